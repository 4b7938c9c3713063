//! Where a cubic on [0, 1] is positive.

use crate::algebra::real::Real;

/// A part of [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
}

/// Up to four disjoint parts of [0, 1], in order.
#[derive(Debug, Clone, Copy, Default)]
pub struct Intervals {
    items: [Option<Interval>; 4],
    count: usize,
}

impl Intervals {
    fn push(&mut self, from: f64, to: f64) {
        if let Some(slot) = self.items.get_mut(self.count) {
            *slot = Some(Interval { from, to });
            self.count += 1;
        }
    }

    /// The parts, in order.
    pub fn iter(&self) -> impl Iterator<Item = Interval> + '_ {
        self.items.iter().flatten().copied()
    }

    /// Sum of the lengths.
    pub fn length(&self) -> f64 {
        self.iter().map(|part| part.to - part.from).sum()
    }

    /// The whole of [0, 1].
    pub fn whole() -> Intervals {
        let mut parts = Intervals::default();
        parts.push(0.0, 1.0);
        parts
    }
}

/// A cubic on [0, 1] by its Bézier control values b0 … b3: the curve lies between the least and the greatest of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic(pub [f64; 4]);

impl Cubic {
    /// The cubic with given end values and end slopes (by x).
    pub fn hermite(y0: f64, d0: f64, y1: f64, d1: f64) -> Cubic {
        Cubic([y0, y0 + d0 / 3.0, y1 - d1 / 3.0, y1])
    }

    /// The cubic with given values at x = 0, ⅓, ⅔, 1.
    pub fn through(y: [f64; 4]) -> Cubic {
        let control = |near: f64, next: f64, far: f64, end: f64| (18.0 * next - 5.0 * near - 9.0 * far + 2.0 * end) / 6.0;
        Cubic([y[0], control(y[0], y[1], y[2], y[3]), control(y[3], y[2], y[1], y[0]), y[3]])
    }

    /// Value at x (de Casteljau, stable).
    pub fn at(&self, x: f64) -> f64 {
        let b = &self.0;
        let y = 1.0 - x;
        y * y * y * b[0] + 3.0 * y * y * x * b[1] + 3.0 * y * x * x * b[2] + x * x * x * b[3]
    }

    /// End values and end slopes (by x), [`Cubic::hermite`] undone: y0, d0, y1, d1.
    pub fn ends(&self) -> [f64; 4] {
        let b = &self.0;
        [b[0], 3.0 * (b[1] - b[0]), b[3], 3.0 * (b[3] - b[2])]
    }

    /// The same with an x in every lane.
    #[inline(always)]
    pub fn in_lanes<F: Real>(&self, x: F) -> F {
        let b = &self.0;
        let y = -x + 1.0;
        let (low, high) = (y.scale_add(b[0], x * (3.0 * b[1])), x.scale_add(b[3], y * (3.0 * b[2])));
        (y * y).mul_add(low, x * x * high)
    }

    /// Certainly nowhere above `level` (by the control values).
    pub fn below(&self, level: f64) -> bool {
        self.0.iter().all(|b| *b <= level)
    }

    /// Certainly everywhere at or above `level` (by the control values).
    pub fn above(&self, level: f64) -> bool {
        self.0.iter().all(|b| *b >= level)
    }

    /// The parts of [0, 1] where the cubic is greater than `level`, exact to rounding.
    pub fn parts_above(&self, level: f64) -> Intervals {
        if self.below(level) {
            return Intervals::default();
        }
        if self.above(level) {
            return Intervals::whole();
        }
        let mut parts = Intervals::default();
        if let Some(cut) = self.only_crossing(level) {
            let (from, to) = if self.0[0] >= level { (0.0, cut) } else { (cut, 1.0) };
            parts.push(from, to);
            return parts;
        }
        let mut cuts = [0.0; 5];
        let count = 1 + self.crossings(level, &mut cuts[1..]);
        cuts[count] = 1.0;
        let mut from = None;
        for k in 0..count {
            let inside = cuts[k + 1] > cuts[k] && self.at(0.5 * (cuts[k] + cuts[k + 1])) > level;
            match (inside, from) {
                (true, None) => from = Some(cuts[k]),
                (false, Some(start)) if cuts[k + 1] > cuts[k] => {
                    parts.push(start, cuts[k]);
                    from = None;
                }
                _ => {}
            }
        }
        if let Some(start) = from {
            parts.push(start, 1.0);
        }
        parts
    }

