"""The built-in case through the FMU, against the published curve and the solver alone, for each kind of master.

Source: `tests/data/lindahl_sjoberg_tension.csv`, a converged solution of another program; rms over 60 to 120 s.
"""

import csv
import ctypes as c
import math
import pathlib
import sys
import time as clock

from master import OK, Fmu, Line, surge

fmu = Fmu(sys.argv[1])
END = 120.0


def table(path) -> dict[float, float]:
    with open(path, encoding="utf-8") as file:
        return {round(float(row["time"]), 6): float(row["tension"]) for row in csv.DictReader(file)}


published = table(pathlib.Path(__file__).parents[1] / "data/lindahl_sjoberg_tension.csv")
standalone = table(pathlib.Path(sys.argv[1]).with_name("standalone.csv"))


def run(step: float, velocities: bool = True, derivatives: bool = False, mode: int = 1) -> dict[float, float]:
    line = Line(fmu)
    assert line.set_integer({"input.interpolation": mode}) == OK
    line.start(surge)
    names = [f"fairlead.{kind}.{axis}" for kind in ("position", "position", "velocity") for axis in "xyz"]
    references, orders = line.references(names), (c.c_int * 9)(*[1, 1, 1, 2, 2, 2, 1, 1, 1])
    tensions, seconds = {}, 0.0
    for index in range(round(END / step)):
        line.move(surge, line.time, velocities)
        if derivatives:
            _, v, a = surge(line.time)
            values = (c.c_double * 9)(*v, *a, *a)
            assert line.call("fmi2SetRealInputDerivatives", references, c.c_size_t(9), orders, values) == OK
        begin = clock.perf_counter()
        assert line.do_step(line.time, step) == OK, line.log
        seconds += clock.perf_counter() - begin
        line.time = (index + 1) * step
        tensions[round(line.time, 6)] = line.get_real("tension")[1][0]
    print(f"{seconds / (END / step) * 1e6:.1f} us per step of {step} s; ", end="")
    line.free()
    return tensions


def rms_error(found: dict[float, float], truth: dict[float, float]) -> float:
    times = [time for time in found if 60.0 <= time <= 120.0]
    assert len(times) > 100
    wrong = math.sqrt(sum((found[time] - truth[time]) ** 2 for time in times) / len(times))
    return wrong / math.sqrt(sum(truth[time] ** 2 for time in times) / len(times))


CASES = [
    ("exact derivatives, 0.1 s, against the solver alone", {"step": 0.1, "derivatives": True}, standalone, 5e-4),
    ("position and velocity, 0.1 s", {"step": 0.1}, published, 1e-3),
    ("positions alone, 0.1 s", {"step": 0.1, "velocities": False}, published, 1e-3),
    ("position and velocity, 0.5 s", {"step": 0.5}, published, 3e-3),
    ("positions alone, 0.5 s", {"step": 0.5, "velocities": False}, published, 3e-3),
    ("velocities held, 0.1 s", {"step": 0.1, "mode": 3}, published, 2e-2),
]
failures = []
for what, options, truth, allowed in CASES:
    error = rms_error(run(**options), truth)
    print(f"{what}: {100 * error:.4f} % rms (allowed {100 * allowed} %)")
    if not error <= allowed:
        failures.append(what)
assert not failures, failures
