//! A mooring in the hands of a program that was written for MoorDyn: its life, its steps, its forces and its states. No C types.
//!
//! A call that fails changes nothing: a step that cannot be done leaves the mooring as it stood before.

use crate::failure::{Failure, INVALID_INPUT, INVALID_INPUT_FILE, INVALID_OUTPUT_FILE, NAN_ERROR, Outcome};
use crate::log::{self, Log};
use crate::own::Water;
use crate::rig::{Held, Line, Rig, Thing};
use moorline::algebra::rotation;
use moorline::fmi::instance::Instance;
use moorline::fmi::variables::{Interface, Kind, MOST_LINES};
use moorline::scene::read;
use moorline::solve::between::Place;
use moorline::solve::simulation::Outputs;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use std::path::Path;

/// The beginning of a state as numbers of eight bytes: the name of the format and its version.
const MAGIC: u64 = u64::from_le_bytes(*b"moorln01");
/// A state is shorter than this [numbers of eight bytes]; more is something else.
const LONGEST_STATE: u64 = 1 << 32;
/// Numbers of a state before positions, velocities and the bytes of the solver.
const HEAD: usize = 4;

/// Pose and motion of a thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Position of its reference point, of a rod of its end A [m].
    pub position: Vector3<f64>,
    /// How it is turned.
    pub turn: Matrix3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Angular velocity [rad/s].
    pub omega: Vector3<f64>,
}

impl Motion {
    fn at_rest(position: Vector3<f64>, turn: Matrix3<f64>) -> Motion {
        Motion { position, turn, velocity: Vector3::zeros(), omega: Vector3::zeros() }
    }

    /// Position and velocity of a place in its axes.
    pub fn place(&self, at: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let arm = self.turn * at;
        [self.position + arm, self.velocity + self.omega.cross(&arm)]
    }
}

/// The mooring.
pub struct System {
    /// What it has to say.
    pub log: Log,
    /// What its file has.
    pub rig: Rig,
    water: Water,
    instance: Instance,
    /// Value references of the motion of each body of the scene: position, attitude, velocity, angular velocity.
    inputs: Vec<[u32; 12]>,
    /// Where the calling program has everything at the time reached, and how fast.
    positions: Vec<f64>,
    velocities: Vec<f64>,
    /// Time reached [s].
    clock: f64,
    ready: bool,
    /// The state before a step.
    before: usize,
    /// Nodes of lines as they were asked for since the last step.
    nodes: Vec<Option<Vec<Place>>>,
    told_of_time: bool,
}

/// Three numbers of many.
fn triple(values: &[f64], from: usize) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| values.get(from + axis).copied().unwrap_or(0.0))
}

impl System {
    /// The mooring of a MoorDyn file.
    pub fn new(path: &str) -> Outcome<System> {
        let mut loaded = read::load(Path::new(path), &[])?;
        let Some(deck) = loaded.moordyn.take() else {
            return Err(Failure::new(INVALID_INPUT, format!("{path}: no MoorDyn file; a scene goes through `moorline convert`")));
        };
        if loaded.scene.lines.len() > MOST_LINES {
            let reason = format!("{path}: {} lines; {MOST_LINES} is the limit", loaded.scene.lines.len());
            return Err(Failure::new(INVALID_INPUT, reason));
        }
        if loaded.scene.lines.len() != deck.lines.len() {
            let reason = "free rods of no length, which make one line of two, are not there for calling programs";
            return Err(Failure::new(INVALID_INPUT, format!("{path}: {reason}")));
        }
        let rig = Rig::new(&loaded, &deck)?;
        let interface = Interface::new(&rig.scene);
        let named: BTreeMap<&str, u32> =
            interface.variables().iter().map(|variable| (variable.name.as_str(), variable.reference)).collect();
        let inputs = (0..rig.scene.bodies.len()).map(|body| {
            let prefix = interface.body_prefix(body);
            let stems = ["position.x", "position.y", "position.z", "attitude.roll", "attitude.pitch", "attitude.yaw"];
            let rates = ["velocity.x", "velocity.y", "velocity.z"];
            let turns = ["angular_velocity.x", "angular_velocity.y", "angular_velocity.z"];
            let mut all = stems.into_iter().chain(rates).chain(turns);
            std::array::from_fn(|_| {
                let name = format!("{prefix}{}", all.next().unwrap_or_default());
                named.get(name.as_str()).copied().unwrap_or(u32::MAX)
            })
        });
        let mut log = Log::default();
        loaded.warnings.iter().chain(&rig.warnings).for_each(|warning| log.tell(log::WARNING, warning));
        let mut system = System {
            log,
            water: Water::new(&rig.scene.environment),
            instance: Instance::of_scene(&rig.scene, true),
            inputs: inputs.collect(),
            positions: Vec::new(),
            velocities: vec![0.0; rig.freedoms],
            clock: 0.0,
            ready: false,
            before: 0,
            nodes: vec![None; rig.lines.len()],
            told_of_time: false,
            rig,
        };
        system.positions = system.first_positions();
        Ok(system)
    }

