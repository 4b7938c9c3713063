//! The FMU state: all that an instance is at one moment, as plain data and as bytes.
//!
//! Bytes, little-endian: magic (8), version (4), fingerprint of scene and interface (16), length of what follows (8), the state,
//! checksum over all before it (16). Text of the instance's log and other handed-out states are not part of it.

use crate::fmi::body_variables::Said;
use crate::fmi::experiment::Experiment;
use crate::fmi::filter::Filter;
use crate::fmi::fit::{Fit, Point};
use crate::fmi::freshness::{Age, Pace};
use crate::fmi::input_path::{Axis, CAPACITY, InputPath, Sample};
use crate::fmi::inputs::Inputs;
use crate::fmi::phase::{Phase, StepStatus};
use crate::fmi::refusal::Refusal;
use crate::fmi::resource::fingerprint;
use crate::fmi::vessel::{Reached, Vessel};
use crate::fmi::warnings::Told;
use crate::solve::simulation::{LastStep, Outputs};
use crate::solve::snapshot::Snapshot;
use nalgebra::Vector3;

const MAGIC: &[u8; 8] = b"MOORLINE";
const VERSION: u32 = 9;
const HEADER: usize = 8 + 4 + 16 + 8;
const CHECKSUM: usize = 16;

/// All that an instance is, but for the lines themselves.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Where in the life of an instance.
    pub phase: Phase,
    /// What the master said of the experiment.
    pub experiment: Experiment,
    /// The communication point reached [s].
    pub clock: f64,
    /// Length of the last step, or of the default one before the first [s].
    pub last_step_size: f64,
    /// How the last step ended.
    pub step_status: StepStatus,
    /// Values of the parameters, by slot.
    pub parameters: Vec<f64>,
    /// Whether the lines are in equilibrium for these parameters at their origins.
    pub settled: bool,
    /// What each line has of its own.
    pub ends: Vec<End>,
    /// What each body has of its own.
    pub vessels: Vec<Vessel>,
    /// Free points: number in the scene, position [m] and velocity [m/s].
    pub points: Vec<(usize, [Vector3<f64>; 2])>,
}

/// The upper end of a line as the master sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct End {
    /// Position at which the line was put in equilibrium [m]; with the parameters it makes the line what it is.
    pub origin: [f64; 3],
    /// The inputs as last set.
    pub inputs: Inputs,
    /// Where the fairlead's path stands.
    pub path: InputPath,
    /// Where the filter of the positions stands.
    pub filter: Filter,
    /// What the master has been warned of.
    pub told: Told,
    /// Outputs of the last step.
    pub outputs: Outputs,
    /// How the solver did in the last step.
    pub last: LastStep,
}

/// A moment with the states of the lines, if there are lines at that moment.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// The instance.
    pub moment: Moment,
    /// The lines; none before the initialisation.
    pub lines: Vec<Snapshot>,
}

impl State {
    /// The state as bytes that only an instance with the same fingerprint reads.
    pub fn to_bytes(&self, scene: u128) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&scene.to_le_bytes());
        bytes.extend_from_slice(&[0; 8]);
        let mut writer = Writer(bytes);
        self.moment.write(&mut writer);
        let mut bytes = writer.0;
        bytes.extend_from_slice(&(self.lines.len() as u64).to_le_bytes());
        for line in &self.lines {
            let begin = bytes.len();
            bytes.extend_from_slice(&[0; 8]);
            line.to_bytes(&mut bytes);
            let length = (bytes.len() - begin - 8) as u64;
            bytes[begin..begin + 8].copy_from_slice(&length.to_le_bytes());
        }
        let length = (bytes.len() - HEADER) as u64;
        bytes[HEADER - 8..HEADER].copy_from_slice(&length.to_le_bytes());
        let checksum = fingerprint(&bytes);
        bytes.extend_from_slice(&checksum.to_le_bytes());
        bytes
    }

    /// Reads bytes that `to_bytes` wrote; anything else, damaged by as little as a bit, is refused.
    /// `like`: a moment of the instance that will take it.
    pub fn from_bytes(bytes: &[u8], scene: u128, like: &Moment) -> Result<State, Refusal> {
        let refuse = |reason| Err(Refusal::Serialized(reason));
        if !bytes.starts_with(MAGIC) {
            return refuse("it was not written by moorline");
        }
        let Some((body, checksum)) = bytes.split_last_chunk::<CHECKSUM>().filter(|(body, _)| body.len() >= HEADER) else {
            return refuse("it is cut off");
        };
        let mut reader = Reader(&body[MAGIC.len()..]);
        if reader.array::<4>().map(u32::from_le_bytes) != Some(VERSION) {
            return refuse("it was written by another version of moorline");
        }
        let written_for = reader.array::<16>().map(u128::from_le_bytes);
        if reader.count() != Some(body.len() - HEADER) {
            return refuse("it is cut off, or longer than it says");
        }
        if fingerprint(body) != u128::from_le_bytes(*checksum) {
            return refuse("its checksum is wrong: it was damaged");
        }
        if written_for != Some(scene) {
            return refuse("it belongs to an FMU of another scene or interface");
        }
        Self::read(&mut reader, like).map_or_else(|| refuse("its content makes no sense"), Ok)
    }

    fn read(reader: &mut Reader<'_>, like: &Moment) -> Option<State> {
        let (parameters, ends, vessels) = (like.parameters.len(), like.ends.len(), like.vessels.len());
        let moment = Moment::read(reader)?;
        let count = reader.count().filter(|count| *count <= ends + vessels)?;
        let lines = reader.several(count, |reader| {
            let length = reader.count()?;
            Snapshot::from_bytes(reader.take(length)?)
        })?;
        let alike = moment.parameters.len() == parameters && moment.ends.len() == ends && moment.vessels.len() == vessels;
        let fits = alike && reader.0.is_empty();
        fits.then_some(State { moment, lines })
    }
}

