"""Offset curve and stiffness of the mooring of the semi-submersible (examples/semi-submersible.json) beside those of MoorPy.

usage: moorpy_offsets.py SCENE.json OFFSETS.csv STATICS.json

Both are quasi-static; MoorPy's bed is rigid, moorline's gives way by the weight of the line over its stiffness (lines lie as deep in both).
"""

import csv
import json
import sys

import moorpy
import numpy as np

scene, statics = (json.load(open(path, encoding="utf-8")) for path in (sys.argv[1], sys.argv[3]))
environment = scene["environment"]
system = moorpy.System(depth=environment["depth"], rho=environment.get("water_density", 1025.0), g=environment.get("gravity", 9.80665))
for name, kind in scene["line_types"].items():
    diameter = kind["diameter"]
    weight = kind.get("submerged_weight", kind["mass"] * system.g - system.rho * system.g * np.pi / 4 * diameter**2)
    system.lineTypes[name] = {"name": name, "d_vol": diameter, "m": kind["mass"], "EA": kind["ea"], "w": weight, "cost": 0, "material": name}
system.addBody(-1, np.zeros(6))
for line in scene["lines"]:
    system.addPoint(1, np.array(line["anchor"]))
    anchor = len(system.pointList)
    system.addPoint(1, np.array(line["fairlead"]["at"]))
    fairlead = len(system.pointList)
    system.bodyList[0].attachPoint(fairlead, np.array(line["fairlead"]["at"]))
    section = line["sections"][0]
    system.addLine(section["length"], section["type"], pointA=anchor, pointB=fairlead)
system.initialize()


def pull(pose):
    system.bodyList[0].setPosition(np.array(pose, dtype=float))
    for point in system.pointList:
        if point.number in system.bodyList[0].attachedP:
            continue
        point.setPosition(point.r)
    for line in system.lineList:
        line.staticSolve(tol=1e-10)
    return system.bodyList[0].getForces(lines_only=True), [line.TB for line in system.lineList]


worst = [0.0, 0.0, 0.0]
with open(sys.argv[2], encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
assert len(rows) == 41, len(rows)
size = max(abs(float(row["force_x"])) for row in rows)
lever = max(abs(float(row["moment_y"])) for row in rows)
for row in rows:
    force, tensions = pull([float(row["offset_m"]), 0, 0, 0, 0, 0])
    worst[0] = max(worst[0], abs(force[0] - float(row["force_x"])) / size, abs(force[2] / float(row["force_z"]) - 1))
    worst[1] = max(worst[1], abs(force[4] - float(row["moment_y"])) / lever)
    for line, tension in zip(scene["lines"], tensions):
        worst[2] = max(worst[2], abs(tension / float(row[f"{line['name']}.tension"]) - 1))
print(f"offsets of -20 to 20 m: force within {worst[0]:.1e} of the largest, moment {worst[1]:.1e}, tensions {worst[2]:.1e}")
assert max(worst) < 1e-4

# 6x6 stiffness by central differences of MoorPy, entries on the scale of their row and column.
ours = np.array(statics["bodies"][0]["stiffness"])
theirs = np.zeros((6, 6))
for column in range(6):
    step = 0.1 if column < 3 else 1e-3
    ahead, behind = (pull([sign * step if c == column else 0 for c in range(6)])[0] for sign in (1, -1))
    theirs[:, column] = -(ahead - behind) / (2 * step)
scale = np.sqrt(np.abs(np.diag(theirs)))
off = np.max(np.abs(ours - theirs) / np.outer(scale, scale))
print(f"stiffness within {off:.1e}")
assert off < 5e-4
