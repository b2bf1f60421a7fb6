"""What a run gives: points, events, and the state at any time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip._arrays import real
from stickslip._derivatives import Rerun, Sensitivities, sensitivities_of
from stickslip._libraries import library
from stickslip._names import Named
from stickslip._progress import Progress
from stickslip._tabular import Columns as Table
from stickslip._tabular import Tabular, flat

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import Dataset

    from stickslip._axes import Panels
    from stickslip._formulas import FormulaSystem

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
        from stickslip import _solution_pictures

        return _solution_pictures.dense(self, ax, components, line)

    def __repr__(self) -> str:
        size, steps = self._end[1].size, self._segments[0].size
        return f"DenseOutput(t from {self.t_min} to {self.t_max}, {size} components, {steps} steps)"


@dataclass(frozen=True)
class Beside:
    """What a run has beside its state: values at its points, columns of its events, and what is in
    these."""

    variables: dict[str, NDArray[np.float64]]
    sides: dict[str, NDArray[np.int8]]
    columns: list[Any]
    behind: dict[str, Any]


#: Of a run without variables and surfaces.
NOTHING_BESIDE = Beside({}, {}, [], {})


class Solution(Tabular):
    """What `solve` found. The names are those of SciPy's `solve_ivp` where it has them.

    What is not looked at is not made: a run of few steps takes less time than its tables.
    """

    #: "decided", or "sampled: " with the reason why the functions could not be recorded.
    guards: str
    #: The methods are explicit: no Jacobians, no factors.
    njev: int = 0
    nlu: int = 0
    #: What the native module has found, as columns.
    _found: dict[str, Any]
    _names: Names
    _start: float
    _dense: bool
    _beside: Beside
    #: The system of formulas that has run, and with which arguments.
    _again: tuple[FormulaSystem, Rerun] | None

    def __init__(
        self,
        found: dict[str, Any],
        names: Names,
        *,
        start: float,
        dense: bool,
        guards: str,
        beside: Beside | None = None,
        again: tuple[FormulaSystem, Rerun] | None = None,
    ) -> None:
        if not dense:
            for name in ("starts", "sizes", "coefficients", "segment_modes", "samples"):
                found.pop(name, None)
        self.__dict__.update(
            _found=found,
            _names=names,
            _start=start,
            _dense=dense,
            _beside=beside or NOTHING_BESIDE,
            _again=again,
            guards=guards,
        )

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a Solution cannot be changed, nor {name!r} of it")

    @property
    def t(self) -> Floats:
        """Times, shape (k,): of the steps, or those of `t_eval`. A run that ends early ends with its
        last point. Where an event changes the state, the steps have its time twice."""
        times: Floats = self._found["t"]
        return times

    @cached_property
    def y(self) -> Floats:
        """States, shape (n, k)."""
        states: Floats = self._found["y"].reshape(self.t.size, self._found["end_state"].size).T
        return states

    @cached_property
    def mode(self) -> NDArray[np.str_]:
        """The mode at each time, shape (k,)."""
        modes: NDArray[np.str_] = self._names.mode_array[self._found["modes"]]
        return modes

    @property
    def variables(self) -> dict[str, NDArray[np.float64]]:
        """The variables at each time by their names, shape (k,), or (k, ...) for arrays."""
        return self._beside.variables

    @property
    def sides(self) -> dict[str, NDArray[np.int8]]:
        """The sides of surfaces at each time by their names, shape (k,): 1 and -1, the signs, or 0
        where the state slides."""
        return self._beside.sides

    @cached_property
    def sol(self) -> DenseOutput | None:
        """The state at any time, if it was asked for."""
        if not self._dense:
            return None
        return DenseOutput(self._found, self._names.mode_array, self._start)

    @cached_property
    def _rows(self) -> list[NDArray[np.intp]]:
        """The rows of `events` in which each name fired."""
        stays = self._found["event_from"] == self._found["event_to"]
        return _rows(self.events, self.event_names, stays, self.status == 1)

    @cached_property
    def t_events(self) -> list[Floats]:
        """The times of the events of each name of `event_names`."""
        return [self.events["time"][row] for row in self._rows]

    @cached_property
    def y_events(self) -> list[Floats]:
        """The states there, before the event changes them, each of shape (events, n)."""
        return [self.events["before"][row] for row in self._rows]

    @cached_property
    def event_names(self) -> list[str]:
        """Names of `events`, and then of guards, in the order in which they were added. Guards of
        several modes may share a name."""
        return list(self._names.events)

    @cached_property
    def events(self) -> NDArray[np.void]:
        """Everything that fired, in order: time, guard, mode `from` and `to`, state `before` and
        `after` (shape (n,)), flatness, jump and simultaneous.

        An error of the guard, relative to its largest value, moves the event by the error times
        `flatness`. `jump`: the guard jumps over zero. `simultaneous`: guards that vanish there too,
        a tuple of names; if nothing changes, they have fired with this one. `variables`: those after
        it. `sides_from` and `sides_to`, by names of surfaces, and `unique`: whether the solution
        could go on in this way only."""
        found = _event_array(self._found, self._names, self._beside.columns)
        for name, values in self._beside.behind.items():
            column = found[name]
            if isinstance(values, dict):
                for part, one in values.items():
                    column[part] = one
            else:
                found[name] = values
        return found

    @cached_property
    def _places(self) -> dict[str, NDArray[np.void]]:
        """Touches, poles, preempted and rests."""
        modes, labels, found = self._names.modes, self._names.guards, self._found
        touching, place, resting = _place_types(self._names.width)
        rows = {
            "touches": [(t, labels[at][g], modes[at], m) for t, at, g, m in found["touches"]],
            "poles": [(t, labels[at][guard], modes[at]) for t, at, guard in found["poles"]],
            "preempted": [(t, labels[at][guard], modes[at]) for t, at, guard in found["preempted"]],
            "rests": [
                (t, error, labels[left][guard], modes[left], modes[to])
                for t, error, guard, left, to in found["rests"]
            ],
        }
        types = (touching, place, place, resting)
        both = zip(rows.items(), types, strict=True)
        return {name: np.array(row, dtype=dtype) for (name, row), dtype in both}

    @property
    def touches(self) -> NDArray[np.void]:
        """Where a guard came so close to zero that a step had to decide: time, guard, mode and the
        guard's value there, the margin."""
        return self._places["touches"]

    @property
    def poles(self) -> NDArray[np.void]:
        """Where a guard changed its sign at a pole, and did not fire: time, guard and mode."""
        return self._places["poles"]

    @property
    def preempted(self) -> NDArray[np.void]:
        """Guards that crossed zero and did not act, because another one that acted before at the
        same instant led to a mode without them: time, guard and mode."""
        return self._places["preempted"]

    @property
    def rests(self) -> NDArray[np.void]:
        """Where events accumulated and the run went on behind them: time, its error, guard, mode
        `from` and `to`."""
        return self._places["rests"]

    @property
    def decided(self) -> bool:
        """Whether all guards and events were decided. Those of callables are sampled: one that
        changes faster than the state may have fired unseen. A `guard_scale` helps there."""
        return bool(self._found["decided"])

    @property
    def status(self) -> int:
        """0 if the end was reached, 1 if a guard or an event ended the run, and else -1."""
        return int(self._found["status"])

    @property
    def outcome(self) -> Outcome:
        """The same in a word: reached_end, ended_by_guard, zeno, switch_limit, step_limit,
        instant_limit or failed."""
        outcome: Outcome = self._found["outcome"]
        return outcome

    @property
    def message(self) -> str:
        """The same in a sentence."""
        return str(self._found["message"])

    @property
    def accumulation(self) -> float | None:
        """Where the switches accumulate, if the outcome is zeno."""
        place: float | None = self._found["accumulation"]
        return place

    @property
    def nfev(self) -> int:
        """Calls of right-hand sides."""
        return int(self._found["nfev"])

    @property
    def statistics(self) -> dict[str, int]:
        """Work of the solver, by the names of `stickslip_solver::Statistics`; empty if it failed."""
        counts: dict[str, int] = self._found["statistics"]
        return counts

    @property
    def system(self) -> FormulaSystem | None:
        """The formulas that have run: those of a text, or those of recorded functions."""
        return None if self._again is None else self._again[0]

    def sensitivities(self, *by: str, progress: Progress | None = None) -> Sensitivities:
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
        return sensitivities_of(system, by, rerun, progress)

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
        from stickslip import _solution_pictures

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
        xr = library("xarray", "for to_xarray")
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
        found = system._native.run(values, given, end, settings, np.empty(0), True)
        return DenseOutput(found, np.array(system.modes), found["start_time"])

    def _repr_svg_(self) -> str | None:
        from stickslip import _solution_pictures
        from stickslip._axes import svg

        count = min(len(self.y), _solution_pictures.MOST_PANELS)
        return svg(self.plot, count) if count else None

    @property
    def success(self) -> bool:
        """Whether the run came to a regular end: status 0 or 1."""
        return self.status >= 0

    def __getitem__(self, name: str) -> Any:
        if name.startswith("_") or callable(getattr(Solution, name, None)):
            raise KeyError(name)
        try:
            return getattr(self, name)
        except AttributeError:
            raise KeyError(name) from None

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


def note_interruption(found: dict[str, Any]) -> None:
    """Says why a run has ended early."""
    found["message"] = f"Stopped at t = {found['end_time']!r} by Ctrl-C."


def with_variables(found: dict[str, Any], variables: Named | None) -> Beside | None:
    """Takes the variables, which are the last components, out of the states that were `found`."""
    if not variables:
        return None
    held = variables.flat.size
    size = found["end_state"].size
    of: dict[str, Columns] = {}
    for name in ("y", "event_before", "event_after", "coefficients"):
        if name in found:
            rows = found[name].reshape(-1, size)
            found[name] = np.ascontiguousarray(rows[:, :-held]).reshape(-1)
            of[name] = variables.columns(rows[:, size - held :])
    found["end_state"] = found["end_state"][:-held]
    behind = {"variables": of["event_after"]}
    return Beside(of["y"], {}, variable_columns(variables), behind)


def _event_array(found: dict[str, Any], names: Names, extra: list[Any]) -> NDArray[np.void]:
    """Everything that fired, in order, with room for further columns."""
    dimension = found["end_state"].size
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
