"""A vessel on two lines in masters that people have, at communication steps that they take, as a table in docs/coupling.md.

    .ci/release fmu && pip install libcosimpy ecospy pythonfmu && python3 tests/bench/masters.py target/dist/moorline.fmu

The vessel is that of examples/osp (20 000 t, three motions, a swell of 12 s). libcosim and Ecos step all together (Jacobi); calls from a script of
one's own can let the vessel go first. Error of both tensions in percent of their rms, and the largest in percent of the largest, after 30 s of
120 s; the judge is the script that steps all together at 5 ms.
"""

from __future__ import annotations

import math
import pathlib
import re
import subprocess
import sys
import tempfile

from measure import ROOT, put

sys.path[:0] = [str(ROOT / "examples/osp"), str(ROOT / "tests/fmu")]

from ecospy import EcosSimulation, EcosSimulationStructure
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
from master import OK, Fmu, Line
from vessel import ARM, Vessel

END, FROM, FINE = 120.0, 30.0, 0.005
STEPS = (0.1, 0.2, 0.3, 0.5, 1.0)
AUTO, DELAY = 1, 4
SIGNS = {"bow": 1.0, "stern": -1.0}
OSP = (ROOT / "examples/osp/OspSystemStructure.xml").read_text(encoding="utf-8")

Rows = list[tuple[float, float]]


def script(fmu: pathlib.Path, step: float, first: bool, foresees: bool = False) -> Rows:
    """Plain calls: all together with `auto`, or the vessel first and the lines with `delay`; its forces held or extrapolated."""
    vessel, loaded, lines, rows = Vessel(instance_name="vessel"), Fmu(str(fmu)), {}, []
    for end, sign in SIGNS.items():
        lines[end] = line = Line(loaded)
        assert line.set_real({"anchor.position.x": sign * 1233.97}) == OK
        assert line.set_integer({"input.interpolation_index": DELAY if first else AUTO}) == OK
        line.start(lambda _, sign=sign: ([sign * ARM, 0.0, 0.0], [0.0] * 3))
        vessel.forces[end] = [line.get_real(f"force.{axis}")[1][0] for axis in "xyz"]
    before = {end: list(force) for end, force in vessel.forces.items()}
    where = lambda sign: ([vessel.position[0] + sign * ARM, *vessel.position[1:]], list(vessel.velocity))
    for number in range(round(END / step)):
        at = {end: where(sign) for end, sign in SIGNS.items()}
        now = {end: list(force) for end, force in vessel.forces.items()}
        parts = math.ceil(step / 0.05 - 1e-9) if foresees else 1
        for part in range(parts):
            ahead = (part + 0.5) / parts if foresees else 0.0
            for end in SIGNS:
                vessel.forces[end] = [new + ahead * (new - old) for new, old in zip(now[end], before[end])]
            vessel.do_step(number * step + part * step / parts, step / parts)
        before = now
        for end, sign in SIGNS.items():
            motion = where(sign) if first else at[end]
            assert lines[end].step(lambda _, motion=motion: motion, step) == OK, lines[end].log
            vessel.forces[end] = [lines[end].get_real(f"force.{axis}")[1][0] for axis in "xyz"]
        rows.append(tuple(lines[end].get_real("tension")[1][0] for end in SIGNS))
    return rows


def libcosim(fmu: pathlib.Path, step: float) -> Rows:
    """The example's system at another step."""
    with tempfile.TemporaryDirectory() as folder:
        text = re.sub(r'stepSize="0.1"', f'stepSize="{step}"', OSP.replace("<BaseStepSize>0.1<", f"<BaseStepSize>{step}<"))
        text = text.replace('source="moorline.fmu"', f'source="{fmu}"').replace('source="Vessel.fmu"', f'source="{vessel_fmu}"')
        pathlib.Path(folder, "OspSystemStructure.xml").write_text(text, encoding="utf-8")
        log_output_level(CosimLogLevel.ERROR)
        execution = CosimExecution.from_osp_config_file(osp_path=folder)
        observer = CosimObserver.create_last_value()
        execution.add_observer(observer=observer)
        found = {}
        for end in SIGNS:
            slave = execution.slave_index_from_instance_name(f"{end} line")
            found[end] = slave, next(v.reference for v in execution.slave_variables(slave) if v.name == b"tension")
        rows = []
        for _ in range(round(END / step)):
            assert execution.step(step_count=1)
            values = (observer.last_real_values(slave_index=slave, variable_references=[reference]) for slave, reference in found.values())
            rows.append(tuple(value[0] for value in values))
        return rows


def ecos(fmu: pathlib.Path, step: float) -> Rows:
    with EcosSimulationStructure() as structure:
        structure.add_model("vessel", vessel_fmu)
        values = {}
        for end, sign in SIGNS.items():
            structure.add_model(f"{end} line", fmu)
            for axis in "xyz":
                for quantity in ("position", "velocity"):
                    structure.make_real_connection(f"vessel::{end}.{quantity}.{axis}", f"{end} line::fairlead.{quantity}.{axis}")
                structure.make_real_connection(f"{end} line::force.{axis}", f"vessel::{end}.force.{axis}")
            values |= {f"{end} line::fairlead.position.x": sign * ARM, f"{end} line::anchor.position.x": sign * 1233.97}
        structure.add_parameter_set("given", values)
        with EcosSimulation(step, structure=structure) as simulation:
            assert simulation.init(parameter_set="given")
            rows = []
            for _ in range(round(END / step)):
                simulation.step(1)
                rows.append(tuple(simulation.get_real(f"{end} line::tension") for end in SIGNS))
            return rows


def cell(rows: Rows, step: float) -> str:
    every, pairs = round(step / FINE), []
    for number, row in enumerate(rows, 1):
        if number * step > FROM:
            pairs += zip(row, exact[number * every - 1])
    off = math.sqrt(sum((a - b) ** 2 for a, b in pairs) / sum(b * b for _, b in pairs))
    return f"{100.0 * off:.2f} / {100.0 * max(abs(a - b) for a, b in pairs) / max(b for _, b in pairs):.1f}"


fmu = pathlib.Path(sys.argv[1]).resolve()
WAYS = {
    "libcosim, `fixedStep`: together, `auto`": lambda step: libcosim(fmu, step),
    "Ecos, code or SSP: together, `auto`": lambda step: ecos(fmu, step),
    "a loop of one's own, plain calls: together, `auto`": lambda step: script(fmu, step, first=False),
    "… the vessel first, `delay`": lambda step: script(fmu, step, first=True),
    "… the vessel first, `delay`, forces extrapolated": lambda step: script(fmu, step, first=True, foresees=True),
}
with tempfile.TemporaryDirectory() as name:
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", str(ROOT / "examples/osp/vessel.py"), "-d", name]
    subprocess.run(build, check=True, capture_output=True)
    vessel_fmu = pathlib.Path(name, "Vessel.fmu")
    exact = script(fmu, FINE, first=False, foresees=True)
    lines = ["| master | " + " | ".join(f"{step} s" for step in STEPS) + " |", "| --- |" + " ---: |" * len(STEPS)]
    for way, run in WAYS.items():
        lines.append(f"| {way} | " + " | ".join(cell(run(step), step) for step in STEPS) + " |")
        print(lines[-1], file=sys.stderr)
put("masters", "python3 tests/bench/masters.py", "\n".join(lines), ROOT / "docs/coupling.md")
