"""The wave-energy mooring (examples/wave-energy-floats.json, six lines and three floats, surge 2 m and heave 1 m of 10 s) beside MoorDyn.

usage: MOORLINE=PROGRAM moordyn_floats.py

The tension at the device differs from that of MoorDyn's finer mesh by no more than its two meshes do from each other.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "bench"))

import mooring

scene = mooring.floats()
_, _, rows = mooring.run(scene)
ours = [float(row["upper a.tension"]) for row in rows[1:]]
coarse, fine = (mooring.moordyn_run(scene, segments, per_row)[0] for segments, per_row in ((20, 80), (40, 160)))
own, off = mooring.apart(coarse, fine), mooring.apart(ours, fine)
print(f"tension: {100 * off:.2f} % rms of what varies from MoorDyn's, whose own meshes differ by {100 * own:.2f} %")
assert off < own, (off, own)