    /// Where the file has what is coupled.
    fn first_positions(&self) -> Vec<f64> {
        let mut positions = vec![0.0; self.rig.freedoms];
        for (thing, first, _) in self.rig.driven() {
            positions[first..first + 3].copy_from_slice(thing.position.as_slice());
            if thing.turns {
                positions[first + 3..first + 6].copy_from_slice(rotation::angles_xyz(&thing.turn).as_slice());
            }
        }
        positions
    }

    /// Puts it in equilibrium at time zero, with everything coupled where and as fast as it is said. Where the file asks for none, or the program,
    /// only the lines are: what is free begins at rest where the file has it.
    pub fn initialise(&mut self, positions: &[f64], velocities: &[f64], settled: bool) -> Outcome {
        self.check_numbers(positions, velocities)?;
        self.ready = false;
        self.nodes.fill(None);
        self.instance.reset();
        self.instance.let_go(!(settled && self.rig.settled));
        self.instance.setup_experiment(None, 0.0, None)?;
        self.instance.enter_initialization()?;
        self.say(positions, velocities)?;
        let settled = self.instance.exit_initialization();
        self.pass_messages();
        settled?;
        self.positions = positions.to_vec();
        self.velocities = velocities.to_vec();
        (self.clock, self.ready, self.told_of_time) = (0.0, true, false);
        self.before = self.instance.get_state(0)?;
        Ok(())
    }

