//! Diagonally implicit Runge–Kutta steps with an explicit first stage, stiffly accurate and L-stable.
//!
//! With V_j, A_j the rates at the stages, stage i solves for x = A_i
//!
//! ```text
//! V = v₀ + h Σ_{j<i} a_ij A_j + γh x,   U = u₀ + h Σ_{j<i} a_ij V_j + γh V,   R(U, V, x, t₀ + c_i h) = 0
//! ```
//!
//! so all stages share one matrix. The last stage is the end of the step. Error of u: h Σ (b_i - b̂_i) V_i, filtered
//! by the stage matrix.

use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::solve::newton::Stall;
use crate::solve::scheme::{Bench, Moment, Scheme, predict};

/// Coefficients of a method of up to four stages.
#[derive(Debug)]
pub struct Tableau {
    stages: usize,
    gamma: f64,
    /// c_i.
    nodes: [f64; 4],
    /// a_ij below the diagonal; the last row is b.
    below: [[f64; 3]; 4],
    /// b̂_i of the embedded method.
    embedded: [f64; 4],
    /// Order of the error estimate in h.
    error_order: f64,
}

const SQRT2: f64 = std::f64::consts::SQRT_2;

/// TR-BDF2 (Bank et al. 1985): an Adams–Moulton step to t + (2 - √2) h, then a backward difference step; embedded method of order 3
/// (Hosea & Shampine 1996).
pub static TR_BDF2: Tableau = Tableau {
    stages: 3,
    gamma: 1.0 - 0.5 * SQRT2,
    nodes: [0.0, 2.0 - SQRT2, 1.0, 0.0],
    below: [[0.0; 3], [1.0 - 0.5 * SQRT2, 0.0, 0.0], [0.25 * SQRT2, 0.25 * SQRT2, 0.0], [0.0; 3]],
    embedded: [(1.0 - 0.25 * SQRT2) / 3.0, (0.75 * SQRT2 + 1.0) / 3.0, (1.0 - 0.5 * SQRT2) / 3.0, 0.0],
    error_order: 3.0,
};

const G: f64 = 1767732205903.0 / 4055673282236.0;

/// Implicit part of ARK3(2)4L[2]SA (Kennedy & Carpenter 2003): order 3, embedded order 2.
pub static ARK3: Tableau = Tableau {
    stages: 4,
    gamma: G,
    nodes: [0.0, 2.0 * G, 0.6, 1.0],
    below: [
        [0.0; 3],
        [G, 0.0, 0.0],
        [2746238789719.0 / 10658868560708.0, -640167445237.0 / 6845629431997.0, 0.0],
        [1471266399579.0 / 7840856788654.0, -4482444167858.0 / 7529755066697.0, 11266239266428.0 / 11593286722821.0],
    ],
    embedded: [
        2756255671327.0 / 12835298489170.0,
        -10771552573575.0 / 22201958757719.0,
        9247589265047.0 / 10645013368117.0,
        2193209047091.0 / 5459859503100.0,
    ],
    error_order: 3.0,
};

impl Tableau {
    /// b_i - b̂_i.
    fn error_weight(&self, i: usize) -> f64 {
        let last = self.stages - 1;
        let b = if i == last { self.gamma } else { self.below[last][i] };
        b - self.embedded[i]
    }
}

/// A method and its working space.
pub struct Esdirk {
    tableau: &'static Tableau,
    /// Rates at the stages between the first and the last: V_j and A_j.
    between: Vec<[Field; 2]>,
    base: Field,
    error: Field,
}

impl Esdirk {
    /// Room for `nodes` nodes.
    pub fn new(tableau: &'static Tableau, nodes: usize) -> Esdirk {
        let between = (2..tableau.stages).map(|_| [Field::new(nodes), Field::new(nodes)]).collect();
        Esdirk { tableau, between, base: Field::new(nodes), error: Field::new(nodes) }
    }

    fn stage(&mut self, i: usize, bench: &mut Bench, from: &Moment, h: f64, next: &mut State) -> Result<(), Stall> {
        let (tableau, start) = (self.tableau, &from.state);
        let diagonal = tableau.gamma * h;
        match self.between[..i - 1].last() {
            // What goes slack and taut all the time is accelerated by anything: the last acceleration says nothing of the next.
            _ if bench.newton.is_rough() => next.a.fill(0.0),
            None => predict(from, tableau.nodes[i] * h, &mut next.a),
            Some([_, before]) => {
                // Through the start and the stage before.
                let factor = tableau.nodes[i] / tableau.nodes[i - 1];
                next.a.set_sum([(1.0 - factor, &start.a), (factor, before)]);
            }
        }
        // U takes V as it is predicted here, so V comes first.
        for (order, of_stage) in [1, 0].into_iter().zip([&start.a, &start.v]) {
            let State { u, v, a, .. } = &mut *next;
            let (to, from, own) = if order == 1 { (v, &start.v, &*a) } else { (u, &start.u, &*v) };
            let share = |j: usize| h * tableau.below[i][j];
            match &self.between[..i - 1] {
                [] => to.set_sum([(1.0, from), (diagonal, own), (share(0), of_stage)]),
                [first] => to.set_sum([(1.0, from), (diagonal, own), (share(0), of_stage), (share(1), &first[order])]),
                [first, second, ..] => to.set_sum([
                    (1.0, from),
                    (diagonal, own),
                    (share(0), of_stage),
                    (share(1), &first[order]),
                    (share(2), &second[order]),
                ]),
            }
        }
        bench.prescribe(next, from.clock_after(tableau.nodes[i] * h));
        let weights = Weights { u: diagonal * diagonal, v: diagonal, a: 1.0 };
        bench.solve(&weights, next)?;
        if let Some([velocity, acceleration]) = self.between.get_mut(i - 1) {
            velocity.copy_from(&next.v);
            acceleration.copy_from(&next.a);
        }
        Ok(())
    }
}

impl Scheme for Esdirk {
    fn step(&mut self, bench: &mut Bench, from: &Moment, h: f64, next: &mut State) -> Result<f64, Stall> {
        let last = self.tableau.stages - 1;
        for i in 1..=last {
            self.stage(i, bench, from, h, next)?;
        }
        let share = |i: usize| h * self.tableau.error_weight(i);
        self.error.set_sum([(share(0), &from.state.v), (share(last), &next.v)]);
        for (i, [velocity, _]) in (1..).zip(&self.between) {
            self.error.add(share(i), velocity);
        }
        for &(node, component) in bench.line.fixed() {
            self.error.component_mut(component)[node] = 0.0;
        }
        bench.filter(next, &mut self.error, &mut self.base);
        Ok(bench.line.error_size(&self.error))
    }

    fn error_order(&self) -> f64 {
        self.tableau.error_order
    }

    fn is_l_stable(&self) -> bool {
        true
    }
}
