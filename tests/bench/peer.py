"""MoorDyn (Hall & Goupee 2015; PyPI `moordyn`) on the scenes of the benchmarks.

What makes the comparison fair:

- the same physics: its `diameter` is the one that displaces the scene's buoyancy, and the drag and added-mass coefficients are scaled to
  the same forces; its internal damping BA = EA C, its bed kBot = k/d, no friction;
- its bed begins at the water depth, ours w/k above it, so that a line at rest lies at the depth: it is given the depth less w/k, and holds
  its anchor as a coupled point at rest, because it would lift a fixed one onto its bed;
- the force on the vessel is the one that `Step` returns, not the tension of the last segment;
- the fairlead is told to it at every one of its own steps, position and the velocity that takes it to the next, so that it follows the
  same path; time is that of the process in the loop of steps alone. Of it 2 to 4 microseconds per step are Python's.
"""

import math
import os
import tempfile
import time
from pathlib import Path

import moordyn


def deck(scene, segments, scheme, step):
    """The scene as MoorDyn's input file."""
    environment, (line,) = scene["environment"], scene["lines"]
    (section,) = line["sections"]
    kind = scene["line_types"][section["type"]]
    gravity, density = environment.get("gravity", 9.80665), environment.get("water_density", 1025.0)
    in_air = kind["mass"] * gravity
    buoyancy = in_air - kind["submerged_weight"] if "submerged_weight" in kind else density * gravity * math.pi / 4 * kind["diameter"] ** 2
    weight, d = in_air - buoyancy, math.sqrt(4.0 * buoyancy / (density * gravity * math.pi))
    ratio = kind["diameter"] / d
    drag, added = kind.get("drag", {}), kind.get("added_mass", {})
    stiffness = environment.get("seabed", {}).get("stiffness", weight / kind["diameter"])
    depth = environment["depth"] - weight / stiffness
    numbers = [
        d, kind["mass"], kind["ea"], kind["ea"] * kind.get("damping", 0.0), kind.get("ei", 0.0), drag.get("normal", 0.0) * ratio,
        added.get("normal", 0.0) * ratio**2, drag.get("tangential", 0.0) * ratio, added.get("tangential", 0.0) * ratio**2,
    ]
    point = lambda name: " ".join(repr(float(x)) for x in line[name])
    return f"""a scene of the benchmarks
---------------------- LINE TYPES
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (N-m^2) (-) (-) (-) (-)
main {" ".join(repr(float(x)) for x in numbers)}
---------------------- POINTS
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled {point("anchor")} 0 0 0 0
2 Coupled {point("fairlead")} 0 0 0 0
---------------------- LINES
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (-) (#) (#) (m) (-) (-)
1 main 1 2 {section["length"]!r} {segments} -
---------------------- OPTIONS
0 writeLog
1 disableOutput
{scheme} tScheme
{step!r} dtM
{gravity!r} g
{density!r} rho
{depth!r} WtrDpth
{stiffness / d!r} kBot
0.0 cBot
1.0 dtIC
100.0 TmaxIC
4.0 CdScaleIC
1e-4 threshIC
---------------------- END
"""


def path(scene, t):
    """Where the fairlead is [m]."""
    motion, (line,) = scene["motion"], scene["lines"]
    omega, ramp = math.tau / motion["period"], motion.get("ramp", 3.25 * motion["period"])
    xi = min(t / ramp, 1.0) if ramp > 0 else 1.0
    ease, s, c = xi * xi * (3.0 - 2.0 * xi), math.sin(omega * t), math.cos(omega * t)
    return [f + ease * (a * s + b * c) for f, a, b in zip(line["fairlead"], motion["sine"], motion.get("cosine", [0, 0, 0]))]


class Broken(Exception):
    """The run gave up or blew up."""


def run(scene, segments, scheme, per_row, end=None, bound=math.inf):
    """Tension at the fairlead at every output step, and the CPU time of the loop of steps; `per_row` steps per output step. A tension above
    `bound` counts as blown up."""
    rows, h = round((end or scene["run"]["duration"]) / scene["run"]["output_step"]), scene["run"]["output_step"] / per_row
    steps = rows * per_row
    places = [path(scene, k * h) for k in range(steps + 1)]
    anchor = [float(x) for x in scene["lines"][0]["anchor"]]
    inputs = [(anchor + a, [0.0, 0.0, 0.0] + [(q - p) / h for p, q in zip(a, b)]) for a, b in zip(places, places[1:])]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "lines.txt")
        file.write_text(deck(scene, segments, scheme, h), encoding="utf-8")
        with silence():
            system = moordyn.Create(str(file))
            try:
                moordyn.SetVerbosity(system, moordyn.LOG_NO_OUT if hasattr(moordyn, "LOG_NO_OUT") else 0)
                moordyn.Init(system, anchor + places[0], [0.0] * 6)
                forces, step = [], moordyn.Step
                started = time.process_time()
                for k, (x, v) in enumerate(inputs):
                    force = step(system, x, v, k * h, h)
                    if (k + 1) % per_row == 0:
                        tension = math.hypot(*force[3:6])
                        if not tension < bound:
                            raise Broken
                        forces.append(tension)
                return forces, time.process_time() - started
            except (RuntimeError, OSError) as error:
                raise Broken from error
            finally:
                moordyn.Close(system)


class silence:
    """MoorDyn talks on both streams of the process."""

    def __enter__(self):
        self.kept = [os.dup(1), os.dup(2)]
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1), os.dup2(nothing, 2)
        os.close(nothing)

    def __exit__(self, *_):
        for stream, kept in zip((1, 2), self.kept):
            os.dup2(kept, stream), os.close(kept)
