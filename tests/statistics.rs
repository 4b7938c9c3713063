//! Statistics of a random sea against samples of known distributions, closed forms and the example of the standard.

#[path = "support/random.rs"]
#[allow(dead_code, reason = "other tests use more of it")]
mod random;

use moorline::report::extremes::{Maxima, NoFit, STORM, Weibull};
use moorline::report::rainflow::{Curve, Cycle, Rainflow};
use moorline::report::welch::{self, Spectrum};
use random::Random;
use realfft::RealFftPlanner;
use std::f64::consts::{PI, SQRT_2, TAU};

fn close(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value / expected - 1.0).abs() <= tolerance, "{what}: {value} instead of {expected}");
}

/// Rows of a Gaussian process, 0.5 s apart, of variance `std`² and with the spectrum of a narrow sea (JONSWAP, 3.3, peak 10 s): each of
/// very many frequencies has sine and cosine parts of its own, which are normal.
fn sea(random: &mut Random, std: f64, rows: usize) -> Vec<f64> {
    let (step, fp) = (0.5, 0.1);
    let transform = RealFftPlanner::<f64>::new().plan_fft_inverse(rows);
    let (mut lines, mut values) = (transform.make_input_vec(), transform.make_output_vec());
    let mut variance = 0.0;
    for (k, line) in lines.iter_mut().enumerate() {
        let f = k as f64 / (rows as f64 * step);
        if !(0.04..0.3).contains(&f) {
            continue;
        }
        let sigma: f64 = if f <= fp { 0.07 } else { 0.09 };
        let peak = (-((f / fp - 1.0) / sigma).powi(2) / 2.0).exp();
        let density = f.powi(-5) * (-1.25 * (fp / f).powi(4)).exp() * 3.3_f64.powf(peak);
        let (size, phase) = ((density * -random.share().max(1.0e-300).ln()).sqrt(), TAU * random.share());
        (line.re, line.im) = (size * phase.cos(), size * phase.sin());
        variance += 2.0 * density;
    }
    transform.process(&mut lines, &mut values).expect("vectors of its own");
    values.iter_mut().for_each(|value| *value *= std / variance.sqrt());
    values
}

/// A sample of Weibull's law comes back with its shape and scale, within the error that the fit states: of 200 samples, shape, scale and
/// most probable maximum lie within 1.645 standard errors (or the interval) in about 90 %, and within 4 in all.
#[test]
fn samples_of_weibull_give_shape_and_scale_back_within_the_stated_error() {
    for (shape, scale) in [(2.0, 3.0e5), (1.3, 8.0), (0.8, 2.0e6)] {
        let (mut held, mut most) = ([0; 3], 0.0_f64);
        for seed in 0..200 {
            let mut random = Random::new(seed);
            let sample: Vec<f64> = (0..800).map(|_| scale * (-random.share().max(1.0e-300).ln()).powf(1.0 / shape)).collect();
            let fit = Weibull::fit(&sample).expect("a fit");
            let of_shape = (fit.shape - shape) / fit.shape_error;
            let of_scale = (fit.scale - scale) / fit.scale_error;
            let exact = scale * 1000.0_f64.ln().powf(1.0 / shape);
            let found = fit.most_probable(1000.0);
            let within =
                [of_shape.abs() < 1.645, of_scale.abs() < 1.645, (found.interval[0]..found.interval[1]).contains(&exact)];
            held.iter_mut().zip(within).for_each(|(held, within)| *held += i32::from(within));
            most = most.max(of_shape.abs()).max(of_scale.abs());
        }
        // Binomial: 180 of 200 with a standard deviation of 4.2; neighbours make the error itself uncertain.
        assert!(held.iter().all(|held| (165..=195).contains(held)), "shape {shape}: {held:?} of 200 within 90 %");
        assert!(most < 4.5, "shape {shape}: {most} standard errors");
    }
}

