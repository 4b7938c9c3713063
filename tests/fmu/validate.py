"""FMPy reads, validates and simulates the FMU; the archive holds what it must."""

import pathlib
import re
import sys
import zipfile
from xml.etree import ElementTree

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
root = ElementTree.fromstring(zipfile.ZipFile(path).read("modelDescription.xml"))
assert root.attrib["version"] == re.search(r'^version = "(.*)"', pathlib.Path("Cargo.toml").read_text(), re.MULTILINE)[1]
page = zipfile.ZipFile(path).read("documentation/index.html").decode()
for variable in description.modelVariables:
    row = f"<code>{variable.name}</code></td><td>{variable.valueReference}</td><td>{variable.causality}</td>"
    assert row in page, f"the page does not name {variable.name}"
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

# Half of every force: gravity (which makes the weight of the 10 m in air), weight in water, EA and bed; the shape stays.
begin = {v.name: float(v.start) for v in description.modelVariables if v.start is not None}
forces = ("gravity", "line.ea", "line.submerged_weight", "seabed.stiffness")
high = {"fairlead.position.z": 10.0}
whole, halved = (
    simulate_fmu(path, stop_time=0.1, output_interval=0.1, start_values=high | values, output=["tension"])["tension"][0]
    for values in ({}, {name: 0.5 * begin[name] for name in forces})
)
# Both statics are good to 1e-6; without gravity the 10 m would make 0.5 %.
assert abs(halved / whole - 0.5) < 1e-5, (whole, halved)

# The choices as Integers are the same values: what is set last counts.
from master import OK, Fmu, Line

line = Line(Fmu(path))
assert line.set_integer({"solver.scheme_index": 2, "input.interpolation": 4}) == OK
assert line.get_integer("solver.scheme", "solver.scheme_index", "input.interpolation_index")[1] == [2, 2, 4]
assert line.set_integer({"solver.scheme": 3}) == OK and line.get_integer("solver.scheme_index")[1] == [3]
