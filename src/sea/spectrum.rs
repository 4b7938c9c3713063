//! Spectra of seas, and components drawn from them.
//!
//! ```text
//! JONSWAP (Hasselmann et al. 1973)   S(f) ∝ f⁻⁵ exp(-5/4 (f/f_p)⁻⁴) γ^exp(-(f/f_p - 1)²/(2 σ²)),   σ = 0.07 (f ≤ f_p), 0.09 (f > f_p)
//! Pierson & Moskowitz (1964)         the same with γ = 1
//! Ochi & Hubble (1976)               S(f) = Σ H_j² m_j^λ_j / (4 Γ(λ_j)) f_j^4λ_j f^-(4λ_j+1) exp(-m_j (f/f_j)⁻⁴),   m_j = λ_j + 1/4,   j = 1, 2
//! table                              linear between rows
//! ∫ S df = H_s²/16
//! ```
//!
//! The spectrum is cut into bins of equal energy. Each holds one component, at a random frequency inside it (so that the sea does not
//! repeat itself) and with a random phase. All components thus have the same amplitude, H_s/4 √(2/N), and the variance of the
//! elevation is H_s²/16 for any N. Frequencies from 0.3 to 5 f_p are used, beyond which lies 0.2 % of the energy. What a cut-off takes away
//! is left out, not put elsewhere: the sea is then lower than H_s.

use crate::scene::types::{OchiHubblePart, variance};
use crate::sea::random::SplitMix;
use crate::sea::wave::Wave;
use std::f64::consts::TAU;

/// Frequencies used, as multiples of that of the peak.
const BAND: [f64; 2] = [0.3, 5.0];
/// Points at which the spectrum is integrated.
const POINTS: usize = 4000;

/// How components are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw {
    /// The same seed, the same sea.
    pub seed: u64,
    /// Number of components.
    pub count: usize,
    /// Direction in which all travel [rad].
    pub direction: f64,
    /// Frequency above which nothing is drawn [Hz].
    pub cut_off: Option<f64>,
}

/// A spectrum. Frequencies are counted in units of its own, so that the numbers of one shape are the same at every period.
pub trait Spectrum {
    /// H_s [m].
    fn height(&self) -> f64;
    /// The time in whose inverse frequencies are counted [s].
    fn period(&self) -> f64;
    /// Lowest and highest frequency used.
    fn band(&self) -> [f64; 2];
    /// Shape of S at a frequency, up to a factor.
    fn shape(&self, x: f64) -> f64;

    /// S [m²/Hz] at a frequency [Hz], scaled so that its integral over the band is H_s²/16.
    fn density(&self, frequency: f64) -> f64 {
        let [from, to] = self.band();
        let cells = Cells::new(from, to, |x| self.shape(x));
        self.height().powi(2) / 16.0 * self.period() * self.shape(frequency * self.period()) / cells.integral()
    }

    /// The components of a sea; none where there is no energy.
    fn waves(&self, draw: &Draw) -> Vec<Wave> {
        let [from, last] = self.band();
        let to = draw.cut_off.map_or(last, |cut_off| last.min(cut_off * self.period()));
        let cells = Cells::new(from, to, |x| self.shape(x));
        let mut amplitude = self.height() / 4.0 * (2.0 / draw.count as f64).sqrt();
        if to < last {
            amplitude *= (cells.integral() / Cells::new(from, last, |x| self.shape(x)).integral()).sqrt();
        }
        cells.waves(amplitude, self.period(), draw)
    }
}

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
    /// The full-grown sea of Pierson and Moskowitz, of a height [m] and a peak period [s].
    pub fn full_grown(hs: f64, tp: f64) -> Jonswap {
        Jonswap { hs, tp, gamma: 1.0 }
    }

    /// `count` components that travel in one direction [rad]; the same for the same seed.
    pub fn waves(&self, seed: u64, count: usize, direction: f64) -> Vec<Wave> {
        Spectrum::waves(self, &Draw { seed, count, direction, cut_off: None })
    }
}

impl Spectrum for Jonswap {
    fn height(&self) -> f64 {
        self.hs
    }

