"""What `import moorline` gives, held to the command, to answers in closed form, and to itself."""

import csv
import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import moorline
import numpy as np
import pytest

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
COMMAND = [sys.executable, "-m", "moorline"]


def scene(name):
    return json.loads((EXAMPLES / f"{name}.json").read_text())


@pytest.mark.parametrize("name", ["lindahl-sjoberg", "two-lines", "semi-submersible", "moored-buoy"])
def test_a_run_has_the_rows_of_the_command_to_the_digits(name, tmp_path):
    """Source: timeseries.csv of `moorline run`, which writes every digit."""
    changes = {"run.duration": 10.0}
    path = EXAMPLES / f"{name}.json"
    subprocess.run([*COMMAND, "run", str(path), "-o", str(tmp_path), "-q", "--set", "run.duration=10.0"], check=True)
    with open(tmp_path / "timeseries.csv", newline="") as file:
        header, *rows = csv.reader(file)
    expected = np.array(rows, dtype=float)
    results = moorline.run(path, changes)
    table = results.to_pandas()
    assert ["time", *table.columns] == header
    assert len(results.time) > 10
    assert np.array_equal(results.time, expected[:, 0])
    assert np.array_equal(table.to_numpy(), expected[:, 1:])


def test_a_dict_is_the_same_as_its_file():
    given = scene("lindahl-sjoberg")
    given["run"]["duration"] = np.float64(3.0)
    given["lines"][0]["fairlead"] = np.zeros(3)
    one, other = moorline.run(given), moorline.run(None, {"run.duration": 3.0})
    assert np.array_equal(one.lines["line"].tension, other.lines["line"].tension)
    assert one.lines["line"].force.shape == (31, 3)
    line = one.lines["line"]
    shots, nodes = line.node_tension.shape
    assert line.node_position.shape == (shots, nodes, 3) and line.s.shape == (nodes,) and one.snapshot_time.shape == (shots,)
    assert np.array_equal(line.node_position[0, 0], line.fairlead[0])


def test_statics_is_the_elastic_catenary():
    """Source: Irvine (1981): a chain that hangs between two points, solved here by bisection over the horizontal force."""
    found = moorline.statics(EXAMPLES / "slack-catenary.json").lines["garland"]
    weight = 135.35 * 9.80665 - 1025.0 * 9.80665 * math.pi / 4 * 0.076**2
    length, ea, across, down = 180.0, 5.0e8, 100.0, 20.0

    def spans(h, v):
        x = h * length / ea + h / weight * (math.asinh(v / h) - math.asinh((v - weight * length) / h))
        z = (v * length - weight * length**2 / 2) / ea + (math.hypot(h, v) - math.hypot(h, v - weight * length)) / weight
        return x, z

    def vertical(h):
        low, high = 0.0, 2.0 * weight * length
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if spans(h, middle)[1] < down else (low, middle)
        return low

    low, high = 1.0, 1.0e7
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if spans(middle, vertical(middle))[0] < across else (low, middle)
    assert found.tension == pytest.approx(math.hypot(low, vertical(low)), rel=1e-4)


def test_statics_of_an_example_is_what_its_title_says():
    """Source: the title of semi-submersible.json: 1105.7 kN at each fairlead, 907.8 kN at each anchor."""
    found = moorline.statics(EXAMPLES / "semi-submersible.json")
    assert found.converged
    for line in found.lines.values():
        assert line.tension == pytest.approx(1105.7e3, rel=1e-4)
        assert line.anchor_tension == pytest.approx(907.8e3, rel=1e-4)
        assert np.linalg.norm(line.force) == pytest.approx(line.tension, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "place", "words"),
    [
        ({"line_types.chain.ea": -1.0}, "line_types.chain.ea", "-1"),
        ({"line_types.chain.eaa": 1.0}, "line_types.chain.eaa", "did you mean `ea`"),
        ({"environment.depth": "deep"}, "environment.depth", "deep"),
        ({"lines[0].fairlead": [0.0, 0.0, -500.0]}, "lines[0].fairlead", "bed"),
    ],
)
def test_what_is_not_allowed_is_named_with_its_place(change, place, words):
    with pytest.raises(moorline.InputError) as caught:
        moorline.statics(None, change)
    assert caught.value.place == place
    assert words in str(caught.value) and place in str(caught.value)
    assert isinstance(caught.value, moorline.Error) and isinstance(caught.value, ValueError)


