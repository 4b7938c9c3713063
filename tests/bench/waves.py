"""What a sea costs: the built-in case in waves of more and more components, beside the same run in still water, as a table in docs/benchmarks.md.

    cargo build --release && python3 tests/bench/waves.py [--quick]

100 s, each run the fastest of three, all in one session on one core. The error is the rms difference of the tension at the fairlead from a run in
which the components are summed one by one: the same sea with every component turned by 1e-6 degrees from the one before, which no sum by cells holds.
`--quick` leaves out the thousand components summed one by one, which take minutes.
"""

import math
import random
import sys

from measure import fastest, machine, on_one_core, put, table
from scenes import BUILT_IN, altered

BASE = altered(BUILT_IN, run={"duration": 100.0}, motion={"ramp": 7.5})
HS, TP, GAMMA = 4.0, 10.0, 3.3
BAND, POINTS = (0.3, 5.0), 4000
APART = 1e-6  # [deg]


def shape(x):
    """The JONSWAP spectrum at x times the frequency of its peak, up to a factor."""
    width = 0.07 if x <= 1.0 else 0.09
    return x**-5 * math.exp(-1.25 * x**-4) * GAMMA ** math.exp(-0.5 * ((x - 1.0) / width) ** 2)


def jonswap(count):
    """Components of equal energy, each at a random frequency in its share of the spectrum."""
    draw = random.Random(1)
    step = (BAND[1] - BAND[0]) / POINTS
    middles = [BAND[0] + (n + 0.5) * step for n in range(POINTS)]
    energy = [shape(x) for x in middles]
    total, components, cell, below = sum(energy), [], 0, 0.0
    for n in range(count):
        wanted = (n + draw.random()) / count * total
        while cell + 1 < POINTS and below + energy[cell] <= wanted:
            below += energy[cell]
            cell += 1
        x = middles[cell] + ((wanted - below) / energy[cell] - 0.5) * step
        components.append({"amplitude": HS / 4 * math.sqrt(2 / count), "period": TP / x, "phase_deg": 360 * draw.random()})
    return components


def sea(components):
    return altered(BASE, environment={"waves": {"kind": "components", "components": components, "ramp": TP}})


def main():
    on_one_core()
    still = fastest(BASE, 3)
    rows = [["still water", 1000 * still.seconds, 1.0, "", ""]]
    regular = fastest(altered(BASE, environment={"waves": {"kind": "regular", "amplitude": HS / 2, "period": TP}}), 3)
    rows.append(["regular wave", 1000 * regular.seconds, regular.seconds / still.seconds, "", ""])
    for count in (50, 200, 1000):
        components = jonswap(count)
        run = fastest(sea(components), 3)
        row = [f"{count} components", 1000 * run.seconds, run.seconds / still.seconds, "", ""]
        if count < 1000 or "--quick" not in sys.argv:
            judge = fastest(sea([{**one, "direction_deg": APART * n} for n, one in enumerate(components)]), 1)
            row[3] = f"{judge.seconds / still.seconds:.1f}"
            row[4] = f"{math.dist(run.tension, judge.tension) / math.hypot(*judge.tension):.1e}"
        rows.append(row)
    head = ["sea", "time [ms]", "per still water", "summed one by one", "error of the tension"]
    text = table(head, [[name, f"{ms:.1f}", f"{ratio:.1f}", *rest] for name, ms, ratio, *rest in rows])
    print(text)
    put("waves", "python3 tests/bench/waves.py --quick", f"{text}\n\nOne core of {machine()}.")


if __name__ == "__main__":
    main()
