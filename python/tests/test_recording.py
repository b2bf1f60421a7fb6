"""Functions of Python that run as formulas."""

import bisect
import enum
import functools
import itertools
import math
import numbers
from collections import deque
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

import stickslip
from numba import njit
from scipy.interpolate import interp1d
from stickslip import HybridSystem, recorded, solve
from stickslip._recording import Tape

MATRIX = np.array([[0.0, 1.0], [-2.0, -0.1]])
RATES = [0.5, 1.5]
SETTINGS = {"k": 3.0}
PLACE = SimpleNamespace(stiffness=2.0)


def pendulum(t, y):
    return [y[1], -np.sin(y[0])]


def with_math(t, y):
    return [y[1], -math.sin(y[0]) + math.exp(-t) * math.sqrt(1 + y[0] ** 2)]


def into_zeros(t, y):
    slope = np.zeros(2)
    slope[0] = y[1]
    slope[1] = -y[0] / (1 + y[0] ** 2)
    return slope


def like(t, y):
    slope = np.zeros_like(y)
    slope[0], slope[1] = y[1], -y[0] ** 3
    return slope


def unpacked(t, y):
    x, v = y
    return v, -x - 0.1 * v * abs(v)


def product(t, y):
    return MATRIX @ y


def dotted(t, y):
    return np.dot(MATRIX, y) + np.array([0.0, np.cos(t)])


def selected(t, y):
    return np.array([y[1], np.where(y[0] > 0, -y[0], -2 * y[0])])


def branched(t, y):
    if y[0] > 0:
        force = -y[0]
    elif y[1] < 0:
        force = -2 * y[0]
    else:
        force = -2 * y[0] + 0.1
    return [y[1], force]


def clipped(t, y):
    return [y[1], np.clip(-3 * y[0], -1, 1) - min(y[1], 0.5) + max(0.0, y[0])]


def table(t, y):
    return [y[1], -np.interp(y[0], [-1.0, 0.0, 2.0], [-2.0, 0.0, 1.0])]


def helped(t, y):
    return [y[1], spring(y[0], k=SETTINGS["k"])]


def spring(x, k):
    return -k * x


def looped(t, y):
    return [sum(RATES[i] * y[(i + j) % 2] * (-1) ** j for i in range(2)) for j in range(2)]


def attributes(t, y):
    return [y[1], -PLACE.stiffness * y[0]]


def closed(omega):
    def field(t, y):
        return np.array([y[1], -(omega**2) * y[0]])

    return field


def joined(t, y):
    return np.concatenate([y[1:], -np.tanh(y[:1])])


def logical(t, y):
    inside = (y[0] > -0.5) & (y[0] < 0.5)
    return [y[1], np.where(inside, -y[0], -np.sign(y[0]) * 0.5)]


def powers(t, y):
    return [y[1], -(y[0] ** 5) - np.power(np.abs(y[0]), 1.5) - 2.0 ** y[1] + np.hypot(y[0], 1)]


def reduced(t, y):
    return [y[1] - y.mean(), -np.sum(y**2) * np.prod(y) - np.max(y) - np.linalg.norm(y)]


def in_place(t, y):
    y *= 2
    y[1] += 1
    return [y[1], -y[0]]


def functions(t, y):
    x = 0.3 * np.tanh(y[0])
    circular = np.arcsin(x) + np.arctan2(x, 2.0) + np.arccos(x) + np.tan(x)
    return [y[1], -circular - np.arcsinh(x) - np.log1p(x) + np.expm1(x) - math.erf(x) - np.cosh(x)]


@pytest.mark.parametrize(
    "field",
    [
        *(pendulum, with_math, into_zeros, like, unpacked, product, dotted, selected, branched),
        *(clipped, table, helped, looped, attributes, closed(1.3), joined, logical, powers),
        *(reduced, in_place, functions, lambda t, y: [y[1], -y[0] if t < 1 else y[0]]),
    ],
    ids=lambda field: field.__name__,
)
def test_common_functions_are_recorded(field) -> None:
    formulas = recorded(field, 2)
    assert len(formulas) >= 2
    for y in ([0.3, -0.2], [-0.7, 0.4]):
        span = (0.0, 0.1)
        one = solve(field, span, y, record=True, rtol=1e-8, atol=1e-10)
        other = solve(field, span, y, record=False, rtol=1e-8, atol=1e-10)
        np.testing.assert_allclose(one.y[:, -1], other.y[:, -1], rtol=1e-7, atol=1e-9)


