//! The unknowns of a line and their rates: plain numbers whose clone is the rollback.
//!
//! A `Field` holds six numbers per node, component by component (all x, then all y, …): position (or its rate) [m] in
//! components 0–2 and slope dr/ds (or its rate) [-] in components 3–5. Nodes run from the anchor to the fairlead. Each component
//! is padded with zeros, and so is the end, so that elements can be read in batches without a look at where the line ends.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::sea::clock::Clock;
use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};

/// Components per node: three of position, three of slope.
pub const COMPONENTS: usize = 6;

/// Six numbers per node, component-major.
#[derive(Debug, Clone)]
pub struct Field {
    nodes: usize,
    stride: usize,
    data: Vec<f64>,
    processor: Arch,
}

impl PartialEq for Field {
    fn eq(&self, other: &Field) -> bool {
        self.nodes == other.nodes && self.data == other.data
    }
}

impl Field {
    /// Zeros for `nodes` nodes.
    pub fn new(nodes: usize) -> Field {
        let stride = padded(nodes);
        Field { nodes, stride, data: vec![0.0; COMPONENTS * stride + MOST_LANES], processor: Arch::new() }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Distance in `data` from a component to the next.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// All numbers, component-major, with the padding, which is zero.
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// All numbers, component-major, to change; the padding must stay zero.
    pub fn data_mut(&mut self) -> &mut [f64] {
        &mut self.data
    }

    /// The six components, each with the numbers that follow it, so that a batch may start at any node.
    #[inline(always)]
    pub fn rows(&self) -> [&[f64]; COMPONENTS] {
        std::array::from_fn(|c| &self.data[c * self.stride..][..self.stride + MOST_LANES])
    }

    /// All numbers but the padding.
    pub fn numbers(&self) -> impl Iterator<Item = &f64> {
        (0..COMPONENTS).flat_map(|c| self.component(c))
    }

    /// Component `c` of every node.
    #[inline(always)]
    pub fn component(&self, c: usize) -> &[f64] {
        &self.data[c * self.stride..c * self.stride + self.nodes]
    }

    /// Component `c` of every node, to change.
    #[inline(always)]
    pub fn component_mut(&mut self, c: usize) -> &mut [f64] {
        &mut self.data[c * self.stride..c * self.stride + self.nodes]
    }

    /// Components 0–2 of a node.
    pub fn position(&self, node: usize) -> Vector3<f64> {
        Vector3::from_fn(|c, _| self.data[c * self.stride + node])
    }

    /// Components 3–5 of a node.
    pub fn slope(&self, node: usize) -> Vector3<f64> {
        Vector3::from_fn(|c, _| self.data[(c + 3) * self.stride + node])
    }

    /// Largest position of nodes `first` to before `end`; NaN where there is one.
    pub fn largest_position(&self, first: usize, end: usize) -> f64 {
        let mut largest: f64 = 0.0;
        for node in first..end {
            let size = self.position(node).norm();
            if size > largest || size.is_nan() {
                largest = size;
            }
        }
        largest
    }

    /// Largest entry of nodes `first` to before `end` times `scales` (for positions, slopes), all numbers finite.
    pub fn largest_entry(&self, first: usize, end: usize, scales: [f64; 2]) -> f64 {
        self.processor.dispatch(Largest { field: self, first, end, scales })
    }

    /// self += Σ factor·field at nodes `first` to before `end`.
    pub fn add_between<const N: usize>(&mut self, first: usize, end: usize, terms: [(f64, &Field); N]) {
        let terms = terms.map(|(factor, field)| (factor, field.data.as_slice()));
        let (processor, stride) = (self.processor, self.stride);
        processor.dispatch(SumBetween { to: &mut self.data, stride, first, end, terms });
    }

    /// Sets components 0–2 of a node.
    pub fn set_position(&mut self, node: usize, x: &Vector3<f64>) {
        for c in 0..3 {
            self.data[c * self.stride + node] = x[c];
        }
    }

    /// Sets components 3–5 of a node.
    pub fn set_slope(&mut self, node: usize, x: &Vector3<f64>) {
        for c in 0..3 {
            self.data[(c + 3) * self.stride + node] = x[c];
        }
    }

    /// self = Σ factor·field, entry by entry.
    pub fn set_sum<const N: usize>(&mut self, terms: [(f64, &Field); N]) {
        let terms = terms.map(|(factor, field)| (factor, field.data.as_slice()));
        self.processor.dispatch(Sum { to: &mut self.data, own: false, terms });
    }

    /// self += factor·x, entry by entry.
    pub fn add(&mut self, factor: f64, x: &Field) {
        self.processor.dispatch(Sum { to: &mut self.data, own: true, terms: [(factor, &x.data)] });
    }

    /// Sum of the products, entry by entry.
    pub fn dot(&self, x: &Field) -> f64 {
        self.data.iter().zip(&x.data).map(|(a, b)| a * b).sum()
    }

    /// Becomes the same as another field, without allocation if it is not larger.
    pub fn copy_from(&mut self, x: &Field) {
        (self.nodes, self.stride) = (x.nodes, x.stride);
        self.data.clone_from(&x.data);
    }

    /// Sets all numbers but the padding.
    pub fn fill(&mut self, value: f64) {
        (0..COMPONENTS).for_each(|c| self.component_mut(c).fill(value));
    }
}

/// Unknowns u, their rates v = du/dt and a = dv/dt, when they are so, and what friction remembers.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// When.
    pub clock: Clock,
    /// Positions and slopes.
    pub u: Field,
    /// Velocities.
    pub v: Field,
    /// Accelerations.
    pub a: Field,
    /// Places of the bed to which the line holds on by friction [m]: for element e, at e, two coordinates of each of its three Gauss
    /// points. Empty without friction.
    pub holds: Field,
    /// Of each free body, the rotation from which its rotation vector counts. Empty without free bodies.
    pub frames: Vec<Matrix3<f64>>,
}

