//! Lines that hang on free bodies and points, as one system: a rod of all their elements side by side, and behind it a node for each body and point.
//!
//! An end that hangs on a body goes with it,
//!
//! ```text
//! r = X + R a,   ṙ = V + ω × R a,   r̈ = A + α × R a + ω × (ω × R a),   δr = δX + J δϑ × R a = B (δX, δϑ)
//! ```
//!
//! and its force reaches the body as Bᵀ f. Ends on what is driven are prescribed.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::rotation;
use crate::rod::clamp::Clamp;
use crate::rod::line::Line;
use crate::rod::motion::{Asking, Motion, Weights};
use crate::rod::rigid::Rigid;
use crate::rod::state::{Field, State};
use crate::rod::system::{Links, System};
use crate::solve::motion::Path;
use nalgebra::{Matrix3, Matrix3x6, Vector3};
use std::ops::AddAssign;
use std::sync::Mutex;

/// The network.
pub struct Network {
    /// All lines side by side, and nodes of bodies and points.
    pub rod: Box<dyn Line>,
    /// Free bodies.
    pub bodies: Vec<Rigid>,
    /// What hangs on what.
    pub links: Links,
    /// Of each link, its place in the axes of its body; none: on a point.
    pub arms: Vec<Option<Vector3<f64>>>,
    /// Ends that are driven, and their paths.
    pub driven: Vec<(usize, Path)>,
    /// Nodes of points, and the constant forces on them [N].
    pub pulls: Vec<(usize, Vector3<f64>)>,
    /// Prescribed unknowns.
    pub fixed: Vec<(usize, usize)>,
    /// Error allowed to the finest line over that allowed to each line, in the order of the ranges of `links`, and to each master.
    pub shares: Vec<f64>,
    /// Room for forces of the tangent.
    room: Mutex<Field>,
}

impl Network {
    /// Displacement of a hanging node per unit of its master's six unknowns.
    fn lever(&self, number: usize, at: &Motion) -> Matrix3x6<f64> {
        let mut lever = Matrix3x6::zeros();
        lever.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        let link = &self.links.links[number];
        if let (Some(arm), Some(body)) = (self.arms[number], self.body_at(self.links.masters[link.master])) {
            let turned = body.motion(at).rotation * arm;
            let by_turn = -rotation::cross(&turned) * rotation::jacobian(&at.u.slope(body.node));
            lever.fixed_view_mut::<3, 3>(0, 3).copy_from(&by_turn);
        }
        lever
    }

    /// A network; `driven` ends are fixed for the solver.
    pub fn new(
        rod: Box<dyn Line>,
        bodies: Vec<Rigid>,
        links: Links,
        arms: Vec<Option<Vector3<f64>>>,
        driven: Vec<(usize, Path)>,
        pulls: Vec<(usize, Vector3<f64>)>,
        slopes_of: &[usize],
    ) -> Network {
        let mut fixed = rod.fixed().to_vec();
        fixed.extend(driven.iter().flat_map(|(node, _)| (0..3).map(|c| (*node, c))));
        fixed.extend(slopes_of.iter().flat_map(|node| (3..6).map(|c| (*node, c))));
        fixed.sort_unstable();
        fixed.dedup();
        let room = Mutex::new(Field::new(rod.nodes()));
        let shares = vec![1.0; links.ranges.len() + links.masters.len()];
        Network { rod, bodies, links, arms, driven, pulls, fixed, shares, room }
    }

    /// Lets clamped ends go with the bodies that drive them.
    pub fn clamp(&mut self) {
        for (node, path) in &self.driven {
            if let Path::OnBody { body, .. } = path {
                self.rod.clamp_to(*node, body);
            }
        }
    }

    /// Power of the moment on the body that drives an end, where that is clamped to it [W].
    pub fn clamp_power(&self, node: usize, path: &Path, at: &Motion) -> f64 {
        let Path::OnBody { body, .. } = path else { return 0.0 };
        if !self.rod.clamps().iter().any(|clamp| clamp.node == node) {
            return 0.0;
        }
        self.rod.end_moment(node, at).dot(&body.at(at.clock.now).omega)
    }

    /// The clamps on free bodies, in the order of `Links::clamped`, and these.
    fn clamps(&self) -> impl Iterator<Item = (&Clamp, &Rigid)> {
        self.links.clamped.iter().filter_map(|link| {
            let clamp = self.rod.clamps().iter().find(|clamp| clamp.node == link.node)?;
            Some((clamp, self.bodies.get(link.master)?))
        })
    }