#: Idioms, each recorded as what it computes, at any place.
IDIOMS = [
    lambda t, y: [y[np.argmax(y)], max(y), min(*y), sum(y), max(y, key=abs)],
    lambda t, y: [*np.sort(y), *sorted(y)],
    lambda t, y: [y.max() - y.min(), y.std(), y.var(), np.linalg.norm(y - 0.3)],
    lambda t, y: [np.heaviside(y[0], 0.5), np.sign(y[1]), t // 0.3, t % 0.3],
    lambda t, y: [y[0] ** -2, (-2.0) ** 2 * y[1], y[2] ** 3, abs(y[0]) ** 0.5, 2 ** y[1]],
    lambda t, y: [math.floor(3 * t), math.ceil(y[0]), np.where(y, 1.0, 2.0)[0]],
    lambda t, y: np.concatenate([np.outer(y, y).ravel(), np.cross(y, [1.0, 2.0, 3.0])]),
    lambda t, y: np.einsum("ij,j->i", np.arange(6.0).reshape(2, 3), y),
    lambda t, y: [3.0 if y[0] else 4.0, 3.0 if y[0] == 0.5 else 4.0, y[0] * (y[1] > 0)],
    lambda t, y: [3.0 if -0.1 < y[0] < 0.5 else y[1], 1.0 if not (y[0] > 0) else y[0]],
    lambda t, y: [*np.diff(y, prepend=0.0), *np.cumsum(y), *np.roll(y, 1), *y[::-1]],
    lambda t, y: np.array([[y[0], 0], [1, y[1]]]) @ np.array([1.0, 2.0]),
    lambda t, y: np.select([y > 0.2, y > -0.2], [y, 2 * y], default=-1.0),
    lambda t, y: np.piecewise(y, [y < 0, y >= 0], [lambda x: -x, lambda x: x**2]),
    lambda t, y: [*np.polyval([1.0, 2.0, 3.0], y), *np.full(2, y[0]), *np.full_like(y, 2.0)],
    lambda t, y: [math.hypot(y[0], y[1]), math.atan2(y[0], y[1]), math.copysign(1.0, y[0])],
    lambda t, y: [math.log(abs(y[0]) + 1, 2), math.degrees(y[0]), math.sin(math.pi * t)],
    lambda t, y: [y[0] if isinstance(t, float) else 7.0, len(y), y.size, float(y[0])],
    lambda t, y: [y[0] if t < 0.2 or y[1] > 0 and y[2] < 0 else -y[0]],
    lambda t, y: [np.logical_and(y[0] > 0, y[1] > 0) * 1.0],
    lambda t, y: [np.where((y[0] > 0) | (y[1] > 0), 1, 2)],
    # Truth values are compared, counted and converted.
    lambda t, y: [((y[0] > 0) == (y[1] > 0)) * 1.0, 1.0 if (y[0] > 0) == 1 else 2.0],
    lambda t, y: [((y[0] > 0) != (y[1] > 0)) * 1.0, ((y[0] > 0) ^ (y[1] > 0)) * 1.0],
    lambda t, y: [np.sum(y > 0), (y > 0).mean(), np.count_nonzero(y > 0), int(y[0] > 0)],
    lambda t, y: [*(y > 0).astype(float), *np.array(y > 0, dtype=float), *(y > 0).astype(int)],
    lambda t, y: [1.0 if np.any(y > 0.5) else 2.0, 1.0 if (y > -0.5).all() else 2.0],
    # Numbers are asked what they are.
    lambda t, y: [1.0 if np.isscalar(t) else 2.0, 1.0 if hasattr(t, "__len__") else 2.0],
    lambda t, y: [1.0 if isinstance(y[0], numbers.Number) else 2.0, 1.0 if t is None else 2.0],
    # Extremes and sums of generators, of lists, and with a first value.
    lambda t, y: [max((x for x in y), default=0.0), min(x for x in (2, 1)), *max([y[0]], [y[1]])],
    lambda t, y: [y.sum(initial=5.0), y.max(initial=0.0), np.max(y, initial=0.3), y.prod()],
    lambda t, y: [y.clip(-0.5, 0.5)[0], np.clip(y, None, 0.1)[1], *y.clip(min=0.0)],
    # Integers, remainders and roots.
    lambda t, y: [int(3 * t) % 2, int(4 * y[0]), np.trunc(3 * y[0]), np.fix(3 * y[1])],
    lambda t, y: [math.fmod(y[0], 0.3), np.fmod(y[1], -0.4), *divmod(y[0], 0.3), np.cbrt(y[1])],
    lambda t, y: [math.hypot(*y), math.dist(y, [1, 2, 3]), math.fsum(y), math.prod([*y])],
    # Arrays of constants that are filled, and arrays of integers.
    lambda t, y: [_filled(np.array([0.0, 0.0]), y), _filled(np.zeros(2, dtype=float), y)],
    lambda t, y: [_filled(MATRIX.copy()[0], y), _filled(np.zeros_like(y, dtype=np.float64), y)],
    lambda t, y: np.sign(MATRIX.dot(y[:2])) + np.maximum(MATRIX.dot(y[:2]), 0) + MATRIX.T @ y[1:],
    # Linear algebra of small matrices.
    lambda t, y: np.linalg.solve(np.diag(y**2 + 1) + 0.1 * np.outer(y, y), y),
    lambda t, y: [*np.linalg.norm(np.outer(y, y), axis=1), np.linalg.norm(y, ord=np.inf)],
    lambda t, y: [np.linalg.det(np.diag(y)), *(np.linalg.inv(np.eye(3) * (2 + y)) @ y)],
    lambda t, y: [*np.linalg.solve(np.array([[2.0, 1.0], [1.0, 3.0]]), y[:2]), *np.gradient(y)],
    # Lists, tables and helpers.
    lambda t, y: [*np.exp([y[0], 1.0]), *np.r_[0, y], *np.pad(y, 1), np.sinc(y[0])],
    lambda t, y: [np.searchsorted([0.2, 0.5, 0.9], t), bisect.bisect([0.2, 0.5, 0.9], t)],
    lambda t, y: np.vectorize(lambda x: 1.0 if x > 0 else math.sin(x))(y),
    lambda t, y: np.divide(1.0, y, out=np.zeros_like(y), where=y > 0),
    lambda t, y: [CACHED(y[0]), HELPERS["force"](y[1]), *map(math.cos, y)],
    lambda t, y: [eval("np.sin(x) * t", {"np": np, "x": y[0], "t": t})],
]


def _filled(array, y):
    array[0] = y[0] * y[1]
    array += 1.0
    return np.sin(array).sum()


CACHED = functools.lru_cache(lambda x: math.sin(x) + 1.0)
HELPERS = {"force": lambda x: -math.sinh(x)}


def aliased(t, y):
    same = np.asarray(y)
    same[0] = 2.0
    first, _, last = np.split(y, 3)
    first -= 0.5
    last *= 3.0
    other = np.array(y)
    other[1] = 7.0
    return y


def imported(t, y):
    import math
    from numpy import zeros

    slope = zeros(3)
    slope[0] = math.sin(y[0])
    return slope


def tried(t, y):
    try:
        rate = SETTINGS["rate"]
    except KeyError:
        rate = 2.0
    with np.errstate(all="ignore"):
        return [rate / y[0], np.sqrt(y[1]), len(y)]


class Vector:
    """Two components."""

    def __init__(self, x, y):
        self.x, self.y = x, y

    def __add__(self, other):
        return Vector(self.x + other.x, self.y + other.y)

    @property
    def length(self):
        return math.sqrt(self.x**2 + self.y**2)


class Spring:
    """A system with parts that others override."""

    scale = 2.0

    def __call__(self, t, y):
        return [self.force(y[0]) * self.damping(), (Vector(y[0], t) + Vector(1.0, 0.0)).length]

    def force(self, x):
        return math.sin(x) * self.scale

    @staticmethod
    def damping():
        return 0.5


class Hard(Spring):
    """A spring of another force."""

    def force(self, x):
        return super().force(x) - x**3


class Slotted(Spring):
    """A spring with a helper that remembers what it has computed."""

    __slots__ = ("stiffness",)

    def __init__(self, stiffness):
        self.stiffness = stiffness

    @functools.lru_cache  # noqa: B019
    def force(self, x):
        return self.stiffness * math.tanh(x)


class Named(NamedTuple):
    """Parameters with a method."""

    rates: np.ndarray
    scale: float = 2.0

    def field(self, t, y):
        return self.scale * math.cos(t) * self.rates.dot(y[:2])


class Parameters(dict):
    """Parameters as attributes."""

    __getattr__ = dict.__getitem__


class Axis(enum.IntEnum):
    X, Y, Z = range(3)


GIVEN = Parameters(rate=2.0, force=lambda x: math.cos(x))
BUNDLE = SimpleNamespace(matrix=MATRIX, force=lambda x: math.sin(x), table=deque([2.0, math.cos]))
CURVE = interp1d([0.0, 0.4, 1.0], [1.0, 2.0, -1.0])


@njit
def jitted(t, y):
    slope = np.zeros(3)
    for i in range(3):
        slope[i] = math.sin(y[i - 1]) - t
    return slope


IDIOMS += [
    *(aliased, imported, tried, jitted, Spring(), Hard(), Hard().__call__, Slotted(3.0)),
    Named(MATRIX).field,
    lambda t, y: [GIVEN.rate * GIVEN.force(y[Axis.Y]), CURVE(t), Axis.Z * y[Axis.Z]],
    lambda t, y: [*BUNDLE.matrix.dot(y[:2]), BUNDLE.force(t), BUNDLE.table[1](y[2])],
]


@pytest.mark.parametrize("number", range(len(IDIOMS)))
def test_idioms_are_what_they_compute(number: int) -> None:
    function = IDIOMS[number]
    tape = Tape()
    formulas = [symbol.id for symbol in tape.record(function, 3, ())]
    random = np.random.default_rng(number)
    for _ in range(100):
        t, y = float(random.uniform(0, 1)), random.uniform(-1, 1, 3)
        expected = np.asarray(function(t, y.copy()), dtype=float).ravel()
        (found,) = tape.native.evaluate(formulas, [(t, y.tolist())], [])
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)


