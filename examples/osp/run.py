"""Run a system of FMUs in OSP's libcosim: a vessel on two mooring lines,

    pip install libcosimpy pythonfmu
    cp moorline.fmu moorline_OspModelDescription.xml examples/osp/
    cd examples/osp && pythonfmu build -f vessel.py
    python run.py . vessel/bow.position.x "bow line/tension" "stern line/tension"

or a ship and its whole mooring, one FMU each:

    moorline pack examples/spread-moored-ship.json -o examples/osp/ship/mooring.fmu
    cd examples/osp/ship && pythonfmu build -f ship.py
    python ../run.py . ship/position.x ship/position.y mooring/ship.force.x mooring/ship.force.y

Prints the variables named (SIMULATOR/VARIABLE) every ten seconds.
"""

import pathlib
import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

SECONDS, REPORT = 120, 10


def run(folder: pathlib.Path, seen: list[tuple[str, str]], seconds: int = SECONDS) -> list[list[float]]:
    """Rows of time [s] and the values of variables, each named by its simulator and itself."""
    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_osp_config_file(osp_path=str(folder))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer=observer)

    def value(simulator: str, variable: str) -> float:
        index = execution.slave_index_from_instance_name(simulator)
        slave = execution.slave_variables(index)
        reference = next(v.reference for v in slave if v.name.decode() == variable)
        return observer.last_real_values(slave_index=index, variable_references=[reference])[0]

    rows = []
    for time in range(REPORT, seconds + REPORT, REPORT):
        if not execution.simulate_until(target_time=int(time * 1e9)):
            raise RuntimeError(f"the simulation stopped before t = {time} s")
        rows.append([float(time), *(value(*name) for name in seen)])
    return rows


if __name__ == "__main__":
    print("t [s]", *sys.argv[2:], sep=", ")
    for row in run(pathlib.Path(sys.argv[1]), [tuple(name.split("/", 1)) for name in sys.argv[2:]]):
        print(*(f"{number:.6g}" for number in row), sep=", ")
