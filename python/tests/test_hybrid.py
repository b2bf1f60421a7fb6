"""Systems of one's own."""

import _thread
import copy
import ctypes
import math
import pickle
import threading
import time
from fractions import Fraction

import numpy as np
import pytest
from numba import cfunc, njit, types
from scipy import LowLevelCallable
from scipy.integrate import solve_ivp

import stickslip
from stickslip import Compiled, Guard, HybridSystem, solve

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)
G = 9.81


def decay(t, y):
    return -y


def circle(t, y):
    return [y[1], -y[0]]


def ball(restitution=0.5):
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y: [y[1], -G])
    fly.guard("floor", lambda t, y: y[0], reset=lambda t, y: [0.0, -restitution * y[1]])
    return system


def belt():
    """The mass on a belt of the README."""
    system = HybridSystem()
    stick = system.mode("stick", lambda t, y: [y[1], 0.0])
    slip = system.mode("slip", lambda t, y: [y[1], -y[0] + 0.6])
    stick.guard("breaks away", lambda t, y: -y[0] + 1.0, to=slip, reset=lambda t, y: [y[0], 0.5])
    slip.guard("stops", lambda t, y: -y[1] + 0.5, to="stick", reset=lambda t, y: [y[0], 0.5])
    return system


def event(function, terminal=False, direction=0.0, **attributes):
    def made(t, y, *args):
        return function(t, y, *args)

    made.terminal, made.direction = terminal, direction
    for name, value in attributes.items():
        setattr(made, name, value)
    return made


@cfunc(SIGNATURE)
def c_fly(t, y, out, p):
    out[0] = y[1]
    out[1] = -p[0]


@cfunc(SIGNATURE)
def c_height(t, y, out, p):
    out[0] = y[0]


@cfunc(SIGNATURE)
def c_bounce(t, y, out, p):
    out[0] = 0.0
    out[1] = -p[0] * y[1]


@cfunc(SIGNATURE)
def c_circle(t, y, out, p):
    out[0] = y[1]
    out[1] = -y[0]


def compiled_ball(wrap=lambda function: function):
    system = HybridSystem()
    fly = system.mode("fly", Compiled(wrap(c_fly), [G]))
    fly.guard("floor", Compiled(wrap(c_height)), reset=Compiled(wrap(c_bounce), [0.5]))
    return system


def assert_same(one, other):
    """The same run, bit for bit."""
    for name in ("t", "y", "mode", "status", "message", "nfev", "statistics"):
        assert np.array_equal(one[name], other[name]), name
    for name in ("time", "guard", "before", "after", "flatness"):
        assert np.array_equal(one.events[name], other.events[name]), name


# Closed forms


def test_every_bounce_of_a_ball():
    found = solve(ball(), (0.0, 2.9999), [4.905, 0.0])
    # It falls for 1, and then flies for 1, 1/2, 1/4, ...
    bounces = 3.0 - 0.5 ** np.arange(found.events.size) * 2.0
    assert found.events.size == 15
    assert np.abs(found.t_events[0] - bounces).max() < 1e-12
    assert found.status == 0 and found.success and found.t[-1] == 2.9999
    assert set(found.mode) == {"fly"}


def test_zeno_is_reported():
    found = solve(ball(), (0.0, 5.0), [4.905, 0.0])
    assert (found.status, found.outcome, found.success) == (-1, "zeno", False)
    assert abs(found.accumulation - 3.0) < 1e-10
    assert "accumulate" in found.message
    assert found.t[-1] == found.events["time"][-1]
    assert (found.y[:, -1] == found.events["after"][-1]).all()


@pytest.mark.parametrize(("method", "error"), [("dop853", 1e-10), ("dopri5", 1e-8), ("RK45", 1e-8)])
def test_friction_belt(method, error):
    found = solve(belt(), (0.0, 30.0), [0.0, 0.5], "stick", method=method)
    breaks, stops = found.t_events
    assert found.event_names == ["breaks away", "stops"]
    assert np.abs(np.diff(breaks) - 6.533703422732).max() < error
    assert abs(breaks[0] - 2.0) < 1e-12
    assert breaks.size == stops.size + 1 == 5
    row = found.events[0]
    assert (row["guard"], row["from"], row["to"]) == ("breaks away", "stick", "slip")
    assert (found.mode[found.t < breaks[0]] == "stick").all()


def test_state_before_and_after():
    found = solve(ball(), (0.0, 1.5), [4.905, 0.0], dense_output=True)
    bounce = found.t_events[0][0]
    before, after = found.y[:, found.t == bounce].T
    assert abs(before[1] + G) < 1e-12 and after.tolist() == [0.0, -0.5 * before[1]]
    assert found.sol(bounce).tolist() == after.tolist()
    assert found.y_events[0][0].tolist() == before.tolist()
    assert found.events["after"][0].tolist() == after.tolist()
    # Where the state goes on, its time comes once.
    modes = HybridSystem()
    modes.mode("up", lambda t, y: [1.0]).guard("top", lambda t, y: 1.0 - y[0], to="down")
    modes.mode("down", lambda t, y: [-1.0])
    found = solve(modes, (0.0, 1.5), [0.0], "up", dense_output=True)
    assert (np.diff(found.t) > 0.0).all() and abs(found.y[0, -1] - 0.5) < 1e-12
    assert found.sol.mode(found.t_events[0]).tolist() == ["down"]
    assert found.sol.mode([0.5, 1.4, 1.5, 7.0]).tolist() == ["up", "down", "down", ""]


# What solve_ivp gets wrong; docs/python/coming-from-solve-ivp.md has what it prints.


