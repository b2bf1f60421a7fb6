"""How soon every long call ends on Ctrl-C: `python python/benches/interruptions.py [NAME ...]`.

Each call runs in a process of its own and is interrupted there after 0.4 s, and if it takes so long
after 2.5 s. The table has the longest time from the signal to KeyboardInterrupt, and what the
exception keeps. A call that is over after 0.4 s is too short to be measured, and that is an error,
as is a delay of more than 0.3 s. A machine with other work on it delays everything. Look-ups of ten
million points in a table are over too soon.
"""

import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import dask.array  # noqa: F401  Imported here, they are not interrupted.
import numpy as np
import stickslip
import xarray  # noqa: F401
import zarr  # noqa: F401
from stickslip import Bodies, Compiled, HybridFamily, HybridSystem, Material, Sphere, Surface

ROOT = Path(__file__).resolve().parents[2]
#: Seconds after which a call is interrupted.
PRESSED = (0.4, 2.5)
LONGEST = 0.3
LAW = "gran/hooke/history"
MANY = 10_000_000

Call = Callable[[], object]


def oscillator(end: float) -> stickslip.FormulaSystem:
    text = "parameter k = 1e6, a = 1\nstate x = a, v = 0\nx' = v\nv' = -k*x\n"
    return stickslip.system(f"{text}when x < -0.9*a \"low\"\nend = {end}")


def shaken() -> stickslip.FormulaSystem:
    return stickslip.system(
        "parameter a = 0.02, r = 0.7\nstate x = 0.015, v = 0.5, phase = 0.8\n"
        "table = a*sin(phase)\nx' = v\nv' = -1\nphase' = 2*pi\n"
        'when x < table "bounce"\n  x := table\n  v := (1 + r)*table\' - r*v\n'
        'when phase > 2*pi "period"\n  phase := phase - 2*pi'
    )


def read(name: str) -> stickslip.FormulaSystem:
    return stickslip.read(ROOT / "examples" / "orbits" / f"{name}.slip")


def pair() -> Bodies:
    steel = Material(210e9, 0.3, 7850.0)
    return Bodies(Sphere(0.02, steel), Sphere(0.02, steel), Surface(0.4, 1e9, 1e-7))


def swing(t: float, y: Any) -> Any:
    return [y[1], -1e6 * y[0]]


def low(t: float, y: Any) -> Any:
    return y[0] + 0.5


def family(end: float) -> HybridFamily:
    return HybridFamily.of(oscillator(1.0), "k", "a", end=end)


def family_of_functions(end: float) -> HybridFamily:
    """Symbols are no numbers for its functions: they are not recorded."""
    system = HybridSystem()
    mode = system.mode("swings", lambda t, y, p, q: [y[1], -p * float(y[0])])
    mode.guard("low", lambda t, y, p, q: float(y[0]) + 0.5 * q, direction="falling")
    return HybridFamily(system, (0, end), [1.0, 0.0])


def few_curves() -> stickslip.FamilyAtlas:
    return stickslip.trace_family(family(0.01), (1e5, 2e5), (0.5, 2), effort="screen")


def compiled() -> HybridSystem:
    from numba import cfunc, types

    array = types.CPointer(types.float64)
    signature = types.void(types.float64, array, array, array)

    @cfunc(signature)
    def right_hand_side(t, y, out, p):  # type: ignore[no-untyped-def]
        out[0], out[1] = y[1], -1e6 * y[0]

    @cfunc(signature)
    def guard(t, y, out, p):  # type: ignore[no-untyped-def]
        out[0] = y[0] + 0.5

    system = HybridSystem()
    system.mode("swings", Compiled(right_hand_side)).guard("low", Compiled(guard), direction="falling")
    return system


def impacts() -> dict[str, Any]:
    """Measured ones, many of them."""
    angle = np.linspace(1, 85, 4000)
    found = stickslip.impact(pair(), speed_m_per_s=2.0, angle_rad=np.radians(angle))
    e_t = found.centre_e_t + np.random.default_rng(1).normal(0, 0.01, angle.size)
    return {"centre_impact_angle_deg": angle, "centre_e_t": e_t}


def special(branch: stickslip.Branch, kind: str) -> stickslip.SpecialOrbit:
    return next(it for it in branch.specials if it.kind == kind)


def with_orbit(call: Callable[[stickslip.FormulaSystem, stickslip.Orbit], object]) -> Call:
    system = shaken()
    orbit = system.orbit(itinerary=["period", "bounce"])
    return lambda: call(system, orbit)


