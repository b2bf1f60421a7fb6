"""Systems of formulas, from texts."""

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import stickslip

EXAMPLES = Path(__file__).parents[2] / "examples" / "systems"
BALL = """
parameter g = 9.81 in 1:20, e = 0.5
state x = 4.905, v = 0
x' = v
v' = -g
when x < 0 "bounce"
  x := 0
  v := -e*v
end = 2.9
"""


def test_a_ball_bounces() -> None:
    ball = stickslip.system(BALL)
    found = ball.solve(t_eval=[0.0, 0.5, 1.5], dense_output=True)
    assert found.decided and found.success and found.outcome == "reached_end"
    np.testing.assert_allclose(found.t_events[0], [1, 2, 2.5, 2.75, 2.875], atol=1e-12)
    np.testing.assert_allclose(found.y[0], [4.905, 0.75 * 4.905, 0.25 * 4.905], atol=1e-10)
    assert found.sol is not None
    np.testing.assert_allclose(found.sol(0.5), found.y[:, 1], atol=1e-12)
    assert (ball.parameters, ball.ranges) == ({"g": 9.81, "e": 0.5}, {"g": (1.0, 20.0)})
    assert (ball.components, ball.modes) == (["x", "v"], ["main"])


def test_starts_and_parameters_are_replaced() -> None:
    ball = stickslip.system(BALL)
    found = ball.solve((1.0, 1.5), [1.0, 0.0], parameters={"g": 2.0})
    assert (found.t[0], found.t[-1]) == (1.0, 1.5)
    np.testing.assert_allclose(found.y[:, -1], [0.75, -1.0], atol=1e-12)
    with pytest.raises(ValueError, match="'h' is no parameter; expected one of g, e"):
        ball.solve(parameters={"h": 1.0})
    with pytest.raises(ValueError, match="number of components = 1"):
        ball.solve(y0=[1.0])
    with pytest.raises(ValueError, match="expected an end after"):
        ball.solve((1.0, 0.0))
    with pytest.raises(ValueError, match="mode = 'slip'"):
        ball.solve(mode="slip")
    with pytest.raises(ValueError, match="no end and no rule"):
        stickslip.system("state x = 0\nx' = 1").solve()


def test_points_are_those_of_a_callable() -> None:
    found = stickslip.system("state x = 1, v = 0\nx' = v\nv' = -x\nend = 10").solve()
    other = stickslip.solve(lambda _, y: [y[1], -y[0]], (0.0, 10.0), [1.0, 0.0])
    np.testing.assert_array_equal(found.t, other.t)
    np.testing.assert_array_equal(found.y, other.y)


def test_a_narrow_dip_is_found() -> None:
    """The guard is decided: samples miss it."""
    text = "state x = 0\nx' = 1\nwhen 0.5 - exp(-((t - 7.123)/0.03)^2) crosses 0\nend = 10"
    found = stickslip.system(text).solve()
    half = 0.03 * math.sqrt(math.log(2))
    np.testing.assert_allclose(found.events["time"], [7.123 - half, 7.123 + half], atol=1e-12)


def test_modes_and_labels() -> None:
    belt = stickslip.read(EXAMPLES / "belt.slip")
    found = belt.solve(dense_output=True)
    assert found.event_names == ["breaks away", "stops"]
    assert found.t_events[0][0] == pytest.approx(2.0, abs=1e-12)
    assert found.events["from"].tolist()[:3] == ["stick", "slip", "stick"]
    assert found.mode[0] == "stick" and found.sol is not None
    assert found.sol.mode([1.0, 3.0]).tolist() == ["stick", "slip"]
    slow = belt.solve(parameters={"belt": 0.25})
    assert slow.t_events[0][0] == pytest.approx(4.0, abs=1e-11)
    again = belt.solve((2.0, 3.0), [1.0, 0.5], "slip")
    assert again.y[0, -1] == pytest.approx(0.6 + 0.4 * math.cos(1) + 0.5 * math.sin(1))


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.slip")), ids=lambda path: path.stem)
def test_examples_keep_their_text(path: Path) -> None:
    one = stickslip.read(path)
    for other in (stickslip.system(one.text), pickle.loads(pickle.dumps(one))):
        found, again = one.solve(), other.solve()
        assert found.decided
        np.testing.assert_array_equal(found.events["time"], again.events["time"])
        np.testing.assert_array_equal(found.y, again.y)


def test_mistakes_have_a_place() -> None:
    with pytest.raises(ValueError, match=r"line 2, column 7: `y` is not known"):
        stickslip.system("state x = 1\nx' = -y")
    with pytest.raises(FileNotFoundError):
        stickslip.read("nowhere.slip")
    with pytest.raises(stickslip.ComputationError):
        stickslip.system("state x = 1\nx' = x^2\nend = 2").solve()


def test_a_text_slides_and_comes_to_rest() -> None:
    belt = stickslip.system(
        "parameter belt = 0.5\nstate x = -0.3, v = belt\nx' = v\nv' = -x - 0.8*sign(v - belt)\n"
        "mode move\n  sliding on v = belt\nend = 5\n"
    )
    found = belt.solve(parameters={"belt": 0.4})
    assert belt.modes[:3] == ["move_above", "move_below", "move_sliding"]
    assert found.guards == "decided"
    assert found.events["time"][1] == pytest.approx(1.1 / 0.4, rel=1e-12)
    ball = stickslip.system(
        "state x = 0.5, v = 0\nx' = v\nmode fall\n  v' = -1\n  when x < 0\n    x := 0\n"
        "    v := -0.5*v\n    rest -> lie\n    v := 0\nmode lie\n  v' = 0\nend = 6\n"
    )
    assert ball.solve().y[:, -1] == pytest.approx([0, 0], abs=1e-9)
    assert "rest -> lie" in ball.text


def test_recorded_functions_are_text_that_reads_the_same():
    found = stickslip.solve(lambda t, y: [y[1], -y[0]], (0, 2), [1.0, 0.0])
    text = found.system.text
    again = stickslip.system(text).solve((0, 2))
    assert (again.y[:, -1] == found.y[:, -1]).all() and "mode main" in text
    # A copy keeps the names, also those that no text can have.
    restored = pickle.loads(pickle.dumps(found.system))
    assert restored.modes == found.system.modes and restored.text == text
