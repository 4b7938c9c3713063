//! Snapshots of a run as files of VTK: lines and bodies at a time as `.vtp`, and the list of times as `.pvd`, which ParaView opens.

use crate::algebra::rotation;
use crate::error::Error;
use crate::report::course::Row;
use crate::report::tables;
use crate::scene::bodies::Cylinder;
use crate::scene::types::Scene;
use crate::solve::loads;
use crate::solve::simulation::NodeOutput;
use nalgebra::Vector3;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use vtkio::model::{Attribute, Attributes, ByteOrder, DataArray, DataSet, PolyDataPiece, Version, VertexNumbers, Vtk};

/// Sides of a cylinder as it is drawn.
const SIDES: usize = 24;

/// The list of the lines.
pub const LINES: &str = "lines.pvd";

/// The list of the bodies and points.
pub const BODIES: &str = "bodies.pvd";

/// Files of VTK that grow with a run, one of the lines for each snapshot, and one of the bodies and points where there are some.
pub struct Series {
    directory: PathBuf,
    scene: Scene,
    /// The times so far [s].
    times: Vec<f64>,
}

impl Series {
    /// Files in a directory, which is made; lists of an earlier run go.
    pub fn create(directory: &Path, scene: &Scene) -> Result<Series, Error> {
        std::fs::create_dir_all(directory).map_err(|error| tables::unwritable(directory, &error))?;
        for old in [LINES, BODIES] {
            // Where this fails, writing the new file says why.
            let _ = std::fs::remove_file(directory.join(old));
        }
        Ok(Series { directory: directory.to_path_buf(), scene: scene.clone(), times: Vec::new() })
    }

    /// Writes a snapshot. The lists are written anew, so that a run that goes on, or was ended, can be looked at.
    pub fn snapshot(&mut self, row: &Row) -> Result<(), Error> {
        let number = self.times.len();
        self.times.push(row.time);
        self.put("lines", LINES, number, lines(&row.nodes))?;
        if row.bodies.is_empty() && row.points.is_empty() {
            return Ok(());
        }
        self.put("bodies", BODIES, number, bodies(&self.scene, row))
    }

    fn put(&self, stem: &str, list: &str, number: usize, piece: PolyDataPiece) -> Result<(), Error> {
        let path = self.directory.join(name(stem, number));
        let mut text = Vec::new();
        let file = Vtk {
            version: Version::new_xml(1, 0),
            title: String::new(),
            byte_order: ByteOrder::LittleEndian,
            file_path: None,
            data: DataSet::inline(piece),
        };
        file.write_xml(&mut text).map_err(|error| tables::unwritable(&path, &error))?;
        std::fs::write(&path, text).map_err(|error| tables::unwritable(&path, &error))?;
        tables::write(&self.directory.join(list), &collection(stem, &self.times))
    }
}

fn name(stem: &str, number: usize) -> String {
    format!("{stem}_{number:04}.vtp")
}

