"""Times and errors of systems with many guards: beside solve_ivp and, if it is installed, heyoka.

    python python/benches/many_events.py

200 balls that bounce on one floor, and 50 thermostats that switch their heaters. All have rtol =
1e-10, atol = 1e-12, and the 8(5,3) pair where there is one. solve_ivp is restarted at every event,
as its users do; heyoka goes on by itself, by callbacks. "compiled" are functions of Numba. An error is the largest one of the times of
all events. All times are from one run.
"""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import cfunc, types
from scipy.integrate import solve_ivp

from stickslip import Compiled, Guard, HybridSystem, solve

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)
TOLERANCES = {"rtol": 1e-10, "atol": 1e-12}
BALLS, FALL = 200, 2.0
HEIGHTS = 1.0 + np.arange(BALLS) / BALLS
THERMOSTATS, SPAN = 50, 10.0
RATES = 1.0 + np.arange(THERMOSTATS) / THERMOSTATS


def bounces() -> np.ndarray:
    """When the balls bounce: each keeps 0.8 of its velocity."""
    first = np.sqrt(2.0 * HEIGHTS / 9.81)
    flights = 2.0 * first[:, None] * 0.8 ** np.arange(1, 30)
    times = first[:, None] + np.cumsum(np.hstack([np.zeros((BALLS, 1)), flights]), axis=1)
    return np.sort(times[times < FALL])


def switches() -> np.ndarray:
    """When the thermostats switch: at 2 above, where they tend to 3, and at 1 below, to 0."""
    times = (np.log(3.0) + np.log(2.0) * np.arange(60)) / RATES[:, None]
    return np.sort(times[times < SPAN])


def balls_here() -> np.ndarray:
    def field(t, y):
        slope = np.full(2 * BALLS, -9.81)
        slope[::2] = y[1::2]
        return slope

    def bounce(ball):
        def reset(t, y):
            y[2 * ball], y[2 * ball + 1] = 0.0, -0.8 * y[2 * ball + 1]
            return y

        return Guard(f"floor {ball}", reset=reset)

    system = HybridSystem()
    fly = system.mode("fly", field)
    fly.guards(lambda t, y: y[::2], *(bounce(ball) for ball in range(BALLS)))
    start = np.zeros(2 * BALLS)
    start[::2] = HEIGHTS
    return solve(system, (0.0, FALL), start, t_eval=[], **TOLERANCES).events["time"]


@cfunc(SIGNATURE)
def fly_compiled(t, y, out, parameters):
    for ball in range(BALLS):
        out[2 * ball], out[2 * ball + 1] = y[2 * ball + 1], -9.81


@cfunc(SIGNATURE)
def heights_compiled(t, y, out, parameters):
    for ball in range(BALLS):
        out[ball] = y[2 * ball]


@cfunc(SIGNATURE)
def bounce_compiled(t, y, out, parameters):
    ball = int(parameters[0])
    for place in range(2 * BALLS):
        out[place] = y[place]
    out[2 * ball], out[2 * ball + 1] = 0.0, -0.8 * y[2 * ball + 1]


@cfunc(SIGNATURE)
def rooms_compiled(t, y, out, parameters):
    for unit in range(THERMOSTATS):
        rate = 1.0 + unit / THERMOSTATS
        out[unit] = rate * (3.0 * y[THERMOSTATS + unit] - y[unit])


@cfunc(SIGNATURE)
def limits_compiled(t, y, out, parameters):
    for unit in range(THERMOSTATS):
        out[unit], out[THERMOSTATS + unit] = 2.0 - y[unit], y[unit] - 1.0


def balls_compiled() -> np.ndarray:
    system = HybridSystem()
    fly = system.mode("fly", Compiled(fly_compiled))
    bounces = (Compiled(bounce_compiled, [ball]) for ball in range(BALLS))
    guards = [Guard(f"floor {ball}", reset=reset) for ball, reset in enumerate(bounces)]
    fly.guards(Compiled(heights_compiled), *guards)
    start = np.zeros(2 * BALLS)
    start[::2] = HEIGHTS
    return solve(system, (0.0, FALL), start, t_eval=[], **TOLERANCES).events["time"]


def balls_scipy() -> np.ndarray:
    def field(t, y):
        slope = np.full(2 * BALLS, -9.81)
        slope[::2] = y[1::2]
        return slope

    def height(ball):
        def event(t, y):
            return y[2 * ball]

        event.terminal, event.direction = True, -1
        return event

    events = [height(ball) for ball in range(BALLS)]

    def after(y, ball):
        y[2 * ball], y[2 * ball + 1] = 0.0, -0.8 * y[2 * ball + 1]

    start = np.zeros(2 * BALLS)
    start[::2] = HEIGHTS
    return restarted(field, events, after, start, FALL)


def thermostats_here(
    field: Any = lambda t, y, now: RATES * (3.0 * now.on - y),
    limits: Any = lambda t, y, now: np.concatenate([2.0 - y, y - 1.0]),
) -> np.ndarray:
    def sets(unit, value):
        def values(t, y, now):
            on = now.on.copy()
            on[unit] = value
            return {"on": on}

        return values

    system = HybridSystem(variables={"on": np.ones(THERMOSTATS)})
    rooms = system.mode("rooms", field)
    units = range(THERMOSTATS)
    warm = [Guard(f"warm {unit}", "falling", sets=sets(unit, 0.0)) for unit in units]
    cold = [Guard(f"cold {unit}", "falling", sets=sets(unit, 1.0)) for unit in units]
    rooms.guards(limits, *warm, *cold)
    found = solve(system, (0.0, SPAN), np.zeros(THERMOSTATS), t_eval=[], **TOLERANCES)
    return found.events["time"]


