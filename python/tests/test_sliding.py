"""Surfaces along which solutions slide."""

import math

import numpy as np
import pytest
from numba import cfunc, types

from stickslip import Compiled, HybridFamily, HybridSystem, solve

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)


def belt(right_hand_side=lambda t, y, sign: [y[1], -y[0] - 0.8 * sign.belt]):
    """A mass of 1 on a spring of stiffness 1 and on a belt of velocity 0.5, with friction 0.8."""
    system = HybridSystem(sliding={"belt": lambda t, y: y[1] - 0.5})
    system.mode("mass", right_hand_side)
    return system


def test_a_belt_carries_a_mass_until_the_spring_is_stronger():
    found = solve(belt(), (0.0, 3.0), [-0.3, 0.5])
    assert found.event_names == ["belt"] and abs(found.t_events[0][0] - 2.2) < 1e-12
    assert found.sides["belt"][0] == 0 and found.sides["belt"][-1] == -1
    assert found.events["sides_from"]["belt"].tolist() == [0]
    assert found.events["sides_to"]["belt"].tolist() == [-1] and found.events["unique"].all()
    # Then it swings about 0.8, with a velocity of 0.5 at first.
    assert abs(found.y[0, -1] - 0.8 - 0.5 * math.sin(0.8)) < 1e-10


def test_a_relay_stays_at_zero():
    system = HybridSystem(sliding={"zero": lambda t, y: y[0]})
    system.mode("relay", lambda t, y, sign: [-sign.zero])
    found = solve(system, (0.0, 2.0), [0.75])
    assert found.events.size == 1 and abs(found.t_events[0][0] - 0.75) < 1e-14
    assert abs(found.y[0, -1]) < 1e-14 and found.sides["zero"][-1] == 0


def test_two_surfaces_are_slid_along_at_once():
    system = HybridSystem(sliding={"a": lambda t, y: y[0], "b": lambda t, y: y[1] - 0.1 * t})
    system.mode("both", lambda t, y, sign: [0.4 - sign.a, -2.0 * sign.b, 1.0])
    found = solve(system, (0.0, 3.0), [0.6, 2.1, 0.0])
    # x = 0 at 1, and 2.1 − 2 t = 0.1 t there too.
    assert np.abs(found.events["time"] - 1.0).max() < 1e-12
    assert (found.sides["a"][-1], found.sides["b"][-1]) == (0, 0)
    assert np.abs(found.y[:, -1] - [0.0, 0.3, 3.0]).max() < 1e-12


def test_a_repelling_surface_needs_a_side():
    system = HybridSystem(sliding={"zero": lambda t, y: y[0]})
    system.mode("away", lambda t, y, sign: [sign.zero])
    with pytest.raises(ValueError, match="not unique"):
        solve(system, (0.0, 1.0), [0.0])
    for side in (-1, 1):
        found = solve(system, (0.0, 1.0), [0.0], sides={"zero": side})
        assert abs(found.y[0, -1] - side) < 1e-14
        assert found.sides["zero"].tolist() == [side] * found.t.size
    for wrong in ({"zero": 2}, {"other": 1}):
        with pytest.raises(ValueError, match="expected -1, 0 or 1 for each of"):
            solve(system, (0.0, 1.0), [0.0], sides=wrong)


def test_a_belt_that_turns_at_times():
    """Friction 0.8 turns the mass by 1 within 1.25 after each turn of the belt."""
    system = HybridSystem(
        variables={"speed": 0.5}, sliding={"belt": lambda t, y, now: y[1] - now.speed}
    )
    mass = system.mode("mass", lambda t, y, now, sign: [y[1], -0.8 * sign.belt])
    mass.at("turns", [2.0, 4.0, 6.0, 8.0], sets=lambda t, y, now: {"speed": -now.speed})
    mass.guard("far", lambda t, y, now: 0.7 - y[0], direction="falling", terminal=3)
    found = solve(system, (0.0, 9.0), [0.0, 0.5])
    rows = zip(found.events["time"].round(9), found.events["guard"], strict=True)
    seen = [(time, guard) for time, guard in rows if guard != "far"]
    turns = [(time, "turns") for time in (2.0, 4.0, 6.0, 8.0)]
    assert seen == sorted([*turns, (3.25, "belt"), (5.25, "belt"), (7.25, "belt")])
    # It rises with 0.5 to 1, and after a turn by 0.25/1.6 more, with the velocity √(0.25 − 1.6 h).
    assert abs(found.t_events[found.event_names.index("far")][0] - 1.4) < 1e-12
    assert found.status == 0


