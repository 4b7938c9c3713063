//! Whether the velocities that a master sends are those of its positions.
//!
//! ```text
//! c ← (1 - 1/32) c + ∫ v dt - Δx,   p ← (1 - 1/32) p + Δx       from one fresh sample to the next
//! ```
//!
//! ∫ v is that of the parabola through three velocities, good to (ω h)⁴/180 of a motion. Velocities of another point, of slow motion alone, in
//! another frame or unit, or of no axis at all make c a part of p; noise of the positions does not add up in c. Where the mean of c² is
//! more than a hundredth of that of p² (and c more than a few millimetres), velocities on that axis are not believed until
//! they fit again to a fiftieth.

/// Sums forget a part of this of themselves with each sample.
const MEMORY: f64 = 32.0;
/// Samples before a verdict.
const ENOUGH: u32 = 8;
/// c/p above which velocities are not believed, and below which they are again.
const MISFIT: f64 = 0.1;
const FIT: f64 = 0.02;
/// Root mean square of c below which there is no verdict [m].
const LEAST: f64 = 5.0e-3;

/// Position [m] and velocity [m/s] on one axis at a time [s].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Time [s].
    pub time: f64,
    /// Position [m].
    pub position: f64,
    /// Velocity [m/s].
    pub velocity: f64,
}

/// What is known of the fit on one axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fit {
    /// The last two samples, the newest first, and how many have been.
    pub last: [Point; 2],
    /// Samples seen.
    pub count: u32,
    /// c and p [m].
    pub sums: [f64; 2],
    /// Means of c² and p² [m²].
    pub squares: [f64; 2],
    /// The velocities are not believed.
    pub misfit: bool,
}

impl Fit {
    /// Looks at a fresh sample.
    pub fn look(&mut self, now: Point) {
        let [middle, first] = self.last;
        if self.count >= 2 && now.time > middle.time && middle.time > first.time {
            let step = now.position - middle.position;
            let error = integral(&first, &middle, &now) - step;
            let keep = 1.0 - 1.0 / MEMORY;
            self.sums = [keep * self.sums[0] + error, keep * self.sums[1] + step];
            let weight = 1.0 / f64::from(self.count - 1).min(MEMORY);
            for (mean, sum) in self.squares.iter_mut().zip(self.sums) {
                *mean += weight * (sum * sum - *mean);
            }
            if self.count >= ENOUGH {
                let share = self.share();
                self.misfit = if self.misfit { share > FIT } else { share > MISFIT && self.squares[0].sqrt() > LEAST };
            }
        }
        self.last = [now, middle];
        self.count = self.count.saturating_add(1);
    }

    /// How large the motion is that positions and velocities do not share, as a part of that of the positions.
    pub fn share(&self) -> f64 {
        (self.squares[0] / self.squares[1].max(f64::MIN_POSITIVE)).sqrt().min(1.0e3)
    }
}

/// ∫ v from the second to the third time, of the parabola through three velocities [m].
fn integral(first: &Point, middle: &Point, last: &Point) -> f64 {
    let (before, step) = (middle.time - first.time, last.time - middle.time);
    let slope = (last.velocity - middle.velocity) / step;
    let bend = (slope - (middle.velocity - first.velocity) / before) / (before + step);
    step * (0.5 * (middle.velocity + last.velocity) - bend * step * step / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(step: f64, velocity: impl Fn(f64) -> f64, noise: f64) -> bool {
        let mut fit = Fit::default();
        let mut seed = 1_u64;
        for k in 0..(100.0 / step) as u32 {
            let t = f64::from(k) * step;
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let jitter = noise * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
            let position = 3.0 * (0.05 * t).sin() + 2.0 * (0.7 * t).sin() + jitter;
            fit.look(Point { time: t, position, velocity: velocity(t) });
        }
        fit.misfit
    }

    #[test]
    fn velocities_of_other_motions_do_not_fit() {
        let slow = |t: f64| 0.15 * (0.05 * t).cos();
        let whole = |t: f64| slow(t) + 1.4 * (0.7 * t).cos();
        for step in [0.02, 0.1, 0.5, 1.0] {
            assert!(!verdict(step, whole, 0.0), "step {step}");
            assert!(!verdict(step, whole, 0.005), "noise, step {step}");
            assert!(!verdict(step, |t| 1.03 * whole(t), 0.0), "3 % more, step {step}");
            assert!(verdict(step, slow, 0.0), "slow alone, step {step}");
            assert!(verdict(step, |t| 1.3 * whole(t), 0.0), "another point, step {step}");
            assert!(verdict(step, |t| -whole(t), 0.0), "another frame, step {step}");
            assert!(verdict(step, |_| 0.0, 0.0), "none, step {step}");
        }
    }
}
