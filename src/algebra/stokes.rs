//! A steady wave by Stokes's expansion to the fifth order in the steepness (Fenton 1985, J. Waterway Port Coastal Ocean Eng. 111; 1990).
//!
//! ```text
//! kη = Σ_i ε^i Σ_j B_ij cos jθ,   u - iw = √(g/k³) C₀ Σ_i ε^i Σ_j j k A_ij [cosh jk(z+d) cos jθ - i sinh jk(z+d) sin jθ],   i, j = 1 … 5
//! θ = k x - ω t,   ε = kH/2,   ω/√(gk) = C₀ + ε² C₂ + ε⁴ C₄
//! ```
//!
//! H height from trough to crest [m], d depth [m]. A_ij, B_ij and C_i are rational functions of S = 1/cosh 2kd. The wave runs in water that does not
//! flow on the mean at any place below the trough, so its speed is ω/k. What comes out are five bound harmonics: frequency jω goes with the number jk.
//!
//! The expansion holds for waves that are not long, H L²/d³ ≤ 40 (Hedges 1995), and not higher than the highest (Fenton 1990).

use std::f64::consts::TAU;

/// Harmonics.
pub const ORDER: usize = 5;
/// H L²/d³ up to which the expansion holds.
pub const LONGEST: f64 = 40.0;
/// Beyond this kd the water is deep to the last digit.
const DEEP: f64 = 20.0;

/// The coefficients at a depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// A_ij, by i - 1 and j - 1.
    pub a: [[f64; ORDER]; ORDER],
    /// B_ij, by i - 1 and j - 1.
    pub b: [[f64; ORDER]; ORDER],
    /// C₀, C₂ and C₄.
    pub c: [f64; 3],
}

/// The wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stokes {
    /// k [1/m].
    pub number: f64,
    /// ω [rad/s].
    pub omega: f64,
    /// Elevation of each harmonic, of cos jθ [m].
    pub elevations: [f64; ORDER],
    /// Upright speed of each harmonic at still water, of sin jθ [m/s].
    pub speeds: [f64; ORDER],
}

impl Coefficients {
    /// The coefficients for a product of wave number and depth.
    pub fn new(kd: f64) -> Coefficients {
        let kd = kd.min(DEEP);
        let s = (2.0 * kd).cosh().recip();
        let (sinh, tanh) = (kd.sinh(), kd.tanh());
        let sum = |terms: &[f64]| terms.iter().rev().fold(0.0, |sum, term| sum * s + term);
        let rest = |power: i32| (1.0 - s).powi(power);
        let (three, four) = (3.0 + 2.0 * s, 4.0 + s);
        let a = [
            [1.0 / sinh, 0.0, 0.0, 0.0, 0.0],
            [0.0, 3.0 * s * s / (2.0 * rest(2)), 0.0, 0.0, 0.0],
            [
                sum(&[-4.0, -20.0, 10.0, -13.0]) / (8.0 * sinh * rest(3)),
                0.0,
                sum(&[0.0, 0.0, -2.0, 11.0]) / (8.0 * sinh * rest(3)),
                0.0,
                0.0,
            ],
            [
                0.0,
                sum(&[0.0, 12.0, -14.0, -264.0, -45.0, -13.0]) / (24.0 * rest(5)),
                0.0,
                sum(&[0.0, 0.0, 0.0, 10.0, -174.0, 291.0, 278.0]) / (48.0 * three * rest(5)),
                0.0,
            ],
            [
                sum(&[-1184.0, 32.0, 13232.0, 21712.0, 20940.0, 12554.0, -500.0, -3341.0, -670.0])
                    / (64.0 * sinh * three * four * rest(6)),
                0.0,
                sum(&[0.0, 4.0, 105.0, 198.0, -1376.0, -1302.0, -117.0, 58.0]) / (32.0 * sinh * three * rest(6)),
                0.0,
                sum(&[0.0, 0.0, 0.0, -6.0, 272.0, -1552.0, 852.0, 2029.0, 430.0]) / (64.0 * sinh * three * four * rest(6)),
            ],
        ];
        let b31 = -3.0 * sum(&[1.0, 3.0, 3.0, 2.0]) / (8.0 * rest(3));
        let b53 =
            9.0 * sum(&[132.0, 17.0, -2216.0, -5897.0, -6292.0, -2687.0, 194.0, 467.0, 82.0]) / (128.0 * three * four * rest(6));
        let b55 =
            5.0 * sum(&[300.0, 1579.0, 3176.0, 2949.0, 1188.0, 675.0, 1326.0, 827.0, 130.0]) / (384.0 * three * four * rest(6));
        let b = [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, (1.0 + 2.0 * s) / (2.0 * tanh * (1.0 - s)), 0.0, 0.0, 0.0],
            [b31, 0.0, -b31, 0.0, 0.0],
            [
                0.0,
                sum(&[6.0, -26.0, -182.0, -204.0, -25.0, 26.0]) / (6.0 * tanh * three * rest(4)),
                0.0,
                sum(&[24.0, 92.0, 122.0, 66.0, 67.0, 34.0]) / (24.0 * tanh * three * rest(4)),
                0.0,
            ],
            [-(b53 + b55), 0.0, b53, 0.0, b55],
        ];
        let c0 = tanh.sqrt();
        let c = [
            c0,
            c0 * sum(&[2.0, 0.0, 7.0]) / (4.0 * rest(2)),
            c0 * sum(&[4.0, 32.0, -116.0, -400.0, -71.0, 146.0]) / (32.0 * rest(5)),
        ];
        Coefficients { a, b, c }
    }
}

