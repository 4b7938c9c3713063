"""The examples for FMPy run; the coupled ship is within its half percent, and its tension repeats itself from period to period once the start is over."""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "examples"))
from fmpy_tension import run

times, tensions = run(sys.argv[1])
assert len(times) == 1200 and abs(times[-1] - 120.0) < 1e-9
last, before = tensions[-120:], tensions[-240:-120]
assert max(abs(a - b) for a, b in zip(last, before)) < 0.01 * max(last), "the tension does not become periodic"
subprocess.run([sys.executable, pathlib.Path(__file__).parents[2] / "examples/coupled_ship.py", sys.argv[1]], check=True)
