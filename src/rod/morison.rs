//! Force of the water on a moving line (Morison), and its tangent.
//!
//! ```text
//! f = kn |qn| qn + kt |qt| qt t - an (a - (t·a) t) - at (t·a) t + b V̇/g
//! q = V - ṙ,  a = r̈ - V̇,  qt = t·q,  qn = q - qt t,  t = r′/|r′|
//! kn = ½ ρ d Cn,  kt = ½ ρ π d Ct,  an = ρ (π/4) d² Cmn,  at = ρ (π/4) d² Cmt
//! ```
//!
//! f force on the line per unstretched length [N/m] besides the buoyancy b [N/m], V velocity [m/s] and V̇ acceleration [m/s²] of the
//! water. b V̇/g, Froude & Krylov's force, is the pressure of the waves on the displaced water ρ A = b/g: b belongs to the volume, the
//! coefficients to the diameter. Projector with the unit tangent: the 1994 report's I - r′r′ᵀ makes a stretched line swim.
//!
//! The tangent leaves out that the waves change from place to place: in a step of length h this is h² ∂f/∂r against the mass, below
//! 1e-3 of it for h up to 0.1 s, and Newton's method converges as well without.

use crate::algebra::real::Real;
use crate::algebra::tensor::Tensor;
use crate::algebra::triple::Triple;
use crate::rod::motion::Weights;
use crate::rod::stretch::Direction;
use crate::sea::clock::Clock;
use crate::sea::current::Current;
use crate::sea::waves::{Flow, Waves};
use nalgebra::Vector3;

/// Coefficients of an element.
#[derive(Debug, Clone, Copy)]
pub struct Coefficients<F> {
    /// kn [kg/m²].
    pub drag_normal: F,
    /// kt [kg/m²].
    pub drag_tangential: F,
    /// an [kg/m].
    pub added_normal: F,
    /// at [kg/m].
    pub added_tangential: F,
    /// b [N/m].
    pub buoyancy: F,
}

impl Coefficients<f64> {
    /// The same in every lane.
    #[inline(always)]
    pub fn splat<F: Real>(&self, cpu: F::Cpu) -> Coefficients<F> {
        Coefficients {
            drag_normal: F::splat(cpu, self.drag_normal),
            drag_tangential: F::splat(cpu, self.drag_tangential),
            added_normal: F::splat(cpu, self.added_normal),
            added_tangential: F::splat(cpu, self.added_tangential),
            buoyancy: F::splat(cpu, self.buoyancy),
        }
    }
}

/// Motion of a point of the line.
#[derive(Debug, Clone, Copy)]
pub struct PointMotion<F: Real> {
    /// When.
    pub clock: Clock,
    /// Direction of the line.
    pub direction: Direction<F>,
    /// Position [m].
    pub place: Triple<F>,
    /// Velocity [m/s].
    pub velocity: Triple<F>,
    /// Acceleration [m/s²].
    pub acceleration: Triple<F>,
}

/// Tangent of f, weighted.
#[derive(Debug, Clone, Copy)]
pub struct WaterTangent<F: Real> {
    /// Change with position, velocity and acceleration together [N/m²].
    pub by_motion: Tensor<F>,
    /// Change with r′ [N/m].
    pub by_slope: Tensor<F>,
}

/// Motion of the water past a point of the line.
#[derive(Debug, Clone, Copy)]
pub struct Past<F: Real> {
    /// V - ṙ [m/s].
    pub velocity: Triple<F>,
    /// V̇ [m/s²]; zero and not looked at where there are no waves.
    pub acceleration: Triple<F>,
}

/// The water around the line.
pub trait Water: Clone + Send + Sync + 'static {
    /// False: there is no drag and no added mass, and the element loop does not look for them.
    const PRESENT: bool;
    /// False: the water has no acceleration and its surface is z = 0.
    const WAVES: bool = false;
    /// Whether the water moves differently at different heights, waves apart.
    const SHEARED: bool = false;
    /// Motion of the water past a point.
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F>;
    /// The same where the motion of the waves is known.
    #[inline(always)]
    fn past_with<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>, _: &Flow<F>) -> Past<F> {
        self.past(cpu, at)
    }
    /// The waves, if there are any.
    fn waves(&self) -> Option<&Waves> {
        None
    }
    /// Change of V with height [1/s], waves apart.
    #[inline(always)]
    fn shear<F: Real>(&self, cpu: F::Cpu, _: F) -> Triple<F> {
        Triple::zero(cpu)
    }
    /// g [m/s²]; asked for where there are waves only.
    fn gravity(&self) -> f64 {
        1.0
    }
    /// Height of the surface at a place [m].
    fn elevation(&self, _: &Clock, _: &Vector3<f64>) -> f64 {
        0.0
    }
    /// Height below which the surface never falls [m].
    fn lowest_surface(&self) -> f64 {
        0.0
    }
}

impl<F: Real> Past<F> {
    /// Water without acceleration.
    #[inline(always)]
    fn steady(cpu: F::Cpu, velocity: Triple<F>) -> Past<F> {
        Past { velocity, acceleration: Triple::zero(cpu) }
    }
}

/// No hydrodynamic force at all.
#[derive(Debug, Clone, Copy)]
pub struct NoWater;

impl Water for NoWater {
    const PRESENT: bool = false;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F> {
        Past::steady(cpu, -at.velocity)
    }
}