/// The text of a list of files over time.
fn collection(stem: &str, times: &[f64]) -> String {
    let mut text = String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n");
    for (number, time) in times.iter().enumerate() {
        let _ = writeln!(text, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>", name(stem, number));
    }
    text + "</Collection>\n</VTKFile>\n"
}

/// Cells in the making: each a list of points.
#[derive(Default)]
struct Cells {
    connectivity: Vec<u64>,
    offsets: Vec<u64>,
}

impl Cells {
    fn add(&mut self, points: impl IntoIterator<Item = usize>) {
        self.connectivity.extend(points.into_iter().map(|point| point as u64));
        self.offsets.push(self.connectivity.len() as u64);
    }

    fn finished(self) -> Option<VertexNumbers> {
        (!self.offsets.is_empty()).then_some(VertexNumbers::XML { connectivity: self.connectivity, offsets: self.offsets })
    }
}

fn scalars(name: &str, values: Vec<f64>) -> Attribute {
    Attribute::DataArray(DataArray::scalars(name, 1).with_data(values))
}

fn numbers(name: &str, values: Vec<i32>) -> Attribute {
    Attribute::DataArray(DataArray::scalars(name, 1).with_data(values))
}

fn vectors(name: &str, values: &[Vector3<f64>]) -> Attribute {
    Attribute::DataArray(DataArray::vectors(name).with_data(flat(values)))
}

fn flat(values: &[Vector3<f64>]) -> Vec<f64> {
    values.iter().flat_map(|value| <[f64; 3]>::from(*value)).collect()
}

/// The lines as polylines through their nodes, with `tension` [N], `curvature` [1/m], `s` [m] and, where it is known, `wall_tension` [N] at
/// the nodes; `line` is the number of the line in the scene, from 0.
fn lines(lines: &[Vec<NodeOutput>]) -> PolyDataPiece {
    let all: Vec<&NodeOutput> = lines.iter().flatten().collect();
    let mut cells = Cells::default();
    let mut first = 0;
    for nodes in lines {
        cells.add(first..first + nodes.len());
        first += nodes.len();
    }
    let mut point = vec![
        scalars("tension", all.iter().map(|node| node.tension).collect()),
        scalars("curvature", lines.iter().flat_map(|nodes| curvatures(nodes)).collect()),
        scalars("s", all.iter().map(|node| node.s).collect()),
    ];
    if let Some(walls) = all.iter().map(|node| node.wall_tension).collect() {
        point.push(scalars("wall_tension", walls));
    }
    PolyDataPiece {
        points: flat(&all.iter().map(|node| node.position).collect::<Vec<_>>()).into(),
        lines: cells.finished(),
        data: Attributes { point, cell: vec![numbers("line", (0..lines.len() as i32).collect())] },
        ..PolyDataPiece::default()
    }
}

/// Curvature at the nodes of a line [1/m], from the directions that it has there: the vector of each piece, the turn of its direction over its
/// length, stands at the middle of the piece and is linear between the middles and beyond the outer ones. Exact for an arc of a circle, and of
/// second order for any smooth line.
fn curvatures(nodes: &[NodeOutput]) -> Vec<f64> {
    let pieces: Vec<(Vector3<f64>, f64)> = nodes.windows(2).map(|pair| piece(&pair[0], &pair[1])).collect();
    let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return vec![0.0; nodes.len()] };
    if pieces.len() == 1 {
        return vec![first.0.norm(); 2];
    }
    let end = |(outer, length): &(Vector3<f64>, f64), (inner, next): &(Vector3<f64>, f64)| {
        (outer + (outer - inner) * (length / (length + next))).norm()
    };
    let between = pieces.windows(2).map(|pair| {
        let ((before, length), (after, next)) = (pair[0], pair[1]);
        ((before * next + after * length) / (length + next)).norm()
    });
    let mut all = vec![end(first, &pieces[1])];
    all.extend(between);
    all.push(end(last, &pieces[pieces.len() - 2]));
    all
}

/// Curvature of the piece between two nodes as a vector across its plane [1/m], and its length [m]: those of the arc that turns as much over the
/// same chord.
fn piece(from: &NodeOutput, to: &NodeOutput) -> (Vector3<f64>, f64) {
    let across = from.tangent.cross(&to.tangent);
    let (sine, cosine) = (across.norm(), from.tangent.dot(&to.tangent));
    let angle = sine.atan2(cosine);
    let chord = (to.position - from.position).norm();
    let half = 0.5 * angle;
    let length = if half > 1.0e-8 { chord * half / half.sin() } else { chord };
    if !(sine > 0.0 && length > 0.0) {
        return (Vector3::zeros(), length.max(f64::MIN_POSITIVE));
    }
    (across * (angle / (sine * length)), length)
}

/// Bodies and free points: of each body a vertex at its reference point, spokes to the ends of lines that hang on it, and its cylinders as
/// surfaces; of each free point a vertex. `force` [N] and `moment` [N·m] of the lines on a body stand at its reference point and are zero
/// elsewhere, so that it gets one arrow; `body` is its number in the scene, from 0, and -1 for a free point.
fn bodies(scene: &Scene, row: &Row) -> PolyDataPiece {
    let (mut points, mut force, mut moment) = (Vec::new(), Vec::new(), Vec::new());
    let (mut verts, mut spokes, mut sides) = (Cells::default(), Cells::default(), Cells::default());
    let (mut of_verts, mut of_spokes, mut of_sides) = (Vec::new(), Vec::new(), Vec::new());
    for (index, (body, at)) in scene.bodies.iter().zip(&row.bodies).enumerate() {
        let number = index as i32;
        let centre = points.len();
        points.push(at.pose.position);
        force.resize(points.len(), Vector3::zeros());
        moment.resize(points.len(), Vector3::zeros());
        (force[centre], moment[centre]) = (at.force, at.moment);
        verts.add([centre]);
        of_verts.push(number);
        for (line, anchor) in loads::hanging(scene, index) {
            let Some(outputs) = row.outputs.get(line) else { continue };
            spokes.add([centre, points.len()]);
            of_spokes.push(number);
            points.push(if anchor { outputs.anchor } else { outputs.fairlead });
        }
        let turn = rotation::of_angles(&at.pose.angles);
        for cylinder in &body.cylinders {
            let first = points.len();
            points.extend(rims(cylinder).map(|place| at.pose.position + turn * place));
            let (from, to) = (|side: usize| first + side % SIDES, |side: usize| first + SIDES + side % SIDES);
            sides.add((0..SIDES).rev().map(from));
            sides.add((0..SIDES).map(to));
            (0..SIDES).for_each(|side| sides.add([from(side), from(side + 1), to(side + 1), to(side)]));
            of_sides.extend(std::iter::repeat_n(number, SIDES + 2));
        }
    }
    for place in &row.points {
        verts.add([points.len()]);
        of_verts.push(-1);
        points.push(*place);
    }
    force.resize(points.len(), Vector3::zeros());
    moment.resize(points.len(), Vector3::zeros());
    // Cells count in this order: vertices, lines, surfaces.
    let body = [of_verts, of_spokes, of_sides].concat();
    PolyDataPiece {
        points: flat(&points).into(),
        verts: verts.finished(),
        lines: spokes.finished(),
        polys: sides.finished(),
        data: Attributes { point: vec![vectors("force", &force), vectors("moment", &moment)], cell: vec![numbers("body", body)] },
        ..PolyDataPiece::default()
    }
}

