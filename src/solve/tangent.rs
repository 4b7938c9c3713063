//! The derivative of steps already taken.
//!
//! A step is a chain of linear combinations and stages R(u, v, a) = 0, so its derivative is the same chain with every stage replaced
//! by its linearisation: K δu + C δv + M δa = 0 about the stage as it was solved. The schemes' own code runs a second time on the
//! changes; the choice of steps is not differentiated.

use crate::algebra::block_tridiagonal::{BlockTridiagonal, Factor};
use crate::rod::element::Weights;
use crate::rod::line::Line;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::solve::newton::{Stall, motion};
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
    factor: Factor<COMPONENTS>,
}

impl LinearStage {
    /// The linearisation of a stage.
    pub fn new(line: &dyn Line, stage: &SolvedStage) -> Result<LinearStage, Stall> {
        let nodes = line.mesh().nodes();
        let matrix = |u, v, a| {
            let mut matrix = BlockTridiagonal::new(line.mesh().ties());
            line.tangent(&motion(&stage.state), &Weights { u, v, a }, None, &mut matrix);
            matrix
        };
        let mut whole = matrix(stage.weights.u, stage.weights.v, stage.weights.a);
        line.fixed().iter().for_each(|&(node, component)| whole.fix(node, component));
        let mut factor = Factor::new(nodes);
        factor.factor(&whole).map_err(|singular| Stall::Singular { node: singular.index })?;
        Ok(LinearStage {
            weights: stage.weights,
            by_position: matrix(1.0, 0.0, 0.0),
            by_velocity: matrix(0.0, 1.0, 0.0),
            by_acceleration: matrix(0.0, 0.0, 1.0),
            factor,
        })
    }

    /// Solves the stage for changes: `trial` holds their prediction, with the prescribed ones in place, and becomes the solution.
    pub fn solve(&self, line: &dyn Line, trial: &mut State) {
        let nodes = trial.u.nodes();
        let mut force = vec![SVector::<f64, COMPONENTS>::zeros(); nodes];
        let mut part = force.clone();
        let parts = [(&self.by_position, &trial.u), (&self.by_velocity, &trial.v), (&self.by_acceleration, &trial.a)];
        for (matrix, field) in parts {
            matrix.multiply(&blocks(field), &mut part);
            force.iter_mut().zip(&part).for_each(|(sum, part)| *sum += part);
        }
        let mut x = Field::new(nodes);
        for (node, f) in force.iter().enumerate() {
            for c in 0..COMPONENTS {
                x.component_mut(c)[node] = f[c];
            }
        }
        line.fixed().iter().for_each(|&(node, component)| x.component_mut(component)[node] = 0.0);
        let stride = x.stride();
        self.factor.solve(x.data_mut(), stride);
        trial.u.add(-self.weights.u, &x);
        trial.v.add(-self.weights.v, &x);
        trial.a.add(-self.weights.a, &x);
    }
}

fn blocks(field: &Field) -> Vec<SVector<f64, COMPONENTS>> {
    (0..field.nodes()).map(|node| SVector::from_fn(|c, _| field.component(c)[node])).collect()
}