    fn body_at(&self, node: usize) -> Option<&Rigid> {
        self.bodies.iter().find(|body| body.node == node)
    }

    /// Sets the error allowed to each line [m], the finest of them `finest`; bodies and points have that of the finest line on them.
    pub fn allow(&mut self, errors: &[f64], finest: f64) {
        let lines = self.links.ranges.len();
        self.shares.fill(1.0);
        for (share, error) in self.shares.iter_mut().zip(errors) {
            *share = (finest / error).min(1.0);
        }
        for master in 0..self.links.masters.len() {
            let on = self.links.links.iter().filter(|link| link.master == master);
            let most = on.map(|link| self.shares[link.line]).fold(0.0, f64::max);
            self.shares[lines + master] = if most > 0.0 { most } else { 1.0 };
        }
    }

    /// Forces that reach bodies and points at a motion: the residual with that of hanging ends taken to their masters.
    pub fn gathered(&self, at: &Motion, out: &mut Field) {
        self.residual(at, out);
        self.gather(at, out);
        self.fixed.iter().for_each(|&(node, component)| out.component_mut(component)[node] = 0.0);
    }
}

impl System for Network {
    fn nodes(&self) -> usize {
        self.rod.nodes()
    }

    fn ties(&self) -> Vec<bool> {
        self.rod.ties()
    }

    fn fixed(&self) -> &[(usize, usize)] {
        &self.fixed
    }

    fn is_planar(&self) -> bool {
        false
    }

    fn place(&self, order: usize, field: &mut Field, time: f64) {
        for (node, path) in &self.driven {
            let at = path.at(time);
            field.set_position(*node, &[at.position, at.velocity, at.acceleration][order]);
        }
        self.rod.place(order, field, time);
    }

    fn residual(&self, at: &Motion, out: &mut Field) {
        self.residual_of(at, &[(0, self.rod.nodes())], out);
    }

    fn residual_of(&self, at: &Motion, runs: &[(usize, usize)], out: &mut Field) {
        self.rod.residual_of(at, runs, out);
        for body in &self.bodies {
            let [force, moment] = body.residual(at);
            out.set_position(body.node, &force);
            out.set_slope(body.node, &moment);
        }
        for (clamp, body) in self.clamps() {
            let (moment, _) = clamp.on_body(at);
            out.set_slope(body.node, &(out.slope(body.node) + rotation::jacobian(&at.u.slope(body.node)).tr_mul(&moment)));
        }
        for (node, force) in &self.pulls {
            out.set_position(*node, &(out.position(*node) - force));
        }
    }

    fn tangent(&self, at: &Motion, weights: &Weights, geometric: Option<&[f64]>, matrix: &mut BlockTridiagonal<6>) {
        matrix.clear();
        self.tangent_of(at, weights, geometric, &[(0, self.rod.nodes())], matrix);
    }

    fn tangent_of(
        &self,
        at: &Motion,
        weights: &Weights,
        geometric: Option<&[f64]>,
        runs: &[(usize, usize)],
        matrix: &mut BlockTridiagonal<6>,
    ) {
        self.rod.tangent_of(at, weights, geometric, runs, matrix);
        for body in &self.bodies {
            matrix.diagonal[body.node] = body.tangent(at, weights);
        }
        if weights.u == 0.0 || self.bodies.is_empty() {
            return;
        }
        // The moment of an end force turns with the body.
        let mut room = self.room.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        self.rod.residual(at, &mut room);
        for (link, arm) in self.links.links.iter().zip(&self.arms) {
            let (Some(arm), Some(body)) = (arm, self.body_at(self.links.masters[link.master])) else { continue };
            let lever = body.motion(at).rotation * arm;
            let turned = rotation::cross(&room.position(link.node)) * rotation::cross(&lever) * weights.u;
            matrix.diagonal[body.node].fixed_view_mut::<3, 3>(3, 3).add_assign(turned);
        }
        for (clamp, body) in self.clamps() {
            let jacobian = rotation::jacobian(&at.u.slope(body.node));
            let turned = jacobian.tr_mul(&(clamp.on_body(at).1 * jacobian)) * weights.u;
            matrix.diagonal[body.node].fixed_view_mut::<3, 3>(3, 3).add_assign(turned);
        }
    }

