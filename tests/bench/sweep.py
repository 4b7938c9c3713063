"""What a sweep costs beside its runs: 10 000 short ones on two workers.

usage: pip install ".[sweep]"; python tests/bench/sweep.py [RUNS]

All is CPU time, which a busy machine changes least: that of all processes (workers, scheduler, this program) over the sweep, less that of
the same runs one after the other in this program, and less what these processes take when they have nothing to do, over the number of
runs. It holds giving out, statistics, taking in and the store. Starting the workers, and what they take at rest, is told by itself.
"""

import sys
import tempfile
import time
from pathlib import Path

import moorline
import numpy as np
import psutil
from distributed import Client, LocalCluster

ROOT = Path(__file__).resolve().parents[2]
WORKERS = 2


def spent():
    """CPU time of this process and all below it [s]."""
    own = psutil.Process()
    times = [process.cpu_times() for process in (own, *own.children(recursive=True))]
    return sum(time.user + time.system for time in times)


def alone(scene, rows, what):
    """CPU time of a run without a sweep [s], from some of them."""
    call = getattr(moorline, what)
    some = rows[:: max(len(rows) // 300, 1)]
    began = time.process_time()
    for changes in some:
        call(scene, changes)
    return (time.process_time() - began) / len(some)


def measured(client, idle, name, scene, rows, what="run", **how):
    run = alone(scene, rows, what)
    began, wall = spent(), time.perf_counter()
    found = moorline.sweep(scene, rows, what=what, client=client, **how)
    wall = time.perf_counter() - wall
    cost = (spent() - began - idle * wall) / len(rows)
    assert (found.state == 1).all(), found.message.values[found.state.values == 2][:1]
    print(f"| {name} | {len(rows)} | {1e3 * run:.2f} ms | {1e3 * (cost - run):.2f} ms | {wall:.0f} s |", flush=True)


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    began = time.perf_counter()
    keep = {"RAYON_NUM_THREADS": "1"}
    with (
        LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None, env=keep) as cluster,
        Client(cluster) as client,
        tempfile.TemporaryDirectory() as folder,
    ):
        client.run(lambda: __import__("moorline").__version__)
        print(f"{WORKERS} workers are there after {time.perf_counter() - began:.1f} s", end="; ")
        time.sleep(3.0)
        began, idle = time.perf_counter(), spent()
        time.sleep(15.0)
        idle = (spent() - idle) / (time.perf_counter() - began)
        print(f"at rest all processes take {idle:.2f} of a core\n")
        print("| sweep | runs | a run alone | more in a sweep | whole sweep |\n| --- | ---: | ---: | ---: | ---: |")
        semi = ROOT / "examples/semi-submersible.json"
        aside = np.linspace(-10.0, 10.0, max(runs // 10, 10)).tolist()
        offsets = [{"bodies[0].motion.kind": "fixed", "bodies[0].position": [offset, 0.0, 0.0]} for offset in aside]
        measured(client, idle, "statics of a platform on three lines, at offsets", semi, offsets, what="statics")
        sea = {"environment.waves.kind": "jonswap", "environment.waves.hs": 4.0, "environment.waves.tp": 9.0, "run.duration": 600.0}
        seeds = [{**sea, "environment.waves.seed": seed} for seed in range(max(runs // 500, 2))]
        measured(client, idle, "a wire in a sea for ten minutes", ROOT / "examples/wire-under-waves.json", seeds)
        length = "lines[0].sections[0].length"
        still = [{length: value, "run.duration": 1.0, "motion.kind": "fixed"} for value in np.linspace(1195.0, 1205.0, runs).tolist()]
        measured(client, idle, "the built-in scene for a second, nothing moves", None, still)
        measured(client, idle, "the same, with a store", None, still, store=Path(folder, "store"))


if __name__ == "__main__":
    main()
