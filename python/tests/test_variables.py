"""Variables that only events change."""

import math
import pickle

import numpy as np
import pytest
from numba import cfunc, types

import stickslip
from stickslip import Compiled, Guard, HybridFamily, HybridSystem, solve

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)


def heater(right_hand_side=lambda t, y, now: 3.0 * now.on - y):
    """A room that is heated to 3 until it has 2, and cools to 0 until it has 1."""
    system = HybridSystem(variables={"on": 1.0, "count": 0})
    room = system.mode("room", right_hand_side)
    room.guard("warm", lambda t, y, now: 2.0 - y, direction="falling", sets={"on": 0.0})
    room.guard(
        "cold",
        lambda t, y, now: y - 1.0,
        direction="falling",
        sets=lambda t, y, now: {"on": 1.0, "count": now.count + 1.0},
    )
    return system


def test_a_heater_switches_at_its_times():
    found = solve(heater(), (0.0, 10.0), [0.0], rtol=1e-13)
    times = math.log(3.0) + math.log(2.0) * np.arange(13)
    assert np.abs(found.events["time"] - times).max() < 1e-11
    assert list(found.events["guard"]) == ["warm", "cold"] * 6 + ["warm"]
    assert list(found.events["variables"]["on"]) == [0.0, 1.0] * 6 + [0.0]
    assert found.variables["count"][-1] == 6.0 and found.variables["on"][0] == 1.0
    assert found.sides == {} and set(found.mode) == {"room"}


def test_functions_of_variables_are_recorded():
    found = solve(heater(), (0.0, 10.0), [0.0], dense_output=True)
    sampled = solve(heater(), (0.0, 10.0), [0.0], record=False)
    assert found.guards == "decided" and not sampled.decided
    assert found.events.dtype == sampled.events.dtype and found.y.shape[0] == 1
    for name in ("guard", "variables"):
        assert np.array_equal(found.events[name], sampled.events[name])
    assert np.abs(found.events["time"] - sampled.events["time"]).max() < 1e-9
    assert found.sol(1.0).shape == (1,)
    assert abs(found.sol(1.0)[0] - 3.0 * (1.0 - math.exp(-1.0))) < 1e-9
    assert found.variables["count"].shape == found.t.shape
    assert "discrete count = 0" in found.system.text


@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-6, 1e-9])
def test_a_dip_is_found_as_long_as_it_is_armed(width):
    system = HybridSystem(variables={"armed": 1.0, "seen": [0.0, 0.0]})
    line = system.mode("line", lambda t, y, now: [1.0])

    def sets(t, y, now):
        seen = now.seen.copy()
        seen[1] = t
        return {"armed": 0.0, "seen": seen}

    def dip(t, y, now):
        return 0.5 - np.exp(-(((y[0] - 7.123) / width) ** 2)) if now.armed > 0.5 else 1.0

    line.guard("dip", dip, direction="falling", sets=sets)
    found = solve(system, (0.0, 10.0), [0.0], record=True)
    exact = 7.123 - width * math.sqrt(math.log(2.0))
    assert found.events.size == 1 and abs(found.events["time"][0] - exact) < 1e-13
    assert found.variables["seen"][-1].tolist() == [0.0, found.events["time"][0]]


def test_what_sets_variables_otherwise_than_by_formulas_is_refused():
    def with_sets(sets):
        system = HybridSystem(variables={"on": 1.0, "pair": [0.0, 1.0]})
        line = system.mode("line", lambda t, y, now: [now.on])
        line.guard("one", lambda t, y, now: 1.0 - y[0], direction="falling", sets=sets)
        return system

    calls = []

    def counts(t, y, now):
        calls.append(t)
        return {"on": float(len(calls))}

    wrong = [counts, lambda t, y, now: {"on": float(np.random.default_rng().random())}]
    wrong += [lambda t, y, now: {"pair": now.on}, lambda t, y, now: [0.0]]
    for sets in wrong:
        with pytest.raises(ValueError, match="record = True, but sets of guard 'one'"):
            solve(with_sets(sets), (0.0, 2.0), [0.0], record=True)


