"""A simple vessel as an FMU: a mass free to move in x, y and z, with hydrostatic stiffness in heave, linear damping and a slow swell.

    pip install pythonfmu
    pythonfmu build -f examples/osp/vessel.py

Two mooring lines are attached at `bow` and `stern`, 50 m before and behind the centre. Rotations are left out.
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS = 2.0e7  # kg, with the water that moves along
DAMPING = (0.02, 0.03, 0.2)  # per mass, 1/s
HEAVE_STIFFNESS = 0.6  # per mass, 1/s^2: a period of 8 s
SWELL = 0.025  # m/s^2
ARM = 50.0  # m
SUBSTEP = 0.01  # s


class Vessel(Fmi2Slave):
    author = "The moorline authors"
    description = "A vessel on two mooring lines"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.mass = MASS
        self.swell = SWELL
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
        count = math.ceil(step_size / SUBSTEP - 1e-6)
        h = step_size / count
        vertical = sum(force[2] for force in self.forces.values())
        if not hasattr(self, "weight_of_lines"):
            self.weight_of_lines = vertical
        for index in range(count):
            time = current_time + index * h
            pulls = [sum(force[axis] for force in self.forces.values()) / self.mass for axis in range(3)]
            pulls[0] += self.swell * math.sin(2 * math.pi * time / self.period)
            pulls[2] -= self.weight_of_lines / self.mass + HEAVE_STIFFNESS * self.position[2]
            for axis in range(3):
                acceleration = pulls[axis] - DAMPING[axis] * self.velocity[axis]
                self.position[axis] += h * self.velocity[axis] + 0.5 * h * h * acceleration
                self.velocity[axis] += h * acceleration
        return True
