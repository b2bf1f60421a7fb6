"""Systems of your own: piecewise-smooth ODEs of Python callables or compiled functions.

A `HybridSystem` has modes, each with a right-hand side and guards; `solve` runs it through every
switch. A plain function with events, as for SciPy's `solve_ivp`, needs no system.
"""

import ctypes
import operator
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import count
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native

Floats: TypeAlias = NDArray[np.float64]
Direction: TypeAlias = Literal["below", "falling", "rising", "either"]
Outcome: TypeAlias = Literal[
    "reached_end",
    "ended_by_guard",
    "zeno",
    "switch_limit",
    "step_limit",
    "instant_limit",
    "failed",
]

#: The names of methods; in small letters they mean the same.
METHODS = {"dop853": "dop853", "dopri5": "dopri5", "rk45": "dopri5"}


class Compiled:
    """A compiled function with the signature

        void f(double t, const double *y, double *out, const double *parameters)

    `out` takes the derivative of the state, the values of guards, or the state after a guard has
    fired, whichever the function is used for. If all functions of a system are compiled, it runs
    without the interpreter's lock.

    function: a `cfunc` of Numba, a `scipy.LowLevelCallable` (whose user data are the parameters), a
    function of ctypes, or the address of the code. parameters: numbers that are copied, and passed
    with each call.

    What is at an address cannot be checked. Another signature, or a function that reads or writes
    beyond its arrays, ends in wrong numbers or in a crash of the interpreter. The function may be
    called by any thread, and by several at once. It cannot raise an exception; NaN says that there
    is no value.
    """

    #: What `solve` asks of an event.
    terminal: bool | int = False
    direction: float = 0.0
    from_zero: int = 0
    smooth: bool = False

    def __init__(self, function: Any, parameters: ArrayLike | None = None) -> None:
        self._keeps = function
        self.__name__ = str(getattr(function, "__name__", "compiled"))
        address, pointer, signature = _code_of(function)
        if signature is not None and not _SIGNATURE.fullmatch(signature.replace(" ", "")):
            raise TypeError(
                f"the signature is {signature!r}; expected "
                "void (double t, double *y, double *out, double *parameters)"
            )
        if not 0 < address < 2 ** (8 * ctypes.sizeof(ctypes.c_void_p)):
            raise ValueError(f"{address} is not the address of a function")
        self.address = address
        self.parameters: Floats | None = None
        if parameters is not None:
            if pointer:
                raise ValueError("parameters are given twice: here and as user data")
            self.parameters = _reals(parameters, "parameters").reshape(-1)
            self.parameters.setflags(write=False)
            pointer = self.parameters.ctypes.data
        self._pointer = pointer

    def __reduce__(self) -> Any:
        raise TypeError("an address means nothing in another process: Compiled cannot be pickled")

    def __repr__(self) -> str:
        return f"Compiled({self._keeps!r})"


Function: TypeAlias = Callable[..., Any] | Compiled

_FUNCTION_OF_CTYPES: Any = type(ctypes.CFUNCTYPE(None)()).__mro__[1]
_POINTER = r"(const)?(double|float64|void)\*(const)?"
_SIGNATURE = re.compile(rf"void\((double|float64),{_POINTER},{_POINTER},{_POINTER}\)")


def _code_of(function: Any) -> tuple[int, int, str | None]:
    """The addresses of a function and of its parameters, or 0, and its signature, if it has one."""
    if isinstance(function, int) and not isinstance(function, bool):
        return function, 0, None
    if isinstance(function, tuple) and type(function).__name__ == "LowLevelCallable":
        # Its own [] refuses.
        capsule = ctypes.py_object(tuple.__getitem__(function, 0))
        api = ctypes.pythonapi
        name = ctypes.PYFUNCTYPE(ctypes.c_char_p, ctypes.py_object)(
            ("PyCapsule_GetName", api)
        )(capsule)
        pointer = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object, ctypes.c_char_p)(
            ("PyCapsule_GetPointer", api)
        )(capsule, name)
        context = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object)(
            ("PyCapsule_GetContext", api)
        )(capsule)
        return int(pointer), int(context or 0), name.decode()
    if isinstance(function, _FUNCTION_OF_CTYPES):
        return int(ctypes.cast(function, ctypes.c_void_p).value or 0), 0, None
    address = getattr(function, "address", None)
    if isinstance(address, int):
        signature = getattr(function, "_sig", None)
        if signature is None:
            return address, 0, None
        result = str(signature.return_type).replace("none", "void")
        return address, 0, f"{result} ({', '.join(str(one) for one in signature.args)})"
    raise TypeError(
        f"a {type(function).__name__} is not compiled; expected a cfunc of Numba, a "
        "LowLevelCallable of SciPy, a function of ctypes, or an address"
    )