def test_pairs_of_crossings_within_a_step():
    # github.com/scipy/scipy/issues/9228: roots at -6, -2 and 2.
    found = solve(
        lambda t, y: 3 * t**2 + 12 * t - 4, (-8, 4), np.array([-120]), events=lambda t, y: y
    )
    assert np.abs(found.t_events[0] - [-6.0, -2.0, 2.0]).max() < 1e-12
    top = solve(circle, (0, 100), [0.0, 1.0], events=lambda t, y: y[0] - 0.999)
    swings = 2 * np.pi * np.arange(16)[:, None] + [np.arcsin(0.999), np.pi - np.arcsin(0.999)]
    assert np.abs(top.t_events[0] - swings.ravel()).max() < 1e-7


def test_last_point():
    # github.com/scipy/scipy/issues/10319: with t_eval, the end was dropped.
    ground = event(lambda t, y: y[0], terminal=True, direction=-1)
    times = [0, 15, 30, 45]
    found = solve(lambda t, y: [y[1], -0.5], (0, 100), [0, 10], events=ground, t_eval=times)
    assert found.t[:-1].tolist() == [0, 15, 30] and abs(found.t[-1] - 40) < 1e-12
    assert found.t[-1] == found.t_events[0][0] and abs(found.y[0, -1]) < 1e-12
    assert found.status == 1 and "ended the run" in found.message


@pytest.mark.parametrize("direction", [0, -1])
def test_start_on_a_zero(direction):
    ground = event(lambda t, y: y[0], terminal=True, direction=direction)
    cannon = lambda t, y: [y[1], -0.5]  # noqa: E731
    # With the long first step the whole flight is on one step.
    for options in ({}, {"first_step": 50.0}):
        found = solve(cannon, (0, 100), [0, 10], events=ground, **options)
        assert found.t_events[0].size == 1 and abs(found.t[-1] - 40) < 1e-11


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_zeros_of_any_order_at_the_start(order):
    def powers(t, y):
        return [(order + 1) * t**order, order * t ** (order - 1)]

    found = solve(powers, (0, 2), [0, 0], events=lambda t, y: y[1])
    assert found.t_events[0].size == 0
    # t^(order + 1) = t^order
    found = solve(powers, (0, 2), [0, 0], events=lambda t, y: y[0] - y[1])
    assert np.abs(found.t_events[0] - [1.0]).max() < 1e-9


# Options and names of solve_ivp


def test_names_of_solve_ivp():
    found = solve(decay, (0, 1), [1.0, 2.0], dense_output=True, events=lambda t, y: y[0] - 0.5)
    other = solve_ivp(decay, (0, 1), [1.0, 2.0], dense_output=True, events=lambda t, y: y[0] - 0.5)
    for name in other:
        assert hasattr(found, name), name
        assert found[name] is getattr(found, name) or found[name] == getattr(found, name)
    assert found.y.shape == (2, found.t.size) and found.sol([0.1, 0.2]).shape == (2, 2)
    assert found.sol(0.3).shape == (2,) and found.y_events[0].shape == other.y_events[0].shape
    assert found.success is True and found.status == 0
    assert abs(found.t_events[0][0] - math.log(2)) < 1e-11
    with pytest.raises(KeyError):
        found["nothing"]


def test_events_as_in_solve_ivp():
    up = event(lambda t, y: y[0], direction=1)
    down = event(lambda t, y: y[0], direction=-1)
    both = event(lambda t, y: y[0])
    third = event(lambda t, y: y[0] - 0.5, terminal=3)
    found = solve(circle, (0.1, 50), [np.sin(0.1), np.cos(0.1)], events=[up, down, both, third])
    assert np.allclose(found.t_events[0], [2 * np.pi], atol=1e-10)
    assert np.allclose(found.t_events[1], [np.pi], atol=1e-10)
    assert np.allclose(found.t_events[2], [np.pi, 2 * np.pi], atol=1e-10)
    assert found.status == 1 and abs(found.t[-1] - (2 * np.pi + np.pi / 6)) < 1e-10
    assert found.event_names == ["event 0", "event 1", "event 2", "event 3"]
    named = solve(decay, (0, 1), [1.0], events=decay_to_half)
    assert named.event_names == ["decay_to_half"] and named.events["guard"][0] == "decay_to_half"


def decay_to_half(t, y):
    return y[0] - 0.5


def test_events_of_a_system():
    top = event(lambda t, y: y[1], direction=-1)
    found = solve(ball(), (0.0, 2.4), [4.905, 0.0], events=[top])
    # It falls from the start.
    assert np.allclose(found.t_events[0], [0.0, 1.5, 2.25], atol=1e-12)
    assert np.allclose(found.t_events[1], [1.0, 2.0], atol=1e-12)
    same = event(lambda t, y: y[0], terminal=2, direction=-1)
    found = solve(ball(), (0.0, 2.4), [4.905, 0.0], events=[same])
    assert found.status == 1 and abs(found.t[-1] - 2.0) < 1e-12
    assert [len(times) for times in found.t_events] == [2, 1]
    with pytest.raises(ValueError, match="both|called"):
        solve(ball(), (0, 1), [1.0, 0.0], events=[floor])


def floor(t, y):
    return y[0]


def test_args():
    found = solve(
        lambda t, y, k, m: -k * y / m,
        (0, 1),
        [1.0],
        args=(2, 4),
        events=lambda t, y, k, m: y[0] - k / m - 0.3,
    )
    assert abs(found.y[0, -1] - math.exp(-0.5)) < 1e-10
    assert abs(found.t_events[0][0] + 2 * math.log(0.8)) < 1e-10
    system = HybridSystem()
    system.mode("on", lambda t, y, k: [k]).guard(
        "full", lambda t, y, k: k - y[0], reset=lambda t, y, k: [y[0] - k]
    )
    assert np.allclose(solve(system, (0, 3.5), [0.0], args=(2.0,)).t_events[0], [1, 2, 3])
    with pytest.raises(TypeError, match=r"args=\(3,\)"):
        solve(decay, (0, 1), [1.0], args=3)


