//! The JONSWAP spectrum (Hasselmann et al. 1973) and a sea drawn from it.
//!
//! ```text
//! S(f) ∝ f⁻⁵ exp(-5/4 (f/f_p)⁻⁴) γ^exp(-(f/f_p - 1)²/(2 σ²)),   σ = 0.07 (f ≤ f_p), 0.09 (f > f_p),   ∫ S df = H_s²/16
//! ```
//!
//! The spectrum is cut into bins of equal energy. Each holds one component, at a random frequency inside it (so that the sea does not
//! repeat itself) and with a random phase. All components thus have the same amplitude, H_s/4 √(2/N), and the variance of the
//! elevation is H_s²/16 for any N. Frequencies from 0.3 to 5 f_p are used, beyond which lies 0.2 % of the energy.

use crate::sea::wave::Wave;
use std::f64::consts::TAU;

/// Frequencies used, as multiples of that of the peak.
const BAND: [f64; 2] = [0.3, 5.0];
/// Points at which the spectrum is integrated.
const POINTS: usize = 4000;

/// A JONSWAP sea.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jonswap {
    /// Significant wave height H_s [m].
    pub hs: f64,
    /// Peak period 1/f_p [s].
    pub tp: f64,
    /// Peak enhancement γ [-].
    pub gamma: f64,
}

impl Jonswap {
    /// Shape of S at f = x f_p, up to a factor.
    pub fn shape(&self, x: f64) -> f64 {
        let sigma = if x <= 1.0 { 0.07 } else { 0.09 };
        let peak = (-0.5 * ((x - 1.0) / sigma).powi(2)).exp();
        x.powi(-5) * (-1.25 * x.powi(-4)).exp() * self.gamma.powf(peak)
    }

    /// `count` components that travel in one direction [rad]; the same for the same seed.
    pub fn waves(&self, seed: u64, count: usize, direction: f64) -> Vec<Wave> {
        let step = (BAND[1] - BAND[0]) / POINTS as f64;
        let energy: Vec<f64> = (0..POINTS).map(|k| self.shape(BAND[0] + (k as f64 + 0.5) * step)).collect();
        let total: f64 = energy.iter().sum();
        let amplitude = self.hs / 4.0 * (2.0 / count as f64).sqrt();
        let mut random = SplitMix(seed);
        let (mut cell, mut below) = (0, 0.0);
        let wave = |bin: usize| {
            let wanted = (bin as f64 + random.next()) / count as f64 * total;
            while cell + 1 < POINTS && below + energy[cell] <= wanted {
                below += energy[cell];
                cell += 1;
            }
            let x = BAND[0] + (cell as f64 + ((wanted - below) / energy[cell]).clamp(0.0, 1.0)) * step;
            Wave { amplitude, omega: TAU * x / self.tp, direction, phase: TAU * random.next() }
        };
        (0..count).map(wave).collect()
    }
}

/// The generator SplitMix64 (Steele, Lea & Flood 2014).
struct SplitMix(u64);

impl SplitMix {
    /// Uniform in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEA: Jonswap = Jonswap { hs: 6.0, tp: 11.0, gamma: 3.3 };

    /// ∫ x^n S dx over a part of the band by Simpson's rule, over that on the whole band.
    fn moment(sea: &Jonswap, n: i32, from: f64, to: f64) -> f64 {
        let integral = |from: f64, to: f64, n: i32| {
            let h = (to - from) / 2000.0;
            let weight = |k: usize| if k == 0 || k == 2000 { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
            (0..=2000).map(|k| (weight(k), from + k as f64 * h)).map(|(w, x)| w * h / 3.0 * x.powi(n) * sea.shape(x)).sum::<f64>()
        };
        integral(from, to, n) / (integral(BAND[0], 1.0, 0) + integral(1.0, BAND[1], 0))
    }

    /// Variance of the elevation Σ a²/2 = H_s²/16, exact by construction, for few and many components.
    #[test]
    fn the_variance_is_that_of_the_significant_height() {
        for count in [1, 7, 200, 1000] {
            let variance: f64 = SEA.waves(5, count, 0.0).iter().map(|wave| 0.5 * wave.amplitude * wave.amplitude).sum();
            assert!((variance / (SEA.hs * SEA.hs / 16.0) - 1.0).abs() < 1e-12);
        }
    }

    /// Each of 200 bins has one component, so the energy below any frequency is that of the spectrum within a bin (0.5 %, and what
    /// the integration by 4000 cells adds); the second moment, which rules the mean period, within 1 %.
    #[test]
    fn the_energy_lies_where_the_spectrum_has_it() {
        let count = 200;
        for gamma in [1.0, 3.3, 7.0] {
            let sea = Jonswap { gamma, ..SEA };
            let waves = sea.waves(3, count, 0.0);
            for x in [0.8, 0.95, 1.0, 1.1, 1.5, 2.0, 3.0] {
                let below = waves.iter().filter(|wave| wave.omega < TAU * x / sea.tp).count() as f64 / count as f64;
                let exact = if x <= 1.0 { moment(&sea, 0, 0.3, x) } else { moment(&sea, 0, 0.3, 1.0) + moment(&sea, 0, 1.0, x) };
                assert!((below - exact).abs() < 0.006, "γ = {gamma}, x = {x}: {below} {exact}");
            }
            let second = waves.iter().map(|wave| (wave.omega * sea.tp / TAU).powi(2)).sum::<f64>() / count as f64;
            let exact = moment(&sea, 2, 0.3, 1.0) + moment(&sea, 2, 1.0, 5.0);
            assert!((second / exact - 1.0).abs() < 0.01, "{second} {exact}");
        }
    }

    /// The same seed gives the same sea to the bit, another seed another one.
    #[test]
    fn the_seed_makes_the_sea() {
        assert_eq!(SEA.waves(9, 50, 0.3), SEA.waves(9, 50, 0.3));
        assert_ne!(SEA.waves(9, 50, 0.3), SEA.waves(10, 50, 0.3));
    }
}
