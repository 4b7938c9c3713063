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

use crate::algebra::lanes::{Real, Triple, length};
use crate::rod::stretch::Direction;
use crate::sea::clock::Clock;
use crate::sea::current::Current;
use crate::sea::waves::Waves;
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
    /// b [N/m].
    pub buoyancy: F,
}

/// Motion of a point of the line.
#[derive(Debug, Clone, Copy)]
pub struct PointMotion<F> {
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

/// Motion of the water past a point of the line.
#[derive(Debug, Clone, Copy)]
pub struct Past<F> {
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
    /// Motion of the water past a point.
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F>;
    /// Change of V with height [1/s], waves apart.
    fn shear(&self, height: f64) -> Vector3<f64>;
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
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F> {
        Past::steady(cpu, -at.velocity)
    }
    fn shear(&self, _: f64) -> Vector3<f64> {
        Vector3::zeros()
    }
}

impl Water for Current {
    const PRESENT: bool = true;
    #[inline(always)]
    fn past<F: Real>(&self, cpu: F::Cpu, at: &PointMotion<F>) -> Past<F> {
        Past::steady(cpu, self.added_to(cpu, at.place.z, -at.velocity))
    }
    fn shear(&self, height: f64) -> Vector3<f64> {
        Current::shear(self, height)
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
    fn shear(&self, height: f64) -> Vector3<f64> {
        self.current.shear(height)
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

/// Force f of the water on the line per unstretched length [N/m]. About 50 operations and a square root.
#[inline(always)]
pub fn force<F: Real, W: Water>(cpu: F::Cpu, water: &W, k: &Coefficients<F>, at: &PointMotion<F>) -> Triple<F> {
    let t = at.direction.tangent;
    let past = water.past(cpu, at);
    let (q, a) = (past.velocity, if W::WAVES { at.acceleration - past.acceleration } else { at.acceleration });
    let qt = t.dot(q);
    let qn = t.mul_add(-qt, q);
    let speed_t = qt.max(-qt);
    let along = (k.drag_tangential * speed_t).mul_add(qt, (k.added_normal - k.added_tangential) * t.dot(a));
    let f = a.mul_add(-k.added_normal, qn.mul_add(k.drag_normal * qn.length(), t * along));
    if W::WAVES { past.acceleration.mul_add(k.buoyancy * (1.0 / water.gravity()), f) } else { f }
}

/// Tangent of f.
pub fn tangent<W: Water>(water: &W, k: &Coefficients<f64>, at: &PointMotion<f64>) -> WaterTangent {
    let stretch = at.direction.stretch;
    let t = Vector3::from(at.direction.tangent);
    let past = water.past((), at);
    let (q, a) = (Vector3::from(past.velocity), Vector3::from(at.acceleration - past.acceleration));
    let along = t * t.transpose();
    let across = Matrix3::identity() - along;
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
    let a_t = t.dot(&a);
    let a_n = a - t * a_t;
    let inertia = (t * a_n.transpose() + across * a_t) * (k.added_normal - k.added_tangential);
    WaterTangent {
        by_height: by_flow * water.shear(at.place.z),
        by_slope: (normal + tangential + inertia) / stretch,
        by_velocity: -by_flow,
        by_acceleration: -(across * k.added_normal + along * k.added_tangential),
    }
}
