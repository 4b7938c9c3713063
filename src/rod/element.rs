//! The loop over the elements: gather, Gauss points, sum of loads, scatter. It has no physics of its own.
//!
//!     R_k = Σ_g w_g L [ N_k X + N′_k n + N″_k EI r″ ],   X = m r̈ + w e_z - f
//!
//! R residual [N] (positions) and [N·m] (slopes): the force that must be applied from outside for the motion to be as it is.
//! N_k Hermite shape functions, X load per length [N/m], n axial force [N], f force of the water [N/m].

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::lanes::Real;
use crate::algebra::shape::{GAUSS3, SHAPES3, Shape};
use crate::rod::bending::Bending;
use crate::rod::mesh::{Mesh, Properties};
use crate::rod::morison::{self, Coefficients, PointMotion, Water};
use crate::rod::state::Field;
use crate::rod::stretch::{Axial, Stretch};
use nalgebra::{Matrix3, Vector3};

/// The motion at which forces are asked for.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// Positions and slopes.
    pub u: &'a Field,
    /// Their rates.
    pub v: &'a Field,
    /// Their second rates.
    pub a: &'a Field,
}

/// Weights of the tangent: c_u ∂R/∂u + c_v ∂R/∂v + c_a ∂R/∂a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// c_u.
    pub u: f64,
    /// c_v.
    pub v: f64,
    /// c_a.
    pub a: f64,
}

/// Properties of all elements, one array each, so that several elements can be loaded side by side.
#[derive(Debug, Clone)]
pub struct Table {
    /// Length [m]; 1 for joints, so that quotients stay finite.
    length: Vec<f64>,
    /// Length that counts in integrals [m]; 0 for joints.
    measure: Vec<f64>,
    mass: Vec<f64>,
    weight_in_air: Vec<f64>,
    buoyancy: Vec<f64>,
    /// Height below which an element is certainly wet [m]; infinite where water is everywhere.
    waterline: Vec<f64>,
    ea: Vec<f64>,
    damping: Vec<f64>,
    floor: Vec<f64>,
    friction: Vec<f64>,
    ei: Vec<f64>,
    drag_normal: Vec<f64>,
    drag_tangential: Vec<f64>,
    added_normal: Vec<f64>,
    added_tangential: Vec<f64>,
}

/// Bound of the friction of a slack element, as a share of its weight in air.
const SLACK_FRICTION: f64 = 0.05;

impl Table {
    /// The properties of a mesh; `surface`: there is air above z = 0.
    pub fn new(mesh: &Mesh, surface: bool) -> Table {
        let column =
            |f: &dyn Fn(&Properties) -> f64| -> Vec<f64> { (0..mesh.elements.len()).map(|e| f(mesh.properties_of(e))).collect() };
        Table {
            length: mesh.elements.iter().map(|e| if e.is_joint() { 1.0 } else { e.length }).collect(),
            measure: mesh.elements.iter().map(|e| e.length).collect(),
            mass: column(&|p| p.mass),
            weight_in_air: column(&|p| p.weight_in_air),
            buoyancy: column(&|p| p.weight_in_air - p.weight),
            waterline: column(&|p| if surface { -0.5 * p.diameter } else { f64::INFINITY }),
            ea: column(&|p| p.ea),
            damping: column(&|p| p.damping),
            floor: column(&|p| p.tension_floor()),
            friction: mesh.elements.iter().map(|e| SLACK_FRICTION * mesh.sections[e.section].slack_weight() * e.length).collect(),
            ei: column(&|p| p.ei),
            drag_normal: column(&|p| p.drag_normal),
            drag_tangential: column(&|p| p.drag_tangential),
            added_normal: column(&|p| p.added_normal),
            added_tangential: column(&|p| p.added_tangential),
        }
    }

    /// Number of elements, joints included.
    pub fn len(&self) -> usize {
        self.length.len()
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.length.is_empty()
    }

    /// Length of element `e` [m]; 1 for a joint.
    pub fn length_of(&self, e: usize) -> f64 {
        self.length[e]
    }

    /// Whether element `e` is a joint.
    pub fn is_joint(&self, e: usize) -> bool {
        self.measure[e] == 0.0
    }

    /// Axial properties of elements from `e` on.
    #[inline(always)]
    pub fn axial<F: Real>(&self, e: usize) -> Axial<F> {
        let load = |column: &[f64]| F::load(&column[e..]);
        Axial { ea: load(&self.ea), damping: load(&self.damping), floor: load(&self.floor), friction: load(&self.friction) }
    }

