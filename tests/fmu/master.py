"""A master that may do everything wrong: the C functions of the FMU, called as they are."""

from __future__ import annotations

import ctypes as c
import itertools
import math
import pathlib
import subprocess
import sys
import tempfile
import zipfile
from xml.etree import ElementTree

OK, WARNING, DISCARD, ERROR, FATAL = range(5)
STEP = 0.1

LOGGER = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p)


class Callbacks(c.Structure):
    _fields_ = [
        ("logger", LOGGER),
        ("allocate", c.c_void_p),
        ("free", c.c_void_p),
        ("finished", c.c_void_p),
        ("environment", c.c_void_p),
    ]


class Fmu:
    """An unpacked FMU with its library loaded."""

    def __init__(self, path: str, folder: str | None = None):
        self.folder = pathlib.Path(folder or tempfile.mkdtemp(prefix="moorline fmu {100%} "))
        with zipfile.ZipFile(path) as archive:
            archive.extractall(self.folder)
        self.location = (self.folder / "resources").as_uri()
        root = ElementTree.parse(self.folder / "modelDescription.xml").getroot()
        self.guid = root.attrib["guid"]
        variables = root.find("ModelVariables")
        self.reference = {v.attrib["name"]: int(v.attrib["valueReference"]) for v in variables}
        self.outputs = [v.attrib["name"] for v in variables if v.attrib["causality"] == "output"]
        if sys.platform == "win32":
            library = "win64/moorline.dll"
        elif sys.platform == "darwin":
            library = "darwin64/moorline.dylib"
        else:
            library = "linux64/moorline.so"
        self.c = c.CDLL(str(self.folder / "binaries" / library))
        self.c.fmi2Instantiate.restype = c.c_void_p
        self.c.fmi2FreeInstance.restype = None
        for name in ("fmi2GetTypesPlatform", "fmi2GetVersion"):
            getattr(self.c, name).restype = c.c_char_p