def test_bad_scenes_are_refused():
    with pytest.raises(moorline.InputError, match="nowhere.json"):
        moorline.run("nowhere.json")
    with pytest.raises(moorline.InputError, match="not int"):
        moorline.run(7)
    with pytest.raises(moorline.InputError, match="JSON"):
        moorline.run({"title": object()})
    with pytest.raises(moorline.InputError, match="not a finite|NaN"):
        moorline.run({"environment": {"depth": math.nan}})
    with pytest.raises(moorline.InputError, match="environment"):
        moorline.run({})


def test_a_run_that_fails_keeps_what_came_before():
    broken = scene("lindahl-sjoberg")
    broken["run"]["duration"] = 30.0
    broken["motion"] = {"kind": "sinusoidal", "period": 40.0, "sine": [-1500.0, 0.0, 0.0], "ramp": 0.0}
    with pytest.raises(moorline.ConvergenceError) as caught:
        moorline.run(broken)
    kept = caught.value.results
    assert 0.0 < kept.time[-1] < 30.0 and kept.summary["completed"] is False
    assert len(kept.lines["line"].tension) == len(kept.time)


def test_offsets_and_fit_agree_with_statics():
    """Source: statics of the same scene with the body put there; the tension that was asked for."""
    path = EXAMPLES / "semi-submersible.json"
    curve = moorline.offsets(path, "platform", "x", [-5.0, 0.0, 5.0])
    rest = moorline.statics(path)
    aside = scene("semi-submersible")
    aside["bodies"][0]["motion"] = {"kind": "fixed"}
    aside["bodies"][0]["position"] = [5.0, 0.0, 0.0]
    moved = moorline.statics(aside)
    assert curve.offset.tolist() == [-5.0, 0.0, 5.0]
    assert curve.force[1] == pytest.approx(rest.bodies["platform"].force, rel=1e-6, abs=1.0)
    assert curve.force[2] == pytest.approx(moved.bodies["platform"].force, rel=1e-6, abs=1.0)
    assert curve.tension["line1"][2] == pytest.approx(moved.lines["line1"].tension, rel=1e-6)
    found = moorline.fit(None, "lines[0].sections[0].length", "line.tension", 1.5e6, between=(1190.0, 1200.0))
    assert moorline.statics(found.scene).lines["line"].tension == pytest.approx(1.5e6, rel=1e-6)
    assert found.before == 1200.0 and 1190.0 < found.value < 1200.0
    with pytest.raises(moorline.InputError, match="platform"):
        moorline.offsets(path, "plattform", "x", [1.0])
    with pytest.raises(moorline.InputError, match="roll"):
        moorline.offsets(path, "platform", "rol", [1.0])


def sailed(mooring, steps):
    tensions = []
    for _ in range(steps):
        t = mooring.time
        pose = [2.0 * math.sin(0.3 * t), 0.0, 0.0, 0.0, 0.0, 0.0]
        rate = [0.6 * math.cos(0.3 * t), 0.0, 0.0, 0.0, 0.0, 0.0]
        mooring.step(0.1, poses={"platform": pose}, rates={"platform": rate})
        tensions.append(mooring.tensions()["line1"])
    return tensions


def test_a_mooring_goes_back_to_a_state_to_the_bit():
    mooring = moorline.Mooring(EXAMPLES / "semi-submersible.json")
    sailed(mooring, 20)
    state = mooring.save()
    first = sailed(mooring, 20)
    mooring.restore(state)
    assert mooring.time == pytest.approx(2.0)
    assert sailed(mooring, 20) == first
    other = moorline.Mooring(EXAMPLES / "semi-submersible.json")
    other.restore(state)
    assert sailed(other, 20) == first
    with pytest.raises(moorline.Error):
        moorline.Mooring(None).restore(state)


