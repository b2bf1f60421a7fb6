"""What was recorded is kept, and used only as long as all that its functions read is the same."""

import functools
import math
import os
import sys
import threading
import time
import types
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
import stickslip
from stickslip import HybridSystem, Mode, _recorded

RATE = 1.0
TABLE = {"rate": 1.0, "more": [1.0]}
HELPERS = types.ModuleType("helpers")
exec("K = 1.0\ndef f(y):\n    return -K * y", HELPERS.__dict__)


def of_a_global(t, y):
    return -RATE * y


def of_a_helper(t, y):
    return helper(HELPERS, y)


def helper(module, y):
    return -module.K * y


def of_a_table(t, y):
    return -TABLE["rate"] * y * TABLE["more"][0]


def with_a_default(t, y, rate=1.0, *, more=1.0):
    return -rate * more * y


def with_an_attribute(t, y):
    return -inner.rate * y


def inner():
    """It has an attribute."""


inner.rate = 1.0  # type: ignore[attr-defined]


def closed(rate):
    return lambda t, y: -rate * y


def by_a_builtin(t, y):
    return -abs(y[0])


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What is recorded anew, with nothing kept from before."""
    found: list[object] = []

    class Counted(_recorded.Recorded):
        def __init__(self, *args: Any) -> None:
            super().__init__(*args)
            found.append(self)

    monkeypatch.setattr(_recorded, "Recorded", Counted)
    monkeypatch.setattr(_recorded, "_KEPT", {})
    monkeypatch.setattr(_recorded, "_WATCHED", {})
    return found


def end(function: Callable[..., Any], y0: float = 1.0, **options: Any) -> float:
    """The end of a run, which formulas and functions have in common."""
    found = stickslip.solve(function, (0.0, 1.0), [y0], **options)
    assert found.decided
    plain = stickslip.solve(function, (0.0, 1.0), [y0], record=False, **options)
    assert found.y[0, -1] == pytest.approx(plain.y[0, -1], rel=1e-9)
    return float(found.y[0, -1])


def test_functions_are_recorded_once(made: list[object]) -> None:
    for y0 in (1.0, 2.0, 2.0, -1.0):
        assert end(of_a_global, y0) == pytest.approx(y0 * math.exp(-1), rel=1e-9)
    # Others with the same code are the same, whatever happens to the first ones.
    rates = np.array([1.0, 2.0])
    first, second = closed(rates[:1]), closed(rates[1:].copy())
    assert end(first) == pytest.approx(math.exp(-1))
    assert end(second) == pytest.approx(math.exp(-2))
    rates[0] = 7.0
    assert end(closed(np.array([1.0]))) == pytest.approx(math.exp(-1))
    assert end(first) == pytest.approx(math.exp(-7))
    assert len(made) == 4


def test_a_start_is_that_of_the_run(made: list[object]) -> None:
    for t, y0 in ((0.0, 1.0), (0.5, 3.0), (0.0, 0.0), (0.0, -0.0)):
        found = stickslip.solve(of_a_global, (t, 2.0), [y0])
        assert found.system is not None
        again = found.system.solve((t, 2.0))
        assert (again.t == found.t).all() and (again.y == found.y).all()
        assert math.copysign(1.0, found.y[0, 0]) == math.copysign(1.0, y0)
        assert found.system.text.endswith(f"at {t:g}\n")
    assert len(made) == 1


def test_the_order_of_a_zero_is_that_of_the_start(made: list[object]) -> None:
    # At rest on the floor it does not hit it; from above it does.
    def floor(t, y):
        return y[0]

    def fall(t, y):
        return [y[1], -1.0]

    for height, speed, times in ((0.0, 1.0, [2.0]), (0.5, 0.0, [1.0]), (0.0, 0.0, [])):
        found = stickslip.solve(fall, (0, 3), [height, speed], events=floor)
        np.testing.assert_allclose(found.t_events[0], times, atol=1e-9)
        assert found.decided
    with pytest.raises(ValueError, match="is zero all the time at the start"):
        stickslip.solve(lambda t, y: [0 * y[0]], (0, 3), [0.0], events=floor, record=True)
    assert len(made) == 1


@pytest.mark.parametrize(
    ("function", "change"),
    [
        (of_a_global, lambda patch: patch.setitem(globals(), "RATE", 2.0)),
        (of_a_global, lambda patch: patch.setitem(globals(), "RATE", np.float64(2.0))),
        (of_a_helper, lambda patch: patch.setattr(HELPERS, "K", 2.0)),
        (lambda t, y: HELPERS.f(y), lambda patch: patch.setattr(HELPERS, "K", 2.0)),
        (lambda t, y: HELPERS.f(y), lambda patch: patch.setattr(HELPERS, "f", lambda y: -2 * y)),
        (of_a_helper, lambda patch: patch.setitem(globals(), "helper", lambda m, y: -2 * y)),
        (of_a_table, lambda patch: patch.setitem(TABLE, "rate", 2.0)),
        (of_a_table, lambda patch: patch.setitem(TABLE, "more", [2.0])),
        (with_a_default, lambda patch: patch.setattr(with_a_default, "__defaults__", (2.0,))),
        (
            with_a_default,
            lambda patch: patch.setattr(with_a_default, "__kwdefaults__", {"more": 2.0}),
        ),
        (with_a_default, lambda patch: patch.setattr(with_a_default, "__code__", DOUBLE)),
        (with_an_attribute, lambda patch: patch.setattr(inner, "rate", 2.0)),
        (by_a_builtin, lambda patch: patch.setattr("builtins.abs", lambda x: 2 * x)),
        (lambda t, y: -np.abs(y), lambda patch: patch.setattr(np, "abs", lambda x: 2 * x)),
        (
            lambda t, y: -getattr(HELPERS, "K") * y,  # noqa: B009
            lambda patch: patch.setattr(HELPERS, "K", 2.0),
        ),
    ],
    ids=range(15),
)
def test_a_change_is_seen(
    function: Any, change: Any, made: list[object], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert end(function) == pytest.approx(math.exp(-1), rel=1e-9)
    with monkeypatch.context() as patch:
        change(patch)
        assert end(function) == pytest.approx(math.exp(-2), rel=1e-9)
    assert end(function) == pytest.approx(math.exp(-1), rel=1e-9)


DOUBLE = (lambda t, y, rate=1.0, *, more=1.0: -2 * y).__code__


def test_a_change_of_arguments_is_seen(made: list[object]) -> None:
    def decays(t, y, rate):
        return -rate[0] * y

    rate = np.array([1.0])
    for value in (1.0, 2.0, 1.0, 3.0):
        rate[0] = value
        assert end(decays, args=(rate,)) == pytest.approx(math.exp(-value), rel=1e-9)
    for many in ([1.0], (1.0,), {0: 1.0}):
        assert end(decays, args=(many,)) == pytest.approx(math.exp(-1.0), rel=1e-9)
    partly = functools.partial(decays, rate=[2.0])
    assert end(partly) == pytest.approx(math.exp(-2.0), rel=1e-9)
    partly.keywords["rate"][0] = 1.0
    assert end(partly) == pytest.approx(math.exp(-1.0), rel=1e-9)


def test_events_and_modes_are_those_of_the_call(made: list[object]) -> None:
    def half(t, y):
        return y[0] - 0.5

    for terminal, direction, status in ((True, 0, 1), (False, 0, 0), (True, 1, 0), (True, -1, 1)):
        half.terminal, half.direction = terminal, direction  # type: ignore[attr-defined]
        assert stickslip.solve(of_a_global, (0, 1), [1.0], events=half).status == status
    system = HybridSystem()
    fall = system.mode("fall", lambda t, y: [y[1], -1.0])
    fall.guard("floor", lambda t, y: y[0], reset=lambda t, y: [0.0, -y[1] / 2])
    count = len(made)
    for height in (0.5, 2.0):
        found = stickslip.solve(system, (0, 2.5), [height, 0.0])
        assert found.t_events[0][0] == pytest.approx(math.sqrt(2 * height)) and found.decided
    assert len(made) == count + 1
    fall.right_hand_side = lambda t, y: [y[1], -4.0]
    found = stickslip.solve(system, (0, 2.0), [2.0, 0.0])
    assert found.t_events[0][0] == pytest.approx(1.0)
    fall.guard("late", lambda t, y: 0.5 - t, terminal=True)
    assert stickslip.solve(system, (0, 2.0), [2.0, 0.0]).t[-1] == pytest.approx(0.5)


def test_only_the_last_ones_are_kept(made: list[object]) -> None:
    for rate in range(2 * _recorded.MOST_KEPT):
        stickslip.solve(closed(1.0 + rate), (0, 1e-3), [1.0])
    assert len(_recorded._KEPT) == _recorded.MOST_KEPT
    # A tape does not grow without end: starts leave their numbers there once the system is seen.
    for is_seen, more in ((False, 1), (True, 2)):
        count = len(made)
        for place in range(3 * _recorded.MOST_STARTS):
            found = stickslip.solve(of_a_global, (0, 0.1), [float(place)])
            assert found.system is not None
            assert not is_seen or f"y0 = {place}\n" in found.system.text
        assert len(made) == count + more


#: So short that no comparison of formulas and functions comes there.
def briefly(t):
    return 0.52 < t < 0.57


def test_what_is_read_by_another_name_is_read_anew(monkeypatch, tmp_path):
    given, path, file = {"rate": 1.0}, str(tmp_path / "rate"), np.loadtxt
    called = np.frompyfunc(lambda x: x * given["rate"], 1, 1)
    made_up, plain = types.ModuleType("made_up"), types.ModuleType("plain")
    made_up.__getattr__ = given.__getitem__  # type: ignore[method-assign]
    read, readers = getattr, (getattr, os.getenv)
    functions = [
        lambda t, y: -(made_up.rate if briefly(t) else 1.0) * y,
        lambda t, y: -(read(plain, "rate") if briefly(t) else 1.0) * y,
        lambda t, y: -(readers[0](plain, "rate") if briefly(t) else 1.0) * y,
        lambda t, y: -(float(readers[1]("RATE")) if briefly(t) else 1.0) * y,
        lambda t, y: -(sys.getrecursionlimit() / known if briefly(t) else 1.0) * y,
        lambda t, y: -(float("{0.rate}".format(plain)) if briefly(t) else 1.0) * y,
        lambda t, y: -(float(plain.__dict__["rate"]) if briefly(t) else 1.0) * y,
        lambda t, y: -(float(helper.__name__) if briefly(t) else 1.0) * y,
        lambda t, y: -(float(file(path)) if briefly(t) else 1.0) * y,
        lambda t, y: -(float(called(1.0)) if briefly(t) else 1.0) * y,
        lambda t, y: -(np.get_printoptions()["linewidth"] / wide if briefly(t) else 1.0) * y,
    ]

    def helper():
        """It has the name of a number."""

    known, wide = sys.getrecursionlimit(), np.get_printoptions()["linewidth"]
    for function in functions:
        ends = []
        for rate in (1.0, 20.0):
            given["rate"] = plain.rate = rate  # type: ignore[attr-defined]
            monkeypatch.setenv("RATE", str(rate))
            (tmp_path / "rate").write_text(str(rate))
            helper.__name__ = str(rate)
            sys.setrecursionlimit(int(rate * known))
            np.set_printoptions(linewidth=int(rate * wide))
            try:
                ends.append(stickslip.solve(function, (0.0, 1.0), [1.0]).y[0, -1])
            finally:
                sys.setrecursionlimit(known)
                np.set_printoptions(linewidth=wide)
        assert ends == pytest.approx([math.exp(-1.0), math.exp(-1.95)], abs=1e-9)


def of(value, read):
    """A function that reads a value where nothing is compared."""
    return lambda t, y: -(read(value) if briefly(t) else 1.0) * y


def moved(rows):
    rows[1].insert(0, rows[0].pop())


def renewed(table):
    table["first"] = table.pop("first")


SQUARE = np.array([[1.0, 1.0], [20.0, 1.0]])
#: A value, how it changes (or the one in its place), and what is read of it: 1, and 20 behind.
CHANGES: dict[str, tuple[Any, Callable[[Any], Any], Callable[[Any], float]]] = {
    "an equal truth value": (1, lambda _: True, lambda k: 20.0 if isinstance(k, bool) else 1.0),
    "an equal float": (3, lambda _: 3.0, lambda k: 20.0 if isinstance(k, float) else 1.0),
    "the other zero": (0.0, lambda _: -0.0, lambda k: 10.5 - 9.5 * math.copysign(1.0, k)),
    "no NaN": (math.nan, lambda _: 0.0, lambda k: 1.0 if math.isnan(k) else 20.0),
    "an entry": ([1.0], lambda k: k.__setitem__(0, 20.0), lambda k: k[0]),
    "deep inside": ([([1.0],)], lambda k: k[0][0].__setitem__(0, 20.0), lambda k: k[0][0][0]),
    "one more": ([], lambda k: k.append(1), lambda k: 20.0 if len(k) else 1.0),
    "to the next row": (([1.0, 20.0], [1.0]), moved, lambda k: k[1][0]),
    "of a key": ({"first": 1.0}, lambda k: k.update(first=20.0), lambda k: k["first"]),
    "of the order": ({"first": 1.0, "last": 20.0}, renewed, lambda k: [*k.values()][0]),
    "a view": (np.ones(2)[1:], lambda k: k.base.fill(20.0), lambda k: k[0]),
    "a shape": (np.ones(2), lambda k: setattr(k, "shape", (2, 1)), lambda k: 19.0 * k.ndim - 18.0),
    "a layout": (SQUARE, lambda k: np.asfortranarray(k), lambda k: k.ravel("K")[1]),
    "a function": (helper, lambda _: inner, lambda k: 1.0 if k is helper else 20.0),
}


@pytest.mark.parametrize(("value", "change", "read"), CHANGES.values(), ids=CHANGES)
def test_a_change_is_seen_where_nothing_is_compared(value, change, read, made):
    function = of(value, read)
    for _ in range(3):
        assert stickslip.solve(function, (0.0, 1.0), [1.0]).y[0, -1] == pytest.approx(math.exp(-1))
    assert len(made) == 1 and len(_recorded._WATCHED) == 1
    other = change(value)
    if other is not None:
        function.__closure__[1].cell_contents = other
    for _ in range(2):
        found = stickslip.solve(function, (0.0, 1.0), [1.0])
        assert found.system is not None
        assert found.y[0, -1] == pytest.approx(math.exp(-1.95))


class Fast(types.ModuleType):
    """A module that makes up an attribute."""

    @property
    def K(self):  # noqa: N802
        return 20.0


@pytest.mark.parametrize(
    ("function", "change"),
    [
        (lambda t, y: -RATE * y, lambda patch: patch.setitem(globals(), "RATE", 20.0)),
        (lambda t, y: -HELPERS.K * y, lambda patch: patch.setattr(HELPERS, "K", 20.0)),
        (lambda t, y: -HELPERS.K * y, lambda patch: patch.setattr(HELPERS, "__class__", Fast)),
        (lambda t, y: HELPERS.f(y), lambda patch: patch.setattr(HELPERS, "f", lambda y: -20 * y)),
        (lambda t, y: HELPERS.f(y), lambda patch: patch.setattr(HELPERS, "K", 20.0)),
        (
            lambda t, y: -abs(-1.0) * y,
            lambda patch: patch.setitem(globals(), "abs", lambda x: 20.0),
        ),
    ],
    ids=range(6),
)
def test_another_name_is_seen_where_nothing_is_compared(function, change, made, monkeypatch):
    def slope(t, y):
        return function(t, y) if briefly(t) else -y

    def run():
        found = stickslip.solve(slope, (0.0, 1.0), [1.0])
        assert found.system is not None
        return found.y[0, -1]

    monkeypatch.setattr(HELPERS, "K", 1.0)
    for _ in range(3):
        assert run() == pytest.approx(math.exp(-1.0))
    assert len(made) == 1
    with monkeypatch.context() as patch:
        change(patch)
        assert [run(), run()] == pytest.approx([math.exp(-1.95)] * 2)
    assert run() == pytest.approx(math.exp(-1.0))


def test_functions_with_the_same_numbers_are_told_apart(made):
    for turn in range(200):
        rate = float(turn % 7)
        found = stickslip.solve(of(rate, lambda k: k), (0.0, 1.0), [1.0])
        assert found.y[0, -1] == pytest.approx(math.exp(-0.95 - 0.05 * rate))
    assert len(made) == 7


def test_threads_change_what_is_read(made):
    rate, done = [1.0], threading.Event()
    function = of(rate, lambda k: k[0])

    def changes():
        while not done.is_set():
            rate[0] += 0.001
            time.sleep(1e-5)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    other = threading.Thread(target=changes)
    other.start()
    for _ in range(300):
        stickslip.solve(function, (0.0, 1.0), [1.0])
    done.set()
    other.join()
    sys.setswitchinterval(interval)
    for rate[0] in (rate[0], 1.0, rate[0], 20.0):
        found = stickslip.solve(function, (0.0, 1.0), [1.0])
        assert found.y[0, -1] == pytest.approx(math.exp(-0.95 - 0.05 * rate[0]))


def test_threads_run_the_same_functions(made):
    def swings(t, y):
        return [y[1], -y[0]]

    def passes(t, y):
        return y[0]

    def run(size):
        return stickslip.solve(swings, (0.0, 3.0), [size, 0.0], events=passes)

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(run, [1.0 + place % 5 for place in range(100)]))
    for place, one in enumerate(found):
        assert one.system is not None and one.y[0, 0] == 1.0 + place % 5
        assert one.system.text.count(f"y0 = {1 + place % 5}") == 1
        assert one.t_events[0] == pytest.approx([math.pi / 2])


def test_events_are_those_of_now(made):
    def decays(t, y):
        return -y

    def half(t, y):
        return y[0] - 0.5

    def run(*events):
        found = stickslip.solve(decays, (0.0, 1.0), [1.0], events=events or half)
        return found.status, found.event_names, len(found.t_events[0])

    assert [run(), run()] == [(0, ["half"], 1)] * 2
    half.terminal = True
    assert run() == (1, ["half"], 1)
    half.direction = 1
    assert run() == (0, ["half"], 0)
    del half.direction
    half.terminal, half.__name__ = False, "middle"
    assert run() == (0, ["middle"], 1) and run(half, half)[1] == ["event 0", "event 1"]
    half.__dict__ = {"terminal": 1}
    assert run() == (1, ["middle"], 1)
    half.__code__ = (lambda t, y: y[0] - 2.0).__code__
    assert run() == (0, ["middle"], 0)


def relay(wide=1.0):
    """It turns round at both ends of an interval."""
    system = HybridSystem()
    up = system.mode("up", lambda t, y: [1.0])
    down = system.mode("down", lambda t, y: [-1.0])
    up.guard("top", lambda t, y: wide - y[0], to=down, direction="falling")
    down.guard("bottom", lambda t, y: y[0], to=up, direction="falling")
    up.at("kick", [0.5], reset=lambda t, y: y - 0.125)
    return system


def test_systems_that_are_gone_are_not_used(made):
    for turn in range(100):
        wide = 1.0 + turn % 7 / 8
        found = stickslip.solve(relay(wide), (0.0, 3.25), [0.25], "up")
        assert found.t_events[0][0] == pytest.approx(wide - 0.125)


def add(system):
    system["down"].guard("half", lambda t, y: y[0] - 0.5, to="up", direction="falling")


def rename(system):
    system["down"].name = "back"


#: What becomes of a system in place.
CHANGED_SYSTEMS: dict[str, Callable[[HybridSystem], Any]] = {
    "another side": lambda it: setattr(it["up"], "right_hand_side", lambda t, y: [2.0]),
    "another guard": add,
    "a guard less": lambda it: it["up"]._sources.pop(),
    "another reset": lambda it: set_guard(it, "reset", lambda t, y: y - 0.25),
    "another time": lambda it: it["up"]._sources[1].guards[0].times.__setitem__(0, 0.625),
    "the last time": lambda it: set_guard(it, "terminal", True),
    "another name": rename,
    "a new mode in its place": lambda it: it._modes.update(down=Mode("down", lambda t, y: [-0.5])),
    "the width": lambda it: set_width(it, 0.75),
}


def set_guard(system, name, value):
    vars(system["up"]._sources[1].guards[0])[name] = value


def set_width(system, wide):
    system["up"]._sources[0].function.__closure__[0].cell_contents = wide


@pytest.mark.parametrize("change", CHANGED_SYSTEMS.values(), ids=CHANGED_SYSTEMS)
def test_a_changed_system_is_seen(change, made):
    def run(system, mode="up"):
        found = stickslip.solve(system, (0.0, 3.25), [0.25], mode)
        assert found.system is not None
        return found.t.tolist(), found.y.tolist(), found.mode.tolist(), found.events.tolist()

    system, other = relay(), relay()
    before = [run(system) for _ in range(3)]
    assert before[0] == before[1] == before[2] and len(made) == 1
    assert run(system, "down") != before[0] and run(system) == before[0]
    change(system)
    change(other)
    assert run(system) == run(system) == run(other) != before[0]
