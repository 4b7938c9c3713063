"""The comparison with MoorDyn (PyPI `moordyn`)."""

import subprocess
import sys
from pathlib import Path

import moorline
import pytest

pytest.importorskip("moordyn")
pytest.importorskip("matplotlib")
from moorline import compare

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def test_the_built_in_case_shows_what_the_benchmarks_say(tmp_path):
    """Source: docs/benchmarks.md, built-in: MoorDyn's error is 1.3 % rms with 80 segments and 0.45 % with 160 or less, moorline's 0.05 %; so far must
    the programs be apart."""
    picture = tmp_path / "built-in.svg"
    command = [sys.executable, "-m", "moorline.compare", "--from", "60", "-o", str(picture)]
    done = subprocess.run(command, capture_output=True, check=True, text=True)
    (row,) = [line.split() for line in done.stdout.splitlines() if line.startswith("line ")]
    fine, coarse = float(row[5]), float(row[7])
    assert 0.02 < fine < 0.5 and 0.9 < coarse < 1.5, done.stdout
    assert "<svg" in picture.read_text()[:600]


def test_a_mooring_of_a_body_is_driven_at_its_fairleads():
    """Source: MoorDyn's own two meshes: it is no further from moorline than they are from each other, and at rest 0.3 % (docs/moordyn-files.md)."""
    found = compare.compare(EXAMPLES / "semi-submersible.json", {"run.duration": 20.0}, segments=(20, 40))
    assert list(found.ours) == ["line1", "line2", "line3"]
    for end in found.ours:
        assert found.theirs[1][end][0] == pytest.approx(found.ours[end][0], rel=5e-3)
        from_fine, _, own = found.apart(end)
        assert from_fine < max(own, 5e-3)


def test_what_cannot_be_compared_is_said():
    with pytest.raises(moorline.InputError, match="constraints"):
        compare.compare(EXAMPLES / "moored-buoy.json", {"run.duration": 1.0})
    with pytest.raises(moorline.InputError, match="segments"):
        compare.compare(None, segments=(40, 40))
    done = subprocess.run([sys.executable, "-m", "moorline.compare", "nowhere.json"], capture_output=True, check=False, text=True)
    assert done.returncode == 2 and "nowhere.json" in done.stderr
