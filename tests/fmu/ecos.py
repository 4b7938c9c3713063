"""A vessel on two lines in Ecos, put together by code and read from the SSP package: both as FMPy runs that package.

Needs ecospy (PyPI; it finds nothing to load without Debian's libtbb12): .ci/fmu installs both.
"""

import pathlib
import subprocess
import sys
import tempfile

from ecospy import EcosSimulation, EcosSimulationStructure

fmu = pathlib.Path(sys.argv[1]).resolve()
examples = pathlib.Path(__file__).parents[2] / "examples"
sys.path.insert(0, str(examples / "ssp"))

from pack import pack
from run import run

STEP, SECONDS, REPORT = 0.1, 60, 10
# The name of the parameter sets in examples/ssp/resources.
SET = "initialValues"
AUTO, HOLD_VELOCITY = 1, 3
SEEN = [("vessel", "bow.position.x"), ("bow line", "tension"), ("stern line", "tension")]


def by_code(folder: pathlib.Path, interpolation: int) -> EcosSimulationStructure:
    """The vessel and its lines; a choice is set as an Integer, since Ecos sets no enumerations."""
    structure = EcosSimulationStructure()
    structure.add_model("vessel", folder / "Vessel.fmu")
    values = {}
    for end, sign in (("bow", 1.0), ("stern", -1.0)):
        structure.add_model(f"{end} line", fmu)
        for letter in "xyz":
            for quantity in ("position", "velocity"):
                structure.make_real_connection(f"vessel::{end}.{quantity}.{letter}", f"{end} line::fairlead.{quantity}.{letter}")
            structure.make_real_connection(f"{end} line::force.{letter}", f"vessel::{end}.force.{letter}")
        values[f"{end} line::fairlead.position.x"] = sign * 50.0
        values[f"{end} line::anchor.position.x"] = sign * 1233.97
        values[f"{end} line::input.interpolation_index"] = interpolation
    structure.add_parameter_set(SET, values)
    return structure


def rows(simulation: EcosSimulation, interpolation: int) -> list[list[float]]:
    """Time [s] and what is seen, every ten seconds."""
    simulation.init(parameter_set=SET)
    found = []
    for time in range(REPORT, SECONDS + REPORT, REPORT):
        simulation.step(round(REPORT / STEP))
        found.append([float(time), *(simulation.get_real(f"{model}::{name}") for model, name in SEEN)])
    assert abs(simulation.get_time() - SECONDS) < 1e-6
    for end in ("bow", "stern"):
        assert simulation.get_integer(f"{end} line::input.interpolation_index") == interpolation
    simulation.terminate()
    return found


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", str(examples / "osp/vessel.py"), "-d", name]
    subprocess.run(build, check=True, capture_output=True)
    package = folder / "vessel.ssp"
    pack(str(package), examples / "ssp", fmu, folder / "Vessel.fmu")
    expected = run(str(package), SEEN, end=SECONDS)
    with by_code(folder, AUTO) as structure, EcosSimulation(STEP, structure=structure) as simulation:
        alike = {"by code": rows(simulation, AUTO)}
    with EcosSimulation(STEP, ssp_path=str(package)) as simulation:
        alike["from SSP"] = rows(simulation, AUTO)
    with by_code(folder, HOLD_VELOCITY) as structure, EcosSimulation(STEP, structure=structure) as simulation:
        otherwise = rows(simulation, HOLD_VELOCITY)

# The same master in other words: the same numbers, but for the rounding of its clock.
for way, found in alike.items():
    for one, other in zip(found, expected, strict=True):
        assert all(abs(a - b) < 1e-7 * abs(b) for a, b in zip(one, other)), f"{way}: {one}, in FMPy {other}"
# An Integer that arrives makes a difference, of no more than the worse recipe may.
differences = [abs(a - b) / b for one, other in zip(otherwise, expected, strict=True) for a, b in zip(one[2:], other[2:])]
assert 1e-6 < max(differences) < 0.02, differences
print(expected[-1])
