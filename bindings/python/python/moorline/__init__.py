"""moorline: statics and dynamics of mooring lines, and of all that moors a ship.

A scene is a dict with the keys of a scene file, the path of one, or None for the built-in case; ``changes`` puts values into it before it is
checked, such as ``{"run.duration": 60}``. Paths inside a dict are relative to the working directory. Axes: z up, still water at z = 0; SI units, angles in radians
unless a name says deg. Forces are those of a line on what holds its end. Failures are `moorline.Error`.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from moorline import _moorline, _results
from moorline._errors import ConvergenceError, Error, InputError, Warning
from moorline._mooring import Linearised, Mooring
from moorline._moorline import __version__
from moorline._results import BodyResults, BodyStatics, Fit, LineResults, LineStatics, Offsets, Results, Statics
from moorline._scene import Scene, source, warn
from moorline._sweep import sweep

__all__ = [
    "BodyResults",
    "BodyStatics",
    "ConvergenceError",
    "Error",
    "Fit",
    "InputError",
    "LineResults",
    "LineStatics",
    "Linearised",
    "Mooring",
    "Offsets",
    "Results",
    "Scene",
    "Statics",
    "Warning",
    "__version__",
    "check",
    "fit",
    "offsets",
    "pack",
    "run",
    "schema",
    "statics",
    "sweep",
]

_Changes = Optional[Mapping[str, Any]]


def check(scene: Scene = None, changes: _Changes = None) -> dict[str, Any]:
    """The scene as it is understood, with all its defaults. Raises `InputError` where it is not allowed."""
    text, warnings = _moorline.check(source(scene, changes))
    warn(warnings)
    understood: dict[str, Any] = json.loads(text)
    return understood


def statics(scene: Scene = None, changes: _Changes = None) -> Statics:
    """The equilibrium of a scene, from which `run` starts.

    Raises `InputError`, and `ConvergenceError` where there is none; its ``results`` then hold the best state found."""
    text, warnings, failure = _moorline.statics(source(scene, changes))
    warn(warnings)
    found = _results.statics(json.loads(text))
    if failure is not None:
        failure.results = found  # type: ignore[attr-defined]
        raise failure
    return found


def run(
    scene: Scene = None,
    changes: _Changes = None,
    progress: Callable[[float, float], object] | None = None,
    vtk: str | os.PathLike[str] | None = None,
) -> Results:
    """Statics, then dynamics; the rows are those of the command's timeseries.csv.

    ``progress`` is called with the time reached and the last time [s], some twenty times a second; what it raises ends the run, and so does
    Ctrl-C. Other threads go on meanwhile. ``vtk`` is a directory for ParaView: the snapshots as lines.pvd, and bodies.pvd where there are
    bodies or free points. Raises `InputError`, and `ConvergenceError` whose ``results`` hold what came before."""
    arrays, failure = _moorline.run(source(scene, changes), progress, vtk)
    found = _results.results(arrays, json.loads(arrays["summary"]))
    warn(found.warnings)
    if failure is not None:
        failure.results = found  # type: ignore[attr-defined]
        raise failure
    return found


def offsets(scene: Scene, body: str, way: str, values: ArrayLike, changes: _Changes = None) -> Offsets:
    """What the mooring does to a body that is held aside from its equilibrium: ``way`` is x, y, z (values [m]) or roll, pitch, yaw ([deg]).

    ``values`` is (n,); offsets that the mooring does not reach are left out with a `Warning`."""
    wanted = np.atleast_1d(np.asarray(values, dtype=float))
    if wanted.ndim != 1 or not np.isfinite(wanted).all():
        raise InputError("values: offsets are a list of finite numbers")
    found, lost = _moorline.offsets(source(scene, changes), body, way, wanted.tolist())
    warn(lost)
    tension = dict(zip(found["lines"], found["tension"].T))
    return Offsets(offset=found["offset"], force=found["force"], moment=found["moment"], tension=tension)


def fit(scene: Scene, change: str, until: str, value: float, between: tuple[float, float] | None = None, changes: _Changes = None) -> Fit:
    """The value at a place of the scene that gives a wanted static result, such as a pretension.

    ``change``: the place, such as ``lines[0].sections[0].length``; ``until``: the result, such as ``bow.tension``; ``value``: what it is to be
    [SI]; ``between``: where to look, without it from a quarter to four times the present value. Raises `InputError` where there is none."""
    range = None if between is None else f"{float(between[0])!r}:{float(between[1])!r}"
    text, found, before, reached, warning = _moorline.fit(source(scene, changes), change, f"{until}={float(value)!r}", range)
    warn([] if warning is None else [warning])
    return Fit(scene=json.loads(text), value=found, before=before, reached=reached)


def pack(
    scene: Scene = None,
    path: str | os.PathLike[str] = "moorline.fmu",
    changes: _Changes = None,
    name: str | None = None,
    flat_names: bool = False,
) -> Path:
    """Writes the scene as an FMU (FMI 2.0 co-simulation) for the platform of this package; needs no compiler. Returns its path.

    ``name`` is the FMU's modelName, without it that of the scene's file or of the FMU. ``flat_names``: names of variables without dots.
    The description of its port for the Open Simulation Platform lies beside it."""
    path = Path(path)
    if name is None:
        name = Path(scene).stem if isinstance(scene, (str, os.PathLike)) else path.stem
    name = re.sub(r"[^A-Za-z0-9_.-]", "_", name)
    _moorline.pack(source(scene, changes), name, flat_names, path)
    return path


def schema() -> dict[str, Any]:
    """The JSON Schema of a scene."""
    found: dict[str, Any] = json.loads(_moorline.schema())
    return found
