"""Many runs on Dask: a table of scenes, and its results as one dataset that grows as runs finish."""

from __future__ import annotations

import asyncio
import hashlib
import itertools
import json
import os
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from moorline import _moorline
from moorline._errors import Error, InputError
from moorline._scene import Parts, Scene, parts, sourced
from moorline._work import DONE, FAILED, NOT_RUN, Block, Columns, Outcome, work

if TYPE_CHECKING:
    import xarray

Over = Union[Mapping[str, Sequence[Any]], Sequence[Mapping[str, Any]]]
"""What is swept: lists of values by place, of which every combination is run; or a list of changes, one for each run."""

_TASK = 1.0
"""What a worker is given at a time is to take so long [s]."""
_FLUSH = 1.0
"""How often the store grows at most [s]."""
_SHARE = 0.02
"""How much of the time of this program that may take."""
_CHUNK = 1024
"""Rows of a chunk of the store."""
_LARGEST = 2000
"""Most runs that a worker is given at a time."""
_LOOKED = 10_000
"""Most combinations of which one is to be an allowed scene."""
_MESSAGE = 400
"""Longest message that is kept."""
_PATIENCE = 300.0
"""How long a sweep waits for a worker where there is none [s]."""
_LOOK = 5.0
"""How often it looks whether there are workers while nothing comes back [s]."""
_AXES = {"axis": ["x", "y", "z"], "angle": ["roll", "pitch", "yaw"]}


