//! The largest tension of a storm, from the maxima of a part of it
//!
//! Between two neighbouring up-crossings of the mean lies one maximum; what it is above the mean is taken to follow a law of Weibull,
//! P(larger than x) = exp(-(x/scale)^shape), above a threshold: the fit is by maximum likelihood, and of the maxima below only their number
//! counts, so that small ones do not bend the tail. The threshold is the median if the maxima above it follow the law, or else the upper
//! quarter, eighth, … of the maxima is fitted by itself: a line that snaps now and then rings in between, and has many small maxima that
//! say nothing of the large ones. Then the law is P(larger than x) = exp(offset - (x/scale)^shape), the share of those that are fitted
//! being that of the sample. In a storm with n maxima, the most probable maximum is the one that one maximum in n exceeds:
//! mean + scale·(offset + ln n)^(1/shape). Of a Gaussian process, whose maxima follow Rayleigh's law (shape 2, scale sqrt(2)·std), that is
//! std·sqrt(2 ln n).
//!
//! Maxima follow the law where the distance of their distribution from it (Kolmogorov and Smirnov) is less than one sample in a hundred of
//! such a law has (Chandra, Singpurwalla and Stephens 1981), and the largest is neither smaller nor larger than one in a hundred has.
//!
//! How sure the fit is comes from the likelihood itself, in the form that does not take one maximum to be independent of its neighbours,
//! which in groups of waves it is not (Newey and West 1987).

/// Fewest maxima of which a law is fitted.
pub const FEWEST: usize = 30;
/// Duration of the storm [s].
pub const STORM: f64 = 10_800.0;
/// Fewest of them above the threshold, beyond the first.
const FEWEST_ABOVE: usize = 30;
/// Highest threshold: the upper half, halved so many times.
const HALVINGS: u32 = 5;
/// Distance of distributions times the square root of the number of values that one sample in a hundred exceeds.
const FAR: f64 = 1.007;
/// Probability of the largest value below which, and above one less which, it does not belong to the law.
const ODD: f64 = 0.005;
/// Quantile of the normal distribution of an interval that holds 90 %.
const NINETY: f64 = 1.644_853_626_951_472_2;
/// Shapes beyond which maxima are not those of a random sea; 2 is a Gaussian process, 1 an exponential tail.
const SHAPES: [f64; 2] = [0.2, 20.0];

/// The maxima between mean up-crossings.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Maxima {
    /// What they are above the mean [N], in time; all > 0.
    pub above: Vec<f64>,
    /// Time from the first up-crossing to the last [s].
    pub duration: f64,
}

impl Maxima {
    /// The maxima of values `step` [s] apart about their mean.
    pub fn of(values: &[f64], step: f64, mean: f64) -> Maxima {
        let mut above = Vec::new();
        // The largest value since the last up-crossing, and the times of the first and last one in steps.
        let (mut largest, mut first, mut last): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
        for (k, pair) in values.windows(2).enumerate() {
            if pair[0] <= mean && pair[1] > mean {
                let crossing = k as f64 + (mean - pair[0]) / (pair[1] - pair[0]);
                match largest {
                    Some(value) => above.push(value - mean),
                    None => first = crossing,
                }
                (largest, last) = (Some(pair[1]), crossing);
            }
            largest = largest.map(|value| value.max(pair[1]));
        }
        Maxima { above, duration: (last - first) * step }
    }

    /// Mean time from one up-crossing to the next [s]; `None` where there is no such time.
    pub fn period(&self) -> Option<f64> {
        (!self.above.is_empty()).then(|| self.duration / self.above.len() as f64)
    }

    /// The maxima of several runs of one sea, as if of one run.
    pub fn together<'a>(runs: impl Iterator<Item = &'a Maxima>) -> Maxima {
        runs.fold(Maxima::default(), |mut all, run| {
            all.above.extend(&run.above);
            all.duration += run.duration;
            all
        })
    }
}

