//! The spectrum of a tension: Welch's mean over segments that overlap by half, each without its mean and under a Hann window.

use realfft::RealFftPlanner;
use std::f64::consts::TAU;

/// Periods that a segment should hold, so that the resolution is a twentieth of the mean frequency.
const PERIODS: f64 = 20.0;
/// Half-overlapping segments of this share of a long run: 15 of them.
const SHARE: usize = 8;

/// A one-sided spectral density.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Distance of the frequencies [Hz]; the first is 0.
    pub step: f64,
    /// Density [N²/Hz, the square of the unit of the values per Hz].
    pub density: Vec<f64>,
    /// Segments it is the mean of; its relative standard error is about 1/sqrt(segments).
    pub segments: usize,
}

impl Spectrum {
    /// Frequency of the largest density [Hz], between the rows by a parabola; `None` where all is 0.
    pub fn peak(&self) -> Option<f64> {
        let inner = 1..self.density.len().saturating_sub(1);
        let k = inner.max_by(|a, b| self.density[*a].total_cmp(&self.density[*b]))?;
        let [before, here, after] = [self.density[k - 1], self.density[k], self.density[k + 1]];
        let bend = before - 2.0 * here + after;
        let aside = if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
        (here > 0.0).then_some((k as f64 + aside) * self.step)
    }

    /// Its integral: the variance of the values.
    pub fn variance(&self) -> f64 {
        self.density.iter().sum::<f64>() * self.step
    }

    /// How many of its rows hold a share of the variance, such as 0.999, counted from frequency 0.
    pub fn rows_with(&self, share: f64) -> usize {
        let whole: f64 = self.density.iter().sum();
        let mut sum = 0.0;
        let held = self.density.iter().take_while(|density| {
            let more = sum < share * whole;
            sum += *density;
            more
        });
        held.count()
    }
}

/// The spectrum of values `step` [s] apart, whose mean period is `period` [s]; `None` of fewer than 16 values, or of values that are not
/// all finite.
pub fn spectrum(values: &[f64], step: f64, period: f64) -> Option<Spectrum> {
    if values.len() < 16 || !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let wanted = if period.is_finite() { (PERIODS * period / step) as usize } else { values.len() };
    let most = wanted.min(values.len() / 2).max(values.len() / SHARE).max(16);
    // The largest power of two that is not more.
    let length = 1 << most.ilog2();
    let window: Vec<f64> = (0..length).map(|k| 0.5 - 0.5 * (TAU * k as f64 / length as f64).cos()).collect();
    let energy: f64 = window.iter().map(|w| w * w).sum();
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let (mut segment, mut lines) = (transform.make_input_vec(), transform.make_output_vec());
    let mut density = vec![0.0; lines.len()];
    let mut segments = 0;
    for from in (0..=values.len() - length).step_by(length / 2) {
        let here = &values[from..from + length];
        let mean = here.iter().sum::<f64>() / length as f64;
        for ((slot, value), weight) in segment.iter_mut().zip(here).zip(&window) {
            *slot = (value - mean) * weight;
        }
        // Both vectors are of the transform's own making.
        transform.process(&mut segment, &mut lines).ok()?;
        density.iter_mut().zip(&lines).for_each(|(sum, line)| *sum += line.norm_sqr());
        segments += 1;
    }
    let scale = step / (energy * segments as f64);
    let last = density.len() - 1;
    // What lies at negative frequencies is added, except at 0 and at the highest, which are their own mirror images.
    density.iter_mut().enumerate().for_each(|(k, sum)| *sum *= if k == 0 || k == last { scale } else { 2.0 * scale });
    Some(Spectrum { step: 1.0 / (length as f64 * step), density, segments })
}