/// Water at rest.
#[derive(Debug, Clone, Copy)]
pub struct Still;

impl Water for Still {
    const PRESENT: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F> {
        Past::steady(cpu, -at.velocity)
    }
}

impl Water for Current {
    const PRESENT: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F> {
        Past::steady(cpu, self.added_to(cpu, at.place.z, -at.velocity))
    }
    const SHEARED: bool = true;
    #[inline(always)]
    fn shear<F: Real>(&self, cpu: F::Cpu, height: F) -> Triple<F> {
        Current::shear(self, cpu, height)
    }
}

/// Waves, and the current that they run on; neither changes the other.
#[derive(Debug, Clone)]
pub struct Sea {
    /// The waves.
    pub waves: Waves,
    /// The current; still water is one.
    pub current: Current,
}

impl Water for Sea {
    const PRESENT: bool = true;
    const WAVES: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F> {
        let steady = self.current.past(cpu, at);
        match self.waves.flow(cpu, &at.clock, &at.place) {
            Some(flow) => Past { velocity: steady.velocity + flow.velocity, acceleration: flow.acceleration },
            None => steady,
        }
    }
    #[inline(always)]
    fn past_with<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>, flow: &Flow<F>) -> Past<F> {
        let steady = self.current.past(cpu, at);
        Past { velocity: steady.velocity + flow.velocity, acceleration: flow.acceleration }
    }
    fn waves(&self) -> Option<&Waves> {
        Some(&self.waves)
    }
    const SHEARED: bool = true;
    #[inline(always)]
    fn shear<F: Real>(&self, cpu: F::Cpu, height: F) -> Triple<F> {
        self.current.shear(cpu, height)
    }
    fn gravity(&self) -> f64 {
        self.waves.gravity()
    }
    fn elevation(&self, clock: &Clock, place: &Vector3<f64>) -> f64 {
        self.waves.elevation(clock, place.x, place.y)
    }
    fn lowest_surface(&self) -> f64 {
        -self.waves.crest()
    }
}

/// Force f of the water that moves past the line per unstretched length [N/m]. About 50 operations and a square root.
#[inline(always)]
pub fn force_past<F: Real, W: Water>(water: &W, k: &Coefficients<F>, at: &PointMotion<F>, past: Past<F>) -> Triple<F> {
    let t = at.direction.tangent;
    let (q, a) = (past.velocity, if W::WAVES { at.acceleration - past.acceleration } else { at.acceleration });
    let qt = t.dot(q);
    let qn = t.mul_add(-qt, q);
    let speed_t = qt.max(-qt);
    let along = (k.drag_tangential * speed_t).mul_add(qt, (k.added_normal - k.added_tangential) * t.dot(a));
    let f = a.mul_add(-k.added_normal, qn.mul_add(k.drag_normal * qn.length(), t * along));
    if W::WAVES { past.acceleration.mul_add(k.buoyancy * (1.0 / water.gravity()), f) } else { f }
}

/// Tangent of f, c_u ∂f/∂u + c_v ∂f/∂v + c_a ∂f/∂a.
///
/// ```text
/// ∂f/∂q = kn (|qn| (1 - t tᵀ) + qn qnᵀ/|qn|) + 2 kt |qt| t tᵀ
/// dt = (1 - t tᵀ) dr′/|r′|,   dqt = qn·dr′/|r′|,   dqn = -(t qnᵀ + qt (1 - t tᵀ)) dr′/|r′|
/// ```
#[inline(always)]
pub fn tangent_past<F: Real, W: Water>(
    cpu: F::Cpu,
    water: &W,
    k: &Coefficients<F>,
    at: &PointMotion<F>,
    past: Past<F>,
    weights: &Weights,
) -> WaterTangent<F> {
    let t = at.direction.tangent;
    let (q, a) = (past.velocity, at.acceleration - past.acceleration);
    let qt = t.dot(q);
    let qn = t.mul_add(-qt, q);
    let speed = qn.length();
    let per_speed = k.drag_normal * speed.reciprocal();
    let normal = k.drag_normal * speed;
    let tangential = k.drag_tangential * qt.max(-qt);
    let sliding = tangential * 2.0 - normal;
    let skew = k.added_normal - k.added_tangential;

    let alike = normal * -weights.v - k.added_normal * weights.a;
    let mut by_motion = Tensor::isotropic(cpu, alike)
        .add_outer(t, t * (sliding * -weights.v + skew * weights.a))
        .add_outer(qn, qn * (per_speed * -weights.v));
    if W::SHEARED {
        let shear = water.shear(cpu, at.place.z) * F::splat(cpu, weights.u);
        let by_height = qn.mul_add(per_speed * qn.dot(shear), t.mul_add(sliding * t.dot(shear), shear * normal));
        by_motion.0[2] = by_motion.0[2] + by_height;
    }

    let at_t = t.dot(a);
    let at_n = a - t * at_t;
    let alike = qt * (tangential - normal) + skew * at_t;
    let by_slope =
        Tensor::isotropic(cpu, alike).add_outer(t, qn * sliding + at_n * skew - t * alike).add_outer(qn, qn * (-qt * per_speed));
    WaterTangent { by_motion, by_slope: by_slope.times(at.direction.stretch.reciprocal() * weights.u) }
}
