"""Two lines in one FMU: what each of them gives is what an FMU with that line alone gives, to the bit (both scenes have the same motion, for
which their meshes are made); a failure of one leaves both usable."""

import pathlib
import sys

from fmpy import read_model_description
from fmpy.validation import validate_fmu
from master import ERROR, OK, Fmu, Line, surge

STRIDE = 1_000_000
path = pathlib.Path(sys.argv[1]).with_name("two-lines.fmu")
problems = validate_fmu(str(path))
assert not problems, problems
names = {variable.name: variable for variable in read_model_description(str(path)).modelVariables}
for name, reference in {
    "bow.tension": 10,
    "stern.tension": STRIDE + 10,
    "stern.fairlead.velocity.z": STRIDE + 5,
    "stern.solver.substeps": STRIDE + 30,
    "stern.line.length": STRIDE + 44,
    "solver.scheme": 40,
    "input.interpolation": 43,
    "water.depth": 59,
    "seabed.stiffness": 61,
}.items():
    assert names[name].valueReference == reference, name
assert "tension" not in names and "bow.water.depth" not in names
ports = path.with_name("two-lines_OspModelDescription.xml").read_text(encoding="utf-8")
assert 'name="stern.fairlead"' in ports and 'ref="bow.force.x"' in ports

both, alone = Fmu(str(path)), Fmu(sys.argv[1])
ENDS = {"bow": (50.0, 1233.97), "stern": (-50.0, -1233.97)}


def move(line: Line, prefix: str, origin: float, time: float):
    position, velocity = surge(time)[:2]
    values = {f"{prefix}fairlead.position.{axis}": x for axis, x in zip("xyz", [origin + position[0], *position[1:]])}
    values |= {f"{prefix}fairlead.velocity.{axis}": v for axis, v in zip("xyz", velocity)}
    assert line.set_real(values) == OK, line.log


def initialized(line: Line, origins: dict) -> Line:
    assert line.setup() == OK and line.call("fmi2EnterInitializationMode") == OK
    for prefix, origin in origins.items():
        move(line, prefix, origin, 0.0)
    assert line.call("fmi2ExitInitializationMode") == OK, line.log
    return line


def single(end: str, length: float) -> Line:
    line = Line(alone)
    fairlead, anchor = ENDS[end]
    assert line.set_real({"anchor.position.x": anchor, "line.length": length}) == OK
    return initialized(line, {"": fairlead})


def step(line: Line, origins: dict, size: float = 0.1) -> int:
    for prefix, origin in origins.items():
        move(line, prefix, origin, line.time)
    status = line.do_step(line.time, size)
    if status == OK:
        line.time += size
    return status


double = Line(both, logging=True)
assert double.set_real({"stern.line.length": 1205.0}) == OK
origins = {f"{end}.": fairlead for end, (fairlead, _) in ENDS.items()}
initialized(double, origins)
assert any("stern.static equilibrium" in text for _, _, text in double.log), double.log
singles = {"bow.": single("bow", 1200.0), "stern.": single("stern", 1205.0)}
OUTPUTS = alone.outputs


def values(prefix: str) -> list[float]:
    status, found = double.get_real(*(prefix + name for name in OUTPUTS))
    assert status == OK
    return found


def compare():
    for prefix, line in singles.items():
        assert values(prefix) == line.outputs(), prefix


compare()
for size in [0.1] * 30 + [0.03, 0.5, 0.01, 0.2]:
    assert step(double, origins, size) == OK, double.log
    for prefix, line in singles.items():
        assert step(line, {"": origins[prefix]}, size) == OK
    compare()


def directional(line: Line, unknown: str, known: str) -> float:
    status, changes = line.directional([unknown], known)
    assert status == OK, line.log
    return changes[0]


for prefix, line in singles.items():
    other = next(name for name in singles if name != prefix)
    for known in ("fairlead.velocity.x", "fairlead.position.z"):
        assert directional(double, prefix + "tension", prefix + known) == directional(line, "tension", known) != 0.0
        assert directional(double, prefix + "tension", other + known) == 0.0, "one line answers to the other's fairlead"

# Asked again, the derivative is the same; where another input is set, it is that of the new step.
first = directional(double, "stern.tension", "stern.fairlead.velocity.x")
assert directional(double, "stern.tension", "stern.fairlead.velocity.x") == first
assert double.set_real({"stern.fairlead.velocity.x": 3.0}) == OK
assert directional(double, "stern.tension", "stern.fairlead.velocity.x") != first

# State, bytes, and a failure of the second line: the first is as it was, and both go on after going back.
status, state = double.get_state()
assert status == OK
data = double.serialize(state)
before, begin = values("bow."), double.time


def go_on() -> list:
    double.time = begin
    for _ in range(5):
        assert step(double, origins) == OK, double.log
    return values("bow.") + values("stern.")


expected = go_on()
assert double.set_state(state) == OK and go_on() == expected
assert double.set_state(state) == OK
double.time = begin
move(double, "bow.", 50.0, begin)
assert double.set_real({"stern.fairlead.position.x": 1e6, "stern.fairlead.velocity.x": 9e3}) == OK
assert double.do_step(begin, 0.1) == ERROR
assert "stern" in double.log[-1][2], double.log[-1]
assert values("bow.") == before, "the first line moved although the second failed"
assert double.set_state(state) == OK and go_on() == expected, "after a failed step the lines go on differently"
status, again = double.deserialize(data)
assert status == OK and double.set_state(again) == OK and go_on() == expected
assert double.call("fmi2Reset") == OK and double.set_state(again) == OK and go_on() == expected

# Errors name the line, and shared quantities go by the FMU's own names.
for changes, words in {
    ("stern.line.length", 400.0): ("stern.line.length", '"stern"'),
    ("stern.anchor.position.z", -130.0): ("stern.anchor.position", "water.depth"),
    ("water.depth", 50.0): ("bow.anchor.position", "water.depth"),
}.items():
    wrong = Line(both)
    assert wrong.set_real(dict([changes])) == OK
    assert wrong.setup() == OK and wrong.call("fmi2EnterInitializationMode") == OK
    assert wrong.call("fmi2ExitInitializationMode") == ERROR
    message = wrong.log[-1][2]
    assert all(word in message for word in words) and "environment.depth" not in message, message
    wrong.free()
print("two lines in one FMU are two lines in two, to the bit")