    fn period(&self) -> f64 {
        self.tp
    }

    fn band(&self) -> [f64; 2] {
        BAND
    }

    fn shape(&self, x: f64) -> f64 {
        let sigma = if x <= 1.0 { 0.07 } else { 0.09 };
        let peak = (-0.5 * ((x - 1.0) / sigma).powi(2)).exp();
        x.powi(-5) * (-1.25 * x.powi(-4)).exp() * self.gamma.powf(peak)
    }
}

/// A sea of two peaks; frequencies in Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OchiHubble(pub [OchiHubblePart; 2]);

impl Spectrum for OchiHubble {
    fn height(&self) -> f64 {
        self.0[0].hs.hypot(self.0[1].hs)
    }

    fn period(&self) -> f64 {
        1.0
    }

    fn band(&self) -> [f64; 2] {
        let [one, other] = self.0.map(|part| part.tp);
        [BAND[0] / one.max(other), BAND[1] / one.min(other)]
    }

    fn shape(&self, x: f64) -> f64 {
        let part = |part: &OchiHubblePart| {
            let (m, y) = (part.lambda + 0.25, x * part.tp);
            // In logarithms, for powers that no number holds.
            let power = part.lambda * m.ln() - libm::lgamma(part.lambda) - (4.0 * part.lambda + 1.0) * y.ln() - m * y.powi(-4);
            0.25 * part.hs * part.hs * part.tp * power.exp()
        };
        self.0.iter().map(part).sum()
    }
}

/// Rows of frequency [Hz] and density [m²/Hz]: at least two, frequencies rising.
#[derive(Debug, Clone, PartialEq)]
pub struct Table(pub Vec<[f64; 2]>);

impl Spectrum for Table {
    fn height(&self) -> f64 {
        4.0 * variance(&self.0).sqrt()
    }

    fn period(&self) -> f64 {
        1.0
    }

    fn band(&self) -> [f64; 2] {
        let ends = [self.0.first(), self.0.last()];
        ends.map(|row| row.map_or(0.0, |row| row[0]))
    }

    fn shape(&self, x: f64) -> f64 {
        let after = self.0.partition_point(|row| row[0] <= x);
        if after == 0 || after == self.0.len() {
            return self.0.last().filter(|row| row[0] == x).map_or(0.0, |row| row[1]);
        }
        let ([from, low], [to, high]) = (self.0[after - 1], self.0[after]);
        low + (high - low) * (x - from) / (to - from)
    }
}

/// A spectrum in cells of one width.
struct Cells {
    from: f64,
    step: f64,
    energy: Vec<f64>,
    total: f64,
}

impl Cells {
    fn new(from: f64, to: f64, shape: impl Fn(f64) -> f64) -> Cells {
        let step = (to - from) / POINTS as f64;
        let energy: Vec<f64> = (0..POINTS).map(|k| shape(from + (k as f64 + 0.5) * step)).collect();
        let total = energy.iter().sum();
        Cells { from, step, energy, total }
    }

    fn integral(&self) -> f64 {
        self.total * self.step
    }

    fn waves(&self, amplitude: f64, period: f64, draw: &Draw) -> Vec<Wave> {
        let Draw { seed, count, direction, .. } = *draw;
        if !(self.total > 0.0) {
            return Vec::new();
        }
        let Cells { from, step, energy, total } = self;
        let mut random = SplitMix(seed);
        let (mut cell, mut below) = (0, 0.0);
        let wave = |bin: usize| {
            let wanted = (bin as f64 + random.uniform()) / count as f64 * total;
            while cell + 1 < POINTS && below + energy[cell] <= wanted {
                below += energy[cell];
                cell += 1;
            }
            let share = if energy[cell] > 0.0 { ((wanted - below) / energy[cell]).clamp(0.0, 1.0) } else { 0.0 };
            let x = from + (cell as f64 + share) * step;
            Wave { amplitude, omega: TAU * x / period, direction, phase: TAU * random.uniform() }
        };
        (0..count).map(wave).collect()
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