    fn inertia(&self, at: &Motion, x: &Field, out: &mut Field) {
        self.rod.inertia(at, x, out);
        for body in &self.bodies {
            let (position, turn) = (x.position(body.node), x.slope(body.node));
            let mut six = nalgebra::Vector6::zeros();
            six.fixed_rows_mut::<3>(0).copy_from(&position);
            six.fixed_rows_mut::<3>(3).copy_from(&turn);
            let force = body.inertia(at) * six;
            out.set_position(body.node, &force.fixed_rows::<3>(0).into());
            out.set_slope(body.node, &force.fixed_rows::<3>(3).into());
        }
    }

    fn holding_nodes(&self) -> usize {
        self.rod.holding_nodes()
    }

    fn hold(&self, u: &Field, v: &Field, holds: &mut Field) {
        self.rod.hold(u, v, holds);
    }

    fn links(&self) -> Option<&Links> {
        Some(&self.links)
    }

    fn follow(&self, state: &mut State) {
        for (link, arm) in self.links.links.iter().zip(&self.arms) {
            let master = self.links.masters[link.master];
            let (position, velocity, acceleration) = match (arm, self.body_at(master)) {
                (Some(arm), Some(body)) => {
                    let State { clock, u, v, a, holds, frames } = &*state;
                    let motion = body.motion(&Motion { clock: *clock, u, v, a, holds, frames, asking: Asking::Alone });
                    let lever = motion.rotation * arm;
                    let (velocity, acceleration) = motion.at(&lever);
                    (motion.position + lever, velocity, acceleration)
                }
                _ => (state.u.position(master), state.v.position(master), state.a.position(master)),
            };
            state.u.set_position(link.node, &position);
            state.v.set_position(link.node, &velocity);
            state.a.set_position(link.node, &acceleration);
        }
    }

    fn recentre(&self, state: &mut State) {
        for body in &self.bodies {
            let State { clock, u, v, a, holds, frames } = &*state;
            let motion = body.motion(&Motion { clock: *clock, u, v, a, holds, frames, asking: Asking::Alone });
            if let Some(frame) = state.frames.get_mut(body.frame) {
                *frame = orthonormal(&motion.rotation);
            }
            state.u.set_slope(body.node, &Vector3::zeros());
            state.v.set_slope(body.node, &motion.omega);
            state.a.set_slope(body.node, &motion.alpha);
        }
    }

    fn loose(&self, increment: &Field, number: usize) -> f64 {
        let node = self.links.masters[number];
        let turn = self.body_at(node).map_or(0.0, |body| body.reach() * increment.slope(node).norm());
        increment.position(node).norm().max(turn)
    }

    fn gather(&self, at: &Motion, out: &mut Field) {
        for (number, link) in self.links.links.iter().enumerate() {
            let six = self.lever(number, at).tr_mul(&out.position(link.node));
            let master = self.links.masters[link.master];
            out.set_position(master, &(out.position(master) + six.fixed_rows::<3>(0)));
            out.set_slope(master, &(out.slope(master) + six.fixed_rows::<3>(3)));
            out.set_position(link.node, &Vector3::zeros());
        }
    }

    fn error_size(&self, error: &Field) -> f64 {
        let masters = self.links.masters.iter().map(|node| (*node, node + 1));
        let parts = self.links.ranges.iter().copied().chain(masters);
        parts.zip(&self.shares).fold(0.0, |largest, ((first, end), share)| {
            let size = share * error.largest_position(first, end);
            if size > largest || size.is_nan() { size } else { largest }
        })
    }

    fn levers(&self, at: &Motion, out: &mut [Matrix3x6<f64>]) {
        let (ends, directions) = out.split_at_mut(self.links.links.len());
        ends.iter_mut().enumerate().for_each(|(number, lever)| *lever = self.lever(number, at));
        for (lever, (clamp, body)) in directions.iter_mut().zip(self.clamps()) {
            lever.fill(0.0);
            let by_turn = -rotation::cross(&clamp.direction_at(at)) * rotation::jacobian(&at.u.slope(body.node));
            lever.fixed_view_mut::<3, 3>(0, 3).copy_from(&by_turn);
        }
    }

    fn crossed(&self, at: &Motion, number: usize) -> Matrix3<f64> {
        self.clamps().nth(number).map_or_else(Matrix3::zeros, |(clamp, _)| clamp.crossed(at))
    }
}

/// The rotation nearest to a matrix that is nearly one.
fn orthonormal(r: &Matrix3<f64>) -> Matrix3<f64> {
    // One step of Newton's method for the polar factor: what is off by ε is off by ε² after it.
    r * 1.5 - r * r.tr_mul(r) * 0.5
}
