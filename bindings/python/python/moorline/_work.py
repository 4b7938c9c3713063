"""What a worker of a sweep does: some runs, one after the other, and what is kept of them. It needs NumPy alone."""

from __future__ import annotations

import json
import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy import float64
from numpy.typing import NDArray

from moorline import _moorline, _results
from moorline._errors import Error, Warning
from moorline._scene import Parts, sourced

NOT_RUN, DONE, FAILED = 0, 1, 2
"""The states of a row."""

Outcome = Callable[[Any], Mapping[str, Any]]
"""What is kept of a run: from its results to numbers by name, or (names of dimensions, numbers)."""


@dataclass
class Columns:
    """Results of runs, a row for each."""

    length: int
    """The number of runs."""
    data: dict[str, NDArray[float64]] = field(default_factory=dict)
    """By name, (length, ...); NaN where a run gave nothing."""
    dimensions: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """Their dimensions after that of the runs."""

    def put(self, rows: Any, name: str, dimensions: tuple[str, ...], values: NDArray[float64]) -> None:
        """Puts values of one name into a row, or into several."""
        shape = values.shape[values.ndim - len(dimensions) :]
        if name not in self.data:
            self.data[name] = np.full((self.length, *shape), np.nan)
            self.dimensions[name] = dimensions
        if self.data[name].shape[1:] != shape or self.dimensions[name] != dimensions:
            first = dict(zip(self.dimensions[name], self.data[name].shape[1:]))
            raise ValueError(f"`{name}` is {dict(zip(dimensions, shape))} in this run and {first} in another; a column has one shape")
        self.data[name][rows] = values


@dataclass
class Block:
    """What came of some runs."""

    state: NDArray[np.int8]
    """DONE or FAILED."""
    seconds: NDArray[float64]
    """Wall time of each [s]."""
    warnings: NDArray[np.int32]
    """Number of warnings of each."""
    message: list[str]
    """Why a run failed, else empty."""
    columns: Columns
    """What is kept."""


def statistics(results: _results.Results) -> dict[str, Any]:
    """What is kept of a run where nothing else is asked for."""
    lines, bodies = list(results.lines.values()), list(results.bodies.values())

    def of(pick: Callable[[Any], Any], parts: list[Any]) -> NDArray[float64]:
        return np.array([pick(part) for part in parts], dtype=float)

    found: dict[str, Any] = {
        "tension_initial": (("line",), of(lambda line: line.tension[0], lines)),
        "tension_max": (("line",), of(lambda line: line.tension.max(), lines)),
        "tension_max_time": (("line",), of(lambda line: results.time[line.tension.argmax()], lines)),
        "tension_min": (("line",), of(lambda line: line.tension.min(), lines)),
        "tension_mean": (("line",), of(lambda line: line.tension.mean(), lines)),
        "tension_std": (("line",), of(lambda line: line.tension.std(), lines)),
        "anchor_tension_max": (("line",), of(lambda line: line.anchor_tension.max(), lines)),
        "grounded_length_min": (("line",), of(lambda line: line.grounded_length.min(), lines)),
    }
    if bodies:
        for name, axis in (("position", "axis"), ("attitude", "angle")):
            ways = [getattr(body, name) for body in bodies]
            found[f"body_{name}_max"] = (("body", axis), of(lambda way: way.max(axis=0), ways))
            found[f"body_{name}_min"] = (("body", axis), of(lambda way: way.min(axis=0), ways))
        for name in ("force", "moment"):
            sizes = [np.linalg.norm(getattr(body, name), axis=1) for body in bodies]
            found[f"body_{name}_max"] = (("body",), of(lambda size: size.max(), sizes))
    return found


def equilibrium(found: _results.Statics) -> dict[str, Any]:
    """What is kept of statics where nothing else is asked for."""
    lines, bodies = list(found.lines.values()), list(found.bodies.values())
    kept: dict[str, Any] = {
        name: (("line",), np.array([getattr(line, name) for line in lines])) for name in ("tension", "anchor_tension", "grounded_length")
    }
    kept["force"] = (("line", "axis"), np.array([line.force for line in lines]))
    if bodies:
        for name, axis in (("position", "axis"), ("attitude", "angle"), ("force", "axis"), ("moment", "axis")):
            kept[f"body_{name}"] = (("body", axis), np.array([getattr(body, name) for body in bodies]))
    return kept


def _one(scene: Parts, what: str, changes: Mapping[str, Any]) -> tuple[Any, int]:
    """The results of a scene, and the number of its warnings."""
    source = sourced(scene, changes)
    if what == "statics":
        text, told, failure = _moorline.statics(source)
        if failure is not None:
            raise failure
        return text, len(told)
    arrays, failure = _moorline.run(source, None, None)
    if failure is not None:
        raise failure
    return arrays, 0


def work(scene: Parts, what: str, outcome: Outcome | None, rows: list[dict[str, Any]]) -> Block:
    """Runs some rows of a sweep."""
    block = Block(
        state=np.full(len(rows), FAILED, dtype=np.int8),
        seconds=np.zeros(len(rows)),
        warnings=np.zeros(len(rows), dtype=np.int32),
        message=[""] * len(rows),
        columns=Columns(len(rows)),
    )
    for row, changes in enumerate(rows):
        began = time.perf_counter()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", Warning)
                found, told = _one(scene, what, changes)
                block.seconds[row] = time.perf_counter() - began
                if what == "statics":
                    results: Any = _results.statics(json.loads(found))
                    kept = (outcome or equilibrium)(results)
                else:
                    results = _results.results(found, json.loads(found["summary"]))
                    told = len(results.warnings)
                    kept = (outcome or statistics)(results)
            for name, value in kept.items():
                dimensions, values = value if isinstance(value, tuple) else ((), value)
                block.columns.put(row, name, tuple(dimensions), np.asarray(values, dtype=float))
            block.state[row], block.warnings[row] = DONE, told
        except Error as error:
            block.message[row] = str(error)
        except Exception as error:  # noqa: BLE001 - whatever the outcome does wrong belongs to its row
            block.message[row] = f"{type(error).__name__}: {error}"
        if block.state[row] == FAILED:
            block.seconds[row] = block.seconds[row] or time.perf_counter() - began
            for values in block.columns.data.values():
                values[row] = np.nan
    return block