def test_what_is_recorded_is_decided() -> None:
    def dip(t, y):
        return 0.5 - np.exp(-(((t - 7.123) / 0.03) ** 2))

    found = solve(lambda t, y: [1.0], (0, 10), [0.0], events=dip)
    half = 0.03 * math.sqrt(math.log(2))
    assert found.guards == "decided" and found.decided
    np.testing.assert_allclose(found.t_events[0], [7.123 - half, 7.123 + half], atol=1e-12)
    sampled = solve(lambda t, y: [1.0], (0, 10), [0.0], events=dip, record=False)
    assert sampled.guards == "sampled: record = False" and not sampled.decided


def test_random_dips_are_found() -> None:
    random = np.random.default_rng(1)
    for _ in range(150):
        width, place = 10 ** random.uniform(-3, -1), random.uniform(1, 9)
        found = solve(
            lambda t, y: [1.0],
            (0, 10),
            [0.0],
            events=lambda t, y, p=place, w=width: 0.5 - np.exp(-(((t - p) / w) ** 2)),
        )
        half = width * math.sqrt(math.log(2))
        np.testing.assert_allclose(found.t_events[0], [place - half, place + half], atol=1e-11)


def test_systems_of_modes_are_recorded() -> None:
    belt = HybridSystem()
    stick = belt.mode("stick", lambda t, y: [y[1], 0.0])
    stick.guard("breaks away", lambda t, y: 1 - y[0], to="slip")
    slip = belt.mode("slip", lambda t, y: [y[1], 0.6 - y[0]])
    slip.guard("stops", lambda t, y: 0.5 - y[1], to="stick", reset=lambda t, y: [y[0], 0.5])
    found = solve(belt, (0, 30), [0.0, 0.5], "stick", record=True, dense_output=True)
    other = solve(belt, (0, 30), [0.0, 0.5], "stick", record=False)
    assert found.guards == "decided"
    assert found.events["guard"].tolist()[:2] == ["breaks away", "stops"]
    np.testing.assert_allclose(found.events["time"], other.events["time"], atol=1e-9)
    np.testing.assert_allclose(found.y[:, -1], other.y[:, -1], atol=1e-9)


