"""Times of an atlas of a bouncing ball: of Python functions, and compiled.

    python python/benches/families.py [POINTS]

The family, the window and the options are those of the bouncing ball in `examples/gallery`, which
measures the same in Rust (`cargo run --release --example gallery -- POINTS "bouncing ball"`, with
RAYON_NUM_THREADS=1): a trace that is verified at POINTS random points, and as many runs. All are on
one thread; times are those of the processor.
"""

import sys
import time

import numpy as np
from numba import cfunc, types

from stickslip import (
    Compiled,
    HybridFamily,
    HybridSystem,
    TraceOptions,
    VerifyOptions,
    trace_family,
)

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)
WINDOW = (0.5, 2.0), (0.3, 0.8)


def fly(t, y, height, restitution):
    return [y[1], -1.0]


def floor(t, y, height, restitution):
    return y[0]


def bounce(t, y, height, restitution):
    return [0.0, -restitution * y[1]]


def drop(t, y, height, restitution):
    return [height, 0.0]


@cfunc(SIGNATURE)
def c_fly(t, y, out, p):
    out[0] = y[1]
    out[1] = -1.0


@cfunc(SIGNATURE)
def c_floor(t, y, out, p):
    out[0] = y[0]


@cfunc(SIGNATURE)
def c_bounce(t, y, out, p):
    out[0] = 0.0
    out[1] = -p[1] * y[1]


@cfunc(SIGNATURE)
def c_drop(t, y, out, p):
    out[0] = p[0]
    out[1] = 0.0


def ball(functions) -> HybridFamily:
    flies, height, bounces, start = functions
    system = HybridSystem()
    system.mode("fly", flies).guard("floor", height, reset=bounces)
    return HybridFamily(system, (0, 5), [0.0, 0.0], start=start, max_step=0.3, max_switches=8)


def main() -> None:
    points = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    families = {
        "callables": ball([fly, floor, bounce, drop]),
        "compiled": ball([Compiled(one) for one in (c_fly, c_floor, c_bounce, c_drop)]),
    }
    options = {"options": TraceOptions(beyond=1e-3), "verify": VerifyOptions(points)}
    random = np.random.default_rng(2)
    for name, family in families.items():
        began = time.process_time()
        atlas = trace_family(family, *WINDOW, **options, threads=1)
        traced = time.process_time()
        family.labels(*(random.uniform(*side, points) for side in WINDOW), threads=1)
        ended = time.process_time()
        runs = atlas.statistics["free_runs"] + atlas.statistics["prescribed_runs"]
        print(
            f"{name:10} trace {traced - began:7.2f} s ({runs} runs of the trace), "
            f"{points} runs {ended - traced:6.2f} s, {atlas!r}, {atlas.objection}"
        )


main()
