"""Accuracy and time of the built-in case, of every scheme at three tolerances and of cable-1994, as a table in Markdown.

    cargo build --release && python3 tests/bench/accuracy.py [target/release/moorline]

Errors are those of `timeseries.csv` against tests/data/lindahl_sjoberg_tension.csv from t = 60 to 120 s: rms over rms, largest over
largest. The time is `solver_seconds` of `summary.json`, the smallest of five runs. `cable-1994` is run as in the report, on 40 elements with
steps of 0.1 s; its law of extension differs from the reference's, which is 0.08 % of its error.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "tests/data/lindahl_sjoberg_tension.csv"
SCHEMES = ["adams-moulton", "esdirk3", "generalized-alpha"]
TOLERANCES = ["1e-2", "1e-3", "1e-4"]
RUNS = 5


def last_minute(path, column):
    """Tensions from 60 s on, whatever the time column is called."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    place = rows[0].index(column) if column in rows[0] else 1
    values = [float(row[place]) for row in rows[1:] if float(row[0]) >= 60.0 - 1e-9]
    assert len(values) == 601, f"{path}: {len(values)} rows from 60 to 120 s"
    return values


def errors(found, exact):
    """rms and largest error in percent."""
    rms = math.dist(found, exact) / math.hypot(*exact)
    return 100 * rms, 100 * max(abs(a - b) for a, b in zip(found, exact, strict=True)) / max(exact)


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "target/release/moorline").resolve()
    exact = last_minute(REFERENCE, "tension")
    print("| scheme | tolerance | elements | steps | rejected | rms error | largest error | solver time |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    cases = [(scheme, tolerance, f"solver.tolerance={tolerance}") for scheme in SCHEMES for tolerance in TOLERANCES]
    for scheme, tolerance, change in [*cases, ("cable-1994", "none", "lines[0].sections[0].elements=40")]:
        sets = ["--set", f"solver.scheme={scheme}", "--set", change]
        with tempfile.TemporaryDirectory() as directory:
            seconds = math.inf
            for _ in range(RUNS):
                subprocess.run([program, "--quiet", "-o", directory, *sets], check=True)
                summary = json.loads(Path(directory, "summary.json").read_text(encoding="utf-8"))
                seconds = min(seconds, summary["solver_seconds"])
            rms, largest = errors(last_minute(Path(directory, "timeseries.csv"), "tension"), exact)
        work = f"{summary['elements']} | {summary['steps']} | {summary['rejected_steps']}"
        print(f"| {scheme} | {tolerance} | {work} | {rms:.4f} % | {largest:.4f} % | {1e3 * seconds:.0f} ms |")


if __name__ == "__main__":
    main()