    /// Coefficients of the water's force on elements from `e` on.
    #[inline(always)]
    pub fn coefficients<F: Real>(&self, e: usize) -> Coefficients<F> {
        Coefficients {
            drag_normal: F::load(&self.drag_normal[e..]),
            drag_tangential: F::load(&self.drag_tangential[e..]),
            added_normal: F::load(&self.added_normal[e..]),
            added_tangential: F::load(&self.added_tangential[e..]),
        }
    }
}

/// One vector at each end of an element and its rate by x = s/L: values a, b and slopes times length.
#[derive(Debug, Clone, Copy)]
pub struct Ends<F: Real> {
    a: Vector3<F>,
    da: Vector3<F>,
    b: Vector3<F>,
    db: Vector3<F>,
}

impl<F: Real> Ends<F> {
    /// Elements from `e` on, of lengths `length`.
    #[inline(always)]
    pub fn gather(field: &Field, e: usize, length: F) -> Ends<F> {
        let node = |c: usize, n: usize| F::load(&field.component(c)[n..]);
        let triple = |c: usize, n: usize| Vector3::new(node(c, n), node(c + 1, n), node(c + 2, n));
        Ends { a: triple(0, e), da: triple(3, e) * length, b: triple(0, e + 1), db: triple(3, e + 1) * length }
    }

    /// Value where the shape functions are `n` (unit length).
    #[inline(always)]
    pub fn combine(&self, n: &[f64; 4]) -> Vector3<F> {
        self.a * F::splat(n[0]) + self.da * F::splat(n[1]) + self.b * F::splat(n[2]) + self.db * F::splat(n[3])
    }

    /// Height (third component) where the shape functions are `n`.
    #[inline(always)]
    pub fn combine_z(&self, n: &[f64; 4]) -> F {
        self.a.z * F::splat(n[0]) + self.da.z * F::splat(n[1]) + self.b.z * F::splat(n[2]) + self.db.z * F::splat(n[3])
    }

    /// 1 where the element is certainly below the waterline, else 0.
    #[inline(always)]
    pub fn wet(&self, waterline: F) -> F {
        let third = F::splat(1.0 / 3.0);
        all_wet_lanes([self.a.z, self.a.z + self.da.z * third, self.b.z - self.db.z * third, self.b.z], waterline)
    }

    /// End values and end slopes times length: r_i, L p_i, r_j, L p_j.
    pub fn parts(&self) -> [&Vector3<F>; 4] {
        [&self.a, &self.da, &self.b, &self.db]
    }
}

/// 1 where all control heights lie below the waterline, else 0; without branches.
#[inline(always)]
fn all_wet_lanes<F: Real>(heights: [F; 4], waterline: F) -> F {
    let top = heights[0].max(heights[1]).max(heights[2].max(heights[3]));
    ((waterline - top) * F::splat(1.0e200)).max(F::zero()).min(F::one())
}

/// Whether all control heights of an element lie below the waterline, by the rule of the fast loop.
pub fn all_wet(heights: [f64; 4], waterline: f64) -> bool {
    all_wet_lanes(heights, waterline) == 1.0
}

/// Adds the residual of every element to `out`.
pub fn residual<F: Real, S: Stretch, W: Water, B: Bending>(table: &Table, water: &W, motion: &Motion, out: &mut Field) {
    let mut e = 0;
    while e < table.len() {
        let sum = forces::<F, S, W, B>(table, water, motion, e);
        scatter_to_nodes(out, e, F::load(&table.length[e..]), &sum);
        e += F::LANES;
    }
}

