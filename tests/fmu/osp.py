"""The example for OSP: a vessel on two lines, the same FMU twice, in libcosim. Stable, and symmetric where the case is."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

fmu = pathlib.Path(sys.argv[1])
example = pathlib.Path(__file__).parents[2] / "examples/osp"
sys.path.insert(0, str(example))

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shutil.copy(example / "OspSystemStructure.xml", folder)
    shutil.copy(fmu, folder / "moorline.fmu")
    shutil.copy(fmu.with_name("moorline_OspModelDescription.xml"), folder)
    subprocess.run([sys.executable, "-m", "pythonfmu", "build", "-f", str(example / "vessel.py"), "-d", name], check=True)
    from run import run

    rows = run(folder, [("vessel", "bow.position.x"), ("bow line", "tension"), ("stern line", "tension")])

assert len(rows) == 12 and rows[-1][0] == 120.0
for time, place, bow, stern in rows:
    surge = place - 50.0
    assert abs(surge) < 1.0, f"t = {time}: the vessel surges by {surge} m"
    assert 1.0e6 < bow < 1.6e6 and 1.0e6 < stern < 1.6e6, f"t = {time}: tensions {bow}, {stern} N"
    assert (surge > 0) == (bow < stern) or abs(bow - stern) < 3e4, f"t = {time}: surge {surge} m, tensions {bow}, {stern} N"
print(rows[-1])
