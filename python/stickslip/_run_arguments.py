"""Arguments of runs, checked."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip._compiled import _count, _number, _reals

Floats: TypeAlias = NDArray[np.float64]
#: The names of methods; in small letters they mean the same.
METHODS = {"dop853": "dop853", "dopri5": "dopri5", "rk45": "dopri5"}


def method_name(method: str) -> str:
    found = METHODS.get(str(method).lower())
    if found is None:
        raise ValueError(
            f'method = {method!r}; expected "dop853" or "dopri5" ("RK45"); there are no others, '
            "and no implicit ones"
        )
    return found


def span(t_span: ArrayLike) -> tuple[float, float]:
    span = _reals(t_span, "t_span")
    if span.shape != (2,):
        raise ValueError(f"t_span has shape {span.shape}; expected (start, end)")
    start, end = map(float, span)
    if not np.isfinite(start) or np.isnan(end):
        raise ValueError(f"t_span = ({start}, {end}); expected a finite start and an end")
    return start, end


def state_at_start(y0: ArrayLike) -> Floats:
    state = _reals(y0, "y0")
    if state.ndim != 1:
        raise ValueError(f"y0 has {state.ndim} dimensions; expected one, as in y0=[1.0]")
    if not np.isfinite(state).all():
        index = int(np.flatnonzero(~np.isfinite(state))[0])
        raise ValueError(f"component {index} of y0 is {state[index]}; expected a finite number")
    return state


def times_within(t_eval: ArrayLike, start: float, end: float) -> Floats:
    times = _reals(t_eval, "t_eval")
    if times.ndim != 1:
        raise ValueError(f"t_eval has {times.ndim} dimensions; expected one")
    low, high = min(start, end), max(start, end)
    if not ((times >= low) & (times <= high)).all():
        raise ValueError(f"t_eval leaves t_span = ({start}, {end})")
    steps = np.diff(times) * (1.0 if end >= start else -1.0)
    if (steps < 0.0).any():
        raise ValueError("t_eval is not sorted in the direction of t_span")
    return times


def settings_of(
    method: str,
    rtol: float,
    atol: float,
    max_step: float,
    first_step: float | None,
    max_switches: int,
) -> dict[str, Any]:
    """The settings of runs, as the native module takes them."""
    return {
        "method": method_name(method),
        "rtol": _number(rtol, "rtol"),
        "atol": _number(atol, "atol"),
        "max_step": _number(max_step, "max_step"),
        "first_step": None if first_step is None else _number(first_step, "first_step"),
        "max_switches": _count(max_switches, "max_switches"),
    }