@pytest.mark.parametrize("names", [["y0"], ["t"], ["pi", "mode"], ["y0", "y1"], ["sin"], ["y0_"]])
def test_variables_may_be_called_as_anything_else(names):
    system = HybridSystem(variables={name: 1.0 + place for place, name in enumerate(names)})
    mode = system.mode("mode", lambda t, y, now: [now[0] + 0.0 * y[0], -y[1]])
    mode.guard(
        "one",
        lambda t, y, now: 1.5 - y[0],
        direction="falling",
        reset=lambda t, y, now: [0.0, y[1] + 1.0],
        sets=lambda t, y, now: {names[-1]: getattr(now, names[-1]) + 1.0},
    )
    found = solve(system, (0.0, 5.0), [0.0, 1.0], record=True)
    sampled = solve(system, (0.0, 5.0), [0.0, 1.0], record=False)
    assert np.abs(found.events["time"] - sampled.events["time"]).max() < 1e-9
    assert np.array_equal(found.events["variables"], sampled.events["variables"])
    # The text is that of the same system, under other names.
    again = stickslip.system(found.system.text).solve((0.0, 5.0))
    assert np.abs(again.t_events[0] - found.t_events[0]).max() < 1e-12


def test_units_need_no_modes_of_their_own():
    n = 40
    rates = 1.0 + np.arange(n) / n
    system = HybridSystem(variables={"on": np.ones(n)})
    units = system.mode("units", lambda t, y, now: rates * (3.0 * now.on - y))

    def to(unit, value):
        def sets(t, y, now):
            on = now.on.copy()
            on[unit] = value
            return {"on": on}

        return sets

    warm = [Guard(f"warm {i}", "falling", sets=to(i, 0.0)) for i in range(n)]
    cold = [Guard(f"cold {i}", "falling", sets=to(i, 1.0)) for i in range(n)]
    units.guards(lambda t, y, now: np.concatenate([2.0 - y, y - 1.0]), *warm, *cold)
    found = solve(system, (0.0, 4.0), np.zeros(n), t_eval=[], rtol=1e-12)
    for unit, rate in enumerate(rates):
        names = [f"warm {unit}", f"cold {unit}"]
        times = found.events["time"][np.isin(found.events["guard"], names)]
        exact = (math.log(3.0) + math.log(2.0) * np.arange(99)) / rate
        assert times.size == (exact < 4.0).sum()
        assert np.abs(times - exact[: times.size]).max() < 1e-10


def test_what_follows_sees_what_was_before():
    system = HybridSystem(variables={"kicks": 0, "last": [0.0, 0.0]})
    first = system.mode("first", lambda t, y, now: [1.0, 0.0])
    system.mode("second", lambda t, y, now: [now.kicks, now.last[0]])
    first.every(
        "kick",
        1.0,
        phase=0.5,
        reset=lambda t, y, now: y + [0.0, 10.0 * (1.0 + now.kicks)],
        sets=lambda t, y, now: {"kicks": now.kicks + 1, "last": y},
    )
    first.guard("enough", lambda t, y, now: 2.0 - y[0] + 0.0 * now.kicks, to="second")
    found = solve(system, (0.0, 3.5), [0.0, 0.0], "first")
    assert list(found.events["guard"]) == ["kick", "kick", "enough"]
    assert np.abs(found.events["after"][1] - [1.5, 30.0]).max() < 1e-13
    assert found.variables["last"].shape == (found.t.size, 2)
    assert np.array_equal(found.variables["last"][-1], found.events["before"][1])
    assert np.abs(found.y[:, -1] - [2.0 + 2.0 * 1.5, 30.0 + 1.5 * 1.5]).max() < 1e-12


def test_a_guard_is_armed_by_another_one():
    """It fires when the sine falls, but only after it has been below -0.5."""
    system = HybridSystem(variables={"armed": 0.0})
    wave = system.mode("wave", lambda t, y, now: [0.0])
    wave.guard("arms", lambda t, y, now: np.sin(t) + 0.5, direction="falling", sets={"armed": 1.0})
    wave.guard("fires", lambda t, y, now: np.sin(t) if now.armed else 1.0, terminal=True)
    wave.guard("rises", lambda t, y, now: np.sin(t), direction="rising", sets={"armed": 0.0})
    found = solve(system, (0.5, 20.0), [0.0])
    # It is negative where it is armed.
    assert found.status == 1 and list(found.events["guard"]) == ["arms", "fires"]
    assert abs(found.t[-1] - math.pi * 7.0 / 6.0) < 1e-10


