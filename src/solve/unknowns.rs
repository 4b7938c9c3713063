//! The free unknowns of a line and the factor of their matrix: all six of a node, or the four in the plane of a planar line.

use crate::algebra::block_tridiagonal::{BlockTridiagonal, Factor, Singular};
use crate::rod::motion::Motion;
use crate::rod::state::{COMPONENTS, Field};
use crate::rod::system::System;
use crate::solve::condensed::Condensed;
use nalgebra::Vector3;

/// Components of a node in the x–z plane.
const IN_PLANE: [usize; 4] = [0, 2, 3, 5];

/// The factor of a matrix of a line.
pub enum Unknowns {
    /// Of all components.
    Spatial(Factor<COMPONENTS>),
    /// Of those in the x–z plane.
    Planar(Factor<4>),
    /// Of all components of lines that hang on bodies and points, and of these.
    Network(Box<Condensed>),
}

impl Unknowns {
    /// Room for the factor of a line.
    pub fn new(line: &dyn System) -> Unknowns {
        let nodes = line.nodes();
        if let Some(links) = line.links() {
            Unknowns::Network(Box::new(Condensed::new(nodes, links)))
        } else if line.is_planar() {
            Unknowns::Planar(Factor::new(nodes, IN_PLANE))
        } else {
            Unknowns::Spatial(Factor::new(nodes, std::array::from_fn(|c| c)))
        }
    }

    /// Factors the matrix of a motion; prescribed unknowns are taken out of it. `weight`: that of ∂R/∂u in it. `lines`: those of a network that alone
    /// are factored anew, from their first nodes to before their ends; none: all.
    pub fn factor(
        &mut self,
        line: &dyn System,
        at: &Motion,
        weight: f64,
        matrix: &mut BlockTridiagonal<COMPONENTS>,
        lines: Option<&[(usize, usize)]>,
    ) -> Result<(), Singular> {
        for &(node, component) in line.fixed() {
            matrix.fix(node, component);
        }
        match self {
            Unknowns::Spatial(factor) => factor.factor(matrix),
            Unknowns::Planar(factor) => factor.factor(matrix),
            Unknowns::Network(factor) => factor.factor(line, at, weight, matrix, lines),
        }
    }

    /// Solves with the factor: b becomes the solution; prescribed unknowns, and those across the plane, are zero in it.
    pub fn solve(&self, line: &dyn System, b: &mut Field) {
        for &(node, component) in line.fixed() {
            b.component_mut(component)[node] = 0.0;
        }
        let stride = b.stride();
        match self {
            Unknowns::Spatial(factor) => factor.solve(b.data_mut(), stride),
            Unknowns::Planar(factor) => {
                b.component_mut(1).fill(0.0);
                b.component_mut(4).fill(0.0);
                factor.solve(b.data_mut(), stride);
            }
            Unknowns::Network(factor) => factor.solve(b),
        }
    }

    /// The same of a network, where b is zero inside all lines but those of `runs`, from their first nodes to before their ends.
    pub fn solve_runs(&self, line: &dyn System, b: &mut Field, runs: &[(usize, usize)]) {
        let Unknowns::Network(factor) = self else { return self.solve(line, b) };
        for &(node, component) in line.fixed() {
            b.component_mut(component)[node] = 0.0;
        }
        factor.solve_runs(b, runs);
    }

    /// Takes from the forces on the hanging ends of a network [N] what a displacement of all takes from them by the matrix that was factored.
    pub fn relax(&self, x: &Field, forces: &mut [Vector3<f64>]) {
        if let Unknowns::Network(factor) = self {
            factor.relax(x, forces);
        }
    }
}
