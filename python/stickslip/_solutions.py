"""What a run gives: points, events, and the state at any time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native, _solution_pictures
from stickslip._arrays import real
from stickslip._axes import Panels, svg
from stickslip._derivatives import Rerun, Sensitivities, sensitivities_of
from stickslip._libraries import library
from stickslip._names import Named
from stickslip._tabular import Columns as Table
from stickslip._tabular import Tabular, flat

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import Dataset

    from stickslip.formulas import FormulaSystem

Floats: TypeAlias = NDArray[np.float64]
Outcome: TypeAlias = Literal[
    "reached_end",
    "ended_by_guard",
    "zeno",
    "switch_limit",
    "step_limit",
    "instant_limit",
    "failed",
]


class DenseOutput:
    """The state at any time of a run, from the polynomial of each step.

    At an event it is the state after it. Outside the run it is NaN.
    """

    def __init__(self, found: dict[str, Any], names: NDArray[np.str_], start: float) -> None:
        self._segments = (found["starts"], found["sizes"], found["coefficients"])
        self._modes = np.append(found["segment_modes"].astype(np.intp), found["end_mode"])
        self._names = names
        self._end = (found["end_time"], found["end_state"])
        #: The first and the last time of the run.
        self.t_min, self.t_max = sorted((start, found["end_time"]))

    def __call__(self, t: ArrayLike) -> Floats:
        """The state, shape (n,) at a number and (n, k) at k times."""
        times = real("t", t)
        if times.ndim > 1:
            raise ValueError(f"t has {times.ndim} dimensions; expected a number or a list")
        flat = np.ascontiguousarray(times).reshape(-1)
        rows = _native.evaluate_dense(self._segments, self._end, flat)
        states: Floats = rows.reshape(flat.size, self._end[1].size).T
        return states if times.ndim else states[:, 0]

    def mode(self, t: ArrayLike) -> Any:
        """The mode at each time, or "" outside the run."""
        times = real("t", t)
        starts, sizes, _ = self._segments
        sign = -1.0 if sizes.size and sizes[0] < 0.0 else 1.0
        index = np.searchsorted(sign * starts, sign * times, side="right") - 1
        index = np.where(times == self._end[0], -1, np.maximum(index, 0))
        inside = (times >= self.t_min) & (times <= self.t_max)
        return np.where(inside, self._names[self._modes[index]], "")[()]

    def plot(
        self, ax: Panels = None, *, components: Sequence[int] | None = None, **line: Any
    ) -> list[Axes]:
        """Draws the state in time with matplotlib, coloured by mode; see `Solution.plot`."""
        return _solution_pictures.dense(self, ax, components, line)

    def __repr__(self) -> str:
        size, steps = self._end[1].size, self._segments[0].size
        return f"DenseOutput(t from {self.t_min} to {self.t_max}, {size} components, {steps} steps)"


@dataclass(frozen=True)
class Solution(Tabular):
    """What `solve` found. The names are those of SciPy's `solve_ivp` where it has them."""

    #: Times, shape (k,): of the steps, or those of `t_eval`. A run that ends early ends with its
    #: last point. Where an event changes the state, the steps have its time twice.
    t: Floats
    #: States, shape (n, k).
    y: Floats
    #: The mode at each time, shape (k,).
    mode: NDArray[np.str_]
    #: The variables at each time by their names, shape (k,), or (k, ...) for arrays.
    variables: dict[str, NDArray[np.float64]]
    #: The sides of surfaces at each time by their names, shape (k,): 1 and -1, the signs, or 0
    #: where the state slides.
    sides: dict[str, NDArray[np.int8]]
    #: The state at any time, if it was asked for.
    sol: DenseOutput | None
    #: The times of the events of each name of `event_names`.
    t_events: list[Floats]
    #: The states there, before the event changes them, each of shape (events, n).
    y_events: list[Floats]
    #: Names of `events`, and then of guards, in the order in which they were added. Guards of
    #: several modes may share a name.
    event_names: list[str]
    #: Everything that fired, in order: time, guard, mode `from` and `to`, state `before` and
    #: `after` (shape (n,)), flatness, jump and simultaneous. An error of the guard, relative to its
    #: largest value, moves the event by the error times `flatness`. `jump`: the guard jumps over
    #: zero. `simultaneous`: guards that vanish there too, a tuple of names; if nothing changes,
    #: they have fired with this one. `variables`: those after it. `sides_from` and `sides_to`, by
    #: names of surfaces, and `unique`: whether the solution could go on in this way only.
    events: NDArray[np.void]
    #: Where a guard came so close to zero that a step had to decide: time, guard, mode and the
    #: guard's value there, the margin.
    touches: NDArray[np.void]
    #: Where a guard changed its sign at a pole, and did not fire: time, guard and mode.
    poles: NDArray[np.void]
    #: Guards that crossed zero and did not act, because another one that acted before at the same
    #: instant led to a mode without them: time, guard and mode.
    preempted: NDArray[np.void]
    #: Where events accumulated and the run went on behind them: time, its error, guard, mode `from`
    #: and `to`.
    rests: NDArray[np.void]
    #: Whether all guards and events were decided. Those of callables are sampled: one that changes
    #: faster than the state may have fired unseen. A `guard_scale` helps there.
    decided: bool
    #: "decided", or "sampled: " with the reason why the functions could not be recorded.
    guards: str
    #: 0 if the end was reached, 1 if a guard or an event ended the run, and else -1.
    status: int
    #: The same in a word: reached_end, ended_by_guard, zeno, switch_limit, step_limit,
    #: instant_limit or failed.
    outcome: Outcome
    #: The same in a sentence.
    message: str
    #: Where the switches accumulate, if the outcome is zeno.
    accumulation: float | None
    #: Calls of right-hand sides.
    nfev: int
    #: Work of the solver, by the names of `stickslip_solver::Statistics`; empty if it failed.
    statistics: dict[str, int]
    #: The methods are explicit: no Jacobians, no factors.
    njev: int = 0
    nlu: int = 0
    #: The system of formulas that has run, and with which arguments.
    _again: Any = field(default=None, repr=False, compare=False)

    @property
    def system(self) -> FormulaSystem | None:
        """The formulas that have run: those of a text, or those of recorded functions."""
        return None if self._again is None else self._again[0]

    def sensitivities(self, *by: str) -> Sensitivities:
        """Derivatives of events and of the end by parameters, and by components at the start (y0,
        y1, … of functions), by a run with derivatives. See `FormulaSystem.sensitivities`.

        Raises ValueError if the functions were not recorded.

        >>> from stickslip import solve
        >>> found = solve(lambda t, y: [y[1], -9.81], (0, 2), [4.905, 0.0], events=lambda t, y: y[0])
        >>> found.sensitivities("y0").t_by[0].round(9).tolist()
        [0.101936799]
        """
        if self._again is None:
            raise ValueError(
                "derivatives are those of formulas, and the functions were not recorded; guards are "
                f"{self.guards}"
            )
        system, rerun = self._again
        return sensitivities_of(system, by, rerun)

    def plot(
        self, ax: Panels = None, *, components: Sequence[int] | None = None, **line: Any
    ) -> list[Axes]:
        """Draws the state in time with matplotlib: coloured by mode, with its events.

        ax: axes for each component, or one for all of them; without it, new ones. components: which
        ones, the first eight unless given. line: properties of all lines. Without `dense_output`, a
        run of formulas is repeated for the states between its steps, unless it is long. The result
        is the axes, one for each component.

        >>> from stickslip import solve
        >>> found = solve(lambda t, y: [y[1], -9.81], (0, 2), [4.905, 0.0], events=lambda t, y: y[0])
        >>> height, speed = found.plot()
        >>> height.get_ylabel(), height.get_legend().get_texts()[0].get_text()
        ('y0', 'event 0')
        """
        return _solution_pictures.solution(self, ax, components, line)

    _dimension = "time"

    @property
    def _components(self) -> list[str]:
        """The names of the components of the state."""
        known = None if self.system is None else self.system.components[: len(self.y)]
        return known or [f"y{place}" for place in range(len(self.y))]

    def _columns(self) -> Table:
        columns: Table = {"time": self.t, "mode": self.mode}
        columns |= dict(zip(self._components, self.y, strict=True))
        for name, values in self.variables.items():
            columns |= flat(name, values)
        return columns | {f"side_{name}": values for name, values in self.sides.items()}

    def to_xarray(self) -> Dataset:
        """A `xarray.Dataset` with `state` over time and component, and the mode over time;
        variables and sides, if there are any.

        Raises ImportError if xarray is not installed.
        """
        xr = library("xarray", "xarray", "for to_xarray")
        rest = {name: one for name, one in self._columns().items() if name not in self._components}
        time = rest.pop("time")
        variables = {name: ("time", one) for name, one in rest.items()}
        coordinates = {"time": time, "component": self._components}
        state = {"state": (("time", "component"), self.y.T)}
        found: Dataset = xr.Dataset(state | variables, coordinates)
        return found

    def _smooth(self, most_calls: int) -> DenseOutput | None:
        """The state at any time by another run, if this one needed no more calls."""
        if self._again is None or self.nfev > most_calls:
            return None
        system, (values, given, end, settings) = self._again
        found = system._native.run(values, given, end, settings, [])
        return DenseOutput(found, np.array(system.modes), found["start_time"])

    def _repr_svg_(self) -> str | None:
        count = min(len(self.y), _solution_pictures.MOST_PANELS)
        return svg(self.plot, count) if count else None

    @property
    def success(self) -> bool:
        """Whether the run came to a regular end: status 0 or 1."""
        return self.status >= 0

    def __getitem__(self, name: str) -> Any:
        if name not in {*self.__dataclass_fields__, "success"}:
            raise KeyError(name)
        return getattr(self, name)

    def __repr__(self) -> str:
        shape = f"y of shape {self.y.shape}, {self.events.size} events, nfev = {self.nfev}"
        return f"Solution(status={self.status}: {self.message} {shape})"


