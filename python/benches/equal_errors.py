"""Times at equal errors: texts, callables and Numba's functions here, and heyoka beside them.

    python python/benches/equal_errors.py

Every way is run with tolerances from 1e-3 to 1e-14, and the table has the least of 15 times with
which the error is at most 1e-6 and 1e-9, in µs, for a run that is prepared: texts are read,
functions compiled, heyoka's integrators made. Callables are recorded anew with each run. An error
is that of the state at the end, relative to its largest component, against heyoka at 1e-18, or of
the times of events. heyoka needs `pip install heyoka`; its events act in callbacks of Python.
"""

import time
from collections.abc import Callable
from typing import Any

import heyoka
import numba
import numpy as np

import stickslip
from stickslip import Compiled, solve

SIGNATURE = numba.types.void(
    numba.types.float64, *[numba.types.CPointer(numba.types.float64)] * 3
)
LADDER = 10.0 ** -np.arange(3.0, 14.5, 0.5)
MU, PERIOD = 0.012277471, 17.0652165601579625588917206249

KEPLER = """
state x = 0.4, y = 0, u = 0, w = 2
r3 = (x^2 + y^2)^1.5
x' = u
y' = w
u' = -x/r3
w' = -y/r3
end = 62.83185307179586
"""
ARENSTORF = f"""
parameter m = {MU}
state x = 0.994, y = 0, u = 0, w = -2.00158510637908252240537862224
p = ((x + m)^2 + y^2)^1.5
q = ((x - 1 + m)^2 + y^2)^1.5
x' = u
y' = w
u' = x + 2*w - (1 - m)*(x + m)/p - m*(x - 1 + m)/q
w' = y - 2*u - (1 - m)*y/p - m*y/q
end = {PERIOD!r}
"""
IMPACT = """
state x = 0, v = 0
x' = v
v' = 2*cos(2.7*t) - x - 0.1*v
when x > 0.3
  v := -0.8*v
end = 30
"""
TABLE = """
state x = 0.3, v = 0
x' = v
v' = -9.81
when x < 0.01*sin(60*t)
  v := 1.5*0.6*cos(60*t) - 0.5*v
end = 0.5
"""
BELT = """
state x = 0, v = 0.5
x' = v
mode stick
  v' = 0
  when x > 1 -> slip
mode slip
  v' = 0.6 - x
  when v > 0.5 -> stick
    v := 0.5
start in stick
end = 30
"""


def chain_text(n: int) -> str:
    """n masses with springs between them and to both walls; the last one meets a stop."""
    lines = ["state " + ", ".join(f"x{i} = {0.3 * (i == 0)}, v{i} = 0" for i in range(n))]
    for i in range(n):
        left, right = (f"x{i - 1}" if i else "0"), (f"x{i + 1}" if i + 1 < n else "0")
        lines += [f"x{i}' = v{i}", f"v{i}' = {left} - 2*x{i} + {right}"]
    lines += [f"when x{n - 1} > 0.1", f"  v{n - 1} := -0.7*v{n - 1}", "end = 40"]
    return "\n".join(lines)


TEXTS = {
    "Arenstorf": ARENSTORF,
    "Kepler": KEPLER,
    "table": TABLE,
    "belt": BELT,
    "impact": IMPACT,
    "chain": chain_text(6),
}


def here(text: str) -> Callable[[float], Any]:
    """A run of a text here."""
    system = stickslip.system(text)
    end = float(text.rpartition("end = ")[2])

    def run(tolerance: float) -> stickslip.Solution:
        return system.solve(rtol=tolerance, atol=tolerance, t_eval=[end])

    return run


# --- heyoka ---------------------------------------------------------------------------------------