    /// The crossing of `level`, where the signs of the control values tell that there is just one (Descartes).
    fn only_crossing(&self, level: f64) -> Option<f64> {
        self.only_crossing_near(level, f64::NAN)
    }

    /// The same, looked for from a guess on.
    pub fn only_crossing_near(&self, level: f64, guess: f64) -> Option<f64> {
        let shifted = Cubic(self.0.map(|value| value - level));
        let b = &shifted.0;
        let changes = (0..3).filter(|k| (b[*k] < 0.0) != (b[*k + 1] < 0.0)).count();
        (changes == 1).then(|| shifted.bracketed_root(0.0, 1.0, b[0] < 0.0, guess))
    }

    /// Crossings of `level` in (0, 1) in rising order, at most 3; returns how many. Between neighbouring extrema the cubic is
    /// monotone, so a safeguarded Newton iteration finds each crossing.
    fn crossings(&self, level: f64, found: &mut [f64]) -> usize {
        let shifted = Cubic(self.0.map(|value| value - level));
        let mut stations = [0.0, 1.0, 1.0, 1.0];
        let mut last = 1;
        for x in extrema(shifted.derivative()).into_iter().flatten() {
            stations[last] = x;
            last += 1;
        }
        stations[last] = 1.0;
        let mut count = 0;
        for k in 0..last {
            let (x0, x1) = (stations[k], stations[k + 1]);
            let (f0, f1) = (shifted.at(x0), shifted.at(x1));
            if (f0 < 0.0) != (f1 < 0.0) && count < found.len() {
                found[count] = shifted.bracketed_root(x0, x1, f0 < 0.0, f64::NAN);
                count += 1;
            }
        }
        count
    }

    /// Bézier control values of the derivative.
    fn derivative(&self) -> [f64; 3] {
        let b = &self.0;
        [3.0 * (b[1] - b[0]), 3.0 * (b[2] - b[1]), 3.0 * (b[3] - b[2])]
    }

    /// The zero between x0 and x1, by Newton's method from a guess, or, where that lies outside, from where the chord is zero.
    fn bracketed_root(&self, mut x0: f64, mut x1: f64, rising: bool, guess: f64) -> f64 {
        // By powers of x: less to do than by control values, and sharp enough, since all of it happens on [0, 1].
        let b = &self.0;
        let c = [b[0], 3.0 * (b[1] - b[0]), 3.0 * (b[0] - 2.0 * b[1] + b[2]), b[3] - b[0] + 3.0 * (b[1] - b[2])];
        let at = |x: f64| ((c[3] * x + c[2]) * x + c[1]) * x + c[0];
        let mut x = guess;
        if !(x > x0 && x < x1) {
            let (f0, f1) = (at(x0), at(x1));
            let secant = x0 - f0 * (x1 - x0) / (f1 - f0);
            x = if secant > x0 && secant < x1 { secant } else { 0.5 * (x0 + x1) };
        }
        for _ in 0..60 {
            let f = at(x);
            if (f < 0.0) == rising {
                x0 = x;
            } else {
                x1 = x;
            }
            let slope = (3.0 * c[3] * x + 2.0 * c[2]) * x + c[1];
            let newton = x - f / slope;
            let inside = newton > x0 && newton < x1;
            // Newton's error is squared with every step.
            if inside && (newton - x).abs() < 1e-8 {
                return newton;
            }
            let next = if inside { newton } else { 0.5 * (x0 + x1) };
            if (next - x).abs() < 1e-15 {
                return next;
            }
            x = next;
        }
        x
    }
}