impl Stokes {
    /// The wave of a height [m] and a period [s] in water of a depth [m]; none where no length goes with them.
    pub fn new(height: f64, period: f64, gravity: f64, depth: f64) -> Option<Stokes> {
        let omega = TAU / period;
        // What the speed of the wave is beyond what its period asks.
        let excess = |k: f64| {
            let (of, e) = (Coefficients::new(k * depth), 0.5 * k * height);
            (gravity * k).sqrt() * (of.c[0] + e * e * (of.c[1] + e * e * of.c[2])) - omega
        };
        // The wave outruns a low one, so its number lies below that of linear theory, which is at most 1.2 of the larger limit.
        let limit = (omega * omega / gravity).max(omega / (gravity * depth).sqrt());
        let (mut low, mut high) = (0.5 * limit, 1.25 * limit);
        if !(excess(low) < 0.0 && excess(high) > 0.0) {
            return None;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        let number = 0.5 * (low + high);
        let (of, e, kd) = (Coefficients::new(number * depth), 0.5 * number * height, (number * depth).min(DEEP));
        let sum = |table: &[[f64; ORDER]; ORDER], j: usize| (0..ORDER).map(|i| e.powi(i as i32 + 1) * table[i][j]).sum::<f64>();
        let speed = |j: usize| {
            let n = (j + 1) as f64;
            (gravity / number).sqrt() * of.c[0] * n * sum(&of.a, j) * (n * kd).sinh()
        };
        Some(Stokes {
            number,
            omega,
            elevations: std::array::from_fn(|j| sum(&of.b, j) / number),
            speeds: std::array::from_fn(speed),
        })
    }

    /// L [m].
    pub fn length(&self) -> f64 {
        TAU / self.number
    }
}

/// The highest wave of a length L in water of a depth [m] (Fenton 1990, eq. 32, after Williams 1981) [m].
pub fn highest(length: f64, depth: f64) -> f64 {
    let x = length / depth;
    let above = x * (0.141063 + x * (0.0095721 + x * 0.0077829));
    depth * above / (1.0 + x * (0.0788340 + x * (0.0317567 + x * 0.0093407)))
}
