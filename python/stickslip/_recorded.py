"""Systems of Python's functions that are recorded as formulas, run, and compared."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip._compiled import Compiled, Function
from stickslip._recording import Tape
from stickslip._solutions import DenseOutput, Solution
from stickslip._symbols import CannotRecord, Symbol
from stickslip._systems import Guard, Mode, _Clock, _Source
from stickslip.formulas import FormulaSystem

#: Places between steps, and events, at which formulas are compared with their functions.
MOST_PLACES = 8


class Recorded:
    """The formulas of a system, and the functions from which they come.

    Raises CannotRecord with the reason, if a function is no formula.
    """

    def __init__(self, table: Any, start: float, state: NDArray[np.float64]) -> None:
        if not state.size:
            raise CannotRecord("there is no state")
        if table.variables or table.signs:
            raise CannotRecord("the system has variables or surfaces")
        if table.apart:
            raise CannotRecord("guards of several modes are counted until the run ends")
        self.table, self.state, self.start = table, state, start
        self.tape = Tape()
        #: For each mode, functions with their formulas: the right-hand side, guards, and resets.
        self.slopes: list[tuple[str, Function, list[int]]] = []
        self.guards: list[list[tuple[str, Function, list[int]]]] = []
        self.resets: list[dict[int, tuple[str, Function]]] = []
        modes = [self.mode(mode) for mode in table.system_modes]
        self.system = FormulaSystem._of(self.tape.native.system(state.tolist(), modes))

    def formulas(self, what: str, function: Function, count: int) -> list[int]:
        """The formulas of a function that returns so many numbers."""
        if isinstance(function, Compiled):
            raise CannotRecord(f"{what}: it is compiled")
        try:
            found = self.tape.record(function, self.state.size, self.table.args)
        except CannotRecord as reason:
            raise CannotRecord(f"{what}: {reason}") from None
        except BaseException as error:
            # Whatever the function raises, it raises again when it runs with numbers.
            kind = type(error).__name__
            raise CannotRecord(f"{what}: {kind} with symbols for t and y: {error}") from None
        if len(found) != count:
            raise CannotRecord(f"{what}: it returns {len(found)} numbers instead of {count}")
        return [symbol.id for symbol in found]

    def mode(self, mode: Mode) -> tuple[str, list[int], list[dict[str, Any]]]:
        """A mode for the native module."""
        about = "the right-hand side"
        if not self.table.plain:
            about += f" of mode {mode.name!r}"
        slopes = self.formulas(about, mode.right_hand_side, self.state.size)
        self.slopes.append((about, mode.right_hand_side, slopes))
        self.guards.append([])
        self.resets.append({})
        rules: list[dict[str, Any]] = []
        for source in [*self.table.events, *mode._sources]:
            values: list[int | None] = [None] * len(source.guards)
            if source.function is not None:
                found = self.formulas(source.label, source.function, len(values))
                self.guards[-1].append((source.label, source.function, found))
                values = list(found)
            for guard, value in zip(source.guards, values, strict=True):
                rules.append(self.rule(guard, value, (mode, slopes, source), len(rules)))
        return mode.name, slopes, rules

    def rule(
        self, guard: Guard, value: int | None, of: tuple[Mode, list[int], _Source], place: int
    ) -> dict[str, Any]:
        """A guard for the native module."""
        mode, slopes, source = of
        about = f"guard {guard.name!r} of mode {mode.name!r}"
        others = {"transition": guard.transition, "rest": guard.rest, "sets": guard.sets}
        for name, other in others.items():
            if other is not None:
                raise CannotRecord(f"{about} has {name}")
        after = None
        if guard.reset is not None:
            what = f"the reset of {about}"
            after = self.formulas(what, guard.reset, self.state.size)
            self.resets[-1][place] = (what, guard.reset)
        order = int(guard.from_zero)
        if self.table.plain and not order and value is not None:
            state = self.state.tolist()
            order = self.tape.native.zero_order(value, slopes, self.start, state)
            if order >= 8:
                raise CannotRecord(f"{source.label} is zero all the time at the start")
        if value is not None and self.tape.native.value(value) is not None:
            raise CannotRecord(f"{source.label} never changes")
        times = guard.times if isinstance(guard, _Clock) else []
        periodic = isinstance(times, tuple)
        if not periodic and not (np.diff(times) >= 0.0).all():
            raise CannotRecord(f"the times of {about} are out of order")
        return {
            "label": guard.name,
            "guard": value,
            "direction": guard.direction,
            "period": times if periodic else None,
            "times": [] if periodic else times,
            "to": self.table.target(guard.to, about),
            "after": after,
            "terminal": int(guard.terminal),
            "from_zero": order,
            "priority": int(guard.priority),
            "sees_jumps": guard.sees_jumps,
        }

    def solve(
        self,
        begin: tuple[int, float, float],
        settings: dict[str, Any],
        times: list[float] | None,
        dense: bool,
    ) -> Solution:
        """Runs the system, and compares the formulas with their functions."""
        first, start, end = begin
        settings = {name: value for name, value in settings.items() if name != "guard_scale"}
        given = (first, start, self.state.tolist())
        found = self.system._native.run([], given, end, settings, times)
        self.compare(found, first)
        return self.system._solution(found, dense, self.table.event_names)

    def compare(self, found: dict[str, Any], first: int) -> None:
        """Refuses formulas that are not what their functions return."""
        self.compare_at(first, self.start, self.state)
        dense = DenseOutput(found, np.array(self.table.names), self.start)
        starts, sizes, modes = found["starts"], found["sizes"], found["segment_modes"]
        chosen = np.unique(np.linspace(0, starts.size - 1, MOST_PLACES).astype(int))
        chosen = chosen[: starts.size]
        # An irrational part of a step is at no event.
        times = starts[chosen] + 0.61803 * sizes[chosen]
        for t, mode, y in zip(times.tolist(), modes[chosen].tolist(), dense(times).T, strict=True):
            self.compare_at(mode, t, y)
        n = self.state.size
        before = found["event_before"].reshape(-1, n)
        after = found["event_after"].reshape(-1, n)
        events = zip(found["event_from"], found["event_guards"], strict=True)
        for row, (mode, guard) in enumerate(list(events)[:MOST_PLACES]):
            if guard in self.resets[mode] and not (before[row] == after[row]).all():
                what, reset = self.resets[mode][guard]
                at = (float(found["event_times"][row]), before[row])
                self.same(what, reset, at, after[row].tolist())

    def compare_at(self, mode: int, t: float, y: NDArray[np.float64]) -> None:
        for what, function, formulas in [self.slopes[mode], *self.guards[mode]]:
            values = self.tape.native.evaluate(formulas, t, y.tolist())
            self.same(what, function, (t, y), values)

    def same(
        self,
        what: str,
        function: Function,
        at: tuple[float, NDArray[np.float64]],
        recorded: list[float],
    ) -> None:
        """Refuses a function that returns something else than its formulas."""
        t, y = at
        assert not isinstance(function, Compiled)
        try:
            with np.errstate(all="ignore"):
                found = function(t, y.copy(), *self.table.args)
                returned = np.asarray(found, dtype=float).reshape(-1).tolist()
        except Exception as error:
            # Without formulas it says so itself, if it is called there.
            raise CannotRecord(f"{what}: {type(error).__name__} at t = {t!r}: {error}") from None
        size = max([1.0, *(abs(value) for value in recorded if math.isfinite(value))])
        near = (
            a == b or (a != a and b != b) or abs(a - b) <= 1e-7 * abs(b) + 1e-10 * size
            for a, b in zip(returned, recorded, strict=False)
        )
        if len(returned) != len(recorded) or not all(near):
            raise CannotRecord(
                f"{what}: at t = {t!r} it returns {returned}, and its formulas {recorded}: it "
                "depends on more than t and y"
            )


def recorded_formulas(function: Function, n: int, args: tuple[Any, ...] = ()) -> list[str]:
    """The formulas of a function f(t, y, *args) of a state with n components, as text.

    They use t, y0, y1, …. Raises ValueError with the reason, if the function is no formula.

    >>> import stickslip
    >>> stickslip.recorded(lambda t, y: [y[1], -np.sin(y[0])], 2)
    ['y1', '-sin(y0)']
    """
    tape = Tape()
    try:
        if isinstance(function, Compiled):
            raise CannotRecord("it is compiled")
        found: list[Symbol] = tape.record(function, n, args)
    except CannotRecord as reason:
        raise ValueError(f"the function cannot be recorded: {reason}") from None
    return tape.native.text([symbol.id for symbol in found], n)
