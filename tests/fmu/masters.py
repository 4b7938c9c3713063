"""What the FMU tells and takes in masters of other people: FMPy, libcosim and Ecos, each beside the same steps by plain C calls.

usage: masters.py MOORLINE.fmu MOORLINE

The second is the command, which packs FMUs of scenes with names that are not ASCII. Derivatives, which of
these FMPy alone asks for, are compared with differences there. Needs libcosimpy and ecospy (PyPI), as osp.py and ecos.py do.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from xml.sax.saxutils import quoteattr

import fmpy
from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from master import OK, WARNING, Fmu, Line, surge

STEP = 0.1
# The same numbers in other words: clocks that are sums or nanoseconds differ by their rounding, which may make another choice of steps: results are
# as far apart as the default tolerance allows, and a few times that where a line is torn about.
ALIKE, ROUGHLY = 1e-3, 5e-3


def said_to_fmpy(_, instance, status, category, message):
    print(f"category={(category or b'').decode()} status={status}: {message.decode()}", flush=True)


callbacks = fmi2CallbackFunctions()
callbacks.logger = fmi2CallbackLoggerTYPE(said_to_fmpy)


class Osp:
    """One FMU in libcosim, its inputs overridden at every step."""

    def __init__(self, fmu: pathlib.Path, values: dict, step: float = STEP, start: float = 0.0):
        kinds = {float: "Real", int: "Integer"}
        initial = "".join(
            f"<InitialValue variable={quoteattr(name)}><{kinds[type(value)]} value={quoteattr(repr(value))}/></InitialValue>"
            for name, value in values.items()
        )
        self.folder = tempfile.TemporaryDirectory()
        shutil.copy(fmu, pathlib.Path(self.folder.name, "line.fmu"))
        pathlib.Path(self.folder.name, "OspSystemStructure.xml").write_text(
            '<?xml version="1.0" encoding="UTF-8"?>'
            '<OspSystemStructure xmlns="http://opensimulationplatform.com/MSMI/OSPSystemStructure" version="0.1">'
            f"<StartTime>{start!r}</StartTime><BaseStepSize>{step!r}</BaseStepSize><Algorithm>fixedStep</Algorithm><Simulators>"
            f'<Simulator name="line" source="line.fmu" stepSize="{step!r}"><InitialValues>{initial}</InitialValues></Simulator>'
            "</Simulators></OspSystemStructure>",
            encoding="utf-8",
        )
        self.execution = CosimExecution.from_osp_config_file(osp_path=self.folder.name)
        self.observer, self.manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
        self.execution.add_observer(observer=self.observer)
        self.execution.add_manipulator(manipulator=self.manipulator)
        self.slave = self.execution.slave_index_from_instance_name("line")
        self.reference = {variable.name.decode(): variable.reference for variable in self.execution.slave_variables(self.slave)}

    def set(self, values: dict):
        references = [self.reference[name] for name in values]
        self.manipulator.slave_real_values(slave_index=self.slave, variable_references=references, values=list(values.values()))

    def step(self) -> bool:
        return self.execution.step(step_count=1)

    def real(self, name: str) -> float:
        return self.observer.last_real_values(slave_index=self.slave, variable_references=[self.reference[name]])[0]

    def integer(self, name: str) -> int:
        return self.observer.last_integer_values(slave_index=self.slave, variable_references=[self.reference[name]])[0]

    def close(self):
        self.folder.cleanup()


class Ecos:
    """One FMU in Ecos, its inputs set before every step."""

    def __init__(self, fmu: pathlib.Path, values: dict, step: float = STEP, start: float = 0.0):
        self.structure = EcosSimulationStructure()
        self.structure.add_model("line", fmu)
        self.structure.add_parameter_set("given", {f"line::{name}": value for name, value in values.items()})
        self.simulation = EcosSimulation(step, structure=self.structure)
        assert self.simulation.init(start_time=start, parameter_set="given"), EcosLib.get_last_error()

    def set(self, values: dict):
        for name, value in values.items():
            self.simulation.set_real(f"line::{name}", value)

    def step(self) -> bool:
        before = self.simulation.get_time()
        return self.simulation.step(1) > before

    def real(self, name: str) -> float:
        return self.simulation.get_real(f"line::{name}")

    def integer(self, name: str) -> int:
        return self.simulation.get_integer(f"line::{name}")

    def close(self):
        self.simulation.free()
        self.structure.free()


class Fmpy:
    """One FMU by FMPy's classes, as its scripts use them; warnings as FMPy itself prints them."""

    def __init__(self, fmu: pathlib.Path, values: dict, step: float = STEP, start: float = 0.0):
        description = fmpy.read_model_description(str(fmu), validate=False)
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.folder, self.length, self.start, self.number = fmpy.extract(str(fmu)), step, start, 0
        identifier = description.coSimulation.modelIdentifier
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=self.folder, modelIdentifier=identifier, instanceName="line")
        self.slave.instantiate(callbacks=callbacks)
        self.slave.setupExperiment(startTime=start)
        for name, value in values.items():
            (self.slave.setReal if type(value) is float else self.slave.setInteger)([self.reference[name]], [value])
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set(self, values: dict):
        self.slave.setReal([self.reference[name] for name in values], list(values.values()))

    def step(self) -> bool:
        try:
            self.slave.doStep(self.start + self.number * self.length, self.length)
        except FMICallException:
            return False
        self.number += 1
        return True

    def real(self, name: str) -> float:
        return self.slave.getReal([self.reference[name]])[0]

    def integer(self, name: str) -> int:
        return self.slave.getInteger([self.reference[name]])[0]

    def close(self):
        self.slave.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


