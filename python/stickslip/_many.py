"""Many runs of one system: over arrays of parameters and of initial values, on all threads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip._arrays import real
from stickslip._blocks import Chunks, aligned, block_shape
from stickslip._compiled import Function
from stickslip._libraries import library
from stickslip._recorded import Recorded
from stickslip._run_arguments import MOST_STEPS, settings_of, span, state_at_start, times_within
from stickslip._symbols import CannotRecord
from stickslip._systems import HybridSystem, Mode
from stickslip._progress import Progress, Report, reported
from stickslip._collisions import _threads
from stickslip._formulas import FormulaSystem
from stickslip._hybrid import _arguments, _event_list, _Table

if TYPE_CHECKING:
    from collections.abc import Iterable

    from xarray import DataArray, Dataset

#: Runs at which formulas are compared with their functions.
_COMPARED = 3

#: Runs of a block with chunks = "auto".
_BLOCK = 1 << 14

#: The type of the longest word for how a run ended.
_OUTCOME = "U14"


def solve_many(
    system: FormulaSystem | HybridSystem | Function,
    t_span: ArrayLike | None = None,
    y0: ArrayLike | None = None,
    mode: str | Mode | None = None,
    *,
    parameters: Mapping[str, ArrayLike | DataArray] | None = None,
    initial: Mapping[str, ArrayLike | DataArray] | None = None,
    events: Function | Iterable[Function] | None = None,
    args: tuple[Any, ...] = (),
    method: str = "dop853",
    rtol: ArrayLike = 1e-10,
    atol: ArrayLike = 1e-12,
    t_eval: ArrayLike | None = None,
    max_step: float = np.inf,
    first_step: float | None = None,
    max_switches: int = 10_000_000,
    max_steps: int = MOST_STEPS,
    chunks: Chunks | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Dataset:
    """Runs a system for every combination of parameters and initial values.

    system: a `FormulaSystem`; or functions, as for `solve`, which are recorded: they get the
    parameters in their order after t and y, and before args. t_span, y0 and mode may be left out of
    a `FormulaSystem`, which has its own.

    parameters: by name, each a number, a one-dimensional array, or a DataArray. An array makes a
    dimension with the name; a DataArray has its own dimensions, and what shares one is taken
    together along it. initial: components of the state at the start, likewise; those of functions
    are called y0, y1, and so on.

    t_eval: sorted times at which the state is wanted too. chunks: without it, the runs are made
    here and now. With it, the result is lazy, on Dask, and has no events: "auto", a number for
    every dimension, or a number for each by name (whole where none is given, or -1). threads: 1 to
    1024; without it, one for each core here, and one where it is lazy. Results have the same bits
    with any number and any chunks. The rest is as in `solve`.

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
    library("xarray", "for solve_many")
    import xarray as xr

    given = dict(parameters or {})
    start, end = (None, None) if t_span is None else span(t_span)
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
        place *= recorded.width
        state = np.append(state, table.variables.flat)
        made, base = recorded.system, [0.0] * len(names)
    components = made.components
    steps, most = (max_step, first_step), (max_switches, max_steps)
    settings = settings_of(method, (rtol, atol), steps, most, len(components))
    unknown = [name for name in initial or {} if name not in components]
    if unknown:
        raise ValueError(f"initial: {unknown[0]!r} is no component; expected one of {components}")
    both = [name for name in initial or {} if name in given]
    if both:
        raise ValueError(f"{both[0]!r} is given as a parameter and as an initial value")
    arrays = {name: _array(name, value) for name, value in {**given, **(initial or {})}.items()}
    if state is not None and state.size != len(components):
        raise ValueError(f"y0 has {state.size} components; expected {len(components)}")
    times = None
    if t_eval is not None:
        low, high = (-np.inf if start is None else start, np.inf if end is None else end)
        times = times_within(t_eval, low, high)
    runs = _Runs(
        made,
        base,
        {name: names.index(name) for name in given},
        {name: components.index(name) for name in initial or {}},
        state,
        (place, start),
        end,
        settings,
        times,
    )
    whole = xr.broadcast(*arrays.values()) if arrays else []
    dims = tuple(map(str, whole[0].dims)) if arrays else ()
    shape = tuple(whole[0].shape) if arrays else ()
    flat = {name: np.ravel(one.to_numpy()) for name, one in zip(arrays, whole, strict=True)}
    if recorded is not None:
        _compare(recorded, *runs.rows(flat, int(np.prod(shape, dtype=int))), runs)
    if chunks is not None:
        return runs.lazy(arrays, (dims, shape), chunks, threads)
    with reported(progress, "solve_many") as report:
        found = runs.compute(flat, int(np.prod(shape, dtype=int)), _threads(threads), report)
    return runs.dataset(found, (dims, shape), arrays)