/// The maxima of a Gaussian process give sigma·sqrt(2 ln N), N the number of maxima in 3 h. Each of 60 storms is as sure as it says,
/// though its waves come in groups; all of them together are a twentieth as uncertain, and meet it to 2 %.
#[test]
fn a_gaussian_process_gives_the_most_probable_maximum_of_rayleigh() {
    let std = 2.0e5;
    let (mut held, mut all) = (0, Vec::new());
    for seed in 0..60 {
        let mut random = Random::new(1000 + seed);
        let values = sea(&mut random, std, 21_600);
        let maxima = Maxima::of(&values, 0.5, values.iter().sum::<f64>() / values.len() as f64);
        let number = STORM / maxima.period().expect("maxima");
        let exact = std * (2.0 * number.ln()).sqrt();
        let found = Weibull::fit(&maxima.above).expect("a fit").most_probable(number);
        held += i32::from((found.interval[0]..found.interval[1]).contains(&exact));
        all.push(maxima);
    }
    assert!((46..=59).contains(&held), "{held} of 60 intervals of 90 % hold it");
    let together = Maxima::together(all.iter());
    let number = STORM / together.period().expect("maxima");
    let fit = Weibull::fit(&together.above).expect("a fit");
    let found = fit.most_probable(number);
    close(found.value, std * (2.0 * number.ln()).sqrt(), 0.02, "most probable maximum");
    close(fit.shape, 2.0, 0.05, "shape");
    close(fit.scale, SQRT_2 * std, 0.03, "scale");
    close((found.interval[1] - found.interval[0]) / found.value, 0.02, 0.5, "width of the interval");
}

/// A line that rings between snaps has many small maxima that follow a law of their own; they do not bend the law of the large ones, and
/// what follows no law is said to follow none.
#[test]
fn many_small_maxima_do_not_bend_the_law_of_the_large_ones() {
    let (mut held, mut ratio) = (0, 0.0);
    for seed in 0..50 {
        let mut random = Random::new(300 + seed);
        let mut law = |shape: f64, scale: f64| scale * (-random.share().max(1.0e-300).ln()).powf(1.0 / shape);
        // Five ripples to every wave; a tenth of the size.
        let sample: Vec<f64> = (0..6000).map(|k| if k % 6 == 0 { law(1.5, 1.0e5) } else { law(2.0, 1.0e4) }).collect();
        // In 3 h, 1000 waves.
        let exact = 1.0e5 * 1000.0_f64.ln().powf(1.0 / 1.5);
        let fit = Weibull::fit(&sample).expect("a fit");
        assert!(fit.share < 0.3, "ripples are fitted: {fit:?}");
        let found = fit.most_probable(6000.0);
        held += i32::from((found.interval[0]..found.interval[1]).contains(&exact));
        ratio += found.value / exact / 50.0;
    }
    close(ratio, 1.0, 0.08, "most probable maximum");
    assert!((38..=50).contains(&held), "{held} of 50 intervals of 90 % hold it");
    // Maxima of three sizes.
    let three: Vec<f64> = (0..2000).map(|k| [1.0, 3.0, 5.0][k % 3]).collect();
    assert!(Weibull::fit(&three).is_ok_and(|law| !law.follows));
}

/// Maxima, their number and their period by hand: what comes before the first up-crossing and after the last does not count.
#[test]
fn between_two_up_crossings_lies_one_maximum() {
    let values = [5.0, -1.0, 1.0, 3.0, 2.0, -2.0, 2.0, 1.0, 4.0, -4.0, 4.0, 9.0];
    let maxima = Maxima::of(&values, 0.1, 0.0);
    assert_eq!(maxima.above, [3.0, 4.0]);
    assert!((maxima.duration - 0.8).abs() < 1.0e-12, "{}", maxima.duration);
    assert_eq!(Maxima::of(&[1.0; 50], 0.1, 1.0), Maxima::default());
    assert_eq!(Maxima::of(&[], 0.1, 0.0).period(), None);
}

