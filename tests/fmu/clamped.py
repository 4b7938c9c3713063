"""The FMU of a riser that is clamped to a driven vessel (examples/clamped-riser.json): its moment as in the run, its derivatives, its work.

usage: clamped.py RISER.fmu TIMESERIES.csv
"""

import csv
import math
import sys

from master import OK, Fmu, Line

fmu = Fmu(sys.argv[1])
LOADS = ["vessel.force.x", "vessel.force.z", "vessel.moment.y"]
COLUMNS = ["vessel.force_x", "vessel.force_z", "vessel.moment_y"]
PERIOD = RAMP = 10.0
KEEL, TRIM, PITCH = -10.0, math.radians(2.0), math.radians(1.0)


def motion(t: float) -> dict:
    """The vessel's, as the scene has it."""
    w, xi = 2 * math.pi / PERIOD, min(t / RAMP, 1.0)
    s, ds = xi * xi * (3 - 2 * xi), 6 * xi * (1 - xi) / RAMP
    value, rate = math.sin(w * t) * s, w * math.cos(w * t) * s + math.sin(w * t) * ds
    return {
        "vessel.position.x": 0.3 * value, "vessel.position.z": KEEL + 0.01 * value, "vessel.attitude.pitch": TRIM + PITCH * value,
        "vessel.velocity.x": 0.3 * rate, "vessel.velocity.z": 0.01 * rate, "vessel.angular_velocity.y": PITCH * rate,
    }  # fmt: skip


# 1. As the command's run. The force across is small beside that along, and where the vessel sets off a path is guessed.
with open(sys.argv[2]) as file:
    rows = list(csv.DictReader(file))
line = Line(fmu).start(motion)
sizes = [max(abs(float(row[name]) - float(rows[0][name])) for row in rows) for name in COLUMNS]
worst = [0.0] * 3
for number, row in enumerate(rows[1:], 1):
    assert line.step(motion) == OK, line.log
    line.time = 0.1 * number
    for k, value in enumerate(line.get_real(*LOADS)[1]):
        worst[k] = max(worst[k], abs(value - float(row[COLUMNS[k]])) / sizes[k])
assert worst[0] < 2e-2 and max(worst[1:]) < 2e-3, worst
print(f"as the run to {max(worst):.1e}")

# The work is that of force and of moment: by the trapezoidal rule from loads every 0.02 s.
line = Line(fmu).start(motion)
works, said, swing = [0.0, 0.0], 0.0, 0.0


def powers() -> tuple[float, float]:
    x, z, moment = line.get_real(*LOADS)[1]
    now = motion(line.time)
    return x * now["vessel.velocity.x"] + z * now["vessel.velocity.z"], moment * now["vessel.angular_velocity.y"]


before = powers()
for number in range(1, 1376):
    assert line.step(motion, 0.02) == OK, line.log
    line.time = 0.02 * number
    now = powers()
    works = [work + 0.01 * (one + two) for work, one, two in zip(works, before, now)]
    said, before = line.get_real("vessel.work")[1][0], now
    swing = max(swing, abs(said))
assert abs(works[1]) > 0.1 * swing and abs(said - sum(works)) < 5e-3 * swing, (said, works, swing)
print(f"work {said / 1e3:.3f} kJ, {works[0] / 1e3:.3f} kJ by the force and {works[1] / 1e3:.3f} kJ by the moment")

# 2. Derivatives of a step, and of equilibrium, beside differences.
KNOWN = {
    "vessel.position.x": 1e-3, "vessel.position.z": 1e-3, "vessel.attitude.pitch": 1e-3,
    "vessel.velocity.x": 1e-2, "vessel.velocity.z": 1e-2, "vessel.angular_velocity.y": 1e-2,
}  # fmt: skip


def compare(line: Line, ends, known: dict, allowed: float, what: str):
    """Changes of each load, by its largest with any of the motions."""
    pairs = []
    for name, small in known.items():
        status, exact = line.directional(LOADS, name)
        assert status == OK, line.log
        value = line.get_real(name)[1][0]
        after, before = ends(name, value + small), ends(name, value - small)
        pairs.append([(small * one, (a - b) / 2) for one, a, b in zip(exact, after, before)])
    sizes = [max(abs(pair[k][1]) for pair in pairs) for k in range(len(LOADS))]
    worst = max(abs(one - two) / size for pair in pairs for (one, two), size in zip(pair, sizes))
    assert worst < allowed, worst
    print(f"{what} agree with differences to {worst:.1e}")


line = Line(fmu)
assert line.set_real({"solver.tolerance": 1e-6, "solver.max_step": 0.02}) == OK
assert line.set_integer({"input.interpolation": 3}) == OK
line.start(motion)
for _ in range(60):
    assert line.step(motion) == OK, line.log
line.move(motion, line.time)


def stepped(name: str, value: float) -> list[float]:
    _, here = line.get_state()
    assert line.set_real({name: value}) == OK and line.do_step(line.time, 0.1) == OK, line.log
    found = line.get_real(*LOADS)[1]
    assert line.set_state(here) == OK
    line.free_state(here)
    return found


compare(line, stepped, KNOWN, 0.02, "derivatives of a step")
still = Line(fmu)
assert still.setup() == OK and still.call("fmi2EnterInitializationMode") == OK
assert still.set_real(motion(0.0)) == OK


def settled(name: str, value: float) -> list[float]:
    given = still.get_real(name)[1][0]
    assert still.set_real({name: value}) == OK
    found = still.get_real(*LOADS)[1]
    assert still.set_real({name: given}) == OK
    return found


compare(still, settled, {name: small for name, small in KNOWN.items() if "velocity" not in name}, 1e-3, "derivatives at rest")

# 3. The rate of the moment beside its changes in time. The slope at a clamp that does not give way rings a little about the vessel's turn.
line = Line(fmu).start(motion)
seen, rates = [], []
for number in range(1, 400):
    assert line.step(motion, 0.02) == OK, line.log
    line.time = 0.02 * number
    seen.append(line.get_real("vessel.moment.y")[1][0])
    rates.append(line.rates(["vessel.moment.y"])[0])
# Over twenty steps that comes to nothing.
worst = 0.0
for first in range(200, 360, 20):
    passed = seen[first + 20] - seen[first]
    summed = 0.02 * (sum(rates[first : first + 21]) - 0.5 * (rates[first] + rates[first + 20]))
    worst = max(worst, abs(summed - passed))
swing = max(seen) - min(seen)
assert worst < 5e-3 * swing, (worst, swing)
print(f"rates of the moment sum up to its changes within {worst / swing:.1e} of its swing")
