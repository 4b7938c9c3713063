//! Bending stiffness (Garrett 1982; Ma & Webster 1994, eq. 2.5).
//!
//! ```text
//! δW = ∫ EI r″·δr″ ds
//! ```
//!
//! r″ curvature vector by unstretched arc length [1/m], EI [N·m²]. Exact for an inextensible rod; for a stretched one the
//! difference is of the order of the strain. The tangent EI is constant.

use crate::algebra::real::Real;
use crate::algebra::triple::Triple;

/// Whether the line bends with resistance.
pub trait Bending: Copy + Send + Sync + 'static {
    /// False: the element loop does not look at curvature at all.
    const PRESENT: bool;

    /// Moment-like force EI r″ [N·m], work-conjugate to r″.
    #[inline(always)]
    fn force<F: Real>(ei: F, curvature: Triple<F>) -> Triple<F> {
        curvature * ei
    }
}

/// EI > 0 somewhere on the line.
#[derive(Debug, Clone, Copy)]
pub struct Stiff;

impl Bending for Stiff {
    const PRESENT: bool = true;
}

/// Perfectly flexible.
#[derive(Debug, Clone, Copy)]
pub struct Flexible;

impl Bending for Flexible {
    const PRESENT: bool = false;
}
