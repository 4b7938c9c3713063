"""The FMU of a moored ship through what the FMU of a line goes through: states in every phase and another process, looks, refusals, statics.

usage: moored.py SHIP.fmu TIMESERIES.csv

SHIP.fmu is examples/spread-moored-ship.json; its time series is not looked at.
"""

import math
import pathlib
import random
import sys

from master import ERROR, OK, Fmu, Line, in_another_process

STEPS = (0.1, 0.03, 0.5, 0.01, 0.2)
SIX = (3.0, 2.0, 0.5, 0.04, 0.02, 0.05)
NAMES = [f"ship.{kind}.{axis}" for kind in ("position", "attitude") for axis in "xyz"]
NAMES[3:] = [f"ship.attitude.{angle}" for angle in ("roll", "pitch", "yaw")]
LOADS = [f"ship.{kind}.{axis}" for kind in ("force", "moment") for axis in "xyz"]


def motion(t: float) -> dict:
    """All six at once; the rates are left to the FMU."""
    return {name: a * math.sin(2 * math.pi / 15 * t + k) for k, (name, a) in enumerate(zip(NAMES, SIX))}


def go_on(line: Line, begin: float) -> list:
    """Steps of all sizes, and every output on the way as exact text."""
    line.time, seen = begin, []
    for step in STEPS * 2:
        assert line.step(motion, step) == OK, line.log
        seen.append([value.hex() for value in line.outputs()])
    return seen


fmu = Fmu(sys.argv[1])
if len(sys.argv) > 3:
    # The other process: goes on from a file.
    line = Line(fmu)
    status, state = line.deserialize(pathlib.Path(sys.argv[2]).read_bytes())
    assert status == OK and line.set_state(state) == OK, line.log
    print(go_on(line, float.fromhex(sys.argv[3])))
    sys.exit()

# 1. States: here, after an error, after a reset, in another instance and another process, and unseen.
line, unseen = Line(fmu).start(motion), Line(fmu).start(motion)
for _ in range(40):
    assert line.step(motion) == OK and unseen.step(motion) == OK, line.log
begin = line.time
_, state = line.get_state()
data = line.serialize(state)
first = go_on(line, begin)
assert go_on(unseen, begin) == first, "to take a state changes the steps that follow"
assert line.set_state(state) == OK and go_on(line, begin) == first, "after going back the steps differ"
assert line.set_real({"ship.position.x": 900.0}) == OK and line.do_step(line.time, 0.1) == ERROR
assert line.set_state(state) == OK and go_on(line, begin) == first, "after an error the steps differ"
assert line.call("fmi2Reset") == OK and line.set_state(state) == OK, line.log
assert go_on(line, begin) == first, "after a reset the steps differ"
status, again = line.deserialize(data)
assert status == OK and line.set_state(again) == OK and line.serialize(again) == data, "bytes change on the way"
assert go_on(line, begin) == first, "after serialisation the steps differ"
assert in_another_process(data, begin) == str(first), "another process goes on differently"
print(f"{len(data)} bytes bring back everything")

# 2. Looks of every kind between the steps change nothing.
dice = random.Random(8)
assert line.set_state(state) == OK
line.time, seen = begin, []
for step in STEPS * 2:
    for look in dice.sample(range(3), 2):
        if look == 0:
            _, kept = line.get_state()
            assert line.step(motion, 0.3) == OK and line.set_state(kept) == OK
            line.time -= 0.3
            line.free_state(kept)
        elif look == 1:
            assert line.directional(LOADS, dice.choice(NAMES))[0] == OK, line.log
        else:
            line.rates(LOADS)
    assert line.step(motion, step) == OK, line.log
    seen.append([value.hex() for value in line.outputs()])
assert seen == first, "looks change the run"

# 3. What may not be is refused with its reason, and nothing is lost.


def refused(what: str, status: int, *words: str):
    assert status == ERROR and line.log, (what, status)
    assert all(word in line.log[-1][2] for word in words), (what, line.log[-1])
    line.log.clear()


assert line.set_state(state) == OK
line.log.clear()
refused("output set", line.set_real({"ship.force.x": 1.0}), "ship.force.x", "an output")
refused("axes after the start", line.set_integer({"ship.axes": 2}), "ship.axes", "fixed")
refused("pose NaN", line.set_real({"ship.position.y": math.nan}), "ship.position.y")
refused("direction from an output", line.directional(LOADS, "ship.force.y")[0], "ship.force.y")
refused("direction of an input", line.directional([NAMES[0]], NAMES[0])[0], "ship.position.x")
refused("direction NaN", line.directional(LOADS, NAMES[5], math.nan)[0], "ship.attitude.yaw")
refused("step from elsewhere", line.do_step(begin + 0.05, 0.1), "currentCommunicationPoint")
refused("step of nothing", line.do_step(begin, 0.0), "communicationStepSize")
for position in range(0, len(data), max(1, len(data) // 40)):
    damaged = bytearray(data)
    damaged[position] ^= 1
    refused("a state with one bit wrong", line.deserialize(bytes(damaged))[0], "refused")
refused("a state cut off", line.deserialize(data[:-1])[0], "refused")
assert go_on(line, begin) == first, "a refusal changed something"

# 4. Every phase comes back.
young = Line(fmu)
assert young.setup() == OK and young.call("fmi2EnterInitializationMode") == OK
young.move(motion, 0.0)
_, initialising = young.get_state()
assert young.call("fmi2ExitInitializationMode") == OK
runs = [go_on(young, 0.0)]
assert young.set_state(initialising) == OK and young.call("fmi2ExitInitializationMode") == OK
runs.append(go_on(young, 0.0))
assert young.call("fmi2Terminate") == OK and young.call("fmi2Reset") == OK
runs.append(go_on(young.start(motion), 0.0))
assert runs[0] == runs[1] == runs[2], "initialised twice, with two results"

# 5. In initialization mode a derivative is that of the equilibrium: against differences of the outputs there.
still = Line(fmu)
assert still.setup() == OK and still.call("fmi2EnterInitializationMode") == OK
STIFFNESS, LEVER = 83.2e3, 95.0  # against surge [N/m], from midships to the fairleads [m]
worst = 0.0
for name, small in (("ship.position.x", 0.1), ("ship.position.y", 0.1), ("ship.attitude.yaw", 1e-3)):
    status, exact = still.directional(LOADS, name)
    assert status == OK, still.log
    ends = []
    for change in (small, -small):
        assert still.set_real({name: change}) == OK
        ends.append(still.get_real(*LOADS)[1])
    assert still.set_real({name: 0.0}) == OK
    by = [(one - two) / (2 * small) for one, two in zip(*ends)]
    # What bow and stern leave of each other is small: errors are measured by the stiffness of the ship at its lever.
    for row, (one, two) in enumerate(zip(exact, by)):
        size = STIFFNESS * LEVER ** ((row >= 3) + ("attitude" in name))
        worst = max(worst, abs(one - two) / size)
assert worst < 1e-3, worst
rate = name.replace("attitude.yaw", "angular_velocity.z")
assert still.directional(LOADS, rate) == (OK, [0.0] * len(LOADS)), "a rate moves nothing at rest"
print(f"stiffness at rest agrees with differences to {worst:.1e}")
