"""Sweeps: rows against single runs, a worker that is killed, a sweep that is cut, and what is refused."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import moorline
import numpy as np
import pytest

distributed = pytest.importorskip("distributed")
xarray = pytest.importorskip("xarray")
pytest.importorskip("zarr")

LENGTH = "lines[0].sections[0].length"
SHORT = {"run.duration": 2.0}


@pytest.fixture(scope="module")
def client():
    """A local cluster of two workers, each a process. A task whose worker dies is not tried again by Dask."""
    import dask

    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_rows_are_the_runs_one_by_one(client):
    """Source: `moorline.run` and `moorline.statics` of each combination."""
    lengths, periods = [1195.0, 1200.0], [10.0, 15.0, 20.0]
    found = moorline.sweep(None, {LENGTH: lengths, "motion.period": periods}, changes=SHORT, client=client)
    assert found.sizes["run"] == 6 and (found.state == 1).all() and found.line.values.tolist() == ["line"]
    assert found[LENGTH].values.tolist() == [1195.0] * 3 + [1200.0] * 3 and found["motion.period"].values.tolist() == periods * 2
    for row in range(6):
        changes = {LENGTH: lengths[row // 3], "motion.period": periods[row % 3], **SHORT}
        line = moorline.run(None, changes).lines["line"]
        assert found.tension_max.values[row] == [line.tension.max()] and found.tension_std.values[row] == [line.tension.std()]
    still = moorline.sweep(None, {LENGTH: lengths}, what="statics", client=client)
    assert still.tension.values[0] == [moorline.statics(None, {LENGTH: 1195.0}).lines["line"].tension]


def test_an_outcome_of_ones_own_and_a_list_of_runs(client):
    def outcome(results):
        line = results.lines["line"]
        return {"last": line.tension[-1], "course": (("moment",), line.tension[::10])}

    rows = [{"motion.period": 10.0, LENGTH: 1200.0}, {"motion.period": 12.0, LENGTH: 1199.0}]
    found = moorline.sweep(None, rows, changes=SHORT, outcome=outcome, client=client)
    assert found.course.dims == ("run", "moment") and found.course.shape == (2, 3)
    line = moorline.run(None, {**rows[1], **SHORT}).lines["line"]
    assert found.course.values[1].tolist() == line.tension[::10].tolist() and found["last"].values[1] == line.tension[-1]


def test_a_scene_that_fails_is_a_row_with_its_message(client):
    found = moorline.sweep(None, {LENGTH: [-1.0, 1200.0, 900.0]}, changes=SHORT, client=client)
    assert found.state.values.tolist()[:2] == [2, 1]
    message = str(found.message.values[0])
    assert LENGTH in message and "-1" in message
    assert np.isnan(found.tension_max.values[0]).all() and found.message.values[1] == ""


def test_a_key_that_does_not_exist_fails_before_the_first_run(client, tmp_path):
    for over, words in [
        ({"lines[0].sections[0].lenght": [1.0, 2.0]}, "did you mean `length`"),
        ({LENGTH: [1200.0], "environment.waves.hs": [3.0]}, "kind"),
        ({"lines[3].fairlead": [[0.0, 0.0, 0.0]]}, "1 entry"),
    ]:
        with pytest.raises(moorline.InputError, match=words):
            moorline.sweep(None, over, client=client, store=tmp_path / "store")
        assert not (tmp_path / "store").exists()
    for over, words in [({}, "nothing"), ({LENGTH: []}, "no values"), ({LENGTH: 7.0}, "list"), ([{"a": 1}, {"b": 1}], "same keys")]:
        with pytest.raises(moorline.InputError, match=words):
            moorline.sweep(None, over, client=client)
    with pytest.raises(moorline.InputError, match="changes"):
        moorline.sweep(None, {LENGTH: [1200.0]}, changes={LENGTH: 1.0}, client=client)


def test_a_worker_that_is_killed_costs_its_runs_only(client, tmp_path):
    """Source: the same rows without a murder; how often each row ran is counted by files."""

    def outcome(results):
        (tmp_path / f"{os.getpid()}-{time.monotonic_ns()}").touch()
        time.sleep(0.05)
        return {"max": results.lines["line"].tension.max()}

    periods = np.linspace(10.0, 20.0, 60)
    killed = []

    def murder(there, _):
        if there >= 10 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    found = moorline.sweep(None, {"motion.period": periods}, changes=SHORT, outcome=outcome, client=client, batch=3, progress=murder)
    assert killed and (found.state == 1).all()
    ran = len(list(tmp_path.iterdir()))
    # The dead worker had at most three tasks of three runs; all else ran once.
    assert 60 <= ran <= 60 + 12, ran
    expected = [moorline.run(None, {"motion.period": period, **SHORT}).lines["line"].tension.max() for period in periods[:3]]
    assert found["max"].values[:3].tolist() == expected


def test_a_scene_that_kills_its_workers_is_a_row(client):
    def outcome(results):
        if results.lines["line"].fairlead[0, 0] == 1.0:
            os.kill(os.getpid(), signal.SIGKILL)
        return {"x": results.lines["line"].fairlead[0, 0]}

    over = {"lines[0].fairlead[0]": [0.0, 1.0, 2.0]}
    found = moorline.sweep(None, over, changes={**SHORT, "motion.kind": "fixed"}, outcome=outcome, client=client, batch=3)
    assert found.state.values.tolist() == [1, 2, 1] and found.x.values[[0, 2]].tolist() == [0.0, 2.0]
    assert "died" in str(found.message.values[1])


def test_a_sweep_does_not_wait_for_ever_for_workers(monkeypatch):
    monkeypatch.setattr("moorline._sweep._PATIENCE", 0.5)
    with (
        distributed.LocalCluster(n_workers=0, dashboard_address=None) as cluster,
        distributed.Client(cluster) as nobody,
        pytest.raises(moorline.Error, match="no worker has been there for"),
    ):
        moorline.sweep(None, {"motion.period": [10.0]}, changes=SHORT, client=nobody)


def test_a_sweep_that_is_cut_goes_on_where_it_was(client, tmp_path):
    """The program is killed half way; how often a row ran is counted by files."""
    store, counted = tmp_path / "store", tmp_path / "counted"
    counted.mkdir()
    script = tmp_path / "script.py"
    script.write_text(
        textwrap.dedent(f"""
        import os, sys, time
        import moorline
        from pathlib import Path

        def outcome(results):
            Path({str(counted)!r}, f"{{os.getpid()}}-{{time.monotonic_ns()}}").touch()
            time.sleep(0.02)
            return {{"max": results.lines["line"].tension.max()}}

        def progress(there, of):
            print(there, flush=True)

        if __name__ == "__main__":
            from distributed import Client
            over = {{"motion.period": [10.0 + 0.05 * k for k in range(200)], "lines[0].sections[0].length": [1200.0]}}
            with Client({client.scheduler.address!r}) as client:
                found = moorline.sweep(None, over, changes={SHORT!r}, outcome=outcome, client=client, store={str(store)!r}, batch=5, progress=progress)
            print("done", int((found.state == 1).sum()), repr(float(found["max"].sum())), flush=True)
        """)
    )
    first = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True)
    while not store.exists() or not (xarray.open_zarr(store).state == 1).any():
        assert first.poll() is None, "it ended before it was cut"
        time.sleep(0.2)
    first.kill()
    first.wait()
    there = int((xarray.open_zarr(store).state == 1).sum())
    assert 0 < there < 200
    time.sleep(1.0)
    before = len(list(counted.iterdir()))
    again = subprocess.run([sys.executable, str(script)], capture_output=True, check=True, text=True).stdout.split()
    assert int(again[0]) == there and again[-3:-1] == ["done", "200"]
    assert len(list(counted.iterdir())) - before == 200 - there
    kept = xarray.open_zarr(store).load()
    assert (kept.state == 1).all() and float(kept["max"].sum()) == float(again[-1])
    assert kept["max"].values[7] == moorline.run(None, {"motion.period": 10.35, **SHORT}).lines["line"].tension.max()
    with pytest.raises(moorline.InputError, match="another sweep"):
        moorline.sweep(None, {"motion.period": [10.0]}, changes=SHORT, client=client, store=store)
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign/notes.txt").write_text("")
    with pytest.raises(moorline.InputError, match="foreign"):
        moorline.sweep(None, {"motion.period": [10.0]}, changes=SHORT, client=client, store=tmp_path / "foreign")
    assert (tmp_path / "foreign/notes.txt").exists()
