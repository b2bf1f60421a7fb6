"""Arguments of runs, checked."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip._compiled import _count, _number, _reals

Floats: TypeAlias = NDArray[np.float64]
#: The names of methods; in small letters they mean the same.
METHODS = {"dop853": "dop853", "dopri5": "dopri5", "rk45": "dopri5"}


#: Steps of a run, unless it says otherwise.
MOST_STEPS = 10_000_000


def method_name(method: str) -> str:
    found = METHODS.get(str(method).lower())
    if found is None:
        raise ValueError(
            f'method = {method!r}; expected "dop853" or "dopri5" ("RK45"); there are no others, '
            "and no implicit ones"
        )
    return found


def span(t_span: ArrayLike) -> tuple[float, float]:
    times = _floats(t_span)
    if times is None or len(times) != 2:
        span = _reals(t_span, "t_span")
        if span.shape != (2,):
            raise ValueError(f"t_span has shape {span.shape}; expected (start, end)")
        times = span.tolist()
    start, end = times
    if not math.isfinite(start) or math.isnan(end):
        raise ValueError(f"t_span = ({start}, {end}); expected a finite start and an end")
    return start, end


def state_at_start(y0: ArrayLike) -> Floats:
    numbers = _floats(y0)
    if numbers is not None and all(map(math.isfinite, numbers)):
        return np.array(numbers)
    state = _reals(y0, "y0")
    if state.ndim != 1:
        raise ValueError(f"y0 has {state.ndim} dimensions; expected one, as in y0=[1.0]")
    if not np.isfinite(state).all():
        index = int(np.flatnonzero(~np.isfinite(state))[0])
        raise ValueError(f"component {index} of y0 is {state[index]}; expected a finite number")
    return state


def _floats(values: Any) -> list[float] | None:
    """The numbers in a list or a tuple, if these are the most common ones."""
    if type(values) not in (list, tuple) or not {float, int}.issuperset(map(type, values)):
        return None
    return [*map(float, values)]


def times_within(t_eval: ArrayLike, start: float, end: float) -> Floats:
    times = _reals(t_eval, "t_eval")
    if times.shape == (0,):
        return times
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
    tolerances: tuple[ArrayLike, ArrayLike],
    steps: tuple[float, float | None],
    most: tuple[int, int],
    components: int = 0,
) -> dict[str, Any]:
    """The settings of runs, as the native module takes them.

    tolerances: relative and absolute, each a number, or an array with one for each component. steps:
    the longest one, and the first one. most: switches, and steps. Derivatives and the size of the
    first step take the smallest tolerances.
    """
    rtol, atol, own = _tolerances(*tolerances, components)
    max_step, first_step = steps
    return {
        "method": method_name(method),
        "rtol": rtol,
        "atol": atol,
        "tolerances": own,
        "max_step": _number(max_step, "max_step"),
        "first_step": None if first_step is None else _number(first_step, "first_step"),
        "max_switches": _count(most[0], "max_switches"),
        "max_steps": _count(most[1], "max_steps"),
    }


def _tolerances(
    rtol: ArrayLike, atol: ArrayLike, components: int
) -> tuple[float, float, list[tuple[float, float]]]:
    """The smallest of each, and those of the components if they differ."""
    if type(rtol) is float and type(atol) is float:
        return rtol, atol, []
    both = {"rtol": _reals(rtol, "rtol"), "atol": _reals(atol, "atol")}
    for name, value in both.items():
        if value.size and (value == value.flat[0]).all():
            both[name] = value.reshape(-1)[0]
        elif value.shape != (components,) or not components:
            few = f", or one for each of {components} components" if components else ""
            raise ValueError(f"{name} has shape {value.shape}; expected a number{few}")
    pairs = np.stack(np.broadcast_arrays(*both.values()), axis=-1).tolist()
    own = [] if isinstance(pairs[0], float) else [(one, other) for one, other in pairs]
    return float(both["rtol"].min()), float(both["atol"].min()), own