@dataclass(frozen=True)
class Guard:
    """When a mode ends, and what follows; see `Mode.guard`."""

    name: str
    direction: Direction = "below"
    to: "str | Mode | None" = None
    reset: Function | None = None
    transition: Callable[..., Any] | None = None
    terminal: bool | int = False
    from_zero: int = 0
    smooth: bool = False
    yields: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise TypeError(f"{self.name!r} is not a name of a guard; expected a str")
        about = f"guard {self.name!r}"
        if self.direction not in get_args(Direction):
            raise ValueError(
                f"{about}: direction = {self.direction!r}; expected one of {get_args(Direction)}"
            )
        for name, value in (("terminal", int(self.terminal)), ("from_zero", self.from_zero)):
            if not 0 <= value < 2**31:
                raise ValueError(f"{about}: {name} = {value}; expected 0 or above")
        if self.transition is not None and (self.to is not None or self.reset is not None):
            raise ValueError(f"{about}: a transition says it all; expected no to and no reset")
        if isinstance(self.transition, Compiled):
            raise TypeError(f"{about}: a transition is a callable; a reset may be compiled")
        for name, function in (("reset", self.reset), ("transition", self.transition)):
            if function is not None:
                _check_function(function, f"{name} of {about}")
        if self.direction == "below" and not self.changes and self.terminal != 1:
            raise ValueError(
                f"{about} would fire for ever, because it stays below zero: expected to, reset, "
                'transition or terminal=True, or direction = "falling"'
            )

    @property
    def changes(self) -> bool:
        """Whether anything follows when it fires."""
        return not (self.to is None and self.reset is None and self.transition is None)


@dataclass(frozen=True)
class _Source:
    """A function that returns the values of successive guards."""

    function: Function
    label: str
    guards: tuple[Guard, ...]


class Mode:
    """A smooth regime of a `HybridSystem`, which makes it."""

    def __init__(self, name: str, right_hand_side: Function) -> None:
        self.name = name
        self.right_hand_side = right_hand_side
        self._sources: list[_Source] = []

    @property
    def guard_list(self) -> tuple[Guard, ...]:
        """The guards, in the order in which they were added."""
        return tuple(guard for source in self._sources for guard in source.guards)

    def guard(
        self,
        name: str,
        function: Function,
        *,
        to: "str | Mode | None" = None,
        reset: Function | None = None,
        transition: Callable[..., Any] | None = None,
        direction: Direction = "below",
        terminal: bool | int = False,
        from_zero: int = 0,
        smooth: bool = False,
        yields: bool = False,
    ) -> "Mode":
        """Adds a guard, and returns the mode.

        function(t, y) is a number, and the guard fires at its zeros. direction: "below" fires as
        soon as the number is negative, also where the mode begins: the guard bounds the mode.
        "falling", "rising" and "either" fire where it crosses zero.

        to: the mode that follows; without it the mode stays. reset(t, y): the state that follows;
        without it the state stays. transition(t, y): both in one, (mode, state), or one of both.
        These functions may be called more than once for an event.

        terminal: True ends the run, and a number k ends it when the guard fires for the k-th time.
        from_zero: the order of the zero from which the guard starts whenever the mode begins; only
        needed if rounding may hide that it is 0 there, or if it is a double zero. smooth: the guard
        varies as slowly as the state, so that fewer values are enough. yields: of guards that fire
        together the first one decides what follows; this one gives way to the others.
        """
        guard = Guard(
            name, direction, to, reset, transition, terminal, from_zero, smooth, yields
        )
        return self._add(function, f"guard {name!r} of mode {self.name!r}", (guard,))

    def guards(self, function: Function, *guards: Guard) -> "Mode":
        """Adds guards whose values one function returns, in this order, and returns the mode."""
        if not guards:
            raise ValueError("no guards are given; expected at least one")
        return self._add(function, f"the guards of mode {self.name!r}", guards)

    def _add(self, function: Function, label: str, guards: tuple[Guard, ...]) -> "Mode":
        _check_function(function, label)
        names = [guard.name for guard in self.guard_list + guards]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"mode {self.name!r} has two guards {name!r}")
        self._sources.append(_Source(function, label, guards))
        return self

    def __repr__(self) -> str:
        names = ", ".join(repr(guard.name) for guard in self.guard_list)
        return f"Mode({self.name!r}, guards: {names or 'none'})"


