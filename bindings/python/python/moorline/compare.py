"""A scene beside MoorDyn: ``python -m moorline.compare scene.json``. Needs ``pip install "moorline[compare]"``.

The scene is written as a MoorDyn file (`moorline convert`) and run by MoorDyn (PyPI ``moordyn``) with two numbers of segments, and by moorline;
the tensions at the ends that are held or driven are set beside each other, in a table and in a picture. How far MoorDyn's two meshes are
apart says how far it is to be believed.

For the comparison, ends on driven bodies and points become points that are driven along the same way, and so do anchors, which MoorDyn would
lift onto its bed; the bed is as much higher as the line sinks into it, so that it rests at the same depth.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy import float64
from numpy.typing import NDArray

import moorline

_LONGEST = 0.0125
"""Longest time between two places that MoorDyn is told [s]."""
_SEGMENTS = (80, 160)


@dataclass(frozen=True)
class Comparison:
    """Tensions of a scene by moorline and by MoorDyn with two numbers of segments, over n rows."""

    time: NDArray[float64]
    """(n,) times [s]."""
    segments: tuple[int, int]
    """MoorDyn's segments of each line, coarse and fine."""
    ours: dict[str, NDArray[float64]]
    """(n,) force on what holds an end [N], by the name of its line, with `` anchor`` behind it where it is the anchor."""
    theirs: tuple[dict[str, NDArray[float64]], dict[str, NDArray[float64]]]
    """The same of MoorDyn, coarse and fine."""
    seconds: tuple[float, float, float]
    """Time of the steps of moorline, and of MoorDyn's, coarse and fine [s]."""
    losses: list[str]
    """What a MoorDyn file does not hold of the scene."""

    def apart(self, end: str, begin: float = 0.0) -> tuple[float, float, float]:
        """How far an end's tensions are apart from `begin` [s] on, rms over the rms of MoorDyn's fine mesh [-]: moorline from the fine mesh, from
        the coarse one, and the two meshes from each other."""
        rows = self.time >= begin
        ours, coarse, fine = self.ours[end][rows], self.theirs[0][end][rows], self.theirs[1][end][rows]
        return _rms(ours - fine) / _rms(fine), _rms(ours - coarse) / _rms(fine), _rms(coarse - fine) / _rms(fine)


