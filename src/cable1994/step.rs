//! One time step of the report: one linear solve (eqs. 2.19 to 2.23 and 2.27, with the signs of the listing).
//!
//! ```text
//! (4/h² M + K) z + B δλ = 2 c - h K u̇,   Bᵀ z - F η L/EA δλ = d - h Bᵀ u̇,   F = 1 - C/h
//! u += h u̇ + z,   u̇ += 2 z/h,   λ += δλ
//! ```
//!
//! M, c, d, drag and the touching part of the mat are those of t_n; K and B those of u_n + h/2 u̇_n and of λ extrapolated to
//! n + ½. This is the trapezoidal rule solved once. d_n on the right pulls back what the constraint has missed so far. F acts
//! like a Kelvin–Voigt time constant C, and is stable for h > 2 C only. The velocity of the fairlead is prescribed, and its
//! position follows by the same trapezoid.

use crate::cable1994::line::{MixedLine, UNKNOWNS};
use crate::rod::state::State;
use nalgebra::Vector3;

/// A step whose system is singular, or that moves a node by more than the length of the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoStep {
    /// Node where it was noticed.
    pub node: usize,
}

/// The shortest step for a time constant C of the damping [s]: below it every step enlarges the last error.
pub fn shortest_step(damping: f64) -> f64 {
    2.0 * damping
}

impl MixedLine {
    /// Takes a step of length h after one of length `last_step` (0: none), at whose end the fairlead has a velocity. On a failure
    /// nothing has changed. `state.a` holds the change of the velocities over h.
    pub fn step(&mut self, state: &mut State, last_step: f64, h: f64, velocity: &Vector3<f64>) -> Result<(), NoStep> {
        self.system.clear();
        let share = if last_step > 0.0 { 0.5 * h / last_step } else { 0.0 };
        for e in 0..self.elements.len() {
            let terms = self.terms(e, state, 0.5 * h, share);
            self.scatter(e, &terms, state, h);
        }
        self.load(2.0);
        let last = self.nodes() - 1;
        for k in 0..self.supports.fixed.len() {
            let (node, c) = self.supports.fixed[k];
            let rate = if node == last && c < 3 { velocity[c] } else { 0.0 };
            self.system.prescribe(UNKNOWNS * node + c, 0.5 * h * (rate - state.v.component(c)[node]));
        }
        self.system.solve().map_err(|row| NoStep { node: row / UNKNOWNS })?;
        let length: f64 = self.elements.iter().map(|element| element.length).sum();
        let bounded = |node: &usize| {
            let z = &self.system.right[UNKNOWNS * node..][..UNKNOWNS];
            z[..3].iter().all(|z| z.abs() <= length) && z.iter().all(|z| z.is_finite())
        };
        if let Some(node) = (0..=last).find(|node| !bounded(node)) {
            return Err(NoStep { node });
        }
        for node in 0..=last {
            let z = &self.system.right[UNKNOWNS * node..][..UNKNOWNS];
            for (c, z) in z.iter().enumerate().take(6) {
                let change = h * state.v.component(c)[node] + z;
                state.u.component_mut(c)[node] += change;
                state.v.component_mut(c)[node] += 2.0 * z / h;
                state.a.component_mut(c)[node] = 2.0 * z / (h * h);
            }
            for (slot, change) in [2 * node, 2 * node + 1].into_iter().zip(&z[6..]) {
                self.tensions.before[slot] = self.tensions.now[slot];
                self.tensions.now[slot] += change;
            }
        }
        Ok(())
    }
}
