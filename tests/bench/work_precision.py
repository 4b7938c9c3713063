"""Error against time of moorline and MoorDyn, in one run on one core: tables and pictures in docs/benchmarks.md.

    cargo build --release && python3 tests/bench/work_precision.py [--quick] [--runs N] [--few] [--without-peer] [SCENE ...]

Without names it takes all scenes of scenes.py. `--few` leaves the slow points out: given meshes, tolerances below 1e-4, 80 and 160
segments. `--quick` runs each scheme on the built-in case at default settings, and the smallest peer, writes nothing, and fails where the
error is above what is promised (0.1 % rms, 0.2 % at most); it never fails on time.

Time: `solver_seconds` of summary.json, the loop of time steps alone; of MoorDyn, the process's CPU time of the loop of its steps. The
smallest of several runs, some in a row and some in turn with all others. Error: of the tension at the fairlead against a converged reference: of the built-in case
tests/data/lindahl_sjoberg_tension.csv; of the others our own `esdirk3` on a fine mesh with fixed fine steps, which MoorDyn's finest
line cross-checks.
"""

import json
import math
import sys
from functools import partial

from measure import (
    ROOT,
    SCHEMES,
    Failed,
    Run,
    errors,
    fastest,
    in_environment,
    judged,
    machine,
    on_one_core,
    put,
    reference,
    table,
)

if "--without-peer" not in sys.argv:
    in_environment()
    import peer

from scenes import BUILT_IN, CASES, FINE, altered, with_mesh

TOLERANCES = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5]
MESHES = [5, 10, 20, 40, 80]
MESH_TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5]
SEGMENTS = [10, 20, 40, 80, 160]
PROMISED = (0.1, 0.2)
LEVELS = [1.0, 0.1, 0.01]
FEW = "--few" in sys.argv
STORE = ROOT / "target/bench"


def seconds_of(scene, solver):
    """Time of one run of moorline [s]."""
    return Run(scene, **solver).seconds


def peer_seconds(case, segments, scheme, steps):
    """Time of one run of MoorDyn [s]."""
    return peer.run(case.scene, segments, scheme, steps)[1]


def time_again(points, runs):
    """Times every point in turn, round after round: a processor that is slow for some seconds is so for all of them."""
    for _ in range(runs):
        for point in points:
            if "again" in point and point["seconds"] < 2.5:
                point["seconds"] = min(point["seconds"], point["again"]())
    for point in points:
        point.pop("again", None)


def ours(case, exact, runs):
    """Points of moorline: each scheme with step control, the mesh left to the program or given, tolerances over three decades."""
    for elements in [None] if FEW else [None, *MESHES]:
        for tolerance in MESH_TOLERANCES if elements else TOLERANCES[: 5 if FEW else None]:
            for scheme in SCHEMES:
                settings = f"{f'{elements} elements' if elements else 'automatic mesh'}, tolerance {tolerance:g}"
                point = {"program": "moorline", "scheme": scheme, "elements": elements, "tolerance": tolerance, "settings": settings}
                scene, solver = with_mesh(case.scene, elements), {"scheme": scheme, "tolerance": tolerance}
                try:
                    run = fastest(scene, runs, **solver)
                except Failed as failure:
                    yield {**point, "failed": str(failure)}
                    continue
                rms, largest = errors(case, judged(case, run.times, run.tension), exact)
                work = {key: run.summary[key] for key in ("steps", "newton_iterations", "element_iterations")}
                used = run.summary["elements"]
                again = partial(seconds_of, scene, solver)
                yield {**point, "used": used, "rms": rms, "largest": largest, "seconds": run.seconds, **work, "again": again}


def seldom(case, exact, runs):
    """Points of moorline with rows, and so steps, further apart than the other points have them: what suffices for a percent."""
    row = case.scene["run"]["output_step"]
    for every in (3, 5):
        step = every * row
        scene = altered(case.scene, run={"output_step": step})
        for tolerance in (2.5e-2, 2e-2, 1e-2):
            for scheme in SCHEMES:
                settings = f"automatic mesh, tolerance {tolerance:g}, rows every {step:g} s"
                point = {"program": "moorline", "scheme": scheme, "elements": None, "tolerance": tolerance, "settings": settings}
                solver = {"scheme": scheme, "tolerance": tolerance, "max_step": step}
                run = fastest(scene, runs, **solver)
                rms, largest = errors(case, judged(case, run.times, run.tension), exact[::every])
                work = {"used": run.summary["elements"], "steps": run.summary["steps"], "seconds": run.seconds}
                again = partial(seconds_of, scene, solver)
                yield {**point, "seldom": True, "rms": rms, "largest": largest, **work, "again": again}


