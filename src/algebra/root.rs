//! The zero of a rising function between two bounds.

/// Most evaluations: bisection alone reaches rounding in some sixty for bounds of one size, in a thousand for any.
const MOST: usize = 1100;

/// Zero of a rising function between two bounds, to rounding; a bound itself where the function does not change its sign between them. By inverse
/// quadratic interpolation where three points say that it may be trusted, else by bisection (Chandrupatla 1997, "A new hybrid quadratic/bisection
/// algorithm for finding the zero of a nonlinear function without using derivatives").
pub fn of_rising(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    // The newest point a, the bound b on the other side of the zero, and the point c before a.
    let (mut a, mut b) = (high, low);
    let (mut fa, mut fb) = (f(a), f(b));
    if !(fb < 0.0) {
        return low;
    }
    if fa < 0.0 {
        return high;
    }
    let mut part = 0.5;
    for _ in 0..MOST {
        let x = a + part * (b - a);
        let fx = f(x);
        let (c, fc) = if (fx < 0.0) == (fa < 0.0) {
            (a, fa)
        } else {
            let old = (b, fb);
            (b, fb) = (a, fa);
            old
        };
        (a, fa) = (x, fx);
        let best = if fa.abs() < fb.abs() { a } else { b };
        let least = (2.0 * f64::EPSILON * best.abs() + f64::MIN_POSITIVE) / (b - a).abs();
        if fa == 0.0 || !(least < 0.5) {
            return best;
        }
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        part = if phi * phi < xi && (1.0 - phi).powi(2) < 1.0 - xi {
            let (near, far) = (fa / (fb - fa) * (fc / (fb - fc)), (c - a) / (b - a) * (fa / (fc - fa)) * (fb / (fc - fb)));
            (near + far).clamp(least, 1.0 - least)
        } else {
            0.5
        };
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// Smooth functions within rounding in a dozen evaluations; steps, poles and flat parts in no more than bisection takes.
    #[test]
    fn zeros_are_found_to_rounding() {
        type Case = (f64, f64, fn(f64) -> f64, f64, usize);
        let cases: [Case; 8] = [
            (0.0, 2.0, |x| x * x * x - 2.0, 2f64.cbrt(), 12),
            (-1e3, 1e6, |x| x.asinh() - 1.0, 1f64.sinh(), 40),
            (0.0, 10.0, |x| if x > 0.0 { x.ln() } else { -1.0 }, 1.0, 16),
            (-4.0, 1.0, |x| x.powi(9), 0.0, 1100),
            (0.0, 1.0, |x| if x < 0.3 { -1.0 } else { 1.0 }, 0.3, 64),
            (0.0, 1e9, |x| if x < 1e-6 { -1.0 } else { x }, 1e-6, 120),
            (2.0, 3.0, |x| x, 2.0, 2),
            (2.0, 3.0, |x| x - 4.0, 3.0, 2),
        ];
        for (number, (low, high, f, zero, most)) in cases.into_iter().enumerate() {
            let calls = Cell::new(0);
            let found = of_rising(low, high, |x| {
                calls.set(calls.get() + 1);
                f(x)
            });
            assert!((found - zero).abs() <= 4.0 * f64::EPSILON * zero + 1e-30, "{number}: {found}, not {zero}");
            assert!(calls.get() <= most, "{number}: {} evaluations", calls.get());
        }
    }
}