/// The law that the maxima follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weibull {
    /// Shape [-].
    pub shape: f64,
    /// Its standard error.
    pub shape_error: f64,
    /// Scale [N].
    pub scale: f64,
    /// Its standard error [N].
    pub scale_error: f64,
    /// The maxima from this one on are fitted [N above the mean].
    pub threshold: f64,
    /// Which share of all maxima these are.
    pub share: f64,
    /// Logarithm of the share of all that the law would have above 0 [-]: 0 where the number of those below counts.
    pub offset: f64,
    /// Whether they follow the law.
    pub follows: bool,
    /// How many are fitted.
    count: usize,
    /// Covariance of ln(scale) and shape.
    covariance: Symmetric,
}

/// The most probable maximum, above the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MostProbable {
    /// It [N].
    pub value: f64,
    /// Where it lies with 90 % probability, as far as the fit is uncertain [N].
    pub interval: [f64; 2],
}

/// Why no law was fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoFit {
    /// So few maxima.
    Few(usize),
    /// They are all of nearly the same size, or of wildly different sizes: not those of a random sea.
    NotRandom,
}

impl std::fmt::Display for NoFit {
    fn fmt(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            NoFit::Few(maxima) => write!(text, "{maxima} maxima between mean up-crossings; a fit needs {FEWEST}: run longer"),
            NoFit::NotRandom => write!(text, "the maxima do not spread as those of a random sea"),
        }
    }
}

impl Weibull {
    /// Fits the law to maxima above the mean, which stand in the order of time.
    pub fn fit(above: &[f64]) -> Result<Weibull, NoFit> {
        if above.len() < FEWEST {
            return Err(NoFit::Few(above.len()));
        }
        let mut sorted = above.to_vec();
        sorted.sort_by(|a, b| b.total_cmp(a));
        let counts = (1..=HALVINGS).map(|halvings| sorted.len() >> halvings);
        let mut best = Err(NoFit::NotRandom);
        for (number, count) in counts.enumerate() {
            if number > 0 && count < FEWEST_ABOVE {
                break;
            }
            let law = Weibull::fit_highest(above, &sorted, count, number > 0);
            if law.is_ok() || best.is_err() {
                best = law;
            }
            if best.is_ok_and(|law| law.follows) {
                break;
            }
        }
        best
    }

    /// Fits it to the highest so many, given also in falling order; `alone`: the number of those below does not count.
    fn fit_highest(above: &[f64], sorted: &[f64], count: usize, alone: bool) -> Result<Weibull, NoFit> {
        let (threshold, high) = (sorted[count - 1], sorted[count / 5]);
        let spread = (high / threshold).ln();
        if !(threshold > 0.0 && spread.is_finite() && spread > 1.0e-3) {
            return Err(NoFit::NotRandom);
        }
        // In units of the threshold, so that likelihoods are of a size to reckon with.
        let maxima: Vec<f64> = above.iter().map(|x| x / threshold).collect();
        let rarity = |number: usize| (sorted.len() as f64 / number as f64).ln();
        let shape = (rarity(count / 5 + 1) / rarity(count)).ln() / spread;
        let start = [-rarity(count).ln() / shape, shape];
        let [ln_scale, shape] = most_likely(&maxima, alone, start).ok_or(NoFit::NotRandom)?;
        if !(SHAPES[0]..=SHAPES[1]).contains(&shape) {
            return Err(NoFit::NotRandom);
        }
        let covariance = covariance(&maxima, alone, [ln_scale, shape]).ok_or(NoFit::NotRandom)?;
        let scale = threshold * ln_scale.exp();
        let [var_scale, _, var_shape] = covariance;
        let share = count as f64 / sorted.len() as f64;
        let law = Weibull {
            shape,
            shape_error: var_shape.sqrt(),
            scale,
            scale_error: scale * var_scale.sqrt(),
            threshold,
            share,
            offset: if alone { share.ln() + (-shape * ln_scale).exp() } else { 0.0 },
            follows: false,
            count,
            covariance,
        };
        Ok(Weibull { follows: law.is_followed(sorted, count), ..law })
    }

