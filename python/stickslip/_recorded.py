"""Systems of Python's functions that are recorded as formulas, run, and compared."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip._compiled import Compiled, Function
from stickslip._derivatives import Rerun
from stickslip._progress import Report, keeping
from stickslip._recording import Tape
from stickslip._solutions import (
    Beside,
    Solution,
    note_interruption,
    with_variables,
)
from stickslip._symbols import CannotRecord, Symbol, Symbols, array_of
from stickslip._systems import Guard, Mode, _Clock, _Source
from stickslip._formulas import FormulaSystem

#: Events at which formulas are compared with their functions.
MOST_PLACES = 8


class Recorded:
    """The formulas of a system, and the functions from which they come.

    names: those of parameters that functions get before further arguments. values: their values, if
    these are known. beginning: a function of the start that returns the state there, the mode, or
    (mode, state). required: functions of the start that must not be negative there.

    Raises CannotRecord with the reason, if a function is no formula.
    """

    def __init__(
        self,
        table: Any,
        begin: tuple[int, float],
        state: NDArray[np.float64],
        names: Sequence[str] = (),
        values: Sequence[float] | None = None,
        beginning: Function | None = None,
        required: Sequence[Function] = (),
    ) -> None:
        if not state.size:
            raise CannotRecord("there is no state")
        if table.apart:
            raise CannotRecord("guards of several modes are counted until the run ends")
        self.table, self.state, self.start = table, state, begin[1]
        self.tape = Tape()
        native = self.tape.native
        symbols = [Symbol(self.tape, native.parameter(place)) for place in range(len(names))]
        #: The variables, which follow the components of the state.
        held = table.variables.flat.tolist()
        places = range(state.size, state.size + len(held))
        self.held = [Symbol(self.tape, native.component(place)) for place in places]
        variables = (table.variables.tuple_of(self.held, Symbols),) if held else ()
        self.behind = (*symbols, *table.args)
        self.args = (*variables, *self.behind)
        self.values = list(values) if values is not None else None if names else []
        self.beginning = beginning
        surfaces = table.surfaces.items()
        self.surfaces = {
            name: self.formulas(f"surface {name!r}", surface, 1)[0] for name, surface in surfaces
        }
        #: The modes that take the place of one, and the rules of surfaces in front of its own.
        self.width = 5 ** len(self.surfaces) + 1 if self.surfaces else 1
        self.front = 2 * len(self.surfaces)
        #: For each mode, functions with their formulas: the right-hand side with signs of surfaces,
        #: guards, and resets.
        self.slopes: list[list[tuple[str, Function, list[int], Any]]] = []
        self.guards: list[list[tuple[str, Function, list[int]]]] = []
        self.resets: list[dict[int, tuple[str, Function]]] = []
        self.transitions: list[dict[int, tuple[str, Callable[..., Any]]]] = []
        self.rests: list[dict[int, tuple[str, Callable[..., Any], int, list[int] | None]]] = []
        self.sets: list[dict[int, tuple[str, Callable[..., Any]]]] = []
        modes = [self.mode(mode) for mode in table.system_modes]
        self.first = begin[0]
        #: What chooses the first mode, and that where it is below 0.
        self.otherwise: tuple[int, int] | None = None
        now = (table.variables.named(held),) if held else ()
        at, args = (self.start, state.tolist()), (*now, *self.behind)
        self.required = [
            (what, one, self.formulas(what, one, 1, at, args))
            for what, one in ((f"requires {n}", one) for n, one in enumerate(required, 1))
        ]
        if beginning is None:
            first = [native.constant(value) for value in state.tolist()]
        else:
            first = self.begun(beginning, args, at)
        first += [native.constant(value) for value in held]
        self.from_start = first
        conditions = [formula for _, _, (formula,) in self.required]
        given = (self.first, self.start, first, self.otherwise, conditions)
        labels, surfaces = table.variables.labels, list(self.surfaces.items())
        try:
            made = native.system(list(names), given, modes, labels, surfaces)
        except ValueError as reason:
            raise CannotRecord(str(reason)) from None
        self.system = FormulaSystem._of(made, list(self.surfaces))

    def formulas(
        self,
        what: str,
        function: Function,
        count: int,
        at: tuple[float, list[float]] | None = None,
        args: tuple[Any, ...] | None = None,
    ) -> list[int]:
        """The formulas of a function that returns so many numbers."""
        args = self.args if args is None else args
        found = self.recorded(
            what, function, lambda plain: self.tape.record(plain, self.state.size, args, at)
        )
        if len(found) != count:
            raise CannotRecord(f"{what}: it returns {len(found)} numbers instead of {count}")
        return [symbol.id for symbol in found]

    def recorded(
        self, what: str, function: Function, record: Callable[[Callable[..., Any]], Any]
    ) -> Any:
        """What is recorded of a function."""
        if isinstance(function, Compiled):
            raise CannotRecord(f"{what}: it is compiled")
        try:
            return record(function)
        except CannotRecord as reason:
            raise CannotRecord(f"{what}: {reason}") from None
        except BaseException as error:
            # Whatever the function raises, it raises again when it runs with numbers.
            kind = type(error).__name__
            raise CannotRecord(f"{what}: {kind} with symbols for t and y: {error}") from None

    def mode(self, mode: Mode) -> tuple[str, list[int], list[dict[str, Any]]]:
        """A mode for the native module."""
        about = "the right-hand side"
        if not self.table.plain:
            about += f" of mode {mode.name!r}"
        slopes = self.sided(about, mode.right_hand_side)
        self.guards.append([])
        self.resets.append({})
        self.transitions.append({})
        self.rests.append({})
        self.sets.append({})
        slopes = slopes + [self.tape.native.constant(0.0)] * len(self.held)
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

    def begun(
        self, beginning: Function, args: tuple[Any, ...], at: tuple[float, list[float]]
    ) -> list[int]:
        """The formulas of the state at the start, and the first mode."""
        names, n = self.table.names, self.state.size

        def record(plain: Callable[..., Any]) -> Any:
            return self.tape.choice(plain, n, args, names, at)

        choice, found = self.recorded("start", beginning, record)
        state = [symbol.id for symbol in found or map(self.tape.number, at[1])]
        if len(state) != n:
            raise CannotRecord(f"start: it returns {len(state)} numbers instead of {n}")
        if isinstance(choice, tuple):
            self.first, self.otherwise = choice[1], (choice[0].id, choice[2])
        elif choice is not None:
            self.first = choice
        return state

    def sided(self, about: str, function: Function) -> list[int]:
        """The formulas of a right-hand side, which choose between those beside surfaces."""
        variables = self.args[: len(self.args) - len(self.behind)]
        every: list[list[int]] = []
        self.slopes.append([])
        for corner in range(1 << len(self.surfaces)):
            above = [corner >> place & 1 for place in range(len(self.surfaces))]
            signs = self.table.signs.named([2.0 * one - 1.0 for one in above]) if above else None
            args = self.args if signs is None else (*variables, signs, *self.behind)
            slopes = self.formulas(about, function, self.state.size, None, args)
            self.slopes[-1].append((about, function, slopes, signs))
            every.append(slopes)
        for surface in reversed(self.surfaces.values()):
            half = len(every) // 2
            every = [
                [self.tape.native.select(surface, *pair) for pair in zip(above, below, strict=True)]
                for below, above in zip(every[:half], every[half:], strict=True)
            ]
        return every[0]

    def rule(
        self, guard: Guard, value: int | None, of: tuple[Mode, list[int], _Source], place: int
    ) -> dict[str, Any]:
        """A guard for the native module."""
        mode, slopes, source = of
        about = f"guard {guard.name!r} of mode {mode.name!r}"
        after, to, branch = None, self.table.target(guard.to, about), None
        if guard.transition is not None:
            what = f"the transition of {about}"
            choice, after = self.choice(what, guard.transition)
            self.transitions[-1][place] = (what, self.table.transition(guard.transition, what))
            if isinstance(choice, tuple):
                branch = (choice[0].id, *choice[1:])
            elif choice is not None:
                to = choice
        if guard.reset is not None:
            what = f"the reset of {about}"
            after = self.formulas(what, guard.reset, self.state.size)
            self.resets[-1][place] = (what, guard.reset)
        if guard.sets is not None:
            what = f"sets of {about}"
            if not self.held:
                raise CannotRecord(f"{what}: the system has no variables")
            changed = self.changed(what, guard.sets)
            self.sets[-1][place] = (what, self.table.variables.setter(guard.sets, what))
            if after is None:
                after = [self.tape.native.component(i) for i in range(self.state.size)]
            after = after + changed
        else:
            after = self.with_held(after)
        order = int(guard.from_zero)
        if self.table.plain and not order and value is not None and self.values is not None:
            state = self.state.tolist()
            known = (self.start, state, self.values)
            order = self.tape.native.zero_order(value, slopes, *known)
            if order >= 8:
                raise CannotRecord(f"{source.label} is zero all the time at the start")
        if value is not None and self.tape.native.value(value) is not None:
            raise CannotRecord(f"{source.label} never changes")
        times = guard.times if isinstance(guard, _Clock) else []
        periodic = isinstance(times, tuple)
        if not periodic and not (np.diff(times) >= 0.0).all():
            raise CannotRecord(f"the times of {about} are out of order")
        rest = None
        if guard.rest is not None:
            rest = self.rest(guard, f"the rest of {about}", place)
        return {
            "label": guard.name,
            "guard": value,
            "direction": guard.direction,
            "period": times if periodic else None,
            "times": [] if periodic else times,
            "to": to,
            "branch": branch,
            "after": after,
            "rest": rest,
            "terminal": int(guard.terminal),
            "from_zero": order,
            "priority": int(guard.priority),
            "sees_jumps": guard.sees_jumps,
        }

    def choice(self, what: str, transition: Callable[..., Any]) -> tuple[Any, list[int] | None]:
        """The mode to which a transition leads, and the formulas of the state behind it."""
        choose = partial(self.tape.choice, n=self.state.size, args=self.args)
        choice, state = self.recorded(what, transition, partial(choose, names=self.table.names))
        if state is not None and len(state) != self.state.size:
            raise CannotRecord(f"{what}: it returns a state of {len(state)} components")
        return choice, None if state is None else [symbol.id for symbol in state]

    def changed(self, what: str, sets: Any) -> list[int]:
        """The formulas of the variables where some are set."""
        variables = self.table.variables

        def numbers(found: Any) -> list[Symbol]:
            if not isinstance(found, Mapping):
                raise CannotRecord("it returns no mapping")
            variables._expect(found, what)
            parts: list[Symbol] = []
            for name, old in variables.columns(np.arange(len(self.held)).reshape(1, -1)).items():
                value = np.asarray(array_of(found.get(name, 0.0)), dtype=object)
                if name not in found:
                    parts += [self.held[place] for place in old.reshape(-1)]
                elif value.shape != variables.shapes[name]:
                    raise CannotRecord(f"{name!r} gets shape {value.shape}")
                else:
                    parts += map(self.tape.number, value.reshape(-1))
            return parts

        if not callable(sets):
            return [symbol.id for symbol in numbers(sets)]
        record = partial(self.tape.record, n=self.state.size, args=self.args, numbers=numbers)
        return [symbol.id for symbol in self.recorded(what, sets, record)]

    def with_held(self, after: list[int] | None) -> list[int] | None:
        """Formulas of a state, with those of variables that stay."""
        return None if after is None else after + [symbol.id for symbol in self.held]

    def rest(self, guard: Guard, what: str, place: int) -> tuple[int, list[int] | None]:
        """What follows where events accumulate."""
        if isinstance(guard.rest, str | Mode):
            to = self.table.target(guard.rest, what)
            assert to is not None
            return to, None
        assert guard.rest is not None
        choice, after = self.choice(what, guard.rest)
        if isinstance(choice, tuple):
            raise CannotRecord(f"{what}: it chooses between modes")
        to = len(self.rests) - 1 if choice is None else choice
        after = self.with_held(after)
        self.rests[-1][place] = (what, self.table.transition(guard.rest, what), to, after)
        return to, after

    def solve(
        self,
        begin: tuple[int, float, float],
        settings: dict[str, Any],
        times: NDArray[np.float64] | None,
        dense: bool,
        report: Report | None,
    ) -> Solution:
        """Runs the system, and compares the formulas with their functions."""
        first, start, end = begin
        first *= self.width
        settings = {name: value for name, value in settings.items() if name != "guard_scale"}
        given = (first, start, self.state.tolist() + self.table.variables.flat.tolist())
        values = self.values or []
        rerun: Rerun = (values, given, end, settings)

        def until_now(found: dict[str, Any]) -> Solution | None:
            try:
                self.compare(found, tuple(values))
            except CannotRecord:
                return None
            note_interruption(found)
            return self._solution(found, dense, rerun)

        with keeping(until_now):
            found = self.system._native.run(*rerun, times, dense, report)
        self.compare(found, tuple(values))
        return self._solution(found, dense, rerun)

    def _solution(self, found: dict[str, Any], dense: bool, rerun: Rerun) -> Solution:
        beside = with_variables(found, self.table.variables)
        names = replace(self.system._names, events=self.table.event_names)
        if self.surfaces:
            names = replace(names, modes=[it for it in self.table.names for _ in range(self.width)])
            beside = self.with_sides(found, beside or Beside({}, {}, [], {}))
        return self.system._solution(found, dense, rerun, names, beside)

    def with_sides(self, found: dict[str, Any], beside: Beside) -> Beside:
        """What stands beside a solution, with the sides of surfaces."""
        signs = np.array([1, -1, 0, 1, -1], dtype=np.int8)

        def sides(modes: NDArray[np.int64]) -> dict[str, NDArray[np.int8]]:
            parts = modes % self.width
            every = enumerate(self.surfaces)
            return {name: signs[parts // 5**place % 5] for place, name in every}

        kinds = [(name, "i1") for name in self.surfaces]
        columns = [("sides_from", kinds), ("sides_to", kinds), ("unique", "?")]
        behind = {
            "sides_from": sides(found["event_from"]),
            "sides_to": sides(found["event_to"]),
            # Where it is not, the formulas end.
            "unique": np.ones(len(found["event_to"]), dtype=bool),
        }
        return replace(
            beside,
            sides=sides(found["modes"]),
            columns=[*beside.columns, *columns],
            behind=beside.behind | behind,
        )

    def compare(self, found: dict[str, Any], values: tuple[float, ...] = ()) -> None:
        """Refuses formulas that are not what their functions return with values of parameters."""
        self.compare_start(values)
        for t, mode, y in found["samples"]:
            self.compare_at(mode // self.width, t, np.array(y), values)
        n = self.state.size
        before = found["event_before"].reshape(-1, n + len(self.held))
        after = found["event_after"].reshape(-1, n + len(self.held))
        left, guards = found["event_from"] // self.width, found["event_guards"] - self.front
        events = zip(left, guards, strict=True)
        for row, (mode, guard) in enumerate(list(events)[:MOST_PLACES]):
            if guard in self.resets[mode] and not (before[row] == after[row]).all():
                what, reset = self.resets[mode][guard]
                at = (float(found["event_times"][row]), before[row])
                self.same(what, reset, at, values, after[row, :n].tolist())
            if guard in self.sets[mode] and not (before[row] == after[row]).all():
                what, setter = self.sets[mode][guard]
                at = (float(found["event_times"][row]), before[row])
                self.same(what, setter, at, values, after[row, n:].tolist())
            if guard in self.rests[mode]:
                what, rest, rests_in, formulas = self.rests[mode][guard]
                at = (float(found["event_times"][row]), after[row])
                to, state = self.call(rest, at, values)
                if (mode if to is None else to) != rests_in:
                    raise CannotRecord(f"{what}: at t = {at[0]!r} it leads to another mode")
                if state is not None and formulas is not None:
                    given = partial(lambda state, *_: state, state)
                    native = self.tape.native
                    formulas = formulas[:n]
                    now = native.evaluate(formulas, at[0], after[row].tolist(), list(values))
                    self.same(what, given, at, values, now)
            if guard in self.transitions[mode] and found["outcome"] != "ended_by_guard":
                what, transition = self.transitions[mode][guard]
                t, y = float(found["event_times"][row]), before[row]
                to, state = self.call(transition, (t, y), values)
                target = found["event_to"][row] // self.width
                if to is not None and to != target:
                    name = self.table.names[target]
                    raise CannotRecord(
                        f"{what}: at t = {t!r} it leads to mode {self.table.names[to]!r}, and its "
                        f"formulas to {name!r}: it depends on more than t and y"
                    )
                if state is not None:
                    given = partial(lambda state, *_: state, state)
                    self.same(what, given, (t, y), values, after[row, :n].tolist())

    def compare_start(self, values: tuple[float, ...] = ()) -> None:
        """Refuses formulas that differ at the start."""
        at = (self.start, np.append(self.state, self.table.variables.flat))
        native = self.tape.native
        for what, function, formulas in self.required:
            found = native.evaluate(formulas, self.start, at[1].tolist(), list(values))
            self.same(what, function, at, values, found)
            if not found[0] >= 0.0:
                return
        found = native.evaluate(self.from_start, self.start, at[1].tolist(), list(values))
        first = self.first
        if self.otherwise is not None:
            (choice,) = native.evaluate([self.otherwise[0]], self.start, [], list(values))
            first = self.otherwise[1] if choice < 0.0 else first
        if self.beginning is not None:
            transition = self.table.transition(self.beginning, "start")
            to, state = self.call(transition, at, values)
            if to is not None and to != first:
                raise CannotRecord("start: it depends on more than t and y")
            if state is not None:
                given = partial(lambda state, *_: state, state)
                self.same("start", given, at, values, found[: self.state.size])
        self.compare_at(first, self.start, np.array(found), values)

    def compare_at(
        self, mode: int, t: float, y: NDArray[np.float64], values: tuple[float, ...]
    ) -> None:
        native = self.tape.native
        for what, function, formulas, signs in self.slopes[mode]:
            found = native.evaluate(formulas, t, y.tolist(), list(values))
            self.same(what, function, (t, y), values, found, signs)
        for what, function, formulas in self.guards[mode]:
            found = native.evaluate(formulas, t, y.tolist(), list(values))
            self.same(what, function, (t, y), values, found)

    def call(
        self,
        function: Callable[..., Any],
        at: tuple[float, NDArray[np.float64]],
        values: tuple[float, ...],
        signs: Any = None,
    ) -> Any:
        """What a function returns at a time, and at a state with variables behind it."""
        n = self.state.size
        held = (self.table.variables.named(at[1][n:]),) if self.held else ()
        signs = () if signs is None else (signs,)
        return function(at[0], at[1][:n].copy(), *held, *signs, *values, *self.table.args)

    def same(
        self,
        what: str,
        function: Function,
        at: tuple[float, NDArray[np.float64]],
        values: tuple[float, ...],
        recorded: list[float],
        signs: Any = None,
    ) -> None:
        """Refuses a function that returns something else than its formulas."""
        t, _ = at
        assert not isinstance(function, Compiled)
        try:
            with np.errstate(all="ignore"):
                found = self.call(function, at, values, signs)
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
                f"{what}: at t = {t!r}{''.join(f', {value!r}' for value in values)} it returns "
                f"{returned}, and its formulas {recorded}: it depends on more than t and y"
            )


def recorded(function: Function, n: int, args: tuple[Any, ...] = ()) -> list[str]:
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
    except Exception as error:
        kind = type(error).__name__
        raise ValueError(f"the function cannot be recorded: {kind}: {error}") from None
    return tape.native.text([symbol.id for symbol in found], n)
