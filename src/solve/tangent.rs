//! The derivative of steps already taken.
//!
//! A step is a chain of linear combinations and stages R(u, v, a) = 0, so its derivative is the same chain with every stage replaced
//! by its linearisation: K δu + C δv + M δa = 0 about the stage as it was solved. The schemes' own code runs a second time on the
//! changes; the choice of steps is not differentiated.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::rod::motion::Weights;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::rod::system::System;
use crate::solve::newton::{Stall, motion};
use crate::solve::unknowns::Unknowns;
use nalgebra::SVector;

/// A stage as it was solved.
#[derive(Debug, Clone)]
pub struct SolvedStage {
    /// Its weights.
    pub weights: Weights,
    /// Its solution.
    pub state: State,
}

/// A stage ready to be solved for changes.
pub struct LinearStage {
    weights: Weights,
    by_position: BlockTridiagonal<COMPONENTS>,
    by_velocity: BlockTridiagonal<COMPONENTS>,
    by_acceleration: BlockTridiagonal<COMPONENTS>,
    unknowns: Unknowns,
    /// The stage, where friction has a memory.
    state: Option<State>,
}

/// Share of a change that is taken to differentiate what friction holds on to: well inside the distance at which it breaks away.
const SHARE: f64 = 1.0e-6;

impl LinearStage {
    /// The linearisation of a stage.
    pub fn new(line: &dyn System, stage: &SolvedStage) -> Result<LinearStage, Stall> {
        let matrix = |u, v, a| {
            let mut matrix = BlockTridiagonal::new(line.ties());
            line.tangent(&motion(&stage.state), &Weights { u, v, a }, None, &mut matrix);
            matrix
        };
        let mut whole = matrix(stage.weights.u, stage.weights.v, stage.weights.a);
        let mut unknowns = Unknowns::new(line);
        let factored = unknowns.factor(line, &motion(&stage.state), stage.weights.u, &mut whole, None);
        factored.map_err(|singular| Stall::Singular { node: singular.index })?;
        Ok(LinearStage {
            weights: stage.weights,
            by_position: matrix(1.0, 0.0, 0.0),
            by_velocity: matrix(0.0, 1.0, 0.0),
            by_acceleration: matrix(0.0, 0.0, 1.0),
            unknowns,
            state: (line.holding_nodes() > 0).then(|| stage.state.clone()),
        })
    }

    /// Solves the stage for changes: `trial` holds their prediction, with the prescribed ones in place, and becomes the solution.
    pub fn solve(&self, line: &dyn System, trial: &mut State) {
        let nodes = trial.u.nodes();
        let mut force = vec![SVector::<f64, COMPONENTS>::zeros(); nodes];
        let mut part = force.clone();
        let parts = [(&self.by_position, &trial.u), (&self.by_velocity, &trial.v), (&self.by_acceleration, &trial.a)];
        for (matrix, field) in parts {
            matrix.multiply(&blocks(field), &mut part);
            force.iter_mut().zip(&part).for_each(|(sum, part)| *sum += part);
        }
        let mut x = Field::new(nodes);
        if let Some(state) = &self.state {
            let mut moved = state.clone();
            let mut other = Field::new(nodes);
            moved.holds.add(SHARE, &trial.holds);
            line.residual(&motion(&moved), &mut other);
            moved.holds.add(-2.0 * SHARE, &trial.holds);
            line.residual(&motion(&moved), &mut x);
            other.add(-1.0, &x);
            x.fill(0.0);
            x.add(0.5 / SHARE, &other);
        }
        for (node, f) in force.iter().enumerate() {
            for c in 0..COMPONENTS {
                x.component_mut(c)[node] += f[c];
            }
        }
        self.unknowns.solve(line, &mut x);
        trial.u.add(-self.weights.u, &x);
        trial.v.add(-self.weights.v, &x);
        trial.a.add(-self.weights.a, &x);
    }
}

/// Change of the places that friction holds on to after a step to `end` from places `before`, of which `change` holds the changes.
pub fn hold(line: &dyn System, end: &State, before: &Field, change: &mut State) {
    if line.holding_nodes() == 0 {
        return;
    }
    let held = |share: f64| {
        let mut moved = State { holds: before.clone(), ..end.clone() };
        moved.u.add(share, &change.u);
        moved.v.add(share, &change.v);
        moved.holds.add(share, &change.holds);
        line.hold(&moved.u, &moved.v, &mut moved.holds);
        moved.holds
    };
    let mut rate = held(SHARE);
    rate.add(-1.0, &held(-SHARE));
    change.holds.fill(0.0);
    change.holds.add(0.5 / SHARE, &rate);
}

/// Rate [m/s] at which the places that friction holds on to follow a moving line.
pub fn hold_rate(line: &dyn System, state: &State) -> Field {
    let (mut holds, mut place) = (state.holds.clone(), state.u.clone());
    place.add(SHARE, &state.v);
    line.hold(&place, &state.v, &mut holds);
    holds.add(-1.0, &state.holds);
    holds.data_mut().iter_mut().for_each(|x| *x /= SHARE);
    holds
}

fn blocks(field: &Field) -> Vec<SVector<f64, COMPONENTS>> {
    (0..field.nodes()).map(|node| SVector::from_fn(|c, _| field.component(c)[node])).collect()
}
