"""A mooring step by step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy import float64
from numpy.typing import ArrayLike, NDArray

from moorline._errors import InputError
from moorline._moorline import Core
from moorline._scene import Scene, source, warn

_POSE = ("position.x", "position.y", "position.z", "attitude.roll", "attitude.pitch", "attitude.yaw")
_RATES = ("velocity.x", "velocity.y", "velocity.z", "angular_velocity.x", "angular_velocity.y", "angular_velocity.z")
_LOADS = ("force.x", "force.y", "force.z", "moment.x", "moment.y", "moment.z")
_APPLIED = ("applied_force.x", "applied_force.y", "applied_force.z", "applied_moment.x", "applied_moment.y", "applied_moment.z")
_FAIRLEAD = ("fairlead.position.x", "fairlead.position.y", "fairlead.position.z")
_FAIRLEAD_RATES = ("fairlead.velocity.x", "fairlead.velocity.y", "fairlead.velocity.z")
_Given = Optional[Mapping[str, ArrayLike]]


@dataclass(frozen=True)
class Linearised:
    """How the loads of the lines on a driven body, at the end of a step, answer to its motion at the start of it."""

    stiffness: NDArray[float64]
    """(6, 6) minus the change of force and moment with displacement along and turn about the global axes [N/m, N, N m]."""
    damping: NDArray[float64]
    """(6, 6) minus their change with velocity and angular velocity along the global axes [N s/m, N s, N m s]."""


class Mooring:
    """The mooring of a scene, moved from outside: poses in, loads out. It is what the FMU of the scene is, and gives the same numbers.

    It begins in static equilibrium with bodies and fairleads where the scene has them; the scene's own motions play no part. Poses are
    those of driven bodies by name, (6,): x, y, z of the reference point [m], roll, pitch and yaw [rad]; and of lines whose
    fairlead hangs on no body, (3,): x, y, z [m]. Rates are (6,): velocity [m/s] and angular velocity along global axes [rad/s], and (3,). Loads
    are (6,): force [N] and moment about the reference point [N m] of the lines on a driven body; and (3,): force of a line on its
    fairlead. Give rates where they are known: the way between two poses is then known much better.
    """

    def __init__(self, scene: Scene = None, changes: Mapping[str, Any] | None = None, time: float = 0.0) -> None:
        """Puts the mooring of a scene in equilibrium at a time [s]. Raises as `moorline.statics`."""
        self._core = Core(source(scene, changes))
        self._parts = {name: (front, kind) for name, front, kind in self._core.parts()}
        self.settle(time=time)

    @property
    def time(self) -> float:
        """The time reached [s]."""
        return self._core.time()

    @property
    def names(self) -> list[str]:
        """All quantities that `get` knows: the Real variables of the scene's FMU, such as ``bow.tension`` or ``ship.force.x``."""
        return self._core.names()

    def settle(self, poses: _Given = None, loads: _Given = None, time: float = 0.0) -> dict[str, NDArray[float64]]:
        """Puts it in equilibrium at a time [s], bodies and fairleads where the scene has them or at the poses given; `loads` (6,) act on free
        bodies [N, N m]. Returns the loads of the lines."""
        names, values = self._inputs(poses, None, loads)
        self._core.settle(names, values, time)
        return self.loads()

    def step(self, step: float, poses: _Given = None, rates: _Given = None, loads: _Given = None) -> dict[str, NDArray[float64]]:
        """Goes on by `step` [s] from what is known at the present time: `poses` and `rates` of driven bodies and fairleads now,
        `loads` (6,) on free bodies [N, N m]; what is not given stays as last given. Returns the loads of the lines then.

        On a `ConvergenceError` it stands as before the step."""
        names, values = self._inputs(poses, rates, loads)
        self._core.set(names, values)
        warn(self._core.step(step))
        return self.loads()

    def loads(self) -> dict[str, NDArray[float64]]:
        """Loads of the lines now: (6,) on driven bodies [N, N m], (3,) on fairleads that hang on no body [N]."""
        found = {}
        for name, (front, kind) in self._parts.items():
            if kind in ("driven", "fairlead"):
                found[name] = self._core.get([front + stem for stem in (_LOADS if kind == "driven" else _LOADS[:3])])
        return found

    def tensions(self) -> dict[str, float]:
        """Effective tension at the fairlead of each line now [N]."""
        lines = {name: front for name, (front, kind) in self._parts.items() if kind in ("fairlead", "line")}
        return dict(zip(lines, self._core.get([f"{front}tension" for front in lines.values()]).tolist()))

    def pose(self, name: str) -> NDArray[float64]:
        """(6,) pose of a body now: x, y, z [m], roll, pitch, yaw [rad]; of a driven body, the one last given."""
        front, _ = self._part(name, ("driven", "free"), "body")
        return self._core.get([front + stem for stem in _POSE])

    def get(self, name: str) -> float:
        """A quantity by its name in the FMU [SI]."""
        return float(self._core.get([name])[0])

    def stiffness(self, body: str) -> NDArray[float64]:
        """(6, 6) static stiffness of the mooring against a driven body, with all that is driven where it was last put and no load on free bodies:
        minus the change of force and moment with displacement along and turn about the global axes [N/m, N, N m]."""
        return self._core.stiffness(body)

    def linearise(self, body: str, poses: _Given = None, rates: _Given = None, loads: _Given = None) -> Linearised:
        """What a body feels of the mooring in one step: the change of its loads at the end of a step as long as the last one (0.1 s before
        the first) with its pose and with its rates at the start, all else that is driven held. `poses`, `rates` and `loads` are those of the
        present time, as in `step`, of which it is the derivative. These are the directional derivatives of the scene's FMU: the step is
        differentiated along the way that the body would go, not taken.

        A displacement is taken up within the step, or 0.1 s if that is longer, and a velocity goes on over it: both matrices hold what the
        inertia and the drag of the lines make of that, and `damping` the stiffness times the way gone. In long steps they are the forces of
        slow motion; `stiffness` is the matrix of statics."""
        front, _ = self._part(body, ("driven",), "driven body")
        self._core.set(*self._inputs(poses, rates, loads))
        change = -self._core.derivatives([front + stem for stem in _LOADS], [front + stem for stem in (*_POSE, *_RATES)])
        # From angles to turns about the global axes: their rates are omega = E dq/dt.
        _, pitch, yaw = self._core.get([front + stem for stem in _POSE[3:]])
        turned = np.array(
            [
                [np.cos(yaw) * np.cos(pitch), -np.sin(yaw), 0.0],
                [np.sin(yaw) * np.cos(pitch), np.cos(yaw), 0.0],
                [-np.sin(pitch), 0.0, 1.0],
            ]
        )
        change[:, 3:6] = change[:, 3:6] @ np.linalg.inv(turned)
        return Linearised(stiffness=change[:, :6].copy(), damping=change[:, 6:].copy())

    def save(self) -> bytes:
        """The state, also for another `Mooring` of the same scene."""
        return self._core.save()

    def restore(self, state: bytes) -> None:
        """Goes back to a state; what follows is the same to the bit."""
        self._core.restore(state)

    def _part(self, name: str, kinds: tuple[str, ...], word: str) -> tuple[str, str]:
        part = self._parts.get(name)
        if part is None or part[1] not in kinds:
            known = [name for name, (_, kind) in self._parts.items() if kind in kinds]
            raise InputError(f'"{name}" is no {word} of this scene; known here: {", ".join(known) or "none"}')
        return part

    def _inputs(self, poses: _Given, rates: _Given, loads: _Given) -> tuple[list[str], list[float]]:
        names: list[str] = []
        values: list[float] = []

        def put(name: str, front: str, stems: tuple[str, ...], given: ArrayLike) -> None:
            numbers = np.asarray(given, dtype=float)
            if numbers.shape != (len(stems),):
                raise InputError(f'"{name}" wants an array of shape ({len(stems)},), not {numbers.shape}')
            names.extend(front + stem for stem in stems)
            values.extend(numbers.tolist())

        for name, given in (poses or {}).items():
            front, kind = self._part(name, ("driven", "fairlead"), "driven body or fairlead")
            put(name, front, _POSE if kind == "driven" else _FAIRLEAD, given)
        for name, given in (rates or {}).items():
            front, kind = self._part(name, ("driven", "fairlead"), "driven body or fairlead")
            put(name, front, _RATES if kind == "driven" else _FAIRLEAD_RATES, given)
        for name, given in (loads or {}).items():
            front, _ = self._part(name, ("free",), "free body")
            put(name, front, _APPLIED, given)
        return names, values
