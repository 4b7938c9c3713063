"""The FMU of a vessel: a driven body's pose in, force and moment out.

usage: vessel.py VESSEL.fmu TIMESERIES.csv

VESSEL.fmu is examples/semi-submersible.json, TIMESERIES.csv what `moorline run` makes of it with the motion of this file.
"""

import csv
import math
import sys

from fmpy import read_model_description
from fmpy.validation import validate_fmu
from master import ERROR, OK, Fmu, Line

PERIOD, RAMP = 20.0, 65.0
AMPLITUDES = (5.0, 0.0, 1.0, 0.0, math.radians(1.0), 0.0)
PARTS = ("position", "attitude", "velocity", "angular_velocity")
ANGLES = ("roll", "pitch", "yaw")


def ramp(t: float) -> tuple[float, float]:
    if t >= RAMP:
        return 1.0, 0.0
    xi = t / RAMP
    return xi * xi * (3 - 2 * xi), 6 * xi * (1 - xi) / RAMP


def motion(t: float) -> dict:
    """The scene's own: x, z and pitch as eased sines, so that the angular velocity is the rate of the pitch."""
    w = 2 * math.pi / PERIOD
    s, ds = ramp(t)
    x = [a * math.sin(w * t) * s for a in AMPLITUDES]
    v = [a * (w * math.cos(w * t) * s + math.sin(w * t) * ds) for a in AMPLITUDES]
    return pose(x, v)


def pose(x, v) -> dict:
    said = {}
    for k, axis in enumerate("xyz"):
        said[f"platform.position.{axis}"] = x[k]
        said[f"platform.attitude.{ANGLES[k]}"] = x[k + 3]
        said[f"platform.velocity.{axis}"] = v[k]
        said[f"platform.angular_velocity.{axis}"] = v[k + 3]
    return said


LOADS = [f"platform.{kind}.{axis}" for kind in ("force", "moment") for axis in "xyz"]
INPUTS = [name for name in pose([0] * 6, [0] * 6)]


def start(fmu: Fmu, said=motion, **parameters) -> Line:
    line = Line(fmu)
    if parameters:
        assert line.set_integer({f"platform.{name}": value for name, value in parameters.items()}) == OK, line.log
    line.start(said)
    return line


def read(line: Line, names=LOADS) -> list[float]:
    return [line.get_real(name)[1][0] for name in names]


path, series = sys.argv[1], sys.argv[2]
problems = validate_fmu(path)
assert not problems, problems
description = read_model_description(path)
inputs = [v.name for v in description.modelVariables if v.causality == "input"]
assert sorted(inputs) == sorted(INPUTS), "the inputs of ends that hang on a body are gone, those of the body are there"
fmu = Fmu(path)

# 1. The same as the command's run, at its output times.
with open(series) as file:
    rows = list(csv.DictReader(file))
line = start(fmu)
worst = [0.0, 0.0, 0.0]
scale = max(abs(float(row["platform.force_x"])) for row in rows)
arm = max(abs(float(row["platform.moment_y"])) for row in rows)
for number, row in enumerate(rows[1:600], 1):
    line.move(motion, line.time)
    assert line.do_step(line.time, 0.1) == OK, line.log
    line.time = 0.1 * number
    force, moment = read(line, ["platform.force.x", "platform.moment.y"])
    tension = read(line, ["line1.tension"])[0] / float(row["line1.tension"]) - 1
    errors = ((force - float(row["platform.force_x"])) / scale, (moment - float(row["platform.moment_y"])) / arm, tension)
    worst = [max(most, abs(error)) for most, error in zip(worst, errors)]
assert max(worst) < 4e-3, worst
print("force, moment and tension as in the run: " + ", ".join(f"{error:.1e}" for error in worst))

# 2. Axes and frames of all kinds say the same.

SIX = (2.0, 1.5, 0.7, 0.05, 0.03, 0.08)


