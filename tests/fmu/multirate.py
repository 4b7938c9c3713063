"""A master that steps the line more often than the vessel: the line is led as well as if it were stepped with the vessel.

Surge as a vessel computes it, every 0.1 s, given to a line that is stepped 1, 2, 5 and 10 times as often, with and without velocities; in every
mode of `input.interpolation`. Judged at the vessel's points against the same motion sent every 0.01 s. The bar: twice the error of a line that
is stepped with the vessel, or 0.2 % of the amplitude of the tension where that is more.
"""

import math
import sys

from master import OK, Fmu, Line

fmu = Fmu(sys.argv[1])
VESSEL, RAMP = 0.1, 20.0
AUTO, EXTRAPOLATE, HOLD_VELOCITY, DELAY = 1, 2, 3, 4


def motion(time, amplitude, period):
    w, s = 2.0 * math.pi / period, min(time / RAMP, 1.0)
    ease, rate = s * s * (3.0 - 2.0 * s), (6.0 * s * (1.0 - s) / RAMP if time < RAMP else 0.0)
    sin, cos = math.sin(w * time), math.cos(w * time)
    return amplitude * ease * sin, amplitude * (rate * sin + ease * w * cos)


def tensions(step, mode, velocities, held, case):
    line = Line(fmu)
    assert line.set_integer({"input.interpolation": mode}) == OK
    assert line.setup() == OK and line.call("fmi2EnterInitializationMode") == OK and line.call("fmi2ExitInitializationMode") == OK
    found = {}
    for number in range(round(2.0 * RAMP / step) + round(max(RAMP, case[1]) / step)):
        time = number * step
        seen = math.floor(time / VESSEL + 1e-6) * VESSEL if held else time
        x, v = motion(round(seen, 9), *case)
        values = {"fairlead.position.x": x} | ({"fairlead.velocity.x": v} if velocities else {})
        assert line.set_real(values) == OK and line.do_step(time, step) == OK, line.log
        if time > 2.0 * RAMP and abs((time + step) / VESSEL - round((time + step) / VESSEL)) < 1e-6:
            found[round((time + step) / VESSEL)] = line.get_real("tension")[1][0]
    line.free()
    return found


def off(one, other):
    return max(abs(one[k] - other[k]) for k in one)


CASES = {(3.0, 10.0): (AUTO, EXTRAPOLATE, HOLD_VELOCITY, DELAY), (0.5, 8.0): (AUTO,), (4.0, 60.0): (AUTO,)}
for case, modes in CASES.items():
    exact = tensions(0.01, AUTO, True, False, case)
    amplitude = (max(exact.values()) - min(exact.values())) / 2
    for mode in modes:
        for velocities in (True, False) if mode == AUTO else (True,):
            together = off(tensions(VESSEL, mode, velocities, True, case), exact)
            for ratio in (2, 5, 10):
                error = off(tensions(VESSEL / ratio, mode, velocities, True, case), exact)
                what = f"{case[0]} m at {case[1]} s, mode {mode}, {'with' if velocities else 'without'} velocities, ratio {ratio}"
                print(f"{what}: {error / amplitude:.2%} of the amplitude, with the vessel {together / amplitude:.2%}")
                assert error < 2.0 * max(together, 0.001 * amplitude), what
