"""Ctrl-C ends every long call, and long calls say how far they are."""

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import stickslip
import xarray  # noqa: F401  Imported here, it is not interrupted.
from results import BALL, WINDOW, family, family_of_functions, of, table

ORBITS = Path(__file__).parents[2] / "examples" / "orbits"
MANY = 60_000_000
OSCILLATOR = "state x = 1\nstate v = 0\nx' = v\nv' = -1e6*x\nend = {}"


def oscillator_regions() -> object:
    oscillator = stickslip.read(ORBITS / "oscillator.slip")
    orbit = oscillator.orbit(itinerary=["impact", "phase"])
    return oscillator.orbit_regions(orbit, ("w", "a"), (0.5, 1.5), (0.05, 1.2), cells=40)


def _around() -> stickslip.HybridFamily:
    """A boundary around the origin, with long runs."""
    text = f"parameter a = 1, b = 0\nstate r = 0\n{OSCILLATOR.format(9)}\nr' = a*a + b*b"
    return stickslip.HybridFamily.of(stickslip.system(f"{text}\nwhen r rises through 9"), "a", "b")


# Each takes minutes, so that a deaf one would not come back within the time of the tests.
LONG: dict[str, Callable[[], object]] = {
    "trace": lambda: stickslip.trace((0.5, 60), (0.1, 3), 0.3),
    "stack": lambda: stickslip.stack((1, 20), (0.1, 2.5), [0.05, 0.3, 0.35]),
    "gaining_lines": lambda: stickslip.gaining_lines((1, 20), (0.1, 2.5), 0.3),
    "table": lambda: stickslip.table((1, 40), (0.1, 3), 0.3, bound=1e-6),
    "timestep": lambda: stickslip.timestep(
        np.geomspace(10, 100, 100), 1.0, steps=[1000, 10_000], phases=100
    ),
    "collide_many": lambda: stickslip.collide_many(np.linspace(1e5, 1e6, 1_000_000), 1.0, 0.2),
    "map": lambda: stickslip.map((1, 60), (0.1, 3), (4000, 4000), 0.2),
    "solve": lambda: stickslip.system(OSCILLATOR.format(1e6)).solve(),
    "sensitivities": lambda: stickslip.system(
        "parameter k = 1e6\n" + OSCILLATOR.format(1e6).replace("1e6*x", "k*x")
    ).sensitivities("k"),
    "settle": lambda: stickslip.read(ORBITS / "oscillator.slip").orbit(settle=3e6),
    "diagram": lambda: stickslip.read(ORBITS / "ball.slip").diagram(
        "a", np.linspace(0.01, 0.03, 3000), "period", time=3000
    ),
    "basins": lambda: stickslip.read(ORBITS / "wells.slip").basins(
        ("x", "v"), np.linspace(-2, 2, 300), np.linspace(-2, 2, 300), settle=3000
    ),
    "regions": oscillator_regions,
    "history": lambda: stickslip.collide(63, 0.5).history(np.linspace(0, 3, MANY)),
    "eps_n": lambda: of("VelocityTable").eps_n(np.linspace(1, 2, MANY)),
    "locate": lambda: of("FamilyAtlas").locate(np.linspace(0.5, 2, MANY), 0.6),
    "labels": lambda: stickslip.HybridFamily.of(
        stickslip.system(f"parameter a = 1, b = 0\n{OSCILLATOR.format(3)}"), "a", "b"
    ).labels(np.linspace(1, 2, 3000), 1.0),
    "follow": lambda: _around().follow((-2.0, 2.0), (-2.0, 2.0), [(0.0, 0.0), (1.5, 1.5)]),
    "times": lambda: stickslip.system("state x = 1\nx' = -x\nend = 1").solve(
        t_eval=np.linspace(0, 1, MANY)
    ),
    "times of functions": lambda: stickslip.solve(
        lambda t, y: -y, (0, 1), [1.0], t_eval=np.linspace(0, 1, MANY), record=False
    ),
    "dense output": lambda: of("Solution").sol(np.linspace(0, 2.6, MANY)),
    "solve_many": lambda: stickslip.solve_many(
        stickslip.system(OSCILLATOR.format(1000)), initial={"x": np.linspace(1, 2, 1000)}
    ),
}


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_a_long_call(name: str) -> None:
    thread = threading.main_thread().ident
    assert thread is not None
    press = threading.Timer(0.3, signal.pthread_kill, [thread, signal.SIGINT])
    with pytest.raises(KeyboardInterrupt):
        press.start()
        LONG[name]()
        press.cancel()


@pytest.mark.parametrize("name", ["settle", "diagram", "basins", "regions", "sensitivities"])
def test_threads_end_behind_ctrl_c(name: str) -> None:
    # A process of its own has no threads of other calls.
    subprocess.run([sys.executable, __file__, name], check=True, timeout=100)


def ends_behind_ctrl_c(name: str) -> None:
    """Presses Ctrl-C in a call. Soon no thread of it computes any more, also on a busy machine."""
    test_ctrl_c_ends_a_long_call(name)
    latest, used = time.monotonic() + 8, np.inf
    while used > 0.1:
        assert time.monotonic() < latest, name
        before = time.process_time()
        time.sleep(0.5)
        used = time.process_time() - before


def interrupted(call: Callable[[], object], after: float = 0.5) -> Any:
    """What Ctrl-C leaves of a call, so many seconds after its start."""
    thread = threading.main_thread().ident
    assert thread is not None
    press = threading.Timer(after, signal.pthread_kill, [thread, signal.SIGINT])
    with pytest.raises(KeyboardInterrupt) as stopped:
        press.start()
        call()
        press.cancel()
    return stopped.value.partial  # type: ignore[attr-defined]


