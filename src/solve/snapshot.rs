//! The complete state of a line in time as plain data, and as bytes.

use crate::cable1994::line::Tensions;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::sea::clock::Clock;
use crate::solve::scheme::Moment;
use crate::solve::simulation::LastStep;

/// Everything that the next step depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    pub(super) moment: Moment,
    /// Of `cable-1994`; empty for every other scheme.
    pub(super) tensions: Tensions,
    pub(super) work: f64,
    pub(super) fresh: bool,
    pub(super) error: f64,
    pub(super) last: LastStep,
}

impl Moment {
    /// Becomes another moment of the same line; allocates nothing, except what friction holds on to where there was none before.
    pub fn copy_from(&mut self, other: &Moment) {
        let Moment { state, earlier, last_step, step, guard } = other;
        self.state.copy_from(state);
        self.earlier.copy_from(earlier);
        (self.last_step, self.step, self.guard) = (*last_step, *step, *guard);
    }
}

impl Snapshot {
    /// Room for the state of a line of so many nodes.
    pub fn new(nodes: usize) -> Snapshot {
        let (state, earlier, tensions) = (State::new(nodes), Field::new(nodes), Tensions::default());
        let moment = Moment { state, earlier, last_step: 0.0, step: 0.0, guard: 0 };
        Snapshot { moment, tensions, work: 0.0, fresh: true, error: 0.0, last: LastStep::default() }
    }

    /// Number of nodes of the line it belongs to.
    pub fn nodes(&self) -> usize {
        self.moment.state.u.nodes()
    }

    /// Appends the state as little-endian 8-byte words: nodes, of the line and of what friction holds on to, flags and counts,
    /// scalars, then u, v, a, the earlier a and what friction holds on to, and of `cable-1994` its tensions now and before.
    pub fn to_bytes(&self, out: &mut Vec<u8>) {
        let (m, last) = (&self.moment, &self.last);
        let words = [
            self.nodes() as u64,
            m.state.holds.nodes() as u64,
            u64::from(self.fresh),
            u64::from(m.guard),
            last.substeps as u64,
            last.newton_iterations as u64,
        ];
        let scalars = [m.state.clock.now, m.state.clock.start, m.last_step, m.step, self.work, self.error, last.error_estimate];
        let fields = [&m.state.u, &m.state.v, &m.state.a, &m.earlier, &m.state.holds];
        let tensions = self.tensions.now.iter().chain(&self.tensions.before);
        let numbers = scalars.iter().chain(fields.into_iter().flat_map(Field::numbers)).chain(tensions).map(|x| x.to_bits());
        words.into_iter().chain(numbers).for_each(|word| out.extend_from_slice(&word.to_le_bytes()));
    }

    /// Reads what `to_bytes` wrote; none if the length does not fit or a number is not finite.
    pub fn from_bytes(bytes: &[u8]) -> Option<Snapshot> {
        let mut words = bytes.chunks_exact(8).map(|chunk| chunk.try_into().map(u64::from_le_bytes).unwrap_or(0));
        let nodes = usize::try_from(words.next()?).ok()?;
        let holding = usize::try_from(words.next()?).ok()?;
        let numbers = nodes.checked_mul(4)?.checked_add(holding)?.checked_mul(COMPONENTS)?;
        let expected = numbers.checked_add(13)?.checked_mul(8)?;
        let per_node = match bytes.len().checked_sub(expected)? {
            0 => 0,
            more if more == 4 * 8 * nodes => 2,
            _ => return None,
        };
        if nodes < 2 {
            return None;
        }
        let fresh = match words.next()? {
            0 => false,
            1 => true,
            _ => return None,
        };
        let guard = u32::try_from(words.next()?).ok()?;
        let (substeps, newton_iterations) = (words.next()? as usize, words.next()? as usize);
        let mut number = || words.next().map(f64::from_bits).filter(|x| x.is_finite());
        let clock = Clock { now: number()?, start: number()? };
        let (last_step, step, work, error, error_estimate) = (number()?, number()?, number()?, number()?, number()?);
        let mut field = |nodes| {
            let mut field = Field::new(nodes);
            for c in 0..COMPONENTS {
                for x in field.component_mut(c) {
                    *x = number()?;
                }
            }
            Some(field)
        };
        let (u, v, a, earlier, holds) = (field(nodes)?, field(nodes)?, field(nodes)?, field(nodes)?, field(holding)?);
        let mut list = || (0..per_node * nodes).map(|_| number()).collect::<Option<Vec<f64>>>();
        let tensions = Tensions { now: list()?, before: list()? };
        Some(Snapshot {
            moment: Moment { state: State { clock, u, v, a, holds }, earlier, last_step, step, guard },
            tensions,
            work,
            fresh,
            error,
            last: LastStep { substeps, newton_iterations, error_estimate },
        })
    }
}