class Plain:
    """The same by calls of the C functions, with a clock that is exact."""

    def __init__(self, fmu: pathlib.Path, values: dict, step: float = STEP, start: float = 0.0):
        self.line, self.length, self.start, self.number = Line(Fmu(str(fmu))), step, start, 0
        for kind, setter in ((float, self.line.set_real), (int, self.line.set_integer)):
            given = {name: value for name, value in values.items() if type(value) is kind}
            assert not given or setter(given) == OK, self.line.log
        self.line.start(start=start)

    def set(self, values: dict):
        assert self.line.set_real(values) == OK, self.line.log

    def step(self) -> bool:
        status = self.line.do_step(self.start + self.number * self.length, self.length)
        self.number += status == OK
        return status == OK

    def real(self, name: str) -> float:
        return self.line.get_real(name)[1][0]

    def integer(self, name: str) -> int:
        return self.line.get_integer(name)[1][0]

    def close(self):
        for status, category, text in self.line.log:
            if status == WARNING:
                print(f"category={category}: {text}")
        self.line.free()


MASTERS = (Plain, Fmpy, Osp, Ecos)
# How each writes a warning of an FMU.
MARKS = ("category=logStatusWarning", "fmi2Warning")


@contextlib.contextmanager
def heard():
    """All that is written to the standard output and the standard error meanwhile, by libraries as well."""
    sys.stdout.flush()
    kept, said = [os.dup(1), os.dup(2)], []
    with tempfile.TemporaryFile() as file:
        for number in (1, 2):
            os.dup2(file.fileno(), number)
        try:
            yield said
        finally:
            sys.stdout.flush()
            ctypes.CDLL(None).fflush(None)
            for number, copy in zip((1, 2), kept):
                os.dup2(copy, number)
                os.close(copy)
            file.seek(0)
            said.append(file.read().decode("utf-8", "replace"))


def at(position, velocity, prefix: str = "") -> dict:
    """Inputs of a fairlead; a prefix ends in what parts the words of its names."""
    dot = prefix[-1:] or "."
    given = (("position", position), ("velocity", velocity))
    return {f"{prefix}fairlead{dot}{name}{dot}{axis}": float(x) for name, values in given for axis, x in zip("xyz", values)}


def runs(
    motion,
    steps: int,
    words=(),
    fmu: pathlib.Path | None = None,
    step=STEP,
    start=0.0,
    seen="tension",
    prefix="",
    quiet=False,
    alike=ALIKE,
    masters=MASTERS,
    **given,
):
    """Tensions [N] after each step of a motion in each master, which have to be alike; each of `words` has to be heard once in each, and
    where it is to be `quiet` no warning at all."""
    found = []
    for master in masters:
        with heard() as said:
            values = given | at(*motion(start), prefix)
            host = master(fmu or line_fmu, values, step, start)
            rows = []
            for number in range(steps):
                host.set(at(*motion(start + number * step), prefix))
                if not host.step():
                    break
                rows.append(host.real(seen))
            host.close()
        for word in words:
            assert said[0].count(word) == 1, f"{master.__name__}: {word!r} is said {said[0].count(word)} times in:\n{said[0]}"
        if quiet:
            assert not any(mark in said[0] for mark in MARKS), f"{master.__name__}: {said[0]}"
        found.append(rows)
    for master, rows in zip(masters[1:], found[1:]):
        assert len(rows) == len(found[0]), f"{master.__name__}: {len(rows)} steps of {len(found[0])}"
        off = max(abs(a - b) for a, b in zip(rows, found[0])) / max(found[0])
        assert off < alike, f"{master.__name__}: {off:.1e} off"
    return found[0]


