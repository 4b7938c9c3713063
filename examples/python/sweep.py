"""Sea states and seeds of a buoy with a tanker on its hawser, on all cores of this machine or on a cluster: the tension that one in twenty seeds
exceeds, of the hawser and of the leg that carries most.

usage: pip install ".[sweep]"
       python examples/python/sweep.py [--scheduler tcp://HOST:8786 | --slurm WORKERS] [--seeds N] [--duration S] [--store DIR]

On a cluster: every worker needs moorline and sees this directory, and the store lies on a file system that this program writes. With a
scheduler that runs (`dask scheduler`, and `dask worker HOST:8786 --nthreads 1 --nworkers auto` on each node), name it; with SLURM, `--slurm 100` asks for
100 workers (pip install dask-jobqueue; PBS, LSF and SGE have classes beside SLURMCluster). Set RAYON_NUM_THREADS=1 for the workers: each run
then keeps to its core. If the program is ended, start it again with the same arguments: what the store holds is not run again.
"""

import argparse
from contextlib import ExitStack
from pathlib import Path

import moorline
import numpy as np

SCENE = Path(__file__).resolve().parents[1] / "calm-buoy.json"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--scheduler")
    parser.add_argument("--slurm", type=int)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--duration", type=float, default=600.0)
    parser.add_argument("--store", type=Path, default=Path("out/sweep.zarr"))
    given = parser.parse_args()
    over = {
        "environment.waves.hs": [2.0, 3.5],
        "environment.waves.tp": [7.0, 9.0, 11.0],
        "environment.waves.seed": range(given.seeds),
    }
    changes = {"environment.waves.kind": "jonswap", "run.duration": given.duration}
    with ExitStack() as stack:
        client = None
        if given.slurm:
            from dask_jobqueue import SLURMCluster
            from distributed import Client

            # Cores, memory and wall time of a job; the queue and the account are those of the place.
            prologue = ["export RAYON_NUM_THREADS=1"]
            cluster = stack.enter_context(
                SLURMCluster(cores=16, processes=16, memory="16GB", walltime="04:00:00", job_script_prologue=prologue)
            )
            cluster.scale(given.slurm)
            client = stack.enter_context(Client(cluster))
        elif given.scheduler:
            from distributed import Client

            client = stack.enter_context(Client(given.scheduler))
        found = moorline.sweep(
            SCENE,
            over,
            changes=changes,
            client=client,
            store=given.store,
            progress=lambda there, of: print(f"\r{there} of {of}", end="", flush=True),
        )
    print()
    failed = found.where(found.state == 2, drop=True)
    for message in np.unique(failed.message.values.astype(str)):
        print(f"failed: {message}")
    grid = found.set_index(run=list(over)).unstack("run")
    for hs in grid["environment.waves.hs"].values:
        for tp in grid["environment.waves.tp"].values:
            largest = grid.tension_max.sel({"environment.waves.hs": hs, "environment.waves.tp": tp}) / 1e3
            often = largest.quantile(0.95, "environment.waves.seed")
            hawser, leg = float(often.sel(line="hawser")), float(often.drop_sel(line="hawser").max())
            print(f"hs {hs:.1f} m, tp {tp:.0f} s: one in twenty seeds has more than {hawser:.1f} kN in the hawser, {leg:.1f} kN in a leg")


if __name__ == "__main__":
    main()