impl Moment {
    /// Becomes another moment of the same instance; in the long run it allocates nothing.
    pub fn copy_from(&mut self, other: &Moment) {
        let Moment { phase, experiment, clock, last_step_size, step_status, parameters, settled, ends, vessels, points } = other;
        (self.phase, self.experiment, self.clock, self.last_step_size) = (*phase, *experiment, *clock, *last_step_size);
        (self.step_status, self.settled) = (*step_status, *settled);
        self.parameters.clone_from(parameters);
        self.ends.resize_with(ends.len(), || End::at_rest(Inputs::default()));
        self.ends.iter_mut().zip(ends).for_each(|(end, other)| end.copy_from(other));
        self.vessels.resize_with(vessels.len(), || Vessel::at_rest(Said::default()));
        self.vessels.iter_mut().zip(vessels).for_each(|(vessel, other)| vessel.copy_from(other));
        self.points.clone_from(points);
    }

    fn write(&self, writer: &mut Writer) {
        writer.count(self.phase.number());
        writer.count(self.step_status.number());
        writer.real(self.experiment.start);
        writer.option(self.experiment.stop);
        writer.option(self.experiment.tolerance);
        writer.real(self.clock);
        writer.real(self.last_step_size);
        writer.count(self.parameters.len());
        self.parameters.iter().for_each(|value| writer.real(*value));
        writer.flag(self.settled);
        writer.count(self.ends.len());
        self.ends.iter().for_each(|end| end.write(writer));
        writer.count(self.vessels.len());
        self.vessels.iter().for_each(|vessel| write_vessel(vessel, writer));
        writer.count(self.points.len());
        for (number, motion) in &self.points {
            writer.count(*number);
            motion.iter().for_each(|vector| writer.triple((*vector).into()));
        }
    }

    fn read(reader: &mut Reader<'_>) -> Option<Moment> {
        let phase = Phase::from_number(reader.count()?)?;
        let step_status = StepStatus::from_number(reader.count()?)?;
        let experiment = Experiment { start: reader.real()?, stop: reader.option()?, tolerance: reader.option()? };
        let (clock, last_step_size) = (reader.real()?, reader.real()?);
        let count = reader.count()?;
        let parameters = reader.several(count, Reader::real)?;
        let settled = reader.flag()?;
        let count = reader.count()?;
        let ends = reader.several(count, End::read)?;
        let count = reader.count()?;
        let vessels = reader.several(count, read_vessel)?;
        let count = reader.count()?;
        let point = |reader: &mut Reader<'_>| Some((reader.count()?, [reader.triple()?.into(), reader.triple()?.into()]));
        let points = reader.several(count, point)?;
        Some(Moment { phase, experiment, clock, last_step_size, step_status, parameters, settled, ends, vessels, points })
    }
}

impl End {
    /// A fairlead at rest where the inputs put it.
    pub fn at_rest(inputs: Inputs) -> End {
        let (zero, origin) = (Vector3::zeros(), inputs.values[0]);
        let outputs = Outputs {
            time: 0.0,
            fairlead: zero,
            force: zero,
            moment: zero,
            anchor_moment: zero,
            tension: 0.0,
            anchor: zero,
            anchor_force: zero,
            anchor_tension: 0.0,
            tension_max: 0.0,
            declination: 0.0,
            azimuth: 0.0,
            grounded_length: 0.0,
            work: 0.0,
        };
        End {
            origin,
            inputs,
            filter: Filter::at_rest(origin, 0.0),
            path: InputPath::at_rest(origin),
            told: Told::default(),
            outputs,
            last: LastStep::default(),
        }
    }

