"""FMPy reads, validates and simulates the FMU; the archive holds what it must."""

import sys
import zipfile

import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

path = sys.argv[1]
problems = validate_fmu(path)
assert not problems, problems

with zipfile.ZipFile(path) as archive:
    names = set(archive.namelist())
    assert archive.testzip() is None
for name in (
    "modelDescription.xml",
    "model.png",
    "resources/scene.json",
    "documentation/index.html",
    "documentation/licenses/license.txt",
):
    assert name in names, f"{name} is missing in {names}"

description = read_model_description(path)
simulation = description.coSimulation
assert simulation.modelIdentifier == "moorline" and description.modelName == "moorline"
for capability in (
    "canGetAndSetFMUstate",
    "canSerializeFMUstate",
    "providesDirectionalDerivative",
    "canInterpolateInputs",
    "canHandleVariableCommunicationStepSize",
):
    assert getattr(simulation, capability), capability
units = {unit.name for unit in description.unitDefinitions}
for variable in description.modelVariables:
    assert variable.description, variable.name
    if variable.type == "Real":
        unit = variable.unit or (variable.declaredType and variable.declaredType.unit)
        assert unit in units, f"{variable.name} has no unit"

motion = np.array(
    [(0.0, 0.0, 0.0), (10.0, 1.0, 0.1)],
    dtype=[("time", float), ("fairlead.position.x", float), ("fairlead.velocity.x", float)],
)
motion["fairlead.velocity.x"] = 0.1
result = simulate_fmu(
    path,
    stop_time=10.0,
    output_interval=0.1,
    input=motion,
    start_values={"line.length": 1210.0},
    output=["tension", "force.x", "work"],
)
assert len(result) == 101 and all(np.isfinite(result[name]).all() for name in result.dtype.names)
print(f"tension {result['tension'][0]:.0f} to {result['tension'][-1]:.0f} N")
