"""Functions that are no formulas: they change by themselves, or when they are called, or what they
do differs where it is not compared. None is frozen."""

import datetime
import functools
import logging
import math
import random
import time
import types
import warnings
import weakref
from collections import deque

import numpy as np
import pytest
from stickslip import SampledGuardsWarning, recorded, solve


def drawn(t, y):
    return -y + 1e-13 * random.random()


def of_numpy(t, y, normal=np.random.default_rng(1).normal):
    return -y + 1e-13 * normal()


def of_an_import(t, y):
    import random as dice

    return -y + 1e-13 * dice.random()


def timed(t, y):
    return -y + 1e-20 * time.time()


def dated(t, y):
    return -y + 1e-20 * datetime.datetime.now().microsecond


def logged(t, y):
    logging.getLogger("stickslip.tests").debug("t = %s", t)
    return -y


def printed_into_a_file(t, y, log=None):
    print(t, file=log or open("/dev/null", "w"))  # noqa: SIM115
    return -y


CALLS = 0


def count_calls():
    global CALLS
    CALLS += 1


def of_a_helper(t, y):
    count_calls()
    return -y


def by_globals(t, y):
    globals()["CALLS"] = CALLS + 1
    return -y


HELPERS = types.ModuleType("helpers")
exec("calls = 0\ndef f(x):\n    global calls\n    calls += 1\n    return -x", HELPERS.__dict__)
VISITED: list[float] = []
visit = VISITED.append
QUEUE: deque[float] = deque([0.0])
STEPS = iter([1.0] * 1000)
FORCES = {"first": lambda x: VISITED.append(1.0) or -x}
BUNDLE = types.SimpleNamespace(force=lambda x: VISITED.append(1.0) or -x)
LARGE = {"values": np.zeros(5000)}


def of_a_large_array(t, y):
    LARGE["values"][2500] += 1e-9
    return -y


def buffered(t, y, out=np.zeros(1)):  # noqa: B008
    out[0] = y[0]
    return -out


def counted(function):
    calls = [0]

    @functools.wraps(function)
    def wrapper(*args):
        calls[0] += 1
        return function(*args)

    return wrapper


class Counter:
    """A right-hand side that remembers."""

    total = 0
    visited: list[float] = []

    def __init__(self):
        self.calls = 0
        self.times = {"all": [0.0]}
        self.dice = random.Random(1)

    def attribute(self, t, y):
        self.calls += 1
        return -y

    def helper(self, t, y):
        return self.attribute(t, y)

    def nested(self, t, y):
        self.times["all"].append(t)
        return -y

    def of_the_class(self, t, y):
        self.visited.append(t)
        return -y

    def drawn(self, t, y):
        return -y + 1e-13 * self.dice.random()


class Single:
    """A class with one instance."""

    instance = None

    def __new__(cls):
        if cls.instance is None:
            cls.instance = super().__new__(cls)
        return cls.instance

    @classmethod
    def seen(cls):
        Counter.visited.append(0.0)
        return 1.0


class Listed(type):
    """A metaclass that remembers."""

    def __call__(cls, *args):
        VISITED.append(0.0)
        return super().__call__(*args)


class Made(metaclass=Listed):
    """What it makes."""


COUNTER = Counter()
TO_COUNTER = weakref.ref(COUNTER)


def own_attribute(t, y):
    own_attribute.calls = getattr(own_attribute, "calls", 0) + 1
    return -y


def by_its_text(t, y):
    return -y if f"{t:.2f}" != "0.31" else 2 * y


def by_its_key(t, y):
    try:
        return {0.31: y}[t]
    except Exception:
        return -y


def by_its_type(t, y):
    return -y if type(t) is float else y


def by_a_domain(t, y):
    try:
        return [-math.sqrt(y[0] - 0.5)]
    except ValueError:
        return [-1.0]


def by_a_division(t, y):
    try:
        return [-1.0 / max(0.0, 0.5 - t)]
    except ZeroDivisionError:
        return [-1.0]


def by_any_exception(t, y):
    try:
        return [-math.log(y[0] - 0.5)]
    except:  # noqa: E722
        return [-1.0]


def by_a_place(t, y):
    return [[-1.0, 1.0][int(2 * t)]]


def newton(t, y):
    x = 1.0
    while abs(x * x - y[0] - 2) > 1e-10:
        x -= (x * x - y[0] - 2) / (2 * x)
    return [-x]


def halves(x):
    return x if x < 1e-3 else halves(x / 2)


def of_integers(t, y):
    slope = np.zeros(1, dtype=int)
    slope[0] = -3 * y[0]
    return slope


def with_a_hole(t, y):
    slope = np.empty(2)
    slope[0] = -y[0]
    return slope


def without_nan(t, y):
    return -np.nan_to_num(np.sqrt(y - 0.5), nan=0.5)


