"""A state brings back everything, bit for bit: after steps, after an error, in every phase, and in another process. To take it changes nothing."""
from __future__ import annotations

import pathlib
import random
import sys
import time

from fmpy.fmi2 import FMU2Slave
from master import ERROR, OK, Fmu, Line, in_another_process, surge

STEPS = [0.1, 0.03, 0.5, 0.01, 0.2, 0.1, 0.1, 0.34]


def go_on(line: Line, begin: float) -> list:
    """Steps of all sizes from a time, and every output on the way, as exact text."""
    line.time = begin
    seen = []
    for step in STEPS * 3:
        assert line.step(surge, step) == OK, line.log
        seen.append([value.hex() for value in line.outputs()])
    return seen


if len(sys.argv) > 2:
    # The other process: goes on from a file.
    fmu = Fmu(sys.argv[1])
    line = Line(fmu)
    status, state = line.deserialize(pathlib.Path(sys.argv[2]).read_bytes())
    assert status == OK, line.log
    assert line.set_state(state) == OK, line.log
    print(go_on(line, float.fromhex(sys.argv[3])))
    sys.exit()

fmu = Fmu(sys.argv[1])
line = Line(fmu)
assert line.set_real({"line.length": 1205.0, "water.density": 1025.0}) == OK
line.start(surge)
for _ in range(40):
    assert line.step(surge) == OK
begin = line.time
status, state = line.get_state()
assert status == OK
data = line.serialize(state)

first = go_on(line, begin)
assert line.set_state(state) == OK
assert go_on(line, begin) == first, "after going back the steps differ"

# A line that nobody ever looked at goes the same way.
unseen = Line(fmu)
assert unseen.set_real({"line.length": 1205.0, "water.density": 1025.0}) == OK
unseen.start(surge)
for _ in range(40):
    assert unseen.step(surge) == OK
assert go_on(unseen, begin) == first, "to take a state changes the steps that follow"
unseen.free()

# After an error the state is as good as ever; parameters come back with it.
assert line.set_real({"fairlead.position.x": -1e6, "fairlead.velocity.x": -9e3}) == OK
assert line.do_step(line.time, 0.1) != OK
assert line.set_state(state) == OK
assert go_on(line, begin) == first, "after an error the steps differ"
assert line.call("fmi2Reset") == OK
assert line.set_state(state) == OK, line.log
assert line.get_real("line.length") == (OK, [1205.0])
assert go_on(line, begin) == first, "after a reset the steps differ"
status, again = line.deserialize(data)
assert status == OK and line.set_state(again) == OK
assert line.serialize(again) == data, "bytes change on the way"
assert go_on(line, begin) == first, "after serialization the steps differ"

# Looks of every kind between random steps, through FMPy: the run is the one that nobody looks at.
INPUTS = [fmu.reference[f"fairlead.{what}.{axis}"] for what in ("position", "velocity") for axis in "xyz"]
OUTPUTS = [fmu.reference[name] for name in fmu.outputs]
TENSION = [fmu.reference["tension"]]


def fmpy_line(scheme: int) -> FMU2Slave:
    slave = FMU2Slave(guid=fmu.guid, unzipDirectory=str(fmu.folder), modelIdentifier="moorline", instanceName="looked at")
    slave.instantiate()
    slave.setInteger([fmu.reference["solver.scheme"]], [scheme])
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    put(slave, 0.0)
    slave.exitInitializationMode()
    return slave


def put(slave: FMU2Slave, at: float):
    position, velocity = surge(at)[:2]
    slave.setReal(INPUTS, position + velocity)


def go(scheme: int, steps: list, dice: random.Random | None) -> dict:
    """Outputs after every step, as exact text; with dice, looks of all kinds and returns in between."""
    slave, other = fmpy_line(scheme), fmpy_line(scheme)
    seen, kept, step, returns = {}, [], 0, 20
    starts = [sum(steps[:count]) for count in range(len(steps) + 1)]
    while step < len(steps):
        look = dice.randrange(7) if dice else 6
        if look == 0:
            kept.append((step, slave.getFMUState()))
        elif look == 1 and kept and returns:
            step, state = dice.choice(kept)
            slave.setFMUState(state)
            returns -= 1
        elif look == 2:
            # Into another instance, which goes on; what was kept belongs to the first.
            state = slave.getFMUState()
            data = slave.serializeFMUState(state)
            slave.freeFMUState(state)
            for _, old in kept:
                slave.freeFMUState(old)
            kept.clear()
            slave, other = other, slave
            state = slave.deSerializeFMUstate(data)
            slave.setFMUState(state)
            slave.freeFMUState(state)
        elif look == 3:
            put(slave, starts[step])
            slave.getDirectionalDerivative(TENSION, INPUTS[:1], [1.0])
        elif look == 4:
            slave.getRealOutputDerivatives(TENSION, [1])
            slave.getReal(OUTPUTS + INPUTS)
        put(slave, starts[step])
        slave.doStep(starts[step], steps[step])
        now = [value.hex() for value in slave.getReal(OUTPUTS)]
        assert seen.setdefault(step, now) == now, f"scheme {scheme}: a step repeated ends elsewhere"
        step += 1
    for instance in (slave, other):
        instance.terminate()
        instance.freeInstance()
    return seen