@dataclass(frozen=True)
class Names:
    """Names of modes and of the guards of each, by their numbers, and all names of guards."""

    modes: list[str]
    guards: list[list[str]]
    events: list[str]

    @cached_property
    def width(self) -> int:
        """The length of the longest name."""
        return max(1, *map(len, self.modes), *map(len, self.events))

    @cached_property
    def mode_array(self) -> NDArray[np.str_]:
        """The names of the modes."""
        return np.array(self.modes)


@cache
def _event_columns(width: int, dimension: int) -> list[Any]:
    text, state = f"U{width}", ("f8", (dimension,))
    columns: list[Any] = [("time", "f8"), ("guard", text), ("from", text), ("to", text)]
    columns += [("before", *state), ("after", *state)]
    return [*columns, ("flatness", "f8"), ("jump", "?"), ("simultaneous", "O")]


@cache
def _event_type(width: int, dimension: int) -> np.dtype[np.void]:
    return np.dtype(_event_columns(width, dimension))


@cache
def _place_types(width: int) -> tuple[np.dtype[np.void], ...]:
    """The types of touches, of poles and guards that were preempted, and of rests."""
    text = f"U{width}"
    place: list[Any] = [("time", "f8"), ("guard", text), ("mode", text)]
    rests = [place[0], ("error", "f8"), place[1], ("from", text), ("to", text)]
    return np.dtype([*place, ("margin", "f8")]), np.dtype(place), np.dtype(rests)