def test_ctrl_c_keeps_what_is_done() -> None:
    kappa = np.linspace(1e5, 1e6, 1_000_000)
    left = interrupted(lambda: stickslip.collide_many(kappa, 1.0, 0.2))
    assert 0 < left.size < kappa.size and np.array_equal(left.kappa, kappa[: left.size])
    assert left.eps_t[-1] == stickslip.eps_t(kappa[left.size - 1], 1.0, 0.2)
    found, counts = interrupted(lambda: stickslip.eps_t(kappa, 1.0, 0.2))
    assert found.shape == counts.shape and 0 < found.size < kappa.size
    solution = interrupted(lambda: stickslip.system(OSCILLATOR.format(1e6)).solve())
    assert 0 < solution.t[-1] < 1e6 and "by Ctrl-C" in solution.message
    # Recorded functions too.
    swing = lambda t, y: [y[1], -1e6 * y[0]]  # noqa: E731
    solution = interrupted(lambda: stickslip.solve(swing, (0, 1e6), [1, 0]))
    assert 0 < solution.t[-1] < 1e6 and "by Ctrl-C" in solution.message
    assert abs(solution.y[0, -1] - np.cos(1e3 * solution.t[-1])) < 1e-4
    steel = stickslip.Material(210e9, 0.3, 7850.0)
    pair = stickslip.Bodies(
        stickslip.Sphere(0.02, steel), stickslip.Wall(), stickslip.Surface(0.4, 1e12, 1e-7)
    )
    speeds = np.linspace(0.1, 1, 3_000_000)
    # A busy machine takes a second to read so many velocities.
    impacts = interrupted(lambda: stickslip.impact(pair, speeds, 0.5), 3.0)
    count = impacts.normal_m_per_s.size
    assert 0 < count < speeds.size and impacts.kinetic_after_j.shape == (count,)


def test_long_calls_report_their_progress() -> None:
    def reports(call: Callable[..., object]) -> list[tuple[int, int]]:
        found: list[tuple[int, int]] = []
        call(progress=lambda done, steps: found.append((done, steps)))
        return found

    kappa, bouncing = np.linspace(3, 9, 1000), table()
    orbit = bouncing.orbit(itinerary=["period", "bounce"])
    recorded = stickslip.solve(lambda t, y: -y, (0.0, 1.0), [1.0])
    calls: list[Callable[..., object]] = [
        lambda progress: stickslip.trace((5, 8), (0.8, 1.2), progress=progress),
        lambda progress: stickslip.table((1, 2), (0.5, 1.5), bound=1e-5, progress=progress),
        lambda progress: stickslip.timestep(3.0, 0.4, steps=[20, 100], progress=progress),
        lambda progress: stickslip.asymptote((10, 100), [1.0], progress=progress),
        lambda progress: stickslip.reproduce(0, cells=5, progress=progress),
        lambda progress: stickslip.eps_t(kappa, 1.0, progress=progress),
        lambda progress: stickslip.collide_many(kappa, 1.0, progress=progress),
        lambda progress: stickslip.map((1, 2), (1, 2), (9, 9), progress=progress),
        lambda progress: stickslip.impact(of("Bodies"), kappa, 0.5, progress=progress),
        lambda progress: family().labels(kappa / 6, 0.6, progress=progress),
        lambda progress: family().follow(
            *WINDOW, [(0.6, 0.55), (1.9, 0.75)], [lambda p, q: q - 0.65], progress=progress
        ),
        lambda progress: family_of_functions().follow(
            *WINDOW, [(0.6, 0.55), (1.9, 0.75)], progress=progress
        ),
        lambda progress: stickslip.system(BALL).sensitivities("restitution", progress=progress),
        lambda progress: recorded.sensitivities("y0", progress=progress),
        lambda progress: bouncing.orbit(settle=100.0, progress=progress),
        lambda progress: bouncing.branch(orbit, "a", (0.02, 0.021), progress=progress),
        lambda progress: bouncing.resumed(of("Branch"), (0.018, 0.035), progress=progress),
        lambda progress: bouncing.curve(
            of("SpecialOrbit"), ("r", "a"), (0.69, 0.7), (0.01, 0.06), progress=progress
        ),
        lambda progress: bouncing.orbit_regions(
            orbit, ("a", "r"), (0.01, 0.03), (0.65, 0.75), cells=1, progress=progress
        ),
        lambda progress: bouncing.section("bounce", time=9.0, progress=progress),
        lambda progress: bouncing.diagram(
            "a", [0.02, 0.021], "bounce", time=9.0, progress=progress
        ),
        lambda progress: bouncing.exponents(time=9.0, progress=progress),
        lambda progress: bouncing.basins(
            ("x", "v"), [0.015, 0.02], [0.5], settle=100.0, progress=progress
        ),
    ]
    for call in calls:
        told = reports(call)
        assert told == sorted(told) and 0 < told[-1][0] <= told[-1][1]


def test_an_exception_of_progress_ends_the_call() -> None:
    def stop(done: int, steps: int) -> None:
        raise RuntimeError(f"{done} of {steps} are enough")

    with pytest.raises(RuntimeError, match="are enough"):
        stickslip.trace((0.5, 60), (0.1, 3), 0.3, progress=stop)
    for one in (family(), family_of_functions()):
        with pytest.raises(RuntimeError, match="are enough"):
            one.follow(*WINDOW, [(0.6, 0.55), (1.9, 0.75)], progress=stop)


if __name__ == "__main__":
    ends_behind_ctrl_c(sys.argv[1])
