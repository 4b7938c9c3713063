"""Run a vessel on two mooring lines in OSP's libcosim.

    pip install libcosimpy pythonfmu
    cp moorline.fmu moorline_OspModelDescription.xml examples/osp/
    cd examples/osp && pythonfmu build -f vessel.py && python run.py

Prints the vessel's surge and both tensions every ten seconds.
"""

import pathlib
import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

SECONDS, REPORT = 120, 10


def run(folder: pathlib.Path) -> list[tuple[float, float, float, float]]:
    """Rows of time [s], surge [m], tension of the bow line and of the stern line [N]."""
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
    for time in range(REPORT, SECONDS + REPORT, REPORT):
        if not execution.simulate_until(target_time=int(time * 1e9)):
            raise RuntimeError(f"the simulation stopped before t = {time} s")
        surge = value("vessel", "bow.position.x") - 50.0
        rows.append((float(time), surge, value("bow line", "tension"), value("stern line", "tension")))
    return rows


if __name__ == "__main__":
    here = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    for time, surge, bow, stern in run(here):
        print(f"t = {time:5.0f} s   surge {surge:7.3f} m   bow {bow / 1e3:8.1f} kN   stern {stern / 1e3:8.1f} kN")