def test_t_eval():
    times = np.linspace(0, 2.5, 11)
    found = solve(ball(), (0.0, 2.5), [4.905, 0.0], t_eval=times)
    dense = solve(ball(), (0.0, 2.5), [4.905, 0.0], dense_output=True)
    assert (found.t == times).all() and (found.y == dense.sol(times)).all()
    assert abs(found.y[0, 1] - (4.905 - 0.5 * G * 0.0625)) < 1e-12
    twice = solve(decay, (0, 1), [1.0], t_eval=[0, 0, 0.5, 0.5, 1, 1])
    assert twice.t.tolist() == [0, 0, 0.5, 0.5, 1, 1] and twice.y[0, 0] == 1.0
    only = solve(ball(), (0.0, 2.5), [4.905, 0.0], t_eval=[])
    assert only.t.size == 0 and only.y.shape == (2, 0)
    assert np.array_equal(only.events, dense.events)
    sampled = solve(ball(), (0.0, 2.5), [4.905, 0.0], t_eval=[], record=False)
    assert sampled.t.size == 0 and sampled.nfev < dense.nfev
    inside = solve(decay, (0, 1), [1.0], t_eval=[0.25])
    assert inside.t.tolist() == [0.25]
    for wrong in ([2.0], [-0.1], [0.5, 0.2], [np.nan], 0.5, [[0.5]], ["a"], [0.5j]):
        with pytest.raises((TypeError, ValueError), match="t_eval"):
            solve(decay, (0, 1), [1.0], t_eval=wrong)


def test_dense_output():
    found = solve(circle, (0, 20), [0.0, 1.0], dense_output=True)
    times = np.linspace(0, 20, 1001)
    assert np.abs(found.sol(times)[0] - np.sin(times)).max() < 1e-8
    assert (found.sol(found.t) == found.y).all()
    assert (found.sol.t_min, found.sol.t_max) == (0.0, 20.0)
    assert np.isnan(found.sol([-1.0, 21.0, np.nan])).all()
    assert solve(circle, (0, 1), [0.0, 1.0]).sol is None
    with pytest.raises(ValueError, match="dimensions"):
        found.sol([[1.0]])


def test_backwards():
    for method in ("dop853", "dopri5"):
        doubled = event(lambda t, y: y[0] - 2.0, direction=1)
        options = {"method": method, "dense_output": True, "t_eval": [1, 0, -1]}
        found = solve(decay, (1.0, -1.0), [1.0], events=doubled, **options)
        assert np.abs(found.y[0] - np.exp([0.0, 1.0, 2.0])).max() < 1e-8
        assert abs(found.t_events[0][0] - (1 - math.log(2))) < 1e-9
        assert abs(found.sol(0.5)[0] - math.exp(0.5)) < 1e-7
        assert np.isnan(found.sol(1.1)).all()
    steps = solve(decay, (1.0, -1.0), [1.0])
    assert steps.t[0] == 1.0 and steps.t[-1] == -1.0 and (np.diff(steps.t) < 0).all()
    with pytest.raises(ValueError, match="backwards.*'floor' of mode 'fly'"):
        solve(ball(), (1.0, 0.0), [1.0, 0.0])
    stone = HybridSystem()
    stone.mode("fly", lambda t, y: [y[1], -G]).guard(
        "1 m", lambda t, y: y[0] - 1.0, direction="rising", terminal=True
    )
    found = solve(stone, (0.0, -10.0), [0.0, -9.81])
    assert abs(found.t[-1] - (-1.0 + math.sqrt(1.0 - 2.0 / 9.81))) < 1e-12


def test_spans():
    empty = solve(decay, (1, 1), [2.0], dense_output=True, t_eval=[1, 1])
    assert empty.t.tolist() == [1, 1] and empty.y.tolist() == [[2, 2]] and empty.status == 0
    assert empty.sol(1.0).tolist() == [2.0]
    assert solve(decay, (1, 1), [2.0]).t.tolist() == [1]
    reached = event(lambda t, y: y[0] - 5, terminal=True)
    assert abs(solve(lambda t, y: [1.0], (0, np.inf), [0.0], events=reached).t[-1] - 5) < 1e-12
    assert abs(solve(lambda t, y: [-1.0], (0, -np.inf), [0.0], events=reached).t[-1] + 5) < 1e-12
    with pytest.raises(ValueError, match="infinite"):
        solve(decay, (0, np.inf), [1.0])
    for wrong in ((np.nan, 1), (0, np.nan), (-np.inf, 0), (0,), (0, 1, 2), 5, "ab", None, (0, 1j)):
        with pytest.raises((TypeError, ValueError), match="t_span"):
            solve(decay, wrong, [1.0])


# Guards


def test_several_guards_of_one_function():
    system = HybridSystem()
    room = system.mode("room", lambda t, y: [1.0, -2.0])
    room.guards(
        lambda t, y: [1.0 - y[0], y[1] + 1.0],
        Guard("right", to="out"),
        Guard("low", direction="falling"),
    )
    system.mode("out", lambda t, y: [0.0, 0.0])
    found = solve(system, (0, 2), [0.0, 0.0], "room")
    assert [str(name) for name in found.events["guard"]] == ["low", "right"]
    assert np.allclose(found.events["time"], [0.5, 1.0])


def test_guards_together():
    system = HybridSystem()
    mode = system.mode("a", lambda t, y: [1.0])
    mode.guard("first", lambda t, y: y[0] - 1, direction="either")
    mode.guard("second", lambda t, y: 2 * y[0] - 2, direction="either")
    mode.guard("end", lambda t, y: 3 - y[0], priority=-1, to="b")
    mode.guard("last", lambda t, y: 6 - 2 * y[0], terminal=True)
    system.mode("b", lambda t, y: [1.0])
    found = solve(system, (0, 5), [0.0], "a")
    assert found.events["simultaneous"][0] == ("second",)
    assert [times.size for times in found.t_events] == [1, 1, 0, 1]
    assert found.status == 1 and abs(found.t[-1] - 3) < 1e-12


