"""What the C program reads from the library, against the command on the same file and against what a chain's weight demands.

    python compare.py MOORLINE DRIVE
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SPREAD = HERE.parents[2] / "tests/data/moordyn/spread-v2.txt"
FLOAT = HERE / "float.txt"
JUMPER = HERE / "jumper.txt"
MOORLINE, DRIVE = sys.argv[1:3]

# Allowed differences. At rest the command and the library solve the same equations: the tolerance is that of the equilibrium. In motion the
# library learns where everything is and how fast every 0.1 s, the command knows the whole motion: the share of the range of a tension.
AT_REST = 1.0e-6
IN_MOTION = 0.02
# In steps of a two-hundredth of a second, what a tension does from step to step beside what it does in two: the share of its range. The
# motion has a period of 27 s.
ALTERNATING = 0.01


def out(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{words}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr}")
    return done.stdout


def close(what, found, wanted, allowed):
    if not abs(found - wanted) <= allowed:
        sys.exit(f"FAILED {what}: {found!r}, not {wanted!r} to {allowed:.3g}")


def at_rest(deck):
    told = json.loads(out(MOORLINE, "statics", deck, "--json"))
    rows = [row.split() for row in out(DRIVE, "statics", deck).splitlines()]
    lines = {row[1]: [float(x) for x in row[2:]] for row in rows if row[0] == "line"}
    points = {row[1]: [float(x) for x in row[2:]] for row in rows if row[0] == "point"}
    for line in told["lines"]:
        number = line["name"].removeprefix("line")
        tension, most, _, count = lines[number]
        scale = line["tension"]
        close(f"{deck.name}: tension of {line['name']}", tension, scale, AT_REST * scale)
        nodes = [[float(x) for x in row[3:]] for row in rows if row[:2] == ["node", number]]
        assert len(nodes) == count
        length = lines[number][2]
        # End A first.
        for end, where in ((0, line["nodes"][-1]), (-1, line["nodes"][0])):
            for axis in range(3):
                close(f"end of {line['name']}", nodes[end][axis], where["position"][axis], 1e-3)
        close(f"tension at end A of {line['name']}", math.hypot(*nodes[0][3:6]), line["anchor_tension"], AT_REST * scale)
        close(f"largest tension of {line['name']}", most, max(n["tension"] for n in line["nodes"]), AT_REST * scale)
        assert all(node[6] == 0.0 for node in nodes), "something moves at rest"
        yield deck.name, line["name"], nodes, length, scale
    for body in told.get("bodies", []):
        if body["name"] == "body1":
            force = [float(row[2]) for row in rows if row[0] == "f"]
            for axis in range(3):
                close("force on body1", force[axis], body["force"][axis], AT_REST * 1e6)
                close("moment on body1", force[3 + axis], body["moment"][axis], AT_REST * 1e7)
    if "7" in points:
        # The free point: what the lines and its weight do to it is nothing.
        for axis in range(3):
            close("force on the free point", points["7"][3 + axis], 0.0, AT_REST * 1e6)
        told_point = told["points"][0]["position"]
        for axis in range(3):
            close("free point", points["7"][axis], told_point[axis], 1e-4)


def weight(name, line):
    """Weight in water per length [N/m] and EA [N] of a line of the two files."""
    diameter, mass, ea = {
        ("spread-v2.txt", "line1"): (0.16, 180.0, 7.5e8),
        ("spread-v2.txt", "line2"): (0.08, 27.0, 4.1e8),
        ("spread-v2.txt", "line3"): (0.16, 180.0, 7.5e8),
        ("spread-v2.txt", "line4"): (0.16, 180.0, 7.5e8),
        ("float.txt", "line1"): (0.09, 60.0, 2.6e8),
        ("float.txt", "line2"): (0.09, 60.0, 2.6e8),
        ("float.txt", "line3"): (0.12, 14.0, 5.0e6),
        ("float.txt", "line4"): (0.09, 60.0, 2.6e8),
    }[(name, line)]
    return 9.80665 * (mass - 1025.0 * math.pi / 4 * diameter**2), ea


def hangs(name, line, nodes, length, scale):
    """Between nodes that are off the bed and in the water, tension changes by the weight, and nothing else; the pull is along the line."""
    bed = -90.0 if name.startswith("spread") else -70.0
    w, ea = weight(name, line)
    span = length / (len(nodes) - 1)
    seen = 0
    for one, two in zip(nodes, nodes[1:]):
        if not all(bed + 1.0 < node[2] < -1.0 for node in (one, two)):
            continue
        seen += 1
        close(f"{name} {line}: change of the vertical pull", two[5] - one[5], w * span, 1e-3 * abs(w) * span + 1e-6 * scale)
        for axis in (3, 4):
            close(f"{name} {line}: horizontal pull", two[axis], one[axis], 1e-5 * scale)
        chord = [two[k] - one[k] for k in range(3)]
        mean = [0.5 * (two[3 + k] + one[3 + k]) for k in range(3)]
        size, pull = math.hypot(*chord), math.hypot(*mean)
        close(f"{name} {line}: length", size, span * (1 + pull / ea), 5e-3 * span)
        close(f"{name} {line}: direction", sum(a * b for a, b in zip(chord, mean)), size * pull, 1e-3 * size * pull)
    return seen


def in_motion(deck, bodies, period, ramp, amplitudes, end):
    step = 0.1
    motion = json.dumps({"kind": "sinusoidal", "period": period, "sine": amplitudes, "ramp": ramp})
    with tempfile.TemporaryDirectory() as folder:
        # Without damping of the bed, with which the solver does not get through some motions of a point that hangs between lines.
        text = deck.read_text()
        assert text.count("3.0e5   cBot") == 1
        deck = Path(folder) / deck.name
        deck.write_text(text.replace("3.0e5   cBot", "0       cBot"))
        sets = [f"run.duration={end}", f"run.output_step={step}"]
        sets += [f"bodies[{body}].motion={motion}" for body in bodies]
        out(MOORLINE, "run", deck, "-o", folder, "--quiet", *[word for item in sets for word in ("--set", item)])
        with open(Path(folder) / "timeseries.csv", newline="") as file:
            told = list(csv.DictReader(file))
        driven = out(DRIVE, "run", deck, step, end, period, ramp, *amplitudes)
    rows = [[float(x) for x in row.split()] for row in driven.splitlines()]
    names = [name for name in told[0] if name.endswith(".tension")]
    worst = 0.0
    assert len(rows) == len(told) - 1, (len(rows), len(told))

    def compared(what, column, name):
        nonlocal worst
        wanted = [float(row[name]) for row in told[1:]]
        # What hardly changes is measured against what it is.
        size = max(max(wanted) - min(wanted), 0.05 * max(map(abs, wanted)))
        off = max(abs(row[column] - value) for row, value in zip(rows, wanted)) / size
        worst = max(worst, off)
        if not off <= IN_MOTION:
            sys.exit(f"FAILED {deck.name}: {what} is off by {off:.2%} of its range in motion")

    for row, want in zip(rows, told[1:]):
        close("time", row[0], float(want["time"]), 1e-9)
    for number, name in enumerate(names):
        compared(name, 1 + number, name)
    first = 1 + len(names)
    if "body1.force_x" in told[0]:
        for axis, name in enumerate("xyz"):
            compared(f"force {name}", first + axis, f"body1.force_{name}")
            compared(f"moment {name}", first + 3 + axis, f"body1.moment_{name}")
            compared(f"force {name} on the rod", first + 6 + axis, f"vessel.force_{name}")
    return worst


def in_short_steps(deck, period, ramp, amplitudes, end):
    """The tension follows the motion, without bursts that change sign from step to step; the largest of them, as a share of the range."""
    rows = [[float(x) for x in row.split()] for row in out(DRIVE, "run", deck, 0.005, end, period, ramp, *amplitudes).splitlines()]
    tension = [row[1] for row in rows]
    swing = max(abs(one - 2 * two + three) / 4 for one, two, three in zip(tension, tension[1:], tension[2:]))
    share = swing / (max(tension) - min(tension))
    if not share <= ALTERNATING:
        sys.exit(f"FAILED {deck.name}: the tension alternates by {share:.2%} of its range from step to step")
    return share


seen = 0
for deck in (SPREAD, FLOAT):
    for found in at_rest(deck):
        seen += hangs(*found)
assert seen > 60, seen
spread = in_motion(SPREAD, [0], 11.0, 22.0, [1.2, 0.5, 0.8, 1.0, 2.0, -1.5], 24.0)
floating = in_motion(FLOAT, [0, 1], 9.0, 18.0, [0.6, -0.3, 0.5, 2.0, 3.0, 2.0], 15.0)
jumping = in_short_steps(JUMPER, 27.0, 27.0, [10.0, 0.0, 0.0, 0.0, 0.0, 0.0], 55.0)
print(f"at rest: {seen} stretches of line hang as their weight demands; in motion: off by at most {spread:.2%} and {floating:.2%} of the range; "
      f"in steps of 5 ms they alternate by at most {jumping:.3%} of it")
