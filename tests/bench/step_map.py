"""Where each scheme is stable: fixed steps over four decades on scenes from tame to rough, as a table in docs/benchmarks.md.

    cargo build --release && python3 tests/bench/step_map.py

No step control and no refinement: what the scheme itself bears. 20 equal elements. A number is the largest tension of the run divided by that of
`esdirk3` with steps of 1 ms, at the same instants; a word is how the run ended. The program must end a run that it cannot go on with by an
error that names place and time: the script fails where one ends otherwise.
"""

import copy
import json
import math
import re
import sys

from measure import ROOT, SCHEMES, Failed, Run, on_one_core, put, table
from scenes import BUILT_IN, CHAIN, altered, with_mesh

STEPS = [1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.001, 0.0001]
ROW = 0.1
LENGTH = 20.0


def slack():
    """The garland of examples/slack-catenary.json, its upper end moved as much as it hangs slack."""
    scene = json.loads((ROOT / "examples/slack-catenary.json").read_text(encoding="utf-8"))
    scene["motion"] = {"kind": "sinusoidal", "period": 8.0, "sine": [8.0, 3.0, 4.0], "ramp": 8.0}
    return scene


def timed(scene):
    return with_mesh(altered(scene, run={"duration": LENGTH, "output_step": ROW}), 20)


moving = {"motion": {"ramp": 10.0}}
SCENES = {
    "built-in, full motion after 10 s": timed(altered(BUILT_IN, **moving)),
    "the same, bed 100 times stiffer": timed(altered(BUILT_IN, environment={"seabed": {"stiffness": 507525.91}}, **moving)),
    "slack line": timed(slack()),
    "snapping chain": timed(CHAIN),
}


def tensions(scene, step, scheme):
    """Tension by instant (in rows) of a run with a fixed step, or with step control where `step` is None."""
    scene = copy.deepcopy(scene)
    scene["run"]["output_step"] = max(ROW, step or 0.0)
    solver = {"fixed_step": step} if step else {}
    run = Run(scene, scheme=scheme, **solver)
    return {round(t / ROW): f for t, f in zip(run.times, run.tension, strict=True)}


def cell(scene, exact, step, scheme, messages):
    try:
        found = tensions(scene, step, scheme)
    except Failed as failure:
        time = re.search(r"t = ([0-9.]+) s", str(failure))
        messages.append(str(failure))
        return f"error, {float(time.group(1)):.2g} s" if time else "error without time"
    if not all(map(math.isfinite, found.values())):
        return "not a number"
    ratio = max(found.values()) / max(exact[k] for k in found)
    return f"{ratio:.3f}" if ratio < 10 else f"{ratio:.0e}"


def main():
    on_one_core()
    rows, messages = [], []
    for name, scene in SCENES.items():
        exact = tensions(scene, 0.001, "esdirk3")
        for scheme in SCHEMES:
            cells = [cell(scene, exact, step, scheme, messages) for step in [*STEPS, None]]
            rows.append([name, scheme, *cells])
            print(*rows[-1], sep=" | ", flush=True)
    text = table(["scene", "scheme", *(f"{step:g} s" for step in STEPS), "controlled"], rows, 2)
    text += f"\n\n{len(messages)} of {len(rows) * (len(STEPS) + 1)} runs ended with an error."
    if messages:
        text += f" The first says: {messages[0].splitlines()[0]}"
    put("step-map", "python3 tests/bench/step_map.py", text)
    if any("error without time" in row or "not a number" in row for row in rows):
        sys.exit("a run ended without saying when, or with a tension that is no number")


if __name__ == "__main__":
    main()
