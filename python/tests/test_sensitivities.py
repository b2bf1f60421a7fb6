"""Derivatives of runs of formulas, and of recorded functions."""

import pickle

import numpy as np
import pytest
import stickslip
from stickslip import HybridSystem, solve

BALL = """
parameter g = 1, e = 0.6, h = 0.5
state x = h, v = 0
x' = v
v' = -g
when x < 0 "floor"
  x := 0
  v := -e*v
end = 2.7
"""


def test_a_ball_has_those_of_its_closed_form() -> None:
    found = stickslip.system(BALL).sensitivities("g", "e", "h", "v", rtol=1e-13, atol=1e-13)
    assert found.by == ("g", "e", "h", "v") and found.event.tolist() == ["floor", "floor", ""]
    assert found.t_by.shape == (3, 4) and found.y_by.shape == (3, 4, 2)
    # t₁ = √(2h/g), t₂ = t₁(1 + 2e); with a velocity v, t₁ = (v + √(v² + 2gh))/g.
    assert np.allclose(found.t[:2], [1.0, 2.2], rtol=0, atol=1e-12)
    expected = [[-0.5, 0.0, 1.0, 1.0], [-1.1, 2.0, 2.2, 1.0]]
    assert np.allclose(found.t_by[:2], expected, rtol=0, atol=1e-11)
    assert (found.t_by[2] == 0.0).all() and found.outcome == "reached_end"


def test_those_of_functions_are_those_of_their_formulas() -> None:
    def belt():
        system = HybridSystem()
        stick = system.mode("stick", lambda t, y: [y[1], 0.0])
        slip = system.mode("slip", lambda t, y: [y[1], 0.6 - y[0]])
        stick.guard("breaks", lambda t, y: 1 - y[0], to="slip")
        slip.guard("stops", lambda t, y: 0.5 - y[1], to="stick", reset=lambda t, y: [y[0], 0.5])
        return system

    strict = {"rtol": 1e-13, "atol": 1e-13}
    run = lambda x: solve(belt(), (0, 9.0), [x, 0.5], "stick", **strict)  # noqa: E731
    found = run(0.1)
    assert found.system is not None and "slip" in found.system.text
    derivatives = found.sensitivities("y0")
    assert derivatives.event.tolist()[:2] == ["breaks", "stops"]
    h = 1e-4
    after, before = run(0.1 + h), run(0.1 - h)
    difference = (after.events["time"] - before.events["time"]) / (2 * h)
    assert np.allclose(derivatives.t_by[:-1, 0], difference, rtol=0, atol=1e-7)
    difference = (after.y[:, -1] - before.y[:, -1]) / (2 * h)
    assert np.allclose(derivatives.y_by[-1, 0], difference, rtol=0, atol=1e-7)
    again = pickle.loads(pickle.dumps(found))
    assert (again.sensitivities("y0").t_by == derivatives.t_by).all()


def test_functions_have_those_by_their_parameters() -> None:
    fall = lambda t, y, g, e: [y[1], -g]  # noqa: E731
    floor = lambda t, y, g, e: y[0] - 0.0 * e  # noqa: E731
    given = {"g": 2.0, "e": 0.5}
    found = solve(fall, (0, 3), [1.0, 0.0], events=floor, parameters=given, rtol=1e-12)
    assert found.guards == "decided"
    # t = √(2h/g)
    moves = found.sensitivities("g", "e", "y0")
    assert np.allclose(moves.t_by[0], [-0.25, 0.0, 0.5], rtol=0, atol=1e-10)
    called = solve(fall, (0, 3), [1.0, 0.0], events=floor, parameters=given, record=False)
    assert np.allclose(called.t_events[0], found.t_events[0], rtol=0, atol=1e-9)
    # An event that is zero at the start does not fire there.
    start = lambda t, y, level: y[0] - level  # noqa: E731
    found = solve(
        lambda t, y, level: [-y[0]], (0, 1), [2.0], events=start, parameters={"level": 2.0}
    )
    assert found.guards == "decided" and found.events.size == 0
    with pytest.raises(TypeError, match="level"):
        solve(lambda t, y, level: -y, (0, 1), [1.0], parameters={"level": "high"})


def test_what_has_none_is_refused() -> None:
    system = stickslip.system(BALL)
    with pytest.raises(ValueError, match="'mass' is no parameter and no component"):
        system.sensitivities("mass")
    with pytest.raises(ValueError, match="rtol"):
        system.sensitivities("g", rtol=3.0)
    called = solve(lambda t, y: [-y[0]], (0, 1), [1.0], record=False)
    assert called.system is None
    with pytest.raises(ValueError, match="the functions were not recorded"):
        called.sensitivities("y0")
    # A guard that does not move where it acts: 0/0 there, unless rounding leaves something.
    flat = stickslip.system(
        "parameter c = 0\nstate x = -1\nx' = 1\nwhen x*x*x > c \"flat\"\n  x := -1\nend = 1.5"
    )
    with pytest.raises(stickslip.ComputationError):
        flat.sensitivities("c")