line_fmu, command = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
log_output_level(CosimLogLevel.WARNING)
# Ecos gives what an FMU logs, warnings as well, at this level alone.
EcosLib.set_log_level("debug")
# Where resources lie (12.8): unpacked into folders that are no easy URI, from a file with such a name.
strange = pathlib.Path(tempfile.mkdtemp(), "100 % %20 Ålesund #1")
strange.mkdir()
os.environ["TMPDIR"] = tempfile.tempdir = str(strange)


def still(_):
    return [0.0] * 3, [0.0] * 3


def moving(time: float):
    return surge(time)[:2]


# A quiet run says nothing; the Integers (12.5) arrive.
plain = runs(moving, 300, quiet=True)
for name, value in {"solver.scheme_index": 2, "input.interpolation_index": 3}.items():
    other = runs(moving, 300, quiet=True, **{name: value})
    most = max(abs(a - b) for a, b in zip(plain, other)) / max(plain)
    assert 1e-9 < most < 0.02, (name, most)
    print(f"{name} = {value}: {most:.1e} of the largest tension from what is without it")

# Outputs in initialization mode follow the inputs (12.6): a line that stands begins with the tension of its equilibrium there, and keeps it.
for place in (-5.0, 5.0):
    held = runs(lambda _, x=place: ([x, 2.0, 1.0], [0.0] * 3), 5)
    assert max(held) - min(held) < 1e-6 * held[0] and abs(held[0] / plain[0] - 1.0) > 0.01, held


# And the derivatives there are those of the equilibrium: of FMPy's calls, against forces that settle anew after the input was set.
host = Fmpy(line_fmu, {})
host.slave.reset()
host.slave.setupExperiment(startTime=0.0)
host.slave.enterInitializationMode()
forces = [host.reference[f"force.{axis}"] for axis in "xyz"]
for axis in "xyz":
    name = f"fairlead.position.{axis}"
    exact = host.slave.getDirectionalDerivative(forces, [host.reference[name]], [1.0])
    ends = []
    for change in (1e-3, -1e-3):
        host.set({name: change})
        ends.append(host.slave.getReal(forces))
    host.set({name: 0.0})
    for k, (one, other) in enumerate(zip(*ends)):
        assert abs(exact[k] - (one - other) / 2e-3) < 1e-4 * max(map(abs, exact)), (axis, exact, ends)
print(f"stiffness in initialization mode: {exact[2] / 1e3:.2f} kN/m in z by z")
host.slave.exitInitializationMode()
host.close()


# Velocities of slow motion beside the whole position (12.3) are told, once, and not believed.
def slow(time: float):
    return [2.0 * math.sin(0.05 * time) + math.sin(0.8 * time), 0.0, 0.0], [0.1 * math.cos(0.05 * time), 0.0, 0.0]


def whole(time: float):
    return slow(time)[0], [0.1 * math.cos(0.05 * time) + 0.8 * math.cos(0.8 * time), 0.0, 0.0]


believed, right = (runs(motion, 800, words)[400:] for motion, words in ((slow, ["velocities"]), (whole, [])))
off = math.dist(believed, right) / math.hypot(*right)
print(f"velocities of slow motion alone: {off:.2%} rms")
assert off < 0.02


# Positions with a millimetre of noise: the cut-off arrives, and does its work.
def noise(number: int) -> float:
    return 1e-3 * math.sqrt(12.0) * (math.modf(math.sin(12.9898 * number) * 43758.5453)[0] % 1.0 - 0.5)


def shaken(time: float):
    number = 3 * round(time / STEP)
    return [x + noise(number + axis) for axis, x in enumerate(surge(time)[0])], [0.0] * 3


