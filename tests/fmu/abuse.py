"""Every illegal call returns fmi2Error (or no instance), says why, and leaves the instance usable."""

import ctypes as c
import json
import math
import os
import pathlib
import shutil
import sys
import tempfile

from master import DISCARD, ERROR, OK, Callbacks, Fmu, Line, surge

fmu = Fmu(sys.argv[1])
REAL, POSITION, TENSION = c.c_double * 1, fmu.reference["fairlead.position.x"], fmu.reference["tension"]
NAN, INFINITE = math.nan, math.inf
tried = []


def refused(line: Line, what: str, status: int, *words: str, expected: int = ERROR):
    assert status == expected, f"{what}: status {status}, log {line.log}"
    assert line.log, f"{what}: nothing was logged"
    text = line.log[-1][2]
    for word in words:
        assert word in text, f"{what}: {word!r} is not in {text!r}"
    tried.append((what, status, text))
    line.log.clear()


def not_made(what: str, *words: str, **changed):
    line = Line(fmu, **changed)
    assert not line.component, f"{what}: an instance was made"
    if "callbacks" not in changed:
        refused(line, what, ERROR, *words)


# --- Instances that must not be made
not_made("wrong GUID", "{other}", "pack it again", guid=b"{other}")
not_made("no GUID", "fmuGUID", "NULL", guid=None)
not_made("no name", "instanceName", "NULL", name=None)
not_made("empty name", "instanceName", name=b"")
not_made("name that is not UTF-8", "UTF-8", name=b"\xff")
not_made("model exchange", "fmi2CoSimulation", type=0)
not_made("type 7", "fmi2CoSimulation", type=7)
not_made("resources elsewhere", "file: URI", location=b"https://example.org/resources")
with tempfile.TemporaryDirectory() as folder:
    scene = pathlib.Path(folder, "scene.json")
    whole = (fmu.folder / "resources/scene.json").read_text()
    uri = pathlib.Path(folder).as_uri().encode()
    for what, text, word in (
        ("empty scene", "", "scene.json"),
        ("scene cut off", whole[: len(whole) // 2], "scene.json"),
        ("scene with an unknown key", whole.replace('"title"', '"titel"'), "titel"),
        ("scene of another FMU", json.dumps(json.loads(whole) | {"title": "another"}), "pack it again"),
    ):
        scene.write_text(text)
        not_made(what, word, location=uri)
    scene.write_bytes(b"\xff\xfe")
    not_made("scene that is not UTF-8", "scene.json", location=uri)
not_made("no callbacks", callbacks=None)
not_made("no callbacks and wrong GUID", callbacks=None, guid=b"{x}")
without_logger = Callbacks(c.cast(None, type(Line(fmu).logger)), None, None, None, None)
not_made("no logger", callbacks=c.byref(without_logger))

# --- Instances that must be made all the same: where the master does not say where its resources lie, or in a way of its own, the library looks
# where it lies itself
for location in (None, b"", b"file:///nowhere", b"file:///100%25s%25n", b"file:///Z|/fmu/resources", rb"\\?\Z:\fmu\resources"):
    elsewhere = Line(fmu, location=location)
    assert elsewhere.component, location
    elsewhere.free()
odd = Fmu(sys.argv[1], folder=tempfile.mkdtemp(prefix="a%20b "))
plain = Line(odd, location=("file://" + str(odd.folder / "resources")).encode())
assert plain.component, "an unencoded path that holds %20"
plain.free()
shutil.rmtree(odd.folder, ignore_errors=True)
for location in (
    fmu.location,
    fmu.location.replace("file:///", "file:/"),
    "file://" + str(fmu.folder / "resources"),
    str(fmu.folder / "resources"),
):
    line = Line(fmu, location=location.encode())
    assert line.component, f"{location}: {line.log}"
    line.free()
assert fmu.c.fmi2GetVersion() == b"2.0" and fmu.c.fmi2GetTypesPlatform() == b"default"
fmu.c.fmi2FreeInstance(c.c_void_p(None))

# --- NULL instance
nobody = Line(fmu)
nobody.free()
for function in ("fmi2Terminate", "fmi2Reset", "fmi2EnterInitializationMode", "fmi2ExitInitializationMode", "fmi2CancelStep"):
    assert nobody.call(function) == ERROR
assert nobody.do_step(0.0, 0.1) == ERROR

# --- Before initialization
line = Line(fmu)
refused(line, "step before initialization", line.do_step(0.0, 0.1), "not allowed before fmi2EnterInitializationMode")
refused(line, "leave initialization before entering", line.call("fmi2ExitInitializationMode"), "not allowed")
refused(line, "terminate before start", line.call("fmi2Terminate"), "not allowed")
refused(line, "output before initialization", line.get_real("tension")[0], "tension", "no value")
refused(line, "local before initialization", line.get_integer("solver.substeps")[0], "solver.substeps")
refused(
    line,
    "output derivative before initialization",
    line.call("fmi2GetRealOutputDerivatives", None, c.c_size_t(0), None, None),
    "not allowed",
)
for start in (NAN, INFINITE):
    refused(line, f"start time {start}", line.setup(start), "startTime")
refused(line, "stop before start", line.setup(10.0, 5.0), "stopTime", "10.0")
refused(line, "stop time NaN", line.setup(0.0, NAN), "stopTime")
refused(line, "tolerance -1", line.setup(0.0, None, -1.0), "tolerance")
refused(line, "tolerance NaN", line.setup(0.0, None, NAN), "tolerance")

# --- Setting what cannot be set
refused(line, "unknown reference", line.set_real({4711: 1.0}), "4711", "modelDescription.xml")
refused(line, "Integer as Real", line.set_real({"line.elements": 1.0}), "Real")
refused(line, "Real as Integer", line.set_integer({"line.length": 1}), "Integer")
refused(line, "output set", line.set_real({"tension": 1.0}), "tension", "an output")
refused(line, "local set", line.set_real({"solver.error_estimate": 1.0}), "solver.error_estimate", "local")
for name, value in (
    ("line.length", 0.0),
    ("line.length", -1.0),
    ("line.length", NAN),
    ("line.ea", 0.0),
    ("line.ea", INFINITE),
    ("line.mass", -1.0),
    ("line.diameter", 0.0),
    ("line.damping", -1e-3),
    ("water.depth", 0.0),
    ("seabed.stiffness", -1.0),
    ("seabed.friction", -0.1),
    ("solver.tolerance", 1.0),
    ("solver.max_step", 0.0),
    ("fairlead.position.z", NAN),
    ("fairlead.velocity.y", INFINITE),
    ("fairlead.position.x", 1e300),
    ("line.submerged_weight", NAN),
    ("anchor.position.y", -INFINITE),
):
    refused(line, f"{name} = {value}", line.set_real({name: value}), name, "must be a number from")
for name, value in (("line.elements", -1), ("solver.scheme", 0), ("solver.scheme", 5), ("input.interpolation", 9)):
    refused(line, f"{name} = {value}", line.set_integer({name: value}), name)
before = line.get_real("fairlead.position.x", "fairlead.position.y")
refused(
    line,
    "one of two values wrong",
    line.set_real({"fairlead.position.x": 9.0, "fairlead.position.y": NAN}),
    "fairlead.position.y",
)
assert line.get_real("fairlead.position.x", "fairlead.position.y") == before, "half of the values was set"
for what, function in (
    ("Boolean", "fmi2GetBoolean"),
    ("String", "fmi2GetString"),
    ("Boolean", "fmi2SetBoolean"),
    ("String", "fmi2SetString"),
):
    refused(line, f"{function} of a Real", line.call(function, line.references([0]), c.c_size_t(1), None), what)
    assert line.call(function, None, c.c_size_t(0), None) == OK
for function in ("fmi2GetReal", "fmi2SetReal", "fmi2GetInteger", "fmi2SetInteger"):
    refused(line, f"{function} without references", line.call(function, None, c.c_size_t(1), REAL()), "vr is NULL")
    refused(
        line, f"{function} without values", line.call(function, line.references([POSITION]), c.c_size_t(1), None), "value is NULL"
    )
    assert line.call(function, None, c.c_size_t(0), None) == OK

# --- Logging
refused(line, "unknown category", line.call("fmi2SetDebugLogging", 1, c.c_size_t(1), (c.c_char_p * 1)(b"100%s")), "100%%s")
refused(line, "no categories", line.call("fmi2SetDebugLogging", 1, c.c_size_t(1), None), "categories is NULL")
refused(line, "category NULL", line.call("fmi2SetDebugLogging", 1, c.c_size_t(1), (c.c_char_p * 1)(None)), "category is NULL")
assert line.call("fmi2SetDebugLogging", 1, c.c_size_t(1), (c.c_char_p * 1)(b"logEvents")) == OK

# --- In initialization mode: a line that cannot be
assert line.setup(0.0, 20.0) == OK
assert line.call("fmi2EnterInitializationMode") == OK
refused(line, "initialization twice", line.call("fmi2EnterInitializationMode"), "in initialization mode")
refused(line, "setup in initialization", line.setup(), "not allowed")
refused(line, "step in initialization", line.do_step(0.0, 0.1), "not allowed")
assert line.set_real({"anchor.position.z": -200.0}) == OK
refused(line, "anchor below the bed", line.get_real("tension")[0], "anchor")
assert line.set_real({"anchor.position.z": -120.0, "line.length": 1.0}) == OK
refused(line, "line of 1 m over 1190 m", line.get_real("tension")[0], "line.length")
assert line.set_real({"line.length": 1200.0, "line.submerged_weight": 2000.0}) == OK
refused(line, "heavier in water than in air", line.get_real("tension")[0], "line.submerged_weight", "weight in air")
assert line.set_real({"line.submerged_weight": 1157.0, "fairlead.position.z": -130.0}) == OK
refused(line, "fairlead below the bed", line.get_real("tension")[0], "fairlead.position")
assert line.set_real({"fairlead.position.z": 0.0, "water.depth": 50.0}) == OK
refused(line, "water less deep than the anchor", line.get_real("tension")[0], "anchor.position")
assert line.set_real({"water.depth": 120.0, "line.length": 1.0}) == OK
refused(line, "start with a line of 1 m", line.call("fmi2ExitInitializationMode"), "line.length")
refused(line, "step after a failed start", line.do_step(0.0, 0.1), "after an error")
refused(line, "state after an error", line.get_state()[0], "after an error")
refused(line, "terminate after an error", line.call("fmi2Terminate"), "after an error")
assert line.call("fmi2Reset") == OK
line.log.clear()
line.start(surge, stop=20.0)
assert any("equilibrium" in text for _, _, text in line.log), line.log

# --- Steps
for step in (0.0, -0.1, NAN, INFINITE, -INFINITE, 1e300, 1e-300):
    refused(line, f"step of {step}", line.do_step(0.0, step), "communicationStepSize")
for time in (0.05, -0.1, 2e-3, NAN, INFINITE):
    refused(line, f"step from {time} instead of 0", line.do_step(time, 0.1), "currentCommunicationPoint")
refused(line, "step past the stop time", line.do_step(0.0, 20.1), "20.0", "stop time")
refused(line, "parameter after the start", line.set_real({"line.length": 1300.0}), "line.length", "fixed")
refused(line, "initialization after the start", line.call("fmi2EnterInitializationMode"), "not allowed")
refused(line, "cancel", line.call("fmi2CancelStep"), "no step")
assert line.step(surge) == OK
refused(line, "the same step again", line.do_step(0.0, 0.1), "stands at t = 0.1")
assert line.do_step(0.1 * (1 + 1e-12), 0.1) == OK, "a rounded time was refused"
line.time = 0.2

# --- Derivatives
one, order = REAL(1.0), c.c_int * 1


def set_derivative(name, n, value=1.0):
    return line.call("fmi2SetRealInputDerivatives", line.references([name]), c.c_size_t(1), order(n), REAL(value))


refused(line, "derivative of an output set", set_derivative("tension", 1), "tension")
refused(line, "input derivative of order 0", set_derivative("fairlead.position.x", 0), "orders 1 and 2")
refused(line, "input derivative of order 3", set_derivative("fairlead.position.x", 3), "orders 1 and 2")
refused(line, "input derivative NaN", set_derivative("fairlead.velocity.z", 1, NAN), "fairlead.velocity.z")
refused(line, "input derivative of nothing", set_derivative(4711, 1), "4711")
refused(
    line,
    "input derivative NULL",
    line.call("fmi2SetRealInputDerivatives", line.references([0]), c.c_size_t(1), None, one),
    "order is NULL",
)


def get_derivative(name, n):
    return line.call("fmi2GetRealOutputDerivatives", line.references([name]), c.c_size_t(1), order(n), REAL())


assert get_derivative("tension", 1) == OK
refused(line, "output derivative of order 2", get_derivative("tension", 2), "order 1")
refused(line, "output derivative of an input", get_derivative("fairlead.position.x", 1), "fairlead.position.x")


def direction(unknown, known, seed=1.0, n=1):
    result = REAL()
    return line.call(
        "fmi2GetDirectionalDerivative",
        line.references([unknown]),
        c.c_size_t(n),
        line.references([known]),
        c.c_size_t(n),
        REAL(seed),
        result,
    )


refused(line, "direction from an output", direction("force.x", "force.y"), "force.y", "position and velocity")
refused(line, "direction of an input", direction("fairlead.position.x", "fairlead.position.x"), "Real outputs")
refused(line, "direction of a parameter", direction("line.length", "fairlead.position.x"), "line.length")
refused(line, "direction NaN", direction("force.x", "fairlead.position.x", NAN), "fairlead.position.x")
refused(line, "direction of nothing", direction(4711, "fairlead.position.x"), "4711")

# --- Status
number, real = c.c_int(), c.c_double()
assert line.call("fmi2GetStatus", 0, c.byref(number)) == OK and number.value == OK
assert line.call("fmi2GetRealStatus", 2, c.byref(real)) == OK and abs(real.value - 0.2) < 1e-9
assert line.call("fmi2GetBooleanStatus", 3, c.byref(number)) == OK and number.value == 0
refused(line, "status of kind 9", line.call("fmi2GetStatus", 9, c.byref(number)), "9")
refused(line, "status of kind -1", line.call("fmi2GetIntegerStatus", -1, c.byref(number)), "-1")
refused(line, "status NULL", line.call("fmi2GetStatus", 0, None), "value is NULL")
refused(line, "pending status", line.call("fmi2GetStringStatus", 1, None), "not available", expected=DISCARD)
refused(line, "integer status", line.call("fmi2GetIntegerStatus", 2, None), "not available", expected=DISCARD)

# --- States
status, state = line.get_state()
assert status == OK and state.value
data = line.serialize(state)
refused(
    line,
    "buffer too small",
    line.call("fmi2SerializeFMUstate", state, (c.c_char * 10)(), c.c_size_t(10)),
    "10 bytes",
    str(len(data)),
)
refused(line, "size NULL", line.call("fmi2SerializedFMUstateSize", state, None), "size is NULL")
refused(line, "set no state", line.set_state(None), "NULL")
refused(line, "set a foreign state", line.set_state(c.c_void_p(0x1234)), "does not belong")
refused(
    line,
    "serialize a foreign state",
    line.call("fmi2SerializedFMUstateSize", c.c_void_p(0x1234), c.byref(c.c_size_t())),
    "does not belong",
)
refused(line, "get into NULL", line.call("fmi2GetFMUstate", None), "FMUstate is NULL")
other = Line(fmu).start(surge)
refused(other, "state of another instance", other.set_state(state), "does not belong")
other.free()
freed = c.c_void_p(state.value)
assert line.free_state(state) == OK and not state.value, "the handle is not NULL after freeing"
assert line.free_state(state) == OK and line.call("fmi2FreeFMUstate", None) == OK
refused(line, "free twice", line.free_state(freed), "freed")
refused(line, "set a freed state", line.set_state(freed), "freed")
refused(line, "empty blob", line.deserialize(b"")[0], "not written by moorline")
refused(line, "foreign blob", line.deserialize(b"hello world, this is not a state")[0], "not written by moorline")
refused(line, "blob cut off", line.deserialize(data[:-1])[0], "refused")
refused(line, "blob with a byte more", line.deserialize(data + b"x")[0], "refused")
for position in range(0, len(data), max(1, len(data) // 200)):
    damaged = bytearray(data)
    damaged[position] ^= 1
    refused(line, "blob with one bit wrong", line.deserialize(bytes(damaged))[0], "refused")
    tried.pop()
refused(line, "blob NULL", line.call("fmi2DeSerializeFMUstate", None, c.c_size_t(8), c.byref(c.c_void_p())), "NULL")
refused(line, "blob to NULL", line.call("fmi2DeSerializeFMUstate", data, c.c_size_t(len(data)), None), "NULL")

# --- A fairlead torn away: no step, or part of one, never OK; and back
status, state = line.get_state()
assert line.set_real({"fairlead.position.x": -1e6, "fairlead.velocity.x": -9e3}) == OK
status = line.do_step(0.2, 0.1)
assert status in (ERROR, DISCARD), f"torn away by 1000 km in 0.1 s: status {status}"
tried.append(("fairlead torn away by 1000 km", status, line.log[-1][2]))
assert line.call("fmi2GetRealStatus", 2, c.byref(real)) == OK and 0.2 <= real.value < 0.3
refused(line, "step after a failed step", line.do_step(0.2, 0.1), "not allowed after")
assert line.set_state(state) == OK
assert line.step(surge) == OK, line.log
assert all(math.isfinite(value) for value in line.outputs())

# --- A step that can be done in part: the fairlead leaves the line's reach on the way
assert line.set_real({"fairlead.velocity.x": -1400.0}) == OK
begin, (_, before) = line.time, line.get_state()
refused(
    line,
    "fairlead out of reach after half a step",
    line.do_step(begin, 3.0),
    "done only up to",
    "more than twice the 1200.0 m of line",
    expected=DISCARD,
)
assert line.call("fmi2GetStatus", 0, c.byref(number)) == OK and number.value == DISCARD
assert line.call("fmi2GetRealStatus", 2, c.byref(real)) == OK and begin < real.value < begin + 3.0
reached = real.value
refused(line, "step after a discarded step", line.do_step(reached, 0.1), "after a discarded step")
refused(line, "inputs after a discarded step", line.set_real({"fairlead.velocity.x": 0.0}), "after a discarded step")
assert line.get_real("tension")[1][0] > 1e8 and all(math.isfinite(value) for value in line.outputs())
assert line.set_state(before) == OK
assert line.do_step(begin, reached - begin) == OK, "the part that was done cannot be done as a step"
assert line.set_state(before) == OK and line.set_real({"fairlead.velocity.x": 0.0}) == OK
assert line.step(surge) == OK, line.log

# --- The end
assert line.call("fmi2Terminate") == OK
refused(line, "step after the end", line.do_step(line.time, 0.1), "after fmi2Terminate")
refused(line, "set after the end", line.set_real({"fairlead.position.x": 0.0}), "after fmi2Terminate")
assert line.get_real("tension")[0] == OK
line.time = 0.2
assert line.set_state(state) == OK and line.step(surge) == OK, "a state does not bring a terminated line back"
line.free()
shutil.rmtree(fmu.folder, ignore_errors=True)
os.write(
    1, "".join(f"{what}: {('OK', 'Warning', 'Discard', 'Error')[status]}: {text}\n" for what, status, text in tried).encode()
)
