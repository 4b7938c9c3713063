"""A packed scene of two sections in a current, in FMPy: its quantities stand under the scene's names, can be set, and mean what they say."""

import pathlib
import sys

from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

path = str(pathlib.Path(sys.argv[1]).with_name("two-sections.fmu"))
problems = validate_fmu(path)
assert not problems, problems
description = read_model_description(path)
assert description.modelName == "two-sections"
starts = {variable.name: variable.start for variable in description.modelVariables if variable.causality == "parameter"}
for name, value in {
    "environment.depth": 120.0,
    "environment.current[0].velocity[0]": 0.5,
    "line_types.rope.ea": 2.0e8,
    "lines[0].sections[1].length": 900.0,
    "lines[0].anchor[2]": -120.0,
    "solver.tolerance": 1e-3,
}.items():
    assert float(starts[name]) == value, f"{name} starts at {starts.get(name)}"
assert "line.length" not in starts


def tension(values: dict) -> float:
    result = simulate_fmu(path, stop_time=2.0, output_interval=0.1, start_values=values, output=["tension"])
    return float(result["tension"][-1])


plain = tension({})
assert 1e5 < plain < 1e7
assert tension({"lines[0].sections[1].length": 895.0}) > 1.02 * plain, "a shorter line must be tauter"
assert tension({"environment.current[0].velocity[0]": 0.0, "environment.current[1].velocity[0]": 0.0}) != plain
try:
    tension({"environment.depth": 50.0})
except FMICallException as error:
    print(error)
else:
    raise AssertionError("an anchor below the bed was accepted")
