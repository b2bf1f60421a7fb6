"""Sweeps on two worker processes: time, memory, and the same bits when processes are killed.

    python benches/sweeps.py --exact 10000000 --damped 1000000

Each sweep is computed twice. The second time, a worker is killed every ten seconds, and the client
once, half way. Both stores must have the same bits.
"""

import argparse
import hashlib
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import psutil
import xarray as xr


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--exact", type=int, default=10**7, help="undamped collisions")
    parser.add_argument("--damped", type=int, default=10**6, help="damped collisions")
    parser.add_argument("--every", type=float, default=10.0, help="seconds between kills")
    parser.add_argument("--folder", type=Path, help="for the stores; a temporary one if not given")
    parser.add_argument("--client", nargs=3, metavar=("STORE", "SIZE", "DAMPING"))
    arguments = parser.parse_args()
    if arguments.client:
        store, size, damping = arguments.client
        compute(store, int(size), float(damping))
        return
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        for name, size, damping in (
            ("undamped", arguments.exact, 0.0),
            ("damped", arguments.damped, 0.1),
        ):
            if size:
                print(f"{name}, {size} collisions", flush=True)
                calm = run(Path(folder) / f"{name} calm", size, damping, None)
                killed = run(Path(folder) / f"{name} killed", size, damping, arguments.every)
                if calm != killed:
                    sys.exit(f"{name}: the bits differ")
                print(f"  same bits: sha256 {calm}", flush=True)


def compute(store: str, size: int, damping: float) -> None:
    """The client: a grid of `size` collisions on two workers."""
    import dask
    from distributed import Client, LocalCluster

    from stickslip import write_sweep

    # Or a worker is given up that was killed twice before it could start again.
    dask.config.set({"distributed.deploy.lost-worker-timeout": "1h"})
    rows = next(n for n in range(math.isqrt(size), 0, -1) if size % n == 0)
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0")
    with cluster, Client(cluster) as client:
        write_sweep(
            store, np.linspace(0.1, 100, size // rows), np.linspace(0.01, 4, rows), damping,
            client=client, progress=lambda done, blocks: print(done, blocks, flush=True),
        )  # fmt: skip


def run(store: Path, size: int, damping: float, every: float | None) -> str:
    """Runs the client until the store is complete, kills if asked, and prints what it took."""
    command = [sys.executable, __file__, "--client", str(store), str(size), str(damping)]
    log = store.with_suffix(".log")
    begin = last = time.monotonic()
    workers_killed = clients_killed = at_start = 0
    peaks = {"client": 0, "worker": 0}
    client = start(command, log)
    while (status := wait(client)) is None:
        workers = [one for one in children(client) if "spawn_main" in " ".join(one[1])]
        for kind, processes in (("client", [client]), ("worker", [one[0] for one in workers])):
            peaks[kind] = max([peaks[kind], *(peak(one) for one in processes)])
        if every is None or time.monotonic() - last < every:
            continue
        done, blocks = finished(store)
        if done == at_start:
            continue  # A cluster that has not begun cannot replace its workers.
        last = time.monotonic()
        if clients_killed == 0 and 2 * done >= blocks > 0:
            client.kill()
            client.wait()
            psutil.wait_procs([one[0] for one in workers], timeout=60)
            client = start(command, log)
            clients_killed += 1
            at_start = finished(store)[0]
        elif workers:
            workers[workers_killed % len(workers)][0].kill()
            workers_killed += 1
    if status != 0:
        sys.exit(f"the client ended with {status}:\n{log.read_text()}")
    seconds = time.monotonic() - begin
    done, blocks = finished(store)
    written = sum(file.stat().st_size for file in store.rglob("*") if file.is_file())
    left = len(list(store.rglob("*.partial")))
    memory = ", ".join(f"{kind} {most >> 20} MiB" for kind, most in peaks.items())
    print(
        f"  {seconds:.1f} s, {1e6 * seconds / size:.3f} µs a collision, {done} of {blocks} blocks; "
        f"peak memory: {memory}; store {written / 1e6:.0f} MB; killed: {workers_killed} workers, "
        f"{clients_killed} clients; {left} drafts left",
        flush=True,
    )
    return digest(store)


def start(command: list[str], log: Path) -> psutil.Popen:
    with log.open("w") as file:
        return psutil.Popen(command, stdout=subprocess.DEVNULL, stderr=file)


def wait(client: psutil.Popen) -> int | None:
    try:
        return client.wait(timeout=0.2)
    except (subprocess.TimeoutExpired, psutil.TimeoutExpired):
        return None


def children(client: psutil.Popen) -> list[tuple[psutil.Process, list[str]]]:
    found = []
    try:
        for process in client.children(recursive=True):
            found.append((process, process.cmdline()))
    except psutil.NoSuchProcess:
        pass
    return found


def peak(process: psutil.Process) -> int:
    """The most memory a process had so far, in bytes."""
    try:
        status = Path(f"/proc/{process.pid}/status").read_text()
    except OSError:
        return 0
    lines = [line.split() for line in status.splitlines() if line.startswith("VmHWM")]
    return int(lines[0][1]) << 10 if lines else 0


def finished(store: Path) -> tuple[int, int]:
    """The blocks with their marks, and all blocks."""
    if not store.exists():
        return 0, 0
    found = xr.open_zarr(store, consolidated=False)
    marks = [path for path in store.glob("_blocks/digest/c/*/*") if path.suffix != ".partial"]
    return len(marks), math.prod(found.eps_t.data.numblocks)


def digest(store: Path) -> str:
    """Of all results, in the order of the grid."""
    total = hashlib.sha256()
    found = xr.open_zarr(store, chunks=None, consolidated=False)
    if found.attrs["complete"] != 1 or bool(found.eps_t[:, :1].isnull().any()):
        sys.exit(f"{store}: not complete")
    for name in ("eps_t", "switch_count"):
        for row in range(0, found.sizes["kappa"], 1000):
            total.update(found[name][row : row + 1000].values.tobytes())
    return total.hexdigest()


if __name__ == "__main__":
    main()
