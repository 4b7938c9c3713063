//! Force of the water on a moving line (Morison), and its tangent.
//!
//! ```text
//! f = kn |qn| qn + kt |qt| qt t - an (a - (t·a) t) - at (t·a) t
//! q = V - ṙ,  qt = t·q,  qn = q - qt t,  t = r′/|r′|
//! kn = ½ ρ d Cn,  kt = ½ ρ π d Ct,  an = ρ (π/4) d² Cmn,  at = ρ (π/4) d² Cmt
//! ```
//!
//! f force on the line per unstretched length [N/m], V velocity of the water [m/s], a = r̈ [m/s²]. The water's own acceleration is
//! zero here (current only). Projector with the unit tangent: the 1994 report's I - r′r′ᵀ makes a stretched line swim.

use crate::algebra::lanes::{Real, Triple};
use crate::algebra::tensor::Tensor;
use crate::rod::element::Weights;
use crate::rod::stretch::Direction;
use crate::sea::current::Current;

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
}

/// Motion of a point of the line.
#[derive(Debug, Clone, Copy)]
pub struct PointMotion<F> {
    /// Direction of the line.
    pub direction: Direction<F>,
    /// Height z [m].
    pub height: F,
    /// Velocity [m/s].
    pub velocity: Triple<F>,
    /// Acceleration [m/s²].
    pub acceleration: Triple<F>,
}

/// Tangent of f, weighted.
#[derive(Debug, Clone, Copy)]
pub struct WaterTangent<F> {
    /// Change with position, velocity and acceleration together [N/m²].
    pub by_motion: Tensor<F>,
    /// Change with r′ [N/m].
    pub by_slope: Tensor<F>,
}

/// The water around the line.
pub trait Water: Clone + Send + Sync + 'static {
    /// False: there is no drag and no added mass, and the element loop does not look for them.
    const PRESENT: bool;
    /// Velocity V - ṙ of the water past a point that moves [m/s].
    fn past<F: Real>(&self, cpu: F::Cpu, height: F, velocity: Triple<F>) -> Triple<F>;
    /// Whether the water moves differently at different heights.
    const SHEARED: bool = false;
    /// Its change with height [1/s].
    #[inline(always)]
    fn shear<F: Real>(&self, cpu: F::Cpu, _: F) -> Triple<F> {
        Triple::zero(cpu)
    }
}

/// No hydrodynamic force at all.
#[derive(Debug, Clone, Copy)]
pub struct NoWater;

impl Water for NoWater {
    const PRESENT: bool = false;
    #[inline(always)]
    fn past<F: Real>(&self, _: F::Cpu, _: F, velocity: Triple<F>) -> Triple<F> {
        -velocity
    }
}

/// Water at rest.
#[derive(Debug, Clone, Copy)]
pub struct Still;

impl Water for Still {
    const PRESENT: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, _: F::Cpu, _: F, velocity: Triple<F>) -> Triple<F> {
        -velocity
    }
}

impl Water for Current {
    const PRESENT: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, height: F, velocity: Triple<F>) -> Triple<F> {
        self.added_to(cpu, height, -velocity)
    }
    const SHEARED: bool = true;
    #[inline(always)]
    fn shear<F: Real>(&self, cpu: F::Cpu, height: F) -> Triple<F> {
        Current::shear(self, cpu, height)
    }
}

/// Force f of the water on the line per unstretched length [N/m]. About 50 operations and a square root.
#[inline(always)]
pub fn force<F: Real, W: Water>(cpu: F::Cpu, water: &W, k: &Coefficients<F>, at: &PointMotion<F>) -> Triple<F> {
    let t = at.direction.tangent;
    let q = water.past(cpu, at.height, at.velocity);
    let qt = t.dot(q);
    let qn = t.mul_add(-qt, q);
    let speed_t = qt.max(-qt);
    let along = (k.drag_tangential * speed_t).mul_add(qt, (k.added_normal - k.added_tangential) * t.dot(at.acceleration));
    at.acceleration.mul_add(-k.added_normal, qn.mul_add(k.drag_normal * qn.length(), t * along))
}

/// Tangent of f, c_u ∂f/∂u + c_v ∂f/∂v + c_a ∂f/∂a.
///
/// ```text
/// ∂f/∂q = kn (|qn| (1 - t tᵀ) + qn qnᵀ/|qn|) + 2 kt |qt| t tᵀ
/// dt = (1 - t tᵀ) dr′/|r′|,   dqt = qn·dr′/|r′|,   dqn = -(t qnᵀ + qt (1 - t tᵀ)) dr′/|r′|
/// ```
#[inline(always)]
pub fn tangent<F: Real, W: Water>(
    cpu: F::Cpu,
    water: &W,
    k: &Coefficients<F>,
    at: &PointMotion<F>,
    weights: &Weights,
) -> WaterTangent<F> {
    let t = at.direction.tangent;
    let q = water.past(cpu, at.height, at.velocity);
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
        let shear = water.shear(cpu, at.height) * F::splat(cpu, weights.u);
        let by_height = qn.mul_add(per_speed * qn.dot(shear), t.mul_add(sliding * t.dot(shear), shear * normal));
        by_motion.0[2] = by_motion.0[2] + by_height;
    }

    let at_t = t.dot(at.acceleration);
    let at_n = at.acceleration - t * at_t;
    let alike = qt * (tangential - normal) + skew * at_t;
    let by_slope =
        Tensor::isotropic(cpu, alike).add_outer(t, qn * sliding + at_n * skew - t * alike).add_outer(qn, qn * (-qt * per_speed));
    WaterTangent { by_motion, by_slope: by_slope.times(at.direction.stretch.reciprocal() * weights.u) }
}
