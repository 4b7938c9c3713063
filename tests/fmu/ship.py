"""The examples of a ship and its mooring as one FMU each: in OSP's libcosim, and as an SSP package that is valid and complete. Both end where FMPy's ship does.

usage: ship.py SHIP.fmu, of examples/spread-moored-ship.json
"""

import importlib.util
import pathlib
import shutil
import subprocess
import sys
import tempfile

from fmpy.ssp.ssd import read_ssd

SEEN = [("ship", "position.x"), ("ship", "position.y"), ("ship", "attitude.yaw")]
SEEN += [("mooring", "ship.force.x"), ("mooring", "ship.force.y"), ("mooring", "ship.moment.z")]

fmu = pathlib.Path(sys.argv[1])
examples = pathlib.Path(__file__).parents[2] / "examples"


def module(path: str):
    """A file of the examples; two of them are called `run`."""
    spec = importlib.util.spec_from_file_location(path.replace("/", "_").removesuffix(".py"), examples / path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


pose, load = module("moored_ship.py").main(str(fmu))
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shutil.copy(examples / "osp/ship/OspSystemStructure.xml", folder)
    shutil.copy(fmu, folder / "mooring.fmu")
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", str(examples / "osp/ship/ship.py"), "-d", name]
    subprocess.run(build, check=True, capture_output=True)
    in_osp = module("osp/run.py").run(folder, SEEN, seconds=900)[-1][1:]

    package = str(folder / "moored-ship.ssp")
    module("ssp/pack.py").pack(package, examples / "ssp/ship", folder / "mooring.fmu", folder / "Ship.fmu")
    system = read_ssd(package, validate=True).system
    assert [component.name for component in system.elements] == ["ship", "mooring"]
    kinds = {(component.name, connector.name): connector.kind for component in system.elements for connector in component.connectors}
    ends = [(connection.endElement, connection.endConnector) for connection in system.connections]
    assert sorted(ends) == sorted(key for key, kind in kinds.items() if kind == "input"), "an input has no connection, or two"
    in_ssp = module("ssp/run.py").run(package, SEEN, end=900.0)[-1][1:]

# After a quarter of an hour the ship is where the mooring holds the wind: pose within 1e-3 of that of FMPy; the loads of an instant are good to the
# tolerance of the tensions, 1e-3 of some 1 MN in each of eight lines, which is 1e-2 of what is left of them.
sizes = [max(map(abs, pose[:2]))] * 2 + [abs(pose[2])] + [max(map(abs, load[:2]))] * 2 + [abs(load[2])]
for who, found in (("OSP", in_osp), ("SSP", in_ssp)):
    errors = [abs(a - b) / size for a, b, size in zip(found, [*pose, *load], sizes)]
    print(f"{who}: pose within {max(errors[:3]):.1e} of FMPy's, load within {max(errors[3:]):.1e}")
    assert max(errors[:3]) < 1e-3 and max(errors[3:]) < 1e-2, (who, found, pose, load)
