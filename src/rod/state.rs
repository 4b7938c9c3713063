//! The unknowns of a line and their rates: plain numbers whose clone is the rollback.
//!
//! A `Field` holds six numbers per node, component by component (all x, then all y, …): position (or its rate) [m] in
//! components 0–2 and slope dr/ds (or its rate) [-] in components 3–5. Nodes run from the anchor to the fairlead.

use nalgebra::Vector3;

/// Components per node: three of position, three of slope.
pub const COMPONENTS: usize = 6;

/// Six numbers per node, component-major.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    stride: usize,
    data: Vec<f64>,
}

impl Field {
    /// Zeros for `nodes` nodes.
    pub fn new(nodes: usize) -> Field {
        Field { stride: nodes, data: vec![0.0; COMPONENTS * nodes] }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.stride
    }

    /// All numbers, component-major.
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// All numbers, component-major, to change.
    pub fn data_mut(&mut self) -> &mut [f64] {
        &mut self.data
    }

    /// Component `c` of every node.
    #[inline(always)]
    pub fn component(&self, c: usize) -> &[f64] {
        &self.data[c * self.stride..(c + 1) * self.stride]
    }

    /// Component `c` of every node, to change.
    #[inline(always)]
    pub fn component_mut(&mut self, c: usize) -> &mut [f64] {
        &mut self.data[c * self.stride..(c + 1) * self.stride]
    }

    /// Components 0–2 of a node.
    pub fn position(&self, node: usize) -> Vector3<f64> {
        Vector3::from_fn(|c, _| self.data[c * self.stride + node])
    }

    /// Components 3–5 of a node.
    pub fn slope(&self, node: usize) -> Vector3<f64> {
        Vector3::from_fn(|c, _| self.data[(c + 3) * self.stride + node])
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

    /// self = x + factor·y, entry by entry.
    pub fn set_sum(&mut self, x: &Field, factor: f64, y: &Field) {
        for ((to, x), y) in self.data.iter_mut().zip(&x.data).zip(&y.data) {
            *to = x + factor * y;
        }
    }

    /// self += factor·x, entry by entry.
    pub fn add(&mut self, factor: f64, x: &Field) {
        for (to, x) in self.data.iter_mut().zip(&x.data) {
            *to += factor * x;
        }
    }

    /// Sum of the products, entry by entry.
    pub fn dot(&self, x: &Field) -> f64 {
        self.data.iter().zip(&x.data).map(|(a, b)| a * b).sum()
    }

    /// Copies all numbers of a field of the same size.
    pub fn copy_from(&mut self, x: &Field) {
        self.data.copy_from_slice(&x.data);
    }

    /// Sets all numbers.
    pub fn fill(&mut self, value: f64) {
        self.data.fill(value);
    }
}

/// Unknowns u, their rates v = du/dt and a = dv/dt.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Positions and slopes.
    pub u: Field,
    /// Velocities.
    pub v: Field,
    /// Accelerations.
    pub a: Field,
}

impl State {
    /// A line of `nodes` nodes, all zero.
    pub fn new(nodes: usize) -> State {
        State { u: Field::new(nodes), v: Field::new(nodes), a: Field::new(nodes) }
    }

    /// Copies the state of a line with as many nodes, without allocation.
    pub fn copy_from(&mut self, from: &State) {
        self.u.copy_from(&from.u);
        self.v.copy_from(&from.v);
        self.a.copy_from(&from.a);
    }
}
