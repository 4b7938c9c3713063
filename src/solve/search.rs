//! How far to go along a Newton step: as far as the energy falls.
//!
//! Where forces come from an energy (or, in a time step, from an incremental one with inertia), the residual times the step is the
//! slope of that energy along it. A line that goes slack and taut has a convex energy with a kink in its slope; a step that stops
//! where the slope vanishes converges from anywhere, a whole one may cycle.

/// The share of a step to take, from the slope of the energy along it as a function of the share. `slope` is left evaluated at the
/// share returned; 0 is returned if the slope at the start is not finite.
pub fn share(mut slope: impl FnMut(f64) -> f64) -> f64 {
    let before = slope(0.0);
    if !before.is_finite() {
        return 0.0;
    }
    let enough = before.abs();
    let (mut low, mut high) = ((0.0, before), None::<(f64, f64)>);
    let mut share = 1.0;
    for _ in 0..12 {
        let here = slope(share);
        if here.is_finite() && here <= 0.1 * enough && (here >= -0.5 * enough || high.is_none()) {
            return share;
        }
        if here < 0.0 {
            low = (share, here);
        } else {
            high = Some((share, if here.is_finite() { here } else { f64::INFINITY }));
        }
        let Some(high) = high else { return share };
        // Between regula falsi and bisection, so that a steep wall on one side does not stop the search.
        let chord = if high.1.is_finite() { low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1) } else { low.0 };
        let width = high.0 - low.0;
        share = chord.clamp(low.0 + 0.1 * width, high.0 - 0.1 * width);
    }
    slope(share);
    share
}

/// Slopes over that at the start between which a share across kinks is good enough.
const GOOD: [f64; 2] = [-0.2, 0.1];
/// Bounds on the share that differ by more than this factor differ in size: between them it is sought by size.
const FAR: f64 = 10.0;

/// The same where kink stands behind kink: in a time step, a line goes taut point by point.
///
/// Behind each kink the slope rises a million times as steeply as before it, so that the chord between a place before and one behind always ends at its foot. The line
/// through the last two places behind meets zero where they would, if no kink were left: behind what is sought, where the slope is convex, and nearer with every kink
/// that has been passed.
pub fn across_kinks(mut slope: impl FnMut(f64) -> f64) -> f64 {
    let before = slope(0.0);
    if !before.is_finite() {
        return 0.0;
    }
    let good = GOOD.map(|share| share * before.abs());
    // Places and slopes before and behind what is sought; of those behind, the last two.
    let (mut low, mut high, mut higher) = ((0.0, before), None::<(f64, f64)>, None::<(f64, f64)>);
    let mut share = 1.0;
    for tried in 1..=12 {
        let here = slope(share);
        if here <= good[1] && (here >= good[0] || high.is_none()) {
            return share;
        }
        if here < 0.0 {
            low = (share, here);
        } else {
            higher = high;
            high = Some((share, if here.is_finite() { here } else { f64::INFINITY }));
        }
        let Some(high) = high else { return share };
        let width = high.0 - low.0;
        let steeper = higher.filter(|higher| higher.1.is_finite() && higher.1 > high.1);
        let foot = steeper.map(|higher| high.0 - high.1 * (higher.0 - high.0) / (higher.1 - high.1));
        let chord = if high.1.is_finite() { low.0 - low.1 * width / (high.1 - low.1) } else { low.0 };
        share = match foot.filter(|share| *share > low.0 && *share < high.0) {
            Some(share) => share,
            None if !(here < 0.0) && higher.is_none() => low.0 + if low.0 > 0.0 { 0.5 } else { 0.3 } * width,
            None if low.0 > 0.0 && high.0 > FAR * low.0 => (low.0 * high.0).sqrt(),
            None if tried % 3 == 0 => low.0 + 0.5 * width,
            None => chord.clamp(low.0 + 0.1 * width, high.0 - 0.1 * width),
        };
    }
    slope(share);
    share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::random::SplitMix;

    /// Energy with a wall at 0.01: slope -1 before, 1e6 (x - 0.01) - 1 beyond. The share found must have a slope within [-0.5, 0.1].
    #[test]
    fn a_steep_wall_is_found() {
        let slope = |x: f64| if x < 0.01 { -1.0 } else { 1.0e6 * (x - 0.01) - 1.0 };
        let found = share(slope);
        assert!((-0.5..=0.1).contains(&slope(found)), "{found}");
    }

    /// Walls anywhere, of any steepness and one behind the other: a share is found always, and soon. (`share` takes 8.6 slopes on average, and in one case of six
    /// finds none.)
    #[test]
    fn walls_behind_walls_are_found_soon() {
        let (mut random, mut asked) = (SplitMix(11), 0);
        for _ in 0..1000 {
            let mut number = |least: f64, most: f64| least + (most - least) * random.uniform();
            let walls: Vec<(f64, f64)> =
                (0..number(1.0, 7.0) as usize).map(|_| (10f64.powf(number(-5.0, 0.0)), 10f64.powf(number(0.0, 6.0)))).collect();
            let slope = |x: f64| x - 1.0 + walls.iter().map(|(place, rise)| rise * (x - place).max(0.0)).sum::<f64>();
            let found = across_kinks(|x| {
                asked += 1;
                slope(x)
            });
            assert!((-0.2..=0.1).contains(&slope(found)), "{found} of {walls:?}");
        }
        assert!(asked < 6500, "{asked} slopes");
    }

    #[test]
    fn a_good_step_is_taken_whole() {
        assert_eq!(share(|x| x - 1.0), 1.0);
        assert_eq!(across_kinks(|x| x - 1.0), 1.0);
    }
}