def test_compiled_functions_find_variables_behind_the_state():
    @cfunc(SIGNATURE)
    def field(t, y, out, parameters):
        out[0] = 3.0 * y[1] - y[0]

    compiled = solve(heater(Compiled(field)), (0.0, 10.0), [0.0])
    sampled = solve(heater(), (0.0, 10.0), [0.0], record=False)
    assert np.array_equal(compiled.y, sampled.y)


def test_families_have_variables():
    system = HybridSystem(variables={"left": 2.0})
    ball = system.mode("ball", lambda t, y, now, height, _: [y[1], -1.0])
    ball.guard(
        "floor",
        lambda t, y, now, height, _: y[0] if now.left else 1.0,
        reset=lambda t, y, now, height, _: [0.0, -0.5 * y[1]],
        sets=lambda t, y, now, height, _: {"left": now.left - 1.0},
    )
    family = HybridFamily(
        system, (0.0, 3.0), [1.0, 0.0], start=lambda t, y, now, height, _: [height, 0.0]
    )
    # Of a height h it bounces at √(2 h) and at twice that time, and not a third time.
    assert [len(family.label(height, 0.0).guards) for height in (5.0, 2.0, 1.0, 0.1)] == [0, 1, 2, 2]


@pytest.mark.parametrize(
    ("sets", "error", "message"),
    [
        ({"off": 1.0}, ValueError, "'off' is no variable; expected some of \\('on', 'pair'\\)"),
        (lambda t, y, now: {"off": 1.0}, ValueError, "at t = .*: 'off' is no variable"),
        (lambda t, y, now: 3.0, TypeError, "3.0; expected a mapping"),
        ({"pair": 1.0}, ValueError, "'pair' has shape \\(\\); expected \\(2,\\)"),
        (lambda t, y, now: {"on": math.nan}, ValueError, "component 0 of the variables after"),
        (lambda t, y, now: {"on": 1j}, TypeError, "complex"),
    ],
)
def test_what_sets_something_else_is_refused(sets, error, message):
    system = HybridSystem(variables={"on": 1.0, "pair": [0.0, 1.0]})
    mode = system.mode("mode", lambda t, y, now: [1.0])
    mode.guard("guard", lambda t, y, now: 1.0 - y, direction="falling", sets=sets)
    with pytest.raises(error, match=message):
        solve(system, (0.0, 2.0), [0.0])


def test_wrong_variables_are_refused():
    with pytest.raises(ValueError, match="'1a' is not a name"):
        HybridSystem(variables={"1a": 1.0})
    with pytest.raises(ValueError, match="finite"):
        HybridSystem(variables={"a": math.inf})
    system = HybridSystem()
    mode = system.mode("mode", lambda t, y: [1.0])
    mode.guard("guard", lambda t, y: 1.0 - y, direction="falling", sets={"on": 1.0})
    with pytest.raises(ValueError, match="sets variables, and the system has none"):
        solve(system, (0.0, 2.0), [0.0])
    with pytest.raises(TypeError, match="sets = 3.0"):
        mode.guard("other", lambda t, y: 1.0 - y, direction="falling", sets=3.0)
    with pytest.raises(ValueError, match="backwards"):
        solve(heater(), (1.0, 0.0), [0.0])


def test_functions_cannot_change_variables():
    def right_hand_side(t, y, now):
        now.pair[0] = 1.0
        return [1.0]

    system = HybridSystem(variables={"pair": [0.0, 1.0]})
    system.mode("mode", right_hand_side)
    with pytest.raises(ValueError, match="read-only"):
        solve(system, (0.0, 2.0), [0.0])


def decay(t, y, now):
    return -now.rates * y


def test_systems_with_variables_are_copied_and_pickled():
    system = HybridSystem(variables={"rates": [1.0, 2.0]})
    system.mode("decay", decay)
    found = solve(pickle.loads(pickle.dumps(system)), (0.0, 1.0), [1.0, 1.0])
    assert np.abs(found.y[:, -1] - np.exp([-1.0, -2.0])).max() < 1e-10
    again = pickle.loads(pickle.dumps(found))
    assert again.variables["rates"].shape == (found.t.size, 2)


def test_events_and_arguments_follow_variables():
    system = HybridSystem(variables={"on": 1.0})
    system.mode("mode", lambda t, y, now, a: [a * now.on])
    found = solve(
        system, (0.0, 2.0), [0.0], events=lambda t, y, now, a: y[0] - now.on - a, args=(2.0,)
    )
    assert abs(found.t_events[0][0] - 1.5) < 1e-12