def six(t: float, rates: int = 1, axes: int = 1, loads: int = 1) -> dict:
    """A motion in all six, as a master says it in its axes."""
    w = 2 * math.pi / 15
    x = [a * math.sin(w * t + k) for k, a in enumerate(SIX)]
    q = [a * w * math.cos(w * t + k) for k, a in enumerate(SIX)]
    (sp, cp), (sy, cy) = ((math.sin(x[4]), math.cos(x[4])), (math.sin(x[5]), math.cos(x[5])))
    omega = [cy * cp * q[3] - sy * q[4], sy * cp * q[3] + cy * q[4], q[5] - sp * q[3]]
    v = q[:3] + omega
    if rates == 2:
        turn = rotation(x[3:])
        v = [sum(turn[i][j] * v[k + i] for i in range(3)) for k in (0, 3) for j in range(3)]
    if axes == 2:
        x = [x[0], -x[1], -x[2], x[3], -x[4], -x[5]]
        v = [v[0], -v[1], -v[2], v[3], -v[4], -v[5]]
    return pose(x, v)


def states(**parameters):
    """Loads after some steps with a motion in all six, as said by a master with these axes."""

    def moved(t: float) -> dict:
        return six(t, **parameters)

    line = start(fmu, moved, **parameters)
    for _ in range(30):
        assert line.step(moved) == OK, line.log
    loads = read(line)
    x = [a * math.sin(2 * math.pi / 15 * line.time + k) for k, a in enumerate(SIX)]
    if parameters.get("axes") == 2:
        loads = [loads[0], -loads[1], -loads[2], loads[3], -loads[4], -loads[5]]
    if parameters.get("loads") == 2:
        turn = rotation(x[3:])
        loads = [sum(turn[i][j] * loads[k + j] for j in range(3)) for k in (0, 3) for i in range(3)]
    line.free()
    return loads


def rotation(angles):
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a), math.cos(a)) for a in angles)
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


plain = states()
sizes = [max(abs(x) for x in plain[k : k + 3]) for k in (0, 3) for _ in range(3)]
for axes in (1, 2):
    for rates in (1, 2):
        for loads in (1, 2):
            other = states(axes=axes, rates=rates, loads=loads)
            # What is turned to and fro differs by rounding; turned loads by where the path ended (1e-4 of a turn).
            error = max(abs(a - b) / size for a, b, size in zip(plain, other, sizes))
            assert error < 1e-3, (axes, rates, loads, error)
print("z-up and ned, global and body rates and loads say the same")

# 3. Directional derivatives against differences by rollback, output derivatives against differences in time.
OUTPUTS = LOADS + ["platform.work", "line2.tension"]


line = Line(fmu)
assert line.set_real({"solver.tolerance": 3e-6, "solver.max_step": 0.02}) == OK
line.start(six)
for _ in range(50):
    assert line.step(six) == OK, line.log
line.move(six, line.time)
worst = 0.0
for kind in PARTS:
    names = [name for name in INPUTS if f".{kind}." in name]
    small = 1e-7 if kind in ("position", "velocity") else 1e-8
    pairs = []
    for name in names:
        _, state = line.get_state()
        value, ends = line.get_real(name)[1][0], []
        for change in (small, -small):
            assert line.set_real({name: value + change}) == OK
            assert line.do_step(line.time, 0.1) == OK, line.log
            ends.append(read(line, OUTPUTS))
            assert line.set_state(state) == OK
        line.free_state(state)
        status, exact = line.directional(OUTPUTS, name)
        assert status == OK, line.log
        pairs.append((exact, [(a - b) / (2 * small) for a, b in zip(*ends)]))
    for group in (range(3), range(3, 6), [6], [7]):
        size = max(abs(by[row]) for _, by in pairs for row in group)
        for name, (exact, by) in zip(names, pairs):
            for row in group:
                error = abs(exact[row] - by[row]) / size
                worst = max(worst, error)
                assert error < 1e-2, (name, OUTPUTS[row], exact[row], by[row])
