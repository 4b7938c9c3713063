//! The whole mooring of a scene: its parts, which do not know of each other, and the bodies that they hang on.

use crate::algebra::rotation;
use crate::error::Error;
use crate::rod::pose::PosePath;
use crate::scene::bodies::Matrix;
use crate::scene::read::Loaded;
use crate::scene::types::Scene;
use crate::solve::fleet;
use crate::solve::loads::{self, BodyOutputs, Pose};
use crate::solve::newton::Newton;
use crate::solve::part::Part;
use crate::solve::partition;
use crate::solve::simulation::{Outputs, Simulation};
use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3};

/// The mooring.
pub struct Mooring {
    /// Its parts.
    pub parts: Vec<Part>,
    hung: Hung,
    scene: Scene,
}

/// A mooring at rest.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    /// Outputs of its lines.
    pub outputs: Vec<Outputs>,
    /// Its bodies.
    pub bodies: Vec<BodyOutputs>,
    /// Its free points: number in the scene, and position [m].
    pub points: Vec<(usize, Vector3<f64>)>,
}

/// The path of a body, and the ends that hang on it, as (line, whether it is its anchor).
type OfBody = (PosePath, Vec<(usize, bool)>);

/// How each body moves that is driven, and what hangs on it.
pub struct Hung {
    bodies: Vec<OfBody>,
}

impl Hung {
    /// The bodies of a scene.
    pub fn new(loaded: &Loaded) -> Hung {
        let body = |index: usize| (PosePath::of_scene(loaded, index), loads::hanging(&loaded.scene, index));
        Hung { bodies: (0..loaded.scene.bodies.len()).map(body).collect() }
    }

    /// All bodies at a time; `free` are the poses of those that are not driven, `outputs` those of the lines.
    pub fn bodies(&self, time: f64, free: &[(usize, Pose)], outputs: &[Outputs]) -> Vec<BodyOutputs> {
        let body = |(index, (path, ends)): (usize, &OfBody)| {
            let own = free.iter().find(|(body, _)| *body == index).map(|(_, pose)| *pose);
            let pose = own.unwrap_or_else(|| {
                let [position, angles] = path.pose(time);
                Pose { position, angles }
            });
            let (force, moment) = loads::on(&pose.position, ends, outputs);
            BodyOutputs { pose, force, moment }
        };
        self.bodies.iter().enumerate().map(body).collect()
    }
}

impl Mooring {
    /// The mooring of a scene.
    pub fn new(loaded: &Loaded) -> Result<Mooring, Error> {
        let mut parts = partition::parts(&loaded.scene);
        let made = fleet::for_each(&mut parts, |together| Part::of_scene(loaded, together));
        Ok(Mooring {
            parts: made.into_iter().collect::<Result<_, Error>>()?,
            hung: Hung::new(loaded),
            scene: loaded.scene.clone(),
        })
    }

    /// Puts everything in equilibrium at a time.
    pub fn equilibrium(&mut self, time: f64) -> Result<Equilibrium, Error> {
        let (mut outputs, mut poses, mut points) = (vec![None; self.scene.lines.len()], Vec::new(), Vec::new());
        for part in &mut self.parts {
            part.settle(time)?;
            for (local, index) in part.lines().to_vec().into_iter().enumerate() {
                outputs[index] = Some(part.outputs(local));
            }
            poses.extend(part.bodies());
            points.extend(part.points());
        }
        let outputs: Vec<Outputs> = outputs.into_iter().flatten().collect();
        Ok(Equilibrium { bodies: self.bodies(time, &poses, &outputs), outputs, points })
    }

    /// Tells a scene where its free bodies and points are.
    pub fn place_in(&self, scene: &mut Scene) {
        for part in &self.parts {
            if let Part::Group(group) = part {
                group.place_in(scene);
            }
        }
    }

    /// All bodies at a time, as `Hung::bodies`.
    pub fn bodies(&self, time: f64, free: &[(usize, Pose)], outputs: &[Outputs]) -> Vec<BodyOutputs> {
        self.hung.bodies(time, free, outputs)
    }

