//! The loop over the elements: gather, Gauss points, sum of loads, scatter. It has no physics of its own.
//!
//! ```text
//! R_k = Σ_g w_g L [ N_k X + N′_k n + N″_k EI r″ ],   X = m r̈ + w e_z - f
//! ```
//!
//! R residual [N] (positions) and [N·m] (slopes): the force that must be applied from outside for the motion to be as it is.
//! N_k Hermite shape functions, X load per length [N/m], n axial force [N], f force of the water [N/m].

use crate::algebra::dimension::{Dimension, Spatial};
use crate::algebra::lanes::Lanes;
use crate::algebra::real::Across;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::algebra::shape::{GAUSS3, SHAPES3};
use crate::algebra::triple::Triple;
use crate::rod::axial::Axial;
use crate::rod::bending::Bending;
use crate::rod::elasticity::Curves;
use crate::rod::ends::Ends;
use crate::rod::flows::Flows;
use crate::rod::mesh::Mesh;
use crate::rod::morison::{self, Coefficients, Past, PointMotion, Water};
use crate::rod::motion::Motion;
use crate::rod::seabed::Bed;
use crate::rod::state::COMPONENTS;
use crate::rod::state::Field;
use crate::rod::stretch::{Direction, Stretch};
use crate::sea::clock::Clock;
use nalgebra::Vector3;
use pulp::{Arch, Simd, WithSimd};
use std::marker::PhantomData;

/// A property of an element.
#[derive(Debug, Clone, Copy)]
pub(in crate::rod) enum Property {
    /// Length [m]; 1 for joints, so that quotients stay finite.
    Length,
    /// 1/length.
    PerLength,
    /// Length that counts in integrals [m]; 0 for joints.
    Measure,
    Mass,
    WeightInAir,
    Buoyancy,
    /// Height below which an element is certainly wet [m]; infinite where water is everywhere.
    Waterline,
    Ea,
    Damping,
    Floor,
    Friction,
    Ei,
    DragNormal,
    DragTangential,
    AddedNormal,
    AddedTangential,
}

const PROPERTIES: usize = Property::AddedTangential as usize + 1;

/// Properties of all elements, one row each, padded, so that several elements can be loaded side by side.
#[derive(Debug, Clone)]
pub struct Table {
    elements: usize,
    stride: usize,
    data: Vec<f64>,
    curves: Curves,
    /// What the processor can do.
    pub processor: Arch,
}

/// Bound of the friction of a slack element, as a share of its weight in air.
const SLACK_FRICTION: f64 = 0.05;

impl Table {
    /// The properties of a mesh; `surface`: there is air above, and this is the height below which the surface never falls [m].
    pub fn new(mesh: &Mesh, surface: Option<f64>) -> Table {
        let elements = mesh.elements.len();
        let stride = padded(elements + 1);
        let mut data = vec![0.0; PROPERTIES * stride + MOST_LANES];
        let mut put = |property: Property, e: usize, value: f64| data[property as usize * stride + e] = value;
        for (e, element) in mesh.elements.iter().enumerate() {
            let p = mesh.properties_of(e);
            let length = if element.is_joint() { 1.0 } else { element.length };
            put(Property::Length, e, length);
            put(Property::PerLength, e, 1.0 / length);
            put(Property::Measure, e, element.length);
            put(Property::Mass, e, p.mass);
            put(Property::WeightInAir, e, p.weight_in_air);
            put(Property::Buoyancy, e, p.weight_in_air - p.weight);
            put(Property::Waterline, e, surface.map_or(f64::INFINITY, |lowest| lowest - 0.5 * p.diameter));
            put(Property::Ea, e, p.ea);
            put(Property::Damping, e, p.damping);
            put(Property::Floor, e, if mesh.limp { 0.0 } else { p.tension_floor() });
            put(Property::Friction, e, SLACK_FRICTION * p.slack_weight() * element.length);
            put(Property::Ei, e, if p.folds { p.bight_stiffness(element.length) } else { p.ei });
            put(Property::DragNormal, e, p.drag_normal);
            put(Property::DragTangential, e, p.drag_tangential);
            put(Property::AddedNormal, e, p.added_normal);
            put(Property::AddedTangential, e, p.added_tangential);
        }
        let laws = || (0..elements).map(|e| (mesh.elasticity_of(e), mesh.properties_of(e))).collect::<Vec<_>>();
        let curves = if mesh.is_special() { Curves::new(&laws()) } else { Curves::default() };
        Table { elements, stride, data, curves, processor: Arch::new() }
    }