def with_branch(call: Callable[[stickslip.FormulaSystem, stickslip.Branch], object]) -> Call:
    system = shaken()
    branch = system.branch(system.orbit(itinerary=["period", "bounce"]), "a", (0.015, 0.05))
    return lambda: call(system, branch)


def again(call: Callable[[], object]) -> Call:
    """What is short is called again and again."""

    def calls() -> None:
        while True:
            call()

    return calls


def with_file(made: Any, load: Callable[[str], object]) -> Call:
    folder = tempfile.mkdtemp()
    path = str(Path(folder) / "file")
    made.save(path)
    return again(lambda: load(path))


def into(call: Callable[[Path], object]) -> Call:
    folder = tempfile.mkdtemp()
    return lambda: call(Path(folder) / "made")


def kappa(count: int = MANY) -> Any:
    return np.linspace(1.2, 7.8, count)


def atlas() -> stickslip.Atlas:
    return stickslip.trace((1, 8), (0.1, 2))


def solution() -> stickslip.Solution:
    return oscillator(20.0).solve(dense_output=True)


#: Prepares each call, and returns it.
CALLS: dict[str, Callable[[], Call]] = {
    # Collisions.
    "collide": lambda: again(lambda: stickslip.collide(1e6, 0.1, 1e4, method="dop853")),
    "Collision.history": lambda: (
        lambda it=stickslip.collide(63, 0.5), at=np.linspace(0, 3, MANY): it.history(at)
    ),
    "Collision.animate": lambda: into(
        lambda path: stickslip.collide(63, 0.5).animate(path.with_suffix(".gif"))
    ),
    "eps_t": lambda: lambda: stickslip.eps_t(np.linspace(1e5, 1e6, 1_000_000), 1.0, 0.2),
    "eps_t, exact": lambda: lambda at=kappa(): stickslip.eps_t(at, 1.0),
    "eps_t_and_switch_count": lambda: (
        lambda: stickslip.eps_t_and_switch_count(np.linspace(1e5, 1e6, 1_000_000), 1.0, 0.2)
    ),
    "collide_many": lambda: (
        lambda: stickslip.collide_many(np.linspace(1e5, 1e6, 1_000_000), 1.0, 0.2)
    ),
    "collide_many, exact": lambda: lambda at=kappa(): stickslip.collide_many(at, 1.0),
    "collide_many, large damping": lambda: (
        lambda: stickslip.collide_many(np.linspace(1e5, 1e6, 10_000_000), 1.0, 1e4)
    ),
    "impact": lambda: lambda: stickslip.impact(pair(), np.linspace(0.1, 1, 3_000_000), 0.5),
    "Bodies.encounter": lambda: again(lambda: pair().contacts(1.0, 0.5)),
    "map": lambda: lambda: stickslip.map((1, 60), (0.1, 3), (4000, 4000), 0.2),
    "sweep": lambda: lambda: stickslip.sweep(
        np.linspace(1, 60, 3000), np.linspace(0.1, 3, 3000), 0.2, chunks="auto"
    ).compute(),
    "write_sweep": lambda: into(
        lambda path: stickslip.write_sweep(
            path, np.linspace(1, 60, 3000), np.linspace(0.1, 3, 3000), 0.2
        )
    ),
    # Atlases.
    "trace": lambda: lambda: stickslip.trace((0.5, 500), (0.05, 3), 0.1),
    "trace, undamped": lambda: lambda: stickslip.trace((0.5, 1000), (0.01, 3)),
    "trace, other law": lambda: lambda: stickslip.trace((0.5, 60), (0.1, 3), 0.3, law=LAW),
    "Atlas.locate": lambda: lambda it=atlas(), at=kappa(): it.locate(at, 1.0),
    "Atlas.load": lambda: with_file(atlas(), stickslip.Atlas.load),
    "gaining_lines": lambda: lambda: stickslip.gaining_lines((1, 20), (0.1, 2.5), 0.3),
    "stack": lambda: lambda: stickslip.stack((1, 20), (0.1, 2.5), [0.05, 0.3, 0.35]),
    # For users of particle codes.
    "timestep": lambda: lambda: stickslip.timestep(
        np.geomspace(10, 100, 1000), 1.0, steps=[1000, 10_000], phases=100
    ),
    "fit": lambda: lambda data=impacts(): stickslip.fit(data, pair(), speed_m_per_s=2.0),
    "fit, another law": lambda: lambda data=impacts(): stickslip.fit(
        data, free=["kappa", "mu"], law=LAW, tangential_damping=0.5, damping=0.3
    ),
    "table": lambda: lambda: stickslip.table((1, 40), (0.1, 3), 0.3, bound=1e-6),
    "table, other law": lambda: lambda: stickslip.table(
        (1, 40), (0.1, 3), 0.3, law=LAW, bound=1e-8
    ),
    "table_of_velocities": lambda: lambda: stickslip.table_of_velocities(
        pair(), (0.1, 5), (0.1, 5), bound=1e-9
    ),
    "load_table": lambda: with_file(
        stickslip.table((1, 8), (0.5, 1.5), bound=1e-8), stickslip.load_table
    ),
    # Studies.
    "asymptote": lambda: again(lambda: stickslip.asymptote((10, 1e10), [0.3, 1.0, 1.7, 1.9])),
    "converge": lambda: lambda: stickslip.converge(damping=0.2),
    "contact_laws": lambda: lambda: stickslip.contact_laws(cells=1000),
    "reproduce, a part": lambda: lambda: stickslip.reproduce(1, cells=5000),
    "reproduce": lambda: into(stickslip.reproduce),
    # Systems of one's own.
    "solve": lambda: lambda: stickslip.solve(swing, (0, 1e6), [1, 0], events=low, record=True),
    "solve, functions of Python": lambda: (
        lambda: stickslip.solve(swing, (0, 1e6), [1, 0], events=low, record=False)
    ),
    "solve, compiled": lambda: (
        lambda it=compiled(): stickslip.solve(it, (0, 1e6), [1, 0], t_eval=[])
    ),
    "solve, many times": lambda: lambda at=np.linspace(0, 1, MANY): stickslip.solve(
        lambda t, y: -y, (0, 1), [1.0], t_eval=at, record=False
    ),
    "solve_many": lambda: lambda: stickslip.solve_many(
        oscillator(100.0), initial={"x": np.linspace(1, 2, 1000)}
    ),
    "solve_many, long runs": lambda: lambda: stickslip.solve_many(
        oscillator(1e6), initial={"x": np.linspace(1, 2, 10)}
    ),
    "solve_many, lazy": lambda: lambda: stickslip.solve_many(
        oscillator(10.0), initial={"x": np.linspace(1, 2, 3000)}, chunks=10
    ).compute(),
    "FormulaSystem.solve": lambda: lambda: oscillator(1e6).solve(),
    "FormulaSystem.solve, many times": lambda: (
        lambda at=np.linspace(0, 1, MANY): oscillator(1.0).solve(t_eval=at)
    ),
    "DenseOutput": lambda: lambda it=solution().sol, at=np.linspace(0, 19, MANY): it(at),
    "DenseOutput.mode": lambda: lambda it=solution().sol, at=np.linspace(0, 19, MANY): it.mode(at),
    "sensitivities": lambda: lambda: oscillator(1e6).sensitivities("k"),
    "Solution.sensitivities": lambda: (
        lambda it=oscillator(300.0).solve(t_eval=[]): it.sensitivities("k", "a")
    ),
    "FormulaSystem.converge": lambda: lambda: oscillator(300.0).converge(),
    # Orbits.
    "orbit": lambda: lambda: read("oscillator").orbit(settle=3e6),
    "branch": lambda: with_orbit(
        lambda system, orbit: system.branch(
            orbit, "a", (1e-3, 0.5), longest_step=1e-5, most_points=1_000_000
        )
    ),
    "resumed": lambda: with_branch(
        lambda system, it: system.resumed(
            it, (1e-3, 1e3), longest_step=1e-5, most_points=1_000_000
        )
    ),
    "read_branch": lambda: with_branch(
        lambda system, it: with_file(it, system.read_branch)()
    ),
    "switched": lambda: with_branch(
        lambda system, it: again(lambda: system.switched(it, special(it, "flip")))()
    ),
    "curve": lambda: with_branch(
        lambda system, it: system.curve(
            special(it, "flip"), ("r", "a"), (1e-3, 1), (1e-3, 1), longest_step=1e-5
        )
    ),
    "orbit_regions": lambda: with_orbit(
        lambda system, orbit: system.orbit_regions(
            orbit, ("a", "r"), (0.01, 0.1), (0.3, 0.9), cells=40
        )
    ),
    "section": lambda: lambda: read("ball").section("bounce", time=1e7),
    "diagram": lambda: lambda: read("ball").diagram(
        "a", np.linspace(0.01, 0.03, 3000), "period", time=3000
    ),
    "exponents": lambda: lambda: read("wells").exponents(time=1e7),
    "basins": lambda: lambda: read("wells").basins(
        ("x", "v"), np.linspace(-2, 2, 300), np.linspace(-2, 2, 300), settle=3000
    ),
    # Families.
    "trace_family": lambda: (
        lambda: stickslip.trace_family(family(0.03), (1e5, 1e6), (0.5, 2))
    ),
    "trace_family, long runs": lambda: (
        lambda: stickslip.trace_family(family(20.0), (1e6, 2e6), (0.5, 2))
    ),
    "trace_family, functions of Python": lambda: (
        lambda: stickslip.trace_family(family_of_functions(0.03), (1e5, 1e6), (0.5, 2))
    ),
    "FamilyAtlas.resume": lambda: (
        lambda it=family(0.03): stickslip.trace_family(
            it, (1e5, 1e6), (0.5, 2), cancelled=lambda: True
        ).resume(it)
    ),
    "stack_family": lambda: (
        lambda: stickslip.stack_family(family, (1e5, 1e6), (0.5, 2), [0.02, 0.03])
    ),
    "HybridFamily.labels": lambda: (
        lambda: family(1.0).labels(np.linspace(1e5, 1e6, 100_000), 1.0)
    ),
    "HybridFamily.labels, long runs": lambda: (
        lambda: family(100.0).labels(np.linspace(1e5, 1e6, 100_000), 1.0)
    ),
    "HybridFamily.labels, functions of Python": lambda: (
        lambda: family_of_functions(1.0).labels(np.linspace(1e5, 1e6, 1000), 1.0)
    ),
    "HybridFamily.margins": lambda: lambda: family(1000.0).margins(1e6, 1.0),
    "HybridFamily.follow": lambda: lambda: family(100.0).follow(
        (1e4, 1e6), (0.5, 2), [(1e4, 1.0), (1e6, 1.0)]
    ),
    "FamilyAtlas.locate": lambda: (
        lambda it=few_curves(), at=np.linspace(1e5, 2e5, MANY): it.locate(at, 1.0)
    ),
}