    fn check_numbers(&self, positions: &[f64], velocities: &[f64]) -> Outcome {
        for (what, values) in [("position", positions), ("velocity", velocities)] {
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                let reason = format!("component {index} of the {what} is {}, which is no number", values[index]);
                return Err(Failure::new(NAN_ERROR, reason));
            }
        }
        Ok(())
    }

    /// Tells the solver where and how fast everything coupled is.
    fn say(&mut self, positions: &[f64], velocities: &[f64]) -> Outcome {
        for (thing, first, body) in self.rig.driven() {
            let Some(body) = body else { continue };
            let mut values = [0.0; 12];
            values[..3].copy_from_slice(triple(positions, first).as_slice());
            values[6..9].copy_from_slice(triple(velocities, first).as_slice());
            if thing.turns {
                let turn = rotation::of_angles_xyz(&triple(positions, first + 3));
                values[3..6].copy_from_slice(rotation::angles(&turn).as_slice());
                values[9..].copy_from_slice(triple(velocities, first + 3).as_slice());
            }
            self.instance.set(Kind::Real, &self.inputs[body], &values)?;
        }
        Ok(())
    }

    fn pass_messages(&mut self) {
        for message in self.instance.take_messages() {
            let level = if message.category == moorline::fmi::instance::WARNING { log::WARNING } else { log::MESSAGE };
            self.log.tell(level, &message.text);
        }
    }

    /// Whether it has been initialised.
    pub fn check_ready(&self) -> Outcome {
        if self.ready { Ok(()) } else { Err(Failure::invalid("allowed after MoorDyn_Init or MoorDyn_Init_NoIC, not before")) }
    }

    /// Goes on by a step [s] from where and as fast as everything coupled is said to be now; the time reached [s].
    pub fn step(&mut self, positions: &[f64], velocities: &[f64], time: f64, step: f64) -> Outcome<f64> {
        self.check_ready()?;
        self.check_numbers(positions, velocities)?;
        if !step.is_finite() {
            return Err(Failure::new(NAN_ERROR, format!("the step is {step}, which is no number")));
        }
        if step <= 0.0 {
            return Ok(self.clock);
        }
        if !((time - self.clock).abs() <= 1.0e-3 * step.max(1.0e-3)) && !self.told_of_time {
            self.told_of_time = true;
            let text = format!("the program steps from t = {time} s, the mooring from {} s: its own time counts", self.clock);
            self.log.tell(log::WARNING, &text);
        }
        self.instance.get_state(self.before)?;
        let done = self.say(positions, velocities).and_then(|()| Ok(self.instance.do_step(self.clock, step)?));
        self.pass_messages();
        if let Err(failure) = done {
            self.instance.set_state(self.before)?;
            let reason =
                format!("t = {} s, step {step} s: {}; the mooring stands as before the step", self.clock, failure.reason);
            return Err(Failure { reason, ..failure });
        }
        self.clock = self.instance.last_successful_time()?;
        self.positions = self.moved(positions, velocities, step);
        self.velocities = velocities.to_vec();
        self.nodes.fill(None);
        Ok(self.clock)
    }

    /// Where everything coupled is after a step at a constant velocity and angular velocity.
    fn moved(&self, positions: &[f64], velocities: &[f64], step: f64) -> Vec<f64> {
        let mut moved = positions.to_vec();
        for (thing, first, _) in self.rig.driven() {
            for axis in first..first + 3 {
                moved[axis] += velocities[axis] * step;
            }
            if thing.turns {
                let omega = triple(velocities, first + 3);
                if omega != Vector3::zeros() {
                    let turn = rotation::exp(&(omega * step)) * rotation::of_angles_xyz(&triple(positions, first + 3));
                    moved[first + 3..first + 6].copy_from_slice(rotation::angles_xyz(&turn).as_slice());
                }
            }
        }
        moved
    }

    /// Force on everything coupled, with moments about the reference points of bodies and ends A of rods [N, N·m].
    pub fn forces(&self) -> Outcome<Vec<f64>> {
        self.check_ready()?;
        let mut forces = vec![0.0; self.rig.freedoms];
        for (thing, first, _) in self.rig.driven() {
            let [force, moment] = self.load_on(thing);
            forces[first..first + 3].copy_from_slice(force.as_slice());
            if thing.turns {
                forces[first + 3..first + 6].copy_from_slice(moment.as_slice());
            }
        }
        Ok(forces)
    }

    /// How a thing stands and moves; before initialisation as the file has it.
    pub fn motion(&self, thing: &Thing) -> Motion {
        match thing.held {
            Held::Fixed => Motion::at_rest(thing.position, thing.turn),
            Held::Coupled(first, _) => {
                let part = |values: &[f64]| if thing.turns { triple(values, first + 3) } else { Vector3::zeros() };
                Motion {
                    position: triple(&self.positions, first),
                    turn: rotation::of_angles_xyz(&part(&self.positions)),
                    velocity: triple(&self.velocities, first),
                    omega: part(&self.velocities),
                }
            }
            Held::OnBody(body) => {
                let body = self.motion(&self.rig.bodies[body]);
                let [position, velocity] = body.place(&thing.position);
                Motion { position, velocity, ..body }
            }
            Held::Free(of) => {
                of.and_then(|number| self.free(thing, number)).unwrap_or(Motion::at_rest(thing.position, thing.turn))
            }
        }
    }

    fn free(&self, thing: &Thing, number: usize) -> Option<Motion> {
        if !self.ready {
            return None;
        }
        if thing.turns {
            let reached = self.instance.reached(number)?;
            let turn = rotation::of_angles(&reached.angles);
            return Some(Motion { position: reached.position, turn, velocity: reached.velocity, omega: reached.omega });
        }
        let [position, velocity] = self.instance.point(number)?;
        Some(Motion { velocity, ..Motion::at_rest(position, Matrix3::identity()) })
    }

    /// Outputs of a line.
    pub fn outputs(&self, line: usize) -> Outcome<&Outputs> {
        self.check_ready()?;
        self.instance.outputs(line).ok_or_else(|| Failure::invalid("the line has no state"))
    }

    /// Force on a thing, and moment about its reference point: of the lines on it, and its own [N, N·m].
    pub fn load_on(&self, thing: &Thing) -> [Vector3<f64>; 2] {
        let motion = self.motion(thing);
        let [mut force, mut moment] = thing.own.load(&motion.position, &motion.turn, &motion.velocity, &self.water);
        for (line, b) in &thing.ends {
            let Ok(of) = self.outputs(*line) else { continue };
            let (place, pull, turn) =
                if *b { (of.fairlead, of.force, of.moment) } else { (of.anchor, of.anchor_force, of.anchor_moment) };
            force += pull;
            moment += (place - motion.position).cross(&pull) + turn;
        }
        [force, moment]
    }

    /// The node of a line, counted from end A.
    pub fn node(&mut self, line: usize, node: usize) -> Outcome<Place> {
        self.check_ready()?;
        let Line { segments, length, .. } = self.rig.lines[line];
        if node > segments {
            return Err(Failure::invalid(format!("node {node} of a line with nodes 0 to {segments}")));
        }
        if self.nodes[line].is_none() {
            let at: Vec<f64> = (0..=segments).map(|i| length * (segments - i) as f64 / segments as f64).collect();
            self.nodes[line] = self.instance.places(line, &at);
        }
        let places = self.nodes[line].as_ref();
        places.and_then(|places| places.get(node)).copied().ok_or_else(|| Failure::invalid("the line has no state"))
    }

    /// Mass of the lump that MoorDyn has at a node, with the water that moves with it [kg].
    pub fn node_mass(&mut self, line: usize, node: usize) -> Outcome<Matrix3<f64>> {
        let place = self.node(line, node)?;
        let Line { mass, area, added_mass: [across, along], .. } = self.rig.lines[line];
        let share = self.share(line, node);
        let water = if place.position.z < 0.0 { self.water.density() * area * share } else { 0.0 };
        let q = place.tangent * place.tangent.transpose();
        Ok(Matrix3::identity() * (mass * share) + (Matrix3::identity() - q) * (across * water) + q * (along * water))
    }

    /// Weight and buoyancy of the lump that MoorDyn has at a node [N].
    pub fn node_weight(&mut self, line: usize, node: usize) -> Outcome<Vector3<f64>> {
        let place = self.node(line, node)?;
        let Line { mass, area, .. } = self.rig.lines[line];
        let displaced = if place.position.z < 0.0 { self.water.density() * area } else { 0.0 };
        Ok(Vector3::new(0.0, 0.0, self.water.gravity() * (displaced - mass) * self.share(line, node)))
    }

    /// Net force on a node: of an end that on what holds it, of another what accelerates its lump [N].
    pub fn node_force(&mut self, line: usize, node: usize) -> Outcome<Vector3<f64>> {
        let place = self.node(line, node)?;
        match node {
            0 => Ok(self.outputs(line)?.anchor_force),
            last if last == self.rig.lines[line].segments => Ok(self.outputs(line)?.force),
            _ => Ok(self.node_mass(line, node)? * place.acceleration),
        }
    }

    /// Length of the line that counts for a node [m].
    fn share(&self, line: usize, node: usize) -> f64 {
        let Line { segments, length, .. } = self.rig.lines[line];
        let whole = length / segments as f64;
        if node == 0 || node == segments { 0.5 * whole } else { whole }
    }

    /// Velocity of the water at a place [m/s], without lines in it.
    pub fn water_velocity(&self, z: f64) -> Vector3<f64> {
        self.water.velocity(z)
    }

    /// The whole state.
    pub fn state(&mut self) -> Outcome<Vec<u64>> {
        self.check_ready()?;
        self.instance.get_state(self.before)?;
        let bytes = self.instance.serialized(self.before)?;
        let mut state = vec![MAGIC, 0, bytes.len() as u64, self.clock.to_bits()];
        state.extend(self.positions.iter().chain(&self.velocities).map(|value| value.to_bits()));
        state.extend(bytes.chunks(8).map(|chunk| {
            let mut eight = [0; 8];
            eight[..chunk.len()].copy_from_slice(chunk);
            u64::from_le_bytes(eight)
        }));
        state[1] = state.len() as u64;
        Ok(state)
    }

    /// How many numbers a state has that begins with these two; none: it is no state.
    pub fn length_of_state(head: [u64; 2]) -> Option<usize> {
        let [magic, length] = head;
        (magic == MAGIC && length < LONGEST_STATE).then_some(length as usize).filter(|length| *length >= HEAD)
    }

    /// Goes back to a state.
    pub fn restore(&mut self, state: &[u64]) -> Outcome {
        let refuse = || Failure::new(INVALID_INPUT, "this is no state of this mooring");
        let head = [state.first(), state.get(1)].map(|word| word.copied().unwrap_or(0));
        if System::length_of_state(head) != Some(state.len()) {
            return Err(refuse());
        }
        let start = HEAD + 2 * self.rig.freedoms;
        let (length, words) = (state[2] as usize, state.get(start..).ok_or_else(refuse)?);
        if length.div_ceil(8) != words.len() {
            return Err(refuse());
        }
        let numbers: Vec<f64> = state[HEAD..start].iter().map(|word| f64::from_bits(*word)).collect();
        let clock = f64::from_bits(state[3]);
        if !clock.is_finite() || numbers.iter().any(|number| !number.is_finite()) {
            return Err(refuse());
        }
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take(length).collect();
        let handle = self.instance.deserialize(&bytes)?;
        let done = self.instance.set_state(handle);
        self.instance.free_state(handle)?;
        done?;
        if self.before == 0 {
            self.before = self.instance.get_state(0)?;
        }
        let (positions, velocities) = numbers.split_at(self.rig.freedoms);
        (self.positions, self.velocities) = (positions.to_vec(), velocities.to_vec());
        (self.clock, self.ready) = (clock, true);
        self.nodes.fill(None);
        Ok(())
    }

    /// Writes the state to a file.
    pub fn save(&mut self, path: &str) -> Outcome {
        let bytes: Vec<u8> = self.state()?.iter().flat_map(|word| word.to_le_bytes()).collect();
        let written = std::fs::write(path, bytes);
        written.map_err(|error| Failure::new(INVALID_OUTPUT_FILE, format!("{path}: cannot be written: {error}")))
    }

    /// Goes back to the state of a file.
    pub fn load(&mut self, path: &str) -> Outcome {
        let bytes = std::fs::read(path);
        let bytes = bytes.map_err(|error| Failure::new(INVALID_INPUT_FILE, format!("{path}: cannot be read: {error}")))?;
        let (words, rest) = bytes.as_chunks::<8>();
        if !rest.is_empty() {
            return Err(Failure::new(INVALID_INPUT, format!("{path}: no state of a mooring")));
        }
        let state: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        self.restore(&state).map_err(|failure| Failure { reason: format!("{path}: {}", failure.reason), ..failure })
    }

    /// After a fault of the program itself: nothing goes on until it is initialised or goes back to a state.
    pub fn fail(&mut self) {
        self.instance.fail();
        self.ready = false;
    }
}
