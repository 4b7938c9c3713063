//! What a master says of a fairlead at a communication point.

/// What the master gives at a communication point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// `[0]` position [m], `[1]` velocity [m/s] of the fairlead, by axis.
    pub values: [[f64; 3]; 2],
    /// Time derivatives of order 1 and 2 of each value, where the master set them for the step to come: `[order - 1][value][axis]`.
    pub derivatives: [[[Option<f64>; 3]; 2]; 2],
}

impl Inputs {
    /// Velocity on an axis: the input derivative of the position where it is set, else the velocity input [m/s].
    pub fn velocity(&self, axis: usize) -> f64 {
        self.derivatives[0][0][axis].unwrap_or(self.values[1][axis])
    }

    /// Velocity and, as far as they are set, its first and second derivative on an axis.
    pub fn velocity_terms(&self, axis: usize) -> ([f64; 3], usize) {
        let acceleration = self.derivatives[0][1][axis].or(self.derivatives[1][0][axis]);
        match (acceleration, self.derivatives[1][1][axis]) {
            (Some(acceleration), Some(jerk)) => ([self.velocity(axis), acceleration, jerk], 3),
            (Some(acceleration), None) => ([self.velocity(axis), acceleration, 0.0], 2),
            (None, _) => ([self.velocity(axis), 0.0, 0.0], 1),
        }
    }

    /// Whether the master gives a velocity in any way; zeros count as not given.
    pub fn gives_velocity(&self) -> bool {
        (0..3).any(|axis| self.derivatives[0][0][axis].is_some() || self.values[1][axis] != 0.0)
    }

    /// Whether the master set a derivative on an axis: then it has looked at it.
    pub fn has_derivatives(&self, axis: usize) -> bool {
        self.derivatives.iter().flatten().any(|value| value[axis].is_some())
    }
}