    /// Number of elements, joints included.
    pub fn len(&self) -> usize {
        self.elements
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.elements == 0
    }

    /// Length of element `e` [m]; 1 for a joint.
    pub fn length_of(&self, e: usize) -> f64 {
        self.get(Property::Length, e)
    }

    /// Height below which element `e` is certainly wet [m].
    pub fn waterline_of(&self, e: usize) -> f64 {
        self.get(Property::Waterline, e)
    }

    /// Whether element `e` is a joint.
    pub fn is_joint(&self, e: usize) -> bool {
        self.get(Property::Measure, e) == 0.0
    }

    fn get(&self, property: Property, e: usize) -> f64 {
        self.data[property as usize * self.stride + e]
    }

    pub(in crate::rod) fn rows(&self) -> Rows<'_> {
        Rows { data: &self.data, stride: self.stride }
    }

    /// Coefficients of the water's force on element `e`.
    pub fn coefficients(&self, e: usize) -> Coefficients<f64> {
        Coefficients {
            drag_normal: self.get(Property::DragNormal, e),
            drag_tangential: self.get(Property::DragTangential, e),
            added_normal: self.get(Property::AddedNormal, e),
            added_tangential: self.get(Property::AddedTangential, e),
            buoyancy: self.get(Property::Buoyancy, e),
        }
    }
}

/// Axial properties with the tension and stiffness of a point, where they come from tables.
#[inline(always)]
pub(in crate::rod) fn with_curve<F: Real, S: Stretch>(
    axial: Axial<F>,
    cpu: F::Cpu,
    curves: &Curves,
    e: usize,
    direction: &Direction<F>,
    z: F,
) -> Axial<F> {
    if !S::SPECIAL {
        return axial;
    }
    let (elastic, stiffness) = curves.at(cpu, e, S::strain(direction), z);
    Axial { elastic, stiffness, ..axial }
}

/// The rows of a table.
#[derive(Clone, Copy)]
pub(in crate::rod) struct Rows<'a> {
    data: &'a [f64],
    stride: usize,
}

/// Properties of the elements of a batch.
pub(in crate::rod) struct Batch<'a, F: Real> {
    pub cpu: F::Cpu,
    pub rows: Rows<'a>,
    pub e: usize,
}

impl<F: Real> Batch<'_, F> {
    #[inline(always)]
    pub fn get(&self, property: Property) -> F {
        F::load(self.cpu, self.rows.data, property as usize * self.rows.stride + self.e)
    }

    #[inline(always)]
    pub fn axial(&self) -> Axial<F> {
        Axial {
            ea: self.get(Property::Ea),
            damping: self.get(Property::Damping),
            floor: self.get(Property::Floor),
            friction: self.get(Property::Friction),
            elastic: F::splat(self.cpu, 0.0),
            stiffness: F::splat(self.cpu, 0.0),
        }
    }

    #[inline(always)]
    pub fn coefficients(&self) -> Coefficients<F> {
        Coefficients {
            drag_normal: self.get(Property::DragNormal),
            drag_tangential: self.get(Property::DragTangential),
            added_normal: self.get(Property::AddedNormal),
            added_tangential: self.get(Property::AddedTangential),
            buoyancy: self.get(Property::Buoyancy),
        }
    }
}

/// What acts on the ends of elements, as far as the fast loop goes.
#[derive(Debug, Clone, Copy)]
pub struct Acting<F: Real> {
    /// Forces on positions, and moments on slopes times length [N].
    pub ends: [Triple<F>; 4],
    /// Positive where the bed is still to be added, because it may touch a part of the element.
    pub touching: F,
    /// Positive where the water is still to be added, because the element may not be all wet.
    pub dry: F,
}