impl State {
    /// A line of `nodes` nodes without friction, all zero, at time zero.
    pub fn new(nodes: usize) -> State {
        let zero = || Field::new(nodes);
        State { clock: Clock::default(), u: zero(), v: zero(), a: zero(), holds: Field::new(0), frames: Vec::new() }
    }

    /// Copies the state of a line with as many nodes, without allocation.
    pub fn copy_from(&mut self, from: &State) {
        self.clock = from.clock;
        self.u.copy_from(&from.u);
        self.v.copy_from(&from.v);
        self.a.copy_from(&from.a);
        self.holds.copy_from(&from.holds);
        self.frames.clone_from(&from.frames);
    }
}

impl State {
    /// Takes `factors` (for u, v, a) times an increment away, and returns the largest entry of the increment times `scales` (for
    /// positions, slopes); NaN if any is not finite.
    pub fn retreat(&mut self, factors: [f64; 3], increment: &Field, scales: [f64; 2]) -> f64 {
        increment.processor.dispatch(Retreat { state: self, factors, increment, scales })
    }
}

struct Sum<'a, const N: usize> {
    to: &'a mut [f64],
    own: bool,
    terms: [(f64, &'a [f64]); N],
}

impl<const N: usize> WithSimd for Sum<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        for at in (0..self.to.len()).step_by(V::F64_LANES) {
            let zero = Lanes::<V>::splat(cpu, 0.0);
            let mut sum = if self.own { Lanes::<V>::load(cpu, self.to, at) } else { zero };
            for (factor, term) in self.terms {
                sum = Lanes::<V>::load(cpu, term, at).scale_add(factor, sum);
            }
            sum.store(self.to, at);
        }
    }
}

/// A sum at some nodes, those of other nodes untouched.
struct SumBetween<'a, const N: usize> {
    to: &'a mut [f64],
    stride: usize,
    first: usize,
    end: usize,
    terms: [(f64, &'a [f64]); N],
}

impl<const N: usize> WithSimd for SumBetween<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let whole = (self.end - self.first) / V::F64_LANES * V::F64_LANES;
        for c in 0..COMPONENTS {
            let (first, end) = (c * self.stride + self.first, c * self.stride + self.end);
            for at in (first..first + whole).step_by(V::F64_LANES) {
                let mut sum = Lanes::<V>::load(cpu, self.to, at);
                for (factor, term) in self.terms {
                    sum = Lanes::<V>::load(cpu, term, at).scale_add(factor, sum);
                }
                sum.store(self.to, at);
            }
            for at in first + whole..end {
                for (factor, term) in self.terms {
                    self.to[at] = factor.mul_add(term[at], self.to[at]);
                }
            }
        }
    }
}

/// The largest entry at some nodes.
struct Largest<'a> {
    field: &'a Field,
    first: usize,
    end: usize,
    scales: [f64; 2],
}

impl WithSimd for Largest<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> f64 {
        let (data, stride) = (self.field.data.as_slice(), self.field.stride);
        let whole = (self.end - self.first) / V::F64_LANES * V::F64_LANES;
        let mut largest = [0.0_f64; 2];
        for (part, largest) in largest.iter_mut().enumerate() {
            let mut lanes = Lanes::<V>::splat(cpu, 0.0);
            for c in 3 * part..3 * part + 3 {
                let (first, end) = (c * stride + self.first, c * stride + self.end);
                for at in (first..first + whole).step_by(V::F64_LANES) {
                    let x = Lanes::<V>::load(cpu, data, at);
                    lanes = lanes.max(x.max(-x));
                }
                data[first + whole..end].iter().for_each(|x| *largest = x.abs().max(*largest));
            }
            let mut all = [0.0; MOST_LANES];
            lanes.store(&mut all, 0);
            *largest = all.into_iter().fold(*largest, f64::max);
        }
        (largest[0] * self.scales[0]).max(largest[1] * self.scales[1])
    }
}

struct Retreat<'a> {
    state: &'a mut State,
    factors: [f64; 3],
    increment: &'a Field,
    scales: [f64; 2],
}

impl WithSimd for Retreat<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> f64 {
        let (stride, x) = (self.increment.stride, self.increment.data.as_slice());
        let State { u, v, a, .. } = self.state;
        let [c_u, c_v, c_a] = self.factors;
        let (mut largest, mut finite) = (Lanes::<V>::splat(cpu, 0.0), Lanes::<V>::splat(cpu, 0.0));
        for (part, scale) in self.scales.into_iter().enumerate() {
            for at in (3 * part * stride..3 * (part + 1) * stride).step_by(V::F64_LANES) {
                let x = Lanes::<V>::load(cpu, x, at);
                largest = largest.max((x * scale).max(-x * scale));
                finite = x.scale_add(0.0, finite); // 0·x is NaN for all that is not finite.
                x.scale_add(-c_u, Lanes::<V>::load(cpu, &u.data, at)).store(&mut u.data, at);
                x.scale_add(-c_v, Lanes::<V>::load(cpu, &v.data, at)).store(&mut v.data, at);
                x.scale_add(-c_a, Lanes::<V>::load(cpu, &a.data, at)).store(&mut a.data, at);
            }
        }
        let mut lanes = [0.0; MOST_LANES];
        (largest + finite).store(&mut lanes, 0);
        lanes.into_iter().fold(0.0, |largest: f64, x| if x <= largest { largest } else { x + 0.0 * largest })
    }
}
