//! What the solver has done: how statics went, the work since the start, and the last stretch of time.

/// How statics went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticsReport {
    /// Newton iterations, all attempts.
    pub iterations: usize,
    /// Largest unbalanced nodal force [N].
    pub residual: f64,
    /// Whether the residual is small enough to call it equilibrium.
    pub converged: bool,
    /// Others are as good: the line may sag, buckle or turn to another side just as well.
    pub others: bool,
}

/// Work done by the solver since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Accepted time steps.
    pub steps: usize,
    /// Rejected time steps.
    pub rejected_steps: usize,
    /// Accepted steps of the finest length whose estimated error was above the tolerance.
    pub unresolved_steps: usize,
    /// Steps of `cable-1994` with a part of the line pushing.
    pub pushing_steps: usize,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Factorisations of the tangent.
    pub factorisations: usize,
    /// Elements times Newton iterations.
    pub element_iterations: usize,
}

/// The last `advance`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LastStep {
    /// Accepted time steps inside it.
    pub substeps: usize,
    /// Newton iterations inside it.
    pub newton_iterations: usize,
    /// Largest estimated error of a step over the allowed one [-].
    pub error_estimate: f64,
}
