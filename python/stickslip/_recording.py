"""Functions of Python as formulas: each is called once with symbols instead of numbers.

An `if` is followed both ways. What cannot be recorded raises `CannotRecord` with the reason.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip._copies import copied, inside, swapped
from stickslip._symbols import CannotRecord, Condition, Decisions, Symbol, Symbols, array_of

#: Ways through a function that are followed.
MOST_WAYS = 64


class Tape(Decisions):
    """The formulas of a system, as they are recorded."""

    def record(self, function: Callable[..., Any], n: int, args: tuple[Any, ...]) -> list[Symbol]:
        """The numbers that function(t, y, *args) returns, for y of shape (n,)."""
        outside: list[Any] = []
        done: dict[int, Any] = {}
        recorded = copied(function, done, outside)
        args = tuple(swapped(value, done, outside) for value in args)
        refusals = CannotRecord.count
        time = Symbol(self, self.native.time())
        state = np.empty(n, dtype=object)
        state[:] = [Symbol(self, self.native.component(i)) for i in range(n)]
        ways: list[tuple[list[tuple[int, bool, bool]], list[Symbol]]] = []
        self.way = []
        before = repr(list(map(inside, outside)))
        while True:
            self.place = 0
            found = recorded(time, state.copy().view(Symbols), *args)
            whole = np.asarray(array_of(found), dtype=object)
            flat = whole.reshape(-1)
            if whole.ndim > 1:
                raise CannotRecord(f"it returns an array of shape {whole.shape}")
            if any(isinstance(value, Condition | bool | np.bool_) for value in flat):
                raise CannotRecord("it returns a truth value")
            ways.append((self.way[: self.place], [self.number(value) for value in flat]))
            if len(ways) > MOST_WAYS:
                raise CannotRecord(f"more than {MOST_WAYS} ways through the function")
            del self.way[self.place :]
            while self.way and self.way[-1][2]:
                self.way.pop()
            if not self.way:
                break
            node, is_negative, _ = self.way.pop()
            self.way.append((node, not is_negative, True))
        if CannotRecord.count != refusals:
            raise CannotRecord("it catches what a number that is not known yet cannot do")
        if repr(list(map(inside, outside))) != before:
            raise CannotRecord("the function changes something outside")
        return self._merged(ways, 0)

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
