"""What comes out: plain classes of NumPy arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy import float64
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas
    import xarray

_AXES = ("x", "y", "z")
_ANGLES = ("roll", "pitch", "yaw")


@dataclass(frozen=True)
class LineResults:
    """A line over n rows, and its m nodes at k snapshots. Forces are those of the line on what holds its end."""

    fairlead: NDArray[float64]
    """(n, 3) position of the fairlead [m]."""
    force: NDArray[float64]
    """(n, 3) force on what holds the fairlead [N]."""
    moment: NDArray[float64]
    """(n, 3) moment on it [N m]; zero unless the fairlead is clamped."""
    tension: NDArray[float64]
    """(n,) effective tension at the fairlead [N]."""
    anchor: NDArray[float64]
    """(n, 3) position of the anchor [m]."""
    anchor_force: NDArray[float64]
    """(n, 3) force on what holds the anchor [N]."""
    anchor_moment: NDArray[float64]
    """(n, 3) moment on it [N m]."""
    anchor_tension: NDArray[float64]
    """(n,) effective tension at the anchor [N]."""
    tension_max: NDArray[float64]
    """(n,) largest effective tension along the line [N]."""
    declination: NDArray[float64]
    """(n,) angle of the force from straight down [rad]."""
    azimuth: NDArray[float64]
    """(n,) direction of the force in plan, from x to y [rad]."""
    grounded_length: NDArray[float64]
    """(n,) unstretched length on the bed [m]."""
    s: NDArray[float64]
    """(m,) unstretched arc length of the nodes from the fairlead [m]."""
    node_position: NDArray[float64]
    """(k, m, 3) positions of the nodes [m]."""
    node_tangent: NDArray[float64]
    """(k, m, 3) unit tangents from fairlead to anchor [-]."""
    node_tension: NDArray[float64]
    """(k, m) effective tensions, positive pulling [N]."""


@dataclass(frozen=True)
class BodyResults:
    """A body over n rows, and the loads of the lines on it about its reference point."""

    position: NDArray[float64]
    """(n, 3) position of the reference point [m]."""
    attitude: NDArray[float64]
    """(n, 3) roll, pitch and yaw [rad]."""
    force: NDArray[float64]
    """(n, 3) force of the lines [N]."""
    moment: NDArray[float64]
    """(n, 3) moment of the lines [N m]."""


@dataclass(frozen=True)
class Results:
    """A run."""

    time: NDArray[float64]
    """(n,) times of the rows [s]."""
    snapshot_time: NDArray[float64]
    """(k,) times at which all nodes are kept [s]."""
    lines: dict[str, LineResults]
    """The lines by name."""
    bodies: dict[str, BodyResults]
    """The bodies by name."""
    points: dict[str, NDArray[float64]]
    """(n, 3) positions of the free points [m] by name."""
    summary: dict[str, Any]
    """What the command writes as summary.json: scheme, steps, times, statistics of the tensions."""
    warnings: list[str] = field(default_factory=list)
    """What may not be meant, of the scene and of the run."""

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a table with the columns of timeseries.csv [m, rad, N, N m], its index the time [s]. Needs pandas."""
        import pandas

        columns: dict[str, NDArray[float64]] = {}
        for name, line in self.lines.items():
            front = "" if len(self.lines) == 1 else f"{name}."
            columns.update(_columns(f"{front}fairlead_", line.fairlead))
            columns[f"{front}tension"] = line.tension
            columns.update(_columns(f"{front}force_", line.force))
            columns[f"{front}anchor_tension"] = line.anchor_tension
            columns[f"{front}grounded_length"] = line.grounded_length
        for name, body in self.bodies.items():
            columns.update(_columns(f"{name}.", body.position))
            columns.update(_columns(f"{name}.", body.attitude, _ANGLES))
            columns.update(_columns(f"{name}.force_", body.force))
            columns.update(_columns(f"{name}.moment_", body.moment))
        for name, point in self.points.items():
            columns.update(_columns(f"{name}.", point))
        return pandas.DataFrame(columns, index=pandas.Index(self.time, name="time"))

    def to_xarray(self) -> xarray.Dataset:
        """The rows as a dataset: dimensions ``time``, ``line``, ``body``, ``point`` and ``axis``; of each line NAME, nodes over
        ``snapshot`` and ``NAME.node``, with their arc length as coordinate ``NAME.s``. Units are attributes. Needs xarray."""
        import xarray

        data: dict[str, Any] = {}
        coordinates: dict[str, Any] = {"time": ("time", self.time, {"units": "s"}), "axis": list(_AXES)}
        lines = list(self.lines.values())
        coordinates["line"] = list(self.lines)
        for name, unit in _LINE_UNITS.items():
            values = np.stack([getattr(line, name) for line in lines])
            dimensions = ("line", "time", "axis")[: values.ndim]
            data[name] = (dimensions, values, {"units": unit})
        if self.bodies:
            coordinates["body"] = list(self.bodies)
            coordinates["angle"] = list(_ANGLES)
            for name, unit in _BODY_UNITS.items():
                values = np.stack([getattr(body, name) for body in self.bodies.values()])
                last = "angle" if name == "attitude" else "axis"
                data[f"body_{name}"] = (("body", "time", last), values, {"units": unit})
        if self.points:
            coordinates["point"] = list(self.points)
            data["point_position"] = (("point", "time", "axis"), np.stack(list(self.points.values())), {"units": "m"})
        coordinates["snapshot"] = ("snapshot", self.snapshot_time, {"units": "s"})
        for name, line in self.lines.items():
            node = f"{name}.node"
            coordinates[f"{name}.s"] = (node, line.s, {"units": "m"})
            data[f"{name}.position"] = (("snapshot", node, "axis"), line.node_position, {"units": "m"})
            data[f"{name}.tension"] = (("snapshot", node), line.node_tension, {"units": "N"})
        return xarray.Dataset(data, coordinates)


