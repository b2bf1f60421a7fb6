"""Functions of Python as formulas: each is called once with symbols instead of numbers.

An `if` is followed both ways. What cannot be recorded raises `CannotRecord` with the reason.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stickslip._copies import Copies
from stickslip._systems import Mode
from stickslip._symbols import (
    REFUSALS,
    CannotRecord,
    Condition,
    Decisions,
    Symbol,
    Symbols,
    array_of,
)

#: Ways through a function that are followed.
MOST_WAYS = 64


class Tape(Decisions):
    """The formulas of a system, as they are recorded."""

    def record(
        self,
        function: Callable[..., Any],
        n: int,
        args: tuple[Any, ...],
        at: tuple[float, Sequence[float]] | None = None,
        numbers: Callable[[Any], list[Symbol]] | None = None,
    ) -> list[Symbol]:
        """The numbers that function(t, y, *args) returns, for y of shape (n,).

        at: time and state, if these are numbers. numbers: what these are in a result that is no
        list of them.
        """
        ways, numbers = self.ways(function, n, args, at), numbers or self._numbers
        return self._merged([(way, numbers(found)) for way, found in ways], 0)

    def choice(
        self,
        function: Callable[..., Any],
        n: int,
        args: tuple[Any, ...],
        names: list[str],
        at: tuple[float, Sequence[float]] | None = None,
    ) -> tuple[tuple[Symbol, int, int] | int | None, list[Symbol] | None]:
        """What a transition does that returns a state, a mode, or both: a mode, None if that stays,
        or (condition, mode above, mode below); and the state, None if that stays."""
        modes: list[tuple[Any, int | None]] = []
        states: list[tuple[Any, list[Symbol] | None]] = []
        for way, found in self.ways(function, n, args, at):
            state = found
            if isinstance(found, tuple) and len(found) == 2 and isinstance(found[0], str | Mode):
                found, state = found
            name = found.name if isinstance(found, Mode) else found
            is_mode = isinstance(name, str)
            if is_mode and name not in names:
                raise CannotRecord(f"it leads to mode {name!r}")
            modes.append((way, names.index(name) if is_mode else None))
            states.append((way, None if state is found and is_mode else self._numbers(state)))
        if all(state is None for _, state in states):
            after = None
        elif any(state is None for _, state in states):
            raise CannotRecord("whether it changes the state depends on a condition")
        else:
            after = self._merged(states, 0)
        targets = sorted({-1 if mode is None else mode for _, mode in modes})
        if len(targets) == 1:
            return modes[0][1], after
        (way, below), (_, above) = modes[:2] if modes[0][0][0][1] else modes[1::-1]
        if len(modes) > 2 or above is None or below is None:
            raise CannotRecord("it chooses between modes by more than one condition")
        return (Symbol(self, way[0][0]), above, below), after

    def _numbers(self, found: Any) -> list[Symbol]:
        whole = np.asarray(array_of(found), dtype=object)
        flat = whole.reshape(-1)
        if whole.ndim > 1:
            raise CannotRecord(f"it returns an array of shape {whole.shape}")
        if any(isinstance(value, Condition | bool | np.bool_) for value in flat):
            raise CannotRecord("it returns a truth value")
        return [self.number(value) for value in flat]

    def ways(
        self,
        function: Callable[..., Any],
        n: int,
        args: tuple[Any, ...],
        at: tuple[float, Sequence[float]] | None = None,
    ) -> list[tuple[list[tuple[int, bool, bool]], Any]]:
        """What a function returns on each way through it, with the decisions on the way."""
        self.catches = False
        copies = Copies(self)
        recorded = copies.function(function)
        args = tuple(map(copies.value, args))
        refusals = REFUSALS.count
        if at is None:
            time = Symbol(self, self.native.time())
            parts = [Symbol(self, self.native.component(i)) for i in range(n)]
        else:
            time = self.number(at[0])
            parts = [self.number(value) for value in at[1]]
        state = np.empty(n, dtype=object)
        state[:] = parts
        ways: list[tuple[list[tuple[int, bool, bool]], Any]] = []
        self.way = []
        while True:
            self.place = self.texts = 0
            found = recorded(time, state.copy().view(Symbols), *args)
            if self.texts:
                raise CannotRecord("it makes a text of a number that depends on time or state")
            ways.append((self.way[: self.place], found))
            if len(ways) > MOST_WAYS:
                raise CannotRecord(f"more than {MOST_WAYS} ways through the function")
            del self.way[self.place :]
            while self.way and self.way[-1][2]:
                self.way.pop()
            if not self.way:
                break
            node, is_negative, _ = self.way.pop()
            self.way.append((node, not is_negative, True))
        if REFUSALS.count != refusals:
            raise CannotRecord("it catches what a number that is not known yet cannot do")
        if copies.changed():
            raise CannotRecord("the function changes something outside")
        return ways

    def _merged(self, ways: list[Any], depth: int) -> list[Symbol]:
        if len(ways) == 1:
            return list(ways[0][1])
        node = ways[0][0][depth][0]
        below, above = (
            self._merged([way for way in ways if way[0][depth][1] == side], depth + 1)
            for side in (True, False)
        )
        if len(below) != len(above):
            raise CannotRecord("the number of results depends on a condition")
        condition = Symbol(self, node)
        return [self.select(condition, a, b) for a, b in zip(above, below, strict=True)]