/// What acts on the ends of elements from `e` on: forces on positions, and moments on slopes times length [N].
#[inline(always)]
pub fn forces<F: Real, S: Stretch, W: Water, B: Bending>(table: &Table, water: &W, at: &Motion, e: usize) -> [Vector3<F>; 4] {
    let length = F::load(&table.length[e..]);
    let per_length = F::one() / length;
    let measure = F::load(&table.measure[e..]);
    let (mass, axial) = (F::load(&table.mass[e..]), table.axial::<F>(e));
    let (u, v, a) = (Ends::gather(at.u, e, length), Ends::gather(at.v, e, length), Ends::gather(at.a, e, length));
    let (ei, coefficients) = (F::load(&table.ei[e..]), table.coefficients::<F>(e));
    let wet = u.wet(F::load(&table.waterline[e..]));
    let weight = F::load(&table.weight_in_air[e..]) - F::load(&table.buoyancy[e..]) * wet;
    let mut sum: [Vector3<F>; 4] = [Vector3::zeros(); 4];
    for (gauss, shape) in GAUSS3.iter().zip(&SHAPES3) {
        let p = u.combine(&shape.slope) * per_length;
        let rate = v.combine(&shape.slope) * per_length;
        let acceleration = a.combine(&shape.value);
        let n = S::force(&axial, &p, &rate) * per_length;
        let mut x = acceleration * mass;
        x.z += weight;
        if W::PRESENT {
            let velocity = v.combine(&shape.value);
            let point = PointMotion { slope: p, height: u.combine_z(&shape.value), velocity, acceleration };
            x -= morison::force(water, &coefficients, &point) * wet;
        }
        let w = F::splat(gauss.weight) * measure;
        let (x, n) = (x * w, n * w);
        for k in 0..4 {
            sum[k] += x * F::splat(shape.value[k]) + n * F::splat(shape.slope[k]);
        }
        if B::PRESENT {
            let moment = B::force(ei, &(u.combine(&shape.curvature) * (per_length * per_length))) * (per_length * per_length) * w;
            for k in 0..4 {
                sum[k] += moment * F::splat(shape.curvature[k]);
            }
        }
    }
    sum
}

/// Tangent of the loads at one point, already weighted: δX = inertial·δr + turning·δr′, δn = axial·δr′, δ(EI r″) = bending·δr″.
#[derive(Debug, Clone, Copy)]
pub struct PointTangent {
    /// Change of X with position, velocity and acceleration.
    pub load: Matrix3<f64>,
    /// Change of X with the slope.
    pub turning: Matrix3<f64>,
    /// Change of n with the slope and its rate.
    pub axial: Matrix3<f64>,
    /// EI c_u.
    pub bending: f64,
}

impl PointTangent {
    /// A tangent of loads only.
    pub fn of_load(load: Matrix3<f64>, turning: Matrix3<f64>) -> PointTangent {
        PointTangent { load, turning, axial: Matrix3::zeros(), bending: 0.0 }
    }
}

/// Adds `scale` times the point tangent of element `e`, at a point where the shape is `shape` (scaled to the length), to the matrix.
pub fn scatter(matrix: &mut BlockTridiagonal<6>, e: usize, shape: &Shape, scale: f64, point: &PointTangent) {
    for k in 0..4 {
        for l in 0..4 {
            let block = point.load * (shape.value[k] * shape.value[l])
                + point.turning * (shape.value[k] * shape.slope[l])
                + point.axial * (shape.slope[k] * shape.slope[l])
                + Matrix3::identity() * (point.bending * shape.curvature[k] * shape.curvature[l]);
            let target = match (k / 2, l / 2) {
                (0, 0) => &mut matrix.diagonal[e],
                (1, 1) => &mut matrix.diagonal[e + 1],
                (0, _) => &mut matrix.upper[e],
                _ => &mut matrix.lower[e],
            };
            let mut view = target.fixed_view_mut::<3, 3>(3 * (k % 2), 3 * (l % 2));
            view += block * scale;
        }
    }
}

/// Adds the tangent of every element to the matrix. `geometric[3e + g]`, where given, is the tension of the geometric part.
pub fn tangent<S: Stretch, W: Water, B: Bending>(
    table: &Table,
    water: &W,
    at: &Motion,
    weights: &Weights,
    geometric: Option<&[f64]>,
    matrix: &mut BlockTridiagonal<6>,
) {
    for e in 0..table.len() {
        if table.measure[e] == 0.0 {
            continue;
        }
        let length = table.length[e];
        let (u, v, a) = (Ends::gather(at.u, e, length), Ends::gather(at.v, e, length), Ends::gather(at.a, e, length));
        let (axial, coefficients) = (table.axial::<f64>(e), table.coefficients::<f64>(e));
        let wet = u.wet(table.waterline[e]);
        for (g, (gauss, shape)) in GAUSS3.iter().zip(&SHAPES3).enumerate() {
            let p = u.combine(&shape.slope) / length;
            let rate = v.combine(&shape.slope) / length;
            let stretch = S::tangent(&axial, &p, &rate, geometric.map(|tension| tension[3 * e + g]));
            let mut point = PointTangent {
                load: Matrix3::identity() * (weights.a * table.mass[e]),
                turning: Matrix3::zeros(),
                axial: stretch.by_slope * weights.u + stretch.by_rate * weights.v,
                bending: if B::PRESENT { weights.u * table.ei[e] } else { 0.0 },
            };
            if W::PRESENT {
                let motion = PointMotion {
                    slope: p,
                    height: u.combine_z(&shape.value),
                    velocity: v.combine(&shape.value),
                    acceleration: a.combine(&shape.value),
                };
                let (load, turning) = water_tangent(water, &coefficients, &motion, weights);
                point.load -= load * wet;
                point.turning -= turning * wet;
            }
            scatter(matrix, e, &shape.scaled(length), gauss.weight * length, &point);
        }
    }
}