@dataclass(frozen=True)
class _Runs:
    """What many runs have in common."""

    system: FormulaSystem
    #: The values of all parameters, and the places of those that are given.
    base: list[float]
    parameters: dict[str, int]
    #: The places of components that are given.
    initial: dict[str, int]
    #: The state at the start, unless it is that of the system.
    state: Any
    begin: tuple[int | None, float | None]
    end: float | None
    settings: dict[str, Any]
    times: NDArray[np.float64] | None

    def rows(self, flat: Mapping[str, Any], count: int) -> tuple[Any, Any]:
        """The parameters of each run, and its state at the start, if that is not the system's."""
        rows = np.tile(np.array(self.base, dtype=float), (count, 1))
        for name, place in self.parameters.items():
            rows[:, place] = flat[name]
        n = len(self.system.components)
        if self.state is not None:
            states = np.tile(self.state, (count, 1))
        elif not self.initial:
            return rows, None
        elif len(self.initial) < n:
            # The others are those of the system, which may depend on parameters.
            states = np.array(self.system._native.starts(rows)).reshape(count, n)
        else:
            states = np.empty((count, n))
        for name, place in self.initial.items():
            states[:, place] = flat[name]
        return rows, states

    def compute(
        self, flat: Mapping[str, Any], count: int, threads: int, report: Report | None = None
    ) -> dict[str, Any]:
        """Makes so many runs."""
        rows, states = self.rows(flat, count)
        times = None if self.times is None else self.times.tolist()
        system, begin, end = self.system._native, self.begin, self.end
        return _native.run_many(
            system, rows, states, begin, end, self.settings, times, threads, report
        )

    def results(self, found: dict[str, Any]) -> dict[str, tuple[tuple[str, ...], Any]]:
        """What is known of each run, with further dimensions."""
        count, n = found["t"].size, len(self.system.components)
        modes = np.array([*self.system.modes, ""])
        results: dict[str, Any] = {
            "end_time": ((), found["t"]),
            "end_state": (("component",), found["y"].reshape(count, n)),
            "end_mode": ((), modes[found["modes"]]),
            "outcome": ((), np.array(found["outcomes"], dtype=_OUTCOME)),
            "event_count": ((), found["counts"]),
            "decided": ((), found["decided"]),
        }
        if self.times is not None:
            samples = found["samples"].reshape(count, self.times.size, n)
            results["state"] = (("time", "component"), samples)
        return results

    def coordinates(self, arrays: Mapping[str, DataArray]) -> dict[str, Any]:
        coordinates: dict[str, Any] = {**arrays, "component": self.system.components}
        return coordinates if self.times is None else {**coordinates, "time": self.times}

    def dataset(
        self,
        found: dict[str, Any],
        axes: tuple[tuple[str, ...], tuple[int, ...]],
        arrays: Mapping[str, DataArray],
    ) -> Dataset:
        """What was found, with the events of all runs one after another."""
        import xarray as xr

        dims, shape = axes
        variables = {
            name: ((*dims, *more), values.reshape((*shape, *values.shape[1:])))
            for name, (more, values) in self.results(found).items()
        }
        n, modes = len(self.system.components), np.array([*self.system.modes, ""])
        labels = [rules for _, rules in self.system._native.modes()]
        pairs = zip(found["event_from"].tolist(), found["event_guards"].tolist(), strict=True)
        guards = np.array([labels[mode][guard] for mode, guard in pairs], dtype=str)
        variables |= {
            "event_run": (("event",), found["event_runs"]),
            "event_time": (("event",), found["event_times"]),
            "event_guard": (("event",), guards),
            "event_from": (("event",), modes[found["event_from"]]),
            "event_to": (("event",), modes[found["event_to"]]),
            "event_before": (("event", "component"), found["event_before"].reshape(-1, n)),
            "event_after": (("event", "component"), found["event_after"].reshape(-1, n)),
        }
        failures = [f"run {index}: {message}" for index, message in found["failures"]]
        attributes = {"stickslip_version": _native.version(), "failures": failures}
        return xr.Dataset(variables, self.coordinates(arrays), attributes)

    def lazy(
        self,
        arrays: Mapping[str, DataArray],
        axes: tuple[tuple[str, ...], tuple[int, ...]],
        chunks: Chunks,
        threads: int | None,
    ) -> Dataset:
        """The same without events, on Dask. A task holds only its part of each array."""
        library("dask.array", "for chunks")
        import dask.array as da
        import xarray as xr

        dims, shape = axes
        if not dims:
            raise ValueError("chunks: nothing varies; expected an array of a parameter")
        most = dict(zip(dims, block_shape(dims, shape, chunks, _BLOCK), strict=True))
        pairs: list[Any] = []
        for array in arrays.values():
            sizes = tuple(most[str(dim)] for dim in array.dims)
            pairs += [da.from_array(array.to_numpy(), chunks=sizes), array.dims]  # type: ignore[no-untyped-call]
        own = {name: array.dims for name, array in arrays.items()}
        nothing = {name: np.empty(0) for name in arrays}
        empty = self.results(self.compute(nothing, 0, 1))
        fields = np.dtype(
            [(name, values.dtype, values.shape[1:]) for name, (_, values) in empty.items()]
        )
        blocks: Any = da.blockwise(  # type: ignore[no-untyped-call]
            _block, dims, *pairs, runs=self, own_dims=own, dims=dims, fields=fields,
            threads=1 if threads is None else _threads(threads),
            concatenate=True, align_arrays=False, dtype=fields,
            meta=np.empty((0,) * len(dims), fields),
        )  # fmt: skip
        variables = {}
        for name, (more, values) in empty.items():
            further = values.shape[1:]
            variables[name] = (
                (*dims, *more),
                da.map_blocks(  # type: ignore[no-untyped-call]
                    _field, blocks, name, dtype=values.dtype,
                    new_axis=list(range(len(dims), len(dims) + len(further))) or None,
                    chunks=(*blocks.chunks, *((size,) for size in further)),
                    meta=np.empty((0,) * (len(dims) + len(further)), values.dtype),
                ),
            )  # fmt: skip
        attributes = {"stickslip_version": _native.version()}
        return xr.Dataset(variables, self.coordinates(arrays), attributes)