class HybridSystem:
    """Modes and what leads from one to another.

    >>> ball = HybridSystem()
    >>> fly = ball.mode("fly", lambda t, y: [y[1], -9.81])
    >>> fly.guard("floor", lambda t, y: y[0], reset=lambda t, y: [0.0, -0.5 * y[1]])
    Mode('fly', guards: 'floor')
    >>> found = solve(ball, (0.0, 2.5), [4.905, 0.0])
    >>> found.t_events[0].round(12)
    array([1., 2.])
    """

    def __init__(self) -> None:
        self._modes: dict[str, Mode] = {}

    @property
    def modes(self) -> tuple[Mode, ...]:
        """The modes, in the order in which they were added."""
        return tuple(self._modes.values())

    def mode(self, name: str, right_hand_side: Function) -> Mode:
        """Adds a mode. right_hand_side(t, y) is the derivative of the state, shape (n,)."""
        if not isinstance(name, str):
            raise TypeError(f"{name!r} is not a name of a mode; expected a str")
        if name in self._modes:
            raise ValueError(f"there are two modes {name!r}")
        _check_function(right_hand_side, f"the right-hand side of mode {name!r}")
        self._modes[name] = mode = Mode(name, right_hand_side)
        return mode

    def __getitem__(self, name: str) -> Mode:
        return self._modes[name]

    def __repr__(self) -> str:
        return f"HybridSystem({', '.join(repr(mode) for mode in self.modes)})"


class DenseOutput:
    """The state at any time of a run, from the polynomial of each step.

    At an event it is the state after it. Outside the run it is NaN.
    """

    def __init__(self, found: dict[str, Any], names: list[str], start: float) -> None:
        self._segments = (found["starts"], found["sizes"], found["coefficients"])
        self._modes = np.append(found["segment_modes"].astype(np.intp), found["end_mode"])
        self._names = np.array(names)
        self._end = (found["end_time"], found["end_state"])
        #: The first and the last time of the run.
        self.t_min, self.t_max = sorted((start, found["end_time"]))

    def __call__(self, t: ArrayLike) -> Floats:
        """The state, shape (n,) at a number and (n, k) at k times."""
        times = np.asarray(t, dtype=np.float64)
        if times.ndim > 1:
            raise ValueError(f"t has {times.ndim} dimensions; expected a number or a list")
        flat = np.ascontiguousarray(times).reshape(-1)
        rows = _native.evaluate_dense(self._segments, self._end, flat)
        states: Floats = rows.reshape(flat.size, self._end[1].size).T
        return states if times.ndim else states[:, 0]

    def mode(self, t: ArrayLike) -> Any:
        """The mode at each time, or "" outside the run."""
        times = np.asarray(t, dtype=np.float64)
        starts, sizes, _ = self._segments
        sign = -1.0 if sizes.size and sizes[0] < 0.0 else 1.0
        index = np.searchsorted(sign * starts, sign * times, side="right") - 1
        index = np.where(times == self._end[0], -1, np.maximum(index, 0))
        inside = (times >= self.t_min) & (times <= self.t_max)
        return np.where(inside, self._names[self._modes[index]], "")[()]


@dataclass(frozen=True)
class Solution:
    """What `solve` found. The names are those of SciPy's `solve_ivp` where it has them."""

    #: Times, shape (k,): of the steps, or those of `t_eval`. A run that ends early ends with its
    #: last point. Where an event changes the state, the steps have its time twice.
    t: Floats
    #: States, shape (n, k).
    y: Floats
    #: The mode at each time, shape (k,).
    mode: NDArray[np.str_]
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
    #: they have fired with this one.
    events: NDArray[np.void]
    #: Where a guard came so close to zero that a step had to decide: time, guard, mode and the
    #: guard's value there, the margin.
    touches: NDArray[np.void]
    #: Where a guard changed its sign at a pole, and did not fire: time, guard and mode.
    poles: NDArray[np.void]
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