#: Columns by the names of variables.
Columns: TypeAlias = dict[str, NDArray[np.float64]]


def variable_columns(variables: Named) -> list[Any]:
    """The column of events for variables, if there are any."""
    shapes = variables.shapes.items()
    return [("variables", [(name, "f8", shape) for name, shape in shapes])] if variables else []


def with_variables(
    found: dict[str, Any], variables: Named | None
) -> tuple[list[Any], Columns, Columns]:
    """Takes the variables, which are the last components, out of the states that were `found`. The
    result is their column of events, their values at the points, and those behind events."""
    if not variables:
        return [], {}, {}
    held = variables.flat.size
    size = found["end_state"].size
    of: dict[str, Columns] = {}
    for name in ("y", "event_before", "event_after", "coefficients"):
        if name in found:
            rows = found[name].reshape(-1, size)
            found[name] = np.ascontiguousarray(rows[:, :-held]).reshape(-1)
            of[name] = variables.columns(rows[:, size - held :])
    found["end_state"] = found["end_state"][:-held]
    return variable_columns(variables), of["y"], of["event_after"]


def event_array(
    found: dict[str, Any], dimension: int, names: Names, extra: list[Any]
) -> NDArray[np.void]:
    """Everything that fired, in order, with room for further columns."""
    dtype = _event_type(names.width, dimension)
    if extra:
        dtype = np.dtype([*_event_columns(names.width, dimension), *extra])
    modes, guards = names.modes, names.guards
    left = found["event_from"].tolist()
    events: NDArray[np.void] = np.empty(len(left), dtype=dtype)
    if not left:
        return events
    events["time"] = found["event_times"]
    fired = zip(left, found["event_guards"].tolist(), strict=True)
    events["guard"] = [guards[mode][guard] for mode, guard in fired]
    events["from"] = [modes[mode] for mode in left]
    events["to"] = [modes[mode] for mode in found["event_to"].tolist()]
    events["before"] = found["event_before"].reshape(len(left), dimension)
    events["after"] = found["event_after"].reshape(len(left), dimension)
    events["flatness"] = found["event_flatness"]
    events["jump"] = found["event_jump"]
    together = events["simultaneous"]
    for row, others in enumerate(found["event_simultaneous"]):
        together[row] = tuple(guards[left[row]][guard] for guard in others)
    return events


