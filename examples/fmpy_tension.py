"""Drive a mooring line from FMPy and plot its tension.

    pip install fmpy matplotlib
    python examples/fmpy_tension.py moorline.fmu [picture.png]

The fairlead surges by 3 m with a period of 12 s. The master sends position and velocity at every communication point, nothing else.
"""

import math
import shutil
import sys

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

STEP, END = 0.1, 120.0
AMPLITUDE, OMEGA = 3.0, 2 * math.pi / 12.0


def run(path: str) -> tuple[list[float], list[float]]:
    """Times [s] and tensions at the fairlead [kN]."""
    description = read_model_description(path)
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    folder = extract(path)
    line = FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="bow line",
    )
    line.instantiate()
    line.setupExperiment(startTime=0.0)
    line.enterInitializationMode()
    line.setReal([reference["line.length"]], [1210.0])
    line.exitInitializationMode()

    inputs = [reference["fairlead.position.x"], reference["fairlead.velocity.x"]]
    times, tensions = [], []
    for index in range(round(END / STEP)):
        time = index * STEP
        ease = 1 - math.exp(-((time / 10.0) ** 2))
        slope = 2 * time / 100.0 * math.exp(-((time / 10.0) ** 2))
        sin, cos = math.sin(OMEGA * time), math.cos(OMEGA * time)
        line.setReal(inputs, [AMPLITUDE * ease * sin, AMPLITUDE * (ease * OMEGA * cos + slope * sin)])
        line.doStep(currentCommunicationPoint=time, communicationStepSize=STEP)
        times.append(time + STEP)
        tensions.append(line.getReal([reference["tension"]])[0] / 1000)
    line.terminate()
    line.freeInstance()
    shutil.rmtree(folder, ignore_errors=True)
    return times, tensions


if __name__ == "__main__":
    import matplotlib

    if len(sys.argv) > 2:
        matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    times, tensions = run(sys.argv[1] if len(sys.argv) > 1 else "moorline.fmu")
    plt.figure(figsize=(9, 4))
    plt.plot(times, tensions)
    plt.xlabel("time [s]")
    plt.ylabel("tension at the fairlead [kN]")
    plt.grid(alpha=0.3)
    plt.tight_layout()
    if len(sys.argv) > 2:
        plt.savefig(sys.argv[2], dpi=120)
    else:
        plt.show()
