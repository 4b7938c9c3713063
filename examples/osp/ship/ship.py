"""A rigid ship as an FMU: surge, sway and yaw, linear damping and a wind. It knows nothing of its mooring but one force and one moment.

    pip install pythonfmu
    pythonfmu build -f examples/osp/ship/ship.py
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS = (4.0e7, 4.0e7, 9.0e10)  # with added mass [kg], [kg], [kg m2]
DAMPING = (9.0e5, 1.2e6, 2.5e9)  # [N s/m], [N s/m], [N m s]
WIND = (0.6e6, 0.4e6, 1.0e7)  # force along x and y [N], moment about z [N m]
LOADS = ("force.x", "force.y", "moment.z")
POSE = ("position.x", "position.y", "attitude.yaw")
RATES = ("velocity.x", "velocity.y", "angular_velocity.z")
SUBSTEP = 0.02  # s


class Ship(Fmi2Slave):
    author = "The moorline authors"
    description = "A rigid ship in the wind"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.load, self.x, self.v = [0.0] * 3, [0.0] * 3, [0.0] * 3
        for axis in range(3):
            self.register_variable(
                Real(
                    LOADS[axis],
                    causality=Fmi2Causality.input,
                    getter=lambda axis=axis: self.load[axis],
                    setter=lambda value, axis=axis: self.load.__setitem__(axis, value),
                )
            )
            self.register_variable(Real(POSE[axis], causality=Fmi2Causality.output, getter=lambda axis=axis: self.x[axis]))
            self.register_variable(Real(RATES[axis], causality=Fmi2Causality.output, getter=lambda axis=axis: self.v[axis]))

    def do_step(self, current_time, step_size):
        count = math.ceil(step_size / SUBSTEP - 1e-6)
        h = step_size / count
        for _ in range(count):
            for axis in range(3):
                a = (WIND[axis] + self.load[axis] - DAMPING[axis] * self.v[axis]) / MASS[axis]
                self.v[axis] += h * a
                self.x[axis] += h * self.v[axis]
        return True