def _rms(values: NDArray[float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


@dataclass
class _End:
    """An end of a line that is held or driven."""

    name: str
    anchor: bool
    path: NDArray[float64]


def compare(scene: moorline.Scene = None, changes: dict[str, Any] | None = None, segments: tuple[int, int] = _SEGMENTS) -> Comparison:
    """Runs a scene by moorline, and by MoorDyn with two numbers of segments of each line (of each section, where a line has several)."""
    if len(segments) != 2 or not 1 <= segments[0] < segments[1]:
        raise moorline.InputError(f"segments: {segments} are not two numbers, the second larger")
    understood = moorline.check(scene, changes)
    output_step = understood["run"]["output_step"]
    if understood["run"]["duration"] < output_step:
        raise moorline.InputError(
            f"run.duration: {understood['run']['duration']} s is shorter than run.output_step: there are no rows to compare"
        )
    results = moorline.run(scene, changes)
    parts = max(math.ceil(output_step / _LONGEST - 1.0e-9), 1)
    ways = moorline.run(scene, {**(changes or {}), "run.output_step": output_step / parts})
    plain, ends = _standing_alone(understood, ways)
    rows = int((len(ways.time) - 1) // parts)
    with tempfile.TemporaryDirectory() as directory:
        deck, losses = _deck(plain, Path(directory), scene)
        runs = [_moordyn(deck, number, ends, ways.time[: rows * parts + 1], parts) for number in segments]
    ours = {}
    for end in ends:
        line = results.lines[end.name.removesuffix(" anchor")]
        force = line.anchor_force if end.anchor else line.force
        ours[end.name] = np.linalg.norm(force, axis=1)[: rows + 1]
    shown = {name: tension for name, tension in ours.items() if not name.endswith(" anchor") or name.removesuffix(" anchor") not in ours}
    theirs = tuple({name: run[0][name] for name in shown} for run in runs)
    return Comparison(
        time=results.time[: rows + 1],
        segments=segments,
        ours=shown,
        theirs=(theirs[0], theirs[1]),
        seconds=(results.summary["solver_seconds"], runs[0][1], runs[1][1]),
        losses=losses,
    )


def _standing_alone(understood: dict[str, Any], ways: moorline.Results) -> tuple[dict[str, Any], list[_End]]:
    """The scene with ends at coordinates instead of on driven bodies and points, and these ends with their ways."""
    scene = json.loads(json.dumps(understood))
    free = {
        kind: {of["name"] for of in scene.get(kind, []) if of.get("motion", {}).get("kind", default) == "free"}
        for kind, default in (("bodies", "fixed"), ("points", "free"))
    }
    ends = []
    for line in scene["lines"]:
        for key, anchor in (("fairlead", False), ("anchor", True)):
            end = line[key]
            if isinstance(end, dict) and (end.get("body") in free["bodies"] or end.get("point") in free["points"]):
                continue
            if isinstance(end, dict) and "direction" in end:
                raise moorline.InputError(
                    f'line "{line["name"]}": its {key} is clamped; ends that are driven are compared where they are pinned'
                )
            results = ways.lines[line["name"]]
            path = results.anchor if anchor else results.fairlead
            line[key] = path[0].tolist()
            ends.append(_End(line["name"] + (" anchor" if anchor else ""), anchor, path))
    for kind in ("bodies", "points"):
        scene[kind] = [of for of in scene.get(kind, []) if of["name"] in free[kind]]
    scene["motion"] = {"kind": "fixed"}
    return scene, ends


def _deck(plain: dict[str, Any], directory: Path, scene: moorline.Scene) -> tuple[Path, list[str]]:
    """The MoorDyn file of a scene, and what it does not hold."""
    file, deck = directory / "scene.json", directory / "deck.txt"
    # Files that the scene names lie beside it, and have been read by the runs; a deck does not hold them.
    for body in plain["bodies"]:
        body.pop("load", None)
    file.write_text(json.dumps(plain), encoding="utf-8")
    done = subprocess.run([sys.executable, "-m", "moorline", "convert", str(file), str(deck)], capture_output=True, check=False, text=True)
    if done.returncode != 0:
        raise moorline.InputError(done.stderr.strip().replace(str(file), "the scene as a MoorDyn file"))
    held = ("solver, run.duration", str(directory))
    losses = [line.strip() for line in done.stdout.splitlines()[1:] if not any(word in line for word in held)]
    return deck, losses


class _Rows:
    """A MoorDyn file as rows of words, as `convert` writes it."""

    def __init__(self, deck: Path) -> None:
        self.lines = deck.read_text(encoding="utf-8").splitlines()

    def of(self, section: str) -> Iterator[tuple[int, list[str]]]:
        """The rows of a section, with their places in the file."""
        inside, number = False, 0
        for place, line in enumerate(self.lines):
            if line.startswith("---"):
                inside, number = line.strip("- ") == section, 0
            elif inside:
                number += 1
                if number > (0 if section == "OPTIONS" else 2):
                    yield place, line.split()

    def put(self, place: int, words: Sequence[object]) -> None:
        """Replaces a row."""
        self.lines[place] = " ".join(map(str, words))


def _prepared(deck: Path, segments: int, ends: list[_End]) -> tuple[str, list[_End]]:
    """The text of a MoorDyn file with that many segments and all ends driven, and the ends in its order."""
    rows = _Rows(deck)
    hung = {}
    sinks, steps = [], []
    # Diameter, mass, stiffness, damping; where EA is a file of strains and tensions, its steepest piece.
    types = {words[0]: [*map(float, words[1:3]), _stiffness(words[3], deck), float(words[4])] for _, words in rows.of("LINE TYPES")}
    options = {words[1]: words[0] for _, words in rows.of("OPTIONS")}
    gravity, density = float(options["g"]), float(options["WtrDnsty"])
    for place, words in rows.of("LINES"):
        # Number, type, anchor's end, fairlead's end, length, segments.
        hung[words[2]], hung[words[3]] = True, False
        rows.put(place, [*words[:5], segments, *words[6:]])
        diameter, mass, stiffness, damping = types[words[1]]
        # The largest stable step of rk4: 2.8 over the frequency of the shortest wave along the line, 2.8 over the rate at which it is damped.
        piece = float(words[4]) / segments
        slow = piece * math.sqrt(mass / stiffness) / 2, piece**2 * mass / (4 * damping) if damping > 0 else math.inf
        steps.append(2.0 * min(slow))
        sinks.append((mass - density * math.pi / 4 * diameter**2) * gravity / (float(options["kBot"]) * diameter))
    depth = float(options["WtrDpth"]) - max(min(sinks), 0.0)
    order, left = [], list(ends)
    for place, words in rows.of("POINTS"):
        if words[1] not in ("Fixed", "Coupled"):
            continue
        at = np.array([float(word) for word in words[2:5]])
        mine = [
            end
            for end in left
            if end.anchor == hung.get(words[0], True) and np.linalg.norm(end.path[0] - at) < 1.0e-6 * max(np.abs(at).max(), 1.0)
        ]
        if not mine:
            raise moorline.InputError(f"point {words[0]} of the MoorDyn file at {at.tolist()} is no end of a line of the scene")
        left.remove(mine[0])
        order.append(mine[0])
        # Below its bed MoorDyn would not take it; where it really is, it is told before the first step.
        rows.put(place, [words[0], "Coupled", *words[2:4], repr(max(float(words[4]), -depth)), *words[5:]])
    if left:
        raise moorline.InputError(f'"{left[0].name}" has no point of its own in the MoorDyn file')
    for place, words in rows.of("OPTIONS"):
        if words[1] == "WtrDpth":
            rows.put(place, [repr(depth), *words[1:]])
        elif words[1] == "CFL":
            rows.put(place, [repr(min(steps)), "dtM"])
    rows.lines.insert(next(place for place, _ in rows.of("OPTIONS")), "0 writeLog\n1 disableOutput\nrk4 tScheme")
    return "\n".join(rows.lines) + "\n", order


def _stiffness(word: str, deck: Path) -> float:
    """EA of a line type [N]."""
    try:
        return float(word)
    except ValueError:
        table = np.loadtxt(deck.with_name(word.strip('"')), skiprows=3, ndmin=2)
        return float((np.diff(table[:, 1]) / np.diff(table[:, 0])).max())


def _moordyn(deck: Path, segments: int, ends: list[_End], times: NDArray[float64], parts: int) -> tuple[dict[str, NDArray[float64]], float]:
    """The force on each end by MoorDyn at every row, `parts` steps apart, and the time of its steps [s]."""
    import moordyn

    text, order = _prepared(deck, segments, ends)
    file = deck.with_name(f"deck_{segments}.txt")
    file.write_text(text, encoding="utf-8")
    places = np.concatenate([end.path[: len(times)] for end in order], axis=1)
    spans = np.diff(times)
    speeds = np.diff(places, axis=0) / spans[:, None]
    where = [list(row) for row in places]
    rows = []
    before = os.getcwd()
    with _silence():
        os.chdir(deck.parent)
        system = moordyn.Create(str(file))
        try:
            moordyn.Init(system, where[0], [0.0] * places.shape[1])
            seconds = 0.0
            # At rest, for the first row.
            rows.append(moordyn.Step(system, where[0], [0.0] * places.shape[1], float(times[0]), 1.0e-6))
            began = time.process_time()
            for step, (speed, span) in enumerate(zip(speeds.tolist(), spans.tolist())):
                force = moordyn.Step(system, where[step], speed, float(times[step]), span)
                if (step + 1) % parts == 0:
                    rows.append(force)
            seconds = time.process_time() - began
        except (RuntimeError, OSError) as error:
            raise moorline.Error(f"MoorDyn with {segments} segments gave up: {error}") from None
        finally:
            moordyn.Close(system)
            os.chdir(before)
    forces = np.linalg.norm(np.array(rows).reshape(len(rows), len(order), 3), axis=2)
    if not np.isfinite(forces).all():
        raise moorline.Error(f"MoorDyn with {segments} segments gave no number; a finer mesh or a shorter step may")
    return {end.name: forces[:, column] for column, end in enumerate(order)}, seconds


@contextmanager
def _silence() -> Iterator[None]:
    """MoorDyn talks on both streams of the process."""
    sys.stdout.flush()
    kept = [os.dup(1), os.dup(2)]
    nothing = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nothing, 1)
        os.dup2(nothing, 2)
        yield
    finally:
        for stream, other in zip((1, 2), kept):
            os.dup2(other, stream)
            os.close(other)
        os.close(nothing)


def table(found: Comparison, begin: float) -> str:
    """The comparison as text."""
    coarse, fine = found.segments
    lines = [f"tension from {begin:g} s on; differences are rms over rms of MoorDyn's with {fine} segments", ""]
    lines.append(
        f"{'end':24} {'moorline max':>14} {f'MoorDyn {fine}':>14} {f'from {fine}':>10} {f'from {coarse}':>10} {f'{coarse} from {fine}':>14}"
    )
    rows = found.time >= begin
    for end, ours in found.ours.items():
        off = [f"{100 * share:.2f} %" for share in found.apart(end, begin)]
        largest = [f"{values[rows].max() / 1e3:.2f} kN" for values in (ours, found.theirs[1][end])]
        lines.append(f"{end:24} {largest[0]:>14} {largest[1]:>14} {off[0]:>10} {off[1]:>10} {off[2]:>14}")
    own, one, other = (f"{1e3 * seconds:.0f} ms" for seconds in found.seconds)
    lines += ["", f"time of the steps: moorline {own}, MoorDyn {one} with {coarse} segments, {other} with {fine}"]
    return "\n".join([*lines, *(f"not in a MoorDyn file: {loss}" for loss in found.losses)])


def draw(found: Comparison, path: Path, title: str) -> None:
    """Draws tensions, and differences from MoorDyn's fine mesh."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    coarse, fine = found.segments
    figure, axes = pyplot.subplots(len(found.ours), 2, figsize=(14, 3.2 * len(found.ours)), squeeze=False, sharex=True)
    for (end, ours), (left, right) in zip(found.ours.items(), axes):
        one, other = found.theirs[0][end], found.theirs[1][end]
        left.plot(found.time, other / 1e3, color="tab:orange", label=f"MoorDyn, {fine} segments")
        left.plot(found.time, ours / 1e3, color="tab:blue", linewidth=1.0, label="moorline")
        left.set_ylabel(f"{end}: tension [kN]")
        right.plot(found.time, (one - other) / 1e3, color="tab:orange", label=f"MoorDyn, {coarse} segments")
        right.plot(found.time, (ours - other) / 1e3, color="tab:blue", linewidth=1.0, label="moorline")
        right.set_ylabel(f"less MoorDyn's with {fine} [kN]")
    axes[0, 0].legend()
    axes[0, 1].legend()
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    figure.suptitle(title)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(
        prog="python -m moorline.compare", description="Runs a scene by moorline and by MoorDyn with two meshes."
    )
    parser.add_argument("scene", nargs="?", help="scene file; without it, the built-in case")
    parser.add_argument(
        "--segments", default=",".join(map(str, _SEGMENTS)), metavar="N,M", help="MoorDyn's segments of a line (default %(default)s)"
    )
    parser.add_argument("--set", action="append", default=[], metavar="PLACE=VALUE", help="a value to put into the scene; repeatable")
    parser.add_argument("--from", dest="begin", type=float, default=0.0, metavar="T", help="compare from this time on [s]")
    parser.add_argument("-o", "--output", type=Path, default=Path("compare.svg"), metavar="FILE", help="the picture (default %(default)s)")
    given = parser.parse_args(arguments)
    try:
        segments = tuple(int(number) for number in given.segments.split(","))
    except ValueError:
        parser.error(f"--segments {given.segments}: two whole numbers are wanted, such as 80,160")
    changes = {}
    for setting in given.set:
        place, _, value = setting.partition("=")
        try:
            changes[place] = json.loads(value)
        except ValueError:
            changes[place] = value
    try:
        found = compare(given.scene, changes, segments)  # type: ignore[arg-type]
        print(table(found, given.begin))
        draw(found, given.output, str(given.scene or "the built-in case"))
    except moorline.Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 2 if isinstance(error, moorline.InputError) else 3
    except ImportError as error:
        print(f'error: MoorDyn and matplotlib are needed: pip install "moorline[compare]" ({error})', file=sys.stderr)
        return 2
    print(given.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
