"""Systems of formulas: read from a text, decided, and run without the interpreter.

`system` makes one of a text, `read` of a file. The language is described in docs/systems.md of the
repository.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip._compiled import _number
from stickslip._derivatives import Rerun, Sensitivities, sensitivities_of
from stickslip._progress import Progress, keeping, reported, reporting
from stickslip._run_arguments import MOST_STEPS, settings_of, span, state_at_start, times_within
from stickslip._solutions import Names, Solution, note_interruption

# A run needs none of these, which take longer to import than numpy's own functions.
if TYPE_CHECKING:
    from pathlib import Path

    from stickslip._attractors import Basins, Diagram, Exponents
    from stickslip._orbit_regions import OrbitRegions
    from stickslip._orbits import Branch, Orbit, SpecialCurve, SpecialOrbit
    from stickslip._studies import Study

Floats: TypeAlias = NDArray[np.float64]
Native: TypeAlias = _native.FormulaSystem
Orbits: TypeAlias = _native.OrbitSystem


class FormulaSystem:
    """A hybrid system that is made of formulas. `system` and `read` make one.

    >>> import stickslip
    >>> decay = stickslip.system("parameter rate = 1\\nstate x = 1\\nx' = -rate*x\\nend = 1")
    >>> round(float(decay.solve(parameters={"rate": 2.0}).y[0, -1]), 10)
    0.1353352832
    """

    def __init__(self, text: str) -> None:
        self._native = _native.FormulaSystem(text)
        #: The surfaces of functions of Python.
        self._surfaces: tuple[str, ...] = ()

    @classmethod
    def _of(cls, native: _native.FormulaSystem, surfaces: Sequence[str] = ()) -> FormulaSystem:
        system = cls.__new__(cls)
        system._native, system._surfaces = native, tuple(surfaces)
        return system

    @classmethod
    def _later(cls, make: Callable[[], Native], surfaces: Sequence[str]) -> FormulaSystem:
        """The system that is made when it is looked at."""
        system = cls.__new__(cls)
        system.__dict__.update(_make=make, _surfaces=tuple(surfaces))
        return system

    @cached_property
    def _native(self) -> Native:
        made: Native = self.__dict__["_make"]()
        return made

    @property
    def text(self) -> str:
        """The system as text, which reads as the same system."""
        return self._native.text()

    @property
    def parameters(self) -> dict[str, float]:
        """The values that parameters have unless others are given, by name."""
        return dict(self._defaults)

    @cached_property
    def _size(self) -> int:
        return len(self.components)

    @cached_property
    def _defaults(self) -> dict[str, float]:
        return {name: value for name, value, _ in self._native.parameters()}

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The ranges of interest of parameters that have one."""
        rows = self._native.parameters()
        return {name: interval for name, _, interval in rows if interval is not None}

    @property
    def components(self) -> list[str]:
        """The names of the components of the state, those that only rules change among them."""
        return [name for name, _ in self._native.components()]

    @property
    def modes(self) -> list[str]:
        """The names of the modes."""
        return [name for name, _ in self._native.modes()]

    def values(self, parameters: Mapping[str, float] | None = None) -> list[float]:
        """The values of all parameters in order, with others for some names.

        Raises ValueError if a name or a value is wrong.
        """
        values = self.parameters
        for name, value in (parameters or {}).items():
            if name not in values:
                known = ", ".join(values) or "none"
                raise ValueError(f"parameters: {name!r} is no parameter; expected one of {known}")
            values[name] = _number(value, name)
        return list(values.values())

    def solve(
        self,
        t_span: ArrayLike | None = None,
        y0: ArrayLike | None = None,
        mode: str | None = None,
        *,
        parameters: Mapping[str, float] | None = None,
        method: str = "dop853",
        rtol: ArrayLike = 1e-10,
        atol: ArrayLike = 1e-12,
        t_eval: ArrayLike | None = None,
        dense_output: bool = False,
        max_step: float = np.inf,
        first_step: float | None = None,
        max_switches: int = 10_000_000,
        max_steps: int = MOST_STEPS,
        progress: Progress | None = None,
    ) -> Solution:
        """Runs the system through every event.

        t_span, y0 and mode replace the start and the end that the system has. parameters: other
        values, by name. The rest is as in `stickslip.solve`. Guards of the events are the rules,
        by their labels.

        Raises ValueError if a name or a value is wrong, and ComputationError if the run fails.
        Ctrl-C keeps the run up to there as `partial` of the KeyboardInterrupt.
        """
        steps, most = (max_step, first_step), (max_switches, max_steps)
        begin = (t_span, y0, mode)
        rerun = self._arguments(begin, parameters, method, (rtol, atol), steps, most)
        values, given, end, settings = rerun
        start = given[1]
        low, high = (-np.inf if start is None else start, np.inf if end is None else end)
        times = None if t_eval is None else times_within(t_eval, low, high)
        def until_now(found: dict[str, Any]) -> Solution:
            note_interruption(found)
            return self._solution(found, bool(dense_output), rerun)

        with keeping(until_now):
            run = partial(self._native.run, values, given, end, settings, times, bool(dense_output))
            found = reporting(progress, "solve", run)
        return self._solution(found, bool(dense_output), rerun)

    def sensitivities(
        self,
        *by: str,
        t_span: ArrayLike | None = None,
        y0: ArrayLike | None = None,
        mode: str | None = None,
        parameters: Mapping[str, float] | None = None,
        method: str = "dop853",
        rtol: float = 1e-10,
        atol: float = 1e-12,
        max_step: float = np.inf,
        first_step: float | None = None,
        max_switches: int = 10_000_000,
        max_steps: int = MOST_STEPS,
        progress: Progress | None = None,
    ) -> Sensitivities:
        """Runs the system together with derivatives by parameters, and by values of components at
        the start, through every event. The rest is as in `solve`.

        Derivatives are as accurate as the states. Those of formulas are formulas: nothing is
        differenced. Raises ComputationError where there are none: at a graze. Where events
        accumulate, the run with derivatives ends, also if the system goes on from there by `rest`.

        >>> import stickslip
        >>> ball = stickslip.system(\"\"\"
        ... parameter e = 0.5
        ... state x = 0, v = 4.905
        ... x' = v
        ... v' = -9.81
        ... when x < 0 "bounce"
        ...   x := 0
        ...   v := -e*v
        ... end = 1.6
        ... \"\"\")
        >>> found = ball.sensitivities("e", "v")
        >>> found.t[:2].round(9).tolist(), found.t_by[1].round(9).tolist()
        ([1.0, 1.5], [1.0, 0.305810398])
        """
        steps, most = (max_step, first_step), (max_switches, max_steps)
        begin = (t_span, y0, mode)
        rerun = self._arguments(begin, parameters, method, (rtol, atol), steps, most)
        return sensitivities_of(self, by, rerun, progress)

    def orbit(
        self,
        *,
        itinerary: Sequence[str] | None = None,
        start: ArrayLike | None = None,
        mode: str | None = None,
        time: float | None = None,
        durations: ArrayLike | None = None,
        settle: float | None = None,
        near: Orbit | None = None,
        parameters: Mapping[str, float] | None = None,
        progress: Progress | None = None,
    ) -> Orbit:
        """The periodic orbit near a guess, its multipliers, and whether the system follows it.

        itinerary: the rules that end the segments, in order. From start, mode and time (those of
        the system if they are not given) these rules act one after another, others are not looked
        at, and the search goes on from there; durations of the segments may be given instead.
        settle: a run of this time from the start settles to the orbit. near: an orbit at other
        parameters, with the same itinerary. One of itinerary, settle and near is needed. progress:
        of settling, as in `stickslip.solve`.

        States are accurate to about 1e-12 of their size, multipliers to 1e-11 of the largest one.
        Raises ValueError if a name or a value is wrong, ComputationError if there is no orbit.

        >>> import stickslip
        >>> relay = stickslip.system(\"\"\"
        ... parameter width = 0.5
        ... state x = 0
        ... mode up
        ...   x' = 1 - x
        ...   when x > width "down" -> down
        ... mode down
        ...   x' = -1 - x
        ...   when x < -width "up" -> up
        ... start in up
        ... \"\"\")
        >>> orbit = relay.orbit(itinerary=["down", "up"])
        >>> round(orbit.period, 12), orbit.admissible, orbit.stable
        (2.197224577336, True, True)
        """
        from stickslip import _orbits

        return _orbits.orbit(
            self, itinerary, (start, mode, time), durations, settle, near, parameters, progress
        )

    def branch(
        self,
        orbit: Orbit,
        parameter: str,
        interval: tuple[float, float],
        *,
        longest_step: float = 0.05,
        most_points: int = 2000,
        progress: Progress | None = None,
    ) -> Branch:
        """The branch of an orbit over an interval of a parameter, in both directions, through folds
        and grazes. Orbits that the system does not follow are kept and marked.

        longest_step: along the branch, of the size of what changes. most_points: in either
        direction. Special orbits are located to about 1e-11 of the interval. progress: called now
        and then with the number of points, twice; True shows a bar on stderr.

        Raises ValueError if a name or a value is wrong, ComputationError if the branch does not
        begin. Where it breaks off later, `objection` says why.

        >>> import stickslip
        >>> ball = stickslip.system(\"\"\"
        ... parameter a = 0.02, r = 0.7
        ... state x = 0.015, v = 0.5, phase = 0.8
        ... table = a*sin(phase)
        ... x' = v
        ... v' = -1
        ... phase' = 2*pi
        ... when x < table "bounce"
        ...   x := table
        ...   v := (1 + r)*table' - r*v
        ... when phase > 2*pi "period"
        ...   phase := phase - 2*pi
        ... \"\"\")
        >>> orbit = ball.orbit(itinerary=["period", "bounce"])
        >>> branch = ball.branch(orbit, "a", (0.005, 0.05))
        >>> [(it.kind, round(it.value, 10)) for it in branch.specials if it.kind == "flip"]
        [('flip', 0.029654967)]
        """
        steps = (longest_step, most_points)
        from stickslip import _orbits

        return _orbits.branch(self, orbit, parameter, interval, steps, progress)

    def resumed(
        self,
        branch: Branch,
        interval: tuple[float, float],
        *,
        longest_step: float = 0.05,
        most_points: int = 2000,
        progress: Progress | None = None,
    ) -> Branch:
        """A branch that goes on from both of its ends, over an interval that contains its own, or
        from where it broke off. What it has stays as it is.

        Raises ValueError if a value is wrong, or if the branch is closed.
        """
        steps = (longest_step, most_points)
        from stickslip import _orbits

        return _orbits.resumed(self, branch, interval, steps, progress)

    def read_branch(self, path: str | Path) -> Branch:
        """The branch in a JSON file that `Branch.save` or the program has written. Its orbits are
        looked at again: whether the system follows them is decided anew.

        Raises ValueError if the file has no branch of this system, or has changed since it was
        written.
        """
        from stickslip import _orbits

        return _orbits.read_branch(self, path)

    def curve(
        self,
        special: SpecialOrbit,
        parameters: tuple[str, str],
        x: tuple[float, float],
        y: tuple[float, float],
        *,
        longest_step: float = 0.05,
        progress: Progress | None = None,
    ) -> SpecialCurve:
        """The curve of a special orbit of a branch over two parameters, in the window of the
        intervals x and y, in both directions. `meetings` are orbits at which something else changes
        too, with their names: resonance-1-1, resonance-1-2, double-graze, cusp, fold-grazing.

        Raises ValueError if a name or a value is wrong, or for the kinds branch-point, infinite-period and
        boundary,
        and ComputationError if the curve does not begin.
        """
        from stickslip import _orbits

        return _orbits.curve(self, special, parameters, (x, y), longest_step, progress)

    def orbit_regions(
        self,
        orbit: Orbit,
        parameters: tuple[str, str],
        x: tuple[float, float],
        y: tuple[float, float],
        *,
        cells: int = 5,
        progress: Progress | None = None,
    ) -> OrbitRegions:
        """Where orbits of the itinerary of an orbit exist and are stable over two parameters, in
        the window of the intervals x and y. Each region says which orbits the system follows there,
        each boundary what changes. Lines on which orbits are followed divide each side of the
        window into so many cells.

        Raises ValueError if a name or a value is wrong, ComputationError if the orbit cannot be
        followed. What is not explained is in doubt, and `objection` says what.

        >>> import stickslip
        >>> ball = stickslip.system(\"\"\"
        ... parameter a = 0.02, r = 0.7
        ... state x = 0.015, v = 0.5, phase = 0.8
        ... table = a*sin(phase)
        ... x' = v
        ... v' = -1
        ... phase' = 2*pi
        ... when x < table "bounce"
        ...   x := table
        ...   v := (1 + r)*table' - r*v
        ... when phase > 2*pi "period"
        ...   phase := phase - 2*pi
        ... \"\"\")
        >>> orbit = ball.orbit(itinerary=["period", "bounce"])
        >>> found = ball.orbit_regions(orbit, ("a", "r"), (0.01, 0.03), (0.65, 0.75), cells=2)
        >>> found.objection, found.at(0.011, 0.7), found.at(0.02, 0.7)
        (None, (), (0,))
        """
        from stickslip import _orbit_regions

        return _orbit_regions.regions(self, orbit, parameters, (x, y), cells, progress)

    def switched(self, branch: Branch, special: SpecialOrbit, *, aside: float = 0.05) -> Orbit:
        """The orbit on the branch that begins or passes at a special orbit of a branch: of twice
        the period at a flip, on the other branch at a branch-point. It lies beside the special
        orbit by `aside` of the size of its states, at the value of the parameter where it is so far
        away.

        Raises ValueError if a value is wrong, or for other kinds, ComputationError if none is
        found.
        """
        from stickslip import _orbits

        return _orbits.switched(self, branch, special, aside)

    def section(
        self,
        rule: str,
        *,
        time: float,
        skip: float = 0.0,
        start: ArrayLike | None = None,
        mode: str | None = None,
        begin: float | None = None,
        parameters: Mapping[str, float] | None = None,
        progress: Progress | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The Poincaré map of a rule as data: times, shape (n,), and states before the rule acts,
        shape (components, n), in the time behind `skip`.

        start, mode and begin: the state, the mode and the time at the start, where they are not
        those of the system. Raises ValueError if a name or a value is wrong, ComputationError if
        the run does not come to its end.

        >>> import stickslip
        >>> tent = stickslip.system(\"\"\"
        ... parameter m = 1.5
        ... state x = 0.25
        ... x' = 0
        ... every 1 from 1 "folds"
        ...   x := m*min(x, 1 - x)
        ... \"\"\")
        >>> t, (x,) = tent.section("folds", skip=0.5, time=3.0)
        >>> t.tolist(), x.tolist()
        ([1.0, 2.0, 3.0], [0.375, 0.5625, 0.65625])
        """
        begins = (start, mode, begin)
        from stickslip import _attractors

        return _attractors.section(self, rule, (skip, time), begins, parameters, progress)

    def diagram(
        self,
        parameter: str,
        values: ArrayLike,
        rule: str,
        *,
        time: float,
        skip: float = 0.0,
        start: ArrayLike | None = None,
        mode: str | None = None,
        begin: float | None = None,
        parameters: Mapping[str, float] | None = None,
        progress: Progress | None = None,
    ) -> Diagram:
        """A bifurcation diagram by brute force: `section` over values of a parameter, upwards and
        downwards. Each run goes on where the last one ended, so that the two differ where there are
        several attractors. The rest is as in `section`.
        """
        begins, span = (start, mode, begin), (skip, time)
        over = (parameter, values)
        from stickslip import _attractors

        return _attractors.diagram(self, over, rule, span, begins, parameters, progress)

    def exponents(
        self,
        *,
        time: float,
        skip: float = 0.0,
        start: ArrayLike | None = None,
        mode: str | None = None,
        begin: float | None = None,
        parameters: Mapping[str, float] | None = None,
        progress: Progress | None = None,
    ) -> Exponents:
        """The Lyapunov exponents of a run through its events, in the time behind `skip`. One is 0
        where time is not explicit. The rest is as in `section`.

        >>> import stickslip
        >>> decay = stickslip.system("state x = 1\\nx' = -2*x\\nevery 1 from 1\\n  x := x + 1")
        >>> decay.exponents(time=20).values.round(9).tolist()
        [-2.0]
        """
        begins = (start, mode, begin)
        from stickslip import _attractors

        return _attractors.exponents(self, (skip, time), begins, parameters, progress)

    def basins(
        self,
        components: tuple[str, str],
        x: ArrayLike,
        y: ArrayLike,
        *,
        settle: float,
        start: ArrayLike | None = None,
        mode: str | None = None,
        begin: float | None = None,
        parameters: Mapping[str, float] | None = None,
        progress: Progress | None = None,
    ) -> Basins:
        """Where runs from a grid of values of two components lead in the time `settle`, told apart:
        periodic orbits, states that do not change, rules that end runs. Attractors that differ by
        less than 1e-3 of their size are one. The rest is as in `section`.
        """
        begins = (start, mode, begin)
        from stickslip import _attractors

        return _attractors.basins(self, components, (x, y), settle, begins, parameters, progress)

    @cached_property
    def _orbits(self) -> Orbits:
        return _native.OrbitSystem(self._native)

    def converge(
        self,
        *,
        name: str = "the system",
        t_span: ArrayLike | None = None,
        y0: ArrayLike | None = None,
        mode: str | None = None,
        parameters: Mapping[str, float] | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Study:
        """How accurate a run is: the errors of its last state and of the times of its events at
        tolerances from 1e-2 to 1e-13, with both methods, beside dop853 at 1e-15.

        name: of the system in titles. progress: called now and then with the steps done and all
        that are known; True shows a bar on stderr. The rest is as in `solve`. Raises ValueError if
        a name or a value is wrong, and ComputationError if the reference cannot be computed.

        >>> import stickslip
        >>> decay = stickslip.system("state x = 1\\nx' = -x\\nwhen x < 0.5\\nend = 2")
        >>> table = decay.converge().tables["convergence_tolerances"]
        >>> bool(table.columns["same_events"].all())
        True
        """
        from stickslip._collisions import _threads
        from stickslip._studies import _study

        rerun = self._arguments((t_span, y0, mode), parameters)
        values, begin, end, _ = rerun
        with reported(progress, f"converge {name}") as report:
            found = self._native.converge(
                str(name), values, begin, end, _threads(threads), report
            )
        return _study(found)

    def _arguments(
        self,
        begin: tuple[ArrayLike | None, ArrayLike | None, str | None],
        parameters: Mapping[str, float] | None,
        method: str = "dop853",
        tolerances: tuple[ArrayLike, ArrayLike] = (1e-10, 1e-12),
        steps: tuple[float, float | None] = (np.inf, None),
        most: tuple[int, int] = (1, 1),
    ) -> Rerun:
        """The arguments of a run, checked."""
        t_span, y0, mode = begin
        values = self.values(parameters)
        start, end = (None, None) if t_span is None else span(t_span)
        state = None if y0 is None else state_at_start(y0).tolist()
        if mode is not None and mode not in self.modes:
            raise ValueError(f"mode = {mode!r}; expected one of {self.modes}")
        place = None if mode is None else self.modes.index(mode)
        settings = settings_of(method, tolerances, steps, most, self._size)
        return values, (place, start, state), end, settings

    def _solution(self, found: dict[str, Any], dense: bool, rerun: Rerun) -> Solution:
        return Solution(
            found,
            self._names,
            start=found["start_time"],
            dense=dense,
            guards="decided",
            again=(self, rerun),
        )

    @cached_property
    def _names(self) -> Names:
        """The names of modes, the labels of rules of each, and all labels."""
        rows = self._native.modes()
        labels = [rules for _, rules in rows]
        known = list(dict.fromkeys(label for rules in labels for label in rules))
        return Names([name for name, _ in rows], labels, known)

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value!r}" for name, value in self.parameters.items())
        return f"FormulaSystem({', '.join(self.components)}; modes {self.modes}; {values})"

    def __reduce__(self) -> tuple[Any, ...]:
        names = (list(self.parameters), self.components, self.modes)
        return _restored, (self.text, list(self._surfaces), *names)


def _restored(text: str, surfaces: list[str], *names: list[str]) -> FormulaSystem:
    """The system of a text, under the names that it had before."""
    read = _native.FormulaSystem
    native = read.sliding(text, surfaces) if surfaces else read(text)
    return FormulaSystem._of(native.renamed(*names), surfaces)


def system(text: str) -> FormulaSystem:
    """The system that a text describes.

    Raises ValueError with line, column and what was expected, if the text is no system.

    >>> import stickslip
    >>> ball = stickslip.system(\"\"\"
    ... parameter g = 9.81, e = 0.5
    ... state x = 4.905, v = 0
    ... x' = v
    ... v' = -g
    ... when x < 0 "bounce"
    ...   x := 0
    ...   v := -e*v
    ... end = 2.9
    ... \"\"\")
    >>> found = ball.solve()
    >>> found.decided, found.t_events[0].round(12).tolist()
    (True, [1.0, 2.0, 2.5, 2.75, 2.875])
    """
    return FormulaSystem(text)


def read(path: str | PathLike[str]) -> FormulaSystem:
    """The system that a file describes, in UTF-8.

    Raises OSError if it cannot be read, and ValueError if it is no system.
    """
    with open(path, encoding="utf-8") as file:
        return FormulaSystem(file.read())
