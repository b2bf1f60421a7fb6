"""Families: systems of your own that depend on two parameters, and where their events change.

`HybridFamily` is a `HybridSystem` whose functions also get two parameters; `trace_family` finds
every curve in a window of the parameters on which the sequence of events of its runs changes.
"""

from __future__ import annotations

import graphlib
import json
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from itertools import count, pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native, _solution_pictures
from stickslip._arrays import real
from stickslip._axes import svg
from stickslip._compiled import Compiled, Function, _count, _number
from stickslip._family_atlases import (
    Cancelled,
    FamilyAtlas,
    FamilyCurve,
    FamilyLocated,
    FamilyMargin,
    FamilyRegion,
    FamilyVertex,
    Itinerary,
    TraceInterrupted,
    Unresolved,
    _label,
    _margin,
    _objects,
    _pairs,
    finished,
)
from stickslip._family_options import Effort, TraceOptions, VerifyOptions, _json, _plain
from stickslip._progress import Progress, check, reported
from stickslip._recorded import Recorded
from stickslip._shown import Shown
from stickslip._tabular import Columns, Tabular, flat
from stickslip._symbols import CannotRecord
from stickslip._systems import HybridSystem, Mode, _check_function
from stickslip._collisions import Floats, _threads
from stickslip._run_arguments import MOST_STEPS, settings_of, span, state_at_start
from stickslip._formulas import FormulaSystem
from stickslip._hybrid import MOST_RECORDED, _arguments, _callee, _Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from stickslip._orbits import Branch, Orbit, SpecialCurve, SpecialOrbit

__all__ = [
    "FamilyAtlas",
    "FamilyCurve",
    "FamilyLocated",
    "FamilyMargin",
    "FamilyRegion",
    "FamilyVertex",
    "Followed",
    "HybridFamily",
    "Itinerary",
    "MonitorZero",
    "TraceInterrupted",
    "TraceOptions",
    "Unresolved",
    "VerifyOptions",
    "trace_family",
]


#: Labels and margins count so many events, unless told otherwise.
MOST_SWITCHES = 10_000_000

_Window: TypeAlias = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class MonitorZero:
    """Where a monitor changes its sign on a boundary."""

    #: The index of the monitor.
    monitor: int
    #: The point of the boundary at or behind which it does, before the next one.
    node: int
    #: The place; None if it could not be solved for.
    point: tuple[float, float] | None