print(f"derivatives by pose and rates agree with differences to {worst:.1e}")

line.free()
line = start(fmu)
for _ in range(320):
    assert line.step(motion) == OK, line.log
rates, before = line.rates(OUTPUTS), read(line, OUTPUTS)
assert line.step(motion, 0.01) == OK
after = read(line, OUTPUTS)
for group in (range(3), range(3, 6), [6], [7]):
    size = max(abs(after[row] - before[row]) / 0.01 for row in group)
    for row in group:
        assert abs((after[row] - before[row]) / 0.01 - rates[row]) < 0.15 * size + 100.0, (OUTPUTS[row], rates[row], (after[row] - before[row]) / 0.01)
line.free()
print("output derivatives are the differences in time")

# 4. Rollback, in this process and through bytes: the same bits.
line = start(fmu)
for _ in range(20):
    assert line.step(motion) == OK
_, state = line.get_state()
begin = line.time


def go_on(line: Line) -> list:
    line.time, seen = begin, []
    for step in (0.1, 0.03, 0.5, 0.2, 0.1):
        assert line.step(motion, step) == OK, line.log
        seen.append([x.hex() for x in read(line, fmu.outputs)])
    return seen


first = go_on(line)
assert line.set_state(state) == OK and go_on(line) == first
data = line.serialize(state)
other = Line(fmu)
status, copy = other.deserialize(data)
assert status == OK and other.set_state(copy) == OK, other.log
assert go_on(other) == first
print("a state brings back everything")

# 5. What cannot be is refused by name, and nothing is lost.
assert line.set_state(state) == OK
line.time = begin
for name, value, words in (
    ("platform.position.x", 150.0, "100 m"),
    ("platform.attitude.yaw", 2.0, "90"),
):
    line.move(motion, begin)
    assert line.set_real({name: value}) == OK
    assert line.do_step(begin, 0.1) == ERROR, (name, line.log)
    assert any(words in text and "platform" in text for _, _, text in line.log), line.log
    line.log.clear()
for name, value in (("platform.attitude.pitch", 1.6), ("platform.position.x", math.nan), ("platform.velocity.z", math.inf)):
    assert line.set_real({name: value}) == ERROR, name
line.move(motion, begin)
assert go_on(line) == first, "a refused pose changed something"

# Angles of many turns, and ±pi, are no jump.
for turns in (0, 1, -7):

    def wound(t: float, turns=turns) -> dict:
        yaw = math.pi - 0.02 + 0.02 * t
        wrapped = (yaw + math.pi) % (2 * math.pi) - math.pi if turns == 0 else yaw + 2 * math.pi * turns
        return pose([0, 0, 0, 0, 0, wrapped], [0, 0, 0, 0, 0, 0.02])

    line = Line(fmu)
    line.start(wound)
    for _ in range(20):
        assert line.step(wound) == OK, line.log
    loads = read(line)
    if turns == 0:
        base = loads
    assert all(abs(a - b) < 1e-6 * max(map(abs, base)) for a, b in zip(base, loads)), (turns, base, loads)
    line.free()
print("poses that cannot be are refused, and angles wind")

# 6. A master that sends poses without rates.
line = Line(fmu)


def silent(t: float) -> dict:
    return {name: (value if "velocity" not in name else 0.0) for name, value in motion(t).items()}


line.start(silent)
worst = 0.0
for number, row in enumerate(rows[1:600], 1):
    line.move(silent, line.time)
    assert line.do_step(line.time, 0.1) == OK, line.log
    line.time = 0.1 * number
    worst = max(worst, abs(read(line, ["platform.force.x"])[0] - float(row["platform.force_x"])) / scale)
assert worst < 1e-2, worst
print(f"poses without rates: force within {worst:.1e}")
