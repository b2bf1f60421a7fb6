"""Runs the cases of cases.json with SciPy and heyoka, and writes peers.json.

Both are used as their documentation says. SciPy: `solve_ivp` with DOP853 and the tolerances of the
case, non-terminal events for what is only noted, terminal events with a restart for what changes
mode or state. heyoka: `taylor_adaptive` with its default tolerance, `nt_event` and `t_event`;
`abs`, `min`, `max` and `select` are written with its `select`, and there is no `floor`. Compiling
heyoka's integrators is not part of the time.

Each run has a process of its own, which an alarm ends after 20 s.

Run with a Python that has both:  python tests/battery/peers.py [name of a case ...]
"""

import json
import multiprocessing
import os
import signal
import sys
import time
import warnings
from pathlib import Path

import heyoka
import numpy as np
from scipy.integrate import solve_ivp

HERE = Path(__file__).parent
LIMIT = 20


class NotExpressible(Exception):
    """The case uses a function that the peer does not have."""


# SciPy: expressions become Python functions.
def source(e):
    if isinstance(e, (int, float)):
        return repr(float(e))
    if isinstance(e, str):
        return "t" if e == "t" else f"y[{e[1:]}]"
    name, *arguments = e
    if name == "powi":
        return f"({source(arguments[0])})**{int(arguments[1])}"
    parts = [source(a) for a in arguments]
    if name in ("+", "-", "*", "/"):
        return f"({parts[0]} {name} {parts[1]})"
    if name == "neg":
        return f"(-{parts[0]})"
    if name == "select":
        return f"({parts[1]} if {parts[0]} >= 0 else {parts[2]})"
    names = {"ln": "log", "min": "minimum", "max": "maximum"}
    return f"np.{names.get(name, name)}({', '.join(parts)})"


def compiled(text):
    return eval(f"lambda t, y: {text}", {"np": np})  # noqa: S307, the text is ours


def sides(direction):
    return {"below": -1, "falling": -1, "rising": 1, "either": 0}[direction]


def changes(guard):
    return guard["to"] is not None or guard["reset"] is not None


def scipy_run(case, found):
    modes = []
    for mode in case["modes"]:
        events = []
        for guard in mode["guards"]:
            function = compiled(source(guard["value"]))
            function.terminal = changes(guard) or guard.get("terminal", False)
            function.direction = sides(guard["direction"])
            events.append(function)
        field = compiled("[" + ", ".join(map(source, mode["field"])) + "]")
        resets = [g["reset"] and compiled("[" + ", ".join(map(source, g["reset"])) + "]")
                  for g in mode["guards"]]
        modes.append((field, events, resets))
    start = case["start"]
    which, t, y = start["mode"], start["time"], np.array(start["state"])
    begin = time.perf_counter()
    while True:
        field, events, resets = modes[which]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            run = solve_ivp(field, (t, case["end"]), y, method="DOP853", events=events,
                            rtol=max(case["rtol"], 100 * np.finfo(float).eps), atol=case["atol"])
        if run.status < 0:
            raise RuntimeError(run.message)
        found += [[s, k] for k, times in enumerate(run.t_events) for s in map(float, times)]
        if run.status == 0:
            break
        t, y = run.t[-1], run.y[:, -1]
        fired = min(k for k, times in enumerate(run.t_events)
                    if events[k].terminal and len(times) and times[-1] == t)
        guard = case["modes"][which]["guards"][fired]
        if not changes(guard) or t >= case["end"]:
            break
        if guard["reset"]:
            y = np.array(resets[fired](t, y))
        which = which if guard["to"] is None else guard["to"]
    return time.perf_counter() - begin, t if run.status else case["end"]


# heyoka: expressions become its own.
def symbolic(e, state):
    if isinstance(e, (int, float)):
        return heyoka.expression(float(e))
    if isinstance(e, str):
        return heyoka.time if e == "t" else state[int(e[1:])]
    name, *arguments = e
    if name == "powi":
        return symbolic(arguments[0], state) ** float(int(arguments[1]))
    a = [symbolic(argument, state) for argument in arguments]
    if name == "+":
        return a[0] + a[1]
    if name == "-":
        return a[0] - a[1]
    if name == "*":
        return a[0] * a[1]
    if name == "/":
        return a[0] / a[1]
    if name == "neg":
        return -a[0]
    if name == "abs":
        return heyoka.select(heyoka.gte(a[0], 0.0), a[0], -a[0])
    if name == "min":
        return heyoka.select(heyoka.lt(a[0], a[1]), a[0], a[1])
    if name == "max":
        return heyoka.select(heyoka.gt(a[0], a[1]), a[0], a[1])
    if name == "select":
        return heyoka.select(heyoka.gte(a[0], 0.0), a[1], a[2])
    if name == "floor":
        raise NotExpressible("floor")
    return getattr(heyoka, "log" if name == "ln" else name)(a[0])


def heyoka_direction(direction):
    return {-1: heyoka.event_direction.negative, 0: heyoka.event_direction.any,
            1: heyoka.event_direction.positive}[sides(direction)]