def test_an_event_that_starts_from_zero_does_not_fire_there() -> None:
    for event in (lambda t, y: y[0], lambda t, y: y[0] ** 2 * (1 - y[0])):
        found = solve(lambda t, y: [1.0], (0, 2), [0.0], events=event, record=True)
        other = solve(lambda t, y: [1.0], (0, 2), [0.0], events=event, record=False)
        np.testing.assert_allclose(found.t_events[0], other.t_events[0], atol=1e-12)


def changes_a_list(log):
    def field(t, y):
        log.append(t)
        return -y

    return field


def counts():
    calls = 0

    def field(t, y):
        nonlocal calls
        calls += 1
        return -y

    return field


def toggles(state):
    def field(t, y):
        if y[0] < 0.5:
            state["on"] = False
        return [-1.0 if state["on"] else 1.0]

    return field


@pytest.mark.parametrize(
    ("field", "reason"),
    [
        (changes_a_list([]), "changes something outside"),
        (counts(), "changes 'calls'"),
        (toggles({"on": True}), "changes something outside"),
        (lambda t, y: -y + 1e-9 * np.random.normal(), "random"),
        (lambda t, y, c=itertools.count(): [-y[0] + next(c)], ""),
        (len, "of type builtin_function_or_method"),
        (lambda t, y: [[1.0, 2.0][int(t)]], r"int\(\)"),
        (lambda t, y: np.linalg.eigvals(np.eye(1) * (1 + y[0] ** 2)), "linalg"),
        (lambda t, y: np.array([y[0]], ndmin=2)[0], "numpy.array with options"),
        (lambda t, y: [y[0], y[0]], "returns 2 numbers instead of 1"),
        (lambda t, y: [y[0] > 0], "truth value"),
        (lambda t, y: [(y[0] > 0) + (y[0] > 0.5)], "of two truth values"),
    ],
)
def test_what_is_no_formula_is_not_frozen(field, reason) -> None:
    with pytest.raises(ValueError, match=f"record = True, but the right-hand side.*{reason}"):
        solve(field, (0, 0.1), [1.0], record=True)