/// Weighted tangent of the force of the water: by position, velocity and acceleration together, and by slope.
pub fn water_tangent<W: Water>(
    water: &W,
    coefficients: &Coefficients<f64>,
    at: &PointMotion<f64>,
    weights: &Weights,
) -> (Matrix3<f64>, Matrix3<f64>) {
    let f = morison::tangent(water, coefficients, at);
    let by_position = f.by_height * Vector3::z().transpose();
    (by_position * weights.u + f.by_velocity * weights.v + f.by_acceleration * weights.a, f.by_slope * weights.u)
}

/// Adds M x to `out`: mass and added mass of every element, as if all were under water.
pub fn inertia<W: Water>(table: &Table, u: &Field, x: &Field, out: &mut Field) {
    for e in 0..table.len() {
        let length = table.length[e];
        let (ends, x) = (Ends::gather(u, e, length), Ends::gather(x, e, length));
        let k = table.coefficients::<f64>(e);
        let mut sum: [Vector3<f64>; 4] = [Vector3::zeros(); 4];
        for (gauss, shape) in GAUSS3.iter().zip(&SHAPES3) {
            let x = x.combine(&shape.value);
            let mut force = x * table.mass[e];
            if W::PRESENT {
                let p = ends.combine(&shape.slope);
                force += x * k.added_normal
                    + p * ((k.added_tangential - k.added_normal) * p.dot(&x) / p.dot(&p).max(f64::MIN_POSITIVE));
            }
            force *= gauss.weight * table.measure[e];
            for k in 0..4 {
                sum[k] += force * shape.value[k];
            }
        }
        scatter_to_nodes(out, e, length, &sum);
    }
}

/// Adds what acts on the ends of element `e` (forces, and moments for slopes times length) to the nodes.
#[inline(always)]
pub fn scatter_to_nodes<F: Real>(out: &mut Field, e: usize, length: F, sum: &[Vector3<F>; 4]) {
    for c in 0..3 {
        sum[0][c].add_to(&mut out.component_mut(c)[e..]);
        (sum[1][c] * length).add_to(&mut out.component_mut(c + 3)[e..]);
        sum[2][c].add_to(&mut out.component_mut(c)[e + 1..]);
        (sum[3][c] * length).add_to(&mut out.component_mut(c + 3)[e + 1..]);
    }
}

/// Tension at the Gauss points of every element [N], three per element.
pub fn tensions<S: Stretch>(table: &Table, u: &Field, v: &Field, out: &mut [f64]) {
    for e in 0..table.len() {
        let (ends, rates) = (Ends::gather(u, e, table.length[e]), Ends::gather(v, e, table.length[e]));
        for (g, shape) in SHAPES3.iter().enumerate() {
            let (p, rate) = (ends.combine(&shape.slope) / table.length[e], rates.combine(&shape.slope) / table.length[e]);
            out[3 * e + g] = S::tension(&table.axial(e), &p, &rate);
        }
    }
}

/// Tension at the Gauss points after a change of u, to first order in the change [N]: what the mixed method would carry on.
pub fn linear_tensions<S: Stretch>(table: &Table, u: &Field, change: &Field, out: &mut [f64]) {
    for e in 0..table.len() {
        let (ends, changes) = (Ends::gather(u, e, table.length[e]), Ends::gather(change, e, table.length[e]));
        for (g, shape) in SHAPES3.iter().enumerate() {
            let (p, dp) = (ends.combine(&shape.slope) / table.length[e], changes.combine(&shape.slope) / table.length[e]);
            out[3 * e + g] = S::linear_tension(&table.axial(e), &p, &dp);
        }
    }
}
