"""What it costs to moor a ship instead of a line, as ratios in one run, and the mooring of a wave-energy device beside MoorDyn, as tables in
docs/benchmarks.md.

    cargo build --release && python3 tests/bench/mooring.py

Default settings, one core, everything in turn, the smallest of several times. (a) the built-in line alone and on a driven body; (b) eight lines on a vessel and
each alone; (c) three lines at a free point, and each alone with its ends on the same way; (d) three chains with a float at each joint (six lines), surge 2 m and heave 1 m of 10 s,
60 s, against MoorDyn with the same properties; (e) twenty lines at ten points.
"""

import copy
import csv
import json
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measure import ROOT, in_environment, machine, on_one_core, program, put, table
from scenes import BUILT_IN

MOTION = {"kind": "sinusoidal", "period": 12.0, "sine": [2.0, 1.0, 0.7], "ramp": 24.0}
CHAIN = {"ea": 8e8, "mass": 158.0, "diameter": 0.09, "submerged_weight": 1350.0, "drag": {"normal": 1.2, "tangential": 0.1}, "added_mass": {"normal": 1.0}}


def run(scene):
    """Time of the loop of steps [s], work, and the rows of the time series by column."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "scene.json")
        file.write_text(json.dumps(scene), encoding="utf-8")
        subprocess.run([program(), "run", file, "-q", "-o", Path(folder, "out")], check=True)
        summary = json.loads(Path(folder, "out/summary.json").read_text(encoding="utf-8"))
        with open(Path(folder, "out/timeseries.csv"), encoding="utf-8") as rows:
            columns = list(csv.DictReader(rows))
    return sum_of(summary), summary, columns


def sum_of(summary):
    """On one core the lines come one after the other."""
    return summary["solver_seconds"]


def turns(scenes, rounds=9):
    """The smallest time of each of several scenes, taken in turn, and the last summary."""
    best, last = [math.inf] * len(scenes), [None] * len(scenes)
    for _ in range(rounds):
        for k, scene in enumerate(scenes):
            seconds, summary, _ = run(scene)
            best[k], last[k] = min(best[k], seconds), summary
    return best, last


def on_body(scene, motion):
    """The lines of a scene on a body that moves as their fairleads do."""
    moored = copy.deepcopy(scene)
    moored["motion"] = {"kind": "fixed"}
    six = {"sine": [*motion["sine"], 0, 0, 0], "cosine": [*motion.get("cosine", [0, 0, 0]), 0, 0, 0]}
    moored["bodies"] = [{"name": "ship", "motion": {**motion, **six}}]
    for line in moored["lines"]:
        line["fairlead"] = {"body": "ship", "at": line["fairlead"]}
    return moored


def eight():
    lines = []
    for k, (x, y) in enumerate([(95, 8), (95, -8), (-90, 14), (-90, -14)]):
        for spread in (30, 50):
            dx, dy = math.cos(math.radians(spread)) * math.copysign(1, x), math.sin(math.radians(spread)) * math.copysign(1, y)
            lines.append({
                "name": f"{k}-{spread}", "fairlead": [x, y, -6.0], "anchor": [x + 720 * dx, y + 720 * dy, -100.0],
                "sections": [{"type": "chain", "length": 750.0}],
            })
    return {"environment": {"depth": 100.0}, "line_types": {"chain": CHAIN}, "lines": lines, "motion": MOTION, "run": {"duration": 120.0}}


def star():
    """Three lines that meet 60 m down under a float, one of them moved at its upper end."""
    rope = {"ea": 2e8, "mass": 30.0, "diameter": 0.14, "submerged_weight": 140.0, "drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}}
    point = {"name": "joint", "position": [0, 0, -60], "mass": 3000.0, "volume": 20.0, "drag_area": 6.0, "added_mass": 8000.0}
    ends = [([40.0, 0.0, -2.0], 72.0, "rope"), ([-350.0, 200.0, -150.0], 430.0, "chain"), ([-350.0, -200.0, -150.0], 430.0, "chain")]
    lines = [
        {"name": f"l{k}", "fairlead": at, "anchor": {"point": "joint"}, "sections": [{"type": kind, "length": length, "elements": 20}]}
        for k, (at, length, kind) in enumerate(ends)
    ]
    for line in lines[1:]:
        line["fairlead"], line["anchor"] = {"point": "joint"}, line["fairlead"]
    lines[0]["fairlead"] = {"body": "ship", "at": [0, 0, 0]}
    body = {"name": "ship", "position": [40.0, 0.0, -2.0], "motion": {**MOTION, "sine": [2.0, 1.0, 0.7, 0, 0, 0]}}
    return {
        "environment": {"depth": 150.0}, "line_types": {"rope": rope, "chain": CHAIN}, "lines": lines, "points": [point], "bodies": [body],
        "run": {"duration": 120.0},
    }


def farm():
    """Ten shared points in a row, each held by a chain to the bed, joined by ropes to the next, the first by a driven end: twenty lines."""
    scene = star()
    lines, points = [], []
    for k in range(10):
        x = -200.0 * k
        points.append({
            "name": f"p{k}", "position": [x, 0, -40], "mass": 3000.0, "volume": 25.0, "drag_area": 6.0, "added_mass": 8000.0,
        })
        lines.append({"name": f"leg{k}", "fairlead": {"point": f"p{k}"}, "anchor": [x, 60.0, -150.0], "sections": [{"type": "rope", "length": 124.0, "elements": 20}]})
        fairlead = {"body": "ship", "at": [0, 0, 0]} if k == 0 else {"point": f"p{k - 1}"}
        length = 212.0 if k == 0 else 206.0
        lines.append({"name": f"span{k}", "fairlead": fairlead, "anchor": {"point": f"p{k}"}, "sections": [{"type": "rope", "length": length, "elements": 20}]})
    scene |= {"lines": lines, "points": points}
    scene["bodies"][0]["position"] = [200.0, 0.0, -10.0]
    return scene


def parted(scene, folder):
    """The lines of a scene each for itself: its free points are driven along the way that they go in it."""
    _, _, rows = run(scene)
    alone = copy.deepcopy(scene)
    for point in alone["points"]:
        name = point["name"]
        file = Path(folder, f"{name}.csv")
        # At rest before the start, as in the run.
        text = "".join(",".join([row["time"], *(row[f"{name}.{axis}"] for axis in "xyz")]) + "\n" for row in rows)
        file.write_text("t,x,y,z\n" + text, encoding="utf-8")
        point["motion"] = {"kind": "file", "path": str(file)}
    return alone


def floats():
    scene = json.loads((ROOT / "examples/wave-energy-floats.json").read_text(encoding="utf-8"))
    scene["run"] = {"duration": 60.0, "output_step": 0.1}
    # Deep enough for the floats to stay below the surface, which a point of MoorDyn does not know.
    scene["environment"]["depth"] = 88.0
    for line in scene["lines"]:
        if line["name"].startswith("lower"):
            line["anchor"][2] = -88.0
    return scene


def deck(scene, segments, step):
    """The wave-energy mooring as MoorDyn's input."""
    kind = scene["line_types"]["upper"]
    gravity, density = 9.80665, 1025.0
    d = kind["diameter"]
    weight = kind["mass"] * gravity - density * gravity * math.pi / 4 * d * d
    stiffness = weight / d
    numbers = [d, kind["mass"], kind["ea"], kind["ea"] * kind["damping"], 0.0, kind["drag"]["normal"], 1.0, kind["drag"]["tangential"], 0.0]
    points, lines, names = [], [], {}
    for line in scene["lines"]:
        if line["name"].startswith("lower"):
            names[line["name"]] = len(points) + 1
            points.append(f"{len(points) + 1} Coupled {' '.join(map(repr, line['anchor']))} 0 0 0 0")
    for line in scene["lines"]:
        if line["name"].startswith("upper"):
            names[line["name"]] = len(points) + 1
            points.append(f"{len(points) + 1} Coupled {' '.join(map(repr, line['fairlead']['at']))} 0 0 0 0")
    for point in scene["points"]:
        names[point["name"]] = len(points) + 1
        x, y, z = point["position"]
        # Ca multiplies the displaced mass.
        points.append(f"{len(points) + 1} Free {x!r} {y!r} {z!r} {point['mass']!r} {point['volume']!r} {point['drag_area']!r} {point['added_mass'] / (density * point['volume'])!r}")
    for number, line in enumerate(scene["lines"], 1):
        leg = line["name"][-1]
        if line["name"].startswith("upper"):
            lines.append(f"{number} main {names['float ' + leg]} {names[line['name']]} {line['sections'][0]['length']!r} {max(segments // 4, 4)} -")
        else:
            lines.append(f"{number} main {names[line['name']]} {names['float ' + leg]} {line['sections'][0]['length']!r} {segments} -")
    new = "\n"
    return f"""a wave-energy mooring
---------------------- LINE TYPES
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (N-m^2) (-) (-) (-) (-)
main {" ".join(repr(float(x)) for x in numbers)}
---------------------- POINTS
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
{new.join(points)}
---------------------- LINES
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (-) (#) (#) (m) (-) (-)
{new.join(lines)}
---------------------- OPTIONS
0 writeLog
1 disableOutput
rk2 tScheme
{step!r} dtM
{gravity!r} g
{density!r} rho
{scene["environment"]["depth"] - weight / stiffness!r} WtrDpth
{stiffness / d!r} kBot
0.0 cBot
1.0 dtIC
200.0 TmaxIC
20.0 CdScaleIC
1e-3 threshIC
---------------------- END
"""