    fn copy_from(&mut self, other: &End) {
        let End { origin, inputs, path, filter, told, outputs, last } = other;
        (self.origin, self.inputs, self.outputs, self.last) = (*origin, *inputs, *outputs, *last);
        (self.told, self.filter) = (*told, *filter);
        self.path.copy_from(path);
    }

    fn write(&self, writer: &mut Writer) {
        writer.triple(self.origin);
        self.inputs.values.iter().for_each(|value| writer.triple(*value));
        self.inputs.derivatives.iter().flatten().flatten().for_each(|value| writer.option(*value));
        write_path(&self.path, writer);
        write_filter(&self.filter, writer);
        writer.count(self.told.0 as usize);
        let o = &self.outputs;
        writer.real(o.time);
        [o.fairlead, o.force, o.moment, o.anchor, o.anchor_force, o.anchor_moment]
            .into_iter()
            .for_each(|vector| writer.triple(vector.into()));
        let scalars = [o.tension, o.anchor_tension, o.tension_max, o.declination, o.azimuth, o.grounded_length, o.work];
        scalars.into_iter().for_each(|value| writer.real(value));
        writer.count(self.last.substeps);
        writer.count(self.last.newton_iterations);
        writer.real(self.last.error_estimate);
    }

    fn read(reader: &mut Reader<'_>) -> Option<End> {
        let origin = reader.triple()?;
        let mut inputs = Inputs { values: [reader.triple()?, reader.triple()?], ..Inputs::default() };
        for slot in inputs.derivatives.iter_mut().flatten().flatten() {
            *slot = reader.option()?;
        }
        let (path, filter) = (read_path(reader)?, read_filter(reader)?);
        let told = Told(reader.number()?);
        let time = reader.real()?;
        let mut vector = || reader.triple().map(Vector3::from);
        let (fairlead, force, moment) = (vector()?, vector()?, vector()?);
        let (anchor, anchor_force, anchor_moment) = (vector()?, vector()?, vector()?);
        let outputs = Outputs {
            time,
            fairlead,
            force,
            moment,
            anchor,
            anchor_force,
            anchor_moment,
            tension: reader.real()?,
            anchor_tension: reader.real()?,
            tension_max: reader.real()?,
            declination: reader.real()?,
            azimuth: reader.real()?,
            grounded_length: reader.real()?,
            work: reader.real()?,
        };
        let last = LastStep { substeps: reader.count()?, newton_iterations: reader.count()?, error_estimate: reader.real()? };
        Some(End { origin, inputs, path, filter, told, outputs, last })
    }
}

fn write_path(path: &InputPath, writer: &mut Writer) {
    writer.triple(path.position);
    writer.triple(path.velocity);
    writer.flag(path.velocity_given);
    writer.count(path.samples.len());
    for sample in &path.samples {
        writer.real(sample.time);
        writer.triple(sample.position);
        writer.triple(sample.velocity);
        sample.fresh.into_iter().for_each(|fresh| writer.flag(fresh));
    }
    writer.real(path.absorbed);
    writer.real(path.stepped);
    writer.real(path.pace.last);
    path.pace.intervals.iter().for_each(|interval| writer.real(*interval));
    writer.count(path.pace.slower as usize);
    writer.flag(path.axes.is_some());
    path.axes.iter().flatten().for_each(|axis| write_axis(axis, writer));
}

fn read_path(reader: &mut Reader<'_>) -> Option<InputPath> {
    let (position, velocity, velocity_given) = (reader.triple()?, reader.triple()?, reader.flag()?);
    let count = reader.count().filter(|count| *count <= CAPACITY)?;
    let sample = |reader: &mut Reader<'_>| {
        let (time, position, velocity) = (reader.real()?, reader.triple()?, reader.triple()?);
        Some(Sample { time, position, velocity, fresh: [reader.flag()?, reader.flag()?, reader.flag()?] })
    };
    let samples = reader.several(count, sample)?;
    let (absorbed, stepped) = (reader.real()?, reader.real()?);
    let pace = Pace { last: reader.real()?, intervals: reader.reals()?, slower: reader.number()? };
    let axes = if reader.flag()? { Some([read_axis(reader)?, read_axis(reader)?, read_axis(reader)?]) } else { None };
    Some(InputPath { samples, position, velocity, velocity_given, axes, absorbed, stepped, pace })
}

fn write_filter(filter: &Filter, writer: &mut Writer) {
    writer.real(filter.time);
    [filter.given, filter.position, filter.velocity].into_iter().for_each(|value| writer.triple(value));
}

fn read_filter(reader: &mut Reader<'_>) -> Option<Filter> {
    Some(Filter { time: reader.real()?, given: reader.triple()?, position: reader.triple()?, velocity: reader.triple()? })
}