for scheme in (1, 2, 3, 4):
    dice = random.Random(scheme)
    steps = [dice.choice(STEPS) for _ in range(120)]
    unseen_run = go(scheme, steps, None)
    for _ in range(3):
        assert go(scheme, steps, dice) == unseen_run, f"scheme {scheme}: looks change the run"

# The report's own scheme keeps its tensions, too.
report = Line(fmu)
assert report.set_integer({"solver.scheme": 4}) == OK
report.start(surge)
for _ in range(40):
    assert report.step(surge) == OK, report.log
begin_report = report.time
status, there = report.get_state()
assert status == OK
status, there_again = report.deserialize(report.serialize(there))
assert status == OK
first_report = go_on(report, begin_report)
assert report.set_state(there_again) == OK and go_on(report, begin_report) == first_report, "cable-1994 goes back differently"

# A handle that is used again holds the new state.
assert line.set_state(state) == OK
line.time = begin
assert line.step(surge) == OK
assert line.get_state(state)[0] == OK
later = line.outputs()
assert line.set_state(again) == OK and line.outputs() != later
assert line.set_state(state) == OK and line.outputs() == later

# Every phase comes back.
young = Line(fmu)
status, instantiated = young.get_state()
assert status == OK
young.start(surge)
assert young.set_state(instantiated) == OK
assert young.do_step(0.0, 0.1) == ERROR, "a state taken before initialization can step"
assert young.setup() == OK and young.call("fmi2EnterInitializationMode") == OK
status, initializing = young.get_state()
assert young.call("fmi2ExitInitializationMode") == OK
assert young.step(surge) == OK
one = young.outputs()
assert young.set_state(initializing) == OK and young.call("fmi2ExitInitializationMode") == OK
young.time = 0.0
assert young.step(surge) == OK and young.outputs() == one, "initialized twice from one state, with two results"
assert young.call("fmi2Terminate") == OK
status, terminated = young.get_state()
assert status == OK and young.set_state(initializing) == OK and young.set_state(terminated) == OK
assert young.do_step(0.1, 0.1) == ERROR, "a terminated state can step"

# Reset and run again: the same.
runs = []
for _ in range(2):
    rerun = line
    assert rerun.call("fmi2Reset") == OK
    rerun.start(surge)
    runs.append(go_on(rerun, 0.0))
assert runs[0] == runs[1], "a rerun after fmi2Reset differs"

assert in_another_process(data, begin) == str(first), "another process goes on differently"

# The size of the step does not matter beyond the tolerance, and beyond what `auto` leaves of a motion that is sent in steps of all sizes without its
# acceleration (0.24 % here).
results = []
for steps in ([0.1] * 200, (STEPS * 100)):
    assert line.call("fmi2Reset") == OK
    line.start(surge)
    for step in steps:
        step = min(step, 20.0 - line.time)
        if step < 1e-6:
            break
        assert line.step(surge, step) == OK, line.log
    results.append(line.get_real("tension")[1][0])
assert abs(results[0] - results[1]) < 4e-3 * results[0], results

count = 2000
assert line.set_state(state) == OK
clock = time.perf_counter()
for _ in range(count):
    line.set_state(state)
back = (time.perf_counter() - clock) / count * 1e6
clock = time.perf_counter()
for _ in range(count):
    line.get_state(state)
taking = (time.perf_counter() - clock) / count * 1e6
clock = time.perf_counter()
for _ in range(count):
    line.serialize(state)
writing = (time.perf_counter() - clock) / count * 1e6
print(
    f"{len(data)} bytes; with Python's share it takes {taking:.1f} us to take a state, {back:.1f} us to go back, "
    f"{writing:.1f} us to write it"
)
