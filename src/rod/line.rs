//! The discrete line: `Line`, the seam to statics and outputs, and `Rod`, its one implementation.
//!
//! Below the seam all is monomorphised for the physics that the scene needs; above it nothing is generic.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::dimension::Dimension;
use crate::algebra::triple::Triple;
use crate::rod::awash::Surface;
use crate::rod::bending::Bending;
use crate::rod::body::Body;
use crate::rod::clamp::{Clamp, Holder};
use crate::rod::element::{self, Table};
use crate::rod::element_tangent;
use crate::rod::flows::Flows;
use crate::rod::hold::Hold;
use crate::rod::joint;
use crate::rod::lying::Lying;
use crate::rod::mesh::Mesh;
use crate::rod::morison::Water;
use crate::rod::motion::{Asking, Motion, Weights};
use crate::rod::pose::PosePath;
use crate::rod::seabed::Bed;
use crate::rod::state::Field;
use crate::rod::stretch::Stretch;
use crate::rod::system::System;
use crate::rod::touching::Ground;
use crate::sea::beside::Beside;
use nalgebra::Vector3;
use std::marker::PhantomData;
use std::ops::AddAssign;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A discrete line, as far as more is asked of it than a time step needs.
pub trait Line: System {
    /// The elements.
    fn mesh(&self) -> &Mesh;
    /// Whether a node is pinned, by prescribed components of its position.
    fn is_pinned(&self, node: usize) -> bool {
        (0..3).all(|c| self.fixed().contains(&(node, c)))
    }
    /// Weight of what hangs on the line, and dead forces at its nodes [N]: sizes of forces, for comparison.
    fn burden(&self) -> f64;
    /// Tension at each Gauss point after a change of u, to first order [N]; three per element.
    fn linear_tensions(&self, u: &Field, change: &Field, out: &mut [f64]);
    /// Tension at each Gauss point [N]; three per element.
    fn tensions(&self, u: &Field, v: &Field, out: &mut [f64]);
    /// Force [N] that the fairlead side exerts on the anchor side at every node (so at the anchor: the force of the line on it).
    fn node_forces(&self, at: &Motion, out: &mut [Vector3<f64>]);
    /// Force that what holds a pinned end applies to the bodies at that end [N]; zero at any other node, where nothing but the line holds
    /// them.
    fn held_bodies(&self, node: usize, at: &Motion) -> Vector3<f64>;
    /// Force on what holds the fairlead [N]: of the line, and of the bodies at the fairlead where it is pinned.
    fn end_force(&self, at: &Motion) -> Vector3<f64>;
    /// Moment on what holds an end that is clamped [N·m]; zero at any other node.
    fn end_moment(&self, node: usize, at: &Motion) -> Vector3<f64>;
    /// Lets a clamped end go with the motion of a body.
    fn clamp_to(&mut self, node: usize, body: &Arc<PosePath>);
    /// Its clamped ends.
    fn clamps(&self) -> &[Clamp];
    /// Unstretched length of element `e` in contact with the bed [m].
    fn touching_length(&self, u: &Field, e: usize) -> f64;
    /// Unstretched length in contact with the bed [m].
    fn grounded_length(&self, u: &Field) -> f64 {
        (0..self.mesh().elements.len()).map(|e| self.touching_length(u, e)).sum()
    }
    /// Places of the bed to which a line holds on that was laid slack, from its anchor on, to where it lies now, and then stretched.
    fn lay(&self, u: &Field, holds: &mut Field);
}

/// A line with a law of extension, water and bending chosen at load time.
pub struct Rod<S, W, B, D> {
    mesh: Mesh,
    table: Table,
    water: W,
    ground: Option<Ground>,
    /// The bed, where it is of springs alone.
    bed: Option<Bed>,
    /// The bed, where it dissipates.
    lying: Option<Lying>,
    surface: Option<Surface>,
    /// What the waves do in a stage.
    flows: Option<Mutex<Flows>>,
    /// What the points of elements that pierce the surface keep of the sea.
    piercing: Option<Mutex<Beside>>,
    joints: Vec<usize>,
    /// Joints that transmit a moment, and their rotational stiffness [N·m].
    stiff_joints: Vec<(usize, f64)>,
    supports: Supports,
    laws: PhantomData<(S, B, D)>,
}

