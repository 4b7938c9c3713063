//! A mooring step by step: the FMU of the scene without the FMU, in this process.

use crate::failure::{exception, raised, refused};
use crate::results::shaped;
use crate::source::Source;
use moorline::fmi::instance::Instance;
use moorline::fmi::pack::self_contained;
use moorline::fmi::refusal::Refusal;
use moorline::fmi::variables::{Interface, Kind, MOST_LINES, Variable};
use moorline::scene::read::Loaded;
use moorline::scene::types::{Motion, Scene};
use moorline::solve::mooring::Mooring;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The mooring of a scene in the hands of a program that moves its bodies and fairleads.
#[pyclass(frozen)]
pub struct Core {
    scene: Scene,
    references: BTreeMap<String, u32>,
    instance: Mutex<Instance>,
}

fn told(py: Python<'_>, refusal: &Refusal) -> PyErr {
    match refusal {
        Refusal::Solver(error) => raised(py, error),
        other => match exception(py, "Error", &other.to_string()) {
            Ok(value) => PyErr::from_value(value.into_bound(py)),
            Err(error) => error,
        },
    }
}

impl Core {
    fn instance(&self) -> MutexGuard<'_, Instance> {
        self.instance.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn numbers(&self, py: Python<'_>, names: &[String]) -> PyResult<Vec<u32>> {
        let number = |name: &String| {
            let known: Vec<String> = self.references.keys().cloned().collect();
            let unknown =
                || refused(py, &format!("{name} is no quantity of this mooring{}", moorline::error::among(name, &known)));
            self.references.get(name).copied().ok_or_else(unknown)
        };
        names.iter().map(number).collect()
    }

    fn values(&self, py: Python<'_>, names: &[String]) -> PyResult<Vec<f64>> {
        let references = self.numbers(py, names)?;
        let mut values = vec![0.0; references.len()];
        py.detach(|| self.instance().get(Kind::Real, &references, &mut values)).map_err(|refusal| told(py, &refusal))?;
        Ok(values)
    }
}

#[pymethods]
impl Core {
    #[new]
    fn new(py: Python<'_>, source: &Source) -> PyResult<Core> {
        let loaded = source.load().map_err(|error| raised(py, &error))?;
        let lines = &loaded.scene.lines;
        if lines.len() > MOST_LINES {
            return Err(refused(
                py,
                &format!("a mooring that goes step by step has at most {MOST_LINES} lines, this one {}", lines.len()),
            ));
        }
        if let Some(index) = lines.iter().position(|line| !line.is_pinned(0.0) && line.fairlead_on.is_none()) {
            let message = format!(
                "lines[{index}].constraints: a fairlead that is moved from outside must be pinned; take the constraint away"
            );
            return Err(refused(py, &message));
        }
        let scene = self_contained(&loaded.scene);
        let interface = Interface::new(&scene);
        let real = interface.variables().iter().filter(|variable| variable.kind == Kind::Real);
        let references = real.map(|variable: &Variable| (variable.name.clone(), variable.reference)).collect();
        Ok(Core { instance: Mutex::new(Instance::of_scene(&scene, false)), scene, references })
    }

    /// Bodies and lines: name, what stands in front of the names of their quantities, and what they are: `driven`, `free`, `fairlead` (a line
    /// whose fairlead is moved from outside) or `line`.
    fn parts(&self) -> Vec<(String, String, &'static str)> {
        let interface = Interface::new(&self.scene);
        let bodies = self.scene.bodies.iter().enumerate().map(|(index, body)| {
            (body.name.clone(), interface.body_prefix(index), if body.is_free() { "free" } else { "driven" })
        });
        let lines = self.scene.lines.iter().enumerate().map(|(index, line)| {
            (line.name.clone(), interface.prefix(index), if line.fairlead_on.is_none() { "fairlead" } else { "line" })
        });
        bodies.chain(lines).collect()
    }

    /// All names.
    fn names(&self) -> Vec<String> {
        self.references.keys().cloned().collect()
    }

    /// Puts it in equilibrium at a time [s] with some inputs set.
    fn settle(&self, py: Python<'_>, names: Vec<String>, values: Vec<f64>, time: f64) -> PyResult<()> {
        let references = self.numbers(py, &names)?;
        let settled = py.detach(|| {
            let mut instance = self.instance();
            instance.reset();
            instance.setup_experiment(None, time, None)?;
            instance.enter_initialization()?;
            instance.set(Kind::Real, &references, &values)?;
            instance.exit_initialization()
        });
        settled.map_err(|refusal| told(py, &refusal))
    }

