"""Systems of your own: piecewise-smooth ODEs of Python callables or compiled functions.

A `HybridSystem` has modes, each with a right-hand side and guards; `solve` runs it through every
switch. A plain function with events, as for SciPy's `solve_ivp`, needs no system.
"""

from __future__ import annotations

import operator
import warnings
from collections.abc import Callable, Iterable, Mapping
from copy import copy
from functools import partial
from itertools import count
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip._compiled import Compiled, Function, _number
from stickslip._progress import Progress, Report, reporting
from stickslip._recorded import Recorded, recording, watched
from stickslip._run_arguments import MOST_STEPS, settings_of, span, state_at_start, times_within
from stickslip._signatures import reads_of
from stickslip._solutions import Beside, Names, Solution, variable_columns
from stickslip._symbols import CannotRecord
from stickslip._systems import Guard, HybridSystem, Mode, _check_function, _Clock, _Source

Floats: TypeAlias = NDArray[np.float64]
#: Functions have no variables and no surfaces.
_NOTHING = HybridSystem()
#: Functions of more components are recorded on request only: numpy is faster than many formulas.
MOST_RECORDED = 200


def solve(
    system: HybridSystem | Function,
    t_span: ArrayLike,
    y0: ArrayLike,
    mode: str | Mode | None = None,
    *,
    method: str = "dop853",
    rtol: ArrayLike = 1e-10,
    atol: ArrayLike = 1e-12,
    t_eval: ArrayLike | None = None,
    dense_output: bool = False,
    events: Function | Iterable[Function] | None = None,
    max_step: float = np.inf,
    first_step: float | None = None,
    max_switches: int = 10_000_000,
    max_steps: int = MOST_STEPS,
    guard_scale: float | None = None,
    args: tuple[Any, ...] = (),
    parameters: Mapping[str, float] | None = None,
    sides: Mapping[str, int] | None = None,
    record: bool | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Runs a system from t_span[0] to t_span[1], through every switch.

    system: a `HybridSystem`, or the right-hand side f(t, y) of a smooth problem. y0: the state at
    the start, shape (n,). mode: the one at the start, if there are several. The end may lie before
    the start, unless a guard changes something, and it may be infinite if something ends the run.

    method: "dop853" (order 8) or "dopri5" (order 5, also called "RK45"). rtol: 1e-15 to 0.1, atol:
    above 0, each a number or one for each component; the error of a step is below atol + rtol |y|,
    as a root mean square over the components. t_eval: sorted times at which `t` and `y`
    are wanted, and not at all steps; an empty list keeps events only, which is fastest.
    dense_output: whether `sol` is kept.

    events: functions event(t, y) whose zeros are reported in every mode and change nothing. An
    event has the attributes that `solve_ivp` knows: terminal (bool, or a number of times) and
    direction (rising if above 0, falling if below 0); and from_zero and smooth, as a guard. If the
    system is a function, an event that is exactly 0 at the start does not fire there.

    guard_scale: the shortest time on which guards and events change, if they change faster than the
    state. max_switches, max_steps: a run that has so many events or steps stops. args: further arguments of all Python
    functions, after t and y (and after variables and signs, if the system has such). parameters:
    numbers that Python functions get before args, by names for `Solution.sensitivities`. sides: the
    sides of surfaces, 1, -1 or 0, on which a run starts where it could go on in several ways.

    record: Python functions are called once with symbols for t and y, and run as formulas whose
    events are decided, if that is possible: they do not depend on anything that changes meanwhile.
    `Solution.guards` says so, or why not; the first time that guards are sampled and there is no
    guard_scale, a SampledGuardsWarning says so too. False turns this off; with True, what cannot be
    recorded is an error. progress: called now and then with the thousandths of t_span that are done,
    and 1000; True shows a bar on stderr.

    Functions get a state of their own, which they may keep and change. Their exceptions stop the
    run and come out as they are. TypeError and ValueError name the function that returned something
    wrong, and the time. What happens to the numbers (not finite, tolerance not met, switches that
    accumulate) ends the run with status -1.

    >>> found = solve(lambda t, y: -y, (0.0, 1.0), [1.0])
    >>> round(float(found.y[0, -1]), 10)
    0.3678794412
    """
    start, end = span(t_span)
    state = state_at_start(y0)
    given = {name: _number(value, name) for name, value in (parameters or {}).items()}
    listed, further = _event_list(events), _arguments(args)
    name = mode.name if isinstance(mode, Mode) else str(mode)
    places = (*map(id, (system, *listed)), None, *map(id, further))
    key = (*places, state.size, name, *given)
    recorded = watched(key)
    table = _Table(system, listed, further) if recorded is None else recorded.table
    first = table.index_of(mode)
    if given and table.has_compiled:
        raise TypeError("parameters are those of functions of Python; expected Compiled(f, [...])")
    steps, most = (max_step, first_step), (max_switches, max_steps)
    settings = settings_of(method, (rtol, atol), steps, most, state.size)
    scale = None if guard_scale is None else _number(guard_scale, "guard_scale")
    times = None if t_eval is None else times_within(t_eval, start, end)
    if np.isinf(end) and not table.may_end:
        raise ValueError("t_span is infinite, and no guard or event is terminal")
    if end < start:
        table.refuse_changes()
    if scale is not None and not scale > 0.0:
        raise ValueError(f"guard_scale = {guard_scale}; expected a number above 0")
    begin, on = (first, start, end), table.sides(sides or {})
    dense = bool(dense_output)
    job = _Job(table, key, recorded, begin, state, settings, scale, times, dense, given)
    solution = reporting(progress, "solve", partial(_solved, job, on, record))
    if record is None and scale is None and not solution.decided:
        _warn_once(solution.guards)
    return solution


class _Job(NamedTuple):
    """A run that is to be done."""

    table: _Table
    #: What tells it apart by the places of its functions, and the formulas of these, if they are
    #: known already.
    key: Any
    recorded: Recorded | None
    #: The mode, the start and the end.
    begin: tuple[int, float, float]
    state: Floats
    settings: dict[str, Any]
    #: The shortest time on which guards change, if it is known.
    scale: float | None
    times: Floats | None
    dense: bool
    #: Values of parameters of Python functions.
    given: dict[str, float]


def _solved(job: _Job, sides: list[int], record: bool | None, report: Report | None) -> Solution:
    """Runs the formulas of a system, if it is recorded, and else its functions."""
    first, start, end = job.begin
    if record is False:
        reason = "record = False"
    elif sides:
        reason = "sides are given"
    elif record is None and job.state.size > MOST_RECORDED:
        reason = f"the state has more than {MOST_RECORDED} components; record=True records it"
    else:
        found, reason = _try_recorded(job, report)
        if found is not None:
            return found
        if record:
            raise ValueError(f"record = True, but {reason}")
    # Other threads may run the same table.
    table = copy(job.table)
    table.reason = reason
    columns = _native.run_hybrid(
        table.system(),
        (*job.given.values(), *table.args),
        (first, start, job.state, sides),
        end,
        job.settings | {"guard_scale": job.scale},
        (job.times, job.dense),
        report,
    )
    return table.solution(columns, start, job.dense)


class SampledGuardsWarning(UserWarning):
    """Guards are sampled, so that one that changes faster than the state may act unseen."""


_warned: list[str] = []


def _warn_once(reason: str) -> None:
    """Says once in a process that guards are sampled, and what helps."""
    if not _warned:
        _warned.append(reason)
        warnings.warn(
            f"guards are {reason}. One that changes faster than the state may act unseen: pass "
            "guard_scale, the shortest time on which guards change; or write functions of t and y "
            "alone with numpy, which are recorded and decided; or a text (stickslip.system). This "
            "is said once; record=False says that it is known",
            SampledGuardsWarning,
            stacklevel=3,
        )


def _try_recorded(job: _Job, report: Report | None) -> tuple[Solution | None, str]:
    """The solution of the recorded system, or why there is none."""
    first, start, end = job.begin
    if end <= start:
        return None, "the run goes backwards"
    try:
        names, values = list(job.given), list(job.given.values())
        given = (job.table, (first, start), job.state, names, values)
        found = job.recorded or recording(job.key, *given)
        state = job.state
        run = found.solve(job.begin, state, values, job.settings, job.times, job.dense, report)
        return run, ""
    except (CannotRecord, _native.ComputationError) as reason:
        return None, str(reason)


class _Table:
    """A system as the native module takes it, and what its numbers mean."""

    def __init__(
        self, system: HybridSystem | Function, events: list[Function], args: tuple[Any, ...]
    ) -> None:
        self.args = args
        #: What must live on, so that nothing else gets its place.
        self.given = (system, *events)
        #: What the system was before it was read.
        self.reads = reads_of(system) if isinstance(system, HybridSystem) else []
        #: Why the functions are not recorded.
        self.reason = ""
        #: Whether conditions of transitions are wanted.
        self.conditions = False
        self.events = [_event(event, name) for event, name in _named(events)]
        self.plain = not isinstance(system, HybridSystem)
        if isinstance(system, HybridSystem):
            owner = system
            self.system_modes = system.modes
            if not self.system_modes:
                raise ValueError("the system has no modes")
        else:
            _check_function(system, "the right-hand side")
            self.system_modes = (Mode("", system),)
            owner = _NOTHING
        self.variables, self.signs, self.surfaces = owner._variables, owner._signs, owner._sliding
        self.names = [mode.name for mode in self.system_modes]
        # Guards are counted by their place. If one ends the run when it fires again, all guards of
        # all modes have places of their own.
        guards = [guard for mode in self.system_modes for guard in mode.guard_list]
        self.apart = len(self.names) > 1 and any(int(guard.terminal) > 1 for guard in guards)
        self.event_names = [event.guards[0].name for event in self.events] + [*self.surfaces]
        for guard in guards:
            if guard.name in self.event_names[: len(self.events) + len(self.surfaces)]:
                what = "a surface" if guard.name in self.surfaces else "an event"
                raise ValueError(f"a guard and {what} are called {guard.name!r}")
            if guard.name not in self.event_names:
                self.event_names.append(guard.name)
        #: The name of each guard of each mode, by its place.
        self.places: list[list[str]] = []

    @property
    def functions(self) -> list[Any]:
        """Right-hand sides, events and guards."""
        sources = [*self.events, *(s for mode in self.system_modes for s in mode._sources)]
        given = [source.function for source in sources if source.function is not None]
        return [*(mode.right_hand_side for mode in self.system_modes), *given]

    @property
    def formed_of(self) -> tuple[Any, ...]:
        """All of which formulas are made. Those of modes are told apart by their places, too."""
        found = [self.plain, *self.args, len(self.args)]
        sources = list(self.events)
        for mode in self.system_modes:
            found += [mode.name, mode.right_hand_side, len(mode._sources)]
            sources += mode._sources
        for place, source in enumerate(sources):
            # Those of events are made for the table, and nobody can change them.
            of_event = place < len(self.events)
            rows = [tuple(vars(guard).values()) if of_event else guard for guard in source.guards]
            found += [source.function, len(rows), *rows]
        if not self.plain:
            found += [id(mode.right_hand_side) for mode in self.system_modes]
            found += [id(source.function) for source in sources]
            of_modes = sources[len(self.events) :]
            found += [id(guard) for source in of_modes for guard in source.guards]
        return tuple(found)

    @property
    def has_compiled(self) -> bool:
        """Whether a right-hand side or guards are compiled."""
        return any(isinstance(function, Compiled) for function in self.functions)

    @property
    def may_end(self) -> bool:
        sources = [*self.events, *(s for mode in self.system_modes for s in mode._sources)]
        return any(guard.terminal for source in sources for guard in source.guards)

    def index_of(self, mode: str | Mode | None) -> int:
        """The mode at the start."""
        if mode is None:
            if len(self.names) > 1:
                raise ValueError(f"mode is missing; expected one of {self.names}")
            return 0
        name = mode.name if isinstance(mode, Mode) else mode
        if self.plain:
            raise TypeError(f"mode = {name!r}, but a function has no modes; perhaps method=?")
        if name not in self.names:
            raise ValueError(f"mode = {name!r}; expected one of {self.names}")
        return self.names.index(name)

    def refuse_changes(self) -> None:
        """Refuses a run backwards through transitions."""
        if self.surfaces:
            raise ValueError(
                "t_span goes backwards, but how long a solution has slid is not known; expected an "
                "end after the start"
            )
        for mode in self.system_modes:
            for guard in mode.guard_list:
                if guard.changes:
                    raise ValueError(
                        f"t_span goes backwards, but nothing inverts what follows guard "
                        f"{guard.name!r} of mode {mode.name!r}; expected a system in -t, whose "
                        "right-hand sides have the other sign"
                    )

    def sides(self, given: Mapping[str, int]) -> list[int]:
        """The sides on which a run starts where it could go on in several ways."""
        if not given:
            return []
        if set(given) != set(self.surfaces) or not set(given.values()) <= {-1, 0, 1}:
            raise ValueError(f"sides = {given!r}; expected -1, 0 or 1 for each of {self.signs.names}")
        return [given[name] for name in self.surfaces]

    def system(self, places: list[list[int]] | None = None) -> Any:
        """The system for the native module. Of a family, the guards of each mode have `places`."""
        surfaces = [
            (f"surface {name!r}", _callee(surface)) for name, surface in self.surfaces.items()
        ]
        variables = (self.variables.named, self.variables.flat.tolist()) if self.variables else None
        signs = self.signs.named if self.signs else None
        return self.modes(places), surfaces, (variables, signs)

    def modes(self, places: list[list[int]] | None) -> list[Any]:
        """The modes for the native module."""
        offset = 0
        self.places = []
        rows = []
        width = 1 + max((place for row in places or [] for place in row), default=-1)
        for number, mode in enumerate(self.system_modes):
            own = len(mode.guard_list)
            if places is not None:
                numbers = places[number]
            else:
                first = len(self.events) + (offset if self.apart else 0)
                numbers = [*range(len(self.events)), *range(first, first + own)]
            offset += own
            count = max(width, 1 + max(numbers, default=-1))
            off = ("", "off", 0, 0, 0, False, (None, None, False, None), None, False, None, None)
            guards: list[Any] = [off] * count
            names = [""] * count
            native_sources: list[Any] = []
            rest = iter(numbers)
            for source in [*self.events, *mode._sources]:
                these = [next(rest) for _ in source.guards]
                if source.function is not None:
                    native_sources.append(((source.label, _callee(source.function)), these))
                for place, guard in zip(these, source.guards, strict=True):
                    guards[place], names[place] = self.guard(guard, mode, source), guard.name
            label = (
                "the right-hand side"
                if self.plain
                else f"the right-hand side of mode {mode.name!r}"
            )
            rows.append(((label, _callee(mode.right_hand_side)), guards, native_sources))
            self.places.append([name for name in self.surfaces for _ in range(2)] + names)
        return rows

    def guard(self, guard: Guard, mode: Mode, source: _Source) -> Any:
        """A guard for the native module."""
        about = f"guard {guard.name!r} of mode {mode.name!r}"
        label = source.label if source in self.events else about
        to = self.target(guard.to, about)
        after: tuple[int | None, Any, bool] = (to, None, False)
        if guard.reset is not None:
            after = (to, (f"the reset of {about}", _callee(guard.reset)), False)
        elif guard.transition is not None:
            what = f"the transition of {about}"
            after = (None, (what, self.transition(guard.transition, what)), True)
        sets: Any = None
        if guard.sets is not None:
            if not self.variables:
                raise ValueError(f"{about} sets variables, and the system has none")
            what = f"sets of {about}"
            sets = (what, self.variables.setter(guard.sets, what))
        condition: Any = None
        if self.conditions and guard.condition is not None:
            condition = (f"the condition of {about}", _callee(guard.condition))
        return (
            label,
            "clock" if isinstance(guard, _Clock) else guard.direction,
            None if self.plain and not guard.from_zero else guard.from_zero,
            int(guard.terminal),
            operator.index(guard.priority),
            guard.smooth,
            (*after, sets),
            condition,
            guard.sees_jumps,
            self.rest(guard, about),
            guard.times if isinstance(guard, _Clock) else None,
        )

    def target(self, mode: str | Mode | None, about: str) -> int | None:
        """The index of the mode that follows."""
        name = mode.name if isinstance(mode, Mode) else mode
        if name is not None and name not in self.names:
            raise ValueError(f"{about} leads to mode {name!r}; expected one of {self.names}")
        return None if name is None else self.names.index(name)

    def rest(self, guard: Guard, about: str) -> Any:
        """What follows where the events of a guard accumulate."""
        if guard.rest is None:
            return None
        if isinstance(guard.rest, str | Mode):
            return (self.target(guard.rest, about), None, False, None)
        what = f"the rest of {about}"
        return (None, (what, self.transition(guard.rest, what)), True, None)

    def transition(self, transition: Callable[..., Any], what: str) -> Callable[..., Any]:
        """A transition that returns the index of the mode or None, and the state or None."""

        def mode_and_state(t: float, y: Floats, *args: Any) -> tuple[int | None, Any]:
            found = transition(t, y, *args)
            state = None
            if isinstance(found, tuple) and len(found) == 2 and isinstance(found[0], str | Mode):
                found, state = found
                if state is None:
                    raise TypeError(f"{what}, at t = {t}: the state after is None")
            if not isinstance(found, str | Mode):
                if found is None:
                    raise TypeError(
                        f"{what}, at t = {t}: it returns None; expected a mode, a state, or both"
                    )
                return None, found
            name = found.name if isinstance(found, Mode) else found
            if name not in self.names:
                raise ValueError(
                    f"{what}, at t = {t}: it leads to mode {name!r}; expected one of {self.names}"
                )
            return self.names.index(name), state

        return mode_and_state

    def solution(self, found: dict[str, Any], start: float, dense: bool) -> Solution:
        """The result that Python sees."""
        # The native module counts modes with their variables and sides.
        modes = found["seen_modes"].tolist()
        names = [self.names[mode] for mode in modes]
        guards = [self.places[mode] for mode in modes]
        return Solution(
            found,
            Names(names, guards, self.event_names),
            start=start,
            dense=dense,
            guards="decided" if found["decided"] else f"sampled: {self.reason}",
            beside=self.beside(found) if self.variables or self.signs else None,
        )

    def beside(self, found: dict[str, Any]) -> Beside:
        """Variables, and sides of surfaces."""
        count = len(found["seen_modes"])
        variables = self.variables.columns(found["seen_variables"].reshape(count, -1))
        sides = self.signs.columns(found["seen_sides"].reshape(count, -1))
        at, left, to = found["modes"], found["event_from"], found["event_to"]
        columns, behind = variable_columns(self.variables), dict[str, Any]()
        if self.variables:
            behind["variables"] = {name: values[to] for name, values in variables.items()}
        if self.signs:
            signs = [(name, "i1") for name in self.signs.names]
            columns += [("sides_from", signs), ("sides_to", signs), ("unique", "?")]
            behind["sides_from"] = {name: values[left] for name, values in sides.items()}
            behind["sides_to"] = {name: values[to] for name, values in sides.items()}
            behind["unique"] = found["seen_unique"][to]
        return Beside(
            {name: values[at] for name, values in variables.items()},
            {name: values[at] for name, values in sides.items()},
            columns,
            behind,
        )


def _callee(function: Function) -> Any:
    if isinstance(function, Compiled):
        return (function.address, function._pointer, function)
    return function


def _event_list(events: Function | Iterable[Function] | None) -> list[Function]:
    if events is None:
        return []
    if callable(events) or isinstance(events, Compiled):
        return [events]
    return list(events)


def _named(events: list[Function]) -> Iterable[tuple[Function, str]]:
    names = [str(getattr(event, "__name__", "event")) for event in events]
    for index, event, name in zip(count(), events, names, strict=False):
        unique = name.isidentifier() and names.count(name) == 1
        yield event, name if unique else f"event {index}"


def _event(event: Function, name: str) -> _Source:
    """An event as a guard that changes nothing."""
    _check_function(event, f"event {name!r}")
    direction = float(getattr(event, "direction", 0))
    terminal = getattr(event, "terminal", False) or 0
    if terminal < 0 or terminal != int(terminal):
        raise ValueError(f"event {name!r}: terminal = {terminal!r}; expected a bool or a count")
    guard = Guard(
        name,
        "rising" if direction > 0 else "falling" if direction < 0 else "either",
        terminal=int(terminal),
        from_zero=int(getattr(event, "from_zero", 0)),
        smooth=bool(getattr(event, "smooth", False)),
    )
    return _Source(event, f"event {name!r}", (guard,))


def _arguments(args: Any) -> tuple[Any, ...]:
    if type(args) is tuple:
        return args
    if not isinstance(args, Iterable):
        raise TypeError(f"args = {args!r}; expected a tuple, as in args=({args!r},)")
    return tuple(args)
