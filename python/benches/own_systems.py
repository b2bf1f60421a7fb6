"""Times and errors of systems of one's own: as callables, compiled, and by solve_ivp.

    python python/benches/own_systems.py

Two systems: a ball that bounces 15 times, and a mass on a belt with friction for 15 periods, 31
switches. All have rtol = 1e-10, atol = 1e-12 and the 8(5,3) pair. solve_ivp is restarted at every
event, as its users do. All times are from one run, alternating, the least of nine (three for
SciPy). An error is the largest one of the times of all events.
"""

import platform
import time
from collections.abc import Callable

import numba
import numpy as np
import scipy
from numba import cfunc, types
from scipy.integrate import solve_ivp

from stickslip import Compiled, HybridSystem, Solution, solve

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)
TOLERANCES = {"rtol": 1e-10, "atol": 1e-12}
BALL = ((0.0, 2.9999), [4.905, 0.0])
SLIP = 2 * np.pi - 2 * np.arctan(0.8)
BELT = ((0.0, 2.0 + 15 * (SLIP + 1.6) + 0.1), [0.0, 0.5])
#: When the ball bounces, and when the mass breaks away and stops.
BOUNCES = 3.0 - 2.0 * 0.5 ** np.arange(15)
SWITCHES = np.sort(
    np.concatenate([2 + (SLIP + 1.6) * np.arange(16), 2 + SLIP + (SLIP + 1.6) * np.arange(15)])
)


def fly(t, y):
    return [y[1], -9.81]


def floor(t, y):
    return y[0]


def stick(t, y):
    return [y[1], 0.0]


def slip(t, y):
    return [y[1], 0.6 - y[0]]


def grip(t, y):
    return 1.0 - y[0]


def relative(t, y):
    return 0.5 - y[1]


def with_belt(t, y):
    return [y[0], 0.5]


@cfunc(SIGNATURE)
def c_fly(t, y, out, p):
    out[0] = y[1]
    out[1] = -9.81


@cfunc(SIGNATURE)
def c_floor(t, y, out, p):
    out[0] = y[0]


@cfunc(SIGNATURE)
def c_bounce(t, y, out, p):
    out[0] = 0.0
    out[1] = -0.5 * y[1]


@cfunc(SIGNATURE)
def c_stick(t, y, out, p):
    out[0] = y[1]
    out[1] = 0.0


@cfunc(SIGNATURE)
def c_slip(t, y, out, p):
    out[0] = y[1]
    out[1] = 0.6 - y[0]


@cfunc(SIGNATURE)
def c_grip(t, y, out, p):
    out[0] = 1.0 - y[0]


@cfunc(SIGNATURE)
def c_relative(t, y, out, p):
    out[0] = 0.5 - y[1]


@cfunc(SIGNATURE)
def c_with_belt(t, y, out, p):
    out[0] = y[0]
    out[1] = 0.5


def ball(compiled: bool) -> HybridSystem:
    system = HybridSystem()
    if compiled:
        mode = system.mode("fly", Compiled(c_fly))
        mode.guard("floor", Compiled(c_floor), reset=Compiled(c_bounce), smooth=True)
    else:
        mode = system.mode("fly", fly)
        mode.guard("floor", floor, reset=lambda t, y: [0.0, -0.5 * y[1]], smooth=True)
    return system


def belt(compiled: bool) -> HybridSystem:
    system = HybridSystem()
    wrap: Callable = Compiled if compiled else lambda function: function
    sticks = system.mode("stick", wrap(c_stick if compiled else stick))
    slips = system.mode("slip", wrap(c_slip if compiled else slip))
    reset = wrap(c_with_belt if compiled else with_belt)
    grips, relatives = (c_grip, c_relative) if compiled else (grip, relative)
    sticks.guard("breaks away", wrap(grips), to=slips, reset=reset, smooth=True)
    slips.guard("stops", wrap(relatives), to=sticks, reset=reset, smooth=True)
    return system


def ball_by_scipy() -> np.ndarray:
    def hit(t, y):
        return y[0]

    hit.terminal, hit.direction = True, -1
    (t, end), y = BALL
    times = []
    while t < end:
        found = solve_ivp(fly, (t, end), y, "DOP853", events=hit, **TOLERANCES)
        t = found.t[-1]
        if found.status == 1:
            times.append(t)
            y = [0.0, -0.5 * found.y[1, -1]]
    return np.array(times)


def belt_by_scipy() -> np.ndarray:
    def breaks(t, y):
        return 1.0 - y[0]

    def stops(t, y):
        return 0.5 - y[1]

    for event in (breaks, stops):
        event.terminal, event.direction = True, -1
    (t, end), y = BELT
    sticks, times = True, []
    while t < end:
        field, event = (stick, breaks) if sticks else (slip, stops)
        found = solve_ivp(field, (t, end), y, "DOP853", events=event, **TOLERANCES)
        t = found.t[-1]
        if found.status == 1:
            times.append(t)
            y = [found.y[0, -1], 0.5]
            sticks = not sticks
    return np.array(times)


def ours(system: HybridSystem, problem: tuple, mode: str, **options) -> Callable[[], Solution]:
    return lambda: solve(system, *problem, mode, **TOLERANCES, **options)


def seconds(work: Callable[[], object], times: int) -> float:
    found = []
    for _ in range(times):
        begun = time.perf_counter()
        work()
        found.append(time.perf_counter() - begun)
    return min(found)


def main() -> None:
    versions = f"NumPy {np.__version__}, SciPy {scipy.__version__}, Numba {numba.__version__}"
    print(f"Python {platform.python_version()}, {versions}")
    row = "{:32} {:>10} {:>8} {:>10} {:>8}"
    print(row.format("", "time", "events", "error", "calls"))
    for name, make, problem, mode, expected, by_scipy in (
        ("ball", ball, BALL, "fly", BOUNCES, ball_by_scipy),
        ("belt", belt, BELT, "stick", SWITCHES, belt_by_scipy),
    ):
        runs = {
            f"{name}, callables": ours(make(False), problem, mode),
            f"{name}, callables, events only": ours(make(False), problem, mode, t_eval=[]),
            f"{name}, compiled": ours(make(True), problem, mode),
            f"{name}, compiled, events only": ours(make(True), problem, mode, t_eval=[]),
        }
        best = dict.fromkeys([*runs, "scipy"], np.inf)
        for turn in range(9):
            for label, work in runs.items():
                best[label] = min(best[label], seconds(work, 1))
            if turn < 3:
                best["scipy"] = min(best["scipy"], seconds(by_scipy, 1))
        for label, work in runs.items():
            found = work()
            times = found.events["time"]
            error = np.abs(times - expected).max() if times.size == expected.size else np.nan
            least = f"{best[label] * 1e6:.0f} us"
            print(row.format(label, least, times.size, f"{error:.0e}", found.nfev))
        times = by_scipy()
        error = np.abs(times - expected).max() if times.size == expected.size else np.nan
        label = f"{name}, solve_ivp restarted"
        print(row.format(label, f"{best['scipy'] * 1e6:.0f} us", times.size, f"{error:.0e}", ""))


if __name__ == "__main__":
    main()
