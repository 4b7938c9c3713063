//! What the physics tests share: a line built from its parts, with ends held as the test needs them, and the closed forms that
//! more than one test compares with.
#![allow(dead_code, reason = "every test file uses a part of it")]

use moorline::algebra::block_tridiagonal::BlockTridiagonal;
use moorline::algebra::shape::Shape;
use moorline::rod::body::Body;
use moorline::rod::hold::{self, Hold};
use moorline::rod::line::{Line, Supports};
use moorline::rod::mesh::Mesh;
use moorline::rod::motion::Weights;
use moorline::rod::physics::{self, Surroundings};
use moorline::rod::properties::Properties;
use moorline::rod::seabed::{Plane, Resistance};
use moorline::rod::state::{COMPONENTS, Field, State};
use moorline::rod::touching::Ground;
use moorline::scene::types;
use moorline::sea::clock::Clock;
use moorline::solve::controller::{self, Controller, Demands};
use moorline::solve::motion::Path;
use moorline::solve::newton::{Criteria, Newton, motion};
use moorline::solve::scheme::{Bench, Moment, Stages};
use moorline::solve::start::{self, Bounds};
use moorline::solve::statics::{self, Balance};
use nalgebra::{DMatrix, SVector, Vector3};
use serde_json::Value;

pub mod mooring;
pub mod program;
pub mod python;
pub mod random;

pub const GRAVITY: f64 = 9.80665;
pub const X: usize = 0;
pub const Y: usize = 1;
pub const Z: usize = 2;

/// A number of tests/data/reference-cases.json, by JSON pointer.
pub fn reference(pointer: &str) -> f64 {
    let table: Value = serde_json::from_str(include_str!("../data/reference-cases.json")).expect("reference-cases.json");
    table.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no number at {pointer}"))
}