    /// Stiffness of the mooring against a body in the equilibrium that has been found: minus the change of force and moment of the lines with
    /// its displacement along and turn about the global axes, everything free but the body itself following. None where a line has no
    /// stiffness of its own.
    ///
    /// ```text
    /// K = Σ_i [1; [d_i]] k_i [1, -[d_i]] + [0, 0; 0, [f_i][d_i]],   d_i = r_i - X
    /// ```
    pub fn stiffness(&mut self, body: usize, time: f64) -> Option<Matrix> {
        if self.scene.bodies.get(body)?.is_free() || self.parts.iter().any(|part| matches!(part, Part::Group(_))) {
            return self.stiffness_by_differences(body, time);
        }
        let (path, ends) = self.hung.bodies.get(body)?;
        let [position, _] = path.pose(time);
        let ends = ends.clone();
        let mut sum = Matrix6::zeros();
        for part in &mut self.parts {
            let Part::Alone { index: [index], simulation, .. } = part else { continue };
            let own: Vec<bool> = ends.iter().filter(|(line, _)| line == index).map(|(_, anchor)| *anchor).collect();
            if own.is_empty() {
                continue;
            }
            let outputs = simulation.observe();
            let condensed = simulation.end_stiffness()?;
            let at =
                |anchor: bool| if anchor { (outputs.anchor, outputs.anchor_force) } else { (outputs.fairlead, outputs.force) };
            let lever = |anchor: bool| {
                let mut lever = Matrix6x3::zeros();
                lever.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
                lever.fixed_view_mut::<3, 3>(3, 0).copy_from(&rotation::cross(&(at(anchor).0 - position)));
                lever
            };
            for one in &own {
                for other in &own {
                    let (row, column) = (3 * usize::from(!*one), 3 * usize::from(!*other));
                    let block: Matrix3<f64> = condensed.fixed_view::<3, 3>(row, column).into();
                    sum += lever(*one) * block * lever(*other).transpose();
                }
                let (place, force) = at(*one);
                let turned = -rotation::cross(&force) * rotation::cross(&(place - position));
                let mut corner = sum.fixed_view_mut::<3, 3>(3, 3);
                corner += turned;
            }
        }
        Some(std::array::from_fn(|row| std::array::from_fn(|column| sum[(row, column)])))
    }

    /// The same by central differences of statics with the body held in poses nearby.
    fn stiffness_by_differences(&mut self, body: usize, time: f64) -> Option<Matrix> {
        let mut scene = self.scene.clone();
        self.place_in(&mut scene);
        let own = &mut scene.bodies[body];
        let [position, angles] =
            if own.is_free() { [Vector3::from(own.position), own.attitude()] } else { self.hung.bodies[body].0.pose(time) };
        let length = scene.lines.iter().map(|line| line.length()).fold(f64::INFINITY, f64::min);
        let (step, ends) = (1.0e-5 * length, loads::hanging(&scene, body));
        // Turning a clamp bends the line at once.
        let clamped = ends.iter().any(|(line, anchor)| {
            let line = &scene.lines[*line];
            let on = if *anchor { &line.anchor_on } else { &line.fairlead_on };
            on.as_ref().is_some_and(|on| on.clamp().is_some())
        });
        let arm = ends.iter().fold(if clamped { length } else { 1.0e-3 * length }, |arm: f64, (line, anchor)| {
            let line = &scene.lines[*line];
            arm.max((Vector3::from(if *anchor { line.anchor } else { line.fairlead }) - position).norm())
        });
        let moved = |axis: usize, by: f64| -> Option<[Vector3<f64>; 2]> {
            let (mut place, mut turn) = (position, Vector3::zeros());
            if axis < 3 {
                place[axis] += by;
            } else {
                turn[axis - 3] = by;
            }
            let angles = rotation::angles(&(rotation::exp(&turn) * rotation::of_angles(&angles)));
            let held = scene.with_body_held(body, place.into(), angles.map(f64::to_degrees).into());
            let loaded = Loaded::of_scene(held);
            let mut mooring = Mooring::new(&loaded).ok()?;
            let mut outputs = vec![None; loaded.scene.lines.len()];
            for part in &mut mooring.parts {
                part.settle(time).ok()?;
                for (local, index) in part.lines().to_vec().into_iter().enumerate() {
                    outputs[index] = Some(part.outputs(local));
                }
            }
            let outputs: Vec<Outputs> = outputs.into_iter().flatten().collect();
            let (force, moment) = loads::on(&place, &ends, &outputs);
            Some([force, moment])
        };
        let mut sum = [[0.0; 6]; 6];
        for axis in 0..6 {
            let by = if axis < 3 { step } else { step / arm };
            let ([after, turned], [before, back]) = (moved(axis, by)?, moved(axis, -by)?);
            for row in 0..3 {
                sum[row][axis] = (before[row] - after[row]) / (2.0 * by);
                sum[row + 3][axis] = (back[row] - turned[row]) / (2.0 * by);
            }
        }
        Some(sum)
    }
}

impl Simulation {
    /// Static stiffness of the line against its ends, rows and columns of the anchor before those of the fairlead [N/m]; none where the line has
    /// none of its own.
    pub fn end_stiffness(&self) -> Option<Matrix6<f64>> {
        let state = self.state();
        // Across its plane a line is stiff, too, whether that is solved for or not.
        let line = self.in_space();
        Newton::new(line.as_ref()).end_stiffness(line.as_ref(), state)
    }
}
