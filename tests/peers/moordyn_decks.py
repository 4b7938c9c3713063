"""Static tensions of the MoorDyn files under tests/data/moordyn (or of those named), by MoorPy and MoorDyn themselves.

    python tests/peers/moordyn_decks.py [--moorline PROGRAM] [DECK ...]

MoorPy takes lines as elastic catenaries: an independent answer for decks without bodies that float by rods. MoorDyn takes them as segments;
its own stationary state is asked for, with the segments of the deck.
"""

import json
import logging
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
DECKS = HERE.parent / "data" / "moordyn"


def by_moorline(program, deck):
    done = subprocess.run([program, "statics", deck, "--json"], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        return {}
    return {line["name"]: (line["tension"], line["anchor_tension"]) for line in json.loads(done.stdout)["lines"]}


def by_moorpy(deck):
    import moorpy

    logging.disable()
    system = moorpy.System(file=str(deck))
    # A deck without a depth has its bed at its lowest point, as in MoorDyn.
    system.depth = max([system.depth] + [-point.r[2] for point in system.pointList])
    system.initialize()
    for body in system.bodyList:
        if body.type == -1:
            body.setPosition(body.r6)
    system.solveEquilibrium(tol=1e-6)
    return {f"line{line.number}": (line.TB, line.TA) for line in system.lineList}


def by_moordyn(deck):
    import moordyn

    with tempfile.TemporaryDirectory() as directory:
        for file in deck.parent.iterdir():
            if file.is_file():
                (Path(directory) / file.name).write_bytes(file.read_bytes())
        os.chdir(directory)
        system = moordyn.Create(deck.name)
        coupled = moordyn.NCoupledDOF(system)
        places = []
        for number in range(1, moordyn.GetNumberBodies(system) + 1):
            body = moordyn.GetBody(system, number)
            if moordyn.GetBodyType(body) == -1:
                places += list(moordyn.GetBodyState(body)[0])
        for number in range(1, moordyn.GetNumberPoints(system) + 1):
            point = moordyn.GetPoint(system, number)
            if moordyn.GetPointType(point) == -1:
                places += list(moordyn.GetPointPos(point))
        places = places[:coupled]
        moordyn.Init(system, places, [0.0] * coupled)
        tensions = {}
        for number in range(1, moordyn.GetNumberLines(system) + 1):
            line = moordyn.GetLine(system, number)
            last = moordyn.GetLineN(line)
            tension = [sum(x * x for x in moordyn.GetLineNodeTen(line, node)) ** 0.5 for node in (last, 0)]
            tensions[f"line{number}"] = tuple(tension)
        moordyn.Close(system)
        return tensions


def main():
    arguments = sys.argv[1:]
    program = "target/release/moorline"
    if arguments[:1] == ["--moorline"]:
        program, arguments = arguments[1], arguments[2:]
    program = str(Path(program).resolve())
    decks = [Path(name).resolve() for name in arguments] or sorted(DECKS.glob("*.txt"))
    for deck in decks:
        ours = by_moorline(program, deck)
        for name, judge in [("MoorPy", by_moorpy), ("MoorDyn", by_moordyn)]:
            try:
                theirs = judge(deck)
            except Exception as error:  # noqa: BLE001 - MoorPy raises nothing more special
                print(f"{deck.name}: {name}: {type(error).__name__}: {error}")
                continue
            for line, tensions in theirs.items():
                off = [f"{(own - other) / other:+.2%}" for own, other in zip(ours.get(line, ()), tensions) if other]
                fairlead, anchor = tensions
                print(f"{deck.name:20} {line:8} {name:8} fairlead {fairlead:14.2f} N, anchor {anchor:14.2f} N; moorline {', '.join(off)}")


if __name__ == "__main__":
    main()
