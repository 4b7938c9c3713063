//! What has three components.

/// A position, velocity or offset (x, y, z).
pub type Triple = [f64; 3];
