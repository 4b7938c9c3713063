//! The complete state of a line in time as plain data, and as bytes.

use crate::cable1994::line::Tensions;
use crate::rod::motion::Weights;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::sea::clock::Clock;
use crate::solve::counters::LastStep;
use crate::solve::memory::{Memory, Origin};
use crate::solve::newton::Newton;
use crate::solve::scheme::Moment;
use nalgebra::Matrix3;
use std::sync::Arc;

/// Everything that the next step depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    pub(super) moment: Moment,
    pub(super) memory: Memory,
    /// Of `cable-1994`; empty for every other scheme.
    pub(super) tensions: Tensions,
    pub(super) work: f64,
    /// Work done on what moves the anchor.
    pub(super) anchor_work: f64,
    /// Of a network, work done on what moves each driven end, then the error allowed to each line.
    pub(super) of_network: Vec<f64>,
    pub(super) fresh: bool,
    /// The line is known to be at rest.
    pub(super) resting: bool,
    /// The line is solved in a plane.
    pub(super) planar: bool,
    pub(super) error: f64,
    pub(super) last: LastStep,
}

impl Moment {
    /// Becomes another moment of the same line; allocates nothing, except what friction holds on to where there was none before.
    pub fn copy_from(&mut self, other: &Moment) {
        let Moment { state, earlier, last_step, step, tried, guard } = other;
        self.state.copy_from(state);
        self.earlier.copy_from(earlier);
        (self.last_step, self.step, self.tried, self.guard) = (*last_step, *step, *tried, *guard);
    }
}

impl Snapshot {
    /// Room for the state of a line of so many nodes.
    pub fn new(nodes: usize) -> Snapshot {
        let (state, earlier, tensions) = (State::new(nodes), Field::new(nodes), Tensions::default());
        let moment = Moment { state, earlier, last_step: 0.0, step: 0.0, tried: 0.0, guard: 0 };
        let (memory, last) = (Memory::none(), LastStep::default());
        Snapshot {
            moment,
            memory,
            tensions,
            work: 0.0,
            anchor_work: 0.0,
            of_network: Vec::new(),
            fresh: true,
            resting: false,
            planar: false,
            error: 0.0,
            last,
        }
    }

    /// Number of nodes of the line it belongs to.
    pub fn nodes(&self) -> usize {
        self.moment.state.u.nodes()
    }

    /// Number of free bodies of what it belongs to.
    pub fn bodies(&self) -> usize {
        self.moment.state.frames.len()
    }

    /// Number of driven ends and lines of the network that it belongs to.
    pub fn driven_and_lines(&self) -> usize {
        self.of_network.len()
    }

    /// Whether what it remembers of how parts of a network contract is that of so many, or of none.
    pub fn fits_parts(&self, count: usize) -> bool {
        self.memory.rates.is_empty() || self.memory.rates.len() == count
    }

    /// Number of nodes that hold on to the bed.
    pub fn holding_nodes(&self) -> usize {
        self.moment.state.holds.nodes()
    }

    /// Becomes the state of a network: works done on its driven ends, errors allowed to its lines and to the finest.
    pub fn keep(
        &mut self,
        moment: &Moment,
        memory: &Memory,
        [works, errors]: [&[f64]; 2],
        error: f64,
        fresh: bool,
        last: LastStep,
    ) {
        self.of_network.clear();
        self.of_network.extend(works.iter().chain(errors));
        self.moment.copy_from(moment);
        self.memory.clone_from(memory);
        (self.error, self.fresh, self.last, self.planar, self.resting) = (error, fresh, last, false, false);
    }

    /// Puts back the state of a network; returns the allowed error, whether it is fresh, and its last step.
    pub fn bring_back(&self, moment: &mut Moment, newton: &mut Newton, lists: [&mut [f64]; 2]) -> (f64, bool, LastStep) {
        lists.into_iter().flatten().zip(&self.of_network).for_each(|(to, from)| *to = *from);
        moment.copy_from(&self.moment);
        newton.recall(&self.memory);
        (self.error, self.fresh, self.last)
    }

    /// Appends the state as little-endian 8-byte words: nodes, of the line and of what friction holds on to, flags and counts,
    /// scalars, then u, v, a, the earlier a and what friction holds on to, of `cable-1994` its tensions now and before, and from what the
    /// factor of the tangent was made, if there is one.
    pub fn to_bytes(&self, out: &mut Vec<u8>) {
        let (m, last, memory) = (&self.moment, &self.last, &self.memory);
        let flags = [self.fresh, self.resting, self.planar, memory.rough, memory.origin.is_some()];
        let words: [u64; WORDS] = [
            self.nodes() as u64,
            m.state.holds.nodes() as u64,
            flags.iter().rev().fold(0, |bits, flag| 2 * bits + u64::from(*flag)),
            u64::from(m.guard),
            last.substeps as u64,
            last.newton_iterations as u64,
            m.state.frames.len() as u64,
            self.of_network.len() as u64,
            memory.rates.len() as u64,
        ];
        out.reserve(
            8 * (words.len() + SCALARS + 18 * m.state.frames.len() + 8 * COMPONENTS * (self.nodes() + m.state.holds.nodes())),
        );
        words.into_iter().for_each(|word| out.extend_from_slice(&word.to_le_bytes()));
        let clock = m.state.clock;
        let steps = [clock.now, clock.start, m.last_step, m.step, m.tried, memory.rate];
        write(&steps, out);
        let scalars: [f64; SCALARS - 6] = [self.work, self.anchor_work, self.error, last.error_estimate];
        write(&scalars, out);
        [&m.state.u, &m.state.v, &m.state.a, &m.earlier, &m.state.holds].into_iter().for_each(|field| write_field(field, out));
        m.state.frames.iter().for_each(|frame| write(frame.as_slice(), out));
        write(&self.of_network, out);
        write(&memory.rates, out);
        write(&self.tensions.now, out);
        write(&self.tensions.before, out);
        if let Some(origin) = &memory.origin {
            let Origin { weights, state } = origin.as_ref();
            write(&[weights.u, weights.v, weights.a, state.clock.now, state.clock.start], out);
            [&state.u, &state.v, &state.a, &state.holds].into_iter().for_each(|field| write_field(field, out));
            state.frames.iter().for_each(|frame| write(frame.as_slice(), out));
        }
    }

