"""Many lines: how many seconds of how many lines a second of the clock simulates, on one thread and on all, as a table in docs/benchmarks.md.

    cargo build --release && python3 tests/bench/throughput.py

A scene with 1 to 64 lines like the built-in one, at default settings, their anchors in a circle around the vessel; the same motion of the
fairlead is surge for some and sway for others. One thread: the program may use one core only, each in turn. Each number is the smallest of
several runs; runs on one thread and on all take turns, so that a machine that is busy for a while is so for both. On a machine where others
compute at the same time, even the smallest is too large, the more so the longer the run and the more cores it wants.
"""

import copy
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measure import machine, program, put, table
from scenes import BUILT_IN

LINES = [1, 2, 4, 16, 64]
#: At least so many runs, and as many as begin within so many seconds.
RUNS, SECONDS = 7, 10.0


def circle(number):
    """The built-in line that many times, anchors at equal angles."""
    scene = copy.deepcopy(BUILT_IN)
    (line,) = scene["lines"]
    reach, depth = line["anchor"][0], line["anchor"][2]
    angles = [2 * math.pi * k / number for k in range(number)]
    anchor = lambda angle: [reach * math.cos(angle), reach * math.sin(angle), depth]
    scene["lines"] = [{**line, "name": f"line {k}", "anchor": anchor(angle)} for k, angle in enumerate(angles)]
    return scene


def measured(scene, cores):
    """Wall time of the whole program and of its time steps [s], on these cores."""
    os.sched_setaffinity(0, cores)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "scene.json")
        file.write_text(json.dumps(scene), encoding="utf-8")
        began = time.monotonic()
        # The end of its output tells the end of the program at once; a wait with a time limit alone looks every 50 ms.
        command = [program(), "run", file, "--quiet", "-o", Path(folder, "out")]
        subprocess.run(command, check=True, capture_output=True, timeout=600)
        seconds = time.monotonic() - began
        return seconds, json.loads(Path(folder, "out/summary.json").read_text(encoding="utf-8"))["solver_seconds"]


def main():
    if not hasattr(os, "sched_setaffinity"):
        sys.exit("this system does not let a program choose its cores")
    everywhere = sorted(os.sched_getaffinity(0))
    busy, rows = os.getloadavg()[0], []
    for number in LINES:
        scene = circle(number)
        seconds = number * scene["run"]["duration"]
        times, began = [], time.monotonic()
        while len(times) < RUNS or time.monotonic() - began < SECONDS:
            times.append((measured(scene, {everywhere[len(times) % len(everywhere)]}), measured(scene, everywhere)))
        one, all_of_them = ([min(column) for column in zip(*side)] for side in zip(*times))
        each = [f"{1000 * sides[0] / number:.1f} ms" for sides in (one, all_of_them)]
        rates = [f"{seconds / sides[1]:.0f}" for sides in (one, all_of_them)]
        gains = [f"{a / b:.2f}" for a, b in zip(one, all_of_them)]
        rows.append([number, *each, gains[0], *rates, gains[1]])
        print(*rows[-1], sep=" | ", flush=True)
    head = [
        "lines", "whole run per line, one thread", "all", "times as fast", "line-seconds per second of time steps, one thread", "all",
        "times as fast",
    ]
    foot = (
        f"All is {len(everywhere)} threads on {len(everywhere)} cores of {machine()}. The smallest of at least {RUNS} runs; others kept "
        f"{busy:.1f} of the cores busy when the first began."
    )
    put("throughput", "python3 tests/bench/throughput.py", f"{table(head, rows, 0)}\n\n{foot}")


if __name__ == "__main__":
    main()
