//! What every time integration scheme is made of: a step from one state to the next as a few stages, and an estimate of its error.

use crate::rod::line::Line;
use crate::rod::state::{Field, State};
use crate::scene::types;
use crate::solve::adams_moulton::AdamsMoulton;
use crate::solve::esdirk::{ARK3, Esdirk};
use crate::solve::generalized_alpha::GeneralizedAlpha;
use crate::solve::motion::{Kinematics, Path};
use crate::solve::newton::{Criteria, Newton, Stall, motion};

/// The line in time: the state and what the predictor remembers of the step before.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Time [s].
    pub time: f64,
    /// Unknowns and rates.
    pub state: State,
    /// Accelerations one step before.
    pub earlier: Field,
    /// Length of the step that led here [s]; 0: no history.
    pub last_step: f64,
    /// Length aimed at for the next step [s].
    pub step: f64,
    /// Steps still to be taken by the L-stable method.
    pub guard: u32,
}

/// What a step works with.
pub struct Bench<'a> {
    /// The line.
    pub line: &'a dyn Line,
    /// The stage solver.
    pub newton: &'a mut Newton,
    /// The motion of the fairlead.
    pub path: &'a Path,
    /// When a stage is solved.
    pub criteria: Criteria,
}

impl Bench<'_> {
    /// Puts the fairlead where the path has it.
    pub fn prescribe(&self, state: &mut State, at: &Kinematics) {
        let last = self.line.last();
        state.u.set_position(last, &at.position);
        state.v.set_position(last, &at.velocity);
        state.a.set_position(last, &at.acceleration);
    }

    /// Passes an error of u through the stage matrix, J⁻¹ M e: what stiff waves that the step does not resolve contribute is damped
    /// as the step itself damps it (Hosea & Shampine 1996). Needs the factor of the stage.
    pub fn filter(&mut self, state: &State, error: &mut Field, scratch: &mut Field) {
        self.line.inertia(&motion(state), error, scratch);
        self.newton.solve_linear(self.line, scratch);
        error.copy_from(scratch);
    }

    /// Accelerations that fit positions, velocities and the prescribed acceleration: M a = -R(u, v, 0).
    pub fn accelerate(&mut self, state: &mut State) -> Result<(), Stall> {
        let weights = crate::rod::element::Weights { u: 0.0, v: 0.0, a: 1.0 };
        self.newton.factor(self.line, &motion(state), &weights, None)?;
        let mut residual = Field::new(state.u.nodes());
        self.line.residual(&motion(state), &mut residual);
        self.newton.solve_linear(self.line, &mut residual);
        state.a.add(-1.0, &residual);
        self.newton.forget();
        Ok(())
    }
}

/// A recipe of stages.
pub trait Scheme: Send {
    /// Tries a step of length h from `from`; on success `next` holds the state at the end, and the estimated error of the
    /// positions [m] is returned.
    fn step(&mut self, bench: &mut Bench, from: &Moment, h: f64, next: &mut State) -> Result<f64, Stall>;
    /// Order of the error estimate in h.
    fn error_order(&self) -> f64;
}

/// The scheme of a name, with room for `nodes` nodes.
pub fn of(name: types::Scheme, nodes: usize) -> Box<dyn Scheme> {
    match name {
        types::Scheme::AdamsMoulton | types::Scheme::Cable1994 => Box::new(AdamsMoulton::new(nodes)),
        types::Scheme::Esdirk3 => Box::new(Esdirk::new(&ARK3, nodes)),
        types::Scheme::GeneralizedAlpha => Box::new(GeneralizedAlpha::new(nodes)),
    }
}

/// Largest position error of a field [m].
pub fn largest_position(field: &Field) -> f64 {
    let mut largest: f64 = 0.0;
    for node in 0..field.nodes() {
        let size = field.position(node).norm();
        if !(size <= largest) {
            largest = size;
        }
    }
    largest
}

/// Linear extrapolation of the accelerations to the end of a step, factor·(a - a_before) beyond a; constant without history.
pub fn predict(from: &Moment, h: f64, a: &mut Field) {
    a.copy_from(&from.state.a);
    if from.last_step > 0.0 {
        let factor = h / from.last_step;
        a.add(factor, &from.state.a);
        a.add(-factor, &from.earlier);
    }
}
