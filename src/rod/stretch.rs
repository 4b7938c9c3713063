//! Axial force of the line at a point, and its tangent.
//!
//! ```text
//! δW = ∫ n·δr′ ds,   n = T t,   T = T(e) + EA C ė,   e = |r′| - 1,   t = r′/|r′|           (`Exact`, engineering strain)
//!                    n = λ r′,  λ = T(g) + EA C ġ,   g = (r′·r′ - 1)/2                      (`Report`, Ma & Webster 1994, eq. 2.11)
//! ```
//!
//! r′ slope by unstretched arc length [-], e strain [-], ė its rate [1/s], T effective tension [N] positive pulling, EA [N],
//! C Kelvin–Voigt time constant [s], T(e) as in `elasticity`. A line without bending stiffness carries no compression: T ≥ 0 (`floor` = 0); the
//! damped law with that limit is continuous and never gives energy: (T - T(max(e, 0))) ė ≥ 0.
//!
//! An element that goes slack is bunched: its slopes have mass but no stiffness and would keep the energy of the last snap for
//! ever. What a real line loses there in folding, a bounded friction takes up,
//!
//! ```text
//! n_s = f_s b(e) ṙ′ / √(ė_0² + ṙ′·ṙ′),   b = min(1, max(0, -e/e_0)),   e_0 = 0.01, ė_0 = 0.1 1/s,
//! ```
//!
//! f_s a twentieth of the element's weight in air, so that it vanishes with the mesh.

use crate::algebra::real::Real;
use crate::algebra::tensor::Tensor;
use crate::algebra::triple::{Triple, length};
use crate::rod::axial::Axial;
use crate::rod::elasticity::Elastic;
use nalgebra::Vector3;
use std::marker::PhantomData;

impl<F: Real> Axial<F> {
    /// Stiffness, EA C and the tension of the geometric part, all zero where the line is slack.
    #[inline(always)]
    fn carried<E: Elastic>(&self, tension: F, geometric: Option<F>) -> (F, F, F) {
        let geometric = geometric.unwrap_or(tension);
        let on = (tension.max(geometric) - self.floor).positive();
        (E::stiffness(self) * on, self.ea * self.damping * on, geometric.max(self.floor) * on)
    }
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
pub struct Direction<F: Real> {
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

/// How much of ∂/∂r′ and of ∂/∂ṙ′ a tangent is made of.
#[derive(Debug, Clone, Copy)]
pub struct By {
    /// Factor of ∂/∂r′.
    pub slope: f64,
    /// Factor of ∂/∂ṙ′ [s].
    pub rate: f64,
}

/// Adds the tangent of n_s to one of n.
#[inline(always)]
fn with_slack_tangent<F: Real>(
    sum: Tensor<F>,
    cpu: F::Cpu,
    law: &Axial<F>,
    at: &Direction<F>,
    rate: Triple<F>,
    by: By,
) -> Tensor<F> {
    let slackness = -at.stretch + 1.0;
    if !(slackness * law.friction).any_positive() {
        return sum;
    }
    let (zero, one) = (F::splat(cpu, 0.0), F::splat(cpu, 1.0));
    let bunched = (slackness * (1.0 / BUNCHED)).max(zero).min(one);
    let bunching = bunched.positive() * (-bunched + 1.0).positive() * (-1.0 / BUNCHED);
    let slowness = (rate.dot(rate) + RATE * RATE).sqrt().reciprocal();
    let friction = law.friction * slowness;
    let by_rate = friction * bunched * by.rate;
    let by_slope = at.tangent * (friction * bunching * by.slope);
    Tensor::isotropic(cpu, by_rate).add_outer(rate, by_slope - rate * (by_rate * slowness * slowness)).mul_add(one, sum)
}

/// A law of extension.
pub trait Stretch: Copy + Send + Sync + 'static {
    /// True: tension and stiffness of every point are looked up in tables.
    const SPECIAL: bool;
    /// Strain e or g [-].
    fn strain<F: Real>(at: &Direction<F>) -> F;
    /// Axial force n [N] for a slope and its rate.
    fn force<F: Real>(cpu: F::Cpu, law: &Axial<F>, at: &Direction<F>, rate: Triple<F>) -> Triple<F>;
    /// Its tangent [N]. `geometric`, where given, replaces the tension in the geometric part (mixed Newton path of statics).
    fn tangent<F: Real>(
        cpu: F::Cpu,
        law: &Axial<F>,
        at: &Direction<F>,
        rate: Triple<F>,
        geometric: Option<F>,
        by: By,
    ) -> Tensor<F>;
    /// Signed effective tension |n| [N].
    fn tension(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> f64;
    /// Change of the tension for a change of the slope, to first order, without the limit `floor` [N].
    fn linear_tension(law: &Axial<f64>, p: &Vector3<f64>, change: &Vector3<f64>) -> f64;
}

/// Tension by engineering strain.
#[derive(Debug, Clone, Copy)]
pub struct Exact<E>(PhantomData<E>);

impl<E: Elastic> Stretch for Exact<E> {
    const SPECIAL: bool = E::SPECIAL;

