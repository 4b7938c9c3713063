"""Run an SSP package with FMPy: parameter sets, connections and fixed steps, nothing else.

    pip install fmpy
    python examples/ssp/run.py vessel-on-two-lines.ssp "vessel/bow.position.x" "bow line/tension" "stern line/tension"
    python examples/ssp/run.py moored-ship.ssp ship/position.x ship/position.y mooring/ship.force.x mooring/ship.force.y

prints the connectors named (COMPONENT/CONNECTOR) every ten seconds. FMPy's own `simulate_ssp` starts every connection at zero; a fairlead must start
where its line was put in equilibrium.
"""

import pathlib
import shutil
import sys

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.ssp.ssd import read_ssd

STEP, END, REPORT = 0.1, 120.0, 10.0


def run(package: str, seen: list[tuple[str, str]], end: float = END) -> list[list[float]]:
    """Rows of time [s] and the values of connectors, each named by its component and itself."""
    system = read_ssd(package).system
    folder = pathlib.Path(extract(package))
    fmus, references, unpacked = {}, {}, [folder]
    for component in system.elements:
        source = str(folder / component.source)
        description = read_model_description(source)
        unpacked.append(extract(source))
        fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=unpacked[-1],
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=component.name,
        )
        fmus[component.name] = fmu
        references[component.name] = {variable.name: variable.valueReference for variable in description.modelVariables}
        fmu.instantiate()
        fmu.setupExperiment(startTime=0.0)
        for binding in component.parameterBindings:
            for parameter in (p for values in binding.parameterValues for p in values.parameters):
                fmu.setReal([references[component.name][parameter.name]], [float(parameter.value)])
        fmu.enterInitializationMode()

    def value(component: str, connector: str) -> float:
        return fmus[component].getReal([references[component][connector]])[0]

    def exchange() -> None:
        values = [value(c.startElement, c.startConnector) for c in system.connections]
        for connection, number in zip(system.connections, values):
            target = connection.endElement
            fmus[target].setReal([references[target][connection.endConnector]], [number])

    exchange()
    for fmu in fmus.values():
        fmu.exitInitializationMode()
    rows = []
    for index in range(round(end / STEP)):
        exchange()
        for fmu in fmus.values():
            fmu.doStep(currentCommunicationPoint=index * STEP, communicationStepSize=STEP)
        if (index + 1) % round(REPORT / STEP) == 0:
            rows.append([(index + 1) * STEP, *(value(*name) for name in seen)])
    for fmu in fmus.values():
        fmu.terminate()
        fmu.freeInstance()
    for path in unpacked:
        shutil.rmtree(path, ignore_errors=True)
    return rows


if __name__ == "__main__":
    print("t [s]", *sys.argv[2:], sep=", ")
    for row in run(sys.argv[1], [tuple(name.split("/", 1)) for name in sys.argv[2:]]):
        print(*(f"{number:.6g}" for number in row), sep=", ")
