//! Directions of travel of a short-crested sea.
//!
//! ```text
//! D(θ) ∝ cos^2s(θ/2),   -π ≤ θ ≤ π                                         (Longuet-Higgins, Cartwright & Smith 1963)
//! r₁ = ∫ D cos θ dθ = s/(s+1),   r₂ = ∫ D cos 2θ dθ = s(s-1)/((s+1)(s+2)),   σ = √(2(1 - r₁)) = √(2/(1+s))     (Kuik et al. 1988)
//! ```
//!
//! M directions hold the same energy each: the medians of M shares of D, drawn apart a little so that the mean of cos θ, and with it σ, is
//! exactly that of D. A component travels in one of them, so no two of one frequency meet and stand; of any M components that are neighbours
//! in frequency each takes another, in random order. Amplitudes, frequencies and phases stay as they are, and so does the energy.

use crate::sea::random::SplitMix;
use crate::sea::wave::Wave;
use std::f64::consts::PI;

/// Cells in which D is integrated over half its range.
const CELLS: usize = 20_000;
/// Keeps the draw of directions apart from that of frequencies and phases, whose seed it shares.
const APART: u64 = 0x5851_f42d_4c95_7f2d;

/// M directions of equal energy about 0 [rad], rising, for an exponent s.
pub fn directions(s: f64, count: usize) -> Vec<f64> {
    let step = PI / CELLS as f64;
    // cos^2s in the middle of a cell, in logarithms for powers that no number holds.
    let shares: Vec<f64> = (0..CELLS).map(|cell| (2.0 * s * (0.5 * (cell as f64 + 0.5) * step).cos().ln()).exp()).collect();
    let whole: f64 = shares.iter().sum();
    // D is even: the medians of one side, mirrored.
    let (mut cell, mut below) = (0, 0.0);
    let side: Vec<f64> = (0..count / 2)
        .map(|n| {
            let wanted = (if count.is_multiple_of(2) { n as f64 + 0.5 } else { n as f64 + 1.0 }) * 2.0 / count as f64 * whole;
            while cell + 1 < CELLS && below + shares[cell] <= wanted {
                below += shares[cell];
                cell += 1;
            }
            (cell as f64 + (wanted - below) / shares[cell]) * step
        })
        .collect();
    // The factor by which the mean of cos θ becomes r₁, by halving.
    let mean =
        |factor: f64| (2.0 * side.iter().map(|angle| (factor * angle).cos()).sum::<f64>() + (count % 2) as f64) / count as f64;
    let furthest = side.last().copied().unwrap_or(PI);
    let (mut low, mut high) = (0.5, (PI / furthest).min(3.0));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if mean(middle) > s / (s + 1.0) { low = middle } else { high = middle }
    }
    let drawn_apart = side.iter().map(|angle| low * angle);
    let centre = (count % 2 == 1).then_some(0.0);
    drawn_apart.clone().rev().map(|angle| -angle).chain(centre).chain(drawn_apart).collect()
}

/// Gives the components of a sea, which rise in frequency, directions about the one that they have; the same for the same seed.
pub fn spread(waves: &mut [Wave], s: f64, count: usize, seed: u64) {
    let directions = directions(s, count);
    let mut random = SplitMix(seed ^ APART);
    let mut order: Vec<usize> = (0..count).collect();
    for neighbours in waves.chunks_mut(count) {
        for n in (1..count).rev() {
            order.swap(n, (random.uniform() * (n + 1) as f64) as usize);
        }
        neighbours.iter_mut().zip(&order).for_each(|(wave, n)| wave.direction += directions[*n]);
    }
}