def device(scene, t):
    motion = scene["bodies"][0]["motion"]
    omega, xi = math.tau / motion["period"], min(t / motion["ramp"], 1.0)
    ease = xi * xi * (3 - 2 * xi)
    return [ease * (s * math.sin(omega * t) + c * math.cos(omega * t)) for s, c in zip(motion["sine"][:3], motion["cosine"][:3])]


def moordyn_run(scene, segments, per_row):
    """Tension at the first upper fairlead at every row, and the CPU time of the loop of steps."""
    import moordyn
    from peer import silence

    h = 0.1 / per_row
    anchors = [x for line in scene["lines"] if line["name"].startswith("lower") for x in line["anchor"]]
    fairleads = [line["fairlead"]["at"] for line in scene["lines"] if line["name"].startswith("upper")]
    count = round(scene["run"]["duration"] / 0.1) * per_row
    places = []
    for k in range(count + 1):
        shift = device(scene, k * h)
        places.append(anchors + [a + s for at in fairleads for a, s in zip(at, shift)])
    speeds = [[(q - p) / h for p, q in zip(a, b)] for a, b in zip(places, places[1:])]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "lines.txt")
        file.write_text(deck(scene, segments, h), encoding="utf-8")
        with silence():
            system = moordyn.Create(str(file))
            try:
                moordyn.Init(system, places[0], [0.0] * 18)
                found = []
                started = time.process_time()
                for k in range(count):
                    force = moordyn.Step(system, places[k], speeds[k], k * h, h)
                    if (k + 1) % per_row == 0:
                        found.append(math.hypot(*force[9:12]))
                return found, time.process_time() - started
            finally:
                moordyn.Close(system)


