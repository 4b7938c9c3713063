//! What the stage solver takes over from one step to the next, small enough to be part of a state: how it did of late, and from what the
//! factor of its tangent was made. The factor itself is not kept: from the same it is made again to the last bit. Of a network, lines may be
//! factored at different times: then it was made from one motion in which each line is where it was at its own.

use crate::rod::motion::{Asking, Motion, Weights};
use crate::rod::state::{COMPONENTS, State};
use std::sync::Arc;

/// From what a factor was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// The weights of the tangent.
    pub weights: Weights,
    /// Where the tangent was taken.
    pub state: State,
}

/// All of the past of the stage solver that the next stage depends on. A clone shares the origin, so that it costs next to nothing.
#[derive(Debug, PartialEq)]
pub struct Memory {
    /// Origin of the factor that the next stage may use; none: it begins with a new one.
    pub origin: Option<Arc<Origin>>,
    /// How the iteration contracted last: each increment over the one before.
    pub rate: f64,
    /// The same of each line, then of each body and point, of a network; none of a line alone.
    pub rates: Vec<f64>,
    /// Whole steps failed where shortened ones did not: near a kink that the line keeps crossing.
    pub rough: bool,
}

impl Clone for Memory {
    fn clone(&self) -> Memory {
        Memory { origin: self.origin.clone(), rates: self.rates.clone(), ..*self }
    }

    // Allocates nothing where there is room.
    fn clone_from(&mut self, other: &Memory) {
        self.origin.clone_from(&other.origin);
        self.rates.clone_from(&other.rates);
        (self.rate, self.rough) = (other.rate, other.rough);
    }
}

impl Memory {
    /// Before the first stage.
    pub fn none() -> Memory {
        Memory { origin: None, rate: 1.0, rates: Vec::new(), rough: false }
    }

    /// Weights of the factor that the next stage may use.
    pub fn weights(&self) -> Option<&Weights> {
        self.origin.as_ref().map(|origin| &origin.weights)
    }
}

/// Origins out of use, to be written over when no state holds on to them any more, so that in the long run nothing is allocated.
#[derive(Default)]
pub struct Shelf(Vec<Arc<Origin>>);

/// Origins kept at most: the line holds on to one, its state before the last advance to another, and a master to one or two.
const ROOM: usize = 4;

impl Shelf {
    /// Takes in an origin.
    pub fn put(&mut self, origin: Option<Arc<Origin>>) {
        let Some(origin) = origin else { return };
        if self.0.len() == ROOM {
            self.0.remove(0);
        }
        self.0.push(origin);
    }

    /// A motion and weights as an origin.
    pub fn origin(&mut self, at: &Motion, weights: &Weights) -> Arc<Origin> {
        let free = self.0.iter_mut().position(|origin| Arc::get_mut(origin).is_some());
        let mut origin = match free {
            Some(free) => self.0.swap_remove(free),
            None => Arc::new(Origin { weights: *weights, state: State::new(at.u.nodes()) }),
        };
        let Origin { weights: kept, state } = Arc::make_mut(&mut origin);
        *kept = *weights;
        state.clock = at.clock;
        state.u.copy_from(at.u);
        state.v.copy_from(at.v);
        state.a.copy_from(at.a);
        state.holds.copy_from(at.holds);
        state.frames.clear();
        state.frames.extend_from_slice(at.frames);
        origin
    }
}

impl Shelf {
    /// An origin of which the nodes of each of `runs`, from its first to before its end, are those of a motion, and so are the rotations.
    pub fn renewed(&mut self, from: &Origin, at: &Motion, runs: impl Iterator<Item = (usize, usize)>) -> Arc<Origin> {
        let State { clock, u, v, a, holds, frames } = &from.state;
        let before = Motion { clock: *clock, u, v, a, holds, frames, asking: Asking::Alone };
        let mut origin = self.origin(&before, &from.weights);
        let State { clock, u, v, a, frames, .. } = &mut Arc::make_mut(&mut origin).state;
        *clock = at.clock;
        frames.clear();
        frames.extend_from_slice(at.frames);
        for (first, end) in runs {
            for (to, from) in [(&mut *u, at.u), (&mut *v, at.v), (&mut *a, at.a)] {
                (0..COMPONENTS).for_each(|c| to.component_mut(c)[first..end].copy_from_slice(&from.component(c)[first..end]));
            }
        }
        origin
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::newton::motion;

    /// An origin that a state holds on to stays what it is; one that nobody holds on to is used again.
    #[test]
    fn an_origin_is_written_over_only_when_nobody_holds_on_to_it() {
        let (mut shelf, mut state) = (Shelf::default(), State::new(3));
        let weights = Weights { u: 1.0, v: 2.0, a: 3.0 };
        let first = shelf.origin(&motion(&state), &weights);
        let (held, place) = (first.clone(), Arc::as_ptr(&first));
        shelf.put(Some(first));
        state.u.fill(5.0);
        let second = shelf.origin(&motion(&state), &weights);
        assert!(Arc::as_ptr(&second) != place && held.state == State::new(3) && second.state == state);
        drop(held);
        shelf.put(Some(second));
        let third = shelf.origin(&motion(&state), &weights);
        assert!(shelf.0.len() == 1 && third.state == state);
        for _ in 0..10 {
            let more = shelf.origin(&motion(&state), &weights);
            shelf.put(Some(more));
        }
        assert!(shelf.0.len() <= ROOM);
    }
}
