"""Times of collisions of arrays: from NumPy, by the program, in Rust alone, and by solve_ivp.

    python python/benches/collisions.py PROGRAM ARRAYS [COUNT]

PROGRAM is the path of `stickslip`, ARRAYS that of the example `arrays` of crates/validation, both
built with --release. All times are from one run, alternating, the least of five (one for the program
and SciPy). SciPy integrates 20 of the collisions.
"""

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import stickslip


def seconds(work: Callable[[], object], times: int = 5) -> float:
    found = []
    for _ in range(times):
        begun = time.perf_counter()
        work()
        found.append(time.perf_counter() - begun)
    return min(found)


def by_scipy(kappa: float, psi: float, damping: float) -> float:
    """eps_t by solve_ivp with terminal events, in plain time; y is the spring, w the velocity."""

    def force(x: float, v: float) -> float:
        return max(x, 0.0) ** 1.5 + damping * max(x, 0.0) ** 0.5 * v

    def rate(x: float, v: float) -> float:
        root = max(x, 1e-300) ** 0.5
        return 1.5 * root * v + damping * (v * v / (2 * root) - root * force(x, v))

    def field(mode: int) -> Callable[[float, np.ndarray], list[float]]:
        def slope(_: float, s: np.ndarray) -> list[float]:
            x, v, y, w = s
            pull = kappa * y if mode == 0 else mode * force(x, v)
            return [v, -force(x, v), w if mode == 0 else 0.0, -pull]

        return slope

    def event(function: Callable[[float, np.ndarray], float], direction: int) -> object:
        function.terminal, function.direction = True, direction  # type: ignore[attr-defined]
        return function

    # The contact ends where the force, which is √x (x + a v), falls to 0.
    end = event(lambda _, s: s[0] + damping * s[1], -1)
    # Without damping the contact starts in slip, with damping in stick.
    state, now, mode = np.array([0.0, 1.0, 0.0, psi]), 0.0, int(damping == 0.0)
    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12}
    for _ in range(100):
        if mode == 0:
            stops = [
                event(lambda _, s: force(s[0], s[1]) - kappa * s[2], -1),
                event(lambda _, s: force(s[0], s[1]) + kappa * s[2], -1),
            ]
        else:
            # Slip ends where the spring falls behind its limit.
            stops = [event(lambda _, s: mode * s[3] - rate(s[0], s[1]) / kappa, -1)]
        run = solve_ivp(field(mode), (now, 20.0), state, events=[end, *stops], **options)
        state, now = run.y[:, -1].copy(), run.t[-1]
        fired = [index for index, times in enumerate(run.t_events) if times.size]
        if not fired or fired[0] == 0 or now > 19:
            return float(state[3] / psi)
        if mode == 0:
            mode = 1 if fired[0] == 1 else -1
        else:
            # A hair inside the limit, so that the event does not fire again at once.
            state[2] = mode * force(state[0], state[1]) / kappa * (1 - 1e-12)
            mode = 0
    return float("nan")


def main() -> None:
    program, arrays = sys.argv[1:3]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 1_000_000
    random = np.random.default_rng(1)
    kappa = 10 ** random.uniform(-1, 2, count)
    psi = 10 ** random.uniform(-2, 0.5, count)
    print("| damping | collisions | threads | eps_t | collide_many | Rust | overhead | program |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for damping in (0.0, 0.1):
            for size in (100_000, count):
                k, p = kappa[:size], psi[:size]
                a = np.full(size, damping)
                file = Path(folder) / "points"
                np.concatenate([k, p, a]).astype("<f8").tofile(file)
                table = Path(folder) / "points.csv"
                np.savetxt(table, np.column_stack([k, p, a]), "%.17g", ",",
                           header="kappa,psi,damping", comments="")  # fmt: skip
                for threads in (1, 2):
                    command = [arrays, str(file), str(threads)]
                    rust = float(subprocess.check_output(command))
                    alone = seconds(lambda: stickslip.eps_t(k, p, a, threads=threads))
                    many = seconds(lambda: stickslip.collide_many(k, p, a, threads=threads))
                    rust = min(rust, float(subprocess.check_output(command)))
                    batch = [program, "collide", "--batch", str(table), "--out",
                             str(Path(folder) / "out.csv"), "--method", "exact",
                             "--threads", str(threads)]  # fmt: skip
                    whole = seconds(lambda: subprocess.run(batch, check=True), 1)
                    print(
                        f"| {damping} | {size} | {threads} | {alone:.3f} s | {many:.3f} s "
                        f"| {rust:.3f} s | {100 * (alone / rust - 1):.1f} % | {whole:.3f} s |"
                    )
    for damping in (0.0, 0.1):
        begun = time.perf_counter()
        found = [by_scipy(k, p, damping) for k, p in zip(kappa[:20], psi[:20], strict=True)]
        each = (time.perf_counter() - begun) / 20
        off = np.abs(np.array(found) - stickslip.eps_t(kappa[:20], psi[:20], damping))
        wrong = ~(off < 1e-6)
        print(f"solve_ivp, damping {damping}: {1e3 * each:.1f} ms a collision, "
              f"{wrong.sum()} of 20 off by more than 1e-6")  # fmt: skip


if __name__ == "__main__":
    main()