def thermostats_compiled() -> np.ndarray:
    return thermostats_here(Compiled(rooms_compiled), Compiled(limits_compiled))


def thermostats_scipy() -> np.ndarray:
    on = np.ones(THERMOSTATS)

    def crossing(unit, sign, limit):
        def event(t, y):
            return sign * (y[unit] - limit)

        event.terminal, event.direction = True, -1
        return event

    units = range(THERMOSTATS)
    events = [crossing(unit, -1.0, 2.0) for unit in units]
    events += [crossing(unit, 1.0, 1.0) for unit in units]

    def after(y, event):
        on[event % THERMOSTATS] = float(event >= THERMOSTATS)

    def field(t, y):
        return RATES * (3.0 * on - y)

    return restarted(field, events, after, np.zeros(THERMOSTATS), SPAN)


def restarted(field: Any, events: list[Any], after: Any, y: np.ndarray, end: float) -> np.ndarray:
    """The times of events of a loop around solve_ivp."""
    t, times = 0.0, []
    while t < end:
        run = solve_ivp(field, (t, end), y, method="DOP853", events=events, **TOLERANCES)
        t, y = run.t[-1], run.y[:, -1].copy()
        if run.status != 1:
            break
        fired = [place for place, found in enumerate(run.t_events) if found.size]
        for place in fired:
            times.append(t)
            after(y, place)
    return np.array(times)


def heyoka_runs() -> dict[str, Callable[[], np.ndarray]]:
    """The same in heyoka, with events that act in callbacks; none if it is not installed."""
    try:
        import heyoka
    except ImportError:
        return {}
    down, times = heyoka.event_direction.negative, []

    def balls():
        names = [name for ball in range(BALLS) for name in (f"x{ball}", f"v{ball}")]
        variables = heyoka.make_vars(*names)
        places, speeds = variables[::2], variables[1::2]
        equations = [
            pair
            for x, v in zip(places, speeds, strict=True)
            for pair in ((x, v), (v, heyoka.expression(-9.81)))
        ]

        def bounce(ball):
            def callback(integrator, sign):
                times.append(integrator.time)
                integrator.state[2 * ball] = 0.0
                integrator.state[2 * ball + 1] *= -0.8
                return True

            return heyoka.t_event(places[ball], direction=down, callback=callback)

        events = [bounce(ball) for ball in range(BALLS)]
        start = np.zeros(2 * BALLS)
        start[::2] = HEIGHTS
        return heyoka.taylor_adaptive(equations, start, t_events=events, tol=1e-12), FALL

    def thermostats():
        variables = heyoka.make_vars(*(f"y{unit}" for unit in range(THERMOSTATS)))
        equations = [
            (y, float(rate) * (3.0 * heyoka.par[unit] - y))
            for unit, (y, rate) in enumerate(zip(variables, RATES, strict=True))
        ]

        def crossing(unit, guard, value):
            def callback(integrator, sign):
                times.append(integrator.time)
                integrator.pars[unit] = value
                return True

            return heyoka.t_event(guard, direction=down, callback=callback)

        events = [crossing(unit, 2.0 - y, 0.0) for unit, y in enumerate(variables)]
        events += [crossing(unit, y - 1.0, 1.0) for unit, y in enumerate(variables)]
        pars = np.ones(THERMOSTATS)
        start = np.zeros(THERMOSTATS)
        made = heyoka.taylor_adaptive(equations, start, t_events=events, pars=pars, tol=1e-12)
        return made, SPAN

    def run(made):
        def timed():
            # The integrator is compiled before, and used once more from the start.
            integrator, end = made[0], made[1]
            times.clear()
            integrator.time = 0.0
            integrator.state[:] = made[2]
            integrator.reset_cooldowns()
            if integrator.pars.size:
                integrator.pars[:] = 1.0
            while integrator.time < end:
                if integrator.propagate_until(end)[0] == heyoka.taylor_outcome.time_limit:
                    break
            return np.array(times)

        return timed

    found = {}
    for name, make in (("balls", balls), ("thermostats", thermostats)):
        integrator, end = make()
        found[name] = run((integrator, end, integrator.state.copy()))
    return found


def main() -> None:
    heyoka = heyoka_runs()
    cases = {
        "balls": (bounces(), {"callables": balls_here, "compiled": balls_compiled, "SciPy": balls_scipy}),
        "thermostats": (
            switches(),
            {
                "callables": thermostats_here,
                "compiled": thermostats_compiled,
                "SciPy": thermostats_scipy,
            },
        ),
    }
    for case, (exact, runs) in cases.items():
        if case in heyoka:
            runs["heyoka"] = heyoka[case]
        for name, run in runs.items():
            begun = time.perf_counter()
            times = np.sort(run())
            took = time.perf_counter() - begun
            right = times.size == exact.size
            error = f"{np.abs(times - exact).max():.1e}" if right else f"{times.size} events"
            print(f"{case:12} {exact.size:5} events  {name:10} {took:8.3f} s  error {error}")


if __name__ == "__main__":
    main()
