//! Axial force of the line at a point, and its tangent.
//!
//! ```text
//! δW = ∫ n·δr′ ds,   n = T t,   T = EA (e + C ė),   e = |r′| - 1,   t = r′/|r′|            (`Exact`, Hooke in engineering strain)
//!                    n = λ r′,  λ = EA (g + C ġ),   g = (r′·r′ - 1)/2                       (`Report`, Ma & Webster 1994, eq. 2.11)
//! ```
//!
//! r′ slope by unstretched arc length [-], e strain [-], ė its rate [1/s], T effective tension [N] positive pulling, EA [N],
//! C Kelvin–Voigt time constant [s]. A line without bending stiffness carries no compression: T ≥ 0 (`floor` = 0); the
//! damped law with that limit is continuous and never gives energy: (T - EA max(e, 0)) ė ≥ 0.
//!
//! An element that goes slack is bunched: its slopes have mass but no stiffness and would keep the energy of the last snap for
//! ever. What a real line loses there in folding, a bounded friction takes up,
//!
//! ```text
//! n_s = f_s b(e) ṙ′ / √(ė_0² + ṙ′·ṙ′),   b = min(1, max(0, -e/e_0)),   e_0 = 0.01, ė_0 = 0.1 1/s,
//! ```
//!
//! f_s a twentieth of the element's weight in air, so that it vanishes with the mesh.

use crate::algebra::lanes::{Real, Triple, length};
use nalgebra::{Matrix3, Vector3};

/// Axial properties of an element.
#[derive(Debug, Clone, Copy)]
pub struct Axial<F> {
    /// EA [N].
    pub ea: F,
    /// Kelvin–Voigt time constant [s].
    pub damping: F,
    /// Least tension [N]: 0 where the line goes slack, -∞ where bending stiffness carries compression.
    pub floor: F,
    /// f_s, bound of the friction of a slack element [N].
    pub friction: F,
}

/// e_0, slackness at which the friction is whole [-].
const BUNCHED: f64 = 0.01;
/// ė_0, rate at which the friction nears its bound [1/s].
const RATE: f64 = 0.1;

/// n + n_s, with the friction n_s of slack elements [N].
#[inline(always)]
fn with_slack_force<F: Real>(n: Triple<F>, cpu: F::Cpu, law: &Axial<F>, strain: F, rate: Triple<F>) -> Triple<F> {
    let slack = -strain * law.friction;
    if !slack.any_positive() {
        return n;
    }
    let bunched = (strain * (-1.0 / BUNCHED)).max(F::splat(cpu, 0.0)).min(F::splat(cpu, 1.0));
    let speed = (rate.dot(rate) + RATE * RATE).sqrt();
    rate.mul_add(law.friction * bunched * speed.reciprocal(), n)
}

/// Direction of the line at a point.
#[derive(Debug, Clone, Copy)]
pub struct Direction<F> {
    /// r′ [-].
    pub slope: Triple<F>,
    /// |r′| [-].
    pub stretch: F,
    /// t = r′/|r′|.
    pub tangent: Triple<F>,
}

impl<F: Real> Direction<F> {
    /// The direction of a slope.
    #[inline(always)]
    pub fn of(slope: Triple<F>) -> Self {
        let stretch = slope.length();
        Direction { slope, stretch, tangent: slope * stretch.reciprocal() }
    }
}

