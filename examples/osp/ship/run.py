"""Run a ship and its whole mooring, one FMU each, in OSP's libcosim.

    pip install libcosimpy pythonfmu
    moorline pack examples/spread-moored-ship.json -o examples/osp/ship/mooring.fmu
    cd examples/osp/ship && pythonfmu build -f ship.py && python run.py

Prints the ship's offset and what the mooring holds it with every minute.
"""

import pathlib
import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

SECONDS, REPORT = 900, 60
SEEN = (
    ("ship", "position.x"),
    ("ship", "position.y"),
    ("ship", "attitude.yaw"),
    ("mooring", "ship.force.x"),
    ("mooring", "ship.force.y"),
    ("mooring", "ship.moment.z"),
)


def run(folder: pathlib.Path, seconds: int = SECONDS) -> list[list[float]]:
    """Rows of time [s], surge and sway [m], yaw [rad], force along x and y [N] and moment about z [N m] of the mooring."""
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
        rows.append([float(time), *(value(*name) for name in SEEN)])
    return rows


if __name__ == "__main__":
    here = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    for time, x, y, yaw, fx, fy, mz in run(here):
        print(f"t = {time:4.0f} s   offset {x:6.2f} m, {y:6.2f} m, {yaw:7.4f} rad   held by {fx / 1e3:7.1f} kN, {fy / 1e3:7.1f} kN, {mz / 1e6:6.2f} MN m")