/// Where there is nothing to fit, that is said, and no number is made up.
#[test]
fn what_is_no_random_sea_has_no_most_probable_maximum() {
    let sine: Vec<f64> = (0..4000).map(|k| (0.0628 * k as f64).sin()).collect();
    let regular = Maxima::of(&sine, 0.1, 0.0);
    assert!(regular.above.len() > 30);
    assert_eq!(Weibull::fit(&regular.above), Err(NoFit::NotRandom));
    assert_eq!(Weibull::fit(&[1.0; 100]), Err(NoFit::NotRandom));
    assert_eq!(Weibull::fit(&[1.0; 29]), Err(NoFit::Few(29)));
    assert!(NoFit::Few(29).to_string().contains("29 maxima"));
}

/// A sine: its spectrum peaks at its frequency, and its integral is its variance, a²/2.
#[test]
fn the_spectrum_of_a_sine_has_its_frequency_and_variance() {
    let sine = |amplitude: f64, period: f64| -> Vec<f64> {
        (0..60_000).map(|k| 7.0e5 + amplitude * (TAU * 0.1 * k as f64 / period + 0.3).sin()).collect()
    };
    for (amplitude, period) in [(3.0e4, 11.3), (2.0, 7.0)] {
        let Spectrum { step, density, segments } = welch::spectrum(&sine(amplitude, period), 0.1, period).expect("a spectrum");
        assert!(segments >= 10, "{segments} segments");
        let spectrum = Spectrum { step, density, segments };
        let peak = spectrum.peak().expect("a peak");
        assert!((peak - 1.0 / period).abs() < 0.2 * step, "peak at {peak} Hz");
        close(spectrum.variance(), 0.5 * amplitude * amplitude, 1.0e-3, "variance");
    }
}

/// Noise without memory has the flat spectrum 2·variance·step, up to the highest frequency; a sea has its variance and its peak.
#[test]
fn the_spectrum_of_noise_is_flat_and_a_sea_has_its_variance() {
    let mut random = Random::new(5);
    let noise: Vec<f64> = (0..200_000).map(|_| random.between(-1.0, 1.0)).collect();
    let spectrum = welch::spectrum(&noise, 0.25, 0.5).expect("a spectrum");
    let third = spectrum.density.len() / 3;
    for part in [1..third, third..2 * third, 2 * third..3 * third - 1] {
        let number = part.len() as f64;
        close(spectrum.density[part].iter().sum::<f64>() / number, 2.0 * 0.25 / 3.0, 0.03, "density");
    }
    let values = sea(&mut random, 4.0, 100_000);
    let variance = values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64;
    let spectrum = welch::spectrum(&values, 0.5, 8.0).expect("a spectrum");
    close(spectrum.variance(), variance, 0.02, "variance");
    close(spectrum.peak().expect("a peak"), 0.1, 0.06, "peak");
    // Nothing of that sea lies above 0.3 Hz.
    let held = spectrum.rows_with(0.999) as f64 * spectrum.step;
    assert!((0.15..0.31).contains(&held), "{held} Hz");
    assert!(welch::spectrum(&[1.0; 15], 0.1, 1.0).is_none() && welch::spectrum(&[f64::NAN; 99], 0.1, 1.0).is_none());
}

fn count(values: &[f64]) -> Vec<Cycle> {
    let mut rainflow = Rainflow::default();
    values.iter().for_each(|value| rainflow.push(*value));
    rainflow.cycles()
}

/// The example of ASTM E1049-85, figure 6: the ranges and how often they count.
#[test]
fn rainflow_counts_the_example_of_the_standard() {
    let cycles = count(&[-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]);
    let of_range = |range: f64| cycles.iter().filter(|cycle| cycle.range == range).map(|cycle| cycle.count).sum::<f64>();
    let counts = [3.0, 4.0, 6.0, 8.0, 9.0].map(of_range);
    assert_eq!(counts, [0.5, 1.5, 0.5, 1.0, 0.5]);
    assert_eq!(cycles.iter().map(|cycle| cycle.count).sum::<f64>(), 4.0, "no other ranges");
    // Its one full cycle goes from -1 to 3.
    assert!(cycles.contains(&Cycle { range: 4.0, mean: 1.0, count: 1.0 }));
    // Values on the way from turning point to turning point, and pauses, change nothing.
    let slow = [-2.0, -1.0, 0.5, 1.0, 1.0, 0.0, -3.0, 1.0, 5.0, 5.0, 5.0, -1.0, 2.0, 2.5, 3.0, -4.0, 4.0, 0.0, -2.0, -2.0];
    assert_eq!(count(&slow), cycles);
    assert_eq!(count(&[1.0, 1.0]), []);
}

