"""Times look-ups in a table of the restitution: `python python/benches/tables.py [THREADS]`."""

import sys
import time

import numpy as np

import stickslip

COUNT = 1_000_000
ROUNDS = 20

threads = int(sys.argv[1]) if len(sys.argv) > 1 else 1
table = stickslip.table((0.5, 100), (0.01, 3))
random = np.random.default_rng(1)
kappa = np.clip(0.5 * 200 ** random.random(COUNT), 0.5, 100)
psi = 0.01 + 2.99 * random.random(COUNT)
times = []
for _ in range(ROUNDS):
    start = time.perf_counter()
    table.eps_t(kappa, psi, threads=threads)
    times.append(time.perf_counter() - start)
print(f"{min(times) / COUNT * 1e9:.1f} ns a point at random, {threads} threads; {table}")
