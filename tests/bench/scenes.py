"""The scenes of the benchmarks, as moorline reads them, and what is asked of each: the tension at the fairlead in a window, every 0.1 s
(the snapping chain: mean of its cycle maxima)."""

import copy
import json
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILT_IN = json.loads((ROOT / "examples/lindahl-sjoberg.json").read_text(encoding="utf-8"))


class Case:
    """A scene, the window of time that is judged, and how."""

    def __init__(self, name, about, scene, window, peaks=None, reference=None):
        self.name, self.about, self.scene, self.window = name, about, scene, window
        self.peaks = peaks  # period of the cycles whose maxima are judged, where the tension itself never converges
        self.reference = reference or {}  # what the converged run differs in from `FINE`


FINE = {"elements": 160, "scheme": "esdirk3", "fixed_step": 0.0125, "tolerance": 1e-7}


def altered(scene, **changes):
    """A copy of a scene with some of its parts replaced; parts of `environment` are put into it."""
    scene = copy.deepcopy(scene)
    for key, value in changes.items():
        scene[key] = {**scene[key], **value} if key in ("environment", "run", "motion", "solver") and key in scene else value
    return scene


def with_mesh(scene, elements):
    """The scene on that many elements of equal length, shared out to the sections; None leaves it to the program."""
    scene = copy.deepcopy(scene)
    for line in scene["lines"]:
        total = sum(section["length"] for section in line["sections"])
        for section in line["sections"]:
            section.pop("elements", None)
            if elements:
                section["elements"] = max(1, round(elements * section["length"] / total))
    return scene


POLYESTER = {
    "environment": {"water_density": 1025.0, "depth": 1300.0, "seabed": {"stiffness": 1.0e4}},
    "line_types": {
        "polyester": {
            "ea": 6.0e7, "mass": 26.0, "submerged_weight": 45.0, "diameter": 0.18,
            "drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}, "damping": 0.01,
        }
    },
    "lines": [
        {"name": "leg", "fairlead": [0, 0, -20], "anchor": [900, 0, -1220], "sections": [{"type": "polyester", "length": 1470}]}
    ],
    "motion": {"kind": "sinusoidal", "period": 12.0, "sine": [-3.0, 1.0, 2.0], "ramp": 24.0},
    "run": {"duration": 60.0, "output_step": 0.1},
}

CHAIN = {
    "environment": {"water_density": 1000.0, "depth": 3.0},
    "line_types": {
        "chain": {
            "ea": 1.0e4, "mass": 0.0818, "submerged_weight": 0.6993, "diameter": 0.0022,
            "drag": {"normal": 2.5, "tangential": 0.5}, "added_mass": {"normal": 3.8}, "damping": 4.0e-4,
        }
    },
    "lines": [{"name": "chain", "fairlead": [32.554, 0, 0.3], "anchor": [0, 0, -3], "sections": [{"type": "chain", "length": 33}]}],
    "motion": {"kind": "sinusoidal", "period": 1.25, "sine": [0.2, 0, 0], "cosine": [0, 0, 0.2], "ramp": 4.0},
    "run": {"duration": 15.0, "output_step": 0.005},
}

RISER = {
    "environment": {"water_density": 1025.0, "depth": 1000.0, "seabed": {"stiffness": 2.0e4}},
    "line_types": {
        "steel": {
            "ea": 4.1e9, "ei": 3.15e7, "mass": 200.0, "diameter": 0.273,
            "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0}, "damping": 1.0e-3,
        }
    },
    "lines": [
        {"name": "riser", "fairlead": [0, 0, -10], "anchor": [1000, 0, -1000], "sections": [{"type": "steel", "length": 1560}]}
    ],
    "motion": {"kind": "sinusoidal", "period": 12.0, "sine": [1.0, 0.5, 2.0], "ramp": 24.0},
    "run": {"duration": 60.0, "output_step": 0.1},
}

CASES = [
    Case("built-in", "the chain of Lindahl & Sjöberg, fairlead in surge and sway, T = 15 s", BUILT_IN, (60.0, 120.0)),
    Case(
        "vertical",
        "the same chain, fairlead in surge 5.08 m and heave 2.1 m, T = 15 s",
        altered(BUILT_IN, motion={"sine": [5.08, 0.0, 2.1]}),
        (60.0, 120.0),
    ),
    Case("polyester", "a taut rope of 1470 m on 1500 m, fairlead 3 m, T = 12 s", POLYESTER, (30.0, 60.0)),
    Case("riser", "a steel catenary riser of 1560 m with bending stiffness in 1000 m, fairlead 2 m, T = 12 s", RISER, (30.0, 60.0)),
    Case(
        "snapping",
        "33 m of chain on a circle of 0.2 m in 1.25 s, slack and snapping, no friction: mean of the cycle maxima",
        CHAIN,
        (7.5, 15.0),
        peaks=1.25,
        reference={"elements": 160, "fixed_step": 0.0005},
    ),
]