def rough(rows: list[float]) -> float:
    """What alternates from step to step: the root of the mean square of second differences."""
    return math.sqrt(sum((a - 2.0 * b + c) ** 2 for a, b, c in zip(rows, rows[1:], rows[2:])) / len(rows))


without, filtered = rough(runs(shaken, 600)[300:]), rough(runs(shaken, 600, **{"input.filter": 0.5})[300:])
print(f"1 mm of noise: {without:.0f} N from step to step, filtered {filtered:.0f} N")
assert filtered < 0.1 * without

# Warnings (12.4) are heard, once each.
runs(lambda _: ([70.0, 0.0, 0.0], [0.0] * 3), 5, ["70.0 m from where the scene has it"])
runs(lambda t: ([0.0 if t < 0.95 else 8.0, 0.0, 0.0], [0.0] * 3), 30, ["is given 8.00 m from where its path had led it"], alike=ROUGHLY)
runs(lambda t: ([5.0 * t * t, 0.0, -2.5 * t * t], [10.0 * t, 0.0, -5.0 * t]), 10, ["slack"], alike=ROUGHLY)
runs(lambda t: ([-min(t, 32.0), 0.0, 0.0], [-1.0 if t < 32.0 else 0.0, 0.0, 0.0]), 400, ["lifts its anchor"])
# A step that is not done to its end gives its reason as a warning, because libcosim says nothing of a Discard but that the step failed. Ecos goes
# on, and hears that it may not.
for master in MASTERS:
    with heard() as said:
        host = master(line_fmu, at(*still(0.0)), 3.0)
        for number in range(5):
            host.set(at([0.0] * 3, [-1400.0 if number == 3 else 0.0, 0.0, 0.0]))
            done = host.step()
            assert done == (number < 3) or master is Ecos, (master, number)
            if not done:
                break
        host.close()
    mark = "fmi2Warning" if master is Ecos else "category=logStatusWarning"
    assert any(mark in text and "was done only up to t = " in text and "fairlead" in text for text in said[0].splitlines()), said[0]
    assert master is not Ecos or "not allowed after a discarded step" in said[0], said[0]

# Clocks (12.7): nanoseconds and sums of thirds and thirtieths, from 0 and from later. (Ecos 0.7.2 tells an FMU when it starts, and begins at 0.)
for step, start, steps, masters in ((1 / 30, 0.0, 3000, MASTERS), (1 / 3, 0.0, 300, MASTERS), (1 / 30, 1000.1, 300, MASTERS[:3])):
    assert len(runs(moving, steps, step=step, start=start, alike=ROUGHLY, masters=masters)) == steps

# Names that are not ASCII, flat names, and a load under which a line breaks (12.5, 12.4).
scene = json.loads((pathlib.Path(__file__).parents[2] / "examples/two-lines.json").read_text(encoding="utf-8"))
scene["lines"][0]["name"], scene["lines"][1]["name"] = "R4 Ø84", "係留索"
scene["line_types"]["chain"]["breaking_load"] = 1.5e6
(strange / "scene.json").write_text(json.dumps(scene, ensure_ascii=False), encoding="utf-8")
tensions = []
for options in ([], ["--flat-names"]):
    packed = strange / f"lines {len(options)}.fmu"
    subprocess.run([command, "pack", strange / "scene.json", "-o", packed, *options], check=True, capture_output=True)
    (seen,) = (name for name in Fmu(str(packed)).reference if "R4" in name and name.endswith("tension") and "anchor" not in name)
    prefix = seen.removesuffix("tension")
    assert seen.isascii() and ("." in seen) != bool(options), seen
    print(seen)
    for motion, words in ((still, []), (moving, ["more than its breaking load of 1500.0 kN"])):
        there = lambda time, motion=motion: ([50.0 + motion(time)[0][0], *motion(time)[0][1:]], motion(time)[1])
        tensions.append(runs(there, 600 if words else 5, words, fmu=packed, seen=seen, prefix=prefix))
# The line of the scene, not the built-in one, and the same by either name.
assert tensions[:2] == tensions[2:] and len(tensions[1]) == 600
print(f"R4: {tensions[0][0] / 1e3:.1f} kN at rest, {max(tensions[1]) / 1e3:.1f} kN at most")
shutil.rmtree(strange.parent)
