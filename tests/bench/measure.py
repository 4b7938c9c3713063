"""What the benchmarks share: one core, runs of moorline, errors, and blocks of a document that a rerun replaces."""

import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from scenes import FINE, with_mesh

try:
    import resource
except ImportError:  # not on Windows
    resource = None

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs/benchmarks.md"
SCHEMES = ["adams-moulton", "esdirk3", "generalized-alpha"]
PACKAGES = ["moordyn==2.7.2", "numpy==2.4.6", "matplotlib==3.11.2"]


def in_environment():
    """Goes on in a virtual environment with `PACKAGES`, which is made at the first time."""
    folder = ROOT / "target/tmp/bench-python"
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if Path(sys.prefix).resolve() == folder.resolve():
        return
    finished = folder / "packages.txt"
    if not finished.exists() or finished.read_text(encoding="utf-8") != "\n".join(PACKAGES):
        if sys.version_info < (3, 11):
            sys.exit("the benchmark's packages need Python 3.11 or newer")
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
        finished.write_text("\n".join(PACKAGES), encoding="utf-8")
    sys.exit(subprocess.run([python, *sys.argv], check=False).returncode)


def on_one_core():
    """This process and all that it starts share the last core that it may use."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def program():
    """The program of the plain release build."""
    file = Path(os.environ.get("MOORLINE", ROOT / "target/release/moorline")).resolve()
    if not file.exists():
        sys.exit(f"{file} is missing: cargo build --release")
    return file


def table_of(file):
    """The rows of a CSV file, its head first."""
    with open(file, encoding="utf-8") as rows:
        return list(csv.reader(rows))


def children():
    """CPU time of the processes that this one has started and seen end [s]."""
    if resource is None:
        return 0.0
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Failed(Exception):
    """The program ended with an error; its text is the message."""


class Run:
    """What a run leaves: `summary`, `times`, `tension`, `nodes` (their arc lengths), and `seconds` of its time loop."""

    def __init__(self, scene, wrapper=(), **solver):
        scene = {**scene, "solver": {**scene.get("solver", {}), **solver}}
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "scene.json")
            file.write_text(json.dumps(scene), encoding="utf-8")
            before = children()
            # Without a time limit a run that neither ends nor fails would pass unnoticed.
            command = [*wrapper, program(), "run", file, "--quiet", "-o", Path(folder, "out")]
            try:
                done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=3600)
            except subprocess.TimeoutExpired as error:
                raise Failed("no end after an hour") from error
            spent = children() - before if resource else math.inf
            if done.returncode != 0:
                said = done.stderr.replace(str(file), "the scene").splitlines()
                raise Failed("\n".join(line for line in said if line and not line.startswith("==")))
            self.said = done.stderr
            self.summary = json.loads(Path(folder, "out/summary.json").read_text(encoding="utf-8"))
            rows = table_of(Path(folder, "out/timeseries.csv"))
            nodes = table_of(Path(folder, "out/nodes.csv"))
        place = rows[0].index("tension")
        self.times, self.tension = [float(r[0]) for r in rows[1:]], [float(r[place]) for r in rows[1:]]
        self.nodes = [float(row[3]) for row in nodes[1:] if float(row[0]) == self.times[0]]
        # The clock of a busy machine runs on while others compute; the CPU time of the whole process is a bound that does not.
        self.seconds = min(self.summary["solver_seconds"], spent)


def fastest(scene, runs, **solver):
    """One result, and the smallest time of several runs; long ones are not repeated as often."""
    best, started = Run(scene, **solver), time.monotonic()
    for _ in range(runs - 1):
        if time.monotonic() - started > 5.0:
            break
        best.seconds = min(best.seconds, Run(scene, **solver).seconds)
    return best


def judged(case, times, tension):
    """The part of a tension that the case judges: its window, or the maxima of the cycles in it."""
    start, end = case.window
    if case.peaks is None:
        return [f for t, f in zip(times, tension, strict=True) if start - 1e-9 <= t <= end + 1e-9]
    cycles = round((end - start) / case.peaks)
    inside = lambda t, k: start + k * case.peaks <= t < start + (k + 1) * case.peaks
    return [max(f for t, f in zip(times, tension, strict=True) if inside(t, k)) for k in range(cycles)]


def errors(case, found, exact):
    """rms and largest error in percent; of peaks, the error of their mean and of the worst cycle, of the reference's mean."""
    if case.peaks is None:
        largest = max(abs(a - b) for a, b in zip(found, exact, strict=True)) / max(exact)
        return 100 * math.dist(found, exact) / math.hypot(*exact), 100 * largest
    mean = sum(exact) / len(exact)
    return 100 * abs(sum(found) / len(found) / mean - 1), 100 * max(abs(f / mean - 1) for f in found)


def reference(case):
    """What is true in the window of the case."""
    if case.name == "built-in":
        rows = [[float(x) for x in row] for row in table_of(ROOT / "tests/data/lindahl_sjoberg_tension.csv")[1:]]
        return judged(case, *zip(*rows))
    fine = {**FINE, **case.reference}
    run = Run(with_mesh(case.scene, fine.pop("elements")), **fine)
    return judged(case, run.times, run.tension)


def put(name, command, text, file=DOCUMENT):
    """Replaces a block of docs/benchmarks.md or another file, which must be there."""
    document = file.read_text(encoding="utf-8")
    pattern = re.compile(rf"<!-- begin {re.escape(name)}\b.*?-->.*?<!-- end {re.escape(name)} -->", re.DOTALL)
    block = f"<!-- begin {name} (made by `{command}`) -->\n{text.strip()}\n<!-- end {name} -->"
    if not pattern.search(document):
        sys.exit(f"{file} has no block {name}")
    file.write_text(pattern.sub(lambda _: block, document), encoding="utf-8")


def table(head, rows, left=1):
    """A table in Markdown; the first columns to the left, numbers to the right."""
    lines = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" if k < left else "---:" for k in range(len(head))) + " |"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def machine():
    """The processor, for the foot of a table of times."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
        return re.search(r"model name\s*: (.*)", text).group(1)
    except (OSError, AttributeError):
        return "an unnamed processor"