class Line:
    """One instance. Methods return the status; `log` holds what the FMU said."""

    def __init__(self, fmu: Fmu, logging: bool = False, **changed):
        self.fmu, self.log = fmu, []
        self.logger = LOGGER(lambda _, name, status, category, text: self.log.append((status, category.decode(), text.decode())))
        self.callbacks = Callbacks(self.logger, None, None, None, None)
        given = {
            "name": b"line",
            "type": 1,
            "guid": fmu.guid.encode(),
            "location": fmu.location.encode(),
            "callbacks": c.byref(self.callbacks),
        } | changed
        self.component = fmu.c.fmi2Instantiate(
            given["name"], given["type"], given["guid"], given["location"], given["callbacks"], 0, int(logging)
        )
        self.time = 0.0

    def call(self, function: str, *arguments) -> int:
        return getattr(self.fmu.c, function)(c.c_void_p(self.component), *arguments)

    def free(self):
        self.fmu.c.fmi2FreeInstance(c.c_void_p(self.component))
        self.component = None

    def references(self, names):
        return (c.c_uint * len(names))(*[n if isinstance(n, int) else self.fmu.reference[n] for n in names])

    def set_real(self, values: dict) -> int:
        names = list(values)
        return self.call(
            "fmi2SetReal", self.references(names), c.c_size_t(len(names)), (c.c_double * len(names))(*values.values())
        )

    def set_integer(self, values: dict) -> int:
        names = list(values)
        return self.call(
            "fmi2SetInteger", self.references(names), c.c_size_t(len(names)), (c.c_int * len(names))(*values.values())
        )

    def get_real(self, *names) -> tuple[int, list[float]]:
        values = (c.c_double * len(names))()
        status = self.call("fmi2GetReal", self.references(names), c.c_size_t(len(names)), values)
        return status, list(values)

    def get_integer(self, *names) -> tuple[int, list[int]]:
        values = (c.c_int * len(names))()
        status = self.call("fmi2GetInteger", self.references(names), c.c_size_t(len(names)), values)
        return status, list(values)

    def directional(self, unknowns: list[str], known: str, seed: float = 1.0) -> tuple[int, list[float]]:
        """Changes of unknowns with a known, by fmi2GetDirectionalDerivative."""
        changes = (c.c_double * len(unknowns))()
        references = self.references(unknowns), c.c_size_t(len(unknowns)), self.references([known]), c.c_size_t(1)
        return self.call("fmi2GetDirectionalDerivative", *references, (c.c_double * 1)(seed), changes), list(changes)

    def rates(self, outputs: list[str]) -> list[float]:
        """First derivatives of outputs in time."""
        count, found = len(outputs), (c.c_double * len(outputs))()
        orders = (c.c_int * count)(*[1] * count)
        status = self.call("fmi2GetRealOutputDerivatives", self.references(outputs), c.c_size_t(count), orders, found)
        assert status == OK, self.log
        return list(found)

    def outputs(self) -> list[float]:
        status, values = self.get_real(*self.fmu.outputs)
        assert status == OK, self.log
        return values

    def setup(self, start: float = 0.0, stop: float | None = None, tolerance: float | None = None) -> int:
        return self.call(
            "fmi2SetupExperiment",
            int(tolerance is not None),
            c.c_double(tolerance or 0.0),
            c.c_double(start),
            int(stop is not None),
            c.c_double(stop or 0.0),
        )

    def start(self, motion=None, start: float = 0.0, stop: float | None = None) -> Line:
        """Through initialization, with the fairlead where the motion begins."""
        assert self.setup(start, stop) == OK, self.log
        assert self.call("fmi2EnterInitializationMode") == OK
        if motion:
            self.move(motion, start)
        assert self.call("fmi2ExitInitializationMode") == OK, self.log
        self.time = start
        return self

    def move(self, motion, time: float, velocities: bool = True):
        """Inputs of a motion: position and velocity of the fairlead, or all inputs by name."""
        said = motion(time)
        if isinstance(said, dict):
            assert self.set_real(said) == OK, self.log
            return
        position, velocity = said[:2]
        values = {f"fairlead.position.{a}": x for a, x in zip("xyz", position)}
        if velocities:
            values |= {f"fairlead.velocity.{a}": v for a, v in zip("xyz", velocity)}
        assert self.set_real(values) == OK, self.log

    def do_step(self, time: float, step: float) -> int:
        return self.call("fmi2DoStep", c.c_double(time), c.c_double(step), 1)

    def step(self, motion, step: float = STEP, velocities: bool = True) -> int:
        """Inputs at the present time, and a step."""
        self.move(motion, self.time, velocities)
        status = self.do_step(self.time, step)
        if status == OK:
            self.time += step
        return status

    def get_state(self, state: c.c_void_p | None = None) -> tuple[int, c.c_void_p]:
        state = state or c.c_void_p()
        return self.call("fmi2GetFMUstate", c.byref(state)), state

    def set_state(self, state) -> int:
        return self.call("fmi2SetFMUstate", state)

    def free_state(self, state) -> int:
        return self.call("fmi2FreeFMUstate", c.byref(state))

    def serialize(self, state) -> bytes:
        size = c.c_size_t()
        assert self.call("fmi2SerializedFMUstateSize", state, c.byref(size)) == OK, self.log
        buffer = (c.c_char * size.value)()
        assert self.call("fmi2SerializeFMUstate", state, buffer, size) == OK, self.log
        return bytes(buffer)

    def deserialize(self, data: bytes) -> tuple[int, c.c_void_p]:
        state = c.c_void_p()
        return self.call("fmi2DeSerializeFMUstate", data, c.c_size_t(len(data)), c.byref(state)), state


def in_another_process(state: bytes, begin: float) -> str:
    """What the script at hand prints in another process that is given a state and the time from which to go on."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "state")
        file.write_bytes(state)
        command = [sys.executable, sys.argv[0], sys.argv[1], str(file), begin.hex()]
        other = subprocess.run(command, capture_output=True, text=True, check=False)
        assert other.returncode == 0, other.stderr
        return other.stdout.strip()


def motion_of(fmu: Fmu):
    """A motion of what the FMU drives, as `Line.move` takes it: of its fairlead, or of a vessel called `ship`."""
    if "fairlead.position.x" in fmu.reference:
        return surge
    names = [f"ship.{quantity}.{axis}" for quantity in ("position", "velocity") for axis in "xyz"]
    return lambda time: dict(zip(names, itertools.chain(*surge(time)[:2])))


def surge(time: float):
    """The built-in case's motion: position, velocity, acceleration."""
    w, ramp = 2 * math.pi / 15, 48.75
    xi = min(time / ramp, 1.0)
    s, s1, s2 = xi * xi * (3 - 2 * xi), 6 * xi * (1 - xi) / ramp, (6 - 12 * xi) / ramp**2 if time < ramp else 0.0
    sin, cos = math.sin(w * time), math.cos(w * time)
    amplitudes = (5.08, 2.1, 0.0)
    return (
        [a * s * sin for a in amplitudes],
        [a * (s1 * sin + s * w * cos) for a in amplitudes],
        [a * (s2 * sin + 2 * s1 * w * cos - s * w * w * sin) for a in amplitudes],
    )
