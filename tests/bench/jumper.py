"""The flexible jumper of Lowe and Langley (OMAE 2006) in waves of 5 m amplitude and 10 s: tension at its upper end beside their figures, as a table in
docs/benchmarks.md.

    cargo build --release && python3 tests/bench/jumper.py MOORDYN/tests/Mooring/lowe_and_langley_2006

Deck and figures (cases 4 to 6, digitised) are those of MoorDyn's public tree, which is not part of this repository. Waves run along, at 45 degrees and
across; their motion is that of linear theory below still water, so that the surface is `none` and nothing is stretched. Phases are those of
MoorDyn's own test, and so is the time: the figures begin after two periods.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from measure import program, put, table

PERIODS = 2
PERIOD = 10.0
#: Number of the case, direction and phase [deg].
CASES = [(4, 0.0, 230.0), (5, 45.0, 165.0), (6, 90.0, 0.0)]


def run(deck, direction, phase, stretching):
    """Times and tensions [kN]."""
    waves = {"kind": "regular", "amplitude": 5.0, "period": PERIOD, "direction_deg": direction, "phase_deg": phase, "stretching": stretching}
    sets = [f"environment.waves={json.dumps(waves)}", 'environment.surface="none"', "run.duration=50", "run.output_step=0.05"]
    with tempfile.TemporaryDirectory() as folder:
        arguments = [program(), "run", deck, "-q", "-o", folder]
        subprocess.run(arguments + [word for one in sets for word in ("--set", one)], check=True)
        with open(Path(folder, "timeseries.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    return [(float(row["time"]), float(row["tension"]) / 1000) for row in rows]


def at(course, time):
    """By the straight line between rows."""
    for (t0, x0), (t1, x1) in zip(course, course[1:]):
        if t0 <= time <= t1:
            return x0 + (x1 - x0) * (time - t0) / (t1 - t0)
    raise ValueError(time)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder, rows = Path(sys.argv[1]), []
    for case, direction, phase in CASES:
        with open(folder / f"Case {case}.csv", encoding="utf-8") as file:
            figures = [(float(row[0]), float(row[1])) for row in csv.reader(file) if row]
        found = [f"{min(x for _, x in figures):.1f} to {max(x for _, x in figures):.1f}"]
        for stretching in ("none", "wheeler"):
            course = run(folder / "line.txt", direction, phase, stretching)
            off = [at(course, time + PERIODS * PERIOD) - tension for time, tension in figures]
            found.append(f"{max(map(abs, off)):.2f}")
            found.append(f"{(sum(x * x for x in off) / len(off)) ** 0.5:.2f}")
        rows.append([f"{case}: waves at {direction:.0f}°", *found])
        print(*rows[-1], sep=" | ", flush=True)
    head = ["case", "their tension [kN]", "`none`: largest difference [kN]", "rms", "`wheeler`: largest", "rms"]
    put("jumper", "python3 tests/bench/jumper.py MOORDYN/tests/Mooring/lowe_and_langley_2006", table(head, rows))


if __name__ == "__main__":
    main()