def catches(t, y):
    try:
        return [[1.0, 2.0][int(y[0])]]
    except Exception:
        return [1.0]


def catches_all(t, y):
    try:
        return [[1.0, 2.0][int(y[0])]]
    except:  # noqa: E722
        return [1.0]


@pytest.mark.parametrize("field", [catches, catches_all])
def test_what_is_caught_is_not_frozen(field) -> None:
    with pytest.raises(ValueError, match="record = True"):
        solve(field, (0, 0.1), [0.5], record=True)
    assert solve(field, (0, 2), [0.5]).guards.startswith(("sampled", "decided"))


def test_clocks_and_random_numbers_are_refused() -> None:
    from random import random
    from time import perf_counter

    for changing in (random, perf_counter):
        with pytest.raises(ValueError, match="changes by itself"):
            recorded(lambda t, y, f=changing: [f() * y[0]], 1)


def test_defaults_and_arguments_are_not_changed() -> None:
    log: list[float] = []

    def field(t, y, kept=log):
        kept.append(t)
        return -y

    with pytest.raises(ValueError, match="changes something outside"):
        recorded(field, 1)
    with pytest.raises(ValueError, match="changes something outside"):
        recorded(lambda t, y, kept: [kept.append(t) or y[0]], 1, (log,))
    assert not log


def test_nothing_is_printed(capsys) -> None:
    def field(t, y):
        print("t =", t, f"{1:3}")
        return -y

    assert recorded(field, 1) == ["-y0"]
    assert not capsys.readouterr().out


def test_functions_do_not_see_symbols_outside() -> None:
    log: list[float] = []
    found = solve(changes_a_list(log), (0, 1), [1.0], events=lambda t, y: y[0] - 0.5)
    assert found.guards.startswith("sampled: the right-hand side: the function changes something")
    assert log and all(isinstance(t, float) for t in log)


def test_state_that_others_change_is_noticed() -> None:
    """What a function reads may change between its calls; its formulas would not."""
    shared = {"sign": 1.0}

    def field(t, y):
        return [shared["sign"]]

    def turn(t, y):
        shared["sign"] = -shared["sign"]
        return y

    system = HybridSystem()
    system.mode("m", field).guard("top", lambda t, y: 1 - y[0], direction="falling", reset=turn)
    found = solve(system, (0, 3), [0.0])
    assert found.guards.startswith("sampled: the reset")


def test_loops_end() -> None:
    def endless(t, y):
        total = 0.0
        while total < y[0]:
            total += 0.1
        return [total]

    with pytest.raises(ValueError, match="more than 100 decisions"):
        recorded(endless, 1)
    assert solve(endless, (0, 0.1), [1.0]).success


def test_large_systems_are_recorded_on_request() -> None:
    def chain(t, y):
        return np.roll(y, 1) - 2 * y + np.roll(y, -1)

    start = np.sin(np.arange(300) * 2 * np.pi / 300)
    found = solve(chain, (0, 1), start, events=lambda t, y: y[75] - 0.99999)
    assert "more than 200 components" in found.guards
    again = solve(chain, (0, 1), start, events=lambda t, y: y[75] - 0.99999, record=True)
    assert again.guards == "decided"
    np.testing.assert_allclose(found.y[:, -1], again.y[:, -1], atol=1e-11)