def test_events_of_one_instant_all_act_in_order():
    for gap in (0.0, 1e-13, 1e-12):
        system = HybridSystem()
        mode = system.mode("a", lambda t, y: [1.0, 0.0, 0.0])
        for index in (1, 2):
            late = gap if index == 1 else 0.0

            def reset(t, y, index=index):
                y[index] = y[1] + y[2] + 1
                return y

            def value(t, y, late=late):
                return y[0] - 1 - late

            mode.guard(f"g{index}", value, direction="rising", reset=reset, priority=index)
        found = solve(system, (0, 2), [0.0, 0.0, 0.0])
        # The second one is earlier, and of higher priority at one instant.
        assert list(found.events["guard"]) == ["g2", "g1"], gap
        assert list(found.y[1:, -1]) == [2.0, 1.0]
    assert found.decided and found.guards == "decided"


def test_guards_that_are_preempted_are_reported():
    system = HybridSystem()
    mode = system.mode("a", lambda t, y: [1.0])
    mode.guard("first", lambda t, y: 1 - y[0], direction="falling", to="b")
    mode.guard("other", lambda t, y: 2 - 2 * y[0], direction="falling", to="c")
    system.mode("b", lambda t, y: [0.0])
    system.mode("c", lambda t, y: [0.0])
    found = solve(system, (0, 2), [0.0], "a")
    assert list(found.events["guard"]) == ["first"]
    assert found.preempted["guard"].tolist() == ["other"]
    assert found.preempted["mode"].tolist() == ["a"] and abs(found.preempted["time"][0] - 1) < 1e-14


def test_clocks():
    system = HybridSystem()
    mode = system.mode("tank", lambda t, y: -y)
    mode.at("dose", [0.0, 1.0, 1.0, 2.5], reset=lambda t, y: y + 1)
    mode.every("sample", 0.5, phase=0.25)
    found = solve(system, (0, 3), [0.0])
    assert found.t_events[0].tolist() == [0.0, 1.0, 2.5]
    assert found.t_events[1].tolist() == [0.25, 0.75, 1.25, 1.75, 2.25, 2.75]
    expected = sum(math.exp(-(3 - dose)) for dose in (0, 1, 2.5))
    assert abs(found.y[0, -1] - expected) < 1e-10
    many = HybridSystem()
    many.mode("m", lambda t, y: [0.0]).at("tick", np.arange(5000) / 1000, reset=lambda t, y: y + 1)
    assert solve(many, (0, 5), [0.0]).y[0, -1] == 5000
    stop = HybridSystem()
    stop.mode("m", lambda t, y: [1.0]).at("end", 1.5, terminal=True)
    ended = solve(stop, (0, np.inf), [0.0])
    assert ended.status == 1 and ended.t[-1] == 1.5
    with pytest.raises(ValueError, match=r"times\[\d+\] = .* is out of range"):
        unsorted = HybridSystem()
        unsorted.mode("m", lambda t, y: [1.0]).at("x", [1.0, 0.0, 2.0])
        solve(unsorted, (0, 1), [0.0])
    with pytest.raises(ValueError, match="period"):
        HybridSystem().mode("m", lambda t, y: [1.0]).every("x", 0.0)


def test_jumps_are_seen_on_request():
    for sees in (False, True):
        system = HybridSystem()
        mode = system.mode("a", lambda t, y: [1.0, 0.0])
        mode.guard("jump", lambda t, y: y[0] - 1, direction="rising", reset=lambda t, y: [3.0, y[1]])

        def count(t, y):
            return [y[0], y[1] + 1]

        mode.guard(
            "two", lambda t, y: y[0] - 2, direction="rising", reset=count, sees_jumps=sees
        )
        found = solve(system, (0, 1.5), [0.0, 0.0])
        assert found.y[1, -1] == sees


def test_a_run_goes_on_at_rest():
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y: [y[1], -G])
    fly.guard(
        "floor",
        lambda t, y: y[0],
        reset=lambda t, y: [0.0, -0.5 * y[1]],
        rest=lambda t, y: ("lie", [0.0, 0.0]),
    )
    system.mode("lie", lambda t, y: [0.0, 0.0])
    for record in (True, False):
        found = solve(system, (0, 10), [1.0, 0.0], "fly", record=record)
        assert found.success and found.mode[-1] == "lie" and found.y[:, -1].tolist() == [0.0, 0.0]
        rest = found.rests[0]
        expected = 3 * math.sqrt(2 / G)
        assert abs(rest["time"] - expected) < 1e-9 and rest["error"] < 1e-9
        assert rest["guard"] == "floor" and found.decided == record


def test_a_chain_without_end_names_its_cycle():
    system = HybridSystem()
    system.mode("up", lambda t, y: [1.0]).guard("top", lambda t, y: 1 - y[0], to="down")
    system.mode("down", lambda t, y: [1.0]).guard("bottom", lambda t, y: y[0] - 2, to="up")
    found = solve(system, (0, 5), [0.0], "up")
    assert found.outcome == "instant_limit" and found.status == -1
    assert "top" in found.message and "bottom" in found.message
    # The chain is no part of the run.
    assert found.events.size == 0 and abs(found.t[-1] - 1) < 1e-12


def test_terminal_counts_each_guard():
    system = HybridSystem()
    system.mode("up", lambda t, y: [1.0]).guard("top", lambda t, y: 1 - y[0], to="down")
    system.mode("down", lambda t, y: [-1.0]).guard("bottom", lambda t, y: y[0], to="up", terminal=2)
    found = solve(system, (0, 50), [0.0], "up")
    assert found.status == 1 and abs(found.t[-1] - 4.0) < 1e-11
    assert "guard 'bottom' of mode 'down'" in found.message
    assert [times.size for times in found.t_events] == [2, 2]