def of_1994(case, runs):
    """Points of the report's own scheme: fixed steps, and its own law of extension, so against a reference with that law."""
    fine = {**FINE, "stretch": "report"}
    run = Run(with_mesh(case.scene, fine.pop("elements")), **fine)
    exact = judged(case, run.times, run.tension)
    for elements in MESHES[2:]:
        for step in (0.1, 0.05, 0.025, 0.01, 0.005):
            settings = f"{elements} elements, step {1e3 * step:g} ms"
            point = {"program": "moorline", "scheme": "cable-1994", "elements": elements, "tolerance": None, "settings": settings}
            try:
                run = fastest(with_mesh(case.scene, elements), runs, scheme="cable-1994", fixed_step=step)
            except Failed as failure:
                yield {**point, "failed": str(failure)}
                continue
            rms, largest = errors(case, judged(case, run.times, run.tension), exact)
            work = {"used": run.summary["elements"], "steps": run.summary["steps"], "seconds": run.seconds}
            yield {**point, "rms": rms, "largest": largest, **work}


def crossing(scene, segments):
    """Time in which an axial wave crosses a segment [s]."""
    (section,) = scene["lines"][0]["sections"]
    kind = scene["line_types"][section["type"]]
    return section["length"] / segments * math.sqrt(kind["mass"] / kind["ea"])