fn write_vessel(vessel: &Vessel, writer: &mut Writer) {
    let Vessel { origin, said, paths, filters, angles, told, reached } = vessel;
    origin.iter().chain(&said.values).chain(&said.applied).for_each(|values| writer.triple(*values));
    said.derivatives.iter().flatten().flatten().for_each(|value| writer.option(*value));
    paths.iter().for_each(|path| write_path(path, writer));
    filters.iter().for_each(|filter| write_filter(filter, writer));
    writer.triple(*angles);
    writer.count(told.0 as usize);
    let Reached { position, angles, velocity, omega, force, moment, work } = reached;
    [position, angles, velocity, omega, force, moment].into_iter().for_each(|vector| writer.triple((*vector).into()));
    writer.real(*work);
}

fn read_vessel(reader: &mut Reader<'_>) -> Option<Vessel> {
    let mut triple = || reader.triple();
    let origin = [triple()?, triple()?];
    let values = [triple()?, triple()?, triple()?, triple()?];
    let mut said = Said { values, applied: [triple()?, triple()?], ..Said::default() };
    for slot in said.derivatives.iter_mut().flatten().flatten() {
        *slot = reader.option()?;
    }
    let paths = [read_path(reader)?, read_path(reader)?];
    let filters = [read_filter(reader)?, read_filter(reader)?];
    let (angles, told) = (reader.triple()?, Told(reader.number()?));
    let mut vector = || reader.triple().map(Vector3::from);
    let (position, of, velocity, omega) = (vector()?, vector()?, vector()?, vector()?);
    let (force, moment) = (vector()?, vector()?);
    let reached = Reached { position, angles: of, velocity, omega, force, moment, work: reader.real()? };
    Some(Vessel { origin, said, paths, filters, angles, told, reached })
}

fn write_axis(axis: &Axis, writer: &mut Writer) {
    let Axis { given, ages, carried, since, fit } = axis;
    given.iter().for_each(|value| writer.real(*value));
    for Age { since, intervals, meant } in ages {
        writer.real(*since);
        intervals.iter().for_each(|interval| writer.real(*interval));
        writer.flag(*meant);
    }
    carried.iter().for_each(|term| writer.real(*term));
    writer.real(*since);
    for Point { time, position, velocity } in fit.last {
        [time, position, velocity].into_iter().for_each(|value| writer.real(value));
    }
    writer.count(fit.count as usize);
    fit.sums.iter().chain(&fit.squares).for_each(|value| writer.real(*value));
    writer.flag(fit.misfit);
}

fn read_axis(reader: &mut Reader<'_>) -> Option<Axis> {
    let given = reader.reals()?;
    let mut age = || Some(Age { since: reader.real()?, intervals: reader.reals()?, meant: reader.flag()? });
    let ages = [age()?, age()?];
    let (carried, since) = (reader.reals()?, reader.real()?);
    let mut point = || Some(Point { time: reader.real()?, position: reader.real()?, velocity: reader.real()? });
    let last = [point()?, point()?];
    let count = reader.number()?;
    let fit = Fit { last, count, sums: reader.reals()?, squares: reader.reals()?, misfit: reader.flag()? };
    Some(Axis { given, ages, carried, since, fit })
}

/// Appends values, little-endian.
struct Writer(Vec<u8>);

impl Writer {
    fn real(&mut self, value: f64) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    fn count(&mut self, value: usize) {
        self.0.extend_from_slice(&(value as u64).to_le_bytes());
    }

    fn flag(&mut self, value: bool) {
        self.0.push(u8::from(value));
    }

    fn option(&mut self, value: Option<f64>) {
        self.flag(value.is_some());
        self.real(value.unwrap_or(0.0));
    }

    fn triple(&mut self, value: [f64; 3]) {
        value.into_iter().for_each(|value| self.real(value));
    }
}

/// Takes values off the front.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*first)
    }

    fn take(&mut self, length: usize) -> Option<&[u8]> {
        let (first, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(first)
    }

    fn real(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    fn reals<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.real()?;
        }
        Some(values)
    }

    fn count(&mut self) -> Option<usize> {
        self.array().map(u64::from_le_bytes).and_then(|value| usize::try_from(value).ok())
    }

    fn number(&mut self) -> Option<u32> {
        u32::try_from(self.count()?).ok()
    }

    fn flag(&mut self) -> Option<bool> {
        self.array::<1>().and_then(|[value]| (value <= 1).then_some(value == 1))
    }

    fn option(&mut self) -> Option<Option<f64>> {
        let set = self.flag()?;
        let value = self.real()?;
        Some(set.then_some(value))
    }

    fn triple(&mut self) -> Option<[f64; 3]> {
        Some([self.real()?, self.real()?, self.real()?])
    }

    fn several<T>(&mut self, count: usize, mut read: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        (0..count).map(|_| read(self)).collect()
    }
}
