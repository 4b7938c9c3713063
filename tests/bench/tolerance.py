"""Achieved against requested tolerance, the mesh left to the program: a table in docs/benchmarks.md.

    cargo build --release && python3 tests/bench/tolerance.py [--quick]

The achieved error is the rms error of the tension at the fairlead (of the snapping chain: of the mean of its cycle maxima). A second run on the
same mesh with a twentieth of the tolerance has the mesh's error; what the two runs differ by is the steps'. `--quick` takes the default
scheme at 1e-2 and 1e-3, and prints only.
"""

import copy
import sys

from measure import (
    SCHEMES,
    Failed,
    Run,
    errors,
    judged,
    on_one_core,
    put,
    reference,
    table,
)
from scenes import CASES

TOLERANCES = [1e-2, 1e-3, 1e-4]
HEAD = ["scene", "scheme", "requested", "elements", "achieved (rms)", "achieved / requested", "largest", "mesh", "steps"]


def on_nodes(scene, nodes):
    """The scene of one section on exactly these nodes."""
    scene = copy.deepcopy(scene)
    (line,) = scene["lines"]
    (section,) = line["sections"]
    line["sections"] = [{**section, "length": b - a, "elements": 1} for a, b in zip(nodes, nodes[1:])]
    return scene


def row(case, exact, scheme, tolerance):
    """One row: requested, achieved, and what of it is the mesh's and the steps'."""
    head = [case.name, scheme, f"{100 * tolerance:g} %"]
    try:
        run = Run(case.scene, scheme=scheme, tolerance=tolerance)
        found = judged(case, run.times, run.tension)
        achieved, largest = errors(case, found, exact)
        fine = Run(on_nodes(case.scene, run.nodes), scheme=scheme, tolerance=max(0.05 * tolerance, 1e-7))
        converged = judged(case, fine.times, fine.tension)
    except Failed as failure:
        return [*head, "", str(failure).splitlines()[0], "", "", "", ""]
    of_mesh, of_steps = errors(case, converged, exact)[0], errors(case, found, converged)[0]
    share = achieved / (100 * tolerance)
    blame = "" if share <= 1 else ("**mesh**" if of_mesh > of_steps else "**steps**")
    number = lambda x: f"{x:.2g} %"
    return [*head, run.summary["elements"], number(achieved), f"{share:.2f} {blame}".strip(), number(largest), number(of_mesh), number(of_steps)]


def main():
    quick = "--quick" in sys.argv
    on_one_core()
    rows = []
    for case in CASES:
        exact = reference(case)
        for scheme in SCHEMES[: 1 if quick else None]:
            for tolerance in TOLERANCES[: 2 if quick else None]:
                rows.append(row(case, exact, scheme, tolerance))
                print(*rows[-1], sep=" | ", flush=True)
        if not quick:
            within = sum("**" not in cells[5] and cells[3] != "" for cells in rows)
            text = f"{table(HEAD, rows, 2)}\n\n{within} of {len(rows)} are within what was requested."
            put("tolerance", "python3 tests/bench/tolerance.py", text)


if __name__ == "__main__":
    main()