def solve(
    system: HybridSystem | Function,
    t_span: ArrayLike,
    y0: ArrayLike,
    mode: str | Mode | None = None,
    *,
    method: str = "dop853",
    rtol: float = 1e-10,
    atol: float = 1e-12,
    t_eval: ArrayLike | None = None,
    dense_output: bool = False,
    events: Function | Iterable[Function] | None = None,
    max_step: float = np.inf,
    first_step: float | None = None,
    max_switches: int = 10_000_000,
    guard_scale: float | None = None,
    args: tuple[Any, ...] = (),
) -> Solution:
    """Runs a system from t_span[0] to t_span[1], through every switch.

    system: a `HybridSystem`, or the right-hand side f(t, y) of a smooth problem. y0: the state at
    the start, shape (n,). mode: the one at the start, if there are several. The end may lie before
    the start, unless a guard changes something, and it may be infinite if something ends the run.

    method: "dop853" (order 8) or "dopri5" (order 5, also called "RK45"). rtol: 1e-15 to 0.1, atol:
    above 0; the error of a step is below atol + rtol |y|. t_eval: sorted times at which `t` and `y`
    are wanted, and not at all steps; an empty list keeps events only, which is fastest.
    dense_output: whether `sol` is kept.

    events: functions event(t, y) whose zeros are reported in every mode and change nothing. An
    event has the attributes that `solve_ivp` knows: terminal (bool, or a number of times) and
    direction (rising if above 0, falling if below 0); and from_zero and smooth, as a guard. If the
    system is a function, an event that is exactly 0 at the start does not fire there.

    guard_scale: the shortest time on which guards and events change, if they change faster than the
    state. max_switches: a run that has so many events stops. args: further arguments of all Python
    functions, after t and y.

    Functions get a state of their own, which they may keep and change. Their exceptions stop the
    run and come out as they are. TypeError and ValueError name the function that returned something
    wrong, and the time. What happens to the numbers (not finite, tolerance not met, switches that
    accumulate) ends the run with status -1.

    >>> found = solve(lambda t, y: -y, (0.0, 1.0), [1.0])
    >>> round(float(found.y[0, -1]), 10)
    0.3678794412
    """
    start, end = _span(t_span)
    state = _state(y0)
    table = _Table(system, _event_list(events), _arguments(args))
    first = table.index_of(mode)
    settings = {
        "method": _method(method),
        "rtol": _number(rtol, "rtol"),
        "atol": _number(atol, "atol"),
        "max_step": _number(max_step, "max_step"),
        "first_step": None if first_step is None else _number(first_step, "first_step"),
        "max_switches": _count(max_switches, "max_switches"),
        "guard_scale": None if guard_scale is None else _number(guard_scale, "guard_scale"),
    }
    times = None if t_eval is None else _times(t_eval, start, end)
    if np.isinf(end) and not table.may_end:
        raise ValueError("t_span is infinite, and no guard or event is terminal")
    if end < start:
        table.refuse_changes()
    found = _native.run_hybrid(
        table.modes(), table.args, (first, start, state), end, settings, (times, dense_output)
    )
    return table.solution(found, state.size, start, dense_output)