/// What is open at any time counts as halves, and looking does not disturb the counting.
#[test]
fn a_look_does_not_disturb_the_count() {
    let mut random = Random::new(3);
    let (mut watched, mut alone) = (Rainflow::default(), Rainflow::default());
    for _ in 0..3000 {
        let value = random.between(0.0, 1.0);
        watched.push(value);
        alone.push(value);
        let _ = watched.cycles();
    }
    assert_eq!(watched.cycles(), alone.cycles());
    // Half a cycle from every turning point to the next, whatever they are paired with: about two thirds of random values turn.
    let total: f64 = alone.cycles().iter().map(|cycle| cycle.count).sum();
    assert!((950.0..1050.0).contains(&total), "{total}");
}

/// n cycles of one amplitude do the damage n/N, N = k (range / breaking load)^-m; two amplitudes add up (Palmgren and Miner).
#[test]
fn damage_of_a_constant_amplitude_is_n_over_n_to_failure() {
    let curve = Curve { m: 3.0, k: 316.0, breaking_load: 6.0e6 };
    let wave = |amplitude: f64, cycles: usize| (0..=20 * cycles).map(move |k| 1.0e6 + amplitude * (PI * k as f64 / 10.0).cos());
    let counted = count(&wave(3.0e5, 250).collect::<Vec<_>>());
    let damage = curve.damage(&counted);
    let to_failure = 316.0 * (6.0e5_f64 / 6.0e6).powi(-3);
    close(damage.damage, 250.0 / to_failure, 1.0e-12, "damage");
    assert_eq!(damage.cycles, 250.0);
    close(damage.largest_range, 6.0e5, 1.0e-12, "largest range");
    close(damage.equivalent_range, 6.0e5, 1.0e-12, "equivalent range");
    let both = count(&wave(3.0e5, 250).chain(wave(1.0e5, 90)).collect::<Vec<_>>());
    let small = 90.0 / (316.0 * (2.0e5_f64 / 6.0e6).powi(-3));
    // On the way from the one to the other lies half a range of its own; it is small beside both.
    close(curve.damage(&both).damage, 250.0 / to_failure + small, 2.0e-3, "damage of both");
    assert_eq!(curve.damage(&[]).damage, 0.0);
    assert_eq!(curve.damage(&[]).equivalent_range, 0.0);
}

/// The damage of a narrow Gaussian process has a closed form: n/k·(2·sqrt(2)·std/breaking load)^m·Γ(1 + m/2); rainflow ranges of a sea
/// that is not quite narrow do a little less (Wirsching and Light 1980: a few per cent for m = 3).
#[test]
fn damage_of_a_narrow_sea_is_that_of_the_closed_form() {
    let curve = Curve { m: 3.0, k: 1000.0, breaking_load: 5.0e6 };
    let (mut found, mut expected) = (0.0, 0.0);
    for seed in 0..10 {
        let std = 1.5e5;
        let values = sea(&mut Random::new(77 + seed), std, 21_600);
        let cycles = Maxima::of(&values, 0.5, 0.0).above.len() as f64;
        // Γ(2.5) = 1.5·0.5·sqrt(π).
        expected += cycles / 1000.0 * (2.0 * SQRT_2 * std / 5.0e6).powi(3) * 0.75 * PI.sqrt();
        found += curve.damage(&count(&values)).damage;
    }
    let ratio = found / expected;
    assert!((0.85..1.02).contains(&ratio), "{ratio} of the narrow-band damage");
}