def sweep(
    scene: Scene,
    over: Over,
    *,
    changes: Mapping[str, Any] | None = None,
    what: str = "run",
    outcome: Outcome | None = None,
    store: str | os.PathLike[str] | None = None,
    client: Any = None,
    batch: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> xarray.Dataset:
    """Runs a scene many times on Dask. Needs ``pip install "moorline[sweep]"``.

    ``over``: ``{"environment.waves.hs": [4, 6], "environment.waves.seed": range(20)}`` is 40 runs, the last key changing fastest; a list of
    dicts is a run for each of them. ``changes`` are common to all. ``what``: "run", or "statics" for the equilibrium alone. ``outcome``: what is
    kept of each run: a function from `Results` (or `Statics`) to numbers by name, or to (names of dimensions, numbers), the same for all
    runs; without it, statistics of the tensions and of the bodies. ``client``: a `dask.distributed.Client`, whose workers have moorline and see
    the files that the scene names; without it, all cores of this machine: then a script must stand under ``if __name__ == "__main__":``.
    ``batch``: runs that a worker is given at a time; without it, as many as take a second. ``progress`` is called with the number of rows that
    are there and of all.

    ``store``: the directory of a Zarr store that grows as runs finish. The same sweep given again goes on where it was: what is there is
    not run again. ``xarray.open_zarr(store)`` shows it at any time.

    Returns a dataset over ``run``: the values of ``over`` as coordinates, ``state`` (0 not run, 1 done, 2 failed), ``message`` (why it
    failed), ``seconds`` (wall time of the run on its worker), ``warnings`` (their number) and what is kept, NaN where a run failed. A scene that fails
    is a row with its message, a worker that dies costs its runs only: others take them over. Raises `InputError` before the first run
    where no combination is an allowed scene, as with a key that does not exist, and where the store holds another sweep."""
    if what not in ("run", "statics"):
        raise InputError(f'what: "{what}" is not known; "run" or "statics" are')
    if batch is not None and batch < 1:
        raise InputError(f"batch: {batch} runs at a time are none; 1 or more are allowed")
    _needed()
    table = _table(over, changes or {})
    plain = parts(scene)
    plain = plain._replace(path=plain.path and os.path.abspath(plain.path), directory=os.getcwd())
    understood = _first(plain, table)
    keys = [key for key in table[0] if key not in (changes or {})]
    sheet = _Sheet(table, keys, understood, _print(plain, table, understood, what, outcome), store)
    try:
        with _Client(client) as cluster:
            _drive(cluster, plain, what, outcome, sheet, batch, progress)
    finally:
        sheet.flush()
    return sheet.dataset()


def _needed() -> None:
    try:
        import distributed  # noqa: F401
        import xarray  # noqa: F401
        import zarr  # noqa: F401
    except ImportError as error:
        raise ImportError(f'a sweep needs Dask, xarray and Zarr: pip install "moorline[sweep]" ({error})') from None


def _table(over: Over, changes: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The changes of each run."""
    if isinstance(over, Mapping):
        for key, values in over.items():
            if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__len__"):
                raise InputError(f"over: `{key}` wants a list of values, not {values!r}")
            if len(values) == 0:
                raise InputError(f"over: `{key}` has no values")
        rows = [dict(zip(over, values)) for values in itertools.product(*over.values())] if over else []
    else:
        rows = [dict(row) for row in over]
        if any(set(row) != set(rows[0]) for row in rows):
            raise InputError("over: all runs must change the same keys")
    if not rows or not rows[0]:
        raise InputError("over: there is nothing to sweep over")
    both = sorted(set(changes) & set(rows[0]))
    if both:
        raise InputError(f"over: `{both[0]}` is in `changes` too")
    return [{**changes, **row} for row in rows]


def _first(scene: Parts, table: list[dict[str, Any]]) -> dict[str, Any]:
    """The first scene of a table that is allowed, as it is understood. Where there is none, the first refusal is raised."""
    refusal = None
    # Neighbours have most values in common: some from all over the table are looked at first.
    spread = range(0, len(table), max(len(table) // 100, 1))
    for row in itertools.chain((0,), spread, range(min(len(table), _LOOKED))):
        try:
            text, _ = _moorline.check(sourced(scene, table[row]))
            understood: dict[str, Any] = json.loads(text)
            return understood
        except Error as error:
            refusal = refusal or error
    assert refusal is not None
    raise refusal


def _print(scene: Parts, table: list[dict[str, Any]], understood: dict[str, Any], what: str, outcome: Outcome | None) -> str:
    """What tells one sweep from another."""
    kept = getattr(outcome, "__qualname__", repr(outcome))
    told = [_moorline.__version__, what, kept, scene.text, understood, table]
    return hashlib.sha256(json.dumps(told, default=_plain, sort_keys=True).encode()).hexdigest()


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else str(value)


def _column(values: list[Any]) -> Any:
    """Values of a key: numbers, or text."""
    if all(isinstance(value, (bool, int, float, np.number, np.bool_)) for value in values):
        return np.array(values)
    return np.array([value if isinstance(value, str) else json.dumps(value, default=_plain) for value in values])


class _Sheet:
    """The rows of a sweep in memory, and in a store where there is one."""

    def __init__(self, table: list[dict[str, Any]], keys: list[str], understood: dict[str, Any], fingerprint: str, store: Any) -> None:
        length = len(table)
        self.table, self.fingerprint = table, fingerprint
        self.names = {"line": _names(understood, "lines"), "body": _names(understood, "bodies"), **_AXES}
        self.columns = Columns(length)
        self.state = np.full(length, NOT_RUN, dtype=np.int8)
        self.seconds, self.warnings = np.full(length, np.nan), np.zeros(length, dtype=np.int32)
        self.message = np.full(length, "", dtype=object)
        self.keys = {key: ("run", _column([row[key] for row in table])) for key in keys}
        self.path = None if store is None else Path(store)
        self.dirty: set[int] = set()
        self.stored: set[str] = set()
        self.flushed, self.pause = time.monotonic(), _FLUSH
        if self.path is not None and self.path.exists() and any(self.path.iterdir()):
            self._load(self.path)

    @property
    def there(self) -> int:
        """Number of rows that are there."""
        return int(np.count_nonzero(self.state != NOT_RUN))

    def take(self, rows: Sequence[int], block: Block) -> None:
        """Takes over what a worker gives."""
        for name, values in block.columns.data.items():
            done = np.flatnonzero(block.state == DONE)
            try:
                self.columns.put(np.asarray(rows)[done], name, block.columns.dimensions[name], values[done])
            except ValueError as error:
                for row in done.tolist():
                    block.state[row], block.message[row] = FAILED, f"ValueError: {error}"
        for row, message in zip(rows, block.message):
            self.message[row] = message[:_MESSAGE]
        self.state[list(rows)], self.seconds[list(rows)] = block.state, block.seconds
        self.warnings[list(rows)] = block.warnings
        self.dirty.update(row // _CHUNK for row in rows)
        if time.monotonic() - self.flushed > self.pause:
            began = time.monotonic()
            self.flush()
            self.pause = max(_FLUSH, (time.monotonic() - began) / _SHARE)

    def dataset(self) -> xarray.Dataset:
        """All rows."""
        import xarray

        data: dict[str, Any] = {
            "state": ("run", self.state),
            "message": ("run", self.message),
            "seconds": ("run", self.seconds, {"units": "s"}),
        }
        data["warnings"] = ("run", self.warnings)
        for name, values in self.columns.data.items():
            data[name] = (("run", *self.columns.dimensions[name]), values)
        used = {dimension for dimensions in self.columns.dimensions.values() for dimension in dimensions}
        named = {name: names for name, names in self.names.items() if name in used}
        return xarray.Dataset(data, {**self.keys, **named}, {"moorline": self.fingerprint})

    def flush(self) -> None:
        """Writes what is new to the store: first what is kept, then the states, so that a row whose state is there is whole."""
        self.flushed = time.monotonic()
        if self.path is None or not (self.dirty or not self.stored):
            return
        import zarr

        whole = self.dataset()
        new = [str(name) for name in whole.variables if name not in self.stored]
        if new:
            fresh = whole[new].drop_vars(self.stored, errors="ignore")
            if "state" in new:
                # A row that is not in the store yet is not done there yet.
                fresh["state"] = ("run", np.full(len(self.table), NOT_RUN, np.int8))
            chunks = {
                name: {"chunks": tuple(min(size, _CHUNK) if dimension == "run" else size for dimension, size in fresh[name].sizes.items())}
                for name in new
            }
            if self.stored:
                fresh.to_zarr(self.path, mode="a", encoding=chunks, consolidated=True, zarr_format=2)
            else:
                # Whoever looks sees a whole store or none.
                making = self.path.with_name(self.path.name + ".new")
                fresh.to_zarr(making, mode="w", encoding=chunks, consolidated=True, zarr_format=2)
                if self.path.exists():
                    self.path.rmdir()
                making.rename(self.path)
            self.stored.update(new)
        group: Any = zarr.open_group(str(self.path), mode="r+")
        grown = [name for name in (*self.columns.data, "message", "seconds", "warnings", "state") if name in self.stored]
        for name in grown:
            values, array = whole[name].values, group[name]
            for chunk in self.dirty:
                rows = slice(chunk * _CHUNK, (chunk + 1) * _CHUNK)
                array[rows] = values[rows]
        self.dirty.clear()

    def _load(self, path: Path) -> None:
        """Takes over what a store holds."""
        import xarray

        try:
            kept = xarray.open_zarr(path, chunks=None).load()
        except Exception as error:  # noqa: BLE001 - what stands there may be anything
            raise InputError(f"{path}: is no store of a sweep ({type(error).__name__}); give another directory, or take it away") from None
        if kept.attrs.get("moorline") != self.fingerprint:
            raise InputError(
                f"{path}: holds another sweep, of other values, another scene, outcome or version; give another directory, or take it away"
            )
        self.stored = {str(name) for name in kept.variables}
        for name in ("state", "seconds", "warnings"):
            getattr(self, name)[:] = kept[name].values
        self.message[:] = [str(message) for message in kept["message"].values]
        for name, values in kept.data_vars.items():
            if name not in ("state", "seconds", "warnings", "message"):
                self.columns.put(slice(None), str(name), tuple(map(str, values.dims[1:])), values.values)


def _names(understood: dict[str, Any], kind: str) -> list[str]:
    return [of["name"] for of in understood.get(kind, [])]


class _Client:
    """The client given, or one of this machine for as long as the sweep takes."""

    def __init__(self, client: Any) -> None:
        self.given = client
        self.cluster: Any = None

    def __enter__(self) -> Any:
        if self.given is not None:
            return self.given
        import dask
        from distributed import Client, LocalCluster

        # Runs share the cores out among themselves; within a run, lines take turns.
        alone = {"RAYON_NUM_THREADS": "1"}
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        with dask.config.set({"distributed.worker.profile.enabled": False}):
            self.cluster = LocalCluster(n_workers=cores, threads_per_worker=1, dashboard_address=None, env=alone)
        self.own = Client(self.cluster)
        return self.own

    def __exit__(self, *_: object) -> None:
        if self.cluster is not None:
            self.own.close()
            self.cluster.close()


def _drive(
    client: Any,
    scene: Parts,
    what: str,
    outcome: Outcome | None,
    sheet: _Sheet,
    batch: int | None,
    progress: Callable[[int, int], object] | None,
) -> None:
    """Gives out the rows that are not there, and takes in what comes of them."""
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    todo = np.flatnonzero(sheet.state == NOT_RUN).tolist()
    pace = _Pace(batch)
    given: dict[Any, list[int]] = {}
    # Runs whose worker died, perhaps of a neighbour: each is tried once more with no other beside it.
    suspects: list[int] = []
    alone = False
    arrived = as_completed()

    def give(rows: list[int]) -> None:
        future = client.submit(work, scene, what, outcome, [sheet.table[row] for row in rows], pure=False)
        given[future] = rows
        arrived.add(future)

    def fill() -> None:
        slots = 2 * max(sum(client.nthreads().values()), 1)
        while todo and len(given) < slots:
            number = pace.number(len(todo), slots)
            give(todo[:number])
            del todo[:number]

    def told() -> None:
        if progress is not None:
            progress(sheet.there, len(sheet.table))

    try:
        told()
        fill()
        while given:
            _wait(client, list(given))
            future = next(arrived)
            rows = given.pop(future)
            block, failure = None, Exception()
            try:
                block = future.result()
            except Exception as error:  # noqa: BLE001 - also of a worker that dies with what it has computed
                failure = error
            if block is not None:
                pace.saw(len(rows), float(block.seconds.sum()))
                sheet.take(rows, block)
                told()
            elif not isinstance(failure, KilledWorker):
                raise failure
            elif len(rows) > 1:
                # One of them, or none, is what kills workers.
                for row in rows:
                    give([row])
            elif alone:
                sheet.take(rows, _killed(failure))
                told()
            else:
                suspects.extend(rows)
            future.release()
            fill()
            if not given and suspects:
                alone = True
                give([suspects.pop()])
    finally:
        client.cancel(list(given))


def _wait(client: Any, futures: list[Any]) -> None:
    """Until one of them has come; not for ever where nobody works on them."""
    from distributed import wait

    there = time.monotonic()
    while True:
        try:
            wait(futures, timeout=min(_LOOK, _PATIENCE), return_when="FIRST_COMPLETED")
            return
        except asyncio.TimeoutError:
            if client.nthreads():
                there = time.monotonic()
            elif time.monotonic() - there >= _PATIENCE:
                raise Error(
                    f"no worker has been there for {_PATIENCE:.0f} s; what has run is kept in the store, if one was given: start workers and"
                    " run the same sweep again, and it goes on from there"
                ) from None


def _killed(failure: Any) -> Block:
    """The row of a run whose workers died."""
    message = (
        f"the workers that it ran on died, {failure.allowed_failures + 1} of them, the last {getattr(failure.last_worker, 'address', '')}"
    )
    return Block(np.array([FAILED], np.int8), np.array([np.nan]), np.zeros(1, np.int32), [message], Columns(1))


class _Pace:
    """How many runs a worker is given at a time."""

    def __init__(self, batch: int | None) -> None:
        self.batch = batch
        self.runs, self.seconds = 0, 0.0

    def saw(self, runs: int, seconds: float) -> None:
        """Some runs took so long [s]."""
        self.runs, self.seconds = self.runs + runs, self.seconds + seconds

    def number(self, left: int, slots: int) -> int:
        """How many of those that are left come next: as many as take a second, and fewer towards the end, so that all workers end together."""
        if self.batch is not None:
            return self.batch
        if self.runs == 0:
            return 1
        fits = int(_TASK * self.runs / max(self.seconds, 1.0e-9))
        return max(min(fits, left // (2 * slots), _LARGEST), 1)
