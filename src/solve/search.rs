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

#[cfg(test)]
mod tests {
    use super::*;

    /// Energy with a wall at 0.01: slope -1 before, 1e6 (x - 0.01) - 1 beyond. The share found must have a slope within [-0.5, 0.1].
    #[test]
    fn a_steep_wall_is_found() {
        let slope = |x: f64| if x < 0.01 { -1.0 } else { 1.0e6 * (x - 0.01) - 1.0 };
        let found = share(slope);
        assert!((-0.5..=0.1).contains(&slope(found)), "{found}");
    }

    #[test]
    fn a_good_step_is_taken_whole() {
        assert_eq!(share(|x| x - 1.0), 1.0);
    }
}