def _block(
    *parts: Any,
    runs: _Runs,
    own_dims: Mapping[str, tuple[Any, ...]],
    dims: tuple[str, ...],
    fields: np.dtype[Any],
    threads: int,
) -> NDArray[np.void]:
    """The results of the runs of a block."""
    named = zip(own_dims.items(), parts, strict=True)
    arrays = {name: aligned(part, own, dims) for (name, own), part in named}
    shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    flat = {name: np.broadcast_to(array, shape).ravel() for name, array in arrays.items()}
    found = runs.results(runs.compute(flat, int(np.prod(shape, dtype=int)), threads))
    block = np.empty(shape, fields)
    for name, (_, values) in found.items():
        block[name] = values.reshape((*shape, *values.shape[1:]))
    return block


def _field(block: NDArray[np.void], name: str) -> NDArray[Any]:
    return block[name]


def _mode_of(system: FormulaSystem, mode: str | Mode) -> int:
    if mode not in system.modes:
        raise ValueError(f"mode = {mode!r}; expected one of {system.modes}")
    return system.modes.index(str(mode))


def _array(name: str, value: Any) -> DataArray:
    import xarray as xr

    if isinstance(value, xr.DataArray):
        array = value.astype(float)
    else:
        plain = real(name, value)
        if plain.ndim > 1:
            raise ValueError(
                f"{name} has {plain.ndim} dimensions; expected a number, an array of one dimension, "
                "or a DataArray"
            )
        array = xr.DataArray(plain, dims=[name] * plain.ndim)
    if not np.isfinite(array.to_numpy()).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return array


def _compare(recorded: Recorded, rows: Any, states: Any, runs: _Runs) -> None:
    """Compares formulas with their functions at some runs."""
    places = sorted({0, len(rows) // 2, len(rows) - 1})[:_COMPARED] if len(rows) else []
    for place in places:
        values = tuple(rows[place].tolist())
        state = None if states is None else states[place].tolist()
        try:
            recorded.compare_start(values)
            begin = (None, runs.begin[1], state)
            native = recorded.system._native
            nothing = np.empty(0)
            given = (list(values), begin, runs.end, runs.settings)
            found = native.run(*given, nothing, False, compared=True)
            recorded.compare(found, values)
        except CannotRecord as reason:
            raise ValueError(f"many runs are those of formulas, but {reason}") from None
        except _native.ComputationError:
            continue