def test_recorded_shows_formulas() -> None:
    assert recorded(pendulum, 2) == ["y1", "-sin(y0)"]
    assert recorded(lambda t, y, k: k * y, 1, (2.0,)) == ["y0*2"]
    with pytest.raises(ValueError, match="cannot be recorded"):
        recorded(lambda t, y: [np.random.normal()], 1)
    assert "recorded" in stickslip.__all__


@pytest.mark.parametrize(
    ("rest", "mode"),
    [("lie", "lie"), (lambda t, y: [0.0, 0.25], "fly"), (lambda t, y: ("lie", [t, 0.0]), "lie")],
)
def test_a_rest_is_recorded(rest, mode):
    system = stickslip.HybridSystem()
    fly = system.mode("fly", lambda t, y: [y[1], -1.0])
    fly.guard("floor", lambda t, y: y[0], reset=lambda t, y: [0.0, -0.5 * y[1]], rest=rest)
    system.mode("lie", lambda t, y: [0.0, 0.0])
    found = solve(system, (0, 10), [0.5, 0.0], "fly", record=True)
    assert found.guards == "decided" and found.rests["to"][0] == mode
    assert abs(found.rests["time"][0] - 3.0) < 1e-8


def test_a_rest_that_depends_on_more_is_refused():
    seen = []

    def rest(t, y):
        return ("lie", [float(len(seen)), 0.0])

    system = stickslip.HybridSystem()
    fly = system.mode("fly", lambda t, y: [y[1], -1.0])
    fly.guard(
        "floor",
        lambda t, y: y[0],
        reset=lambda t, y: (seen.append(t), [0.0, -0.5 * y[1]])[1],
        rest=rest,
    )
    system.mode("lie", lambda t, y: [0.0, 0.0])
    found = solve(system, (0, 10), [0.5, 0.0], "fly")
    assert found.guards.startswith("sampled") and found.rests["to"][0] == "lie"
    assert found.y[0, -1] > 0.0


def test_a_text_has_a_study_of_its_accuracy():
    decay = stickslip.system("state x = 1\nx' = -x\nwhen x < 0.5 \"half\"\nend = 2")
    study = decay.converge(name="decay", threads=1)
    rows = study.tables["convergence_tolerances"].columns
    assert (np.maximum(rows["state_error"], rows["time_error"]) < 3 * rows["tolerance"]).all()
    assert rows["same_events"].all() and study.data["schema"] == "stickslip.system-convergence/1"
    assert study.tables["convergence_events"].columns["time"][0] == pytest.approx(np.log(2), abs=1e-14)
    with pytest.raises(ValueError, match="unknown"):
        decay.converge(parameters={"unknown": 1.0})
    with pytest.raises(ValueError, match="expected an end after"):
        decay.converge(t_span=(0.0, 0.0))


def test_jumps_of_the_right_hand_side_are_seen():
    def pulse(t, y):
        return [1e4 if 1.5 < t < 1.5001 else 0.0]

    found = solve(pulse, (0, 10), [0.0])
    assert abs(found.y[0, -1] - 1.0) < 1e-9 and found.events.size == 0
    assert found.sol is None and found.y.shape[0] == 1

    def wave(t, y):
        return [1.0 if t % 1 < 0.25 else -1.0, float(np.floor(t))]

    found = solve(wave, (0, 8), [0.0, 0.0], dense_output=True, t_eval=[0.5, 7.75])
    assert np.abs(found.y[:, -1] - [-3.75, 21 + 7 * 0.75]).max() < 1e-11
    assert abs(found.sol(0.125)[0] - 0.125) < 1e-13
    assert found.sensitivities("y0").y_by.shape[-1] == 2


def test_a_switch_that_slides_is_integrated_as_it_is():
    found = solve(lambda t, y: [-np.sign(y[0])], (0, 1.00001), [1.0])
    assert found.success and abs(found.y[0, -1]) < 1e-9


def test_an_array_is_recorded_as_it_lies():
    columns = np.array([[1.0, 3.0], [2.0, 4.0]], order="F")
    for read in (lambda: columns.ravel("K")[1], lambda: columns.reshape(-1, order="A")[1]):
        found = solve(lambda t, y, read=read: -read() * y, (0.0, 1.0), [1.0], record=True)
        assert found.y[0, -1] == pytest.approx(math.exp(-2.0))