    /// Sets inputs.
    fn set(&self, py: Python<'_>, names: Vec<String>, values: Vec<f64>) -> PyResult<()> {
        let references = self.numbers(py, &names)?;
        self.instance().set(Kind::Real, &references, &values).map_err(|refusal| told(py, &refusal))
    }

    /// Reads values.
    fn get<'py>(&self, py: Python<'py>, names: Vec<String>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let values = self.values(py, &names)?;
        shaped(py, values, &[names.len()])
    }

    /// Goes on by a step [s]; what there is to say of it.
    fn step(&self, py: Python<'_>, step: f64) -> PyResult<Vec<String>> {
        let done = py.detach(|| {
            let mut instance = self.instance();
            let now = instance.last_successful_time()?;
            instance.do_step(now, step)?;
            Ok(instance.take_messages().into_iter().map(|message| message.text).collect())
        });
        done.map_err(|refusal| told(py, &refusal))
    }

    /// The time reached [s].
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.instance().last_successful_time().map_err(|refusal| told(py, &refusal))
    }

    /// The state as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut instance = self.instance();
        let saved = instance.get_state(0).and_then(|handle| {
            let bytes = instance.serialized(handle);
            instance.free_state(handle)?;
            bytes
        });
        saved.map(|bytes| PyBytes::new(py, &bytes)).map_err(|refusal| told(py, &refusal))
    }

    /// Goes back to a state.
    fn restore(&self, py: Python<'_>, bytes: &[u8]) -> PyResult<()> {
        let restored = py.detach(|| {
            let mut instance = self.instance();
            let handle = instance.deserialize(bytes)?;
            let done = instance.set_state(handle);
            instance.free_state(handle)?;
            done
        });
        restored.map_err(|refusal| told(py, &refusal))
    }

    /// Change of outputs at the end of a step as long as the last one per change of inputs at its start, the others held: (outputs, inputs).
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        outputs: Vec<String>,
        inputs: Vec<String>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (unknowns, knowns) = (self.numbers(py, &outputs)?, self.numbers(py, &inputs)?);
        let columns = py.detach(|| {
            let mut instance = self.instance();
            let column = |known: &u32| instance.directional_derivative(&unknowns, &[*known], &[1.0]);
            knowns.iter().map(column).collect::<Result<Vec<Vec<f64>>, Refusal>>()
        });
        let columns = columns.map_err(|refusal| told(py, &refusal))?;
        let rows = (0..unknowns.len()).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
        shaped(py, rows, &[unknowns.len(), knowns.len()])
    }

    /// Stiffness of the mooring against a body that is driven, with everything driven where it is now [N/m, N, N·m].
    fn stiffness<'py>(&self, py: Python<'py>, body: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let driven: Vec<String> = self.scene.bodies.iter().filter(|body| !body.is_free()).map(|body| body.name.clone()).collect();
        if !driven.iter().any(|name| name == body) {
            let message = format!("\"{body}\" is no body that is driven{}", moorline::error::among(body, &driven));
            return Err(refused(py, &message));
        }
        let interface = Interface::new(&self.scene);
        let mut scene = self.scene.clone();
        let triple = |prefix: &str, axes: [&str; 3]| -> PyResult<[f64; 3]> {
            let values = self.values(py, &axes.map(|axis| format!("{prefix}{axis}")))?;
            Ok([values[0], values[1], values[2]])
        };
        for index in (0..self.scene.bodies.len()).filter(|index| !self.scene.bodies[*index].is_free()) {
            let position = triple(&format!("{}position.", interface.body_prefix(index)), ["x", "y", "z"])?;
            let angles = triple(&format!("{}attitude.", interface.body_prefix(index)), ["roll", "pitch", "yaw"])?;
            scene = scene.with_body_held(index, position, angles.map(f64::to_degrees));
        }
        for index in (0..self.scene.lines.len()).filter(|index| self.scene.lines[*index].fairlead_on.is_none()) {
            scene.lines[index].fairlead = triple(&format!("{}fairlead.position.", interface.prefix(index)), ["x", "y", "z"])?;
        }
        scene.motion = Motion::Fixed;
        let (index, start) = (self.scene.body(body).unwrap_or_default(), scene.run.start);
        let found = py.detach(|| {
            let mut mooring = Mooring::new(&Loaded::of_scene(scene))?;
            mooring.equilibrium(start)?;
            Ok(mooring.stiffness(index, start))
        });
        let matrix = found.map_err(|error| raised(py, &error))?;
        let matrix = matrix.ok_or_else(|| refused(py, "a line has no stiffness of its own there: it is slack and lies loose"))?;
        shaped(py, matrix.concat(), &[6, 6])
    }
}