def test_guard_at_zero_at_the_start():
    # The ball lies on the floor and flies up: below fires where it would become negative only.
    found = solve(ball(), (0.0, 1.0), [0.0, G / 2])
    assert found.events.size == 0 or found.t_events[0][0] > 0.9
    found = solve(ball(), (0.0, 0.5), [0.0, -1.0])
    assert found.t_events[0][0] == 0.0 and found.y[:, 0].tolist() == [0.0, -1.0]
    assert found.y[:, 1].tolist() == [0.0, 0.5]


def test_transitions():
    def changing(transition):
        system = HybridSystem()
        mode = system.mode("a", lambda t, y: [1.0])
        mode.guard("g", lambda t, y: 1 - y[0], transition=transition)
        system.mode("b", lambda t, y: [0.0])
        return system

    system = changing(lambda t, y: "b")
    assert solve(system, (0, 2), [0.0], "a").mode[-1] == "b"
    assert solve(system, (0, 2), [0.0], system["b"]).mode[-1] == "b"
    assert solve(changing(lambda t, y: system["b"]), (0, 2), [0.0], "a").mode[-1] == "b"
    both = solve(changing(lambda t, y: ("b", 3 * y)), (0, 2), [0.0], "a")
    assert abs(both.y[0, -1] - 3.0) < 1e-12 and both.mode[-1] == "b"
    again = solve(changing(lambda t, y: [0.5]), (0, 1.75), [0.0], "a")
    assert np.allclose(again.t_events[0], [1.0, 1.5])

    def in_place(t, y):
        y *= 0.5
        return y

    again = solve(changing(in_place), (0, 1.75), [0.0], "a")
    assert np.allclose(again.t_events[0], [1.0, 1.5])
    stuck = solve(changing(lambda t, y: y), (0, 2), [0.0], "a")
    assert stuck.outcome == "instant_limit" and stuck.status == -1
    for wrong, error, words in [
        (lambda t, y: "zz", ValueError, "leads to mode 'zz'; expected one of"),
        (lambda t, y: ("zz", y), ValueError, "'zz'"),
        (lambda t, y: None, TypeError, "None"),
        (lambda t, y: ("b", None), TypeError, "None"),
        (lambda t, y: [1.0, 2.0], ValueError, r"shape \(2,\)"),
        (lambda t, y: [np.nan], ValueError, "component 0 of the state after is NaN"),
    ]:
        match = rf"the transition of guard 'g' of mode 'a', at t = (1\.0|0\.999).*{words}"
        with pytest.raises(error, match=match):
            solve(changing(wrong), (0, 2), [0.0], "a")


def test_many_events():
    count = 2000
    found = solve(
        lambda t, y: [1.0],
        (0, count + 0.5),
        [0.25],
        t_eval=[],
        max_step=2,
        events=lambda t, y: math.sin(math.pi * y[0]),
    )
    assert found.t_events[0].size == count
    assert np.abs(found.t_events[0] - np.arange(0.75, count)).max() < 1e-9
    limited = solve(ball(1.0), (0, 100), [4.905, 0.0], max_switches=7)
    assert limited.outcome == "switch_limit" and limited.events.size == 7
    assert limited.t[-1] == limited.events["time"][-1]


def fast(t, y):
    return math.sin(300 * t + 1)


def test_guards_that_change_fast():
    # Of 955 crossings most are lost without the scale on which the guard changes.
    crossings = (np.arange(1, 956) * np.pi - 1) / 300
    found = solve(lambda t, y: [1.0], (0, 10), [0.0], events=fast, guard_scale=0.01, max_step=0.5)
    assert found.t_events[0].size == 955
    assert np.abs(found.t_events[0] - crossings).max() < 1e-12


def test_guards_that_change_fast_on_long_steps():
    found = solve(lambda t, y: [1.0], (0, 10), [0.0], events=fast, guard_scale=0.01)
    assert found.t_events[0].size == 955 and found.poles.size == 0


def test_touches_and_poles():
    found = solve(circle, (0, 5), [0.0, 1.0], events=lambda t, y: 1.0 - y[0])
    assert found.t_events[0].size in (0, 2)
    pole = event(lambda t, y: 1 / (y[0] - math.sqrt(2)))
    found = solve(lambda t, y: [1.0], (0, 3), [0.0], events=pole)
    assert found.t_events[0].size == 0 and np.allclose(found.poles["time"], math.sqrt(2))
    assert found.poles["guard"].tolist() == ["made"]


# Compiled functions


def test_callables_and_compiled_functions_agree_bit_for_bit():
    def wrapped(function):
        return LowLevelCallable(function.ctypes)

    parameters = np.array([G])
    held = ctypes.cast(parameters.ctypes.data, ctypes.c_void_p)
    with_data = HybridSystem()
    with_data.mode("fly", Compiled(LowLevelCallable(c_fly.ctypes, held))).guard(
        "floor", Compiled(c_height.address), reset=Compiled(c_bounce.ctypes, [0.5])
    )
    span, start = (0.0, 2.9), [4.905, 0.0]
    python = solve(ball(), span, start, record=False)
    for system in (compiled_ball(), compiled_ball(wrapped), with_data):
        assert_same(solve(system, span, start), python)
    mixed = HybridSystem()
    mixed.mode("fly", Compiled(c_fly, [G])).guard(
        "floor", lambda t, y: y[0], reset=lambda t, y: np.array([0.0, -0.5 * y[1]])
    )
    assert_same(solve(mixed, span, start), python)
    jitted = njit(lambda t, y: np.array([y[1], -y[0]]))
    half = [lambda t, y: y[0] - 0.5]
    one = solve(circle, (0, 9), [0.0, 1.0], events=half, record=False)
    assert_same(solve(jitted, (0, 9), [0.0, 1.0], events=half, record=False), one)
    assert_same(solve(Compiled(c_circle), (0, 9), [0.0, 1.0], events=half), one)


