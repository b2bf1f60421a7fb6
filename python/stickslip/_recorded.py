"""Systems of Python's functions that are recorded as formulas, run, and compared."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain, repeat
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip._compiled import Compiled, Function
from stickslip._derivatives import Rerun
from stickslip._progress import Report, keeping
from stickslip._recording import Tape
from stickslip._signatures import Signer, Unsigned, Watch
from stickslip._solutions import (
    Beside,
    Solution,
    note_interruption,
    with_variables,
)
from stickslip._symbols import CannotRecord, Symbol, Symbols, array_of
from stickslip._systems import Guard, Mode, _Clock, _Source
from stickslip._formulas import FormulaSystem

#: A time, and a state with variables behind it.
Place: TypeAlias = tuple[float, list[float]]
#: Numbers that are compared as they are.
_EXACT, _DOUBLES = {float, int, np.float64}, np.dtype(np.float64)
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
        self.table, self.size, self.names = table, state.size, list(names)
        self.tape = Tape()
        native = self.tape.native
        symbols = [Symbol(self.tape, native.parameter(place)) for place in range(len(names))]
        #: The variables, which follow the components of the state.
        held = table.variables.flat.tolist()
        places = range(state.size, state.size + len(held))
        self.held = [Symbol(self.tape, native.component(place)) for place in places]
        variables = (table.variables.tuple_of(self.held, Symbols),) if held else ()
        #: The start: its time, and its state with variables behind it.
        self.at: Place = (begin[1], state.tolist() + held)
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
        #: and guards; and what follows these.
        self.functions: list[list[tuple[str, Any, list[int], tuple[Any, ...]]]] = []
        self.resets: list[dict[int, tuple[str, Any]]] = []
        self.transitions: list[dict[int, tuple[str, Callable[..., Any]]]] = []
        self.rests: list[dict[int, tuple[str, Callable[..., Any], int, list[int] | None]]] = []
        self.sets: list[dict[int, tuple[str, Callable[..., Any]]]] = []
        #: Events that may start from a zero, whose order depends on the start: rule, label, formula
        #: and slopes.
        self.from_zero: list[tuple[dict[str, Any], str, int, list[int]]] = []
        self.modes = [self.mode(mode) for mode in table.system_modes]
        self.first = begin[0]
        #: What chooses the first mode, and that where it is below 0.
        self.otherwise: tuple[int, int] | None = None
        self.all_formulas = [[one for row in rows for one in row[2]] for rows in self.functions]
        followers = (*self.resets, *self.transitions, *self.rests, *self.sets)
        #: Whether anything follows an event.
        self.follows = any(followers)
        at, args = (begin[1], state.tolist()), (*self._held(self.at), *self.behind)
        self.required = [
            (what, one, self.formulas(what, one, 1, at, args))
            for what, one in ((f"requires {n}", one) for n, one in enumerate(required, 1))
        ]
        begun = None if beginning is None else self.begun(beginning, args, at)
        #: How many starts have left their numbers on the tape.
        self.starts = [0]
        self.from_start = self._constants(self.at if begun is None else (self.at[0], held), begun)
        self.orders = {} if self.values is None else self._orders(self.at, self.values)
        self.given = _bytes(self.at, self.values or [])
        native = self._native(self.at[0], self.from_start, self.orders)
        self.system = FormulaSystem._of(native, list(self.surfaces))
        self.names_of_run = replace(self.system._names, events=table.event_names)
        if self.surfaces:
            of_modes = [it for it in table.names for _ in range(self.width)]
            self.names_of_run = replace(self.names_of_run, modes=of_modes)

    def again(self, table: Any) -> Recorded:
        """The same formulas of functions that return the same."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__, table=table)
        if table.plain:
            (mode,), sources = table.system_modes, table.events
            functions = [mode.right_hand_side, *(source.function for source in sources)]
            rows = zip(self.functions[0], functions, strict=True)
            other.functions = [[(row[0], function, *row[2:]) for row, function in rows]]
        return other

    def starting(self, at: Place, values: list[float]) -> tuple[FormulaSystem, Any]:
        """The system that starts there with values of parameters, and what runs it."""
        if _bytes(at, values) == self.given:
            return self.system, self.system._native
        orders = self._orders(at, values)

        def made() -> Any:
            return self._native(at[0], self._constants(at), orders)

        surfaces = list(self.surfaces)
        if orders == self.orders:
            # Another start is said to the run; few look at the system.
            return FormulaSystem._later(made, surfaces), self.system._native
        system = FormulaSystem._of(made(), surfaces)
        return system, system._native

    def _constants(self, at: Place, front: list[int] | None = None) -> list[int]:
        """Numbers as formulas, behind others."""
        return [*(front or ()), *map(self.tape.native.constant, at[1])]

    def _native(self, start: float, begun: list[int], orders: dict[int, int]) -> Any:
        """The system that starts there, where some events start from zeros of these orders."""
        self.starts[0] += 1
        conditions = [formula for _, _, (formula,) in self.required]
        given = (self.first, start, begun, self.otherwise, conditions)
        modes = [
            (name, slopes, [_from_zero(rule, orders.get(id(rule))) for rule in rules])
            for name, slopes, rules in self.modes
        ]
        surfaces = list(self.surfaces.items())
        try:
            return self.tape.native.system(
                self.names, given, modes, self.table.variables.labels, surfaces
            )
        except ValueError as reason:
            raise CannotRecord(str(reason)) from None

    def _orders(self, at: Place, values: list[float]) -> dict[int, int]:
        """The orders of the zeros from which events start there, by the places of their rules."""
        orders: dict[int, int] = {}
        if not self.from_zero:
            return orders
        native = self.tape.native
        ((*found,),) = native.evaluate([formula for *_, formula, _ in self.from_zero], [at], values)
        for (rule, label, formula, slopes), value in zip(self.from_zero, found, strict=True):
            if value == 0.0:
                orders[id(rule)] = native.zero_order(formula, slopes, *at, values)
                if orders[id(rule)] >= 8:
                    raise CannotRecord(f"{label} is zero all the time at the start")
        return orders

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
            what, function, lambda plain: self.tape.record(plain, self.size, args, at)
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
        self.functions.append([])
        slopes = self.sided(about, mode.right_hand_side)
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
                self.functions[-1].append((source.label, source.function, found, ()))
                values = list(found)
            for guard, value in zip(source.guards, values, strict=True):
                rules.append(self.rule(guard, value, (mode, slopes, source), len(rules)))
        return mode.name, slopes, rules

    def begun(
        self, beginning: Function, args: tuple[Any, ...], at: tuple[float, list[float]]
    ) -> list[int]:
        """The formulas of the state at the start, and the first mode."""
        names, n = self.table.names, self.size

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
        for corner in range(1 << len(self.surfaces)):
            above = [corner >> place & 1 for place in range(len(self.surfaces))]
            signs = (self.table.signs.named([2.0 * one - 1.0 for one in above]),) if above else ()
            args = (*variables, *signs, *self.behind)
            slopes = self.formulas(about, function, self.size, None, args)
            self.functions[-1].append((about, function, slopes, signs))
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
            after = self.formulas(what, guard.reset, self.size)
            self.resets[-1][place] = (what, guard.reset)
        if guard.sets is not None:
            what = f"sets of {about}"
            if not self.held:
                raise CannotRecord(f"{what}: the system has no variables")
            changed = self.changed(what, guard.sets)
            self.sets[-1][place] = (what, self.table.variables.setter(guard.sets, what))
            if after is None:
                after = [self.tape.native.component(i) for i in range(self.size)]
            after = after + changed
        else:
            after = self.with_held(after)
        if value is not None and self.tape.native.value(value) is not None:
            raise CannotRecord(f"{source.label} never changes")
        times = guard.times if isinstance(guard, _Clock) else []
        periodic = isinstance(times, tuple)
        if not periodic and not (np.diff(times) >= 0.0).all():
            raise CannotRecord(f"the times of {about} are out of order")
        rest = None
        if guard.rest is not None:
            rest = self.rest(guard, f"the rest of {about}", place)
        rule = {
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
            "from_zero": int(guard.from_zero),
            "priority": int(guard.priority),
            "sees_jumps": guard.sees_jumps,
        }
        if self.table.plain and not rule["from_zero"] and value is not None:
            self.from_zero.append((rule, source.label, value, slopes))
        return rule

    def choice(self, what: str, transition: Callable[..., Any]) -> tuple[Any, list[int] | None]:
        """The mode to which a transition leads, and the formulas of the state behind it."""
        choose = partial(self.tape.choice, n=self.size, args=self.args)
        choice, state = self.recorded(what, transition, partial(choose, names=self.table.names))
        if state is not None and len(state) != self.size:
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
        record = partial(self.tape.record, n=self.size, args=self.args, numbers=numbers)
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
        state: NDArray[np.float64],
        values: list[float],
        settings: dict[str, Any],
        times: NDArray[np.float64] | None,
        dense: bool,
        report: Report | None,
    ) -> Solution:
        """Runs the system, and compares the formulas with their functions."""
        first, start, end = begin
        at = (start, state.tolist() + self.at[1][self.size :])
        system, native = self.starting(at, values)
        rerun: Rerun = (values, (first * self.width, *at), end, settings)

        def until_now(found: dict[str, Any]) -> Solution | None:
            try:
                self.compare(found, values, at)
            except CannotRecord:
                return None
            note_interruption(found)
            return self._solution(found, dense, (system, rerun))

        with keeping(until_now):
            found = native.run(*rerun, times, dense, report, True)
        self.compare(found, values, at)
        return self._solution(found, dense, (system, rerun))

    def _solution(
        self, found: dict[str, Any], dense: bool, again: tuple[FormulaSystem, Rerun]
    ) -> Solution:
        beside = with_variables(found, self.table.variables)
        if self.surfaces:
            beside = self.with_sides(found, beside or Beside({}, {}, [], {}))
        return Solution(
            found,
            self.names_of_run,
            start=found["start_time"],
            dense=dense,
            guards="decided",
            beside=beside,
            again=again,
        )

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

    @np.errstate(all="ignore")
    def compare(
        self, found: dict[str, Any], values: Sequence[float] = (), at: Place | None = None
    ) -> None:
        """Refuses formulas that are not what their functions return with values of parameters, in
        a run from a start."""
        begun = self.begun_at(values, at or self.at)
        places: dict[int, list[Place]] = {} if begun is None else {begun[0]: [begun[1]]}
        for t, mode, y in found["samples"]:
            places.setdefault(mode // self.width, []).append((t, y))
        for mode, within in places.items():
            self.compare_at(mode, within, values)
        if self.follows and found["event_times"].size:
            self.compare_events(found, values)

    def compare_events(self, found: dict[str, Any], values: Sequence[float]) -> None:
        """Refuses what follows the first events, if it is not what functions return."""
        n = self.size
        before = found["event_before"].reshape(-1, n + len(self.held))
        after = found["event_after"].reshape(-1, n + len(self.held))
        left, guards = found["event_from"] // self.width, found["event_guards"] - self.front
        events = zip(left, guards, strict=True)
        for row, (mode, guard) in enumerate(list(events)[:MOST_PLACES]):
            t = float(found["event_times"][row])
            left_at, at = (t, before[row].tolist()), (t, after[row].tolist())
            if guard in self.resets[mode] and not (before[row] == after[row]).all():
                what, reset = self.resets[mode][guard]
                self.same(what, reset, left_at, values, at[1][:n])
            if guard in self.sets[mode] and not (before[row] == after[row]).all():
                what, setter = self.sets[mode][guard]
                self.same(what, setter, left_at, values, at[1][n:])
            if guard in self.rests[mode]:
                what, rest, rests_in, formulas = self.rests[mode][guard]
                to, state = self.call(rest, at, values)
                if (mode if to is None else to) != rests_in:
                    raise CannotRecord(f"{what}: at t = {t!r} it leads to another mode")
                if state is not None and formulas is not None:
                    given = partial(lambda state, *_: state, state)
                    (now,) = self.tape.native.evaluate(formulas[:n], [at], list(values))
                    self.same(what, given, at, values, now)
            if guard in self.transitions[mode] and found["outcome"] != "ended_by_guard":
                what, transition = self.transitions[mode][guard]
                to, state = self.call(transition, left_at, values)
                target = found["event_to"][row] // self.width
                if to is not None and to != target:
                    name = self.table.names[target]
                    raise CannotRecord(
                        f"{what}: at t = {t!r} it leads to mode {self.table.names[to]!r}, and its "
                        f"formulas to {name!r}: it depends on more than t and y"
                    )
                if state is not None:
                    given = partial(lambda state, *_: state, state)
                    self.same(what, given, left_at, values, at[1][:n])

    @np.errstate(all="ignore")
    def compare_start(self, values: Sequence[float] = ()) -> None:
        """Refuses formulas that differ at the start."""
        begun = self.begun_at(values, self.at)
        if begun is not None:
            self.compare_at(begun[0], [begun[1]], values)

    def begun_at(self, values: Sequence[float], at: Place) -> tuple[int, Place] | None:
        """The mode, the time and the state where a run begins, if it does."""
        if not self.required and self.beginning is None:
            return self.first, at
        evaluate = partial(self.tape.native.evaluate, places=[at], parameters=list(values))
        for what, function, formulas in self.required:
            (found,) = evaluate(formulas)
            self.same(what, function, at, values, found)
            if not found[0] >= 0.0:
                return None
        if self.beginning is None:
            return self.first, at
        (found,) = evaluate(self.from_start)
        first = self.first
        if self.otherwise is not None:
            ((choice,),) = evaluate([self.otherwise[0]])
            first = self.otherwise[1] if choice < 0.0 else first
        transition = self.table.transition(self.beginning, "start")
        to, state = self.call(transition, at, values)
        if to is not None and to != first:
            raise CannotRecord("start: it depends on more than t and y")
        if state is not None:
            given = partial(lambda state, *_: state, state)
            self.same("start", given, at, values, found[: self.size])
        return first, (at[0], found)

    def compare_at(self, mode: int, places: list[Place], values: Sequence[float]) -> None:
        """Refuses a right-hand side and guards that return something else than their formulas."""
        found = self.tape.native.evaluate(self.all_formulas[mode], places, list(values))
        times = [t for t, _ in places]
        states = np.array([y[: self.size] for _, y in places])
        held = [[self._held(at)[0] for at in places]] if self.held else []
        first = 0
        for what, function, formulas, signs in self.functions[mode]:
            recorded = [row[first : first + len(formulas)] for row in found]
            first += len(formulas)
            further = map(repeat, (*signs, *values, *self.table.args))
            returned, error = list[Any](), None
            try:
                # Each call gets a state of its own.
                returned += map(function, times, states.copy(), *held, *further)
            except Exception as raised:
                error = raised
            if not _are_same(returned, recorded):
                for t, one, numbers in zip(times, returned, recorded, strict=False):
                    _refuse_other(what, t, values, one, numbers)
            if len(returned) < len(times):
                raise _raised(what, times[len(returned)], error or StopIteration())

    def call(self, function: Callable[..., Any], at: Place, values: Sequence[float]) -> Any:
        """What a function returns at a time, and at a state with variables behind it."""
        state = np.array(at[1][: self.size])
        return function(at[0], state, *self._held(at), *values, *self.table.args)

    def _held(self, at: Place) -> tuple[Any, ...]:
        """The variables, if there are any."""
        return (self.table.variables.named(at[1][self.size :]),) if self.held else ()

    def same(
        self,
        what: str,
        function: Any,
        at: Place,
        values: Sequence[float],
        recorded: list[float],
    ) -> None:
        """Refuses a function that returns something else than its formulas."""
        try:
            found = self.call(function, at, values)
        except Exception as error:
            raise _raised(what, at[0], error) from None
        _refuse_other(what, at[0], values, found, recorded)


def _are_same(returned: list[Any], recorded: list[list[float]]) -> bool:
    """Whether a function has returned the very numbers, as most do."""
    kinds = {*map(type, returned)}
    if kinds <= _EXACT:
        return len(recorded[0]) == 1 and returned == [*chain.from_iterable(recorded)]
    if kinds == {np.ndarray}:
        doubles = all(array.dtype is _DOUBLES for array in returned)
        return doubles and [array.tolist() for array in returned] == recorded
    if kinds <= {list, tuple} and _EXACT.issuperset(map(type, chain.from_iterable(returned))):
        return (returned if kinds == {list} else [*map(list, returned)]) == recorded
    return False


def _refuse_other(
    what: str, t: float, values: Sequence[float], found: Any, recorded: list[float]
) -> None:
    """Refuses what a function has returned if its formulas are something else."""
    try:
        returned = np.asarray(found, dtype=float).reshape(-1).tolist()
    except Exception as error:
        raise _raised(what, t, error) from None
    if returned == recorded:
        return
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


def _raised(what: str, t: float, error: Exception) -> CannotRecord:
    """Without formulas the function says so itself, if it is called there."""
    return CannotRecord(f"{what}: {type(error).__name__} at t = {t!r}: {error}")


def _from_zero(rule: dict[str, Any], order: int | None) -> dict[str, Any]:
    """A rule whose guard starts from a zero of an order."""
    return rule if order is None else rule | {"from_zero": order}


def _bytes(at: Place, values: list[float]) -> bytes:
    """What tells starts apart, also zeros of another sign."""
    return array("d", (at[0], *at[1], *values)).tobytes()


#: What was recorded last, by the signatures of the functions, and what must live on for these.
_KEPT: dict[Any, tuple[Recorded, list[Any]]] = {}
#: The same by the places of the functions, as long as all that these read is the same.
_WATCHED: dict[Any, tuple[Recorded, Watch]] = {}
MOST_KEPT = 64
#: Starts of the same formulas, each of which leaves its numbers on their tape.
MOST_STARTS = 50


def watched(key: Any) -> Recorded | None:
    """What was recorded of the same functions, if all that they read is the same."""
    found = _WATCHED.get(key)
    if found is None or found[0].starts[0] >= MOST_STARTS or not found[1].holds():
        return None
    return found[0]


def recording(
    place: Any,
    table: Any,
    begin: tuple[int, float],
    state: NDArray[np.float64],
    names: Sequence[str],
    values: Sequence[float],
) -> Recorded:
    """The formulas of a system, kept as long as all that its functions read is the same.

    place: what tells the system and its functions apart by their places.
    """
    given = (table, begin, state, names, values)
    if table.variables or table.surfaces:
        return Recorded(*given)
    signer = Signer()
    of = (state.size, begin[0], *names, table.formed_of)
    try:
        key = signer.signature(of)
        kept = _KEPT.get(key)
        if kept is not None and kept[0].starts[0] < MOST_STARTS:
            found = kept[0].again(table)
        else:
            found = Recorded(*given)
            if Signer().signature(of) != key:
                # Something has changed meanwhile.
                return found
            _keep(_KEPT, key, (found, signer.kept))
    except Unsigned:
        return Recorded(*given)
    watch = signer.watch(table.functions, table.reads)
    if watch is not None:
        _keep(_WATCHED, place, (found, watch))
    return found


def _keep(known: dict[Any, Any], key: Any, value: Any) -> None:
    """Keeps a value in the place of the first one, if there are many."""
    if len(known) >= MOST_KEPT and key not in known:
        known.pop([*known][0], None)
    known[key] = value


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