def apart(found, exact):
    """rms difference over the rms of what varies, from 20 s on."""
    pairs = list(zip(found, exact))[200:]
    mean = sum(b for _, b in pairs) / len(pairs)
    return math.sqrt(sum((a - b) ** 2 for a, b in pairs) / sum((b - mean) ** 2 for _, b in pairs))


def step_of_fmu():
    """Time of a doStep of 0.1 s of the ship's FMU, by the C functions [us]."""
    sys.path.insert(0, str(ROOT / "tests/fmu"))
    from master import OK, Fmu, Line

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "ship.fmu")
        subprocess.run([program(), "pack", ROOT / "examples/spread-moored-ship.json", "-o", file], check=True)
        line = Line(Fmu(str(file), folder=Path(folder, "unpacked")))

        def said(t):
            w = math.tau / 12.0
            return {
                "ship.position.x": 2.0 * math.sin(w * t) - 0.0, "ship.velocity.x": 2.0 * w * math.cos(w * t),
                "ship.position.z": 0.6 * math.sin(w * t), "ship.velocity.z": 0.6 * w * math.cos(w * t),
            }

        line.start(said)
        spent = []
        for _ in range(1200):
            line.move(said, line.time)
            begun = time.perf_counter()
            assert line.do_step(line.time, 0.1) == OK, line.log
            spent.append(time.perf_counter() - begun)
            line.time += 0.1
        line.free()
    return 1e6 * sorted(spent)[len(spent) // 2]


def main():
    in_environment()
    on_one_core()
    rows = []

    def row(what, ours, other, ratio, bar):
        rows.append([what, ours, other, ratio, bar])
        print(*rows[-1], sep=" | ", flush=True)

    (alone, body), _ = turns([copy.deepcopy(BUILT_IN), on_body(BUILT_IN, BUILT_IN["motion"])], 25)
    row("(a) the built-in line, 120 s: on a driven body, alone", f"{1e3 * body:.2f} ms", f"{1e3 * alone:.2f} ms", f"{body / alone:.3f}", "1.03")
    (alone, body), _ = turns([eight(), on_body(eight(), MOTION)])
    row("(b) eight lines, 120 s: on a vessel, alone", f"{1e3 * body:.1f} ms", f"{1e3 * alone:.1f} ms", f"{body / alone:.3f}", "1")
    micro = step_of_fmu()
    row("(b) doStep of 0.1 s of the ship's FMU, median", f"{micro:.0f} us", "", "", "100 us")
    with tempfile.TemporaryDirectory() as folder:
        for what, scene in (("(c) three lines, 120 s: at a free point", star()), ("(e) twenty lines, 120 s: at ten free points", farm())):
            (joined, alone), (one, other) = turns([scene, parted(scene, folder)])
            row(f"{what}, each alone with its ends on the same way", f"{1e3 * joined:.1f} ms", f"{1e3 * alone:.1f} ms", f"{joined / alone:.2f}", "1.5")
            print("steps", one["steps"], other["steps"], "iterations", one["newton_iterations"], other["newton_iterations"])
    head = ["what", "together", "apart", "ratio", "bar"]
    put("mooring", "python3 tests/bench/mooring.py", table(head, rows) + f"\n\nOne core of {machine()}.")

    scene = floats()
    fine = copy.deepcopy(scene)
    fine["solver"] = {"tolerance": 1e-5}
    _, _, columns = run(fine)
    exact = [float(r["upper a.tension"]) for r in columns[1:]]
    best, found = math.inf, None
    for _ in range(9):
        seconds, _, columns = run(scene)
        best, found = min(best, seconds), [float(r["upper a.tension"]) for r in columns[1:]]
    rows = [["moorline, default settings", f"{1e3 * best:.1f} ms", f"{100 * apart(found, exact):.2f} %", ""]]
    print(*rows[-1], sep=" | ", flush=True)
    kept = {}
    for segments, per_row in ((20, 80), (40, 160), (80, 800)):
        try:
            kept[segments], seconds = moordyn_run(scene, segments, per_row)
        except (RuntimeError, OSError) as error:
            rows.append([f"MoorDyn, {segments} segments", "", f"failed: {error}", ""])
            continue
        off = apart(kept[segments], exact)
        rows.append([f"MoorDyn, {segments} and {max(segments // 4, 4)} segments, step {100 / per_row:.3g} ms", f"{seconds:.2f} s", f"{100 * off:.2f} %", f"{seconds / best:.0f}"])
        print(*rows[-1], sep=" | ", flush=True)
    finest = sorted(kept)[-2:]
    own = apart(kept[finest[0]], kept[finest[1]]) if len(finest) == 2 else math.nan
    text = table(["program", "time of the steps", "error (rms of what varies)", "times ours"], rows)
    text += f"\n\nError against moorline at a tolerance of 1e-5. MoorDyn's two finest meshes differ by {100 * own:.2f} %. One core of {machine()}."
    put("floats", "python3 tests/bench/mooring.py", text)


if __name__ == "__main__":
    sys.exit(main())