    /// Whether the highest so many, in falling order, follow the law.
    fn is_followed(&self, sorted: &[f64], count: usize) -> bool {
        // Among those above the threshold, the share that exceeds each by the law, and in the sample.
        let above = self.exceedance(self.threshold);
        let number = count as f64;
        let distance = sorted[..count].iter().enumerate().map(|(rank, x)| {
            let share = self.exceedance(*x) / above;
            (share - rank as f64 / number).abs().max((share - (rank + 1) as f64 / number).abs())
        });
        let far = distance.fold(0.0, f64::max) * number.sqrt();
        let largest = (-self.exceedance(sorted[0]) * sorted.len() as f64).exp();
        far <= FAR && (ODD..=1.0 - ODD).contains(&largest)
    }

    /// The most probable maximum of so many maxima, more than 1.
    pub fn most_probable(&self, maxima: f64) -> MostProbable {
        let z = self.offset + maxima.ln();
        let value = self.scale * z.powf(self.shape.recip());
        // Of its logarithm, along ln(scale) and shape: the threshold keeps its share.
        let mut slope = [1.0, -z.ln() / (self.shape * self.shape)];
        let [a, b, c] = self.covariance;
        let mut variance = 0.0;
        if self.offset != 0.0 {
            let w = (self.threshold / self.scale).ln();
            let kept = (self.shape * w).exp() / z;
            slope[0] -= kept;
            slope[1] += w * kept / self.shape;
            // The share itself is that of a sample.
            variance = (self.shape * z).powi(-2) / self.count as f64;
        }
        variance += a * slope[0] * slope[0] + 2.0 * b * slope[0] * slope[1] + c * slope[1] * slope[1];
        let error = variance.sqrt();
        MostProbable { value, interval: [value * (-NINETY * error).exp(), value * (NINETY * error).exp()] }
    }

    /// Probability that a maximum exceeds `above` [N above the mean], from the threshold on.
    pub fn exceedance(&self, above: f64) -> f64 {
        (self.offset - (above / self.scale).powf(self.shape)).exp()
    }
}

/// A symmetric 2×2 matrix: its upper triangle by rows.
type Symmetric = [f64; 3];

/// One maximum's part of the log-likelihood, its gradient and its second derivatives in ln(scale) and shape. Values are over the
/// threshold, 1; of those below it only that counts, or, where those above are `alone`, nothing.
fn likelihood(x: f64, alone: bool, [ln_scale, shape]: [f64; 2]) -> (f64, [f64; 2], Symmetric) {
    // At the threshold: z, and its derivatives.
    let w = -ln_scale;
    let z = (shape * w).exp();
    let dz = [-shape * z, w * z];
    let ddz = [shape * shape * z, -z - shape * w * z, w * w * z];
    if x >= 1.0 {
        let kept = if alone { 1.0 } else { 0.0 };
        let w = x.ln() - ln_scale;
        let own = (shape * w).exp();
        let value = shape.ln() + shape * w - x.ln() - own + kept * z;
        let slope = [shape * (own - 1.0) + kept * dz[0], shape.recip() + w * (1.0 - own) + kept * dz[1]];
        let second = [-shape * shape * own, own - 1.0 + shape * w * own, -shape.powi(-2) - w * w * own];
        return (value, slope, std::array::from_fn(|k| second[k] + kept * ddz[k]));
    }
    if alone {
        return (0.0, [0.0; 2], [0.0; 3]);
    }
    let below = -(-z).exp_m1();
    let q = (-z).exp() / below;
    let dq = -q * (1.0 + q);
    let second = [(0, 0), (0, 1), (1, 1)];
    let second = std::array::from_fn(|k| dq * dz[second[k].0] * dz[second[k].1] + q * ddz[k]);
    (below.ln(), [q * dz[0], q * dz[1]], second)
}

