"""Expressions of SymPy."""

import numpy as np
import pytest
import sympy

import stickslip

x, v, t, w = sympy.symbols("x v t w")


def test_a_pendulum_of_expressions_is_that_of_a_function() -> None:
    swing = stickslip.from_sympy(sympy.ImmutableMatrix([v, sympy.cos(w * t) - sympy.sin(x)]), [x, v], t, [w])
    floor = stickslip.from_sympy(x - sympy.Rational(1, 2), [x, v], t, [w])
    by_hand = stickslip.solve(
        lambda t, y, w: [y[1], np.cos(w * t) - np.sin(y[0])],
        (0, 9),
        [1.0, 0.0],
        events=lambda t, y, w: y[0] - 0.5,
        args=(1.5,),
    )
    found = stickslip.solve(swing, (0, 9), [1.0, 0.0], events=floor, args=(1.5,))
    assert found.guards == by_hand.guards == "decided"
    assert len(found.t_events[0]) > 1
    np.testing.assert_allclose(found.t_events[0], by_hand.t_events[0], rtol=1e-12)


@pytest.mark.parametrize(
    "expression",
    [
        sympy.Piecewise((x, x > 0), (-2 * x, True)),
        sympy.Abs(x) + sympy.sign(v) * sympy.Max(x, v, 0) - sympy.Min(x, 1),
        sympy.atan2(x, v) + sympy.sqrt(1 + x**2) + sympy.exp(-(v**2)) * sympy.tanh(x),
        x**3 + 2**x + sympy.log(2 + x**2) + sympy.pi * sympy.erf(v) + sympy.floor(3 * x),
        sympy.sinh(x) + sympy.cosh(v) + sympy.asinh(x) + sympy.Mod(v, 2),
        sympy.Integer(3),
    ],
)
def test_what_sympy_has_is_recorded(expression: sympy.Expr) -> None:
    function = stickslip.from_sympy([expression, v], [x, v])
    formulas = stickslip.recorded(function, 2)
    recorded = stickslip.system(
        "state y0 = 0, y1 = 0\n" + "\n".join(formulas[:-2]) + f"\ny0' = {formulas[-2]}\ny1' = 0\n"
    )
    assert recorded.text
    for state in ([0.3, -0.7], [-1.2, 0.4], [2.5, 1.5]):
        # A step so short that only the derivative at its start counts.
        step = recorded.solve((0.0, 1e-9), state, rtol=1e-12, atol=1e-15)
        slope = (step.y[0, -1] - state[0]) / 1e-9
        exact = float(expression.subs({x: state[0], v: state[1]}).evalf())
        assert slope == pytest.approx(exact, rel=1e-5, abs=1e-5)


def test_what_is_no_function_of_the_state_is_refused() -> None:
    with pytest.raises(ValueError, match="contains g; expected x, v alone"):
        stickslip.from_sympy([v, -sympy.Symbol("g")], [x, v])
    with pytest.raises(ValueError, match=r"contains .*x\(t\)"):
        stickslip.from_sympy([sympy.Function("x")(t)], [x], t)
    with pytest.raises(ValueError, match="each one once"):
        stickslip.from_sympy([v], [v, v])