_LINE_UNITS = {
    "fairlead": "m",
    "force": "N",
    "moment": "N m",
    "tension": "N",
    "anchor": "m",
    "anchor_force": "N",
    "anchor_moment": "N m",
    "anchor_tension": "N",
    "tension_max": "N",
    "declination": "rad",
    "azimuth": "rad",
    "grounded_length": "m",
}
_BODY_UNITS = {"position": "m", "attitude": "rad", "force": "N", "moment": "N m"}


def _columns(front: str, values: NDArray[float64], names: tuple[str, ...] = _AXES) -> dict[str, NDArray[float64]]:
    return {front + name: values[:, axis] for axis, name in enumerate(names)}


def results(arrays: dict[str, Any], summary: dict[str, Any]) -> Results:
    """A run from the arrays of the extension."""
    return Results(
        time=arrays["time"],
        snapshot_time=arrays["snapshot_time"],
        lines={name: LineResults(**line) for name, line in arrays["lines"].items()},
        bodies={name: BodyResults(**body) for name, body in arrays["bodies"].items()},
        points=arrays["points"],
        summary=summary,
        warnings=list(summary["warnings"]),
    )


@dataclass(frozen=True)
class LineStatics:
    """A line in equilibrium with m nodes. Forces are those of the line on what holds its end."""

    tension: float
    """Effective tension at the fairlead [N]."""
    force: NDArray[float64]
    """(3,) force on what holds the fairlead [N]."""
    anchor_tension: float
    """Effective tension at the anchor [N]."""
    anchor_force: NDArray[float64]
    """(3,) force on what holds the anchor [N]."""
    grounded_length: float
    """Unstretched length on the bed [m]."""
    s: NDArray[float64]
    """(m,) unstretched arc length from the fairlead [m]."""
    node_position: NDArray[float64]
    """(m, 3) positions [m]."""
    node_tangent: NDArray[float64]
    """(m, 3) unit tangents from fairlead to anchor [-]."""
    node_tension: NDArray[float64]
    """(m,) effective tensions, positive pulling [N]."""


@dataclass(frozen=True)
class BodyStatics:
    """A body, and the loads of the lines on it about its reference point."""

    position: NDArray[float64]
    """(3,) position of the reference point [m]."""
    attitude: NDArray[float64]
    """(3,) roll, pitch and yaw [rad]."""
    force: NDArray[float64]
    """(3,) force of the lines [N]."""
    moment: NDArray[float64]
    """(3,) moment of the lines [N m]."""
    stiffness: NDArray[float64] | None
    """(6, 6) of the mooring: minus the change of force and moment with displacement along and turn about the global axes [N/m, N, N m];
    None where a line has no stiffness of its own."""


@dataclass(frozen=True)
class Statics:
    """A mooring in equilibrium."""

    converged: bool
    """Whether it is one."""
    iterations: int
    """Iterations of all parts."""
    residual: float
    """Largest unbalanced nodal force [N]."""
    lines: dict[str, LineStatics]
    """The lines by name."""
    bodies: dict[str, BodyStatics]
    """The bodies by name."""
    points: dict[str, NDArray[float64]]
    """(3,) positions of the free points [m] by name."""


def statics(found: dict[str, Any]) -> Statics:
    """An equilibrium from the JSON of the extension."""

    def line(of: dict[str, Any]) -> LineStatics:
        def nodes(name: str) -> NDArray[float64]:
            return np.array([node[name] for node in of["nodes"]], dtype=float)

        return LineStatics(
            tension=of["tension"],
            force=np.array(of["force"]),
            anchor_tension=of["anchor_tension"],
            anchor_force=np.array(of["anchor_force"]),
            grounded_length=of["grounded_length"],
            s=nodes("s"),
            node_position=nodes("position"),
            node_tangent=nodes("tangent"),
            node_tension=nodes("tension"),
        )

    def body(of: dict[str, Any]) -> BodyStatics:
        stiffness = of.get("stiffness")
        return BodyStatics(
            position=np.array(of["position"]),
            attitude=np.radians(of["attitude_deg"]),
            force=np.array(of["force"]),
            moment=np.array(of["moment"]),
            stiffness=None if stiffness is None else np.array(stiffness),
        )

    return Statics(
        converged=found["converged"],
        iterations=found["iterations"],
        residual=found["residual"],
        lines={of["name"]: line(of) for of in found["lines"]},
        bodies={of["name"]: body(of) for of in found.get("bodies", [])},
        points={of["name"]: np.array(of["position"]) for of in found.get("points", [])},
    )


@dataclass(frozen=True)
class Offsets:
    """What the mooring does to a body held aside, at the n offsets that it reaches."""

    offset: NDArray[float64]
    """(n,) offsets from the equilibrium [m] or [deg]."""
    force: NDArray[float64]
    """(n, 3) force of the lines on the body [N]."""
    moment: NDArray[float64]
    """(n, 3) moment of the lines about its reference point [N m]."""
    tension: dict[str, NDArray[float64]]
    """(n,) tension at the fairlead of each line [N] by name."""


@dataclass(frozen=True)
class Fit:
    """The scene that has a wanted result."""

    scene: dict[str, Any]
    """The scene with the value found, and with all its defaults."""
    value: float
    """The value, in the unit of its place."""
    before: float
    """What it was."""
    reached: float
    """The result with it [SI]."""
