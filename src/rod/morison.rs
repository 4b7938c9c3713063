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

use crate::algebra::lanes::{Real, Triple, length};
use crate::rod::stretch::Direction;
use crate::sea::current::Current;
use nalgebra::{Matrix3, Vector3};

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

/// Tangent of f.
#[derive(Debug, Clone, Copy)]
pub struct WaterTangent {
    /// ∂f/∂z, the change with height [N/m²].
    pub by_height: Vector3<f64>,
    /// ∂f/∂r′ [N/m].
    pub by_slope: Matrix3<f64>,
    /// ∂f/∂ṙ [N·s/m²].
    pub by_velocity: Matrix3<f64>,
    /// ∂f/∂r̈ [kg/m].
    pub by_acceleration: Matrix3<f64>,
}

/// The water around the line.
pub trait Water: Clone + Send + Sync + 'static {
    /// False: there is no drag and no added mass, and the element loop does not look for them.
    const PRESENT: bool;
    /// Velocity V - ṙ of the water past a point that moves [m/s].
    fn past<F: Real>(&self, cpu: F::Cpu, height: F, velocity: Triple<F>) -> Triple<F>;
    /// Its change with height [1/s].
    fn shear(&self, height: f64) -> Vector3<f64>;
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
    fn shear(&self, _: f64) -> Vector3<f64> {
        Vector3::zeros()
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
    fn shear(&self, _: f64) -> Vector3<f64> {
        Vector3::zeros()
    }
}

impl Water for Current {
    const PRESENT: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, height: F, velocity: Triple<F>) -> Triple<F> {
        self.added_to(cpu, height, -velocity)
    }
    fn shear(&self, height: f64) -> Vector3<f64> {
        Current::shear(self, height)
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

/// Tangent of f.
pub fn tangent<W: Water>(water: &W, k: &Coefficients<f64>, at: &PointMotion<f64>) -> WaterTangent {
    let stretch = at.direction.stretch;
    let (t, acceleration) = (Vector3::from(at.direction.tangent), Vector3::from(at.acceleration));
    let along = t * t.transpose();
    let across = Matrix3::identity() - along;
    let q = Vector3::from(water.past((), at.height, at.velocity));
    let qt = t.dot(&q);
    let qn = q - t * qt;
    let speed = length(&qn);
    let squared = |w: &Vector3<f64>| (across * speed + qn * w.transpose() / speed) * k.drag_normal;

    // ∂qn/∂q = across; ∂qt/∂q = t.
    let by_flow = squared(&qn) + along * (2.0 * k.drag_tangential * qt.abs());
    // dt = across dp / |p|; dqt = qn·dp/|p|; dqn = -(t qnᵀ + qt across) dp / |p|.
    let turning = -(t * qn.transpose() + across * qt);
    let normal = (Matrix3::identity() * speed + qn * qn.transpose() / speed) * turning * k.drag_normal;
    let tangential = (t * qn.transpose() * 2.0 + across * qt) * (k.drag_tangential * qt.abs());
    let a_t = t.dot(&acceleration);
    let a_n = acceleration - t * a_t;
    let inertia = (t * a_n.transpose() + across * a_t) * (k.added_normal - k.added_tangential);
    WaterTangent {
        by_height: by_flow * water.shear(at.height),
        by_slope: (normal + tangential + inertia) / stretch,
        by_velocity: -by_flow,
        by_acceleration: -(across * k.added_normal + along * k.added_tangential),
    }
}
