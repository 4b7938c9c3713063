//! Height, period and steepness of a sea, computed back from its components.
//!
//! ```text
//! H_s = 4 √(Σ a²/2),   T_p = 1/f_p,   f_p: the component about which Σ a_n² exp(-(f_n - f)²/(2 (w f)²)) is greatest,   s = H_s/L(T_p)
//! ```
//!
//! L from the dispersion relation at the depth of the water. The kernel, w wide, makes a smooth spectrum of lines that lie at random; it
//! finds the peak of a JONSWAP sea of 200 components within 7 %. A wave alone is measured by its own height 2a instead of H_s.

use crate::sea::wave::{Wave, wave_number};
use std::f64::consts::TAU;

/// Width w of the kernel, as a share of the frequency.
const WIDTH: f64 = 0.06;
/// Peak periods between which the steepest sea goes over from one steepness to the other (DNV-RP-C205, 3.5.5) [s].
const PERIODS: [f64; 2] = [8.0, 15.0];
/// Steepness of the steepest seas at and beyond these periods.
const STEEPEST: [f64; 2] = [1.0 / 15.0, 1.0 / 25.0];

/// What a sea is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// H_s, or the height of a wave alone [m].
    pub height: f64,
    /// T_p, or the period of a wave alone [s].
    pub period: f64,
    /// Lowest and highest frequency [Hz].
    pub band: [f64; 2],
    /// Length of a wave of that period [m].
    pub length: f64,
    /// Height over length.
    pub steepness: f64,
    /// The steepness beyond which waves break: of a sea after DNV-RP-C205, of a wave alone 0.142 tanh kd (Miche 1944).
    pub steepest: f64,
}

impl Figures {
    /// The figures of components in water of a depth [m], or none of a calm sea.
    pub fn of(waves: &[Wave], gravity: f64, depth: f64) -> Option<Figures> {
        let variance: f64 = waves.iter().map(|wave| 0.5 * wave.amplitude * wave.amplitude).sum();
        let near = |at: &Wave| -> f64 {
            let weight = |wave: &Wave| (-0.5 * ((wave.omega / at.omega - 1.0) / WIDTH).powi(2)).exp();
            // Over the width, so that it is a density.
            waves.iter().map(|wave| wave.amplitude * wave.amplitude * weight(wave)).sum::<f64>() / at.omega
        };
        let densities = waves.iter().map(|wave| (near(wave), wave.omega));
        let (_, omega) = densities.max_by(|one, other| one.0.total_cmp(&other.0)).filter(|_| variance > 0.0)?;
        let alone = waves.iter().filter(|wave| wave.amplitude > 0.0).count() == 1;
        let height = if alone { (8.0 * variance).sqrt() } else { 4.0 * variance.sqrt() };
        let (number, period) = (wave_number(omega, gravity, depth), TAU / omega);
        let length = TAU / number;
        let steepest = if alone {
            0.142 * (number * depth).tanh()
        } else {
            let share = ((period - PERIODS[0]) / (PERIODS[1] - PERIODS[0])).clamp(0.0, 1.0);
            STEEPEST[0] + share * (STEEPEST[1] - STEEPEST[0])
        };
        let frequencies = waves.iter().map(|wave| wave.omega / TAU);
        let band = [frequencies.clone().fold(f64::INFINITY, f64::min), frequencies.fold(0.0, f64::max)];
        Some(Figures { height, period, band, length, steepness: height / length, steepest })
    }

    /// Whether waves of the sea would break as a matter of course.
    pub fn breaks(&self) -> bool {
        self.steepness > self.steepest
    }
}
