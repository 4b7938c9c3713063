"""A rigid ship with surge, sway and yaw in FMPy, moored by the FMU of examples/spread-moored-ship.json.

usage: moorline pack examples/spread-moored-ship.json -o ship.fmu
       python examples/moored_ship.py ship.fmu [STEP]

The ship sends its pose and rates and gets one force and one moment back: no fairlead, no anchor and no lever stands in this script. A wind of
1.5 MN blows it aside, and the offset it ends at is the one at which the mooring holds the wind.
"""

import math
import shutil
import sys

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

MASS = 4.0e7  # with added mass [kg]
INERTIA = 9.0e10  # yaw, with added inertia [kg m2]
DAMPING = (9.0e5, 1.2e6, 2.5e9)  # [N s/m], [N s/m], [N m s]
WIND = (0.6e6, 0.4e6, 1.0e7)  # force along x and y [N], moment about z [N m]


def main(path: str, step: float = 0.1, duration: float = 900.0) -> tuple[list, list]:
    description = read_model_description(path)
    reference = {v.name: v.valueReference for v in description.modelVariables}
    folder = extract(path)
    mooring = FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="mooring",
    )
    said = [f"ship.{name}" for name in ("position.x", "position.y", "attitude.yaw", "velocity.x", "velocity.y", "angular_velocity.z")]
    loads = [f"ship.{name}" for name in ("force.x", "force.y", "moment.z")]
    inputs, outputs = [reference[name] for name in said], [reference[name] for name in loads]
    x, v, time = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0
    mooring.instantiate()
    mooring.setupExperiment(startTime=0.0)
    mooring.enterInitializationMode()
    mooring.setReal(inputs, x + v)
    mooring.exitInitializationMode()
    force = mooring.getReal(outputs)
    while time < duration - 1e-9:
        # The ship goes a step with the force it knows, then the mooring follows.
        for axis, mass in enumerate((MASS, MASS, INERTIA)):
            a = (WIND[axis] + force[axis] - DAMPING[axis] * v[axis]) / mass
            v[axis] += step * a
            x[axis] += step * v[axis]
        mooring.setReal(inputs, x + v)
        mooring.doStep(currentCommunicationPoint=time, communicationStepSize=step)
        force = mooring.getReal(outputs)
        time += step
    mooring.terminate()
    mooring.freeInstance()
    shutil.rmtree(folder, ignore_errors=True)
    return x, force


if __name__ == "__main__":
    x, force = main(sys.argv[1], *(float(argument) for argument in sys.argv[2:3]))
    print(f"offset {x[0]:.2f} m, {x[1]:.2f} m, {math.degrees(x[2]):.2f} deg")
    for name, wind, held in zip(("surge", "sway", "yaw"), WIND, force):
        print(f"{name}: the wind's {wind:.3e} is held by {held:.3e}")
    assert all(abs(wind + held) < 0.01 * abs(wind) for wind, held in zip(WIND, force)), "not yet at rest"