def fewest_steps(case, segments, scheme, bound):
    """Steps of MoorDyn per output step that carry it through the first quarter of the run without a tension above `bound`: the fewest, by
    bisection from those that the axial wave asks for (h < 1.41 of its crossing)."""
    end = 0.25 * case.scene["run"]["duration"]

    def holds(steps):
        try:
            return peer.run(case.scene, segments, scheme, steps, end, bound)
        except peer.Broken:
            return None

    bad, good = 0, max(1, math.ceil(case.scene["run"]["output_step"] / (1.41 * crossing(case.scene, segments))))
    while holds(good) is None:
        bad, good = good, 2 * good
    while good - bad > max(1, good // 12):
        middle = (bad + good) // 2
        bad, good = (bad, middle) if holds(middle) else (middle, good)
    return good


def whole(case, segments, scheme, steps, exact):
    """A whole run of MoorDyn: its errors and its time; None where it breaks."""
    row = case.scene["run"]["output_step"]
    try:
        tension, seconds = peer.run(case.scene, segments, scheme, steps)
    except peer.Broken:
        return None
    found = judged(case, [row * (k + 1) for k in range(len(tension))], tension)
    return (*errors(case, found, exact), seconds) if all(map(math.isfinite, found)) else None


def theirs(case, exact, runs):
    """Points of MoorDyn, each at its largest stable step. Weak instability does not break a run, it fills it with noise: stable is a step whose
    error is at most a quarter larger than that of a step a third as long as the longest that survives."""
    row, bound = case.scene["run"]["output_step"], 1.5 * max(exact)
    for segments in SEGMENTS[: 3 if FEW else None]:
        for scheme in ("rk4", "rk2"):
            point = {"program": "MoorDyn", "scheme": scheme, "elements": segments}
            steps = fewest_steps(case, segments, scheme, bound)
            fine = whole(case, segments, scheme, 3 * steps, exact)
            limit = 1.25 * fine[0] + 0.005 if fine else math.inf
            while (found := whole(case, segments, scheme, steps, exact)) is None or found[0] > limit:
                steps = math.ceil(1.2 * steps)
            rms, largest, seconds = found
            for _ in range(runs - 1 if seconds < 5.0 else 0):
                seconds = min(seconds, peer_seconds(case, segments, scheme, steps))
            again = partial(peer_seconds, case, segments, scheme, steps)
            settings = f"{segments} segments, step {1e3 * row / steps:.2g} ms"
            count = steps * round(case.scene["run"]["duration"] / row)
            yield {**point, "settings": settings, "rms": rms, "largest": largest, "seconds": seconds, "steps": count, "again": again}


def percent(x):
    return f"{x:.2g} %" if x < 10 else f"{x:.0f} %"


def milliseconds(seconds):
    return f"{1e3 * seconds:.1f} ms" if seconds < 0.1 else f"{1e3 * seconds:.0f} ms"


def is_default(point):
    return point["program"] == "moorline" and point["scheme"] == "adams-moulton" and not point["elements"] and point["tolerance"] == 1e-3


def report(case, points):
    """The tables of a case: the fastest at each level, the mesh left to the program, the peer; the rest is in the picture."""
    good = [p for p in points if "failed" not in p]
    peers = [p for p in good if p["program"] == "MoorDyn"]
    lines = [f"**{case.name}**: {case.about}.", "", f"![error against time, {case.name}](work-precision-{case.name}.svg)", ""]
    rows = []
    for level in LEVELS:
        for name in ("moorline", "MoorDyn"):
            enough = [p for p in good if p["program"] == name and p["rms"] <= level and p["largest"] <= 2 * level]
            best = min(enough, key=lambda p: p["seconds"], default=None)
            what = f"{best['scheme']}, {best['settings']}" if best else "none of these"
            found = [percent(best["rms"]), percent(best["largest"]), milliseconds(best["seconds"])] if best else ["", "", ""]
            rows.append([percent(level), name, what, *found])
    lines += ["The fastest within a level (rms, and largest error at most twice it):", ""]
    lines += [table(["level", "program", "settings", "rms error", "largest error", "time"], rows, 3), ""]
    kept = [p for p in points if p["program"] == "MoorDyn" or not p["elements"] or p["scheme"] == "cable-1994"]
    rows = []
    for p in kept:
        name = f"{p['program']} {p['scheme']}" + (" **(default)**" if is_default(p) else "")
        if "failed" in p:
            rows.append([name, p["settings"], p["failed"].splitlines()[0], "", "", ""])
        else:
            used = f", {p['used']} elements" if p["program"] == "moorline" else ""
            rows.append([name, p["settings"] + used, percent(p["rms"]), percent(p["largest"]), p["steps"], milliseconds(p["seconds"])])
    lines += [table(["program", "settings", "rms error", "largest error", "steps", "time"], rows, 2), ""]
    default = next((p for p in good if is_default(p)), None)
    if default:
        mine = (p for p in good if p["program"] == "moorline" and p["rms"] <= default["rms"] and p["largest"] <= default["largest"])
        quickest = min(mine, key=lambda p: p["seconds"])
        lines.append(
            f"Default settings take {milliseconds(default['seconds'])}; the fastest point of moorline that is as accurate "
            f"({quickest['scheme']}, {quickest['settings']}) takes {milliseconds(quickest['seconds'])}."
        )
        if peers:
            finest = max(peers, key=lambda p: (p["elements"], p["scheme"]))
            ratio = finest["seconds"] / default["seconds"]
            lines.append(
                f"MoorDyn with {finest['elements']} segments ({finest['scheme']}) takes {ratio:.{0 if ratio >= 10 else 2}f} times as long at an rms error of "
                f"{percent(finest['rms'])}, which is also how well the two programs' answers agree."
            )
    return "\n".join(lines)


def draw(axes, points, *how, **style):
    if points:
        axes.plot([1e3 * p["seconds"] for p in points], [p["rms"] for p in points], *how, **style)


def picture(case, points):
    """Error against time, log–log."""
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "moorline", "font.size": 9, "font.family": "sans-serif"})
    figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    good = [p for p in points if "failed" not in p]
    seldoms = any("seldom" in p for p in good)
    for scheme, colour in zip(SCHEMES, ("#0b6fa4", "#d1641f", "#3c8d40")):
        mine = [p for p in good if p["program"] == "moorline" and p["scheme"] == scheme]
        auto = sorted((p for p in mine if not p["elements"] and "seldom" not in p), key=lambda p: p["tolerance"], reverse=True)
        given = [p for p in mine if p["elements"]]
        draw(axes, auto, "o-", color=colour, label=f"moorline {scheme}, automatic mesh")
        draw(axes, given, ".", color=colour, alpha=0.45, label="  5 to 80 equal elements")
        draw(axes, [p for p in mine if "seldom" in p], "+", color=colour, alpha=0.6, label="  rows every 0.3 or 0.5 s" if seldoms else None)
    old = [p for p in good if p["scheme"] == "cable-1994"]
    draw(axes, old, "x", color="#8a5fa8", label="moorline cable-1994, 20 to 80 elements")
    for scheme, mark in (("rk2", "v:"), ("rk4", "s--")):
        other = [p for p in good if p["program"] == "MoorDyn" and p["scheme"] == scheme]
        draw(axes, other, mark, color="#555555", label=f"MoorDyn {scheme}, 10 to 160 segments")
    for p in filter(is_default, good):
        draw(axes, [p], "o", ms=13, mfc="none", mec="black", label="default settings")
    axes.set(xscale="log", yscale="log", xlabel="time of the loop of steps [ms]", title=case.name)
    axes.set_ylabel("error of the mean of the cycle maxima [%]" if case.peaks else "rms error of the fairlead tension [%]")
    axes.grid(which="major", alpha=0.3)
    axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(ROOT / f"docs/work-precision-{case.name}.svg", metadata={"Date": None})
    plt.close(figure)


