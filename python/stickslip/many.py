"""Many runs of one system: over arrays of parameters and of initial values, on all threads."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import ArrayLike

from stickslip import _native
from stickslip._compiled import Function
from stickslip._recorded import Recorded
from stickslip._run_arguments import settings_of, span, state_at_start, times_within
from stickslip._symbols import CannotRecord
from stickslip._systems import HybridSystem, Mode
from stickslip.collisions import _threads
from stickslip.formulas import FormulaSystem
from stickslip.hybrid import _arguments, _event_list, _Table

if TYPE_CHECKING:
    from collections.abc import Iterable

    from xarray import DataArray, Dataset

#: Runs at which formulas are compared with their functions.
_COMPARED = 3


def solve_many(
    system: FormulaSystem | HybridSystem | Function,
    t_span: ArrayLike | None = None,
    y0: ArrayLike | None = None,
    mode: str | Mode | None = None,
    *,
    parameters: Mapping[str, Union[ArrayLike, "DataArray"]] | None = None,
    initial: Mapping[str, Union[ArrayLike, "DataArray"]] | None = None,
    events: "Function | Iterable[Function] | None" = None,
    args: tuple[Any, ...] = (),
    method: str = "dop853",
    rtol: float = 1e-10,
    atol: float = 1e-12,
    t_eval: ArrayLike | None = None,
    max_step: float = np.inf,
    first_step: float | None = None,
    max_switches: int = 10_000_000,
    threads: int | None = None,
) -> "Dataset":
    """Runs a system for every combination of parameters and initial values.

    system: a `FormulaSystem`; or functions, as for `solve`, which are recorded: they get the
    parameters in their order after t and y, and before args. t_span, y0 and mode may be left out of
    a `FormulaSystem`, which has its own.

    parameters: by name, each a number, a one-dimensional array, or a DataArray. An array makes a
    dimension with the name; a DataArray has its own dimensions, and what shares one is taken
    together along it. initial: components of the state at the start, likewise; those of functions
    are called y0, y1, and so on.

    t_eval: sorted times at which the state is wanted too. threads: 1 to 1024, or None for one for
    each core; results have the same bits with any number. The rest is as in `solve`.

    The Dataset has, over all dimensions, end_time, end_state (with the dimension component),
    end_mode, outcome (as `Solution.outcome`), event_count (-1 where a run failed), decided, and
    with t_eval state (with time and component). Events stand one after another along the dimension
    event: event_run, the place of the run in the flat array of all runs, event_time, event_guard,
    event_from and event_to (modes), event_before and event_after (states). Runs that failed are NaN
    and "failed"; the attribute failures says why.

    Raises ValueError if functions cannot be recorded, or if a name or a value is wrong.

    >>> found = solve_many(
    ...     lambda t, y, rate: [-rate * y[0]], (0, 1), [1.0], parameters={"rate": [1.0, 2.0]}
    ... )
    >>> bool(np.allclose(found.end_state.sel(component="y0"), np.exp([-1.0, -2.0])))
    True
    """
    import xarray as xr

    given = dict(parameters or {})
    start, end = (None, None) if t_span is None else span(t_span)
    settings = settings_of(method, rtol, atol, max_step, first_step, max_switches)
    state = None if y0 is None else state_at_start(y0)
    recorded: Recorded | None = None
    if isinstance(system, FormulaSystem):
        if events is not None or args:
            raise TypeError("events and args are of functions; the rules of a system are its events")
        made = system
        base = made.values({name: 0.0 for name in given})
        names = list(made.parameters)
        place = None if mode is None else _mode_of(made, mode)
    else:
        if state is None or start is None or end is None:
            raise TypeError("t_span and y0 are missing; functions have no start of their own")
        table = _Table(system, _event_list(events), _arguments(args))
        if np.isinf(end) and not table.may_end:
            raise ValueError("t_span is infinite, and no guard or event is terminal")
        names, place = list(given), table.index_of(mode)
        try:
            recorded = Recorded(table, (place, start), state, names)
        except CannotRecord as reason:
            raise ValueError(f"many runs are those of formulas, but {reason}") from None
        made, base = recorded.system, [0.0] * len(names)
    components = made.components
    unknown = [name for name in initial or {} if name not in components]
    if unknown:
        raise ValueError(f"initial: {unknown[0]!r} is no component; expected one of {components}")
    both = [name for name in initial or {} if name in given]
    if both:
        raise ValueError(f"{both[0]!r} is given as a parameter and as an initial value")
    arrays = {name: _array(name, value) for name, value in {**given, **(initial or {})}.items()}
    whole = xr.broadcast(*arrays.values()) if arrays else []
    dims = tuple(whole[0].dims) if arrays else ()
    shape = tuple(whole[0].shape) if arrays else ()
    count = int(np.prod(shape, dtype=int))
    flat = {name: np.ravel(one.to_numpy()) for name, one in zip(arrays, whole, strict=True)}
    rows = np.tile(np.array(base, dtype=float), (count, 1))
    for name in given:
        rows[:, names.index(name)] = flat[name]
    states = None
    if state is not None or initial:
        if state is not None and state.size != len(components):
            raise ValueError(f"y0 has {state.size} components; expected {len(components)}")
        states = _states(made, state, rows, (components, initial or {}, flat))
    times = None
    if t_eval is not None:
        low, high = (-np.inf if start is None else start, np.inf if end is None else end)
        times = times_within(t_eval, low, high)
    if recorded is not None:
        _compare(recorded, rows, (states, start, end), settings)
    found = _native.run_many(
        made._native,
        rows,
        states,
        (place, start),
        end,
        settings,
        None if times is None else times.tolist(),
        _threads(threads),
    )
    return _dataset(found, made, (dims, shape, arrays), times)


def _mode_of(system: FormulaSystem, mode: str | Mode) -> int:
    if mode not in system.modes:
        raise ValueError(f"mode = {mode!r}; expected one of {system.modes}")
    return system.modes.index(str(mode))


def _array(name: str, value: Any) -> "DataArray":
    import xarray as xr

    if isinstance(value, xr.DataArray):
        array = value.astype(float)
    else:
        plain = np.asarray(value, dtype=float)
        if plain.ndim > 1:
            raise ValueError(
                f"{name} has {plain.ndim} dimensions; expected a number, an array of one dimension, "
                "or a DataArray"
            )
        array = xr.DataArray(plain, dims=[name] * plain.ndim)
    if not np.isfinite(array.to_numpy()).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return array


def _states(
    system: FormulaSystem, state: Any, rows: Any, initial: tuple[list[str], Mapping[str, Any], Any]
) -> Any:
    """The state at the start of each run."""
    components, given, flat = initial
    if state is None:
        missing = [name for name in components if name not in given]
        if missing:
            # The others are those of the system, which may depend on parameters.
            own = system._native.starts(rows)
            states = np.array(own).reshape(len(rows), len(components))
        else:
            states = np.empty((len(rows), len(components)))
    else:
        states = np.tile(state, (len(rows), 1))
    for name in given:
        states[:, components.index(name)] = flat[name]
    return states


def _compare(recorded: Recorded, rows: Any, given: Any, settings: dict[str, Any]) -> None:
    """Compares formulas with their functions at some runs."""
    states, start, end = given
    places = sorted({0, len(rows) // 2, len(rows) - 1})[:_COMPARED] if len(rows) else []
    for place in places:
        values = tuple(rows[place].tolist())
        state = None if states is None else states[place].tolist()
        try:
            recorded.compare_start(values)
            begin = (None, start, state)
            found = recorded.system._native.run(list(values), begin, end, settings, [])
            recorded.compare(found, values)
        except CannotRecord as reason:
            raise ValueError(f"many runs are those of formulas, but {reason}") from None
        except _native.ComputationError:
            continue


def _dataset(
    found: dict[str, Any], system: FormulaSystem, axes: tuple[Any, Any, Any], times: Any
) -> "Dataset":
    import xarray as xr

    dims, shape, arrays = axes
    n, components = len(system.components), system.components
    modes = np.array([*system.modes, ""])
    labels = [rules for _, rules in system._native.modes()]
    pairs = zip(found["event_from"].tolist(), found["event_guards"].tolist(), strict=True)
    guards = np.array([labels[mode][guard] for mode, guard in pairs], dtype=str)
    variables: dict[str, Any] = {
        "end_time": (dims, found["t"].reshape(shape)),
        "end_state": ((*dims, "component"), found["y"].reshape(*shape, n)),
        "end_mode": (dims, modes[found["modes"]].reshape(shape)),
        "outcome": (dims, np.array(found["outcomes"], dtype=str).reshape(shape)),
        "event_count": (dims, found["counts"].reshape(shape)),
        "decided": (dims, found["decided"].reshape(shape)),
        "event_run": ("event", found["event_runs"]),
        "event_time": ("event", found["event_times"]),
        "event_guard": ("event", guards),
        "event_from": ("event", modes[found["event_from"]]),
        "event_to": ("event", modes[found["event_to"]]),
        "event_before": (("event", "component"), found["event_before"].reshape(-1, n)),
        "event_after": (("event", "component"), found["event_after"].reshape(-1, n)),
    }
    coordinates: dict[str, Any] = {**arrays, "component": components}
    if times is not None:
        samples = found["samples"].reshape(*shape, times.size, n)
        variables["state"] = ((*dims, "time", "component"), samples)
        coordinates["time"] = times
    failures = [f"run {index}: {message}" for index, message in found["failures"]]
    attributes = {"stickslip_version": _native.version(), "failures": failures}
    return xr.Dataset(variables, coordinates, attributes)