def test_a_mooring_begins_in_equilibrium_and_its_stiffness_is_that_of_differences():
    """Source: statics of the same scene; differences of the loads between settled poses, 2e-3 of the largest entry."""
    path = EXAMPLES / "semi-submersible.json"
    mooring = moorline.Mooring(path)
    rest = moorline.statics(path).bodies["platform"]
    assert mooring.loads()["platform"][:3] == pytest.approx(rest.force, rel=1e-6, abs=1.0)
    pose = np.array([4.0, 1.0, 0.0, 0.0, 0.0, 0.1])
    mooring.settle({"platform": pose})
    stiffness = mooring.stiffness("platform")
    step = 0.05
    for axis in (0, 1, 2):
        aside = [mooring.settle({"platform": pose + sign * step * np.eye(6)[axis]})["platform"] for sign in (1, -1)]
        column = (aside[1] - aside[0]) / (2 * step)
        assert column[:3] == pytest.approx(stiffness[:3, axis], abs=2e-3 * np.abs(stiffness[:3, :3]).max())
    assert mooring.pose("platform").shape == (6,)


def test_the_matrices_of_a_step_are_those_of_differences():
    """Source: central differences of the step itself, taken back each time; 3e-3 of the largest entry of a block."""
    mooring = moorline.Mooring(EXAMPLES / "semi-submersible.json")
    sailed(mooring, 20)
    state = mooring.save()
    pose, rate = np.array([1.1, 0.3, 0.1, 0.01, 0.02, 0.05]), np.array([0.5, 0.0, 0.1, 0.0, 0.01, 0.0])
    found = mooring.linearise("platform", {"platform": pose}, {"platform": rate})
    assert mooring.time == pytest.approx(2.0)

    def after(pose, rate):
        mooring.restore(state)
        return mooring.step(0.1, {"platform": pose}, {"platform": rate})["platform"]

    def turned(axis, angle):
        """The pose after a small turn about a global axis."""
        roll, pitch, yaw = pose[3:]
        x = np.array([[1, 0, 0], [0, math.cos(roll), -math.sin(roll)], [0, math.sin(roll), math.cos(roll)]])
        y = np.array([[math.cos(pitch), 0, math.sin(pitch)], [0, 1, 0], [-math.sin(pitch), 0, math.cos(pitch)]])
        z = np.array([[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]])
        skew = np.cross(np.eye(3), np.eye(3)[axis]) * angle
        r = (np.eye(3) + skew + 0.5 * skew @ skew) @ z @ y @ x
        return np.array([*pose[:3], math.atan2(r[2, 1], r[2, 2]), -math.asin(r[2, 0]), math.atan2(r[1, 0], r[0, 0])])

    columns = {"stiffness": [], "damping": []}
    for axis in range(6):
        size = 1.0e-3 if axis < 3 else 1.0e-4
        aside = [pose + sign * size * np.eye(6)[axis] if axis < 3 else turned(axis - 3, sign * size) for sign in (1, -1)]
        columns["stiffness"].append((after(aside[1], rate) - after(aside[0], rate)) / (2 * size))
        faster = [rate + sign * size * np.eye(6)[axis] for sign in (1, -1)]
        columns["damping"].append((after(pose, faster[1]) - after(pose, faster[0])) / (2 * size))
    for name, expected in columns.items():
        given, expected = getattr(found, name), np.array(expected).T
        for rows in (slice(0, 3), slice(3, 6)):
            for of in (slice(0, 3), slice(3, 6)):
                assert given[rows, of] == pytest.approx(expected[rows, of], abs=3e-3 * np.abs(expected[rows, of]).max()), name
    assert (np.diag(found.damping) > 0).all()
    with pytest.raises(moorline.InputError, match="platform"):
        mooring.linearise("plattform")


def test_a_mooring_of_one_line_moves_its_fairlead():
    """Source: the run of the built-in scene, whose fairlead goes the same way; 0.5 % of the tension."""
    results = moorline.run(None, {"run.duration": 20.0, "run.output_step": 0.05})
    mooring = moorline.Mooring(None)
    places = results.lines["line"].fairlead
    speeds = np.gradient(places, results.time, axis=0, edge_order=2)
    for row in range(len(results.time) - 1):
        mooring.step(0.05, poses={"line": places[row]}, rates={"line": speeds[row]})
    assert mooring.tensions()["line"] == pytest.approx(results.lines["line"].tension[-1], rel=5e-3)
    assert abs(results.lines["line"].tension[-1] / results.lines["line"].tension[0] - 1.0) > 0.01


