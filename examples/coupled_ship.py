"""A ship on two lines, coupled in FMPy: the ship goes first, its lines after it, in one pass.

    moorline pack -o moorline.fmu && python examples/coupled_ship.py moorline.fmu

Over each step the ship goes with the lines' forces, extrapolated linearly from the last two steps; then the lines are given where the ship
is at the *end* of the step, and with `input.interpolation` = `delay` they go exactly there. Nothing is guessed, nothing is repeated. Compared
with steps of 0.02 s; docs/coupling.md has other recipes, six motions and other masses.
"""

import math
import shutil
import sys

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

MASS, DAMPING, DELAY, END = 20.0e6, 2.0e5, 4, 150.0


def load(time: float) -> float:
    """Force of the waves and the slow drift on the ship [N]."""
    ease = min(time / 20.0, 1.0)
    return ease * (4.0e6 * math.sin(2 * math.pi / 9.0 * time) + 2.0e5 * math.sin(2 * math.pi / 90.0 * time))


class Line:
    """One mooring line, out to one side."""

    def __init__(self, description, folder, name, anchor):
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier="moorline", instanceName=name)
        self.fmu.instantiate()
        self.fmu.setReal([self.reference["anchor.position.x"]], [anchor])
        self.fmu.setInteger([self.reference["input.interpolation_index"]], [DELAY])
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def get(self, name):
        return self.fmu.getReal([self.reference[name]])[0]

    def go(self, time, step, surge, speed):
        self.fmu.setReal([self.reference["fairlead.position.x"], self.reference["fairlead.velocity.x"]], [surge, speed])
        self.fmu.doStep(time, step)

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


def run(description, folder, step):
    """Tension of the bow line after every step."""
    lines = [Line(description, folder, "bow", 1183.970), Line(description, folder, "stern", -1183.970)]
    surge = speed = 0.0
    before = now = sum(line.get("force.x") for line in lines)
    tensions = {}
    for number in range(round(END / step)):
        time = number * step
        # The ship: four parts of Runge and Kutta's second order, with the lines' force on a straight line through the last two.
        parts = max(1, round(step / 0.05))
        slope, part = (now - before) / step, step / parts
        for k in range(parts):
            force = lambda tau, v: load(time + tau) + now + slope * tau - DAMPING * v
            middle = speed + 0.5 * part * force(k * part, speed) / MASS
            surge += part * middle
            speed += part * force((k + 0.5) * part, middle) / MASS
        for line in lines:
            line.go(time, step, surge, speed)
        before, now = now, sum(line.get("force.x") for line in lines)
        tensions[round(time + step, 6)] = lines[0].get("tension")
    for line in lines:
        line.end()
    return tensions


def main():
    description, folder = read_model_description(sys.argv[1]), extract(sys.argv[1])
    exact = run(description, folder, 0.02)
    for step in (0.1, 0.5, 1.0):
        found = {time: tension for time, tension in run(description, folder, step).items() if time > 50.0}
        error = math.dist(found.values(), [exact[time] for time in found]) / math.hypot(*found.values())
        print(f"steps of {step} s: tensions from {min(found.values()) / 1e3:.0f} to {max(found.values()) / 1e3:.0f} kN, {error:.2%} rms off")
        assert error < 0.005, "the recipe is good to half a percent"
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