def quick():
    """The promise of the default settings on the built-in case; the peer, small, must still run."""
    case, faults = CASES[0], []
    exact = reference(case)
    for scheme in SCHEMES:
        run = Run(BUILT_IN, scheme=scheme)
        found = errors(case, judged(case, run.times, run.tension), exact)
        print(f"{scheme}: {found[0]:.4f} % rms, {found[1]:.4f} % at most, {run.summary['element_iterations']} element iterations")
        if not all(a <= b for a, b in zip(found, PROMISED)):
            faults.append(f"{scheme} misses {PROMISED[0]} % rms, {PROMISED[1]} % at most")
    if "peer" in globals():
        tension, _ = peer.run(BUILT_IN, 20, "rk4", 5)
        found = errors(case, judged(case, [0.1 * (k + 1) for k in range(len(tension))], tension), exact)
        print(f"MoorDyn, 20 segments: {found[0]:.2f} % rms, {found[1]:.2f} % at most")
        if not found[0] < 10.0:
            faults.append("MoorDyn is far from the reference: the decks differ")
    sys.exit("\n".join(faults) or None)


def main():
    arguments = sys.argv[1:]
    on_one_core()
    if "--quick" in arguments:
        quick()
    runs = int(arguments[arguments.index("--runs") + 1]) if "--runs" in arguments else 5
    names = [a for a in arguments if not a.startswith("--") and not a.isdigit()]
    unknown = set(names) - {case.name for case in CASES}
    if unknown:
        sys.exit(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(case.name for case in CASES)}")
    STORE.mkdir(parents=True, exist_ok=True)
    for case in CASES:
        if names and case.name not in names:
            continue
        exact = reference(case)
        # The two programs take turns, so that a busy minute of the machine meets both.
        points, sources = [], [ours(case, exact, runs)]
        if case.name == "built-in":
            sources.append(seldom(case, exact, runs))
        if case.name == "built-in" and not FEW:
            sources.append(of_1994(case, runs))
        if "peer" in globals():
            sources.append(theirs(case, exact, min(runs, 3)))
        while sources:
            for source in list(sources):
                point = next(source, None)
                if point is None:
                    sources.remove(source)
                else:
                    points.append(point)
                    print(case.name, json.dumps({key: value for key, value in point.items() if key != "again"}), flush=True)
        time_again(points, runs)
        points.sort(key=lambda p: p["program"] == "MoorDyn")
        (STORE / f"work-precision-{case.name}.json").write_text(json.dumps(points, indent=1), encoding="utf-8")
        text = report(case, points)
        print(text)
        if "peer" in globals():
            picture(case, points)
            put(f"work-precision-{case.name}", "python3 tests/bench/work_precision.py", f"{text}\n\nMeasured on one core of {machine()}.")


if __name__ == "__main__":
    main()
