//! What holds a node: springs, dampers and locks along three axes of any orientation, about a reference that may move.
//!
//! ```text
//! R = Σ_i n_i [ k_i n_i·(r - r_0) + c_i n_i·(ṙ - ṙ_0) ] - F,   n_i·(r - r_0) = 0 along locked axes
//! ```
//!
//! n_i unit axes, k_i [N/m], c_i [N·s/m], r_0(t) the reference, F dead force [N], R force to be applied from outside [N]. Where axes
//! are locked, the equations and unknowns of the node are projected on what is left, P = I - Σ n nᵀ over the locked axes: the
//! residual there is P R (the rest is the lock's reaction), the tangent P K P + σ (I - P), so that an increment has no part along
//! a locked axis, whatever its orientation. The motion itself is prescribed along it. A number σ of the size of K leaves the matrix
//! as well conditioned as it was.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::sinusoid::Sinusoid;
use crate::rod::motion::{Motion, Weights};
use crate::rod::state::Field;
use nalgebra::{Matrix3, Vector3};

/// The hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Hold {
    /// First of the nodes that share the position: the node itself, or the one before a joint.
    pub first: usize,
    /// Node, the last of them.
    pub node: usize,
    /// Unit axes, one per row.
    pub axes: Matrix3<f64>,
    /// r_0 at rest [m]; none: not known yet, and springs and locks do not act.
    pub reference: Option<Vector3<f64>>,
    /// Its motion along the axes [m].
    pub motion: Option<Sinusoid>,
    /// k_i [N/m].
    pub stiffness: Vector3<f64>,
    /// c_i [N·s/m].
    pub damping: Vector3<f64>,
    /// Locked axes.
    pub locked: [bool; 3],
    /// F [N].
    pub force: Vector3<f64>,
}

/// Unit axes, one per row, from a first direction and a second that is made perpendicular to it.
pub fn axes(directions: &[[f64; 3]; 2]) -> Matrix3<f64> {
    let first = Vector3::from(directions[0]).normalize();
    let second = Vector3::from(directions[1]);
    let second = (second - first * first.dot(&second)).normalize();
    Matrix3::from_rows(&[first.transpose(), second.transpose(), first.cross(&second).transpose()])
}

impl Hold {
    /// Position, velocity and acceleration of the reference at a time, where it is known.
    pub fn reference_at(&self, time: f64) -> Option<[Vector3<f64>; 3]> {
        let [x, v, a] = self.motion.map_or([Vector3::zeros(); 3], |motion| motion.at(time).map(|x| self.axes.tr_mul(&x)));
        self.reference.map(|reference| [reference + x, v, a])
    }

    /// Springs, dampers and dead force R [N].
    pub fn force(&self, at: &Motion) -> Vector3<f64> {
        let Some([x, v, _]) = self.reference_at(at.clock.now) else { return -self.force };
        let (r, rate) = (at.u.position(self.node), at.v.position(self.node));
        let along = self.stiffness.component_mul(&(self.axes * (r - x))) + self.damping.component_mul(&(self.axes * (rate - v)));
        self.axes.tr_mul(&along) - self.force
    }

    /// c_u ∂R/∂u + c_v ∂R/∂v.
    pub fn tangent(&self, weights: &Weights) -> Matrix3<f64> {
        if self.reference.is_none() {
            return Matrix3::zeros();
        }
        if self.reference.is_none() {
            return Matrix3::zeros();
        }
        let along = Matrix3::from_diagonal(&(self.stiffness * weights.u + self.damping * weights.v));
        self.axes.tr_mul(&(along * self.axes))
    }

    /// Whether any axis is locked.
    pub fn locks(&self) -> bool {
        self.reference.is_some() && self.locked.contains(&true)
    }

    /// P.
    fn free(&self) -> Matrix3<f64> {
        let free = Vector3::from_fn(|axis, _| if self.locked[axis] { 0.0 } else { 1.0 });
        self.axes.tr_mul(&(Matrix3::from_diagonal(&free) * self.axes))
    }

    /// Takes the part along locked axes from a force on the node.
    pub fn project(&self, out: &mut Field) {
        let force = self.free() * out.position(self.node);
        out.set_position(self.node, &force);
    }

    /// Projects the equations and unknowns of the node.
    pub fn project_matrix(&self, matrix: &mut BlockTridiagonal<6>) {
        let free = self.free();
        for node in self.first..=self.node {
            let mut rows = matrix.diagonal[node].fixed_rows_mut::<3>(0);
            rows.copy_from(&(free * &rows));
            let mut columns = matrix.diagonal[node].fixed_columns_mut::<3>(0);
            columns.copy_from(&(&columns * free));
            if node > 0 {
                let mut rows = matrix.lower[node - 1].fixed_rows_mut::<3>(0);
                rows.copy_from(&(free * &rows));
                let mut columns = matrix.upper[node - 1].fixed_columns_mut::<3>(0);
                columns.copy_from(&(&columns * free));
            }
            if node < matrix.upper.len() {
                let mut rows = matrix.upper[node].fixed_rows_mut::<3>(0);
                rows.copy_from(&(free * &rows));
                let mut columns = matrix.lower[node].fixed_columns_mut::<3>(0);
                columns.copy_from(&(&columns * free));
            }
        }
        let mut own = matrix.diagonal[self.node].fixed_view_mut::<3, 3>(0, 0);
        let size = own.amax();
        own += (Matrix3::identity() - free) * if size > 0.0 { size } else { 1.0 };
    }

    /// Sets the position (order 0), velocity (1) or acceleration (2) of the node along locked axes to that of the reference.
    pub fn place(&self, order: usize, field: &mut Field, time: f64) {
        let Some(reference) = self.reference_at(time) else { return };
        let (x, prescribed) = (field.position(self.node), reference[order]);
        let placed = prescribed + self.free() * (x - prescribed);
        (self.first..=self.node).for_each(|node| field.set_position(node, &placed));
    }
}
