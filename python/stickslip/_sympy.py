"""Expressions of SymPy as functions of time, state and parameters."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from typing import Any


def from_sympy(
    expressions: Any, y: Sequence[Any], t: Any = None, parameters: Sequence[Any] = ()
) -> Callable[..., Any]:
    """A function f(t, y, *parameters) of expressions of SymPy, for `solve` and for modes.

    expressions: one expression, which f returns as a number, or a sequence or a column of them. y:
    the symbols of the components, in order. t: the symbol of the time, if they contain it.
    parameters: the symbols of further arguments.

    `solve` records the function as the formulas that it is made of. It is called with numpy
    otherwise. Raises ValueError if an expression contains another symbol or a function of the time
    such as x(t), and ImportError without SymPy.

    >>> import stickslip, sympy
    >>> x, v, g = sympy.symbols("x v g")
    >>> fall = stickslip.from_sympy([v, -g], [x, v], parameters=[g])
    >>> floor = stickslip.from_sympy(x, [x, v], parameters=[g])
    >>> found = stickslip.solve(fall, (0, 2), [4.905, 0], events=floor, parameters={"g": 9.81})
    >>> found.guards
    'decided'
    >>> bool(abs(found.t_events[0][0] - 1) < 1e-12)
    True
    """
    sympy = importlib.import_module("sympy")
    many = hasattr(expressions, "__len__")
    given = [sympy.sympify(it) for it in (expressions if many else [expressions])]
    symbols = [*y, *([] if t is None else [t]), *parameters]
    known = set(symbols)
    if len(known) < len(symbols):
        raise ValueError(f"the symbols are {symbols}; expected each one once")
    for expression in given:
        functions = expression.atoms(sympy.core.function.AppliedUndef)
        unknown = (expression.free_symbols | functions) - known
        if unknown:
            names = ", ".join(sorted(map(str, unknown)))
            names_known = ", ".join(map(str, symbols))
            raise ValueError(f"{expression} contains {names}; expected {names_known} alone")
    time = sympy.Dummy("t") if t is None else t
    function: Callable[..., Any] = sympy.lambdify(
        (time, tuple(y), *parameters), given if many else given[0], modules="numpy", cse=True
    )
    return function
