"""Clocks that masters have: in single precision, rounded to nanoseconds, summed up; for 1000 s each (a whole mooring 300 s). And one that means another time."""

import ctypes
import sys

from master import ERROR, OK, Fmu, Line, motion_of, surge

fmu = Fmu(sys.argv[1])
motion = motion_of(fmu)


def single(time: float) -> float:
    return ctypes.c_float(time).value


def nano(time: float) -> float:
    return round(time * 1e9) / 1e9


CLOCKS = {
    "single precision": (single, single),
    "single precision, step exact": (single, float),
    "nanoseconds": (nano, nano),
    "step in single precision": (float, single),
}
# In single precision 0.1 s differ by 6e-5 s at 1000 s. The clock of a whole mooring is the same, and steps take longer.
LONG = 1000.0 if motion is surge else 300.0
for name, (clock, length) in CLOCKS.items():
    for step in (0.1, 1 / 30):
        line = Line(fmu).start(motion)
        for number in range(round((LONG if step == 0.1 else 100.0) / step)):
            time = number * step
            line.move(motion, time)
            assert line.do_step(clock(time), length(step)) == OK, f"{name}, {time} s: {line.log[-1]}"
        line.free()

line = Line(fmu).start(motion)
assert line.do_step(0.0, 0.1) == OK
for wrong in (0.0, 0.05, 0.09, 0.11, 0.2):
    assert line.do_step(wrong, 0.1) == ERROR and "currentCommunicationPoint" in line.log[-1][2], wrong
assert line.do_step(0.10000000149, 0.1) == OK, line.log