/// Points around both ends of a cylinder in body axes [m], those of `from` first, turning about the direction to `to`.
fn rims(cylinder: &Cylinder) -> impl Iterator<Item = Vector3<f64>> {
    let ends = [Vector3::from(cylinder.from), Vector3::from(cylinder.to)];
    let axis = (ends[1] - ends[0]).normalize();
    let aside = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let one = axis.cross(&aside).normalize();
    let other = axis.cross(&one);
    let radius = 0.5 * cylinder.diameter;
    ends.into_iter().flat_map(move |end| {
        (0..SIDES).map(move |side| {
            let (sine, cosine) = (std::f64::consts::TAU * side as f64 / SIDES as f64).sin_cos();
            end + (one * cosine + other * sine) * radius
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(s: f64, position: Vector3<f64>, tangent: Vector3<f64>) -> NodeOutput {
        NodeOutput { s, position, tangent, tension: 0.0, wall_tension: None }
    }

    /// Source: an arc of a circle has the curvature of its radius, on any nodes.
    #[test]
    fn an_arc_has_the_curvature_of_its_circle() {
        let radius = 37.0;
        let at = |angle: f64| {
            let (sine, cosine) = angle.sin_cos();
            node(radius * angle, Vector3::new(sine, 0.0, -cosine) * radius, Vector3::new(cosine, 0.0, sine))
        };
        let nodes: Vec<_> = [0.0, 0.3, 0.35, 1.2, 1.3].map(at).into();
        for curvature in curvatures(&nodes) {
            assert!((curvature * radius - 1.0).abs() < 1e-12, "{curvature}");
        }
        assert!((curvatures(&nodes[..2])[1] * radius - 1.0).abs() < 1e-12);
    }

    /// Source: the catenary z = c cosh(x/c), whose curvature is c/(c² + s²); halving the pieces divides the error by four.
    #[test]
    fn a_catenary_has_its_curvature_to_second_order() {
        let c = 50.0;
        let error = |pieces: usize| {
            let at = |k: usize| {
                // Pieces that grow, and a stretch of 3 %, which the nodes' arc length does not have.
                let s = 120.0 * (k as f64 / pieces as f64).powf(1.3) - 20.0;
                let tangent = Vector3::new(c, 0.0, s) / c.hypot(s);
                node(s / 1.03, Vector3::new(c * (s / c).asinh(), 0.0, c.hypot(s)), tangent)
            };
            let nodes: Vec<_> = (0..=pieces).map(at).collect();
            let off = |(node, found): (&NodeOutput, f64)| (found / (c / (c * c + (1.03 * node.s).powi(2))) - 1.0).abs();
            nodes.iter().zip(curvatures(&nodes)).map(off).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(40), error(80));
        assert!(fine < 2e-3 && coarse / fine > 3.0, "{coarse} {fine}");
    }

    #[test]
    fn a_straight_line_and_a_kink_have_curvatures_without_nan() {
        let straight: Vec<_> = [0.0, 1.0, 5.0].map(|s| node(s, Vector3::x() * s, Vector3::x())).into();
        assert_eq!(curvatures(&straight), [0.0; 3]);
        let folded: Vec<_> =
            [(0.0, 1.0), (0.0, -1.0), (0.0, 1.0)].map(|(s, x)| node(s, Vector3::zeros(), Vector3::x() * x)).into();
        assert!(curvatures(&folded).iter().all(|curvature| curvature.is_finite()));
    }

    #[test]
    fn a_list_holds_every_time_and_its_file() {
        let text = collection("lines", &[0.0, 0.4]);
        assert!(text.contains("<DataSet timestep=\"0.4\" part=\"0\" file=\"lines_0001.vtp\"/>"), "{text}");
    }
}