def heyoka_run(case, found):
    size = len(case["start"]["state"])
    state = heyoka.make_vars(*[f"y{k}" for k in range(size)])
    state = state if isinstance(state, list) else [state]
    start = case["start"]

    def note(k):
        def callback(integrator, when, sign):
            found.append([when, k])
        return callback

    modes = []
    for mode in case["modes"]:
        terminal, noted = [], []
        for k, guard in enumerate(mode["guards"]):
            value = symbolic(guard["value"], state)
            direction = heyoka_direction(guard["direction"])
            if changes(guard) or guard.get("terminal", False):
                terminal.append((k, heyoka.t_event(value, direction=direction)))
            else:
                noted.append(heyoka.nt_event(value, note(k), direction=direction))
        field = [(y, symbolic(e, state)) for y, e in zip(state, mode["field"])]
        integrator = heyoka.taylor_adaptive(
            field, start["state"], time=start["time"],
            t_events=[event for _, event in terminal], nt_events=noted)
        resets = [g["reset"] and compiled("[" + ", ".join(map(source, g["reset"])) + "]")
                  for g in mode["guards"]]
        modes.append((integrator, [k for k, _ in terminal], resets))
    which = start["mode"]
    integrator = modes[which][0]
    begin = time.perf_counter()
    while True:
        integrator, terminal, resets = modes[which]
        outcome = integrator.propagate_until(case["end"])[0]
        if outcome == heyoka.taylor_outcome.time_limit:
            break
        code = int(outcome)
        if code >= 0 or -code > len(terminal):
            raise RuntimeError(f"{outcome}")
        fired = terminal[-code - 1]
        found.append([integrator.time, fired])
        guard = case["modes"][which]["guards"][fired]
        if not changes(guard):
            break
        y, t = np.array(integrator.state), integrator.time
        if guard["reset"]:
            y = np.array(resets[fired](t, y))
        following = which if guard["to"] is None else guard["to"]
        after = modes[following][0]
        if following != which:
            after.reset_cooldowns()
            after.time = t
        after.state[:] = y
        which = following
    return time.perf_counter() - begin, integrator.time


def judge(case, found):
    """Counts of events that are right, missed, invented and misplaced, and the largest error."""
    tolerance = case["tolerance"]
    found = sorted(found)
    if "count" in case:
        misplaced, error = 0, 0.0
        for index, when, guard in case["sampled"]:
            off = abs(found[index][0] - when) if index < len(found) else float("inf")
            wrong = off > tolerance
            misplaced += wrong
            error = error if wrong else max(error, off)
        shared = min(len(found), case["count"])
        return {"right": shared - misplaced, "missed": case["count"] - shared,
                "invented": len(found) - shared, "misplaced": misplaced, "error": error}
    truth = case["events"]

    def matched(within, truth, found):
        """Pairs of indices, greedily in the order of time."""
        pairs, used = [], set()
        for k, (when, guard) in enumerate(truth):
            for j, (s, which) in enumerate(found):
                if j not in used and which == guard and abs(s - when) <= within:
                    pairs.append((k, j))
                    used.add(j)
                    break
        return pairs

    right = matched(tolerance, truth, found)
    error = max((abs(truth[k][0] - found[j][0]) for k, j in right), default=0.0)
    taken, seen = {k for k, _ in right}, {j for _, j in right}
    truth = [event for k, event in enumerate(truth) if k not in taken]
    found = [event for j, event in enumerate(found) if j not in seen]
    if "accumulation" in case:
        # Infinitely many events lie between the last one that is listed and the accumulation.
        low, high = case["events"][-1][0] - tolerance, case["accumulation"] + tolerance
        found = [event for event in found if not low < event[0] <= high]
    misplaced = matched(1e3 * tolerance, truth, found)
    return {"right": len(right), "missed": len(truth) - len(misplaced),
            "invented": len(found) - len(misplaced), "misplaced": len(misplaced), "error": error}


def child(peer, case, pipe):
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(LIMIT)
    found, text, seconds = [], None, None
    try:
        seconds, end = peer(case, found)
        if "accumulation" in case and end >= case["end"]:
            text = "passes the accumulation"
    except NotExpressible as missing:
        pipe.send({"error_text": f"not expressible: {missing}"})
        return
    except Exception as error:  # noqa: BLE001, whatever a peer raises is its result
        text = f"{type(error).__name__}: {error}".splitlines()[0][:200]
    if not all(np.isfinite(s) for s, _ in found):
        text = text or "an event at a time that is not finite"
        found = [event for event in found if np.isfinite(event[0])]
    pipe.send({**judge(case, found), "error_text": text, "seconds": seconds})


def guarded(peer, case):
    here, there = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.get_context("fork").Process(target=child, args=(peer, case, there))
    process.start()
    there.close()
    try:
        result = here.recv()
    except EOFError:
        result = None
    process.join()
    if result is None:
        limit = process.exitcode == -signal.SIGALRM
        text = "time limit" if limit else f"ended with code {process.exitcode}"
        result = {"error_text": text}
    return result


def main():
    cases = json.loads((HERE / "cases.json").read_text())
    only = sys.argv[1:]
    path = HERE / "peers.json"
    results = json.loads(path.read_text()) if only and path.exists() else {}
    for case in cases:
        if only and case["name"] not in only:
            continue
        results[case["name"]] = {
            "scipy": guarded(scipy_run, case), "heyoka": guarded(heyoka_run, case)}
        print(case["name"], results[case["name"]], flush=True)
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(it)}" for name, it in results.items())
    path.write_text(f"{{\n{lines}\n}}\n")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
