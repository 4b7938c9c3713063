"""What slack costs: a floating rope in a fold and in a heap, and a hawser in waves, beside the built-in case and the snapping chain, as a table in
docs/benchmarks.md.

    cargo build --release && python3 tests/bench/slack.py

Default settings, meshes of the program's own choice but for the snapping chain, whose scene gives one. All in one run on one core, in turn,
the smallest time of several runs.
"""

import copy
import json
import sys

from measure import ROOT, Run, fastest, machine, on_one_core, put, table
from scenes import BUILT_IN

#: Times when slackness alone chose mesh and steps and every kink a new factor, on another machine [s].
BEFORE = {"rope, 48 m": 7.0, "rope, 60 m": 12.0, "hawser": 297.0}


def rope(length):
    """From the bed at 50 m to 2.8 m below the surface; it floats."""
    return {
        "environment": {"depth": 50.0},
        "line_types": {"rope": {"ea": 1.29e8, "mass": 4.0, "diameter": 0.086, "drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}}},
        "lines": [{"fairlead": [0, 0, -2.8], "anchor": [0, 0, -50], "sections": [{"type": "rope", "length": length}]}],
        "motion": {"kind": "sinusoidal", "sine": [1, 0, 0.2], "period": 8.0},
        "run": {"duration": 60.0},
    }


HAWSER = {
    "environment": {"depth": 50.0, "waves": {"kind": "regular", "amplitude": 1.5, "period": 8.0}},
    "line_types": {
        "rope": {
            "ea": 5e6, "tension_strain": [[0, 0], [0.05, 1.5e5], [0.1, 5e5], [0.2, 2.5e6]], "mass": 15.0, "diameter": 0.16,
            "submerged_weight": -20.0, "damping": 0.01, "drag": {"normal": 1.2}, "added_mass": {"normal": 1.0},
        }
    },
    "lines": [{"fairlead": [60, 0, 1], "anchor": [0, 0, 2], "sections": [{"type": "rope", "length": 70.0}]}],
    "motion": {"kind": "sinusoidal", "sine": [-15, 5, 0], "period": 60.0},
    "run": {"duration": 300.0},
}
SNAPPING = json.loads((ROOT / "examples/snapping-chain.json").read_text(encoding="utf-8"))
CASES = [
    ("built-in", copy.deepcopy(BUILT_IN)),
    ("rope, 48 m", rope(48.0)),
    ("rope, 60 m", rope(60.0)),
    ("hawser", HAWSER),
]


def main():
    on_one_core()
    snapping = copy.deepcopy(SNAPPING)
    motion = ROOT / "examples" / snapping["motion"]["path"]
    snapping["motion"]["path"] = str(motion)
    rows, base = [], None
    for name, scene in [*CASES, ("snapping chain (taut)", snapping)]:
        run: Run = fastest(scene, 15)
        summary, until = run.summary, run.times[-1] - run.times[0]
        each = run.seconds / (until * summary["elements"])
        base = base or each
        ahead = f"{BEFORE[name]:g} s" if name in BEFORE else ""
        rows.append([
            name, f"{until:g} s", summary["elements"], summary["steps"], f"{summary['newton_iterations'] / summary['steps']:.1f}",
            f"{1000 * run.seconds:.0f} ms", ahead, f"{1e6 * each:.1f} us", f"{each / base:.1f}",
        ])
        print(*rows[-1], sep=" | ", flush=True)
    head = ["scene", "simulated", "elements", "steps", "iterations per step", "time of the steps", "was", "per second and element", "of the built-in"]
    put("slack", "python3 tests/bench/slack.py", table(head, rows) + f"\n\nOne core of {machine()}.")


if __name__ == "__main__":
    sys.exit(main())
