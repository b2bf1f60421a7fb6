"""Times runs with and without switches beside SciPy and heyoka, and prints the tables of
docs/validation.md.

The runs of stickslip are those of crates/validation/examples/speed.rs. SciPy: `solve_ivp` with RK45
and DOP853, and with restarts where an event changes the state. heyoka: `taylor_adaptive` in its default
mode, which is not compact and with high_accuracy=False, and with high_accuracy=True; `nt_event` for
what is only noted, `t_event` with a callback where the state changes. Both tolerances are equal
everywhere. Compiling, of Rust as of heyoka's integrators, is not part of the time. Each time is
that of the fastest of many runs in one thread.

The truth has closed forms, but for the ball on a table that moves, where mpmath solves for each
bounce with 40 digits.

Run with a Python that has SciPy, heyoka and mpmath:  python tests/battery/speed.py [problem]
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

import heyoka  # noqa: E402, after the environment is set
import mpmath  # noqa: E402
import numpy as np  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402

ROOT = Path(__file__).parents[2]
RUST = ["cargo", "run", "--release", "-q", "-p", "validation", "--example", "speed", "--"]
TOLERANCES = [1e-6, 1e-9, 1e-12]
REPEATED = 0.15
ONLY = sys.argv[1] if len(sys.argv) > 1 else ""

mpmath.mp.dps = 40
MOON = 0.012277471
EARTH = 1.0 - MOON
ORBIT = [0.994, 0.0, 0.0, -2.00158510637908252240537862224]
PERIOD = 17.0652165601579625588917206249
RATE = 1.0 / (1.0 - 0.5 * np.cos(1.0))
PLANET = [np.cos(1.0) - 0.5, 0.75**0.5 * np.sin(1.0), -np.sin(1.0) * RATE,
          0.75**0.5 * np.cos(1.0) * RATE]
CYCLE = 2 * np.pi - 2 * np.arctan(0.8) + 1.6


# The truth: places of the events, and the state at the end.
def kepler_truth(turns):
    begin = 1 - mpmath.sin(1) / 2
    return [float(k * mpmath.pi - begin) for k in range(1, 2 * turns + 1)], PLANET


def ball_truth():
    g, h, r, end = map(mpmath.mpf, (9.81, 1.5, 0.9, 10.0))
    events, t = [], mpmath.sqrt(2 * h / g)
    v = g * t
    while t < end:
        events.append(t)
        v *= r
        t += 2 * v / g
    s = end - events[-1]
    return [float(t) for t in events], [float(v * s - g * s * s / 2), float(v - g * s)]


def table_truth():
    g, r, a, end = map(mpmath.mpf, (9.81, 0.9, 0.1, 8.0))
    events, t, y, v = [], mpmath.mpf(0), mpmath.mpf(1.5), mpmath.mpf(0)
    step = mpmath.mpf("0.001")
    while True:
        def gap(s):
            return y + v * s - g * s * s / 2 - a * mpmath.sin(2 * (t + s))
        s = step
        while gap(s) > 0 and t + s <= end:
            s += step
        if t + s > end:
            s = end - t
            return [float(t) for t in events], [float(y + v * s - g * s * s / 2), float(v - g * s)]
        s = mpmath.findroot(gap, (s - step, s), solver="anderson")
        t, v = t + s, v - g * s
        y, w = a * mpmath.sin(2 * t), 2 * a * mpmath.cos(2 * t)
        v = w - r * (v - w)
        events.append(t)


def belt_truth():
    cycle = 2 * mpmath.pi - 2 * mpmath.atan(mpmath.mpf(0.8)) + mpmath.mpf("1.6")
    slips = [2 + k * cycle for k in range(51)]
    sticks = [2 + (k + 1) * cycle - mpmath.mpf("1.6") for k in range(50)]
    sine, cosine = np.sin(1.0), np.cos(1.0)
    end = [0.6 + 0.4 * cosine + 0.5 * sine, -0.4 * sine + 0.5 * cosine]
    return sorted(float(t) for t in slips + sticks), end


# The problems for the peers: mode → right-hand side, guard, its direction; a transition or None.
def arenstorf(m):
    def field(t, y):
        earth, moon = y[0] + MOON, y[0] - EARTH
        e = EARTH / (earth * earth + y[1] * y[1]) ** 1.5
        k = MOON / (moon * moon + y[1] * y[1]) ** 1.5
        return [y[2], y[3], y[0] + 2.0 * y[3] - e * earth - k * moon,
                y[1] - 2.0 * y[2] - (e + k) * y[1]]
    return field, None


def kepler(m):
    def field(t, y):
        pull = -((y[0] * y[0] + y[1] * y[1]) ** -1.5)
        return [y[2], y[3], y[0] * pull, y[1] * pull]
    return field, lambda t, y: y[0] * y[2] + y[1] * y[3]


def ball(m):
    return lambda t, y: [y[1], m.number(-9.81)], lambda t, y: y[0]


def bounce(t, y, mode):
    return mode, [0.0, -0.9 * y[1]]


def table(m):
    return lambda t, y: [y[1], m.number(-9.81)], lambda t, y: y[0] - 0.1 * m.sin(2.0 * t)


def bounce_on_table(t, y, mode):
    w = 0.2 * np.cos(2.0 * t)
    return mode, [0.1 * np.sin(2.0 * t), w - 0.9 * (y[1] - w)]


def belt(m):
    def guard(t, y):
        return m.mode * (1.0 - y[0]) + (1.0 - m.mode) * (0.5 - y[1])
    return lambda t, y: [y[1], (1.0 - m.mode) * (0.6 - y[0])], guard


def turn(t, y, mode):
    return 1.0 - mode, [y[0], 0.5]


PROBLEMS = {
    "arenstorf": (arenstorf, None, ORBIT, 0.0, PERIOD, lambda: ([], ORBIT)),
    "kepler-10": (kepler, None, PLANET, 0.0, 20 * np.pi, lambda: kepler_truth(10)),
    "kepler-100": (kepler, None, PLANET, 0.0, 200 * np.pi, lambda: kepler_truth(100)),
    "ball": (ball, bounce, [1.5, 0.0], 0.0, 10.0, ball_truth),
    "table": (table, bounce_on_table, [1.5, 0.0], 0.0, 8.0, table_truth),
    "belt": (belt, turn, [0.0, 0.5], 1.0, 3.0 + 50 * CYCLE, belt_truth),
}


class Numbers:
    """What a problem needs of the numbers in which it is written."""

    def __init__(self, mode):
        self.mode, self.number, self.sin = mode, float, np.sin


class Symbols:
    """The same for heyoka. The mode is a parameter."""

    def __init__(self):
        self.mode, self.number, self.sin = heyoka.par[0], heyoka.expression, heyoka.sin


def scipy_run(problem, method, tolerance):
    build, change, state, mode, end, _ = PROBLEMS[problem]

    def once():
        events, t, y, which, work = [], 0.0, np.array(state), mode, 0
        while True:
            field, guard = build(Numbers(which))
            if guard is not None:
                guard.terminal = change is not None
                guard.direction = -1 if change else 0
            run = solve_ivp(field, (t, end), y, method=method, events=guard, rtol=tolerance,
                            atol=tolerance)
            work += run.nfev
            if guard is not None:
                events += map(float, run.t_events[0])
            t, y = run.t[-1], run.y[:, -1]
            if run.status == 0:
                return events, y, work
            which, y = change(t, y, which)
    return once


def heyoka_run(problem, high_accuracy, tolerance):
    build, change, state, mode, end, _ = PROBLEMS[problem]
    y = heyoka.make_vars(*[f"y{k}" for k in range(len(state))])
    symbols = Symbols()
    field, guard = build(symbols)
    events = []

    def note(integrator, when, sign):
        events.append(when)

    def switch(integrator, sign):
        t = integrator.time
        events.append(t)
        which, after = change(t, integrator.state, integrator.pars[0] if pars else 0.0)
        integrator.state[:] = after
        if pars:
            integrator.pars[0] = which
        return True

    options = {"tol": tolerance, "high_accuracy": high_accuracy}
    if guard is not None:
        guard = guard(heyoka.time, y)
        if change is None:
            options["nt_events"] = [heyoka.nt_event(guard, note)]
        else:
            falling = heyoka.event_direction.negative
            options["t_events"] = [heyoka.t_event(guard, callback=switch, direction=falling)]
    pars = problem == "belt"
    system = list(zip(y, field(heyoka.time, y)))
    integrator = heyoka.taylor_adaptive(system, state, **options)

    def once():
        events.clear()
        integrator.time = 0.0
        integrator.state[:] = state
        if pars:
            integrator.pars[0] = mode
        if change is not None:
            integrator.reset_cooldowns()
        integrator.propagate_until(end)
        return list(events), np.array(integrator.state), None
    return once


def fastest(once):
    shortest, began = float("inf"), time.perf_counter()
    while True:
        now = time.perf_counter()
        events, end, work = once()
        shortest = min(shortest, time.perf_counter() - now)
        if time.perf_counter() - began > REPEATED:
            return {"seconds": shortest, "events": events, "end": list(map(float, end)),
                    "field": work}


def digits(error):
    return "0" if error == 0 else f"{error:.0e}".replace("e-0", "e-")


def cell(result, truth):
    """Time, largest error of an event, error at the end."""
    places, end = truth
    micro = result["seconds"] * 1e6
    text = [f"{micro:.3g}" if micro < 1000 else f"{micro:.0f}"]
    if len(result["events"]) != len(places):
        return f"**{text[0]}; {len(result['events'])} events, not {len(places)}**"
    if places:
        text.append(digits(max(abs(a - b) for a, b in zip(result["events"], places))))
    text.append(digits(max(abs(a - b) for a, b in zip(result["end"], end))))
    return ", ".join(text)


def print_table(names, rows):
    print("| " + " | ".join(["problem", "tolerance", *names]) + " |")
    print("|" + "---|" * (2 + len(names)))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def main():
    rust = json.loads(subprocess.run(RUST + [ONLY], cwd=ROOT, check=True, capture_output=True).stdout)
    ours = {(r["problem"], r["tolerance"], r["program"]): r for r in rust}
    programs = list(dict.fromkeys(r["program"] for r in rust))
    programs.sort(key=lambda name: not name.startswith("dop853"))
    peers = {
        "heyoka": lambda *a: heyoka_run(a[0], False, a[1]),
        "heyoka, high accuracy": lambda *a: heyoka_run(a[0], True, a[1]),
        "SciPy DOP853": lambda *a: scipy_run(a[0], "DOP853", a[1]),
        "SciPy RK45": lambda *a: scipy_run(a[0], "RK45", a[1]),
    }
    times, work = [], []
    for problem, (*_, truth) in PROBLEMS.items():
        if not problem.startswith(ONLY):
            continue
        truth = truth()
        for tolerance in TOLERANCES:
            head = [problem, digits(tolerance)]
            mine = [ours.get((problem, tolerance, name)) for name in programs]
            row = [cell(r, truth) if r else "–" for r in mine]
            row += [cell(fastest(peer(problem, tolerance)), truth) for peer in peers.values()]
            times.append(head + row)
            counts = ("steps", "field", "guards", "enclosures", "isolations", "resteps")
            work.append(head + ["/".join(str(r[c]) for c in counts) if r else "–" for r in mine])
    print_table([*programs, *peers], times)
    print_table(programs, work)


if __name__ == "__main__":
    main()
