"""What is saved where a scene does not need something: scenes with and without it, instructions and iterations of the time loop, as a table in
docs/benchmarks.md.

    cargo build --release && python3 tests/bench/skips.py

The same short run each time, 20 equal elements, fixed steps of 0.05 s, scheme adams-moulton; only the keys in the first column change. "with"
and "without" may differ in what the line does, and so in iterations: what one iteration of one element costs is the fair comparison, and what
the run costs is what the user gets.
"""

import copy
import sys

from callgrind import count, ready
from measure import Failed, put, table
from scenes import BUILT_IN, altered, with_mesh

STEP = 0.05
BASE = altered(BUILT_IN, run={"duration": 15.0}, motion={"ramp": 7.5})


def chain(scene, **changes):
    """The scene with another line type."""
    scene = copy.deepcopy(scene)
    scene["line_types"]["chain"].update(changes)
    return scene


def lifted(scene, height):
    """The scene with its fairlead above the still water."""
    scene = copy.deepcopy(scene)
    scene["lines"][0]["fairlead"][2] += height
    return scene


def sea(**environment):
    return altered(BASE, environment=environment)


CURRENT = [{"z": 0.0, "velocity": [0.5, 0.2, 0.0]}, {"z": -120.0, "velocity": [0.1, 0.0, 0.0]}]
WAVES = {"kind": "regular", "amplitude": 1.0, "period": 10.0}
DRY = {"drag": {"normal": 0.0}, "added_mass": {"normal": 0.0}}
PAIRS = [
    ("bed (depth 120 m, half the line lies; depth 1000 m, none does)", BASE, sea(depth=1000.0)),
    ("current", sea(current=CURRENT), BASE),
    ("waves (amplitude 1 m)", sea(waves=WAVES), BASE),
    ("waves, water surface `none`", sea(waves=WAVES, surface="none"), sea(surface="none")),
    ("bending (`ei` 1e5 N m²)", chain(BASE, ei=1.0e5), BASE),
    ("still surface `pierced`, fairlead in it; `none`", BASE, sea(surface="none")),
    ("fairlead 5 m above the surface; in it", lifted(BASE, 5.0), BASE),
    ("friction of the bed (0.5)", sea(seabed={"stiffness": 5075.2591, "friction": 0.5}), BASE),
    ("damping of the bed", sea(seabed={"stiffness": 5075.2591, "damping": 500.0}), BASE),
    ("axial damping", BASE, chain(BASE, damping=0.0)),
    ("drag and added mass", BASE, chain(BASE, **DRY)),
    ("third dimension (sway 2.1 m; none: a planar scene)", BASE, altered(BASE, motion={"sine": [5.08, 0.0, 0.0]})),
    ("motion (none: a line at rest under a constant input)", BASE, altered(BASE, motion={"sine": [0.0, 0.0, 0.0]})),
]


def main():
    ready()
    known, rows = {}, []

    def counted(scene):
        key = repr(scene)
        if key not in known:
            known[key] = count(with_mesh(scene, 20), fixed_step=STEP)
        return known[key]

    for name, with_it, without in PAIRS:
        try:
            (a, more), (b, less) = counted(with_it), counted(without)
        except Failed as failure:
            rows.append([name, str(failure).splitlines()[0], "", "", "", "", "", ""])
        else:
            work = [a["element_iterations"], b["element_iterations"]]
            each = [more / max(work[0], 1), less / max(work[1], 1)]
            steps = [more / a["steps"], less / b["steps"]]
            shares = [f"{100 * (1 - each[1] / each[0]):.0f} %" if work[1] else "", f"{100 * (1 - less / more):.0f} %"]
            rows.append([name, *work, *(f"{x:.0f}" for x in each), *(f"{x / 1000:.1f}" for x in steps), f"{shares[0]} / {shares[1]}"])
        print(*rows[-1], sep=" | ", flush=True)
    head = [
        "with; without", "element iterations with", "without", "instructions per element iteration with", "without",
        "thousand per step with", "without", "saved per iteration / of the run",
    ]
    put("skips", "python3 tests/bench/skips.py", table(head, rows))


if __name__ == "__main__":
    sys.exit(main())