HAZARDS = [
    (drawn, "module random"),
    (of_numpy, "random numbers"),
    (of_an_import, "module random"),
    (timed, "module time"),
    (dated, "module datetime"),
    (logged, "module logging"),
    (printed_into_a_file, r"open\(\)"),
    (of_a_helper, "changes 'CALLS'"),
    (by_globals, r"globals\(\)"),
    (lambda t, y: HELPERS.f(y), "changes 'calls'"),
    (lambda t, y: [visit(t) or -y[0]], "changes something outside"),
    (lambda t, y: [QUEUE.append(t) or -y[0]], "changes something outside"),
    (lambda t, y: -y * next(STEPS), "changes something outside"),
    (lambda t, y: [FORCES["first"](y[0])], "changes something outside"),
    (lambda t, y: [BUNDLE.force(y[0])], "changes something outside"),
    (of_a_large_array, "changes something outside"),
    (buffered, r"float\(\)"),
    (counted(lambda t, y: -y), "changes something outside"),
    (COUNTER.attribute, "changes 'calls'"),
    (COUNTER.helper, "changes 'calls'"),
    (COUNTER.nested, "changes something outside"),
    (COUNTER.of_the_class, "changes something outside"),
    (COUNTER.drawn, "a Random of the module random"),
    (own_attribute, "changes 'calls'"),
    (lambda t, y: -y if Single() else y, "changes 'instance'"),
    (lambda t, y: -y * Single.seen(), "changes something outside"),
    (lambda t, y: -y if Made() else y, "has a metaclass"),
    (lambda t, y: [TO_COUNTER().visited.append(t) or -y[0]], "weakref"),
    (lambda t, y: [vars(COUNTER).update(calls=t) or -y[0]], "changes something outside"),
    (lambda t, y: [object.__setattr__(COUNTER, "calls", t) or -y[0]], "changes something outside"),
    (lambda t, y: [warnings.warn("here", stacklevel=1) or -y[0]], "module warnings"),
    (lambda t, y: [-y[0] if (t > 0.5) is True else y[0]], "asks whether something is True"),
    (by_its_text, "makes a text"),
    (by_its_key, r"hash\(\)"),
    (by_its_type, r"type\(\)"),
    (by_a_domain, "an exception may be caught"),
    (by_a_division, "an exception may be caught"),
    (by_any_exception, "catches what a number|an exception may be caught"),
    (by_a_place, r"int\(\)"),
    (newton, "more than 100 decisions"),
    (lambda t, y: [-halves(abs(y[0]) + 1.0)], "more than 64 ways"),
    (of_integers, r"int\(\)"),
    (with_a_hole, "NoneType"),
    (without_nan, "nan_to_num"),
    (lambda t, y: [-y[0] if np.isnan(y[0]) else y[0]], "isnan"),
    (lambda t, y: [y[y > 0].sum()], "a choice of entries"),
    (lambda t, y: [round(y[0], 2)], r"round\(\)"),
    (lambda t, y: (-x for x in y), "generator"),
    (lambda t, y: None, "NoneType"),
    (lambda t, y: y[0] > 0.5, "truth value"),
    (lambda t, y: y.reshape(1, 1), "shape"),
]


@pytest.mark.parametrize(("field", "reason"), HAZARDS, ids=range(len(HAZARDS)))
def test_a_hazard_is_refused_and_leaves_no_trace(field, reason) -> None:
    def outside():
        values = [CALLS, HELPERS.calls, VISITED, list(QUEUE), LARGE["values"].sum()]
        values += [COUNTER.calls, COUNTER.times, Counter.visited, COUNTER.dice.getstate()]
        return repr([*values, vars(own_attribute), buffered.__defaults__])

    before = outside()
    with pytest.raises(ValueError, match=f"the function cannot be recorded: .*({reason})"):
        recorded(field, 1)
    assert outside() == before


@pytest.mark.filterwarnings(f"ignore::{SampledGuardsWarning.__module__}.SampledGuardsWarning")
def test_a_hazard_runs_as_it_is() -> None:
    found = solve(by_a_domain, (0, 0.4), [1.0], events=lambda t, y: y[0] - 0.9)
    assert "an exception may be caught" in found.guards
    calls = CALLS
    found = solve(of_a_helper, (0, 1), [1.0], events=lambda t, y: y[0] - 0.5)
    assert CALLS > calls and found.guards == (
        "sampled: the right-hand side: the function changes 'CALLS', which others see"
    )
    np.testing.assert_allclose(found.t_events[0], [math.log(2)], rtol=1e-9)


def test_what_is_not_used_is_no_hazard() -> None:
    class Model:
        """Beside the right-hand side, it draws, counts and keeps."""

        def __init__(self):
            self.dice, self.runs, self.rate = random.Random(1), [], 2.0

        def rhs(self, t, y):
            return -self.rate * y

        def run(self):
            self.runs.append(solve(self.rhs, (0, 1), [self.dice.random()]))
            self.count = len(self.runs)

    assert recorded(Model().rhs, 1) == ["y0*-2"]
    model = Model()
    model.run()
    assert model.count == 1 and type(model.runs[0].y[0, 0]) is np.float64