def test_compiled_events():
    down = Compiled(c_height)
    down.direction, down.terminal = -1, 2
    found = solve(Compiled(c_circle), (0, 50), [0.0, 1.0], events=down)
    assert abs(found.t[-1] - 3 * np.pi) < 1e-9 and found.status == 1
    assert found.event_names == ["c_height"]


def test_what_is_not_compiled():
    two = cfunc(types.float64(types.float64, types.float64))(lambda a, b: a + b)
    for wrong in (decay, 1.5, None, "f", True, two, LowLevelCallable(two.ctypes)):
        with pytest.raises(TypeError):
            Compiled(wrong)
    real, other = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_float)
    for declared in [
        (None, ctypes.c_float, real, real, real),
        (None, ctypes.c_double, real, real),
        (ctypes.c_double, ctypes.c_double, real, real, real),
        (None, ctypes.c_double, other, real, real),
    ]:
        with pytest.raises(TypeError, match="the signature is"):
            Compiled(ctypes.CFUNCTYPE(*declared)(lambda *arguments: 0))
    Compiled(ctypes.CFUNCTYPE(None, ctypes.c_double, real, real, real)(lambda *arguments: None))
    for wrong in (0, -1, 2**70):
        with pytest.raises(ValueError, match="address"):
            Compiled(wrong)
    with pytest.raises(TypeError, match=r"Compiled\(cfunc\)"):
        solve(c_circle, (0, 1), [1.0, 0.0])
    with pytest.raises(TypeError, match="LowLevelCallable"):
        solve(LowLevelCallable(c_circle.ctypes), (0, 1), [1.0, 0.0])
    with pytest.raises(TypeError, match="pickled"):
        pickle.dumps(Compiled(c_circle))
    with pytest.raises(TypeError, match="complex"):
        Compiled(c_circle, [1j])
    numbers = np.array([1.0])
    held = ctypes.cast(numbers.ctypes.data, ctypes.c_void_p)
    with pytest.raises(ValueError, match="twice"):
        Compiled(LowLevelCallable(c_circle.ctypes, held), [1.0])


def test_parameters_are_copied():
    parameters = np.array([G])
    system = HybridSystem()
    system.mode("fly", Compiled(c_fly, parameters))
    parameters[0] = 0.0
    assert abs(solve(system, (0, 1), [0.0, 0.0]).y[1, -1] + G) < 1e-12


def test_compiled_runs_release_the_lock():
    # Another thread counts while the run goes on.
    counts = []
    running = threading.Event()

    def count():
        running.wait()
        while running.is_set():
            counts.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    running.set()
    start = time.perf_counter()
    solve(Compiled(c_circle), (0, 20_000), [0.0, 1.0], t_eval=[])
    end = time.perf_counter()
    running.clear()
    thread.join()
    inside = [one for one in counts if start < one < end]
    assert len(inside) > 3


def test_threads_get_the_same_bits():
    def work(index):
        found[index] = [
            solve(compiled_ball(), (0.0, 2.9), [4.905, 0.0]),
            solve(shared, (0.0, 20.0), [0.0, 0.5], "stick"),
        ]

    shared = belt()
    found = [None] * 4
    threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for one in found[1:]:
        for mine, first in zip(one, found[0], strict=True):
            assert_same(mine, first)


# Exceptions


class Stop(BaseException):
    pass


@pytest.mark.parametrize(
    "error", [KeyError("x"), KeyboardInterrupt(), SystemExit(3), Stop(), StopIteration()]
)
@pytest.mark.parametrize("place", ["field", "guard", "reset", "transition", "event"])
def test_exceptions_come_out_unchanged(error, place):
    calls = []

    def fails(t, y):
        calls.append(t)
        raise error

    fly = lambda t, y: [y[1], -G]  # noqa: E731
    system = HybridSystem()
    mode = system.mode("fly", fails if place == "field" else fly)
    if place == "transition":
        mode.guard("floor", lambda t, y: y[0], transition=fails)
    else:
        reset = fails if place == "reset" else lambda t, y: -y
        mode.guard("floor", fails if place == "guard" else lambda t, y: y[0], reset=reset)
    with pytest.raises(type(error)) as raised:
        solve(system, (0, 5), [4.905, 0.0], events=fails if place == "event" else None)
    assert raised.value is error and len(calls) == 1


def test_exceptions_stop_at_once():
    calls = []

    def fails(t, y):
        calls.append(t)
        if t > 0.5:
            raise ZeroDivisionError
        return -y

    with pytest.raises(ZeroDivisionError):
        solve(fails, (0, 1), [1.0])
    assert sum(t > 0.5 for t in calls) == 1


def test_ctrl_c_stops_a_compiled_run():
    timer = threading.Timer(0.2, _thread.interrupt_main)
    timer.start()
    start = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        solve(Compiled(c_circle), (0, 1e9), [0.0, 1.0], t_eval=[])
    assert time.perf_counter() - start < 5.0
    timer.join()


def test_callables_without_bytecode_let_others_run():
    # A ufunc writes its second argument. It does not look for signals, nor for other threads.
    timer = threading.Timer(0.2, _thread.interrupt_main)
    timer.start()
    start = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        solve(np.cos, (0, 1e12), [1.0], t_eval=[], max_step=0.1)
    assert time.perf_counter() - start < 5.0
    timer.join()


# What callables return