def test_a_mooring_refuses_what_it_does_not_know():
    mooring = moorline.Mooring(EXAMPLES / "semi-submersible.json")
    with pytest.raises(moorline.InputError, match="platform"):
        mooring.step(0.1, poses={"ship": [0.0] * 6})
    with pytest.raises(moorline.InputError, match=r"\(6,\)"):
        mooring.step(0.1, poses={"platform": [0.0] * 3})
    with pytest.raises(moorline.InputError, match="did you mean"):
        mooring.get("line1.tensoin")
    with pytest.raises(moorline.Error, match="positive"):
        mooring.step(-1.0)


def test_progress_is_told_and_may_end_the_run():
    seen = []
    moorline.run(None, {"run.duration": 5.0}, progress=lambda now, end: seen.append((now, end)))
    assert seen[0][0] == 0.0 and seen[-1] == (5.0, 5.0)

    def enough(now, end):
        if now > 1.0:
            raise StopIteration("enough")

    with pytest.raises(StopIteration, match="enough"):
        moorline.run(None, {"run.duration": 100000.0}, progress=enough)


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_ends_a_run():
    # Where the tests run in the background of a shell, Ctrl-C is ignored from the start.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    began = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            moorline.run(None, {"run.duration": 1.0e6})
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - began < 5.0


def test_other_threads_go_on_during_a_run():
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    began = time.monotonic()
    before = counted[0]
    moorline.run(None, {"run.duration": 2000.0, "run.output_step": 100.0})
    seconds, ticks = time.monotonic() - began, counted[0] - before
    done.set()
    thread.join()
    assert ticks > 20 * seconds, f"{ticks} ticks in {seconds} s"


def test_tables_of_other_packages():
    results = moorline.run(EXAMPLES / "semi-submersible.json", {"run.duration": 1.0})
    pytest.importorskip("xarray")
    dataset = results.to_xarray()
    assert dataset["tension"].dims == ("line", "time") and dataset["tension"].attrs["units"] == "N"
    assert np.array_equal(dataset["tension"].sel(line="line2"), results.lines["line2"].tension)
    assert np.array_equal(dataset["body_force"].sel(body="platform"), results.bodies["platform"].force)
    assert dataset["line1.tension"].shape == results.lines["line1"].node_tension.shape


def test_an_fmu_without_a_compiler(tmp_path):
    """Source: statics of the same scene."""
    path = moorline.pack(EXAMPLES / "lindahl-sjoberg.json", tmp_path / "line.fmu")
    assert path.is_file() and (tmp_path / "lindahl-sjoberg_OspModelDescription.xml").is_file()
    fmpy = pytest.importorskip("fmpy")
    result = fmpy.simulate_fmu(str(path), stop_time=0.1, step_size=0.1, output_interval=0.1, output=["tension"])
    assert result["tension"][0] == pytest.approx(moorline.statics(None).lines["line"].tension, rel=1e-6)


def test_check_gives_defaults_and_warnings():
    assert moorline.check(None)["solver"]["scheme"] == "adams-moulton"
    unused = scene("lindahl-sjoberg")
    unused["line_types"]["rope"] = {"ea": 1.0e6, "mass": 10.0, "diameter": 0.1}
    with pytest.warns(moorline.Warning, match="rope"):
        moorline.check(unused)
    assert moorline.schema()["properties"]["environment"]


def test_the_command_answers_with_its_exit_codes(tmp_path):
    version = subprocess.run([*COMMAND, "--version"], capture_output=True, check=True, text=True)
    assert version.stdout.split() == ["moorline", moorline.__version__]
    bad = tmp_path / "bad.json"
    bad.write_text("{}")
    refused = subprocess.run([*COMMAND, "check", str(bad)], capture_output=True, check=False, text=True)
    assert refused.returncode == 2 and "environment" in refused.stderr