def test_compiled_functions_find_signs_behind_the_state():
    @cfunc(SIGNATURE)
    def field(t, y, out, parameters):
        out[0] = y[1]
        out[1] = -y[0] - 0.8 * y[2]

    compiled = solve(belt(Compiled(field)), (0.0, 3.0), [-0.3, 0.5])
    assert np.array_equal(compiled.y, solve(belt(), (0.0, 3.0), [-0.3, 0.5], record=False).y)


def test_a_product_of_signs_is_refused():
    system = HybridSystem(sliding={"a": lambda t, y: y[0], "b": lambda t, y: y[1]})
    system.mode("both", lambda t, y, sign: [-sign.a * sign.b, -sign.a * sign.b])
    found = solve(system, (0.0, 3.0), [1.0, 1.0])
    assert found.outcome == "failed" and "not affine in the signs" in found.message


def test_wrong_surfaces_are_refused():
    with pytest.raises(ValueError, match="5 surfaces; expected 4 at most"):
        HybridSystem(sliding=dict.fromkeys("abcde", lambda t, y: y[0]))
    with pytest.raises(TypeError, match="surface 'a' is of type int"):
        HybridSystem(sliding={"a": 1})
    with pytest.raises(ValueError, match="backwards"):
        solve(belt(), (3.0, 0.0), [-0.3, 0.5])
    system = belt()
    system["mass"].guard("belt", lambda t, y: y[0] - 9.0, terminal=True)
    with pytest.raises(ValueError, match="a guard and a surface are called 'belt'"):
        solve(system, (0.0, 1.0), [-0.3, 0.5])
    with pytest.raises(TypeError, match="surface 'zero', at t = 0.0"):
        system = HybridSystem(sliding={"zero": lambda t, y: "one"})
        system.mode("mode", lambda t, y, sign: [1.0])
        solve(system, (0.0, 1.0), [0.5])


def test_families_slide():
    """Friction falls with the relative velocity: where the mass sticks again before the end."""

    def field(t, y, sign, friction, velocity):
        return [y[1], -y[0] - friction * sign.belt + 0.1 * (y[1] - velocity)]

    system = HybridSystem(sliding={"belt": lambda t, y, friction, velocity: y[1] - velocity})
    system.mode("mass", field)
    family = HybridFamily(
        system,
        (0.0, 7.0),
        [-0.3, 0.5],
        start=lambda t, y, friction, velocity: [-0.3, velocity],
        rtol=1e-11,
        atol=1e-11,
    )
    assert family.guards == ("belt", "belt-")
    labels = [str(family.label(friction, 0.5)) for friction in (0.8, 0.4)]
    assert labels == ["belt-", "belt-, belt"]
    found = family.follow((0.3, 0.9), (0.49, 0.5), [(0.8, 0.5), (0.4, 0.5)])
    assert {str(side) for side in found.sides} == {"belt-", "belt-, belt"}
    friction, velocity = found.points[len(found.points) // 2]

    # It is released at x = friction, and follows a growing oscillation about friction from there.
    at = HybridSystem()
    slips = at.mode("slips", lambda t, y: [y[1], -y[0] + friction + 0.1 * (y[1] - velocity)])
    slips.guard("sticks", lambda t, y: y[1] - velocity, direction="rising", terminal=True)
    begins = (friction + 0.3) / velocity
    run = solve(at, (begins, 20.0), [friction, velocity], rtol=1e-13, atol=1e-14)
    assert abs(run.t[-1] - 7.0) < 1e-8
