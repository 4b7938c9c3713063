//! moorline writes the types of FMI 2.0 and its model description by hand; here the `fmi` crate's bindings, generated from the standard's
//! headers, and its schema say whether they are right.
//!
//! Why moorline does not use `fmi-schema` itself: in 0.8.0 it knows of a Real no min, max, unit, nominal or quantity, of an Integer no limits
//! and of an Enumeration nothing at all. Reading and writing would lose them.

use fmi::fmi2::binding as standard;
use fmi::fmi2::schema::{Causality, Fmi2ModelDescription, ScalarVariableElement};
use moorline::fmi::fmi2 as own;
use moorline::fmi::variables::{DEFAULT_STEP, DEFINITIONS, Kind, MODEL_DESCRIPTION, Meaning};
use std::ffi::CStr;
use std::mem::{align_of, offset_of, size_of};
use std::str::FromStr;

#[test]
fn types_have_the_layout_of_the_standard() {
    assert_eq!(size_of::<own::CallbackFunctions>(), size_of::<standard::fmi2CallbackFunctions>());
    assert_eq!(align_of::<own::CallbackFunctions>(), align_of::<standard::fmi2CallbackFunctions>());
    let offsets = [
        (offset_of!(own::CallbackFunctions, logger), offset_of!(standard::fmi2CallbackFunctions, logger)),
        (offset_of!(own::CallbackFunctions, allocate_memory), offset_of!(standard::fmi2CallbackFunctions, allocateMemory)),
        (offset_of!(own::CallbackFunctions, free_memory), offset_of!(standard::fmi2CallbackFunctions, freeMemory)),
        (offset_of!(own::CallbackFunctions, step_finished), offset_of!(standard::fmi2CallbackFunctions, stepFinished)),
        (
            offset_of!(own::CallbackFunctions, component_environment),
            offset_of!(standard::fmi2CallbackFunctions, componentEnvironment),
        ),
    ];
    assert!(offsets.iter().all(|(ours, theirs)| ours == theirs), "{offsets:?}");
    let sizes = [
        (size_of::<own::Handle>(), size_of::<standard::fmi2Component>()),
        (size_of::<own::StateHandle>(), size_of::<standard::fmi2FMUstate>()),
        (size_of::<own::ValueReference>(), size_of::<standard::fmi2ValueReference>()),
        (size_of::<own::Boolean>(), size_of::<standard::fmi2Boolean>()),
        (size_of::<own::Text>(), size_of::<standard::fmi2String>()),
        (size_of::<own::Status>(), size_of::<standard::fmi2Status>()),
        (size_of::<f64>(), size_of::<standard::fmi2Real>()),
        (size_of::<std::ffi::c_int>(), size_of::<standard::fmi2Integer>()),
        (size_of::<u8>(), size_of::<standard::fmi2Byte>()),
    ];
    assert!(sizes.iter().all(|(ours, theirs)| ours == theirs), "{sizes:?}");
}

#[test]
fn constants_are_those_of_the_standard() {
    // SAFETY: both functions return strings that live as long as the program.
    let (platform, version) = unsafe { (CStr::from_ptr(own::fmi2GetTypesPlatform()), CStr::from_ptr(own::fmi2GetVersion())) };
    assert_eq!(platform.to_bytes_with_nul(), standard::fmi2TypesPlatform);
    assert_eq!(version.to_bytes_with_nul(), standard::fmi2Version);
    let nobody = std::ptr::null_mut();
    // SAFETY: NULL is a component that is always refused.
    assert_eq!(unsafe { own::fmi2Terminate(nobody) } as standard::fmi2Status, standard::fmi2Status_fmi2Error);
}

#[test]
fn the_schema_reads_the_model_description() {
    let description = Fmi2ModelDescription::from_str(MODEL_DESCRIPTION).expect("fmi-schema cannot read modelDescription.xml");
    assert_eq!((description.fmi_version.as_str(), description.model_name.as_str()), ("2.0", "moorline"));
    let simulation = description.co_simulation.expect("no CoSimulation");
    assert_eq!(simulation.model_identifier, "moorline");
    let capabilities = [
        simulation.can_handle_variable_communication_step_size,
        simulation.can_interpolate_inputs,
        simulation.can_get_and_set_fmu_state,
        simulation.can_serialize_fmu_state,
        simulation.provides_directional_derivative,
        simulation.can_not_use_memory_management_functions,
    ];
    assert_eq!(capabilities, [Some(true); 6]);
    assert_eq!(simulation.max_output_derivative_order, Some(1));
    assert_eq!(description.default_experiment.and_then(|experiment| experiment.step_size), Some(DEFAULT_STEP));

    let variables = &description.model_variables.variables;
    assert_eq!(variables.len(), DEFINITIONS.len());
    for (variable, definition) in variables.iter().zip(DEFINITIONS) {
        assert_eq!((variable.name.as_str(), variable.value_reference), (definition.name, definition.reference));
        let kind = match variable.elem {
            ScalarVariableElement::Real(_) => Kind::Real,
            _ => Kind::Integer,
        };
        assert_eq!(kind, definition.kind, "{}", variable.name);
        let causality = match definition.meaning {
            Meaning::Input(_) | Meaning::BodyInput(_) => Causality::Input,
            Meaning::Output(_) | Meaning::BodyOutput(_) => Causality::Output,
            Meaning::Local(_) => Causality::Local,
            Meaning::Parameter(_) | Meaning::Place(_) | Meaning::Choice(_) => Causality::Parameter,
        };
        assert_eq!(variable.causality, causality, "{}", variable.name);
        let start = match &variable.elem {
            ScalarVariableElement::Real(real) => real.start,
            ScalarVariableElement::Integer(integer) => integer.start.map(f64::from),
            _ => Some(definition.start),
        };
        assert_eq!(start.unwrap_or(0.0), definition.start, "{}", variable.name);
    }
    let outputs = variables.iter().enumerate().filter(|(_, variable)| variable.causality == Causality::Output);
    let listed: Vec<usize> =
        description.model_structure.outputs.unknowns.iter().map(|unknown| unknown.index as usize - 1).collect();
    assert_eq!(listed, outputs.map(|(index, _)| index).collect::<Vec<_>>());
}
