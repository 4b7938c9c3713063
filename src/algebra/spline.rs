//! The cubic spline through values at rising times, with continuous curvature.
//!
//! ```text
//! h₀ M₋ + 2 (h₀ + h₁) M + h₁ M₊ = 6 (d₁ - d₀)      M second derivatives, h spacings, d slopes of the chords
//! ```
//!
//! At the ends the curvature goes on as in the neighbouring interval (not a knot) where there are four rows or more; three give the parabola, two
//! the straight line.

use nalgebra::{DMatrix, DVector};

/// Second derivatives at the knots of one component.
pub fn curvatures(times: &[f64], values: &[f64]) -> Vec<f64> {
    let count = times.len();
    if count < 3 {
        return vec![0.0; count];
    }
    let h: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let d: Vec<f64> = values.windows(2).zip(&h).map(|(pair, h)| (pair[1] - pair[0]) / h).collect();
    if count == 3 {
        return vec![2.0 * (d[1] - d[0]) / (h[0] + h[1]); 3];
    }
    if count == 4 {
        // One cubic through all four: its second derivative is linear.
        let a = DMatrix::from_fn(4, 4, |row, power| (times[row] - times[0]).powi(power as i32));
        let c = a.lu().solve(&DVector::from_row_slice(values)).unwrap_or_else(|| DVector::zeros(4));
        return times.iter().map(|t| 2.0 * c[2] + 6.0 * c[3] * (t - times[0])).collect();
    }
    // The ends are eliminated: M₀ = (1 + h₀/h₁) M₁ - h₀/h₁ M₂, and mirrored.
    let last = count - 1;
    let (r0, r1) = (h[0] / h[1], h[last - 1] / h[last - 2]);
    let (mut diagonal, mut upper, mut right) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    let mut lower = vec![0.0; count];
    for i in 1..last {
        (lower[i], diagonal[i], upper[i]) = (h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]);
        right[i] = 6.0 * (d[i] - d[i - 1]);
    }
    diagonal[1] += h[0] * (1.0 + r0);
    upper[1] -= h[0] * r0;
    diagonal[last - 1] += h[last - 1] * (1.0 + r1);
    lower[last - 1] -= h[last - 1] * r1;
    for i in 2..last {
        let share = lower[i] / diagonal[i - 1];
        diagonal[i] -= share * upper[i - 1];
        right[i] -= share * right[i - 1];
    }
    let mut m = vec![0.0; count];
    for i in (1..last).rev() {
        m[i] = (right[i] - upper[i] * m[i + 1] * f64::from(u8::from(i + 1 < last))) / diagonal[i];
    }
    m[0] = (1.0 + r0) * m[1] - r0 * m[2];
    m[last] = (1.0 + r1) * m[last - 1] - r1 * m[last - 2];
    m
}

/// Value, first and second derivative at a time between knots `i` and `i + 1`.
pub fn at(times: &[f64], values: &[f64], curvatures: &[f64], i: usize, time: f64) -> [f64; 3] {
    let h = times[i + 1] - times[i];
    let (a, b) = ((times[i + 1] - time) / h, (time - times[i]) / h);
    let (m, n) = (curvatures[i], curvatures[i + 1]);
    [
        a * values[i] + b * values[i + 1] + ((a * a * a - a) * m + (b * b * b - b) * n) * h * h / 6.0,
        (values[i + 1] - values[i]) / h + ((3.0 * b * b - 1.0) * n - (3.0 * a * a - 1.0) * m) * h / 6.0,
        a * m + b * n,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic is its own spline whatever the spacing (to rounding); a sine is met to the fourth order.
    #[test]
    fn cubics_are_exact_and_sines_of_fourth_order() {
        let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 0.3 * t * t * t;
        for count in [4, 5, 9] {
            let times: Vec<f64> = (0..count).map(|k| f64::from(k) + 0.2 * f64::from(k).sin()).collect();
            let values: Vec<f64> = times.iter().map(|t| cubic(*t)).collect();
            let m = curvatures(&times, &values);
            for i in 0..times.len() - 1 {
                let t = 0.3 * times[i] + 0.7 * times[i + 1];
                let [x, v, a] = at(&times, &values, &m, i, t);
                let scale = 1.0 + t.powi(3);
                assert!((x - cubic(t)).abs() < 1e-11 * scale, "{count} rows, {t}: {x} {}", cubic(t));
                assert!((v - (-2.0 + t - 0.9 * t * t)).abs() < 1e-10 * scale && (a - (1.0 - 1.8 * t)).abs() < 1e-9 * scale);
            }
        }
        let error = |count: usize| {
            let times: Vec<f64> = (0..=count).map(|k| 6.0 * k as f64 / count as f64).collect();
            let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
            let m = curvatures(&times, &values);
            (0..count)
                .map(|i| {
                    (at(&times, &values, &m, i, times[i] + 3.0 / count as f64)[0] - (times[i] + 3.0 / count as f64).sin()).abs()
                })
                .fold(0.0, f64::max)
        };
        let order = (error(20) / error(40)).log2();
        assert!(order > 3.5, "order {order}");
    }
}
