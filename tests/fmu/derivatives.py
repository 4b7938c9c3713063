"""Directional derivatives against differences by rollback; output derivatives against differences in time."""

import ctypes as c
import sys

from master import OK, Fmu, Line, surge

fmu = Fmu(sys.argv[1])
INPUTS = [f"fairlead.{kind}.{axis}" for kind in ("position", "velocity") for axis in "xyz"]
SMALL = {"position": 1e-4, "velocity": 1e-4}


def directional(line: Line, name: str) -> list[float]:
    result = (c.c_double * len(fmu.outputs))()
    status = line.call(
        "fmi2GetDirectionalDerivative",
        line.references(fmu.outputs),
        c.c_size_t(len(fmu.outputs)),
        line.references([name]),
        c.c_size_t(1),
        (c.c_double * 1)(1.0),
        result,
    )
    assert status == OK, line.log
    return list(result)


def difference(line: Line, name: str, step: float) -> list[float]:
    """By stepping with the input a little higher and a little lower."""
    _, state = line.get_state()
    value = line.get_real(name)[1][0]
    ends = []
    small = SMALL[name.split(".")[1]]
    for change in (small, -small):
        assert line.set_real({name: value + change}) == OK
        assert line.do_step(line.time, step) == OK, line.log
        ends.append(line.outputs())
        assert line.set_state(state) == OK
    line.free_state(state)
    return [(a - b) / (2 * small) for a, b in zip(*ends)]


line = Line(fmu).start(surge)
for until in (0.0, 5.0, 12.0):
    while line.time < until - 0.05:
        assert line.step(surge) == OK
    line.move(surge, line.time)
    for name in INPUTS:
        exact, approximate = directional(line, name), difference(line, name, 0.1)
        for output, a, b in zip(fmu.outputs, exact, approximate):
            if output == "grounded_length" or (output == "azimuth" and abs(a) > 1e6):
                continue
            scale = {"force": 1e3, "tension": 1e3, "anchor": 1e3, "tension_max": 1e3, "work": 1e3}.get(output.split(".")[0], 1e-3)
            assert abs(a - b) < 0.02 * abs(b) + scale, (
                f"t = {line.time}: d {output} / d {name}: {a} by derivative, {b} by rollback"
            )

line = Line(fmu).start(surge)
for _ in range(60):
    assert line.step(surge) == OK
names = ["force.x", "tension", "work"]
rates = (c.c_double * 3)()
assert line.call("fmi2GetRealOutputDerivatives", line.references(names), c.c_size_t(3), (c.c_int * 3)(1, 1, 1), rates) == OK, (
    line.log
)
before = line.get_real(*names)[1]
assert line.step(surge, 0.01) == OK
after = line.get_real(*names)[1]
for name, rate, a, b in zip(names, rates, before, after):
    change = (b - a) / 0.01
    assert abs(rate - change) < 0.1 * abs(change) + 100.0, f"d {name} / dt: {rate}, by difference {change}"