/// What holds a line and what pulls at its nodes besides its own loads.
#[derive(Debug, Clone, Default)]
pub struct Supports {
    /// Prescribed unknowns, as (node, component): 0–2 position, 3–5 slope.
    pub fixed: Vec<(usize, usize)>,
    /// Dead forces on nodes [N].
    pub loads: Vec<(usize, Vector3<f64>)>,
    /// Bodies on nodes.
    pub bodies: Vec<Body>,
    /// Springs, dampers, locks and dead forces at nodes.
    pub holds: Vec<Hold>,
    /// Clamped ends.
    pub clamps: Vec<Clamp>,
}

impl<S: Stretch, W: Water, B: Bending, D: Dimension> Rod<S, W, B, D> {
    /// A line of a mesh in given surroundings.
    pub fn new(mesh: Mesh, water: W, ground: Option<Ground>, surface: Option<Surface>, supports: Supports) -> Self {
        let table = Table::new(&mesh, surface.as_ref().map(|_| water.lowest_surface()));
        let lying = ground.as_ref().and_then(Lying::new);
        let bed = ground.as_ref().filter(|_| lying.is_none()).map(|ground| Bed::new(ground.plane, &ground.resistance));
        let joints = (0..table.len()).filter(|e| table.is_joint(*e) && !mesh.gaps.contains(e)).collect();
        let stiff_joints = joint::stiffnesses(&mesh).into_iter().enumerate().filter(|(_, kappa)| *kappa > 0.0).collect();
        let flows = water.waves().map(|waves| {
            let of = |number: &dyn Fn(usize) -> f64| (0..table.len()).map(number).collect();
            Mutex::new(Flows::new(waves, of(&|e| table.length_of(e)), of(&|e| table.waterline_of(e))))
        });
        let piercing = water.waves().filter(|_| surface.is_some()).and_then(Surface::beside).map(Mutex::new);
        Rod {
            mesh,
            table,
            water,
            ground,
            bed,
            lying,
            surface,
            flows,
            piercing,
            joints,
            stiff_joints,
            supports,
            laws: PhantomData,
        }
    }

    /// The motion of the waves as the stage of a motion has it, or, `anew`, where the line is; none: it is to be asked for there.
    fn flows_of(&self, at: &Motion, anew: bool) -> Option<MutexGuard<'_, Flows>> {
        let (Some(waves), Some(flows)) = (self.water.waves(), &self.flows) else { return None };
        if !anew && at.asking == Asking::Alone {
            return None;
        }
        let mut flows = flows.lock().unwrap_or_else(PoisonError::into_inner);
        if anew && !flows.is_cheap() {
            return None;
        }
        flows.update(waves, at, anew);
        Some(flows)
    }

    /// Forces on tied nodes, which have one position, go to the second of them.
    fn share_ties(&self, out: &mut Field) {
        for &e in &self.joints {
            out.set_position(e + 1, &(out.position(e + 1) + out.position(e)));
            out.set_position(e, &Vector3::zeros());
        }
    }

    /// Takes the reactions of locks out of the residual.
    fn project(&self, out: &mut Field) {
        self.supports.holds.iter().filter(|hold| hold.locks()).for_each(|hold| hold.project(out));
    }

    fn kept(&self) -> Option<MutexGuard<'_, Beside>> {
        Some(self.piercing.as_ref()?.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// What a bed that touches in part and a surface above some of it add to the forces on the ends of element `e`.
    fn partial_forces(&self, at: &Motion, e: usize, touching: bool, dry: bool) -> [Option<[Triple<f64>; 4]>; 2] {
        let ground = self.ground.as_ref().filter(|_| touching).and_then(|ground| ground.forces(&self.table, at, e));
        let surface = self.surface.as_ref().filter(|_| dry).and_then(|surface| {
            let mut kept = self.kept();
            surface.forces(&self.table, &self.water, kept.as_deref_mut(), at, e)
        });
        [ground, surface]
    }

    /// All forces on the ends of element `e`.
    fn element_forces(&self, at: &Motion, e: usize) -> [Triple<f64>; 4] {
        let acting = element::forces::<S, W, B>(&self.table, &self.water, self.bed.as_ref(), at, e);
        let mut sum = acting.ends;
        for part in
            self.partial_forces(at, e, acting.touching > 0.0 || self.lying.is_some(), acting.dry > 0.0).into_iter().flatten()
        {
            (0..4).for_each(|k| sum[k] = sum[k] + part[k]);
        }
        sum
    }
}

impl<S: Stretch, W: Water, B: Bending, D: Dimension> System for Rod<S, W, B, D> {
    fn nodes(&self) -> usize {
        self.mesh.nodes()
    }

    fn ties(&self) -> Vec<bool> {
        self.mesh.ties()
    }

    fn fixed(&self) -> &[(usize, usize)] {
        &self.supports.fixed
    }

