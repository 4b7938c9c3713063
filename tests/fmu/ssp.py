"""The example for SSP: valid against the schemas of SSP 1.0 (FMPy reads it), every connector a variable of its FMU, and it runs."""

import pathlib
import subprocess
import sys
import tempfile
import zipfile

from fmpy import read_model_description
from fmpy.ssp.ssd import read_ssd

fmu = pathlib.Path(sys.argv[1])
examples = pathlib.Path(__file__).parents[2] / "examples"
sys.path.insert(0, str(examples / "ssp"))

from pack import pack
from run import run

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", str(examples / "osp/vessel.py"), "-d", name]
    subprocess.run(build, check=True, capture_output=True)
    package = str(folder / "vessel.ssp")
    pack(package, examples / "ssp", fmu, folder / "Vessel.fmu")
    system = read_ssd(package, validate=True).system
    with zipfile.ZipFile(package) as archive:
        archive.extractall(folder)
    assert [component.name for component in system.elements] == ["vessel", "bow line", "stern line"]
    connectors = {}
    for component in system.elements:
        variables = {v.name: v for v in read_model_description(str(folder / component.source)).modelVariables}
        for connector in component.connectors:
            assert variables[connector.name].causality == connector.kind, f"{component.name}: {connector.name}"
            connectors[component.name, connector.name] = connector.kind
        for parameter in (p for b in component.parameterBindings for values in b.parameterValues for p in values.parameters):
            assert parameter.name in variables, parameter.name
    ends = set()
    for connection in system.connections:
        assert connectors[connection.startElement, connection.startConnector] == "output"
        assert connectors[connection.endElement, connection.endConnector] == "input"
        ends.add((connection.endElement, connection.endConnector))
    inputs = {key for key, kind in connectors.items() if kind == "input"}
    assert ends == inputs and len(system.connections) == len(inputs), "an input has no connection, or two"
    rows = run(package, [("vessel", "bow.position.x"), ("bow line", "tension"), ("stern line", "tension")], end=60.0)

assert len(rows) == 6
for time, place, bow, stern in rows:
    surge = place - 50.0
    assert abs(surge) < 1.0, f"t = {time}: the vessel surges by {surge} m"
    assert 1.0e6 < bow < 1.6e6 and 1.0e6 < stern < 1.6e6, f"t = {time}: tensions {bow}, {stern} N"
print(rows[-1])