RETURNED = [
    (lambda t, y: [y[1]], ValueError, r"shape \(1,\); expected 2 numbers"),
    (lambda t, y: [1.0, 2.0, 3.0], ValueError, r"shape \(3,\)"),
    (lambda t, y: np.ones((2, 1)), ValueError, r"shape \(2, 1\)"),
    (lambda t, y: 1.0, ValueError, r"shape \(\)"),
    (lambda t, y: [[1.0], 2.0], ValueError, "inhomogeneous"),
    (lambda t, y: None, TypeError, "None"),
    (lambda t, y: "ab", TypeError, "str"),
    (lambda t, y: ["1", "2"], TypeError, "list"),
    (lambda t, y: [None, 1.0], TypeError, "list"),
    (lambda t, y: {0: 1.0, 1: 2.0}, TypeError, "dict"),
    (lambda t, y: (one for one in y), TypeError, "generator"),
    (lambda t, y: [1j, 2.0], TypeError, "complex"),
    (lambda t, y: y * 1j, TypeError, "complex"),
]


@pytest.mark.parametrize(("function", "error", "words"), RETURNED)
def test_wrong_returns_are_named(function, error, words):
    system = HybridSystem()
    system.mode("fly", function)
    with pytest.raises(error, match=rf"the right-hand side of mode 'fly', at t = 0.0: .*{words}"):
        solve(system, (0, 1), [1.0, 2.0])


GUARDED = [
    (lambda t, y: y[0] > 0, TypeError, "truth values|a bool"),
    (lambda t, y: True, TypeError, "a bool"),
    (lambda t, y: [1.0] if t < 0.5 else [1.0, 2.0], ValueError, r"shape \(2,\); expected one"),
    (lambda t, y: None, TypeError, "None"),
    (lambda t, y: 1j, TypeError, "complex"),
]


@pytest.mark.parametrize(("function", "error", "words"), GUARDED)
def test_wrong_guards_are_named(function, error, words):
    system = HybridSystem()
    system.mode("fly", decay).guard("g", function, terminal=True)
    with pytest.raises(error, match=rf"guard 'g' of mode 'fly', at t = .*: .*({words})"):
        solve(system, (0, 3), [1.0])


@pytest.mark.parametrize(
    "function",
    [
        lambda t, y: [-y[0], -y[1]],
        lambda t, y: (-y[0], -y[1]),
        lambda t, y: [-float(one) for one in y],
        lambda t, y: np.repeat(-y, 2)[::2],
        lambda t, y: (-y[::-1])[::-1],
        lambda t, y: (-y).astype(">f8"),
        lambda t, y: np.array([Fraction(-one) for one in y], dtype=object),
        lambda t, y: np.negative(y, out=y),
        lambda t, y: [np.array(-y[0]), -y[1]],
        lambda t, y: (-y).astype(np.longdouble),
    ],
)
def test_whatever_holds_numbers_is_read(function):
    one, other = (solve(f, (0, 1), [1.0, 2.0], record=False) for f in (function, decay))
    assert_same(one, other)


def test_not_finite():
    def later(t, y):
        return [np.nan] if t > 0.5 else [1.0]

    system = HybridSystem()
    system.mode("m", later)
    found = solve(system, (0, 1), [0.0])
    assert (found.status, found.outcome) == (-1, "failed")
    assert "Near t = 0.5" in found.message or "Near t = 0.49" in found.message
    assert "the right-hand side of mode 'm' is not finite" in found.message
    assert 0.4 < found.t[-1] <= 0.5 and np.isfinite(found.y).all()
    short = solve(system, (0, 1), [0.0], t_eval=[0.25, 0.75])
    assert short.t[0] == 0.25 and 0.4 < short.t[-1] <= 0.5 and short.t.size == 2
    blown = solve(lambda t, y: y**2, (0, 2), [1.0])
    assert blown.status == -1 and abs(blown.t[-1] - 1.0) < 1e-9 and "tolerance" in blown.message
    nowhere = solve(decay, (0, 1), [1.0], events=event(lambda t, y: np.nan if t > 0.5 else 1.0))
    assert nowhere.status == -1 and "event 'made' is not a number" in nowhere.message
    # Where nothing has been computed, it is an error.
    for wrong in (np.nan, np.inf):
        with pytest.raises(ValueError, match="Near t = 0.0, the right-hand side is not finite"):
            solve(lambda t, y, wrong=wrong: [wrong], (0, 1), [0.0])
    with pytest.raises(ValueError, match="event 'made' is not a number"):
        solve(decay, (0, 1), [1.0], events=event(lambda t, y: math.nan))
    with pytest.raises(ValueError, match="zero throughout"):
        solve(decay, (0, 1), [1.0], events=lambda t, y: 0.0)


# What callables do with their arguments


def test_callables_may_keep_what_they_get():
    kept = []

    def keeps(t, y):
        kept.append((y, y.copy(), y[:1], memoryview(y)))
        return -y

    solve(keeps, (0, 1), [1.0, 2.0], events=lambda t, y: y[0] - 0.5)
    assert len({id(one[0]) for one in kept}) == len(kept) > 50
    for y, copied, view, memory in kept:
        assert (y == copied).all() and view[0] == copied[0] == memory[0]


def modifies(t, y):
    slope = -y
    y[:] = np.nan
    return slope


def reshapes(t, y):
    slope = -y
    y.resize((7, 1), refcheck=False)
    return slope


def retypes(t, y):
    slope = -y
    y.dtype = np.int64
    return slope


def freezes(t, y):
    y.setflags(write=False)
    return -y


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("function", [modifies, reshapes, retypes, freezes])
def test_callables_may_change_what_they_get(function):
    one, other = (solve(f, (0, 1), [1.0, 2.0], record=False) for f in (function, decay))
    assert_same(one, other)


def test_guards_do_not_see_what_others_changed():
    def greedy(t, y):
        y[0] -= 0.5
        return y[0]

    found = solve(decay, (0, 2), [1.0], events=[greedy, event(lambda t, y: y[0] - 0.25)])
    assert np.allclose([one[0] for one in found.t_events], np.log([2, 4]))