    fn is_planar(&self) -> bool {
        D::PLANAR
    }

    fn place(&self, order: usize, field: &mut Field, time: f64) {
        self.supports.holds.iter().filter(|hold| hold.locks()).for_each(|hold| hold.place(order, field, time));
    }

    fn residual(&self, at: &Motion, out: &mut Field) {
        self.residual_of(at, &[(0, self.mesh.nodes())], out);
    }

    fn residual_of(&self, at: &Motion, runs: &[(usize, usize)], out: &mut Field) {
        out.fill(0.0);
        let partly = |e: usize, touching: bool, dry: bool, out: &mut Field| {
            for part in self.partial_forces(at, e, touching, dry).into_iter().flatten() {
                element::scatter_to_nodes(out, e, self.table.length_of(e), &part);
            }
        };
        let flows = self.flows_of(at, false);
        element::residual::<S, W, B, D>(&self.table, &self.water, self.bed.as_ref(), flows.as_deref(), at, runs, out, partly);
        drop(flows);
        if let Some((lying, ground)) = self.lying.as_ref().zip(self.ground.as_ref()) {
            lying.add_to(ground, &self.table, at, out);
        }
        for &(e, kappa) in &self.stiff_joints {
            let (p, q) = (at.u.slope(e), at.u.slope(e + 1));
            out.set_slope(e, &(out.slope(e) + joint::moment(kappa, &p, &q)));
            out.set_slope(e + 1, &(out.slope(e + 1) + joint::moment(kappa, &q, &p)));
        }
        for (node, force) in &self.supports.loads {
            out.set_position(*node, &(out.position(*node) - force));
        }
        for body in &self.supports.bodies {
            out.set_position(body.node, &(out.position(body.node) + body.force(&self.water, at)));
        }
        for hold in &self.supports.holds {
            out.set_position(hold.node, &(out.position(hold.node) + hold.force(at)));
        }
        for clamp in &self.supports.clamps {
            out.set_slope(clamp.node, &(out.slope(clamp.node) + clamp.moment(at)));
        }
        self.share_ties(out);
        self.project(out);
    }

    fn tangent(&self, at: &Motion, weights: &Weights, geometric: Option<&[f64]>, matrix: &mut BlockTridiagonal<6>) {
        matrix.clear();
        self.tangent_of(at, weights, geometric, &[(0, self.mesh.nodes())], matrix);
    }

    fn tangent_of(
        &self,
        at: &Motion,
        weights: &Weights,
        geometric: Option<&[f64]>,
        runs: &[(usize, usize)],
        matrix: &mut BlockTridiagonal<6>,
    ) {
        // A factor that is made again from a state must have the same bits: what a stage keeps is not looked at.
        let flows = self.flows_of(at, true);
        element_tangent::tangent::<S, W, B, D>(&self.table, &self.water, flows.as_deref(), at, weights, geometric, runs, matrix);
        for e in runs.iter().flat_map(|(first, end)| *first..end - 1) {
            if let Some(ground) = &self.ground {
                ground.tangent(&self.table, at, e, weights, matrix);
            }
            if let Some(surface) = self.surface.as_ref().filter(|_| flows.as_ref().is_none_or(|flows| flows.is_dry(e))) {
                surface.tangent(&self.table, &self.water, self.kept().as_deref_mut(), at, e, weights, matrix);
            }
        }
        for &(e, kappa) in &self.stiff_joints {
            let (p, q) = (at.u.slope(e), at.u.slope(e + 1));
            let ((below, across), (above, _)) = (joint::tangent(kappa, &p, &q), joint::tangent(kappa, &q, &p));
            matrix.diagonal[e].fixed_view_mut::<3, 3>(3, 3).add_assign(below * weights.u);
            matrix.diagonal[e + 1].fixed_view_mut::<3, 3>(3, 3).add_assign(above * weights.u);
            matrix.upper[e].fixed_view_mut::<3, 3>(3, 3).add_assign(across * weights.u);
            matrix.lower[e].fixed_view_mut::<3, 3>(3, 3).add_assign(across.transpose() * weights.u);
        }
        for body in &self.supports.bodies {
            let own = body.tangent(&self.water, at, weights);
            matrix.diagonal[body.node].fixed_view_mut::<3, 3>(0, 0).add_assign(own);
        }
        for hold in &self.supports.holds {
            matrix.diagonal[hold.node].fixed_view_mut::<3, 3>(0, 0).add_assign(hold.tangent(weights));
        }
        for clamp in &self.supports.clamps {
            matrix.diagonal[clamp.node].fixed_view_mut::<3, 3>(3, 3).add_assign(clamp.tangent(at, weights));
        }
        self.supports.holds.iter().filter(|hold| hold.locks()).for_each(|hold| hold.project_matrix(matrix));
    }