/// A list of numbers of tests/data/reference-cases.json.
pub fn references(pointer: &str) -> Vec<f64> {
    let table: Value = serde_json::from_str(include_str!("../data/reference-cases.json")).expect("reference-cases.json");
    let list = table.pointer(pointer).and_then(Value::as_array).unwrap_or_else(|| panic!("no list at {pointer}"));
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// Fails unless `found` is within `tolerance` (relative) of `exact`; says the error that was measured.
#[track_caller]
pub fn assert_close(what: &str, found: f64, exact: f64, tolerance: f64) {
    let error = (found / exact - 1.0).abs();
    println!("{what}: {found:.10e} for {exact:.10e}, relative error {error:.2e}, allowed {tolerance:.0e}");
    assert!(error <= tolerance, "{what}: {found:.10e} for {exact:.10e}, relative error {error:.2e}, allowed {tolerance:.0e}");
}

/// Fails unless |`found`| ≤ `allowed`; says what was measured.
#[track_caller]
pub fn assert_small(what: &str, found: f64, allowed: f64) {
    println!("{what}: {found:.2e}, allowed {allowed:.0e}");
    assert!(found.abs() <= allowed, "{what}: {found:.3e}, allowed {allowed:.0e}");
}

/// A material with stiffness, mass and weight only; in water it weighs what it weighs in air.
pub fn material(ea: f64, mass: f64, weight: f64) -> Properties {
    Properties {
        ea,
        ei: 0.0,
        damping: 0.0,
        mass,
        weight_in_air: weight,
        weight,
        diameter: 0.1,
        drag_normal: 0.0,
        drag_tangential: 0.0,
        added_normal: 0.0,
        added_tangential: 0.0,
        seabed_stiffness: None,
        folds: false,
    }
}

/// The chain of the 1994 report's example in its water.
pub fn chain() -> Properties {
    let area = std::f64::consts::FRAC_PI_4 * 0.076 * 0.076;
    Properties {
        damping: 4.0e-4,
        weight_in_air: 135.35 * GRAVITY,
        diameter: 0.076,
        drag_normal: 0.5 * 1000.0 * 0.076,
        added_normal: 1000.0 * area * 3.8,
        ..material(5.0e8, 135.35, 1157.1590775)
    }
}

/// One material in equal elements.
pub fn uniform(properties: Properties, length: f64, elements: usize) -> Mesh {
    Mesh::new(vec![properties], &[vec![length / elements as f64; elements]])
}

/// No water, no bed, no surface.
pub fn nothing() -> Surroundings {
    Surroundings { stretch: types::Stretch::Exact, current: None, waves: None, ground: None, surface: None, planar: false }
}

/// A flat bed at height `level`, of the same resistance everywhere, touched `onset` above its level.
pub fn bed(mesh: &Mesh, level: f64, stiffness: f64, onset: f64) -> Ground {
    let resistance = Resistance { stiffness, damping: 0.0, onset, easing: onset.max(0.01) };
    Ground {
        plane: Plane { normal: Vector3::z(), offset: level },
        resistance: vec![resistance; mesh.elements.len()],
        friction: None,
    }
}

/// Supports, put together one by one.
#[derive(Default, Clone)]
pub struct Holding(Supports);

impl Holding {
    pub fn none() -> Holding {
        Holding::default()
    }

    /// Holds some components (0–2 position, 3–5 slope) of a node.
    pub fn hold(mut self, node: usize, components: &[usize]) -> Holding {
        self.0.fixed.extend(components.iter().map(|c| (node, *c)));
        self
    }

    /// Holds some components of every node that is not held in them yet.
    pub fn hold_all(mut self, mesh: &Mesh, components: &[usize]) -> Holding {
        for node in 0..mesh.nodes() {
            for &c in components {
                if !self.0.fixed.contains(&(node, c)) {
                    self.0.fixed.push((node, c));
                }
            }
        }
        self
    }

    /// A dead force on a node.
    pub fn load(mut self, node: usize, force: Vector3<f64>) -> Holding {
        self.0.loads.push((node, force));
        self
    }

    /// A body on its node.
    pub fn body(mut self, body: Body) -> Holding {
        self.0.bodies.push(body);
        self
    }

    /// Springs, dampers and locks at a node.
    pub fn by(mut self, hold: Hold) -> Holding {
        self.0.holds.push(hold);
        self
    }
}

/// A point mass in air.
pub fn point_mass(node: usize, mass: f64) -> Body {
    Body { node, mass, added_mass: 0.0, weight: mass * GRAVITY, buoyancy: 0.0, drag: 0.0, diameter: None, bed: None }
}

/// A hold at an end that does nothing yet, with given axes, about a point.
pub fn hold_at(node: usize, directions: [[f64; 3]; 2], reference: Vector3<f64>) -> Hold {
    let (axes, zero) = (hold::axes(&directions), Vector3::zeros());
    let reference = Some(reference);
    Hold { first: node, node, axes, reference, motion: None, stiffness: zero, damping: zero, locked: [false; 3], force: zero }
}

/// A line on the test bench.
pub struct Rig {
    pub line: Box<dyn Line>,
    pub newton: Newton,
    pub state: State,
    surroundings: Surroundings,
    supports: Supports,
}

impl Rig {
    pub fn new(mesh: Mesh, surroundings: Surroundings, holding: Holding) -> Rig {
        let supports = holding.0;
        let line = physics::build(mesh, surroundings.clone(), supports.clone());
        let (newton, state) = (Newton::new(line.as_ref()), State::new(line.mesh().nodes()));
        Rig { line, newton, state, surroundings, supports }
    }

    pub fn last(&self) -> usize {
        self.line.last()
    }

    /// Puts every node on a curve: position and slope dr/ds at arc length s from the anchor.
    pub fn place(&mut self, curve: impl Fn(f64) -> (Vector3<f64>, Vector3<f64>)) {
        for node in 0..=self.last() {
            let (position, slope) = curve(self.line.mesh().node_arc_length(node));
            self.state.u.set_position(node, &position);
            self.state.u.set_slope(node, &slope);
        }
    }

    /// Puts the line straight between two points, stretched evenly.
    pub fn stretch(&mut self, anchor: Vector3<f64>, fairlead: Vector3<f64>) {
        let slope = (fairlead - anchor) / self.line.mesh().length;
        self.place(|s| (anchor + slope * s, slope));
    }

    /// How near to equilibrium statics comes from where the line is now.
    pub fn balance(&mut self) -> Balance {
        let soften = |limit: f64| {
            let mut mesh = self.line.mesh().clone();
            mesh.sections.iter_mut().for_each(|section| section.ea = section.ea.min(limit));
            physics::build(mesh, self.surroundings.clone(), self.supports.clone())
        };
        statics::settle(self.line.as_ref(), &soften, &mut self.newton, &mut self.state)
    }

    /// Equilibrium from where the line is now; fails if there is none.
    #[track_caller]
    pub fn settle(&mut self) -> Balance {
        let balance = self.balance();
        assert!(balance.converged(), "not in equilibrium: {balance:?}");
        balance
    }

    /// Equilibrium from the program's own first guess, hanging free.
    #[track_caller]
    pub fn hang(&mut self, anchor: Vector3<f64>, fairlead: Vector3<f64>) -> Balance {
        let bounds = Bounds { bed: None, surface: false };
        start::guess(self.line.mesh(), &bounds, &anchor, &fairlead, &mut self.state.u);
        self.settle()
    }

    /// Force of the line on what holds its fairlead.
    pub fn fairlead_force(&self) -> Vector3<f64> {
        self.line.end_force(&motion(&self.state))
    }

    /// Force at every node that the fairlead side exerts on the anchor side; at the anchor the force of the line on it.
    pub fn node_forces(&self) -> Vec<Vector3<f64>> {
        let mut forces = vec![Vector3::zeros(); self.last() + 1];
        self.line.node_forces(&motion(&self.state), &mut forces);
        forces
    }

    /// Position at arc length s from the anchor, by the shape functions.
    pub fn at(&self, s: f64) -> Vector3<f64> {
        let mesh = self.line.mesh();
        let inside = |e: &moorline::rod::mesh::Element| !e.is_joint() && s <= e.start + e.length;
        let e = mesh.elements.iter().position(inside).unwrap_or(mesh.elements.len() - 1);
        let element = mesh.elements[e];
        let n = Shape::at((s - element.start) / element.length).scaled(element.length).value;
        let u = &self.state.u;
        u.position(e) * n[0] + u.slope(e) * n[1] + u.position(e + 1) * n[2] + u.slope(e + 1) * n[3]
    }

    /// Angular frequencies of free vibration about the state [rad/s], rising: K x = ω² M x on the free unknowns.
    pub fn frequencies(&self) -> Vec<f64> {
        let stiffness = self.dense(&Weights { u: 1.0, v: 0.0, a: 0.0 });
        let mass = self.dense(&Weights { u: 0.0, v: 0.0, a: 1.0 });
        let factor = mass.cholesky().expect("a mass matrix is positive definite").l();
        let half = factor.solve_lower_triangular(&stiffness).expect("regular");
        let reduced = factor.solve_lower_triangular(&half.transpose()).expect("regular");
        let symmetric = (&reduced + reduced.transpose()) * 0.5;
        let mut squares: Vec<f64> = symmetric.symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        squares.iter().map(|square| square.max(0.0).sqrt()).collect()
    }

    /// The tangent on the free unknowns; only for meshes without joints.
    fn dense(&self, weights: &Weights) -> DMatrix<f64> {
        let mesh = self.line.mesh();
        let mut matrix = BlockTridiagonal::new(mesh.ties());
        self.line.tangent(&motion(&self.state), weights, None, &mut matrix);
        let free: Vec<(usize, usize)> = (0..mesh.nodes())
            .flat_map(|node| (0..COMPONENTS).map(move |c| (node, c)))
            .filter(|unknown| !self.line.fixed().contains(unknown))
            .collect();
        DMatrix::from_fn(free.len(), free.len(), |i, j| {
            let ((row, r), (column, c)) = (free[i], free[j]);
            match column as i64 - row as i64 {
                0 => matrix.diagonal[row][(r, c)],
                1 => matrix.upper[row][(r, c)],
                -1 => matrix.lower[column][(r, c)],
                _ => 0.0,
            }
        })
    }

    /// Runs in time from the state as it stands (accelerations are made to fit), with steps of fixed length and the fairlead on a path.
    /// `watch` sees the time and state after each step. Returns how many steps had to be cut.
    pub fn run(
        &mut self,
        scheme: types::Scheme,
        path: &Path,
        step: f64,
        until: f64,
        mut watch: impl FnMut(f64, &State, &dyn Line),
    ) -> usize {
        let line = self.line.as_ref();
        let criteria =
            Criteria { tolerance: 1.0e-13, length: line.mesh().length, emphasis: 1.0, iterations: 30, loose: 0.0, enough: 0.0 };
        let demands = Demands { error: 1.0, finest_step: 0.0, max_step: step, fixed_step: Some(step), criteria };
        let mut bench =
            Bench { line, newton: &mut self.newton, path, anchor: None, criteria, allowed: 0.0, stages: Stages::Solve };
        let mut moment: Moment = controller::at_rest(line, 0.0, step);
        moment.state = self.state.clone();
        bench.prescribe(&mut moment.state, Clock::at_rest(0.0));
        bench.accelerate(&mut moment.state).expect("regular mass matrix");
        let mut controller = Controller::new(scheme, line.mesh().nodes());
        let outcome = controller
            .advance(&mut bench, &demands, &mut moment, until, |moment, _| watch(moment.state.clock.now, &moment.state, line));
        if let Err(failure) = outcome {
            panic!("no step: {failure:?}");
        }
        self.state = moment.state;
        controller.tally.rejected
    }

    /// The fairlead held where it is.
    pub fn held(&self) -> Path {
        Path::Fixed(self.state.u.position(self.last()))
    }
}

/// x·A·y-like product: A x for a field, at tied nodes summed on the second, as `Line::residual` reports it.
pub fn times(matrix: &BlockTridiagonal<6>, x: &Field) -> Field {
    let nodes = x.nodes();
    let vector: Vec<SVector<f64, 6>> = (0..nodes).map(|node| SVector::from_fn(|c, _| x.component(c)[node])).collect();
    let mut product = vec![SVector::zeros(); nodes];
    matrix.multiply(&vector, &mut product);
    let mut out = Field::new(nodes);
    for node in 0..nodes {
        out.set_position(node, &product[node].fixed_rows::<3>(0).into_owned());
        out.set_slope(node, &product[node].fixed_rows::<3>(3).into_owned());
    }
    for e in (0..nodes - 1).filter(|e| matrix.tied[*e]) {
        out.set_position(e + 1, &(out.position(e + 1) + out.position(e)));
        out.set_position(e, &Vector3::zeros());
    }
    out
}

/// One section of a hanging line, from the anchor.
#[derive(Clone, Copy)]
pub struct Piece {
    pub length: f64,
    pub weight: f64,
    pub ea: f64,
}

/// A weight (negative: a lift) on a line, as a very short and heavy piece of it.
pub fn weight(force: f64) -> Piece {
    Piece { length: 1.0e-9, weight: 1.0e9 * force, ea: 1.0e15 }
}

/// Elastic catenary of several sections (Irvine 1981, section by section): `horizontal` H and `vertical` V at the anchor.
#[derive(Clone, Copy, Debug)]
pub struct Hanging {
    pub horizontal: f64,
    pub vertical: f64,
}

impl Hanging {
    /// The end forces that span (distance, rise), by nested bisection.
    pub fn spanning(pieces: &[Piece], distance: f64, rise: f64) -> Hanging {
        let scale = 1.0e3 * pieces.iter().map(|p| p.length * p.weight.abs() + p.ea).sum::<f64>();
        let vertical = |h: f64| bisect(-scale, scale, |v| Hanging { horizontal: h, vertical: v }.end(pieces).1 - rise);
        let horizontal = bisect(1e-9, scale, |h| Hanging { horizontal: h, vertical: vertical(h) }.end(pieces).0 - distance);
        Hanging { horizontal, vertical: vertical(horizontal) }
    }

    /// Place of the upper end relative to the anchor.
    pub fn end(&self, pieces: &[Piece]) -> (f64, f64) {
        let (h, mut v, mut x, mut z) = (self.horizontal, self.vertical, 0.0, 0.0);
        for piece in pieces {
            let above = v + piece.weight * piece.length;
            x += h * piece.length / piece.ea + h / piece.weight * ((above / h).asinh() - (v / h).asinh());
            z += 0.5 * (v + above) * piece.length / piece.ea
                + (above - v) / piece.weight * (v + above) / (h.hypot(v) + h.hypot(above));
            v = above;
        }
        (x, z)
    }

    /// Tension at arc length s from the anchor.
    pub fn tension(&self, pieces: &[Piece], s: f64) -> f64 {
        let (mut v, mut start) = (self.vertical, 0.0);
        for piece in pieces {
            v += piece.weight * (s - start).clamp(0.0, piece.length);
            start += piece.length;
        }
        self.horizontal.hypot(v)
    }
}

/// Zero of a rising function, to rounding.
pub fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