/// Everything that the loop over the elements reads.
pub(in crate::rod) struct Source<'a, W> {
    pub clock: Clock,
    pub curves: &'a Curves,
    pub table: Rows<'a>,
    pub water: &'a W,
    bed: Option<&'a Bed>,
    /// The motion of the waves at the Gauss points, where it is known.
    pub flows: Option<&'a Flows>,
    pub u: [&'a [f64]; COMPONENTS],
    pub v: [&'a [f64]; COMPONENTS],
    pub a: [&'a [f64]; COMPONENTS],
}

impl<'a, W> Source<'a, W> {
    pub fn new(table: &'a Table, water: &'a W, bed: Option<&'a Bed>, at: &'a Motion) -> Self {
        Source {
            clock: at.clock,
            curves: &table.curves,
            table: table.rows(),
            water,
            bed,
            flows: None,
            u: at.u.rows(),
            v: at.v.rows(),
            a: at.a.rows(),
        }
    }

    /// 1 where an element from `e` on is all wet, else 0; `waterline`: the height below which it is in any waves.
    #[inline(always)]
    pub fn wet<F: Real>(&self, cpu: F::Cpu, u: &Ends<F>, waterline: F, e: usize) -> F
    where
        W: Water,
    {
        match self.flows {
            Some(flows) if W::WAVES => flows.wet(cpu, e),
            _ => u.wet(waterline),
        }
    }

    /// The motion of the water past point `g` of the elements from `e` on.
    #[inline(always)]
    pub fn past<F: Real>(&self, cpu: F::Cpu, point: &PointMotion<F>, g: usize, e: usize) -> Past<F>
    where
        W: Water,
    {
        match self.flows {
            Some(flows) if W::WAVES => self.water.past_with(cpu, point, &flows.get(cpu, g, e)),
            _ => self.water.past(cpu, point),
        }
    }
}

/// What acts on the ends of element `e`.
pub fn forces<S: Stretch, W: Water, B: Bending>(
    table: &Table,
    water: &W,
    bed: Option<&Bed>,
    at: &Motion,
    e: usize,
) -> Acting<f64> {
    batch_forces::<f64, S, W, B>((), &Source::new(table, water, bed, at), e)
}

/// What acts on the ends of elements from `e` on. In drag and stretch about 830 operations, of them 3 quotients and 6 roots.
#[inline(always)]
fn batch_forces<F: Real, S: Stretch, W: Water, B: Bending>(cpu: F::Cpu, source: &Source<W>, e: usize) -> Acting<F> {
    let table = Batch::<F> { cpu, rows: source.table, e };
    let (length, per_length, measure) =
        (table.get(Property::Length), table.get(Property::PerLength), table.get(Property::Measure));
    let (mass, axial) = (table.get(Property::Mass), table.axial());
    let (ei, coefficients) = (table.get(Property::Ei), table.coefficients());
    let u = Ends::load(cpu, &source.u, e, length);
    let v = Ends::load(cpu, &source.v, e, length);
    let a = Ends::load(cpu, &source.a, e, length);
    let wet = source.wet(cpu, &u, table.get(Property::Waterline), e);
    let weight = table.get(Property::WeightInAir) - table.get(Property::Buoyancy) * wet;
    let mut sum = [Triple::zero(cpu); 4];
    for (g, (gauss, shape)) in GAUSS3.iter().zip(&SHAPES3).enumerate() {
        let direction = Direction::of(u.combine(&shape.slope) * per_length);
        let rate = v.combine(&shape.slope) * per_length;
        let acceleration = a.combine(&shape.value);
        let w = measure * gauss.weight;
        let axial = with_curve::<F, S>(axial, cpu, source.curves, e, &direction, u.combine(&shape.value).z);
        let n = S::force(cpu, &axial, &direction, rate) * (per_length * w);
        let mut x = acceleration * mass;
        x.z = x.z + weight;
        if W::PRESENT {
            let velocity = v.combine(&shape.value);
            let point = PointMotion { clock: source.clock, direction, place: u.combine(&shape.value), velocity, acceleration };
            let past = source.past(cpu, &point, g, e);
            x = morison::force_past(source.water, &coefficients, &point, past).mul_add(-wet, x);
        }
        let x = x * w;
        for k in 0..4 {
            sum[k] = x.scale_add(shape.value[k], n.scale_add(shape.slope[k], sum[k]));
        }
        if B::PRESENT {
            let per_square = per_length * per_length;
            let moment = B::force(ei, u.combine(&shape.curvature) * per_square) * (per_square * w);
            for k in 0..4 {
                sum[k] = moment.scale_add(shape.curvature[k], sum[k]);
            }
        }
    }
    let mut touching = F::splat(cpu, 0.0);
    if let Some(bed) = source.bed {
        touching = bed.add_grounded(cpu, &u, measure, e, &mut sum);
    }
    Acting { ends: sum, touching, dry: -wet + 1.0 }
}

/// Adds the residual of the elements between the nodes of each of `runs`, from its first to the one before its end, to `out`, with the waves as
/// `flows` has them or as they are asked for, and calls `partly` for each that is still to be looked at, with what there may be. Of the elements
/// before and behind a run it may add less than `MOST_LANES` too.
#[allow(clippy::too_many_arguments)]
pub fn residual<S: Stretch, W: Water, B: Bending, D: Dimension>(
    table: &Table,
    water: &W,
    bed: Option<&Bed>,
    flows: Option<&Flows>,
    motion: &Motion,
    runs: &[(usize, usize)],
    out: &mut Field,
    partly: impl FnMut(usize, bool, bool, &mut Field),
) {
    let source = Source { flows, ..Source::new(table, water, bed, motion) };
    table.processor.dispatch(Residual::<S, W, B, D, _> { table, runs, source, out, partly, laws: PhantomData });
}

struct Residual<'a, S, W, B, D, P> {
    table: &'a Table,
    runs: &'a [(usize, usize)],
    source: Source<'a, W>,
    out: &'a mut Field,
    partly: P,
    laws: PhantomData<(S, B, D)>,
}

impl<S: Stretch, W: Water, B: Bending, D: Dimension, P: FnMut(usize, bool, bool, &mut Field)> WithSimd
    for Residual<'_, S, W, B, D, P>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(mut self, cpu: V) {
        for &(first, end) in self.runs {
            // Batches stand where they do in a run of all: behind the last of those there is nothing to be read.
            for e in (first - first % V::F64_LANES..end - 1).step_by(V::F64_LANES) {
                let acting = batch_forces::<Lanes<V, D>, S, W, B>(cpu, &self.source, e);
                let length = Batch::<Lanes<V, D>> { cpu, rows: self.source.table, e }.get(Property::Length);
                add_to_nodes(cpu, self.out, e, length, &acting.ends);
                if acting.touching.any_positive() || acting.dry.any_positive() {
                    let (mut touching, mut dry) = ([0.0; MOST_LANES], [0.0; MOST_LANES]);
                    acting.touching.store(&mut touching, 0);
                    acting.dry.store(&mut dry, 0);
                    for lane in (0..V::F64_LANES).filter(|lane| e + lane < self.table.len()) {
                        let (touching, dry) = (touching[lane] > 0.0, dry[lane] > 0.0);
                        if touching || dry {
                            (self.partly)(e + lane, touching, dry, self.out);
                        }
                    }
                }
            }
        }
    }
}

