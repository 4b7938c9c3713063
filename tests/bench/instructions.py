"""The guard of speed: fails where a short run takes more than 3 % more instructions than tests/bench/instructions.json says.

    cargo build --release && python3 tests/bench/instructions.py [--update]

Fixed steps on a fixed mesh, so that neither step control nor meshing moves the count; the count does not depend on the machine's load, nor on its
processor, as long as that has AVX2. `--update` writes the new count: after a change that is worth its instructions, or that saves some, or after
a change of compiler.
"""

import json
import subprocess
import sys
from pathlib import Path

from callgrind import count, ready
from scenes import BUILT_IN, RISER, altered, with_mesh

KEPT = Path(__file__).with_name("instructions.json")
ALLOWED = 0.03
SHORT = {"run": {"duration": 15.0}, "motion": {"ramp": 7.5}}
RUNS = {
    "built-in, adams-moulton": (altered(BUILT_IN, **SHORT), "adams-moulton"),
    "built-in, esdirk3": (altered(BUILT_IN, **SHORT), "esdirk3"),
    "riser, adams-moulton": (altered(RISER, **SHORT), "adams-moulton"),
}


def compiler():
    return subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True).stdout.strip()


def main():
    ready()
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {"instructions": {}}
    found, faults = {}, []
    for name, (scene, scheme) in RUNS.items():
        summary, instructions = count(with_mesh(scene, 20), fixed_step=0.05, scheme=scheme)
        work = summary["element_iterations"]
        found[name] = {"instructions": instructions, "element_iterations": work}
        before = kept["instructions"].get(name)
        change = instructions / before["instructions"] - 1 if before else None
        print(
            f"{name}: {instructions} instructions, {work} element iterations, {instructions / work:.0f} each"
            + (f"; {100 * change:+.1f} % against {before['instructions']} and {before['element_iterations']}" if before else "")
        )
        if not before or change > ALLOWED:
            faults.append(name)
        elif change < -ALLOWED:
            print("  better: keep it with --update")
    if "--update" in sys.argv:
        KEPT.write_text(json.dumps({"compiler": compiler(), "instructions": found}, indent=2) + "\n", encoding="utf-8")
    elif faults:
        sys.exit(
            f"more than {100 * ALLOWED:g} % more instructions than {KEPT.name} allows: {', '.join(faults)}. Find what the time loop does more "
            f"(callgrind_annotate); where it is worth it, run {Path(__file__).name} --update and say why in the commit. "
            f"The counts were made with {kept.get('compiler', 'no compiler')}, this is {compiler()}."
        )


if __name__ == "__main__":
    main()
