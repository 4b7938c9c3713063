"""The largest communication step at which a vessel on two lines is stable in libcosim, by input mode and mass. Not a test: it measures.

    python tests/fmu/stability.py target/dist/moorline.fmu

The system is that of `examples/osp`, with the master of fixed steps, which exchanges values at communication points and nothing else. A run is
stable if it reaches the end and the vessel surges in the second half no further than with a step of 0.02 s, and half as far again.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples/osp"
MODES = {1: "auto", 2: "extrapolate", 3: "hold-velocity", 4: "delay"}
MASSES = (2e7, 2e6, 5e5)
STEPS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)
END = 120.0


def initial(variable: str, kind: str, value) -> str:
    return f'<InitialValue variable="{variable}"><{kind} value="{value}"/></InitialValue>'


def surge(folder: pathlib.Path, step: float, mode: int, mass: float, velocities: bool) -> float:
    """Largest surge in the second half [m]; infinite where the run does not reach its end."""
    text = (EXAMPLE / "OspSystemStructure.xml").read_text(encoding="utf-8")
    text = text.replace('"0.1"/>', f'"{step}"/>').replace('stepSize="0.1"', f'stepSize="{step}"')
    text = text.replace("<BaseStepSize>0.1<", f"<BaseStepSize>{step}<")
    text = text.replace("<InitialValues>", "<InitialValues>" + initial("input.interpolation", "Integer", mode))
    vessel = f'<Simulator name="vessel" source="Vessel.fmu" stepSize="{step}"'
    text = text.replace(f"{vessel}/>", f"{vessel}><InitialValues>{initial('mass', 'Real', mass)}</InitialValues></Simulator>")
    if not velocities:
        text = re.sub(r".*fairlead\.velocity.*\n", "", text)
    (folder / "OspSystemStructure.xml").write_text(text, encoding="utf-8")
    execution = CosimExecution.from_osp_config_file(osp_path=str(folder))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer=observer)
    index = execution.slave_index_from_instance_name("vessel")
    reference = next(v.reference for v in execution.slave_variables(index) if v.name.decode() == "bow.position.x")
    largest, count = 0.0, round(END / step)
    for number in range(count):
        if not execution.step():
            return float("inf")
        x = observer.last_real_values(slave_index=index, variable_references=[reference])[0] - 50.0
        if not abs(x) < 100.0:
            return float("inf")
        if number > count // 2:
            largest = max(largest, abs(x))
    return largest


def with_integers(fmu: pathlib.Path, out: pathlib.Path):
    """The FMU with its enumerations declared as integers: libcosim sets no enumerations."""
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(out, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            if name == "modelDescription.xml":
                content = re.sub(rb"<Enumeration declaredType=\"[^\"]*\" ", b"<Integer ", content)
            target.writestr(name, content)


def measure(folder: pathlib.Path, mode: int, mass: float, velocities: bool) -> str:
    reference = surge(folder, STEPS[0], 1, mass, True)
    last = "none"
    for step in STEPS[1:]:
        if not surge(folder, step, mode, mass, velocities) < 1.5 * reference:
            break
        last = f"{step} s"
    return last


if __name__ == "__main__":
    log_output_level(CosimLogLevel.FATAL)
    fmu = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with_integers(fmu, folder / "moorline.fmu")
        build = [sys.executable, "-m", "pythonfmu", "build", "-f", str(EXAMPLE / "vessel.py"), "-d", name]
        subprocess.run(build, check=True, capture_output=True)
        for mass in MASSES:
            for mode, word in MODES.items():
                print(f"{mass / 1e3:7.0f} t, {word}: {measure(folder, mode, mass, True)}", flush=True)
            print(f"{mass / 1e3:7.0f} t, auto, positions alone: {measure(folder, 1, mass, False)}", flush=True)