def solution_of(
    found: dict[str, Any],
    events: NDArray[np.void],
    names: Names,
    *,
    start: float,
    dense: bool,
    guards: str,
    variables: dict[str, NDArray[np.float64]] | None = None,
    sides: dict[str, NDArray[np.int8]] | None = None,
    again: tuple[FormulaSystem, Rerun] | None = None,
) -> Solution:
    """The solution that the native module has found, as columns."""
    modes, labels, event_names = names.mode_array, names.guards, list(names.events)
    touching, place, resting = _place_types(names.width)
    touches = [(t, labels[mode][g], modes[mode], m) for t, mode, g, m in found["touches"]]
    poles, preempted = (
        [(t, labels[mode][guard], modes[mode]) for t, mode, guard in found[kind]]
        for kind in ("poles", "preempted")
    )
    rests = [
        (t, error, labels[left][guard], modes[left], modes[to])
        for t, error, guard, left, to in found["rests"]
    ]
    stays = found["event_from"] == found["event_to"]
    rows = _rows(events, event_names, stays, found["status"] == 1)
    return Solution(
        t=found["t"],
        y=found["y"].reshape(found["t"].size, found["end_state"].size).T,
        mode=modes[found["modes"]],
        variables=variables or {},
        sides=sides or {},
        sol=DenseOutput(found, modes, start) if dense else None,
        t_events=[events["time"][row] for row in rows],
        y_events=[events["before"][row] for row in rows],
        event_names=event_names,
        events=events,
        touches=np.array(touches, dtype=touching),
        poles=np.array(poles, dtype=place),
        preempted=np.array(preempted, dtype=place),
        rests=np.array(rests, dtype=resting),
        decided=found["decided"],
        guards=guards,
        status=found["status"],
        outcome=found["outcome"],
        message=found["message"],
        accumulation=found["accumulation"],
        nfev=found["nfev"],
        statistics=found["statistics"],
        _again=again,
    )


def _rows(
    events: NDArray[np.void], names: list[str], stays: NDArray[np.bool_], ended: bool
) -> list[NDArray[np.intp]]:
    """The rows of `events` in which each name fired, also together with another one that changes
    nothing. `stays`: whether an event stays in its mode. `ended`: whether the last one ended the
    run."""
    rows = [np.flatnonzero(events["guard"] == name) for name in names]
    for row in [row for row, others in enumerate(events["simultaneous"]) if others]:
        one = events[row]
        same = stays[row] and np.array_equal(one["before"], one["after"])
        if same and not (ended and row == events.size - 1):
            for name in one["simultaneous"]:
                index = names.index(name)
                rows[index] = np.sort(np.append(rows[index], row))
    return rows