    fn inertia(&self, at: &Motion, x: &Field, out: &mut Field) {
        out.fill(0.0);
        element::inertia::<W>(&self.table, at.u, x, out);
        for body in &self.supports.bodies {
            out.set_position(body.node, &(out.position(body.node) + x.position(body.node) * body.inertia()));
        }
        self.share_ties(out);
        self.project(out);
    }

    fn holding_nodes(&self) -> usize {
        let rough = self.ground.as_ref().is_some_and(|ground| ground.friction.is_some());
        if rough { self.mesh.nodes() } else { 0 }
    }

    fn hold(&self, u: &Field, v: &Field, holds: &mut Field) {
        if let Some((lying, ground)) = self.lying.as_ref().zip(self.ground.as_ref()) {
            lying.hold(ground, &self.table, u, v, holds);
        }
    }
}

impl<S: Stretch, W: Water, B: Bending, D: Dimension> Line for Rod<S, W, B, D> {
    fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    fn burden(&self) -> f64 {
        let Supports { loads, bodies, holds, .. } = &self.supports;
        let dead = loads.iter().map(|(_, force)| force.norm()).chain(holds.iter().map(|hold| hold.force.norm()));
        dead.chain(bodies.iter().map(|body| body.net_weight().abs().max(0.1 * body.weight))).sum()
    }

    fn linear_tensions(&self, u: &Field, change: &Field, out: &mut [f64]) {
        element::linear_tensions::<S>(&self.table, u, change, out);
    }

    fn tensions(&self, u: &Field, v: &Field, out: &mut [f64]) {
        element::tensions::<S>(&self.table, u, v, out);
    }

    fn node_forces(&self, at: &Motion, out: &mut [Vector3<f64>]) {
        let partly = |e: usize, touching: bool, dry: bool, out: &mut [Vector3<f64>]| {
            for part in self.partial_forces(at, e, touching, dry).into_iter().flatten() {
                out[e + 1] += Vector3::from(part[2]);
                if e == 0 {
                    out[0] += Vector3::from(part[0]);
                }
            }
        };
        element::end_forces::<S, W, B>(&self.table, &self.water, self.bed.as_ref(), at, out, partly);
        if let Some((lying, ground)) = self.lying.as_ref().zip(self.ground.as_ref()) {
            lying.add_to_ends(ground, &self.table, at, out);
        }
        out[0] = -out[0];
        for &e in &self.joints {
            let acted_on = self.mesh.points.contains(&e);
            out[e + 1] = if acted_on { (-self.element_forces(at, e + 1)[0]).into() } else { out[e] };
        }
    }

    fn held_bodies(&self, node: usize, at: &Motion) -> Vector3<f64> {
        let bodies = self.supports.bodies.iter().filter(|body| body.node == node && self.is_pinned(node));
        bodies.map(|body| body.force(&self.water, at)).sum()
    }

    fn end_force(&self, at: &Motion) -> Vector3<f64> {
        let line = Vector3::from(self.element_forces(at, self.table.len() - 1)[2]);
        -line - self.held_bodies(self.last(), at)
    }

    fn end_moment(&self, node: usize, at: &Motion) -> Vector3<f64> {
        if !self.supports.clamps.iter().any(|clamp| clamp.node == node) {
            return Vector3::zeros();
        }
        // What the elements leave at the slope is what the clamp must give, whatever the clamp is at.
        let begins = node == 0 || self.mesh.gaps.contains(&(node - 1));
        let (e, end) = if begins { (node, 1) } else { (node - 1, 3) };
        let on_slope = Vector3::from(self.element_forces(at, e)[end]) * self.table.length_of(e);
        -at.u.slope(node).cross(&on_slope)
    }

    fn clamps(&self) -> &[Clamp] {
        &self.supports.clamps
    }

    fn clamp_to(&mut self, node: usize, body: &Arc<PosePath>) {
        let own = self.supports.clamps.iter_mut().filter(|clamp| clamp.node == node);
        own.for_each(|clamp| clamp.body = Holder::Driven(Arc::clone(body)));
    }

    fn lay(&self, u: &Field, holds: &mut Field) {
        if let Some(ground) = &self.ground {
            ground.lay(&self.table, u, holds);
        }
    }

    fn touching_length(&self, u: &Field, e: usize) -> f64 {
        self.ground.as_ref().map_or(0.0, |ground| ground.touching_length(&self.table, u, e))
    }
}
