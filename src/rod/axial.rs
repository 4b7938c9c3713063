//! Axial properties of an element: what the laws of tension and of extension reckon with.

/// Axial properties of an element.
#[derive(Debug, Clone, Copy)]
pub struct Axial<F> {
    /// EA [N].
    pub ea: F,
    /// Kelvin–Voigt time constant [s].
    pub damping: F,
    /// Least tension [N]: 0 where the line goes slack, -∞ where bending stiffness carries compression.
    pub floor: F,
    /// f_s, bound of the friction of a slack element [N].
    pub friction: F,
    /// Tension at the point without damping [N], where it comes from a table or pressures.
    pub elastic: F,
    /// Its change with strain [N].
    pub stiffness: F,
}
