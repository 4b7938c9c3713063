//! Shape functions of the mixed element and the integrals of their products (Ma & Webster 1994, eqs. 2.13 and 2.16).
//!
//! ```text
//! r(x) = U_k a_k(x),  U = (r_0, L r_0', r_1, L r_1');   λ(x) = λ_m ψ_m(x),  λ at x = 0, ½, 1
//! ψ = [1 - 3x + 2x², 4x(1 - x), x(2x - 1)]
//! α_ikm = ∫ a_i'' a_k'' ψ_m,   β_ikm = ∫ a_i' a_k' ψ_m,   γ_ikm = ∫ a_i a_k ψ_m,   μ_im = ∫ a_i ψ_m,   η_lm = ∫ ψ_l ψ_m,   τ_m = ∫ ψ_m
//! ```
//!
//! All on [0, 1], without the powers of the length L. Five Gauss points integrate the longest product, of degree 8, exactly.

use crate::algebra::shape::Shape;

/// Gauss points on [0, 1] and their weights, exact to degree 9.
const GAUSS5: [(f64, f64); 5] = [
    (0.046_910_077_030_668_0, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_45),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// a_i a_k ψ_m and the like: one number for each i, k and m.
pub type Triad = [[[f64; 3]; 4]; 4];

/// The integrals, for unit length.
#[derive(Debug, Clone, PartialEq)]
pub struct Integrals {
    /// α_ikm, of the curvatures.
    pub bending: Triad,
    /// β_ikm, of the slopes.
    pub stretch: Triad,
    /// γ_ikm, of the positions.
    pub mass: Triad,
    /// μ_im.
    pub load: [[f64; 3]; 4],
    /// η_lm.
    pub strain: [[f64; 3]; 3],
    /// τ_m.
    pub unit: [f64; 3],
}

/// ψ at x.
pub fn quadratic(x: f64) -> [f64; 3] {
    [1.0 - 3.0 * x + 2.0 * x * x, 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)]
}

impl Integrals {
    /// All of them.
    pub fn new() -> Integrals {
        let mut sums = Integrals {
            bending: [[[0.0; 3]; 4]; 4],
            stretch: [[[0.0; 3]; 4]; 4],
            mass: [[[0.0; 3]; 4]; 4],
            load: [[0.0; 3]; 4],
            strain: [[0.0; 3]; 3],
            unit: [0.0; 3],
        };
        for (x, weight) in GAUSS5 {
            let (a, psi) = (Shape::at(x), quadratic(x));
            for m in 0..3 {
                let w = weight * psi[m];
                sums.unit[m] += w;
                (0..3).for_each(|l| sums.strain[l][m] += w * psi[l]);
                for i in 0..4 {
                    sums.load[i][m] += w * a.value[i];
                    for k in 0..4 {
                        sums.bending[i][k][m] += w * a.curvature[i] * a.curvature[k];
                        sums.stretch[i][k][m] += w * a.slope[i] * a.slope[k];
                        sums.mass[i][k][m] += w * a.value[i] * a.value[k];
                    }
                }
            }
        }
        sums
    }
}

impl Default for Integrals {
    fn default() -> Self {
        Integrals::new()
    }
}