/// Value, gradient and second derivatives of all.
fn sum(maxima: &[f64], alone: bool, at: [f64; 2]) -> (f64, [f64; 2], Symmetric) {
    let mut sums = (0.0, [0.0; 2], [0.0; 3]);
    for x in maxima {
        let (value, slope, second) = likelihood(*x, alone, at);
        sums.0 += value;
        sums.1.iter_mut().zip(slope).for_each(|(sum, part)| *sum += part);
        sums.2.iter_mut().zip(second).for_each(|(sum, part)| *sum += part);
    }
    sums
}

/// Newton's method from a start near it; `None` where it leads nowhere.
fn most_likely(maxima: &[f64], alone: bool, start: [f64; 2]) -> Option<[f64; 2]> {
    let mut at = start;
    let (mut value, mut slope, mut second) = sum(maxima, alone, at);
    for _ in 0..60 {
        // Uphill also where the likelihood is not yet concave.
        let way = inverse(second).filter(|inverse| inverse[0] < 0.0 && determinant(*inverse) > 0.0);
        let step = way.map_or_else(|| slope.map(|s| s / maxima.len() as f64), |inverse| times(inverse, slope).map(|s| -s));
        if step[0].abs() + step[1].abs() / at[1] < 1.0e-12 {
            return Some(at);
        }
        let better = (0..40).find_map(|halvings| {
            let next = [0, 1].map(|k| at[k] + step[k] * 0.5_f64.powi(halvings));
            let there = (next[1] > 0.0).then(|| sum(maxima, alone, next))?;
            (there.0 > value).then_some((next, there))
        });
        match better {
            Some((next, there)) => (at, (value, slope, second)) = (next, there),
            // No step gains anything any more: the top, to rounding.
            None => return (step[0].abs() + step[1].abs() / at[1] < 1.0e-5).then_some(at),
        }
    }
    None
}

/// Covariance of ln(scale) and shape: H⁻¹ S H⁻¹, S being the sum of products of the parts of the gradient with their neighbours.
fn covariance(maxima: &[f64], alone: bool, at: [f64; 2]) -> Option<Symmetric> {
    let (_, _, second) = sum(maxima, alone, at);
    let bread = inverse(second)?;
    let scores: Vec<[f64; 2]> = maxima.iter().map(|x| likelihood(*x, alone, at).1).collect();
    let neighbours = (maxima.len() as f64).cbrt().ceil() as usize;
    let mut filling = [0.0; 3];
    for apart in 0..=neighbours {
        let weight = (1.0 - apart as f64 / (neighbours + 1) as f64) * if apart == 0 { 0.5 } else { 1.0 };
        for (one, other) in scores.iter().zip(&scores[apart..]) {
            filling[0] += weight * 2.0 * one[0] * other[0];
            filling[1] += weight * (one[0] * other[1] + one[1] * other[0]);
            filling[2] += weight * 2.0 * one[1] * other[1];
        }
    }
    let [left, right] = [times(bread, [filling[0], filling[1]]), times(bread, [filling[1], filling[2]])];
    let [top, bottom] = [times(bread, [left[0], right[0]]), times(bread, [left[1], right[1]])];
    let all = [top[0], 0.5 * (top[1] + bottom[0]), bottom[1]];
    (all[0] > 0.0 && all[2] > 0.0 && determinant(all) >= 0.0).then_some(all)
}

fn determinant([a, b, c]: Symmetric) -> f64 {
    a * c - b * b
}

fn inverse(of: Symmetric) -> Option<Symmetric> {
    let determinant = determinant(of);
    let [a, b, c] = of;
    (determinant.is_finite() && determinant != 0.0).then(|| [c / determinant, -b / determinant, a / determinant])
}

fn times([a, b, c]: Symmetric, v: [f64; 2]) -> [f64; 2] {
    [a * v[0] + b * v[1], b * v[0] + c * v[1]]
}