/// Tangent of n_s.
fn slack_tangent(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> AxialTangent {
    let stretch = length(p);
    let bunched = ((1.0 - stretch) / BUNCHED).clamp(0.0, 1.0);
    let by_stretch = if bunched > 0.0 && bunched < 1.0 { -1.0 / BUNCHED } else { 0.0 };
    let speed = (rate.dot(rate) + RATE * RATE).sqrt();
    AxialTangent {
        by_slope: rate * p.transpose() * (law.friction * by_stretch / (speed * stretch)),
        by_rate: (Matrix3::identity() - rate * rate.transpose() / (speed * speed)) * (law.friction * bunched / speed),
    }
}

/// Tangent of the axial force: ∂n/∂r′ and ∂n/∂ṙ′ [N].
#[derive(Debug, Clone, Copy)]
pub struct AxialTangent {
    /// ∂n/∂r′ [N].
    pub by_slope: Matrix3<f64>,
    /// ∂n/∂ṙ′ [N·s].
    pub by_rate: Matrix3<f64>,
}

/// A law of extension.
pub trait Stretch: Copy + Send + Sync + 'static {
    /// Axial force n [N] for a slope and its rate.
    fn force<F: Real>(cpu: F::Cpu, law: &Axial<F>, at: &Direction<F>, rate: Triple<F>) -> Triple<F>;
    /// Its tangent. `geometric`, where given, replaces the tension in the geometric part (mixed Newton path of statics).
    fn tangent(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>, geometric: Option<f64>) -> AxialTangent;
    /// Signed effective tension |n| [N].
    fn tension(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> f64;
    /// Change of the tension for a change of the slope, to first order, without the limit `floor` [N].
    fn linear_tension(law: &Axial<f64>, p: &Vector3<f64>, change: &Vector3<f64>) -> f64;
}

/// Hooke's law in engineering strain.
#[derive(Debug, Clone, Copy)]
pub struct Exact;

impl Stretch for Exact {
    #[inline(always)]
    fn force<F: Real>(cpu: F::Cpu, law: &Axial<F>, at: &Direction<F>, rate: Triple<F>) -> Triple<F> {
        let strain = at.stretch + -1.0;
        let tension = law.ea * law.damping.mul_add(at.tangent.dot(rate), strain);
        with_slack_force(at.tangent * tension.max(law.floor), cpu, law, strain, rate)
    }

    fn tangent(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>, geometric: Option<f64>) -> AxialTangent {
        let stretch = length(p);
        let t = p / stretch;
        let tension = Self::tension(law, p, rate);
        if tension <= law.floor && geometric.is_none_or(|g| g <= law.floor) {
            return slack_tangent(law, p, rate);
        }
        let along = t * t.transpose();
        let across = Matrix3::identity() - along;
        let turning = across * rate * (law.damping / stretch);
        let slack = slack_tangent(law, p, rate);
        AxialTangent {
            by_slope: (along + t * turning.transpose()) * law.ea
                + across * (geometric.unwrap_or(tension).max(law.floor) / stretch)
                + slack.by_slope,
            by_rate: along * (law.ea * law.damping) + slack.by_rate,
        }
    }

    fn tension(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> f64 {
        let stretch = length(p);
        (law.ea * (stretch - 1.0 + law.damping * p.dot(rate) / stretch)).max(law.floor)
    }

    fn linear_tension(law: &Axial<f64>, p: &Vector3<f64>, change: &Vector3<f64>) -> f64 {
        let stretch = length(p);
        law.ea * (stretch - 1.0 + p.dot(change) / stretch)
    }
}

/// The 1994 report's law, linear in Green's strain.
#[derive(Debug, Clone, Copy)]
pub struct Report;

impl Stretch for Report {
    #[inline(always)]
    fn force<F: Real>(cpu: F::Cpu, law: &Axial<F>, at: &Direction<F>, rate: Triple<F>) -> Triple<F> {
        let p = at.slope;
        let lambda = law.ea * law.damping.mul_add(p.dot(rate), (p.dot(p) + -1.0) * 0.5);
        with_slack_force(p * lambda.max(law.floor), cpu, law, at.stretch + -1.0, rate)
    }

    fn tangent(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>, geometric: Option<f64>) -> AxialTangent {
        let lambda = law.ea * (0.5 * (p.dot(p) - 1.0) + law.damping * p.dot(rate));
        if lambda <= law.floor && geometric.is_none_or(|g| g <= law.floor) {
            return slack_tangent(law, p, rate);
        }
        let slack = slack_tangent(law, p, rate);
        AxialTangent {
            by_slope: (p * p.transpose() + p * rate.transpose() * law.damping) * law.ea
                + Matrix3::identity() * geometric.unwrap_or(lambda).max(law.floor)
                + slack.by_slope,
            by_rate: p * p.transpose() * (law.ea * law.damping) + slack.by_rate,
        }
    }

    fn tension(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> f64 {
        (law.ea * (0.5 * (p.dot(p) - 1.0) + law.damping * p.dot(rate))).max(law.floor) * length(p)
    }

    fn linear_tension(law: &Axial<f64>, p: &Vector3<f64>, change: &Vector3<f64>) -> f64 {
        law.ea * (0.5 * (p.dot(p) - 1.0) + p.dot(change))
    }
}
