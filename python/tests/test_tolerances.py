"""Tolerances of components, and limits of a run."""

import re
from typing import Any

import numpy as np
import pytest
import stickslip

#: A slow component of size 1e-9, beside a fast one whose digits do not matter.
RTOL, ATOL = [1e-10, 1e-2, 1e-2], [1e-20, 1e-2, 1e-2]
START = [1e-9, 0.0, 1.0]
TEXT = "state x = 1e-9, u = 0, v = 1\nx' = -x\nu' = 50*v\nv' = -50*u\nend = 1"


def slopes(t: float, y: np.ndarray) -> list[float]:
    return [-y[0], 50.0 * y[2], -50.0 * y[1]]


def beside_a_surface() -> stickslip.HybridSystem:
    """The same, which never reaches its surface."""
    system = stickslip.HybridSystem(sliding={"far": lambda t, y: y[0] - 1.0})
    system.mode("only", lambda t, y, side: slopes(t, y))
    return system


def run(kind: str, **options: Any) -> stickslip.Solution:
    if kind == "text":
        return stickslip.system(TEXT).solve(**options)
    if kind == "recorded":
        return stickslip.solve(slopes, (0, 1), START, record=True, **options)
    if kind == "sampled":
        return stickslip.solve(slopes, (0, 1), START, record=False, **options)
    return stickslip.solve(beside_a_surface(), (0, 1), START, **options)


@pytest.mark.parametrize("kind", ["text", "recorded", "sampled", "surface"])
@pytest.mark.parametrize("method", ["dop853", "dopri5"])
def test_components_have_their_own(kind: str, method: str) -> None:
    one = run(kind, method=method)
    own = run(kind, method=method, rtol=RTOL, atol=ATOL)
    assert abs(own.y[0, -1] / 1e-9 - np.exp(-1)) < 1e-9
    assert own.nfev < one.nfev / 2
    # One number for all, however it is given, has the same bits.
    same = run(kind, method=method, rtol=np.full(3, 1e-10), atol=[1e-12])
    assert (same.y == one.y).all() and (same.t == one.t).all()
    # A number beside a list is meant for each.
    mixed = run(kind, method=method, rtol=[1e-10] * 3, atol=ATOL)
    assert (mixed.y == run(kind, method=method, atol=ATOL).y).all()


def test_a_tight_component_is_tight() -> None:
    """The mean of the errors hides none that has a tolerance of its own."""
    loose = stickslip.system(TEXT).solve(rtol=1e-3, atol=1e-3)
    tight = stickslip.system(TEXT).solve(rtol=1e-3, atol=[1e-3, 1e-14, 1e-14])
    exact = np.array([np.sin(50.0), np.cos(50.0)])
    assert np.abs(loose.y[1:, -1] - exact).max() > 1e-4
    assert np.abs(tight.y[1:, -1] - exact).max() < 1e-2
    assert tight.nfev > loose.nfev


def test_many_runs_have_them_too() -> None:
    pytest.importorskip("xarray")
    start = {"x": [1e-9, 2e-9]}
    found = stickslip.solve_many(stickslip.system(TEXT), initial=start, rtol=RTOL, atol=ATOL)
    alone = run("text", rtol=RTOL, atol=ATOL)
    assert (found.end_state.values[0] == alone.y[:, -1]).all()


def test_equations_that_jump_and_derivatives() -> None:
    text = TEXT.replace("x' = -x", "x' = -rate*(if t < 0.5 then x else 2*x)")
    system = stickslip.system("parameter rate = 1\n" + text)
    found = system.solve(rtol=RTOL, atol=ATOL)
    assert abs(found.y[0, -1] / 1e-9 - np.exp(-1.5)) < 1e-9
    by = found.sensitivities("rate")
    assert abs(by.y_by[-1, 0, 0] / 1e-9 + 1.5 * np.exp(-1.5)) < 1e-8


@pytest.mark.parametrize("kind", ["text", "recorded", "sampled", "surface"])
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rtol": [1e-3, 1e-4]}, "rtol has shape (2,); expected a number, or one for each of 3"),
        ({"atol": [[1e-3, 1e-4, 1e-5]]}, "atol has shape (1, 3)"),
        ({"atol": [1e-3, 0.0, 1e-5]}, "atol = 0.0"),
        ({"rtol": [1e-3, 1e-4, 2.0]}, "rtol = 2.0"),
        ({"rtol": [1e-3, 1e-4, np.nan]}, "rtol = NaN"),
        ({"rtol": []}, "rtol has shape (0,)"),
        ({"atol": np.inf}, "atol = inf"),
    ],
)
def test_bad_tolerances_are_named(kind: str, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        run(kind, **options)


def test_a_family_has_one_for_all() -> None:
    ball = stickslip.system(
        "parameter h = 1, e = 0.5\nstate x = h, v = 0\nx' = v\nv' = -1\n"
        "when x < 0\n  v := -e*v\nend = 2"
    )
    with pytest.raises(ValueError, match=re.escape("rtol has shape (2,); expected a number")):
        stickslip.HybridFamily.of(ball, "h", "e", rtol=[1e-3, 1e-4])  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["text", "recorded", "sampled", "surface"])
def test_steps_are_limited(kind: str) -> None:
    found = run(kind, max_steps=5)
    assert found.outcome == "step_limit" and not found.success and found.t[-1] < 1.0
    assert run(kind, max_steps=100_000).success
    with pytest.raises(ValueError, match="max_steps = 0; expected 1 or above"):
        run(kind, max_steps=0)