class _Table:
    """A system as the native module takes it, and what its numbers mean."""

    def __init__(
        self, system: HybridSystem | Function, events: list[Function], args: tuple[Any, ...]
    ) -> None:
        self.args = args
        self.events = [_event(event, name) for event, name in _named(events)]
        self.plain = not isinstance(system, HybridSystem)
        if isinstance(system, HybridSystem):
            self.system_modes = system.modes
            if not self.system_modes:
                raise ValueError("the system has no modes")
        else:
            _check_function(system, "the right-hand side")
            self.system_modes = (Mode("", system),)
        self.names = [mode.name for mode in self.system_modes]
        # Guards are counted by their place. If one ends the run when it fires again, all guards of
        # all modes have places of their own.
        guards = [guard for mode in self.system_modes for guard in mode.guard_list]
        self.apart = len(self.names) > 1 and any(int(guard.terminal) > 1 for guard in guards)
        self.event_names = [event.guards[0].name for event in self.events]
        for guard in guards:
            if guard.name in self.event_names[: len(self.events)]:
                raise ValueError(f"a guard and an event are called {guard.name!r}")
            if guard.name not in self.event_names:
                self.event_names.append(guard.name)
        #: The name of each guard of each mode, by its place.
        self.places: list[list[str]] = []

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
        for mode in self.system_modes:
            for guard in mode.guard_list:
                if guard.changes:
                    raise ValueError(
                        f"t_span goes backwards, but nothing inverts what follows guard "
                        f"{guard.name!r} of mode {mode.name!r}; expected a system in -t, whose "
                        "right-hand sides have the other sign"
                    )

    def modes(self) -> list[Any]:
        """The modes for the native module."""
        offset = 0
        self.places.clear()
        rows = []
        for mode in self.system_modes:
            sources = [*self.events]
            skipped = offset if self.apart else 0
            guards: list[Any] = []
            native_sources: list[Any] = []
            names: list[str] = []
            for number, source in enumerate([*sources, *mode._sources]):
                if number == len(self.events):
                    guards += [("", "off", 0, 0, False, False, (None, None, False))] * skipped
                    names += [""] * skipped
                native = (source.label, _callee(source.function))
                native_sources.append((native, len(guards), len(source.guards)))
                guards += [self.guard(guard, mode, source) for guard in source.guards]
                names += [guard.name for guard in source.guards]
            offset += len(mode.guard_list)
            label = (
                "the right-hand side"
                if self.plain
                else f"the right-hand side of mode {mode.name!r}"
            )
            rows.append(((label, _callee(mode.right_hand_side)), guards, native_sources))
            self.places.append(names)
        return rows

    def guard(self, guard: Guard, mode: Mode, source: _Source) -> Any:
        """A guard for the native module."""
        about = f"guard {guard.name!r} of mode {mode.name!r}"
        label = source.label if source in self.events else about
        target = guard.to.name if isinstance(guard.to, Mode) else guard.to
        if target is not None and target not in self.names:
            raise ValueError(f"{about} leads to mode {target!r}; expected one of {self.names}")
        to = None if target is None else self.names.index(target)
        change: tuple[int | None, Any, bool] = (to, None, False)
        if guard.reset is not None:
            change = (to, (f"the reset of {about}", _callee(guard.reset)), False)
        elif guard.transition is not None:
            what = f"the transition of {about}"
            change = (None, (what, self.transition(guard.transition, what)), True)
        return (
            label,
            guard.direction,
            None if self.plain and not guard.from_zero else guard.from_zero,
            int(guard.terminal),
            guard.yields,
            guard.smooth,
            change,
        )

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

    def solution(
        self, found: dict[str, Any], dimension: int, start: float, dense: bool
    ) -> Solution:
        """The result that Python sees."""
        names = np.array(self.names)
        text = f"U{max(map(len, [*self.names, *self.event_names, ' ']))}"
        place = [("time", "f8"), ("guard", text), ("mode", text)]
        touches = [(t, self.places[mode][g], names[mode], m) for t, mode, g, m in found["touches"]]
        poles = [(t, self.places[mode][guard], names[mode]) for t, mode, guard in found["poles"]]
        events = self.event_array(found, dimension, text)
        rows = self.rows(events, found["status"] == 1)
        return Solution(
            t=found["t"],
            y=found["y"].reshape(found["t"].size, dimension).T,
            mode=names[found["modes"]],
            sol=DenseOutput(found, self.names, start) if dense else None,
            t_events=[events["time"][one] for one in rows],
            y_events=[events["before"][one] for one in rows],
            event_names=self.event_names,
            events=events,
            touches=np.array(touches, dtype=[*place, ("margin", "f8")]),
            poles=np.array(poles, dtype=place),
            status=found["status"],
            outcome=found["outcome"],
            message=found["message"],
            accumulation=found["accumulation"],
            nfev=found["nfev"],
            statistics=found["statistics"],
        )

    def event_array(self, found: dict[str, Any], dimension: int, text: str) -> NDArray[Any]:
        """Everything that fired, in order."""
        state = ("f8", (dimension,))
        dtype = [("time", "f8"), ("guard", text), ("from", text), ("to", text)]
        dtype += [("before", *state), ("after", *state)]  # type: ignore[list-item]
        dtype += [("flatness", "f8"), ("jump", "?"), ("simultaneous", "O")]
        size = found["event_times"].size
        events: NDArray[Any] = np.empty(size, dtype=dtype)
        names, modes = np.array(self.names), found["event_from"]
        places = list(zip(modes.tolist(), found["event_guards"].tolist(), strict=True))
        events["time"] = found["event_times"]
        events["guard"] = [self.places[mode][guard] for mode, guard in places]
        events["from"] = names[modes]
        events["to"] = names[found["event_to"]]
        events["before"] = found["event_before"].reshape(size, dimension)
        events["after"] = found["event_after"].reshape(size, dimension)
        events["flatness"] = found["event_flatness"]
        events["jump"] = found["event_jump"]
        together = events["simultaneous"]
        for row, others in enumerate(found["event_simultaneous"]):
            mode = places[row][0]
            together[row] = tuple(self.places[mode][guard] for guard in others) if others else ()
        return events

    def rows(self, events: NDArray[Any], ended: bool) -> list[NDArray[np.intp]]:
        """The rows of `events` in which each name of `event_names` fired."""
        rows = [np.flatnonzero(events["guard"] == name) for name in self.event_names]
        for row in [row for row, others in enumerate(events["simultaneous"]) if others]:
            one = events[row]
            same = one["from"] == one["to"] and np.array_equal(one["before"], one["after"])
            if same and not (ended and row == events.size - 1):
                for name in one["simultaneous"]:
                    index = self.event_names.index(name)
                    rows[index] = np.sort(np.append(rows[index], row))
        return rows