/// Forces on the last end of every element [N], and on the first end of the first; `partly` as for the residual, to be added to them.
pub fn end_forces<S: Stretch, W: Water, B: Bending>(
    table: &Table,
    water: &W,
    bed: Option<&Bed>,
    motion: &Motion,
    out: &mut [Vector3<f64>],
    partly: impl FnMut(usize, bool, bool, &mut [Vector3<f64>]),
) {
    let source = Source::new(table, water, bed, motion);
    table.processor.dispatch(EndForces::<S, W, B, _> { table, source, out, partly, laws: PhantomData });
}

struct EndForces<'a, S, W, B, P> {
    table: &'a Table,
    source: Source<'a, W>,
    out: &'a mut [Vector3<f64>],
    partly: P,
    laws: PhantomData<(S, B)>,
}

impl<S: Stretch, W: Water, B: Bending, P: FnMut(usize, bool, bool, &mut [Vector3<f64>])> WithSimd for EndForces<'_, S, W, B, P> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(mut self, cpu: V) {
        let mut rows = [[0.0; MOST_LANES]; 8];
        for e in (0..self.table.len()).step_by(V::F64_LANES) {
            let acting = batch_forces::<Lanes<V, Spatial>, S, W, B>(cpu, &self.source, e);
            let ([x, y, z], first) = (acting.ends[2].components(cpu), acting.ends[0].components(cpu));
            for (row, lanes) in rows.iter_mut().zip([x, y, z, first[0], first[1], first[2], acting.touching, acting.dry]) {
                lanes.store(row, 0);
            }
            if e == 0 {
                self.out[0] = Vector3::new(rows[3][0], rows[4][0], rows[5][0]);
            }
            for lane in (0..V::F64_LANES).filter(|lane| e + lane < self.table.len()) {
                self.out[e + lane + 1] = Vector3::new(rows[0][lane], rows[1][lane], rows[2][lane]);
                let (touching, dry) = (rows[6][lane] > 0.0, rows[7][lane] > 0.0);
                if touching || dry {
                    (self.partly)(e + lane, touching, dry, self.out);
                }
            }
        }
    }
}

