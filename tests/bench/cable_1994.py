"""The scheme of the 1994 report against its own limit: the table and the figure of docs/cable-1994.md.

    cargo build --release && python3 tests/bench/cable_1994.py [target/release/moorline]

Runs examples/ma-webster-1994.json with ever shorter steps on 40 and 80 elements, and by the default scheme with the report's law and
strain from pressure. Prints lambda at the top at t = 120 s, writes docs/cable-1994.svg.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "examples/ma-webster-1994.json"
FIGURE = ROOT / "docs/cable-1994.svg"
EA = 5.0e8
PRINTED = 709_831.0
STEPS = [0.1, 0.05, 0.025, 0.0125]
DEFAULT = ['solver={"stretch": "report", "hydrostatic_strain": true}']
FINE = [*DEFAULT, "solver.tolerance=1e-4", "lines[0].sections[0].elements=80"]
COARSE = [*DEFAULT, 'lines[0].sections[0]={"type": "chain", "length": 1200}']


def run(program, sets):
    """Times, top tensions as lambda, and the summary."""
    with tempfile.TemporaryDirectory() as directory:
        arguments = [argument for change in sets for argument in ("--set", change)]
        subprocess.run([program, "run", SCENE, "--quiet", "-o", directory, *arguments], check=True)
        summary = json.loads(Path(directory, "summary.json").read_text(encoding="utf-8"))
        with open(Path(directory, "timeseries.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    return [float(row["time"]) for row in rows], [lambda_of(float(row["tension"])) for row in rows], summary


def lambda_of(tension):
    """lambda (1 + 2 lambda/EA)^0.5 = tension, at the surface, where the water does not press."""
    found = tension
    for _ in range(40):
        found = tension / math.sqrt(1.0 + 2.0 * found / EA)
    return found


class Panel:
    """A plot in a figure: axes from data to millimetres."""

    def __init__(self, left, width, xs, ys):
        self.left, self.width, self.xs, self.ys = left, width, xs, ys
        self.parts = []

    def at(self, x, y):
        return (self.left + (x - self.xs[0]) / (self.xs[1] - self.xs[0]) * self.width,
                230.0 - (y - self.ys[0]) / (self.ys[1] - self.ys[0]) * 190.0)

    def line(self, points, style):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in (self.at(*point) for point in points))
        self.parts.append(f'<polyline points="{path}" fill="none" {style}/>')

    def dot(self, x, y, colour):
        px, py = self.at(x, y)
        self.parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.5" fill="{colour}"/>')

    def text(self, x, y, words, anchor="middle", dx=0.0, dy=0.0):
        px, py = self.at(x, y)
        self.parts.append(f'<text x="{px + dx:.1f}" y="{py + dy:.1f}" text-anchor="{anchor}">{words}</text>')

    def axes(self, xticks, yticks, title):
        self.line([(self.xs[0], self.ys[1]), (self.xs[0], self.ys[0]), (self.xs[1], self.ys[0])], 'stroke="#555"')
        for x in xticks:
            self.text(x, self.ys[0], f"{x:g}", dy=14)
        for y in yticks:
            self.line([(self.xs[0], y), (self.xs[1], y)], 'stroke="#ddd"')
            self.text(self.xs[0], y, f"{y:g}", "end", dx=-5, dy=4)
        self.text(0.5 * (self.xs[0] + self.xs[1]), self.ys[1], title, dy=-12)


def figure(ends, limit, times, errors):
    """The end state over the step, and errors in the last cycle of the report's run and of the default scheme's."""
    left = Panel(60, 250, (0.0, 0.105), (694.0, 714.0))
    left.axes([0, 0.025, 0.05, 0.1], [695, 700, 705, 710], "λ at the top, t = 120 s [kN], over h [s]")
    left.line([(0.0, limit / 1e3), (0.105, limit / 1e3)], 'stroke="#2b7" stroke-dasharray="5 3"')
    left.text(0.1, limit / 1e3, "default scheme, converged", "end", dy=-5)
    left.line([(h, value / 1e3) for h, value in ends], 'stroke="#27b"')
    left.text(0.06, 709.0, "cable-1994, 80 elements", "end")
    for h, value in ends:
        left.dot(h, value / 1e3, "#27b")
    left.dot(0.1, PRINTED / 1e3, "#c33")
    left.text(0.1, PRINTED / 1e3, "print of 1994", "end", dy=32)
    right = Panel(380, 300, (105.0, 120.0), (-40.0, 40.0))
    right.axes([105, 110, 115, 120], [-40, -20, 0, 20, 40], "λ at the top less the converged one [kN], over t [s]")
    for values, style, words, height in zip(errors, ["#27b", "#2b7"], ["cable-1994, 40 elements, h = 0.1 s", "default scheme, tolerance 1e-3"],
                                            [34.0, 29.0], strict=True):
        right.line([(t, value / 1e3) for t, value in zip(times, values, strict=True) if t >= 105.0], f'stroke="{style}"')
        right.dot(111.0, height, style)
        right.text(111.0, height, words, "start", dx=8, dy=4)
    body = "\n".join(left.parts + right.parts)
    FIGURE.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 700 255" font-family="sans-serif" font-size="11">\n'
                      f'<rect width="700" height="255" fill="white"/>\n{body}\n</svg>\n', encoding="utf-8")


def main():
    program = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "target/release/moorline").resolve()
    times, converged, fine = run(program, FINE)
    limit = converged[-1]
    print("| method | elements | h | λ at t = 120 s | from converged | largest | smallest | solver time |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")

    def row(method, elements, step, values, summary):
        cycle = [value for t, value in zip(times, values, strict=True) if t >= 105.0 - 1e-9]
        off = 100.0 * (values[-1] / limit - 1.0)
        print(f"| {method} | {elements} | {step} | {values[-1] / 1e3:.2f} kN | {off:.2f} % | {max(cycle) / 1e3:.1f} kN | "
              f"{min(cycle) / 1e3:.1f} kN | {1e3 * summary['solver_seconds']:.0f} ms |")

    print(f"| print of 1994 | 40 | 0.1 s | {PRINTED / 1e3:.2f} kN | {100.0 * (PRINTED / limit - 1.0):.2f} % | | | |")
    _, report, summary = run(program, [])
    row("cable-1994", 40, "0.1 s", report, summary)
    ends = []
    for step in STEPS:
        _, values, summary = run(program, [f"solver.fixed_step={step}", "lines[0].sections[0].elements=80"])
        row("cable-1994", 80, f"{step} s", values, summary)
        ends.append((step, values[-1]))
    _, coarse, summary = run(program, COARSE)
    row("default, tolerance 1e-3", summary["elements"], "controlled", coarse, summary)
    row("default, tolerance 1e-4", 80, "controlled", converged, fine)
    errors = [[a - b for a, b in zip(values, converged, strict=True)] for values in (report, coarse)]
    figure(ends, limit, times, errors)
    print(f"\n{FIGURE}")


if __name__ == "__main__":
    main()
