//! A current that changes in time: a profile at each of several times, linear between them, constant before the first and after the last.
//!
//! ```text
//! V(z, t) = (1 - λ) V_i(z) + λ V_{i+1}(z),   ∂V/∂t = (V_{i+1}(z) - V_i(z))/(t_{i+1} - t_i),   λ = (t - t_i)/(t_{i+1} - t_i)
//! ```
//!
//! Profiles are linear in z and constant outside their rows (`current`), east and north alike, so the current turns with depth as the rows do.

use crate::algebra::real::Real;
use crate::algebra::triple::Triple;
use crate::scene::types::CurrentPoint;
use crate::sea::current::Current;

/// The current over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Stream {
    times: Vec<f64>,
    profiles: Vec<Current>,
}

impl Stream {
    /// The current of rows of time [s], z [m], and velocity [m/s] along x, y and z, times not falling; none where there are no rows.
    pub fn new(rows: &[[f64; 5]]) -> Option<Stream> {
        let point = |[_, z, u, v, w]: &[f64; 5]| CurrentPoint { z: *z, velocity: [*u, *v, *w] };
        let of_one_time = || rows.chunk_by(|one, other| one[0] == other[0]);
        let profile = |rows: &[[f64; 5]]| Current::new(&rows.iter().map(point).collect::<Vec<_>>());
        let stream =
            Stream { times: of_one_time().map(|rows| rows[0][0]).collect(), profiles: of_one_time().map(profile).collect() };
        (!rows.is_empty()).then_some(stream)
    }

    /// V [m/s] and ∂V/∂t [m/s²] at heights z [m].
    #[inline(always)]
    pub fn flow<F: Real>(&self, cpu: F::Cpu, time: f64, z: F) -> (Triple<F>, Triple<F>) {
        let still = || Triple::zero(cpu);
        let after = self.times.partition_point(|t| *t <= time);
        if after == 0 || after == self.times.len() {
            return (self.profiles[after.saturating_sub(1)].added_to(cpu, z, still()), still());
        }
        let (from, to) = (self.times[after - 1], self.times[after]);
        let [before, after] = [after - 1, after].map(|at| self.profiles[at].added_to(cpu, z, still()));
        let change = after - before;
        (change.scale_add((time - from) / (to - from), before), change.scale(1.0 / (to - from)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bilinear interpolation by hand: 1 m/s east at the surface and north at 100 m, twice that ten seconds later; halfway down and halfway in time it flows
    /// northeast with 0.75 √2 m/s and gains 0.05 m/s² in each; before and after, above and below it stays.
    #[test]
    fn it_turns_with_depth_and_changes_in_time() {
        let rows =
            [[5.0, 0.0, 1.0, 0.0, 0.0], [5.0, -100.0, 0.0, 1.0, 0.0], [15.0, -100.0, 0.0, 2.0, 0.0], [15.0, 0.0, 2.0, 0.0, 0.0]];
        let stream = Stream::new(&rows).expect("rows");
        for (time, z, v, a) in [
            (10.0, -50.0, [0.75, 0.75], [0.05, 0.05]),
            (10.0, 5.0, [1.5, 0.0], [0.1, 0.0]),
            (10.0, -300.0, [0.0, 1.5], [0.0, 0.1]),
            (0.0, -25.0, [0.75, 0.25], [0.0, 0.0]),
            (5.0, -25.0, [0.75, 0.25], [0.075, 0.025]),
            (99.0, -25.0, [1.5, 0.5], [0.0, 0.0]),
        ] {
            let (velocity, acceleration): (Triple<f64>, Triple<f64>) = stream.flow((), time, z);
            for (found, exact) in [(velocity.x, v[0]), (velocity.y, v[1]), (acceleration.x, a[0]), (acceleration.y, a[1])] {
                assert!((found - exact).abs() < 1e-14, "t = {time}, z = {z}: {found} {exact}");
            }
        }
        assert!(Stream::new(&[]).is_none());
    }
}
