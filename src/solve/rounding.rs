//! What rounding leaves of the forces out of balance.
//!
//! ```text
//! |δR_i| ≤ u Σ_j |∂R_i/∂x_j| |x_j|,   u = 2⁻⁵³
//! ```
//!
//! Positions and slopes x_j are kept to u |x_j| at best, so the state nearest to equilibrium that can be written down may be out of
//! balance by this much, to first order (the componentwise bound of Oettli & Prager 1964). It is about u EA |r|/ℓ for an
//! element of length ℓ at r: below 1e-6 of the weight wL up to EA/(wL) = 1e8 or so. A line stiffer than that is in equilibrium where its
//! residual is no larger than the bound; the roundings on the way from the unknowns to the forces are of the same size and not counted.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::rod::line::Line;
use crate::rod::motion::Weights;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::solve::newton::motion;
use nalgebra::SVector;

/// Unit roundoff u.
const ROUNDOFF: f64 = 0.5 * f64::EPSILON;

/// The bound of every component of the residual, from rounding of the unknowns; zero where they are prescribed.
pub fn bound(line: &dyn Line, state: &State) -> Field {
    let (mesh, at) = (line.mesh(), motion(state));
    let mut matrix = BlockTridiagonal::new(mesh.ties());
    line.tangent(&at, &Weights { u: 1.0, v: 0.0, a: 0.0 }, None, &mut matrix);
    let nodes = mesh.nodes();
    let sizes: Vec<SVector<f64, COMPONENTS>> =
        (0..nodes).map(|node| SVector::from_fn(|c, _| ROUNDOFF * state.u.component(c)[node].abs())).collect();
    for block in matrix.diagonal.iter_mut().chain(&mut matrix.upper).chain(&mut matrix.lower) {
        *block = block.abs();
    }
    let mut sums = sizes.clone();
    matrix.multiply(&sizes, &mut sums);
    let mut bound = Field::new(nodes);
    for (node, sum) in sums.iter().enumerate() {
        (0..COMPONENTS).for_each(|c| bound.component_mut(c)[node] = sum[c]);
    }
    for &(node, component) in line.fixed() {
        bound.component_mut(component)[node] = 0.0;
    }
    bound
}