@dataclass(frozen=True, repr=False)
class Followed(Tabular, Shown):
    """One boundary, from `HybridFamily.follow`."""

    margin: FamilyMargin
    #: The itineraries on the left and on the right, seen in the direction of the boundary.
    sides: tuple[Itinerary, Itinerary]
    #: Points (x, y), shape (n, 2); a closed boundary ends with its first point.
    points: Floats
    #: Unit vectors along the boundary there, shape (n, 2).
    tangents: Floats
    #: Why it starts and ends: window-edge, window-corner, vertex, stalled (it could not go on) or
    #: limit (too many points); None if it is closed.
    ends: tuple[str, str] | None
    #: The value of each monitor at each point, shape (monitors, n).
    values: Floats
    zeros: tuple[MonitorZero, ...] = field(default=())

    _dimension = "point"

    def _columns(self) -> Columns:
        x, y = self.points.T
        along = dict(zip(("tangent_x", "tangent_y"), self.tangents.T, strict=True))
        return {"x": x, "y": y} | along | flat("monitor", self.values.T)

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the boundary with matplotlib, and the zeros of monitors.

        ax: axes to draw in, or None for new ones. line: properties of the boundary.
        """
        return _solution_pictures.followed(self, ax, line)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)


class HybridFamily:
    """A `HybridSystem` that depends on two parameters x and y.

    system: its functions get the parameters after time and state (and variables and signs, if it
    has such): f(t, y, p, q, *args). A surface of it counts as two guards: its name where it is
    reached, and where it is left upwards, and its name with a minus where it is left downwards. A
    compiled function gets them as its first two parameters, before those that `Compiled` was given. The
    functions must be functions of their arguments alone, smooth a little beyond the guards' zeros
    and a hundredth of the window beyond its edges.

    t_span, y0, mode: start and end of every run, and its state and mode at the start. start: if
    they depend on the parameters, a function start(t, y, p, q, *args) of t_span[0] and y0 that
    returns the state, the mode, or (mode, state). If it is recorded and chooses between two modes,
    the choice is an event "start", whose condition is a boundary. requires: if there is no start at
    some parameters, a function requires(t, y, p, q, *args) of t_span[0] and y0 that is negative
    there, or several, which are decided in their order. Where one is negative, the itinerary is
    "no start", and neither `start` nor the run need exist; its zero is a boundary.

    name, axes: what was traced and the names of the two parameters, for files and pictures. rtol,
    atol, max_step, first_step, guard_scale: as in `solve`; margins are as accurate as the runs. The
    method is "dop853". max_switches: itineraries are told apart up to so many events. Where events
    accumulate, there are boundaries without end, unless this is a small number: without it, atlases
    and stacks choose one from 4 to 12 if events accumulate in a run of the window, and warn; labels
    and margins have 10 000 000.

    record: as in `solve`. Recorded functions run as formulas, whose guards are decided, on all
    threads. They are compared with the functions at points of what is asked for; `reason` says why
    they are not recorded, None if they are.

    Any number of components and guards. Guards that have one name in several modes count as one
    guard, if the modes list them in one order.

    >>> ball = HybridSystem()
    >>> fly = ball.mode("fly", lambda t, y, height, restitution: [y[1], -1.0])
    >>> bounce = lambda t, y, height, restitution: [0.0, -restitution * y[1]]
    >>> fly.guard("floor", lambda t, y, height, restitution: y[0], reset=bounce)
    Mode('fly', guards: 'floor')
    >>> start = lambda t, y, height, restitution: [height, 0.0]
    >>> family = HybridFamily(ball, (0.0, 2.4), [1.0, 0.0], start=start)
    >>> str(family.label(1.0, 0.5)), str(family.label(0.6, 0.55))
    ('floor', 'floor, floor')
    """

    def __init__(
        self,
        system: HybridSystem,
        t_span: ArrayLike,
        y0: ArrayLike,
        mode: str | Mode | None = None,
        *,
        start: Function | None = None,
        requires: Function | Iterable[Function] = (),
        args: tuple[Any, ...] = (),
        name: str = "hybrid systems",
        axes: tuple[str, str] = ("x", "y"),
        rtol: float = 1e-13,
        atol: float = 1e-13,
        max_step: float = np.inf,
        first_step: float | None = None,
        max_switches: int | None = None,
        guard_scale: float | None = None,
        record: bool | None = None,
    ) -> None:
        given = {name: value for name, value in locals().items() if name != "self"}
        self._made = partial(HybridFamily, **given)
        if not isinstance(system, HybridSystem):
            hint = "; expected HybridFamily.of" if isinstance(system, FormulaSystem) else ""
            kind = type(system).__name__
            raise TypeError(f"{kind} is not a HybridSystem; a family needs guards{hint}")
        begin, end = span(t_span)
        if not end > begin:
            raise ValueError(f"t_span = ({begin}, {end}); expected an end after the start")
        state = state_at_start(y0)
        table = _Table(system, [], _arguments(args))
        counted = table.apart
        table.apart, table.conditions = False, True
        if np.isinf(end) and not table.may_end:
            raise ValueError("t_span is infinite, and no guard is terminal")
        first: tuple[None, Any, bool, None] = (None, None, False, None)
        if start is not None:
            _check_function(start, "start")
            _check_parameters(start, "start")
            callee = start if isinstance(start, Compiled) else table.transition(start, "start")
            first = (None, ("start", _callee(callee)), not isinstance(start, Compiled), None)
        conditions = _functions(requires)
        required = [(what, _callee(function)) for what, function in conditions]
        for one in system.modes:
            _check_parameters(one.right_hand_side, f"the right-hand side of mode {one.name!r}")
            for source in one._sources:
                _check_parameters(source.function, source.label)
                for guard in source.guards:
                    for what, function in (("reset", guard.reset), ("condition", guard.condition)):
                        _check_parameters(function, f"the {what} of guard {guard.name!r}")
        self._told = max_switches
        self._given: tuple[FormulaSystem, tuple[str, str], dict[str, float]] | None = None
        most = (MOST_SWITCHES if max_switches is None else max_switches, MOST_STEPS)
        settings = settings_of("dop853", (rtol, atol), (max_step, first_step), most)
        settings["guard_scale"] = (
            None if guard_scale is None else _number(guard_scale, "guard_scale")
        )
        #: The name of the family.
        self.name = _text(name, "name")
        if isinstance(axes, str) or len(axes) != 2:
            raise ValueError(f"axes = {axes!r}; expected the names of two parameters")
        #: The names of the two parameters.
        self.axes = (_text(axes[0], "axes[0]"), _text(axes[1], "axes[1]"))
        places, names = _places(system)
        # A surface has two guards: where it is reached or left upwards, and where downwards.
        names = [part for name in table.surfaces for part in (name, f"{name}-")] + names
        #: The names of the guards, in the order in which files count them.
        self.guards = tuple(names)
        first_mode = table.index_of(mode)
        self._native = _native.HybridFamily(
            table.system(places),
            table.args,
            ((first_mode, begin, state, []), first, required),
            end,
            settings,
            (self.name, list(self.axes), names),
        )
        #: Why guards are sampled; None if the functions were recorded, so that they are decided.
        self.reason: str | None = "record = False"
        self._recorded: Recorded | None = None
        self._must_record = bool(record)
        if record is None and state.size > MOST_RECORDED:
            self.reason = f"the state has more than {MOST_RECORDED} components"
        elif record is not False:
            self._callables = self._native
            try:
                if counted:
                    raise CannotRecord("guards of several modes are counted until the run ends")
                self._recorded = Recorded(
                    table,
                    (first_mode, begin),
                    state,
                    ("p", "q"),
                    beginning=start,
                    required=[function for _, function in conditions],
                )
                del settings["guard_scale"]
                self._settings = settings
                self._end = end
                front = range(self._recorded.front)
                rows = [
                    [*front, *(len(front) + place for place in row)]
                    for row in places
                    for _ in range(self._recorded.width)
                ]
                try:
                    self._native = _native.HybridFamily.of_formulas(
                        self._recorded.system._native,
                        [0, 1],
                        [0.0, 0.0],
                        end,
                        settings,
                        (self.name, list(self.axes)),
                        (names, rows),
                    )
                except ValueError as reason:
                    raise CannotRecord(str(reason)) from None
                # A start that chooses the mode is an event.
                self.guards = tuple(self._native.guards())
                self.reason = None
            except CannotRecord as reason:
                self._fall_back(str(reason))

    def _fall_back(self, reason: str) -> None:
        if self._must_record:
            raise ValueError(f"record = True, but {reason}")
        self.reason, self._recorded, self._native = reason, None, self._callables
        self.guards = tuple(self._native.guards())

    def _compare(self, x: ArrayLike, y: ArrayLike) -> None:
        """Compares formulas with their functions at up to three points, before they are used."""
        xs, ys = np.ravel(np.asarray(x, dtype=float)), np.ravel(np.asarray(y, dtype=float))
        for place in sorted({0, xs.size // 2, xs.size - 1}) if xs.size else ():
            if self._recorded is None:
                return
            values = (float(xs[place]), float(ys[place]))
            try:
                self._recorded.compare_start(values)
                try:
                    system = self._recorded.system._native
                    given = (list(values), (None, None, None), self._end, self._settings)
                    found = system.run(*given, np.empty(0), False, compared=True)
                except (ValueError, _native.ComputationError):
                    continue
                self._recorded.compare(found, values)
            except CannotRecord as reason:
                self._fall_back(str(reason))

    @classmethod
    def of(
        cls,
        system: FormulaSystem,
        x: str,
        y: str,
        *,
        parameters: Mapping[str, float] | None = None,
        end: float | None = None,
        name: str = "systems",
        rtol: float = 1e-13,
        atol: float = 1e-13,
        max_step: float = np.inf,
        first_step: float | None = None,
        max_switches: int | None = None,
    ) -> HybridFamily:
        """The family of a system of formulas over two of its parameters, by their names.

        parameters: the values of others. end: where all runs end, instead of the system's own end.
        name: what was traced, for files and pictures. The rest is as in `HybridFamily`.

        >>> import stickslip
        >>> ball = stickslip.system(\"\"\"
        ... parameter height = 1, restitution = 0.5
        ... state x = height, v = 0
        ... x' = v
        ... v' = -1
        ... when x < 0 "floor"
        ...   x := 0
        ...   v := -restitution*v
        ... end = 2.4
        ... \"\"\")
        >>> family = HybridFamily.of(ball, "height", "restitution")
        >>> str(family.label(1.0, 0.4)), str(family.label(0.6, 0.55))
        ('floor', 'floor, floor')
        """
        if not isinstance(system, FormulaSystem):
            raise TypeError(f"{type(system).__name__} is not a FormulaSystem")
        values, known = system.values(parameters), list(system.parameters)
        for axis in (x, y):
            if axis not in known:
                raise ValueError(f"{axis!r} is no parameter; expected one of {', '.join(known)}")
        if end is not None and np.isnan(_number(end, "end")):
            raise ValueError(f"end = {end!r}; expected a number")
        most = (MOST_SWITCHES if max_switches is None else max_switches, MOST_STEPS)
        settings = settings_of("dop853", (rtol, atol), (max_step, first_step), most)
        family = cls.__new__(cls)
        family._told = max_switches
        family._made = partial(
            cls.of, system, x, y, parameters=parameters, end=end, name=name, rtol=rtol, atol=atol,
            max_step=max_step, first_step=first_step, max_switches=max_switches,
        )  # fmt: skip
        family.name, family.axes = _text(name, "name"), (x, y)
        axes = [known.index(x), known.index(y)]
        last = None if end is None else float(end)
        family._native = _native.HybridFamily.of_formulas(
            system._native, axes, values, last, settings, (family.name, [x, y]), None
        )
        family.guards = tuple(family._native.guards())
        family.reason, family._recorded = None, None
        family._given = (system, (x, y), dict(parameters or {}))
        return family

    def __reduce__(self) -> Any:
        return _made_again, (self._made,)

    def _accumulation(self, window: _Window) -> tuple[int, int, int] | None:
        """In how many of how many runs events accumulate, and the events up to which they should
        be told apart, unless it is told."""
        return self._native.accumulation(window) if self._told is None else None

    def _up_to(self, events: int | None) -> _native.HybridFamily:
        """The family of an atlas, whose runs are told apart up to so many events."""
        return self._native if events is None else self._native.up_to(events)

    def _in(self, window: _Window) -> _native.HybridFamily:
        """The family of an atlas of the window."""
        return self._up_to(_events_of([self._accumulation(window)], warns=False))

    def label(self, x: float, y: float) -> Itinerary:
        """What the run with the parameters x and y does."""
        found: Itinerary = self.labels([_number(x, "x")], [_number(y, "y")], threads=1)[0]
        return found

    def labels(
        self,
        x: ArrayLike,
        y: ArrayLike,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.object_]:
        """What runs do: an array of `Itinerary`. x and y broadcast.

        threads: as in `trace_family`. progress: called now and then with the number of runs that
        are done and of all; True shows a bar on stderr.
        """
        (x, y), shape = _pairs(x, y)
        self._compare(x, y)
        with reported(progress, "labels") as report:
            found = self._native.labels(x, y, _threads(threads), report)
        return _objects([_label(one, self.guards) for one in found], shape)

    def margins(self, x: float, y: float) -> tuple[tuple[FamilyMargin, float], ...]:
        """How far the run with the parameters x and y is from other itineraries.

        Pairs of a margin and its value, in the order of the phases. Where the itinerary changes,
        one of them vanishes.
        """
        self._compare(x, y)
        _, found = self._native.margins(_number(x, "x"), _number(y, "y"))
        return tuple((_margin(one[:3], self.guards), one[3]) for one in found)

    def follow(
        self,
        x: tuple[float, float],
        y: tuple[float, float],
        between: ArrayLike,
        monitors: Sequence[Callable[[float, float], float]] = (),
        options: TraceOptions | None = None,
        *,
        progress: Progress | None = None,
    ) -> Followed | None:
        """Follows the boundary between two points in both directions, until it ends at a vertex,
        leaves the window, or closes.

        x, y: the window. between: two points with different itineraries, shape (2, 2). None if
        their itineraries are the same, or if no margin vanishes where the itinerary changes.
        monitors: functions of the two parameters whose values are recorded and whose zeros along
        the boundary are solved for; NaN says that there is no value. progress: as in
        `trace_family`.
        """
        window = (_interval(x, "x"), _interval(y, "y"))
        places = real("between", between)
        if places.shape != (2, 2) or not np.isfinite(places).all():
            raise ValueError(f"between = {between!r}; expected two points (x, y)")
        functions = list(monitors)
        for index, monitor in enumerate(functions):
            if not callable(monitor):
                raise TypeError(f"monitor {index} is of type {type(monitor).__name__}")
        self._compare(places[:, 0], places[:, 1])
        text = _json(asdict(options or TraceOptions()))
        (one, two), (three, four) = places.tolist()
        pair = ((one, two), (three, four))
        with reported(progress, f"boundary of {self.name}") as report:
            found = self._native.follow(window, text, pair, functions, report)
        if found is None:
            return None
        sides = [_label(one, self.guards) for one in found["sides"]]
        points = found["points"].reshape(-1, 2)
        values = np.array(found["values"], dtype=np.float64).reshape(len(functions), len(points))
        return Followed(
            margin=_margin(found["margin"], self.guards),
            sides=(sides[0], sides[1]),
            points=points,
            tangents=found["tangents"].reshape(-1, 2),
            ends=found["ends"],
            values=values,
            zeros=tuple(MonitorZero(*zero) for zero in found["zeros"]),
        )

    def _system(self) -> tuple[FormulaSystem, tuple[str, str], dict[str, float]]:
        """The formulas of the runs, the names of x and y there, and the values of others."""
        if self._given is not None:
            return self._given
        if self._recorded is None:
            raise ValueError(f"orbits need functions that can be recorded, but {self.reason}")
        return self._recorded.system, ("p", "q"), {}

    def orbit(
        self,
        x: float,
        y: float,
        *,
        itinerary: Sequence[str] | None = None,
        start: ArrayLike | None = None,
        mode: str | None = None,
        time: float | None = None,
        durations: ArrayLike | None = None,
        settle: float | None = None,
        near: Orbit | None = None,
        progress: Progress | None = None,
    ) -> Orbit:
        """The periodic orbit with the parameters x and y, as `FormulaSystem.orbit` finds it.

        itinerary: names of guards. Raises ValueError if functions are not recorded.
        """
        self._compare(x, y)
        system, names, values = self._system()
        both = {names[0]: _number(x, "x"), names[1]: _number(y, "y")}
        return system.orbit(
            itinerary=itinerary, start=start, mode=mode, time=time, durations=durations,
            settle=settle, near=near, parameters={**values, **both}, progress=progress,
        )  # fmt: skip

    def branch(
        self,
        orbit: Orbit,
        axis: str,
        interval: tuple[float, float],
        *,
        longest_step: float = 0.05,
        most_points: int = 2000,
        progress: Progress | None = None,
    ) -> Branch:
        """The branch of an orbit over one of `axes`, as `FormulaSystem.branch` follows it."""
        system, names, _ = self._system()
        if axis not in self.axes:
            raise ValueError(f"axis = {axis!r}; expected one of {', '.join(self.axes)}")
        return system.branch(
            orbit, names[self.axes.index(axis)], interval,
            longest_step=longest_step, most_points=most_points, progress=progress,
        )  # fmt: skip

    def curve(
        self,
        special: SpecialOrbit,
        x: tuple[float, float],
        y: tuple[float, float],
        *,
        longest_step: float = 0.05,
        progress: Progress | None = None,
    ) -> SpecialCurve:
        """The curve of a special orbit in a window, as `FormulaSystem.curve` follows it."""
        system, names, _ = self._system()
        return system.curve(special, names, x, y, longest_step=longest_step, progress=progress)

    def __repr__(self) -> str:
        return f"HybridFamily({self.name!r}, axes: {self.axes}, guards: {self.guards})"


def _made_again(make: partial[HybridFamily]) -> HybridFamily:
    return make()


def trace_family(
    family: HybridFamily,
    x: tuple[float, float],
    y: tuple[float, float],
    *,
    options: TraceOptions | None = None,
    verify: VerifyOptions | None = None,
    tolerance: float = 1e-9,
    rounds: int | None = None,
    effort: Effort = "default",
    threads: int | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> FamilyAtlas:
    """Every curve in a window of the parameters on which the itinerary of the runs changes, and the
    regions between them.

    x, y: intervals of the two parameters. options, verify: how it is traced and compared with runs.
    tolerance: the accuracy that is claimed for the curves, in the units of the parameters. rounds:
    where runs disagree with the regions, the trace looks again, in so many rounds at most.

    effort: how much is done, where options, verify and rounds do not say it. "screen" is a first
    look: half as fine a grid, a fortieth of the random runs, a fifth of those beside curves, and
    one round, after which what is in doubt stays so. "certain" has twice as fine a grid, five times as
    many runs, and twice as many rounds than the 8 of "default". `document["options"]` says which.

    What cannot be resolved is part of the atlas: `unresolved`, `findings`, and the regions in
    doubt. If anything speaks against the atlas, it says so in an AtlasWarning and in `objection`.

    threads: for recorded and compiled functions, 1 to 1024, or None for one for each core; results
    have the same bits with any number. Other functions of Python are called on this thread, one
    after the other. Their exceptions end the trace and come out as they are, with a note that has
    the parameters; NaN says that a run has no value there, and fails.

    progress(done, steps) or progress(done, steps, doing): called now and then with the steps that
    are done, those of all stages that have begun (more may come), and what is done now, in words.
    True shows a bar on stderr. cancelled(): asked every 10 ms between runs; if it is true, the
    trace ends with what was found so far, and `FamilyAtlas.resume` goes on. Both are called on the
    thread that traces. Ctrl-C raises TraceInterrupted, a KeyboardInterrupt whose `atlas` can be
    resumed too.
    """
    if not isinstance(family, HybridFamily):
        raise TypeError(f"{type(family).__name__} is not a HybridFamily")
    window, text = _survey(x, y, options, verify, tolerance, rounds, effort)
    check(progress)
    _check_calls(None, cancelled)
    family._compare(*([*interval, sum(interval) / 2.0] for interval in window))
    native = family._up_to(_events_of([family._accumulation(window)]))
    with reported(progress, f"trace of {family.name}") as report:
        found = native.trace(window, text, _threads(threads), (report, cancelled))
    return finished(found)


def _survey(
    x: tuple[float, float],
    y: tuple[float, float],
    options: TraceOptions | None,
    verify: VerifyOptions | None,
    tolerance: float,
    rounds: int | None,
    effort: Effort = "default",
) -> tuple[_Window, str]:
    """The window, and the options of an atlas as JSON."""
    usual = json.loads(_native.atlas_options(_text(effort, "effort")))
    given = {
        "trace": usual["trace"] if options is None else asdict(options),
        "tolerance": _number(tolerance, "tolerance"),
        "verify": usual["verify"] if verify is None else asdict(verify),
        "rounds": usual["rounds"] if rounds is None else _count(rounds, "rounds"),
    }
    text = json.dumps(usual | _plain(given, ""))
    window = (_interval(x, "x"), _interval(y, "y"))
    if not 0.0 < tolerance < 1e-3 * min(high - low for low, high in window):
        raise ValueError(
            f"tolerance = {tolerance}; expected above 0 and below a thousandth of the window"
        )
    return window, text


def _events_of(
    accumulations: Iterable[tuple[int, int, int] | None], *, warns: bool = True
) -> int | None:
    """How many events count in atlases where events accumulate; None if all do."""
    found = max((one for one in accumulations if one is not None), default=None)
    if found is None:
        return None
    events, runs, of = found
    if warns:
        warnings.warn(
            f"events accumulate in {runs} of {of} runs on a grid: runs are told apart up to event "
            f"{events}; max_switches chooses another number",
            UserWarning,
            stacklevel=3,
        )
    return events


def _check_calls(progress: Any, cancelled: Any) -> None:
    for name, function in (("progress", progress), ("cancelled", cancelled)):
        if function is not None and not callable(function):
            raise TypeError(f"{name} is of type {type(function).__name__}; expected a callable")


def _places(system: HybridSystem) -> tuple[list[list[int]], list[str]]:
    """The place of each guard of each mode, and the names of the places.

    Of guards that fire together the first one counts, so that places keep the order of every mode.
    """
    modes = [[guard.name for guard in mode.guard_list] for mode in system.modes]
    guards = [guard for mode in system.modes for guard in mode.guard_list]
    counted = len(modes) > 1 and any(int(guard.terminal) > 1 for guard in guards)
    order: graphlib.TopologicalSorter[str] = graphlib.TopologicalSorter()
    for names in modes:
        for name in names:
            order.add(name)
        for before, after in pairwise(names):
            order.add(after, before)
    try:
        shared = None if counted else list(order.static_order())
    except graphlib.CycleError:
        shared = None
    if shared is not None:
        return [[shared.index(name) for name in names] for names in modes], shared
    numbers = count()
    places = [[next(numbers) for _ in names] for names in modes]
    every = [guard.name for guard in guards]
    rows = zip(system.modes, modes, strict=True)
    pairs = [(mode.name, name) for mode, names in rows for name in names]
    return places, [name if every.count(name) == 1 else f"{mode}: {name}" for mode, name in pairs]


def _functions(requires: Function | Iterable[Function]) -> list[tuple[str, Function]]:
    """The conditions of a start, with what messages call them."""
    given = [requires] if callable(requires) or isinstance(requires, Compiled) else requires
    functions = [(f"requires {number}", function) for number, function in enumerate(given, 1)]
    for what, function in functions:
        _check_function(function, what)
        _check_parameters(function, what)
    return functions


def _check_parameters(function: Function | None, what: str) -> None:
    if isinstance(function, Compiled) and function.parameters is None and function._pointer:
        raise ValueError(
            f"{what} has user data of unknown length; in a family the parameters of the point come "
            "first, and its own are given as Compiled(function, parameters)"
        )


def _text(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{what} = {value!r}; expected a str")
    return value


def _interval(values: Any, what: str) -> tuple[float, float]:
    try:
        low, high = values
    except (TypeError, ValueError):
        raise ValueError(f"{what} = {values!r}; expected (low, high)") from None
    low, high = _number(low, what), _number(high, what)
    if not (np.isfinite(low) and np.isfinite(high) and low < high):
        raise ValueError(f"{what} = ({low}, {high}); expected finite numbers in ascending order")
    return low, high