    #[inline(always)]
    fn strain<F: Real>(at: &Direction<F>) -> F {
        at.stretch + -1.0
    }

    #[inline(always)]
    fn force<F: Real>(cpu: F::Cpu, law: &Axial<F>, at: &Direction<F>, rate: Triple<F>) -> Triple<F> {
        let strain = Self::strain(at);
        let tension = (law.ea * law.damping).mul_add(at.tangent.dot(rate), E::tension(law, strain));
        with_slack_force(at.tangent * tension.max(law.floor), cpu, law, strain, rate)
    }

    #[inline(always)]
    fn tangent<F: Real>(
        cpu: F::Cpu,
        law: &Axial<F>,
        at: &Direction<F>,
        rate: Triple<F>,
        geometric: Option<F>,
        by: By,
    ) -> Tensor<F> {
        let (t, per_stretch) = (at.tangent, at.stretch.reciprocal());
        let tension = (law.ea * law.damping).mul_add(t.dot(rate), E::tension(law, Self::strain(at)));
        let (stiffness, damping, across) = law.carried::<E>(tension, geometric);
        let across = across * per_stretch * by.slope;
        let along = stiffness * by.slope + damping * by.rate - across;
        let turning = (rate - t * t.dot(rate)) * (damping * per_stretch * by.slope);
        let sum = Tensor::isotropic(cpu, across).add_outer(t, t.mul_add(along, turning));
        with_slack_tangent(sum, cpu, law, at, rate, by)
    }

    fn tension(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> f64 {
        let stretch = length(p);
        (E::tension(law, stretch - 1.0) + law.ea * law.damping * p.dot(rate) / stretch).max(law.floor)
    }

    fn linear_tension(law: &Axial<f64>, p: &Vector3<f64>, change: &Vector3<f64>) -> f64 {
        let stretch = length(p);
        E::tension(law, stretch - 1.0) + E::stiffness(law) * p.dot(change) / stretch
    }
}

/// The 1994 report's law: λ by Green's strain.
#[derive(Debug, Clone, Copy)]
pub struct Report<E>(PhantomData<E>);

impl<E: Elastic> Stretch for Report<E> {
    const SPECIAL: bool = E::SPECIAL;

    #[inline(always)]
    fn strain<F: Real>(at: &Direction<F>) -> F {
        (at.slope.dot(at.slope) + -1.0) * 0.5
    }

    #[inline(always)]
    fn force<F: Real>(cpu: F::Cpu, law: &Axial<F>, at: &Direction<F>, rate: Triple<F>) -> Triple<F> {
        let p = at.slope;
        let lambda = (law.ea * law.damping).mul_add(p.dot(rate), E::tension(law, Self::strain(at)));
        with_slack_force(p * lambda.max(law.floor), cpu, law, at.stretch + -1.0, rate)
    }

    #[inline(always)]
    fn tangent<F: Real>(
        cpu: F::Cpu,
        law: &Axial<F>,
        at: &Direction<F>,
        rate: Triple<F>,
        geometric: Option<F>,
        by: By,
    ) -> Tensor<F> {
        let p = at.slope;
        let lambda = (law.ea * law.damping).mul_add(p.dot(rate), E::tension(law, Self::strain(at)));
        let (stiffness, damping, geometric) = law.carried::<E>(lambda, geometric);
        let along = p * (stiffness * by.slope + damping * by.rate);
        let turning = rate * (damping * by.slope);
        let sum = Tensor::isotropic(cpu, geometric * by.slope).add_outer(p, along + turning);
        with_slack_tangent(sum, cpu, law, at, rate, by)
    }

    fn tension(law: &Axial<f64>, p: &Vector3<f64>, rate: &Vector3<f64>) -> f64 {
        (E::tension(law, 0.5 * (p.dot(p) - 1.0)) + law.ea * law.damping * p.dot(rate)).max(law.floor) * length(p)
    }

    fn linear_tension(law: &Axial<f64>, p: &Vector3<f64>, change: &Vector3<f64>) -> f64 {
        E::tension(law, 0.5 * (p.dot(p) - 1.0)) + E::stiffness(law) * p.dot(change)
    }
}