    /// Reads what `to_bytes` wrote; none if the length does not fit or a number is not finite.
    pub fn from_bytes(bytes: &[u8]) -> Option<Snapshot> {
        let mut words = bytes.chunks_exact(8).map(|chunk| chunk.try_into().map(u64::from_le_bytes).unwrap_or(0));
        let nodes = usize::try_from(words.next()?).ok()?;
        let holding = usize::try_from(words.next()?).ok()?;
        let bits = words.next().filter(|bits| *bits < 1 << FLAGS)?;
        let [fresh, resting, planar, rough, kept] = std::array::from_fn(|flag: usize| bits >> flag & 1 == 1);
        let guard = u32::try_from(words.next()?).ok()?;
        let (substeps, newton_iterations) = (words.next()? as usize, words.next()? as usize);
        let bodies = usize::try_from(words.next()?).ok().filter(|bodies| *bodies <= nodes)?;
        let more = usize::try_from(words.next()?).ok().filter(|more| *more <= 2 * nodes)?;
        let parts = usize::try_from(words.next()?).ok().filter(|parts| *parts <= nodes)?;
        let numbers = |fields: usize| nodes.checked_mul(fields)?.checked_add(holding)?.checked_mul(COMPONENTS);
        let origin = if kept { numbers(3)?.checked_add(5 + 9 * bodies)? } else { 0 };
        let expected =
            numbers(4)?.checked_add(WORDS + SCALARS + 9 * bodies + more + parts)?.checked_add(origin)?.checked_mul(8)?;
        let per_node = match bytes.len().checked_sub(expected)? {
            0 => 0,
            rest if rest == 4 * 8 * nodes => 2,
            _ => return None,
        };
        if nodes < 2 {
            return None;
        }
        let mut number = || words.next().map(f64::from_bits).filter(|x| x.is_finite());
        let clock = Clock { now: number()?, start: number()? };
        let (last_step, step, tried, rate) = (number()?, number()?, number()?, number()?);
        let (work, anchor_work, error, error_estimate) = (number()?, number()?, number()?, number()?);
        let (u, v, a) = (field(nodes, &mut number)?, field(nodes, &mut number)?, field(nodes, &mut number)?);
        let (earlier, holds) = (field(nodes, &mut number)?, field(holding, &mut number)?);
        let frames = turns(bodies, &mut number)?;
        let of_network = (0..more).map(|_| number()).collect::<Option<Vec<f64>>>()?;
        let rates = (0..parts).map(|_| number()).collect::<Option<Vec<f64>>>()?;
        let mut list = || (0..per_node * nodes).map(|_| number()).collect::<Option<Vec<f64>>>();
        let tensions = Tensions { now: list()?, before: list()? };
        let mut origin = || {
            let weights = Weights { u: number()?, v: number()?, a: number()? };
            let clock = Clock { now: number()?, start: number()? };
            let (u, v, a) = (field(nodes, &mut number)?, field(nodes, &mut number)?, field(nodes, &mut number)?);
            Some(Arc::new(Origin {
                weights,
                state: State { clock, u, v, a, holds: field(holding, &mut number)?, frames: turns(bodies, &mut number)? },
            }))
        };
        let origin = if kept { Some(origin()?) } else { None };
        Some(Snapshot {
            moment: Moment { state: State { clock, u, v, a, holds, frames }, earlier, last_step, step, tried, guard },
            memory: Memory { origin, rate, rates, rough },
            tensions,
            work,
            anchor_work,
            of_network,
            fresh,
            resting,
            planar,
            error,
            last: LastStep { substeps, newton_iterations, error_estimate },
        })
    }
}

/// Flags of a state.
const FLAGS: usize = 5;
/// Words of a state before its scalars.
const WORDS: usize = 9;
/// Scalars of a state.
const SCALARS: usize = 10;

fn write(numbers: &[f64], out: &mut Vec<u8>) {
    out.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
}

fn write_field(field: &Field, out: &mut Vec<u8>) {
    (0..COMPONENTS).for_each(|c| write(field.component(c), out));
}

/// Rotations of the numbers that come next.
fn turns(count: usize, number: &mut impl FnMut() -> Option<f64>) -> Option<Vec<Matrix3<f64>>> {
    let mut turns = vec![Matrix3::zeros(); count];
    for x in turns.iter_mut().flat_map(|turn| turn.as_mut_slice()) {
        *x = number()?;
    }
    Some(turns)
}

/// A field of the numbers that come next.
fn field(nodes: usize, number: &mut impl FnMut() -> Option<f64>) -> Option<Field> {
    let mut field = Field::new(nodes);
    for c in 0..COMPONENTS {
        for x in field.component_mut(c) {
            *x = number()?;
        }
    }
    Some(field)
}
