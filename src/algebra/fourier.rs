//! A record at even times as a sum of cosines.
//!
//! ```text
//! x(t_n) = mean + Σ_k a_k cos(2π f_k (t_n - t_0) + α_k),   f_k = k/T,   k = 1 … N/2,   T = N Δt
//! ```
//!
//! Exact at the N times of the record, and repeated after T. The fast transform is that of the crate `realfft`, for any N.

use realfft::RealFftPlanner;
use std::f64::consts::TAU;

/// One cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cosine {
    /// f [Hz].
    pub frequency: f64,
    /// a ≥ 0, in the unit of the record.
    pub amplitude: f64,
    /// α, at the first time of the record [rad].
    pub phase: f64,
}

/// The mean of a record at times `step` [s] apart and its cosines, in rising frequency.
pub fn cosines(record: &[f64], step: f64) -> (f64, Vec<Cosine>) {
    let count = record.len();
    if count < 2 {
        return (record.first().copied().unwrap_or(0.0), Vec::new());
    }
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(count);
    let (mut samples, mut lines) = (record.to_vec(), transform.make_output_vec());
    // The vectors have the lengths that the plan asks for, the only thing that can go wrong.
    if transform.process(&mut samples, &mut lines).is_err() {
        return (0.0, Vec::new());
    }
    let share = |k: usize| if 2 * k == count { 1.0 } else { 2.0 } / count as f64;
    let cosine = |(k, line): (usize, &realfft::num_complex::Complex<f64>)| Cosine {
        frequency: k as f64 / (count as f64 * step),
        amplitude: share(k) * line.norm(),
        phase: line.arg().rem_euclid(TAU),
    };
    let mean = lines[0].re / count as f64;
    (mean, lines.iter().enumerate().skip(1).map(cosine).collect())
}

/// The frequency [Hz] about which a record has most energy per hertz: the mean, by energy, of the cosines within a share of the best one.
pub fn peak(cosines: &[Cosine], share: f64) -> f64 {
    // Sums of energy, and of energy times frequency, up to each cosine.
    let mut sums = vec![[0.0; 2]];
    for of in cosines {
        let ([energy, moment], square) = (sums[sums.len() - 1], of.amplitude * of.amplitude);
        sums.push([energy + square, moment + square * of.frequency]);
    }
    let about = |at: f64| {
        let [from, to] = [1.0 - share, 1.0 + share].map(|of| sums[cosines.partition_point(|cosine| cosine.frequency < at * of)]);
        [to[0] - from[0], to[1] - from[1]]
    };
    let best = cosines.iter().map(|of| of.frequency).max_by(|one, other| {
        let density = |at: f64| about(at)[0] / at;
        density(*one).total_cmp(&density(*other))
    });
    let [energy, moment] = about(best.unwrap_or(0.0));
    if energy > 0.0 { moment / energy } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: the sum on top, at the times of the record, for even, odd and prime lengths (1e-12 of the largest); and a cosine that fits in is found
    /// with its amplitude, frequency and phase.
    #[test]
    fn a_record_is_the_sum_of_its_cosines() {
        for count in [2, 9, 64, 97, 1000] {
            let record: Vec<f64> = (0..count).map(|n| (0.37 * (n * n % 101) as f64).sin() + 0.2).collect();
            let (mean, cosines) = cosines(&record, 0.25);
            assert_eq!(cosines.len(), count / 2);
            for (n, exact) in record.iter().enumerate() {
                let time = 0.25 * n as f64;
                let terms = cosines.iter().map(|of| of.amplitude * (TAU * of.frequency * time + of.phase).cos());
                assert!((mean + terms.sum::<f64>() - exact).abs() < 1e-11, "{count}, {n}");
            }
        }
        let record: Vec<f64> = (0..200).map(|n| 3.0 * (TAU * 0.1 * 0.5 * f64::from(n) + 1.0).cos()).collect();
        let (_, cosines) = cosines(&record, 0.5);
        let found = cosines.iter().max_by(|one, other| one.amplitude.total_cmp(&other.amplitude)).expect("cosines");
        assert!(
            (found.amplitude - 3.0).abs() < 1e-12 && (found.frequency - 0.1).abs() < 1e-15 && (found.phase - 1.0).abs() < 1e-12
        );
        assert!((peak(&cosines, 0.01) - 0.1).abs() < 1e-12);
    }
}
