"""The FMU of a mooring with a free buoy and a driven ship (examples/calm-buoy.json): as the run, rollback, applied loads, derivatives.

usage: network.py CALM.fmu TIMESERIES.csv
"""

import csv
import math
import sys

from fmpy.validation import validate_fmu
from master import OK, Fmu, Line

path, series = sys.argv[1], sys.argv[2]
problems = validate_fmu(path)
assert not problems, problems
fmu = Fmu(path)
RAMP = 3.25 * 60.0
START = -210.0


def motion(t: float) -> dict:
    """The tanker's, as the scene has it."""
    w, xi = 2 * math.pi / 60.0, min(t / RAMP, 1.0)
    s, ds = xi * xi * (3 - 2 * xi), 6 * xi * (1 - xi) / RAMP
    x = START - 3.0 * math.sin(w * t) * s
    v = -3.0 * (w * math.cos(w * t) * s + math.sin(w * t) * ds)
    return {"tanker.position.x": x, "tanker.velocity.x": v}


NAMES = ["buoy.position.x", "buoy.position.z", "buoy.attitude.pitch", "tanker.force.x", "hawser.tension", "'leg 1'.tension"]
COLUMNS = ["buoy.x", "buoy.z", "buoy.pitch", "tanker.force_x", "hawser.tension", "leg 1.tension"]

# 1. As the command's run.
with open(series) as file:
    rows = list(csv.DictReader(file))
line = Line(fmu).start(motion)
sizes = [max(abs(float(row[name]) - float(rows[0][name])) for row in rows) for name in COLUMNS]
worst = [0.0] * len(NAMES)
for number, row in enumerate(rows[1:1200], 1):
    line.move(motion, line.time)
    assert line.do_step(line.time, 0.1) == OK, line.log
    line.time = 0.1 * number
    for k, value in enumerate(line.get_real(*NAMES)[1]):
        worst[k] = max(worst[k], abs(value - float(row[COLUMNS[k]])) / sizes[k])
assert max(worst) < 5e-3, worst
print("as the run: " + ", ".join(f"{name} {error:.1e}" for name, error in zip(NAMES, worst)))

# 2. Rollback and bytes.
_, state = line.get_state()
begin = line.time


def go_on(line: Line) -> list:
    line.time, seen = begin, []
    for step in (0.1, 0.03, 0.5, 0.2):
        assert line.step(motion, step) == OK, line.log
        seen.append([x.hex() for x in line.outputs()])
    return seen


first = go_on(line)
assert line.set_state(state) == OK and go_on(line) == first, "after going back the steps differ"
other = Line(fmu)
status, copy = other.deserialize(line.serialize(state))
assert status == OK and other.set_state(copy) == OK, other.log
assert go_on(other) == first, "another instance goes on otherwise"
print("a state brings back everything")

# 3. Derivatives: every output of the whole by the pose of the ship and by a force on the buoy, against differences by rollback.
# Steps resolved so finely that a small change shows, on paths that choose nothing.
line = Line(fmu)
assert line.set_real({"solver.tolerance": 1e-6, "solver.max_step": 0.02}) == OK
assert line.set_integer({"input.interpolation": 3}) == OK
line.start(motion)
for _ in range(300):
    assert line.step(motion) == OK, line.log
line.move(motion, line.time)
KNOWN = {"tanker.position.x": 1e-2, "tanker.velocity.x": 5e-2, "buoy.applied_force.x": 1e3, "buoy.applied_moment.y": 1e4}
UNKNOWN = ["buoy.position.x", "buoy.velocity.x", "buoy.attitude.pitch", "tanker.force.x", "tanker.moment.y", "hawser.tension", "'leg 1'.tension"]
worst = 0.0
for name, small in KNOWN.items():
    status, result = line.directional(UNKNOWN, name)
    assert status == OK, line.log
    _, here = line.get_state()
    value, ends = line.get_real(name)[1][0], []
    for change in (small, -small):
        assert line.set_real({name: value + change}) == OK
        assert line.do_step(line.time, 0.1) == OK, line.log
        ends.append(line.get_real(*UNKNOWN)[1])
        assert line.set_state(here) == OK
    line.free_state(here)
    for k, unknown in enumerate(UNKNOWN):
        by = (ends[0][k] - ends[1][k]) / (2 * small)
        worst = max(worst, abs(result[k] - by) / abs(by))
        assert abs(result[k] - by) < 0.05 * abs(by), (name, unknown, result[k], by)
print(f"derivatives agree with differences to {worst:.1e}")

# 4. In initialization mode they are those of the equilibrium, all that is free following: against differences of equilibria found anew.
still = Line(fmu)
assert still.setup() == OK and still.call("fmi2EnterInitializationMode") == OK
assert still.set_real(motion(0.0)) == OK
RESTING = ["buoy.position.x", "buoy.position.z", "buoy.attitude.pitch", "tanker.force.x", "tanker.moment.y", "hawser.tension", "'leg 1'.tension"]
found = {}
for name, small in {"tanker.position.x": 0.02, "tanker.position.z": 0.02, "tanker.attitude.pitch": 2e-4, "buoy.applied_force.x": 1e3}.items():
    status, result = still.directional(RESTING, name)
    assert status == OK, still.log
    value, ends = still.get_real(name)[1][0], []
    for change in (small, -small):
        assert still.set_real({name: value + change}) == OK
        ends.append(still.get_real(*RESTING)[1])
    assert still.set_real({name: value}) == OK
    found[name] = [(small * exact, (one - two) / 2) for exact, one, two in zip(result, *ends)]
assert still.directional(RESTING, "tanker.velocity.x") == (OK, [0.0] * len(RESTING)), "a rate moves nothing at rest"
# What a small motion of one thing changes little is measured by what the others change.
sizes = [max(abs(by[k][1]) for by in found.values()) for k in range(len(RESTING))]
worst = max(abs(exact - by) / size for pairs in found.values() for (exact, by), size in zip(pairs, sizes))
assert worst < 2e-3, worst
# Maxwell and Betti: the buoy follows the tanker as the force on the tanker follows one on the buoy.
follows = still.directional(["buoy.position.x"], "tanker.position.x")[1][0]
pulls = still.directional(["tanker.force.x"], "buoy.applied_force.x")[1][0]
assert 0.4 < follows < 0.6 and abs(follows - pulls) < 1e-6, (follows, pulls)
print(f"derivatives at rest agree with differences to {worst:.1e}, and are reciprocal to {abs(follows - pulls):.0e}")

# 5. A force on the buoy takes it along: at rest with it from the start.
held = Line(fmu)
assert held.setup() == OK and held.call("fmi2EnterInitializationMode") == OK
assert held.set_real({"buoy.applied_force.x": 2.0e5} | motion(0.0)) == OK
assert held.call("fmi2ExitInitializationMode") == OK, held.log
x = held.get_real("buoy.position.x")[1][0]
for _ in range(30):
    assert held.step(motion) == OK
moved = held.get_real("buoy.position.x")[1][0]
free = float(rows[0]["buoy.x"])
assert x > free + 0.5 and abs(moved - x) < 0.02, (free, x, moved)
print(f"a force of 200 kN holds the buoy {x - free:.2f} m aside")