def peer(case: str) -> Callable[[float], tuple[np.ndarray, np.ndarray]]:
    """A run of the same system by heyoka."""
    made: dict[float, Any] = {}

    def run(tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        if tolerance not in made:
            made[tolerance] = PEERS[case](tolerance)
        integrator, start, end, times = made[tolerance]
        times.clear()
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.pars[:] = 0.0
        if integrator.with_events:
            integrator.reset_cooldowns()
        while integrator.propagate_until(end)[0] != heyoka.taylor_outcome.time_limit:
            pass
        return integrator.state.copy(), np.array(times)

    return run


def adaptive(equations: Any, start: list[float], end: float, events: Any, tolerance: float) -> Any:
    times: list[float] = []

    def event(guard: Any, direction: Any, act: Callable[[Any], None]) -> Any:
        def callback(integrator: Any, sign: int) -> bool:
            times.append(integrator.time)
            act(integrator)
            return True

        return heyoka.t_event(guard, direction=direction, callback=callback)

    made = heyoka.taylor_adaptive(
        equations, start, t_events=[event(*one) for one in events], tol=tolerance
    )
    return made, np.array(start), end, times


RISING, FALLING = heyoka.event_direction.positive, heyoka.event_direction.negative


def sets(place: int, factor: float) -> Callable[[Any], None]:
    def act(integrator: Any) -> None:
        integrator.state[place] *= factor

    return act


def kepler(tolerance: float) -> Any:
    x, y, u, w = heyoka.make_vars("x", "y", "u", "w")
    r3 = (x**2 + y**2) ** 1.5
    equations = [(x, u), (y, w), (u, -x / r3), (w, -y / r3)]
    return adaptive(equations, [0.4, 0.0, 0.0, 2.0], 62.83185307179586, [], tolerance)


def arenstorf(tolerance: float) -> Any:
    x, y, u, w = heyoka.make_vars("x", "y", "u", "w")
    p = ((x + MU) ** 2 + y**2) ** 1.5
    q = ((x - 1 + MU) ** 2 + y**2) ** 1.5
    equations = [
        (x, u),
        (y, w),
        (u, x + 2.0 * w - (1 - MU) * (x + MU) / p - MU * (x - 1 + MU) / q),
        (w, y - 2.0 * u - (1 - MU) * y / p - MU * y / q),
    ]
    start = [0.994, 0.0, 0.0, -2.00158510637908252240537862224]
    return adaptive(equations, start, PERIOD, [], tolerance)


def impact(tolerance: float) -> Any:
    x, v = heyoka.make_vars("x", "v")
    equations = [(x, v), (v, 2.0 * heyoka.cos(2.7 * heyoka.time) - x - 0.1 * v)]
    events = [(x - 0.3, RISING, sets(1, -0.8))]
    return adaptive(equations, [0.0, 0.0], 30.0, events, tolerance)


def table(tolerance: float) -> Any:
    x, v = heyoka.make_vars("x", "v")

    def bounce(integrator: Any) -> None:
        speed = 0.6 * np.cos(60.0 * integrator.time)
        integrator.state[1] = 1.5 * speed - 0.5 * integrator.state[1]

    events = [(x - 0.01 * heyoka.sin(60.0 * heyoka.time), FALLING, bounce)]
    equations = [(x, v), (v, heyoka.expression(-9.81))]
    return adaptive(equations, [0.3, 0.0], 0.5, events, tolerance)


def belt(tolerance: float) -> Any:
    x, v = heyoka.make_vars("x", "v")

    def slip(integrator: Any) -> None:
        integrator.pars[0] = 1.0

    def stick(integrator: Any) -> None:
        integrator.pars[0] = 0.0
        integrator.state[1] = 0.5

    equations = [(x, v), (v, heyoka.par[0] * (0.6 - x))]
    events = [(x - 1.0, RISING, slip), (v - 0.5, RISING, stick)]
    return adaptive(equations, [0.0, 0.5], 30.0, events, tolerance)


def chain(tolerance: float, n: int = 6) -> Any:
    names = heyoka.make_vars(*(f"{name}{i}" for i in range(n) for name in "xv"))
    x, v = names[::2], names[1::2]
    equations = []
    for i in range(n):
        left = x[i - 1] if i else 0.0
        right = x[i + 1] if i + 1 < n else 0.0
        equations += [(x[i], v[i]), (v[i], left - 2.0 * x[i] + right)]
    start = [0.3] + [0.0] * (2 * n - 1)
    events = [(x[-1] - 0.1, RISING, sets(2 * n - 1, -0.7))]
    return adaptive(equations, start, 40.0, events, tolerance)


PEERS = {
    "Arenstorf": arenstorf,
    "Kepler": kepler,
    "table": table,
    "belt": belt,
    "impact": impact,
    "chain": chain,
}

# --- callables and Numba --------------------------------------------------------------------------


def kepler_here(t, y):
    r3 = (y[0] ** 2 + y[1] ** 2) ** 1.5
    return [y[2], y[3], -y[0] / r3, -y[1] / r3]


def arenstorf_here(t, y):
    p = ((y[0] + MU) ** 2 + y[1] ** 2) ** 1.5
    q = ((y[0] - 1 + MU) ** 2 + y[1] ** 2) ** 1.5
    return [
        y[2],
        y[3],
        y[0] + 2 * y[3] - (1 - MU) * (y[0] + MU) / p - MU * (y[0] - 1 + MU) / q,
        y[1] - 2 * y[2] - (1 - MU) * y[1] / p - MU * y[1] / q,
    ]


@numba.cfunc(SIGNATURE)
def kepler_compiled(t, y, out, _):
    r3 = (y[0] ** 2 + y[1] ** 2) ** 1.5
    out[0], out[1], out[2], out[3] = y[2], y[3], -y[0] / r3, -y[1] / r3


@numba.cfunc(SIGNATURE)
def arenstorf_compiled(t, y, out, _):
    p = ((y[0] + MU) ** 2 + y[1] ** 2) ** 1.5
    q = ((y[0] - 1 + MU) ** 2 + y[1] ** 2) ** 1.5
    out[0], out[1] = y[2], y[3]
    out[2] = y[0] + 2 * y[3] - (1 - MU) * (y[0] + MU) / p - MU * (y[0] - 1 + MU) / q
    out[3] = y[1] - 2 * y[2] - (1 - MU) * y[1] / p - MU * y[1] / q


def of_functions(function: Any, start: list[float], end: float) -> Callable[[float], Any]:
    def run(tolerance: float) -> Any:
        return solve(function, (0.0, end), start, rtol=tolerance, atol=tolerance, t_eval=[end])

    return run


START = [0.994, 0.0, 0.0, -2.00158510637908252240537862224]
FUNCTIONS = {
    "Arenstorf": (arenstorf_here, arenstorf_compiled, START, PERIOD),
    "Kepler": (kepler_here, kepler_compiled, [0.4, 0.0, 0.0, 2.0], 62.83185307179586),
}


# --- the table ------------------------------------------------------------------------------------


def error_of(found: Any, exact: tuple[np.ndarray, np.ndarray]) -> float:
    """The largest error of a run: of the state at the end, and of the times of events."""
    if not isinstance(found, tuple):
        found = (found.y[:, -1], found.events["time"])
    (state, times), (y, events) = found, exact
    if times.size != events.size:
        return np.inf
    errors = [np.abs(state - y).max() / np.abs(y).max(), *np.abs(times - events)]
    return float(max(errors))


def least(runs: dict[str, Callable[[], Any]]) -> dict[str, float]:
    """The least time of each run, in µs, of 15 that alternate."""
    found = dict.fromkeys(runs, np.inf)
    for _ in range(15):
        for name, run in runs.items():
            begun = time.perf_counter()
            run()
            found[name] = min(found[name], 1e6 * (time.perf_counter() - begun))
    return found


def main() -> None:
    columns = ("text", "callable", "Numba", "heyoka")
    print(f"{'':10} {'error':>6}  {' '.join(f'{name:>8}' for name in columns)}  text/heyoka")
    for case, text in TEXTS.items():
        ways: dict[str, Callable[[float], Any]] = {"text": here(text), "heyoka": peer(case)}
        if case in FUNCTIONS:
            function, compiled, start, end = FUNCTIONS[case]
            ways["callable"] = of_functions(function, start, end)
            ways["Numba"] = of_functions(Compiled(compiled), start, end)
        exact = ways["heyoka"](1e-18)
        errors = {
            name: [error_of(run(tolerance), exact) for tolerance in LADDER]
            for name, run in ways.items()
        }
        for wanted in (1e-6, 1e-9):
            # The loosest tolerance from which on no error is larger.
            runs = {}
            for name, run in ways.items():
                worst = np.maximum.accumulate(errors[name][::-1])[::-1]
                below = (worst <= wanted).tolist()
                if any(below):
                    tolerance = LADDER[below.index(True)]
                    runs[name] = lambda run=run, tolerance=tolerance: run(tolerance)
            times = least(runs)
            took = [times.get(name, np.nan) for name in columns]
            row = " ".join(f"{one:8.0f}" for one in took)
            print(f"{case:10} {wanted:6.0e}  {row}  {took[0] / took[3]:6.2f}")


if __name__ == "__main__":
    main()
