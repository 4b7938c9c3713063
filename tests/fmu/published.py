"""The built-in case through the FMU, against the published curve and the solver alone, for each kind of master.

Source: `tests/data/lindahl_sjoberg_tension.csv`, a converged solution of another program; rms over 60 to 120 s.
"""
from __future__ import annotations

import csv
import ctypes as c
import math
import pathlib
import random
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


def random_steps(seed: int) -> list[float]:
    """Steps from 0.01 to 0.5 s up to the end."""
    generator, steps = random.Random(seed), []
    while sum(steps) < END - 0.5:
        steps.append(generator.uniform(0.01, 0.5))
    return steps


def run(step: float = 0.1, velocities: bool = True, derivatives: bool = False, mode: int = 1, seed: int | None = None) -> dict[float, float]:
    line = Line(fmu)
    assert line.set_integer({"input.interpolation": mode}) == OK
    line.start(surge)
    names = [f"fairlead.{kind}.{axis}" for kind in ("position", "position", "velocity") for axis in "xyz"]
    references, orders = line.references(names), (c.c_int * 9)(*[1, 1, 1, 2, 2, 2, 1, 1, 1])
    tensions, seconds = {}, 0.0
    steps = [step] * round(END / step) if seed is None else random_steps(seed)
    for index, own in enumerate(steps):
        line.move(surge, line.time, velocities)
        if derivatives:
            _, v, a = surge(line.time)
            values = (c.c_double * 9)(*v, *a, *a)
            assert line.call("fmi2SetRealInputDerivatives", references, c.c_size_t(9), orders, values) == OK
        begin = clock.perf_counter()
        assert line.do_step(line.time, own) == OK, line.log
        seconds += clock.perf_counter() - begin
        line.time = (index + 1) * own if seed is None else line.time + own
        tensions[round(line.time, 6)] = line.get_real("tension")[1][0]
    print(f"{seconds / len(steps) * 1e6:.1f} us per step; ", end="")
    line.free()
    return tensions


def at(truth: dict[float, float], time: float) -> float:
    """Through the four rows nearest to a time."""
    first = math.floor(time / 0.1) - 1
    s = time / 0.1 - first
    rows = [truth[round((first + k) * 0.1, 6)] for k in range(4)]
    weights = [math.prod((s - j) / (k - j) for j in range(4) if j != k) for k in range(4)]
    return sum(weight * row for weight, row in zip(weights, rows))


def rms_error(found: dict[float, float], truth: dict[float, float]) -> float:
    times = [time for time in found if 60.0 <= time <= 120.0]
    assert len(times) > 100
    right = [truth[time] if time in truth else at(truth, time) for time in times]
    wrong = math.sqrt(sum((found[time] - force) ** 2 for time, force in zip(times, right)) / len(times))
    return wrong / math.sqrt(sum(force**2 for force in right) / len(times))


CASES = [
    ("exact derivatives, 0.1 s, against the solver alone", {"step": 0.1, "derivatives": True}, standalone, 5e-4),
    ("position and velocity, 0.1 s", {"step": 0.1}, published, 1e-3),
    ("positions alone, 0.1 s", {"step": 0.1, "velocities": False}, published, 1e-3),
    ("position and velocity, 0.5 s", {"step": 0.5}, published, 3e-3),
    ("positions alone, 0.5 s", {"step": 0.5, "velocities": False}, published, 3e-3),
    ("velocities held, 0.1 s", {"step": 0.1, "mode": 3}, published, 2e-2),
    # How the run is divided changes nothing beyond the tolerance of 0.1 %. Where the master tells the acceleration it is 0.02 to 0.04 %, without it
    # 0.03 to 0.10 %: the jump of the acceleration at the end of the motion's ramp is seen some steps late, and the axial waves that this
    # starts last for a minute. `auto` is careful with high orders besides, for a vessel that may answer (docs/coupling.md): 0.07 to 0.15 %, with
    # positions alone 0.3 %.
    *((f"exact derivatives, random steps {seed}", {"seed": seed, "derivatives": True}, standalone, 6e-4) for seed in range(4)),
    *((f"position and velocity, random steps {seed}", {"seed": seed}, standalone, 2e-3) for seed in range(4)),
    *((f"positions alone, random steps {seed}", {"seed": seed, "velocities": False}, standalone, 4e-3) for seed in range(2)),
]
failures = []
for what, options, truth, allowed in CASES:
    error = rms_error(run(**options), truth)
    print(f"{what}: {100 * error:.4f} % rms (allowed {100 * allowed} %)")
    if not error <= allowed:
        failures.append(what)
assert not failures, failures
