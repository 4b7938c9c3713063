"""A simple vessel as an FMU: a mass free to move in x, y and z, with hydrostatic stiffness in heave, linear damping and a slow swell.

    pip install pythonfmu
    pythonfmu build -f examples/osp/vessel.py

Two mooring lines are attached at `bow` and `stern`, 50 m before and behind the centre. Rotations are left out.
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS = 2.0e7
DAMPING = (4.0e5, 6.0e5, 4.0e6)
HEAVE_STIFFNESS = 1.2e7
ARM = 50.0
SUBSTEPS = 10


class Vessel(Fmi2Slave):
    author = "The moorline authors"
    description = "A vessel on two mooring lines"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.mass = MASS
        self.swell = 5.0e5
        self.period = 12.0
        self.position = [0.0, 0.0, 0.0]
        self.velocity = [0.0, 0.0, 0.0]
        self.forces = {"bow": [0.0, 0.0, 0.0], "stern": [0.0, 0.0, 0.0]}
        for name in ("mass", "swell", "period"):
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability="tunable"))
        for end, arm in (("bow", ARM), ("stern", -ARM)):
            for axis, letter in enumerate("xyz"):
                offset = arm if axis == 0 else 0.0
                self.register_variable(
                    Real(
                        f"{end}.force.{letter}",
                        causality=Fmi2Causality.input,
                        getter=lambda end=end, axis=axis: self.forces[end][axis],
                        setter=lambda value, end=end, axis=axis: self.forces[end].__setitem__(axis, value),
                    )
                )
                self.register_variable(
                    Real(
                        f"{end}.position.{letter}",
                        causality=Fmi2Causality.output,
                        getter=lambda axis=axis, offset=offset: self.position[axis] + offset,
                    )
                )
                self.register_variable(
                    Real(f"{end}.velocity.{letter}", causality=Fmi2Causality.output, getter=lambda axis=axis: self.velocity[axis])
                )

    def do_step(self, current_time, step_size):
        h = step_size / SUBSTEPS
        vertical = sum(force[2] for force in self.forces.values())
        if not hasattr(self, "weight_of_lines"):
            self.weight_of_lines = vertical
        for index in range(SUBSTEPS):
            time = current_time + index * h
            swell = self.swell * math.sin(2 * math.pi * time / self.period)
            forces = [sum(force[axis] for force in self.forces.values()) for axis in range(3)]
            forces[0] += swell
            forces[2] -= self.weight_of_lines + HEAVE_STIFFNESS * self.position[2]
            for axis in range(3):
                acceleration = (forces[axis] - DAMPING[axis] * self.velocity[axis]) / self.mass
                self.position[axis] += h * self.velocity[axis] + 0.5 * h * h * acceleration
                self.velocity[axis] += h * acceleration
        return True