def test_callables_may_solve():
    def nested(t, y):
        return -solve(decay, (0, 0.1), y).y[:, 0]

    one, other = (solve(f, (0, 0.1), [1.0], record=False) for f in (nested, decay))
    assert_same(one, other)

    def recursive(t, y):
        return solve(recursive, (0, 1), y).y[:, -1]

    with pytest.raises(RecursionError):
        solve(recursive, (0, 1), [1.0])
    assert solve(decay, (0, 1), [1.0]).success

    # A thread with a small stack.
    found = []

    def work():
        try:
            solve(recursive, (0, 1), [1.0])
        except RecursionError as error:
            found.append(error)

    usual = threading.stack_size(512 * 1024)
    try:
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
    finally:
        threading.stack_size(usual)
    assert len(found) == 1


def test_callables_may_start_threads():
    def threaded(t, y):
        result = []
        thread = threading.Thread(target=lambda: result.append(solve(decay, (0, 0.1), y)))
        thread.start()
        thread.join()
        return -result[0].y[:, 0]

    one, other = (solve(f, (0, 0.1), [1.0], record=False) for f in (threaded, decay))
    assert_same(one, other)


# Arguments


def test_starts():
    assert solve(decay, (0, 1), [1]).y[0, -1] == solve(decay, (0, 1), np.array([1.0])).y[0, -1]
    assert solve(decay, (0, 1), np.float32([1])).y.dtype == np.float64
    empty = solve(lambda t, y: [], (0, 1), [], dense_output=True)
    assert empty.y.shape == (0, empty.t.size) and empty.sol([0.5, 0.7]).shape == (0, 2)
    generator = (one for one in [1.0])
    for wrong in (1.0, [[1.0]], None, "abc", [None], [1j], [math.nan], [math.inf], generator):
        with pytest.raises((TypeError, ValueError)):
            solve(decay, (0, 1), wrong)


def test_ten_thousand_components():
    half = event(lambda t, y: y[9_999] - 0.5)
    found = solve(decay, (0, 1), np.ones(10_000), dense_output=True, events=half)
    assert abs(found.y[9_999, -1] - math.exp(-1)) < 1e-10
    assert abs(found.t_events[0][0] - math.log(2)) < 1e-10
    assert found.sol(0.5).shape == (10_000,) and found.events["after"].shape == (1, 10_000)


def test_options():
    for name, value in [
        ("method", "Radau"),
        ("rtol", 0.0),
        ("rtol", [1e-3, 1e-4, 1e-5]),
        ("atol", -1.0),
        ("atol", None),
        ("max_step", 0.0),
        ("first_step", -1.0),
        ("max_switches", 0),
        ("max_switches", 1.5),
        ("guard_scale", 0.0),
        ("guard_scale", "a"),
    ]:
        with pytest.raises((TypeError, ValueError), match=f"{name}|integer"):
            solve(decay, (0, 1), [1.0, 2.0], **{name: value})
    assert solve(decay, (0, 1), [1.0, 2.0], atol=[1e-9, 1e-9]).success
    assert np.diff(solve(decay, (0, 1), [1.0], max_step=0.01).t).max() < 0.0101
    for wrong in (5, None, [decay]):
        with pytest.raises(TypeError, match="right-hand side"):
            solve(wrong, (0, 1), [1.0])
    with pytest.raises(TypeError, match="method"):
        solve(decay, (0, 1), [1.0], "RK45")
    for wrong in ("abc", [None], 5):
        with pytest.raises(TypeError):
            solve(decay, (0, 1), [1.0], events=wrong)


def test_systems_that_make_no_sense():
    system = HybridSystem()
    with pytest.raises(ValueError, match="no modes"):
        solve(system, (0, 1), [1.0])
    mode = system.mode("a", decay)
    with pytest.raises(ValueError, match="two modes"):
        system.mode("a", decay)
    with pytest.raises(TypeError):
        system.mode(1, decay)
    with pytest.raises(TypeError, match="right-hand side of mode 'b'"):
        system.mode("b", 5)
    with pytest.raises(ValueError, match="fire for ever"):
        mode.guard("g", decay)
    with pytest.raises(ValueError, match="direction"):
        mode.guard("g", decay, direction="up")
    with pytest.raises(ValueError, match="terminal"):
        mode.guard("g", decay, terminal=-1)
    with pytest.raises(ValueError, match="transition"):
        mode.guard("g", decay, to="a", transition=decay)
    with pytest.raises(TypeError, match="a reset may be compiled"):
        mode.guard("g", decay, transition=Compiled(c_circle))
    with pytest.raises(ValueError, match="no guards"):
        mode.guards(decay)
    mode.guard("g", decay, to="elsewhere")
    with pytest.raises(ValueError, match="two guards"):
        mode.guard("g", decay, terminal=True)
    with pytest.raises(ValueError, match="leads to mode 'elsewhere'; expected one of"):
        solve(system, (0, 1), [1.0])
    system.mode("elsewhere", decay)
    with pytest.raises(ValueError, match="mode is missing"):
        solve(system, (0, 1), [1.0])
    with pytest.raises(ValueError, match="mode = 'c'"):
        solve(system, (0, 1), [1.0], "c")


# Results


def test_results_are_copied_and_pickled():
    top = event(lambda t, y: y[1])
    found = solve(ball(), (0, 2.5), [4.905, 0.0], dense_output=True, events=top)
    for other in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert_same(other, found)
        assert (other.sol([0.1, 1.7]) == found.sol([0.1, 1.7])).all()
        assert other.event_names == found.event_names
    assert f"{found.events.size} events" in repr(found)


def test_exported():
    for name in ("Compiled", "DenseOutput", "Guard", "HybridSystem", "Mode", "Solution", "solve"):
        assert name in stickslip.__all__ and hasattr(stickslip, name)