def child(name: str, after: float) -> None:
    """Prints the delay of a call that is interrupted after so many seconds, and what is kept."""
    # In the background of a shell the signal may be ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    call = CALLS[name]()
    main = threading.main_thread().ident
    assert main is not None
    pressed: list[float] = []

    def press() -> None:
        pressed.append(time.monotonic())
        signal.pthread_kill(main, signal.SIGINT)

    timer = threading.Timer(after, press)
    timer.daemon = True
    begun = time.monotonic()
    try:
        timer.start()
        call()
    except KeyboardInterrupt as stopped:
        delay = time.monotonic() - pressed[0]
        kept = "partial" if hasattr(stopped, "partial") else type(stopped).__name__
        print(delay, "nothing" if kept == "KeyboardInterrupt" else kept)
    else:
        print("over", time.monotonic() - begun)
    sys.stdout.flush()


def measured(name: str) -> tuple[str, bool]:
    """The row of a call, and whether it is as it should be."""
    delays: list[float] = []
    kept = "nothing"
    for after in PRESSED:
        command = [sys.executable, __file__, "--child", name, str(after)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
            assert running.stdout is not None
            words = running.stdout.readline().split()
            # Threads of the call may compute on; nobody waits for them here.
            running.kill()
        if not words:
            return f"| {name} | failed | |", False
        if words[0] == "over" and delays:
            break
        if words[0] == "over":
            return f"| {name} | over after {float(words[1]):.2f} s | |", False
        delays.append(float(words[0]))
        kept = words[1]
    return f"| {name} | {1e3 * max(delays):.0f} ms | {kept} |", max(delays) <= LONGEST


def main(names: list[str]) -> None:
    print("| call | delay | keeps |\n|---|---|---|")
    wrong = []
    for name in names or CALLS:
        row, right = measured(name)
        print(row if right else f"{row} <--", flush=True)
        if not right:
            wrong.append(name)
    if wrong:
        sys.exit(f"deaf, too short or failed: {', '.join(wrong)}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        child(sys.argv[2], float(sys.argv[3]))
    else:
        main(sys.argv[1:])