/// Zeros in (0, 1), in order, of the quadratic with Bézier control values d.
fn extrema(d: [f64; 3]) -> [Option<f64>; 2] {
    let (a, b, c) = (d[0] - 2.0 * d[1] + d[2], d[1] - d[0], d[0]);
    let discriminant = b * b - a * c;
    if discriminant <= 0.0 {
        return [None, None];
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let inside = |x: f64| (x > 0.0 && x < 1.0).then_some(x);
    let (first, second) = (inside(q / a), inside(c / q));
    match (first, second) {
        (Some(x), Some(y)) if x > y => [second, first],
        (None, _) => [second, None],
        _ => [first, second],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::shape::{self, Shape};

    /// What runs in lanes is what runs alone, to rounding.
    #[test]
    fn lanes_hold_the_same_cubics() {
        let cubic = Cubic([1.0, -2.0, 0.5, 3.0]);
        for x in [0.0, 0.1, 0.5, 0.7, 1.0] {
            assert!((cubic.in_lanes(x) - cubic.at(x)).abs() < 1e-14, "{x}");
            let (alone, (value, slope)) = (Shape::at(x), shape::in_lanes(x));
            (0..4).for_each(|k| assert!((alone.value[k] - value[k]).abs().max((alone.slope[k] - slope[k]).abs()) < 1e-14, "{x}"));
        }
    }

    /// (x - 0.2)(x - 0.5)(x - 0.9): positive on (0.2, 0.5) and (0.9, 1). Roots of simple zeros: rounding only.
    #[test]
    fn a_cubic_with_three_zeros_is_positive_on_two_parts() {
        let f = |x: f64| (x - 0.2) * (x - 0.5) * (x - 0.9);
        let slope = |x: f64| (x - 0.5) * (x - 0.9) + (x - 0.2) * (x - 0.9) + (x - 0.2) * (x - 0.5);
        let cubic = Cubic::hermite(f(0.0), slope(0.0), f(1.0), slope(1.0));
        let parts: Vec<_> = cubic.parts_above(0.0).iter().collect();
        assert_eq!(parts.len(), 2);
        for (found, exact) in [(parts[0].from, 0.2), (parts[0].to, 0.5), (parts[1].from, 0.9), (parts[1].to, 1.0)] {
            assert!((found - exact).abs() < 1e-13, "{found} {exact}");
        }
    }

    /// End values and slopes make the cubic that they were taken of, to rounding.
    #[test]
    fn a_cubic_is_that_of_its_ends() {
        let cubic = Cubic([1.0, -2.0, 0.5, 3.0]);
        let [y0, d0, y1, d1] = cubic.ends();
        let again = Cubic::hermite(y0, d0, y1, d1);
        (0..4).for_each(|k| assert!((again.0[k] - cubic.0[k]).abs() < 1e-14, "{again:?}"));
    }

    /// A cubic is known by its values at four places, to rounding.
    #[test]
    fn a_cubic_through_its_values_is_the_cubic() {
        let cubic = Cubic([1.0, -2.0, 0.5, 3.0]);
        let again = Cubic::through([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|x| cubic.at(x)));
        (0..4).for_each(|k| assert!((again.0[k] - cubic.0[k]).abs() < 1e-14, "{again:?}"));
    }

    /// A parabola that only just dips below zero between its ends is found although both ends are above.
    #[test]
    fn a_dip_between_the_ends_is_found() {
        let cubic = Cubic::hermite(0.25 - 0.01, -1.0, 0.25 - 0.01, 1.0); // (x - 1/2)² - 0.01
        let parts = cubic.parts_above(0.0);
        assert!((parts.length() - 0.8).abs() < 1e-13);
        assert_eq!(parts.iter().count(), 2);
    }

    /// Against a scan at 2000 points, for many cubics: the measured length above zero differs by at most 3 cells.
    #[test]
    fn parts_agree_with_a_scan() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for _ in 0..500 {
            let cubic = Cubic([random(), random(), random(), random()]);
            let scanned = (0..2000).filter(|k| cubic.at((*k as f64 + 0.5) / 2000.0) > 0.0).count() as f64 / 2000.0;
            assert!((cubic.parts_above(0.0).length() - scanned).abs() < 1.6e-3, "{cubic:?}");
        }
    }
}