def _callee(function: Function) -> Any:
    if isinstance(function, Compiled):
        return (function.address, function._pointer, function)
    return function


def _check_function(function: Any, what: str) -> None:
    if isinstance(function, Compiled):
        return
    if hasattr(function, "address") and hasattr(function, "ctypes"):
        raise TypeError(f"{what} is a cfunc; expected Compiled(cfunc), or a callable")
    if type(function).__name__ == "LowLevelCallable":
        raise TypeError(f"{what} is a LowLevelCallable; expected Compiled(...) of it")
    if not callable(function):
        kind = type(function).__name__
        raise TypeError(f"{what} is of type {kind}; expected a callable or Compiled")


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
    if not isinstance(args, Iterable):
        raise TypeError(f"args = {args!r}; expected a tuple, as in args=({args!r},)")
    return tuple(args)


def _method(method: str) -> str:
    found = METHODS.get(str(method).lower())
    if found is None:
        raise ValueError(
            f'method = {method!r}; expected "dop853" or "dopri5" ("RK45"); there are no others, '
            "and no implicit ones"
        )
    return found


def _reals(values: ArrayLike, what: str) -> Floats:
    """A copy as doubles."""
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise TypeError(f"{what} is complex; expected real numbers (real and imaginary parts)")
    if array.dtype.kind not in "biufO" or (array.ndim == 0 and array.dtype.kind == "O"):
        raise TypeError(f"{what} is {values!r}; expected numbers")
    if array.dtype.kind == "O":
        array = np.array([float(one) for one in array.flat]).reshape(array.shape)
    return np.array(array, dtype=np.float64, order="C")


def _number(value: Any, what: str) -> float:
    array = _reals(value, what)
    if array.size != 1:
        if array.size and (array == array.flat[0]).all():
            return float(array.flat[0])
        raise ValueError(f"{what} has {array.size} values; expected one number for all components")
    return float(array.reshape(-1)[0])


def _count(value: int, what: str) -> int:
    number = operator.index(value)
    if not 1 <= number < 2**63:
        raise ValueError(f"{what} = {value}; expected 1 or above")
    return number


def _span(t_span: ArrayLike) -> tuple[float, float]:
    span = _reals(t_span, "t_span")
    if span.shape != (2,):
        raise ValueError(f"t_span has shape {span.shape}; expected (start, end)")
    start, end = map(float, span)
    if not np.isfinite(start) or np.isnan(end):
        raise ValueError(f"t_span = ({start}, {end}); expected a finite start and an end")
    return start, end


def _state(y0: ArrayLike) -> Floats:
    state = _reals(y0, "y0")
    if state.ndim != 1:
        raise ValueError(f"y0 has {state.ndim} dimensions; expected one, as in y0=[1.0]")
    if not np.isfinite(state).all():
        index = int(np.flatnonzero(~np.isfinite(state))[0])
        raise ValueError(f"component {index} of y0 is {state[index]}; expected a finite number")
    return state


def _times(t_eval: ArrayLike, start: float, end: float) -> Floats:
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