/// Adds what acts on the ends of element `e` (forces, and moments for slopes times length) to the nodes.
pub fn scatter_to_nodes(out: &mut Field, e: usize, length: f64, sum: &[Triple<f64>; 4]) {
    add_to_nodes((), out, e, length, sum);
}

/// The same for elements from `e` on. Lanes meet at nodes, so the left ends are added first, then the right ends. Lanes beyond the
/// last element hold zeros, since all their properties are zero.
#[inline(always)]
pub(in crate::rod) fn add_to_nodes<F: Real>(cpu: F::Cpu, out: &mut Field, e: usize, length: F, sum: &[Triple<F>; 4]) {
    let stride = out.stride();
    let data = out.data_mut();
    let ends = [(sum[0], 0, e), (sum[1] * length, 3, e), (sum[2], 0, e + 1), (sum[3] * length, 3, e + 1)];
    for (force, component, node) in ends {
        let at = component * stride + node;
        force.x.add_to(cpu, data, at);
        force.y.write_more(cpu, data, at + stride);
        force.z.add_to(cpu, data, at + 2 * stride);
    }
}

/// Adds M x to `out`: mass and added mass of every element, as if all were under water.
pub fn inertia<W: Water>(table: &Table, u: &Field, x: &Field, out: &mut Field) {
    let properties = table.rows();
    table.processor.dispatch(Inertia::<W> { table, properties, u: u.rows(), x: x.rows(), out, water: PhantomData });
}

struct Inertia<'a, W> {
    table: &'a Table,
    properties: Rows<'a>,
    u: [&'a [f64]; COMPONENTS],
    x: [&'a [f64]; COMPONENTS],
    out: &'a mut Field,
    water: PhantomData<W>,
}

impl<W: Water> WithSimd for Inertia<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        for e in (0..self.table.len()).step_by(V::F64_LANES) {
            let table = Batch::<Lanes<V, Spatial>> { cpu, rows: self.properties, e };
            let (length, measure, mass) = (table.get(Property::Length), table.get(Property::Measure), table.get(Property::Mass));
            let k = table.coefficients();
            let (u, x) = (Ends::load(cpu, &self.u, e, length), Ends::load(cpu, &self.x, e, length));
            let mut sum = [Triple::zero(cpu); 4];
            for (gauss, shape) in GAUSS3.iter().zip(&SHAPES3) {
                let x = x.combine(&shape.value);
                let mut force = x * mass;
                if W::PRESENT {
                    let p = u.combine(&shape.slope);
                    let along = (k.added_tangential - k.added_normal) * p.dot(x) * (p.dot(p) + f64::MIN_POSITIVE).reciprocal();
                    force = p.mul_add(along, x.mul_add(k.added_normal, force));
                }
                let force = force * (measure * gauss.weight);
                for k in 0..4 {
                    sum[k] = force.scale_add(shape.value[k], sum[k]);
                }
            }
            add_to_nodes(cpu, self.out, e, length, &sum);
        }
    }
}

/// Tension at the Gauss points of every element [N], three per element.
pub fn tensions<S: Stretch>(table: &Table, u: &Field, v: &Field, out: &mut [f64]) {
    at_points::<S>(table, u, v, S::tension, out);
}

/// Tension at the Gauss points after a change of u, to first order in the change [N]: what the mixed method would carry on.
pub fn linear_tensions<S: Stretch>(table: &Table, u: &Field, change: &Field, out: &mut [f64]) {
    at_points::<S>(table, u, change, S::linear_tension, out);
}

/// A law of the slopes of two fields at the Gauss points of every element, three per element.
fn at_points<S: Stretch>(
    table: &Table,
    u: &Field,
    other: &Field,
    law: impl Fn(&Axial<f64>, &Vector3<f64>, &Vector3<f64>) -> f64,
    out: &mut [f64],
) {
    let rows = table.rows();
    for e in 0..table.len() {
        let length = table.length_of(e);
        let (ends, others) = (Ends::gather(u, e, length), Ends::gather(other, e, length));
        let axial = Batch::<f64> { cpu: (), rows, e }.axial();
        for (g, shape) in SHAPES3.iter().enumerate() {
            let slope = |ends: &Ends<f64>| Vector3::from(ends.combine(&shape.slope)) / length;
            let (p, z) = (slope(&ends), ends.combine(&shape.value).z);
            let axial = with_curve::<f64, S>(axial, (), &table.curves, e, &Direction::of(p.into()), z);
            out[3 * e + g] = law(&axial, &p, &slope(&others));
        }
    }
}
