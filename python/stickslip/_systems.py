"""Systems of modes, with what ends them and what follows."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip._arrays import real
from stickslip._compiled import Compiled, Function, _number
from stickslip._names import Named, check_sets

Floats: TypeAlias = NDArray[np.float64]
Direction: TypeAlias = Literal["below", "falling", "rising", "either"]
#: Variables that an event sets: a mapping of names to numbers, or a function that returns one.
Sets: TypeAlias = Mapping[str, Any] | Callable[..., Mapping[str, Any]]


@dataclass(frozen=True)
class Guard:
    """When a mode ends, and what follows; see `Mode.guard`."""

    name: str
    direction: Direction = "below"
    to: str | Mode | None = None
    reset: Function | None = None
    transition: Callable[..., Any] | None = None
    terminal: bool | int = False
    from_zero: int = 0
    smooth: bool = False
    priority: int = 0
    condition: Function | None = None
    sees_jumps: bool = False
    rest: str | Mode | Callable[..., Any] | None = None
    sets: Sets | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise TypeError(f"{self.name!r} is not a name of a guard; expected a str")
        about = f"guard {self.name!r}"
        if self.direction not in get_args(Direction):
            raise ValueError(
                f"{about}: direction = {self.direction!r}; expected one of {get_args(Direction)}"
            )
        for name, value in (("terminal", self.terminal), ("from_zero", self.from_zero)):
            if not hasattr(value, "__index__"):
                raise TypeError(f"{about}: {name} = {value!r}; expected a whole number")
            if not 0 <= operator.index(value) < 2**31:
                raise ValueError(f"{about}: {name} = {value}; expected 0 or above")
        if not hasattr(self.priority, "__index__"):
            raise TypeError(f"{about}: priority = {self.priority!r}; expected a whole number")
        if not -128 <= operator.index(self.priority) < 128:
            raise ValueError(f"{about}: priority = {self.priority}; expected -128 to 127")
        if self.transition is not None and (self.to is not None or self.reset is not None):
            raise ValueError(f"{about}: a transition says it all; expected no to and no reset")
        if isinstance(self.transition, Compiled):
            raise TypeError(f"{about}: a transition is a callable; a reset may be compiled")
        functions = {
            "reset": self.reset,
            "transition": self.transition,
            "condition": self.condition,
        }
        for name, function in functions.items():
            if function is not None:
                _check_function(function, f"{name} of {about}")
        if self.sets is not None:
            check_sets(self.sets, about)
        if isinstance(self.rest, Compiled):
            raise TypeError(f"{about}: rest is compiled; expected a mode or a callable")
        if self.direction == "below" and not self.changes and self.terminal != 1:
            raise ValueError(
                f"{about} would fire for ever, because it stays below zero: expected to, reset, "
                'sets, transition or terminal=True, or direction = "falling"'
            )

    @property
    def changes(self) -> bool:
        """Whether anything follows when it fires."""
        followers = (self.to, self.reset, self.transition, self.sets)
        return any(one is not None for one in followers)


@dataclass(frozen=True)
class _Clock(Guard):
    """A guard that fires at given times: a period and a phase, or a list."""

    times: tuple[float, float] | list[float] = ()  # type: ignore[assignment]


@dataclass(frozen=True)
class _Source:
    """A function that returns the values of successive guards; a clock has none."""

    function: Function | None
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
        to: str | Mode | None = None,
        reset: Function | None = None,
        transition: Callable[..., Any] | None = None,
        direction: Direction = "below",
        terminal: bool | int = False,
        from_zero: int = 0,
        smooth: bool = False,
        priority: int = 0,
        condition: Function | None = None,
        sees_jumps: bool = False,
        rest: str | Mode | Callable[..., Any] | None = None,
        sets: Sets | None = None,
    ) -> Mode:
        """Adds a guard, and returns the mode.

        function(t, y) is a number, and the guard fires at its zeros. direction: "below" fires as
        soon as the number is negative, also where the mode begins: the guard bounds the mode.
        "falling", "rising" and "either" fire where it crosses zero.

        to: the mode that follows; without it the mode stays. reset(t, y): the state that follows;
        without it the state stays. transition(t, y): both in one, (mode, state), or one of both.
        sets: variables of the system and their values after, as a mapping or as a function sets(t,
        y, variables) that returns one. These functions see what was before the event, and may be
        called more than once for it.

        terminal: True ends the run, and a number k ends it when the guard fires for the k-th time.
        from_zero: the order of the zero from which the guard starts whenever the mode begins; only
        needed if rounding may hide that it is 0 there, or if it is a double zero. smooth: the guard
        varies as slowly as the state, so that fewer values are enough. condition(t, y): a number
        that is positive where the transition takes one branch, and negative where it takes another
        one; only a `HybridFamily` uses it.

        priority: of guards that fire at one instant all act, each once, those of higher priority
        first, and else in the order in which they were added. sees_jumps: it fires, too, where a
        transition carries its number across zero. rest: where its events accumulate, the run goes
        on in this mode, or rest(t, y) says what follows as a transition does; without it the run
        ends there.
        """
        guard = Guard(
            name,
            direction,
            to,
            reset,
            transition,
            terminal,
            from_zero,
            smooth,
            priority,
            condition,
            sees_jumps,
            rest,
            sets,
        )
        return self._add(function, f"guard {name!r} of mode {self.name!r}", (guard,))

    def guards(self, function: Function, *guards: Guard) -> Mode:
        """Adds guards whose values one function returns, in this order, and returns the mode."""
        if not guards:
            raise ValueError("no guards are given; expected at least one")
        return self._add(function, f"the guards of mode {self.name!r}", guards)

    def at(
        self,
        name: str,
        times: ArrayLike,
        *,
        to: str | Mode | None = None,
        reset: Function | None = None,
        transition: Callable[..., Any] | None = None,
        terminal: bool | int = False,
        priority: int = 0,
        sets: Sets | None = None,
    ) -> Mode:
        """Adds events at times, and returns the mode. Steps end there exactly, without a search.

        What follows is said as for a guard. A time at which the mode begins belongs to the mode
        before; at the start of the run it counts.

        >>> tank = HybridSystem()
        >>> empties = tank.mode("empties", lambda t, y: -y)
        >>> empties.at("dose", [0.0, 1.0], reset=lambda t, y: y + 1.0)
        Mode('empties', guards: 'dose')
        >>> round(float(solve(tank, (0.0, 2.0), [0.0]).y[0, -1]), 9)
        0.503214724
        """
        listed = np.atleast_1d(real("times", times)).tolist()
        return self._clock(name, listed, to, reset, transition, terminal, priority, sets)

    def every(
        self,
        name: str,
        period: float,
        *,
        phase: float = 0.0,
        to: str | Mode | None = None,
        reset: Function | None = None,
        transition: Callable[..., Any] | None = None,
        terminal: bool | int = False,
        priority: int = 0,
        sets: Sets | None = None,
    ) -> Mode:
        """Adds events at the times phase + k period, as `at` does, and returns the mode."""
        times = (_number(period, "period"), _number(phase, "phase"))
        if not (0.0 < times[0] < np.inf and np.isfinite(times[1])):
            raise ValueError(f"period, phase = {times}; expected a period above 0, both finite")
        return self._clock(name, times, to, reset, transition, terminal, priority, sets)

    def _clock(
        self,
        name: str,
        times: tuple[float, float] | list[float],
        to: str | Mode | None,
        reset: Function | None,
        transition: Callable[..., Any] | None,
        terminal: bool | int,
        priority: int,
        sets: Sets | None,
    ) -> Mode:
        guard = _Clock(
            name,
            "falling",
            to,
            reset,
            transition,
            terminal,
            priority=priority,
            sets=sets,
            times=times,
        )
        return self._add(None, f"clock {name!r} of mode {self.name!r}", (guard,))

    def _add(self, function: Function | None, label: str, guards: tuple[Guard, ...]) -> Mode:
        if function is not None:
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
    >>> found = solve(ball, (0.0, 2.4), [4.905, 0.0])
    >>> found.t_events[0].round(12)
    array([1., 2.])

    variables: numbers or arrays that only events change (`sets` of a guard), with their values at
    the start. All functions get them after time and state, as a named tuple.

    >>> heater = HybridSystem(variables={"on": 1.0})
    >>> room = heater.mode("room", lambda t, y, now: 3.0 * now.on - y)
    >>> room.guard("warm", lambda t, y, now: 2.0 - y, direction="falling", sets={"on": 0.0})
    Mode('room', guards: 'warm')
    >>> found = solve(heater, (0.0, 2.0), [0.0])
    >>> float(found.t_events[0][0].round(9)), float(found.variables["on"][-1])
    (1.098612289, 0.0)

    sliding: up to 4 surfaces, each a function h(t, y) whose zero it is. Right-hand sides get the
    signs of these functions, each +1 or -1, as a named tuple after time, state and variables. The
    solution crosses a surface, or slides along it where the fields on both sides lead to it
    (Filippov). With several surfaces a right-hand side is affine in the signs. Recorded functions
    are decided, as they are without surfaces.

    >>> belt = HybridSystem(sliding={"belt": lambda t, y: y[1] - 0.5})
    >>> mass = belt.mode("mass", lambda t, y, sign: [y[1], -y[0] - 0.8 * sign.belt])
    >>> found = solve(belt, (0.0, 3.0), [-0.3, 0.5])
    >>> found.t_events[0].round(12), found.sides["belt"][[0, -1]]
    (array([2.2]), array([ 0, -1], dtype=int8))

    For a compiled function, the variables and the signs follow the state in `y`.
    """

    def __init__(
        self,
        *,
        variables: Mapping[str, ArrayLike] | None = None,
        sliding: Mapping[str, Function] | None = None,
    ) -> None:
        self._modes: dict[str, Mode] = {}
        self._variables = Named("variables", variables or {})
        self._sliding = dict(sliding or {})
        self._signs = Named("signs", dict.fromkeys(self._sliding, 0.0))
        if len(self._sliding) > 4:
            raise ValueError(f"sliding has {len(self._sliding)} surfaces; expected 4 at most")
        for name, surface in self._sliding.items():
            _check_function(surface, f"surface {name!r}")

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
