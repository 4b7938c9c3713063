"""Directional derivatives against differences by rollback; output derivatives against differences in time."""

import sys

from master import OK, Fmu, Line, surge

fmu = Fmu(sys.argv[1])
INPUTS = [f"fairlead.{kind}.{axis}" for kind in ("position", "velocity") for axis in "xyz"]
# Outputs that are compared as one vector, and the size of a change per metre or m/s below which they are not worth comparing. A rounding of a
# strain is EA 2^-52 / 2e-7 = 0.6 N/m of difference, which is all that is left where an anchor does not feel the fairlead in a step.
GROUPS = (
    (("tension", "force.x", "force.y", "force.z", "tension_max"), 1e3),
    (("anchor.tension", "anchor.force.x", "anchor.force.y", "anchor.force.z"), 1e4),
    (("declination", "azimuth"), 1e-3),
    (("grounded_length",), 1e-1),
    (("work",), 1e3),
)
assert {name for names, _ in GROUPS for name in names} == set(fmu.outputs), "an output is not compared"


def directional(line: Line, name: str) -> list[float]:
    status, changes = line.directional(fmu.outputs, name)
    assert status == OK, line.log
    return changes


def difference(line: Line, name: str, step: float, small: float) -> list[float]:
    """By stepping with the input a little higher and a little lower."""
    _, state = line.get_state()
    value = line.get_real(name)[1][0]
    ends = []
    for change in (small, -small):
        assert line.set_real({name: value + change}) == OK
        assert line.do_step(line.time, step) == OK, line.log
        ends.append(line.outputs())
        assert line.set_state(state) == OK
    line.free_state(state)
    return [(a - b) / (2 * small) for a, b in zip(*ends)]


def compare(times: tuple, small: float, allowed: float, parameters: dict):
    """All outputs by all inputs, at several times of the built-in case, in parts of the largest change of their group."""
    line = Line(fmu)
    assert line.set_real(parameters) == OK
    line.start(surge)
    worst = 0.0
    for until in times:
        while line.time < until - 0.05:
            assert line.step(surge) == OK
        line.move(surge, line.time)
        for kind in ("position", "velocity"):
            names = [name for name in INPUTS if kind in name]
            pairs = [(directional(line, name), difference(line, name, 0.1, small)) for name in names]
            for outputs, least in GROUPS:
                rows = [fmu.outputs.index(output) for output in outputs]
                scale = max([least] + [abs(by_rollback[row]) for _, by_rollback in pairs for row in rows])
                for name, (exact, by_rollback) in zip(names, pairs):
                    for row in rows:
                        error = abs(exact[row] - by_rollback[row]) / scale
                        worst = max(worst, error)
                        assert error < allowed, (
                            f"t = {line.time}: d {fmu.outputs[row]} / d {name}: {exact[row]}, by rollback {by_rollback[row]}"
                        )
    line.free()
    print(f"{parameters}: derivatives and differences agree to {worst:.1e} of the largest of their group")


# The derivative is that of converged steps. At the default tolerance a step stops iterating a little before that, with the factor that it
# has at hand, which shows in differences (0.3 at most); with a tight tolerance they agree (1e-3), as long as the small change does not
# change the choice of steps (at 1e-6 it is the motion to which that tolerance answers).
TIMES = (0.0, 5.0, 12.0, 55.0, 61.3)
compare(TIMES, small=1e-5, allowed=0.4, parameters={})
compare(TIMES, small=1e-7, allowed=3e-3, parameters={"solver.tolerance": 3e-6, "solver.max_step": 0.02})

line = Line(fmu).start(surge)
for _ in range(60):
    assert line.step(surge) == OK
names = ["force.x", "tension", "work"]
rates = line.rates(names)
before = line.get_real(*names)[1]
assert line.step(surge, 0.01) == OK
after = line.get_real(*names)[1]
for name, rate, a, b in zip(names, rates, before, after):
    change = (b - a) / 0.01
    assert abs(rate - change) < 0.1 * abs(change) + 100.0, f"d {name} / dt: {rate}, by difference {change}"

# In initialization mode the derivative is that of the equilibrium: against differences of the outputs there (2 cm: both are good to 1e-3), zero by
# velocity; and a vessel of given static loads finds its place on two lines by Newton's method in three iterations.
line = Line(fmu)
assert line.setup() == OK and line.call("fmi2EnterInitializationMode") == OK
for axis in "xyz":
    name = f"fairlead.position.{axis}"
    exact = directional(line, name)
    before = line.outputs()
    ends = []
    for change in (0.01, -0.01):
        assert line.set_real({name: change}) == OK
        ends.append(line.outputs())
    assert line.set_real({name: 0.0}) == OK and line.outputs() == before
    for output, one, two, found in zip(fmu.outputs, *ends, exact):
        expected = (one - two) / 0.02
        assert abs(found - expected) < 2e-3 * abs(expected) + 30.0 or output in ("azimuth", "work"), f"d {output} / d {axis}: {found}, {expected}"
    assert directional(line, f"fairlead.velocity.{axis}") == [0.0] * len(fmu.outputs)
assert line.call("fmi2ExitInitializationMode") == OK and line.step(surge) == OK
assert abs(directional(line, "fairlead.position.x")[fmu.outputs.index("force.x")]) > 1e6, "between steps it is that of a step"
assert line.call("fmi2Terminate") == OK
directional(line, "fairlead.position.x")

bow, stern = Line(fmu), Line(fmu)
assert stern.set_real({"anchor.position.x": -1183.970}) == OK
for end in (bow, stern):
    assert end.setup() == OK and end.call("fmi2EnterInitializationMode") == OK
load, place = 3.0e5, 0.0
for iteration in range(4):
    force = stiffness = 0.0
    for end in (bow, stern):
        assert end.set_real({"fairlead.position.x": place}) == OK
        force += end.get_real("force.x")[1][0]
        stiffness += directional(end, "fairlead.position.x")[fmu.outputs.index("force.x")]
    print(f"iteration {iteration}: {place:.4f} m, {force + load:.1f} N out of balance")
    if abs(force + load) < 1e-3 * load:
        break
    place -= (force + load) / stiffness
assert iteration <= 3 and abs(force + load) < 1e-3 * load and place > 0.5
