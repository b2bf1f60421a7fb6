"""A sweep on a Slurm cluster, with dask-jobqueue; or on this machine, with --local.

    python slurm.py /scratch/me/sweep.zarr
    python slurm.py --local 2 --points 100 sweep.zarr

Whatever is killed, the same command goes on.
"""

import argparse
from typing import Any

import numpy as np


def compute(store: str, points: int, client: Any) -> Any:
    """Damped collisions of ordinary materials: points × points, with five dampings."""
    from stickslip import write_sweep

    def report(done: int, blocks: int) -> None:
        print(f"{done} of {blocks} blocks", flush=True)

    return write_sweep(
        store,
        kappa=np.geomspace(1, 1000, points),
        psi=np.linspace(0.01, 4, points),
        damping=[0.0, 0.05, 0.1, 0.15, 0.2],
        quantities=("eps_t", "eps_n", "switch_count"),
        client=client,
        progress=report,
    )


def slurm_cluster(jobs: int) -> Any:
    """Jobs of 32 workers with a thread each; change what your cluster calls otherwise."""
    from dask_jobqueue import SLURMCluster

    cluster = SLURMCluster(
        cores=32,
        processes=32,
        memory="64GB",
        walltime="04:00:00",
        # One kind of processor: others may round otherwise, and would be refused.
        job_extra_directives=["--constraint=zen4"],
        # The workers end before Slurm ends them, not all at once.
        worker_extra_args=["--lifetime", "3h50m", "--lifetime-stagger", "5m"],
    )
    # New jobs come for those that end.
    cluster.adapt(minimum_jobs=1, maximum_jobs=jobs)
    return cluster


def local_cluster(workers: int) -> Any:
    """Worker processes on this machine."""
    from distributed import LocalCluster

    return LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0")


def main() -> None:
    """Reads the arguments, and computes."""
    from distributed import Client

    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("store", help="a directory that all workers see")
    parser.add_argument("--points", type=int, default=10_000, help="along kappa and psi")
    parser.add_argument("--jobs", type=int, default=20, help="of Slurm, at most")
    parser.add_argument("--local", type=int, metavar="WORKERS", help="processes, without Slurm")
    arguments = parser.parse_args()
    made = local_cluster(arguments.local) if arguments.local else slurm_cluster(arguments.jobs)
    with made as cluster, Client(cluster) as client:
        found = compute(arguments.store, arguments.points, client)
        print(found)


if __name__ == "__main__":
    main()
