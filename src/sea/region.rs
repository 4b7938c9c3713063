//! Few waves that stand for many of one direction, in a region and for a while.
//!
//! ```text
//! Σ a e^(iθ(x, t)) = Σ_q R_q e^(i k_q (x - X) - i ω_q (t - T)),   R_q = Σ a L_q(ω) e^(iθ(X, T))
//! ```
//!
//! X and T middle of the region and of the while, ω_q Chebyshev's points between the lowest and the highest frequency, L_q Lagrange's polynomials
//! through them. As a function of ω, e^(ik(ω)x - iωt) is a polynomial of degree 63 to 1e-8 as long as its phase does not turn by more than
//! `TURN` from the middle of the band. Cells are many in a region: their sums are taken over these waves, however many components there are.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::Real;
use crate::sea::layer::{Member, Water};
use crate::sea::series::cos_sin;
use crate::sea::wave::wave_number;
use pulp::Simd;
use std::f64::consts::{PI, TAU};

/// Waves that stand for all.
pub const NODES: usize = 64;
/// With fewer components their sums are as cheap.
const LEAST: usize = 2 * NODES;
/// How far phases turn from the middle of the band, by the extent of a region and by that of a while [rad].
const TURN: [f64; 2] = [26.0, 10.0];

/// How large regions are, and which waves stand for the components in them.
#[derive(Debug)]
pub struct Region {
    /// Width of a region [m], and the duration of a while [s].
    width: f64,
    duration: f64,
    /// The waves, of unit amplitude, longest first.
    pub nodes: Vec<Member>,
    /// k/2π, ω/2π and φ/2π of these waves.
    pub turns: [Vec<f64>; 3],
    /// a L_q(ω) of the components.
    shares: Vec<[f64; NODES]>,
}

impl Region {
    /// Regions for components, longest first; none where their own sums are as cheap.
    pub fn new(members: &[Member], water: &Water) -> Option<Region> {
        let (first, last) = (members.first()?, members.last()?);
        let band = 0.5 * (last.omega - first.omega);
        if members.len() < LEAST || !(band > 1.0e-3 * last.omega) {
            return None;
        }
        let centre = 0.5 * (last.omega + first.omega);
        // Lowest first.
        let turn: [f64; NODES] = std::array::from_fn(|q| (2 * (NODES - 1 - q) + 1) as f64 * PI / (2 * NODES) as f64);
        let omega = turn.map(|turn| centre + band * turn.cos());
        let node = |omega: &f64| {
            let number = wave_number(*omega, water.gravity, water.depth);
            Member::new(number, *omega, 0.0, 1.0, water.depth)
        };
        let nodes: Vec<Member> = omega.iter().map(node).collect();
        let shares = |member: &Member| {
            if let Some(at) = omega.iter().position(|omega| *omega == member.omega) {
                return std::array::from_fn(|q| if q == at { member.amplitude } else { 0.0 });
            }
            // Barycentric form at Chebyshev's points of the first kind.
            let pull: [f64; NODES] = std::array::from_fn(|q| {
                let sign = if q % 2 == 0 { 1.0 } else { -1.0 };
                sign * turn[q].sin() * band / (member.omega - omega[q])
            });
            let scale = member.amplitude / pull.iter().sum::<f64>();
            pull.map(|pull| pull * scale)
        };
        // 1 over the slowest group speed, which is that at an end of the band.
        let slowness = |omega: f64| {
            let step = 1.0e-4 * omega;
            let number = |omega: f64| wave_number(omega, water.gravity, water.depth);
            (number(omega + step) - number(omega - step)) / (2.0 * step)
        };
        let slowest = slowness(first.omega).max(slowness(last.omega));
        let [by_place, by_time] = TURN.map(|turn| 2.0 * turn / band);
        let row = |of: fn(&Member) -> f64| nodes.iter().map(|node| of(node) / TAU).collect();
        let turns = [row(|node| node.number), row(|node| node.omega), row(|node| node.phase)];
        let shares = members.iter().map(shares).collect();
        Some(Region { width: by_place / slowest, duration: by_time, turns, shares, nodes })
    }

    /// The numbers of the region and of the while in which a place [m] and a time [s] are.
    pub fn at(&self, along: f64, time: f64) -> (i64, i64) {
        ((along / self.width).round_ties_even() as i64, (time / self.duration).floor() as i64)
    }

    /// The middle of a region [m] and of a while [s].
    pub fn middle(&self, (region, span): (i64, i64)) -> [f64; 2] {
        [region as f64 * self.width, (span as f64 + 0.5) * self.duration]
    }

    /// Real and imaginary R_q of a region and a while about a middle, of components that have k/2π, ω/2π and φ/2π.
    #[inline(always)]
    pub fn sums<V: Simd>(
        &self,
        cpu: V,
        [numbers, frequencies, phases]: &[Vec<f64>; 3],
        [cosines, sines]: &mut [Vec<f64>; 2],
        [along, time]: [f64; 2],
    ) -> [[f64; NODES]; 2] {
        for n in (0..self.shares.len()).step_by(V::F64_LANES) {
            let still = Lanes::<V>::load(cpu, frequencies, n).scale_add(-time, Lanes::load(cpu, phases, n));
            let (cos, sin) = cos_sin(cpu, Lanes::load(cpu, numbers, n).scale_add(along, still));
            cos.store(cosines, n);
            sin.store(sines, n);
        }
        let mut sums = [[0.0; NODES]; 2];
        for (shares, (cos, sin)) in self.shares.iter().zip(cosines.iter().zip(sines.iter())) {
            for q in 0..NODES {
                sums[0][q] = shares[q].mul_add(*cos, sums[0][q]);
                sums[1][q] = shares[q].mul_add(*sin, sums[1][q]);
            }
        }
        sums
    }
}
