"""How far a platform goes in a steady load, and what its lines then carry: offsets, a run and a mooring step by step.

usage: pip install .
       python examples/python/watch_circle.py
"""

from pathlib import Path

import moorline
import numpy as np

SCENE = Path(__file__).resolve().parents[1] / "semi-submersible.json"

# Statics: what the mooring does to the platform at offsets along x.
curve = moorline.offsets(SCENE, "platform", "x", np.arange(-10.0, 11.0, 2.0))
for offset, force in zip(curve.offset, curve.force[:, 0]):
    print(f"offset {offset:6.1f} m: {force / 1e3:8.1f} kN")

# Dynamics, as the scene has the platform move.
results = moorline.run(SCENE, {"run.duration": 60.0})
for name, line in results.lines.items():
    print(f"{name}: {line.tension.min() / 1e3:.1f} to {line.tension.max() / 1e3:.1f} kN")

# The same mooring in the hands of this program: a mass that a steady load pushes aside, with enough damping to come to rest.
LOAD, MASS, DAMPING, STEP = 2.0e5, 1.4e7, 2.0e6, 0.1
mooring = moorline.Mooring(SCENE)
pose, rates = np.zeros(6), np.zeros(6)
pull = mooring.loads()["platform"][0]
for _ in range(4000):
    rates[0] += STEP * (LOAD + pull - DAMPING * rates[0]) / MASS
    pose[0] += STEP * rates[0]
    pull = mooring.step(STEP, poses={"platform": pose}, rates={"platform": rates})["platform"][0]
print(f"a load of {LOAD / 1e3:.0f} kN is held at {pose[0]:.2f} m; stiffness there {mooring.stiffness('platform')[0, 0] / 1e3:.1f} kN/m")
assert abs(LOAD + pull) < 0.01 * LOAD, "not yet at rest"
