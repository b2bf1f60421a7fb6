"""What runs lead to: exponents, diagrams over a parameter, and basins."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _orbit_pictures
from stickslip._axes import svg
from stickslip._compiled import _number
from stickslip._orbits import Begin, Orbit, _parameter, _read, first_of
from stickslip._progress import Progress, reported, reporting
from stickslip._shown import Shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._formulas import FormulaSystem


_Column: TypeAlias = tuple[float, list[tuple[float, list[float]]], "str | None"]


@dataclass(frozen=True, repr=False, eq=False)
class Exponents(Shown):
    """Lyapunov exponents, the largest first; -inf for each direction that is lost at events.
    `spread` is the largest difference of a finite one between both halves of the time.
    """

    values: NDArray[np.float64]
    spread: float
    events: int


@dataclass(frozen=True, repr=False, eq=False)
class Diagram(Shown):
    """Points on a section over a parameter. `up` and `down` have shape (1 + components, n): the
    value of the parameter, and the state. `troubles` are runs that did not come to their end, as
    value and reason.
    """

    parameter: str
    up: NDArray[np.float64]
    down: NDArray[np.float64]
    troubles: list[tuple[float, str]]
    components: list[str]

    def plot(self, ax: Axes | None = None, *, component: str | None = None, **points: Any) -> Axes:
        """Draws a component, the first one unless it is named, over the parameter. `points` is for
        matplotlib."""
        return _orbit_pictures.diagram(self, ax, component, points)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)

    def _place(self, component: str | None) -> int:
        if component is not None and component not in self.components:
            expected = ", ".join(self.components)
            raise ValueError(f"component = {component!r}; expected one of {expected}")
        return 0 if component is None else self.components.index(component)


@dataclass(frozen=True, repr=False, eq=False)
class Attractor(Shown):
    """What a run leads to: a periodic `orbit`, or a `state` that does not change in a `mode`, or
    the `rule` of a `mode` that ends the run.
    """

    orbit: Orbit | None
    mode: str | None
    state: NDArray[np.float64] | None
    rule: str | None


@dataclass(frozen=True, repr=False, eq=False)
class Basins(Shown):
    """Where runs from a grid of two initial values lead. `labels` has shape (y, x): the place of an
    attractor, or -1 where a run does not settle.
    """

    components: tuple[str, str]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    attractors: list[Attractor]
    labels: NDArray[np.int64]

    def plot(self, ax: Axes | None = None, **colours: Any) -> Axes:
        """Draws the attractors of all runs in colours. `colours` is for matplotlib."""
        return _orbit_pictures.basins(self, ax, colours)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)


def section(
    system: FormulaSystem,
    rule: str,
    span: tuple[float, float],
    begin: Begin,
    parameters: Mapping[str, float] | None,
    progress: Progress | None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """See `FormulaSystem.section`."""
    values, first = system.values(parameters), first_of(system, begin)
    run = partial(system._orbits.section, values, first, rule, _span(span))
    points = reporting(progress, "section", run)
    return np.array([s for s, _ in points]), _states(system, [state for _, state in points])


def diagram(
    system: FormulaSystem,
    over: tuple[str, ArrayLike],
    rule: str,
    span: tuple[float, float],
    begin: Begin,
    parameters: Mapping[str, float] | None,
    progress: Progress | None,
) -> Diagram:
    """See `FormulaSystem.diagram`."""
    name, given = over
    values, first = system.values(parameters), first_of(system, begin)
    row = (_parameter(system, name), _row(given, "values"))
    with reported(progress, "diagram") as report:
        both = system._orbits.diagram(values, first, row, rule, _span(span), report)

    def columns(found: list[_Column]) -> NDArray[np.float64]:
        rows = [[value, *state] for value, points, _ in found for _, state in points]
        return np.array(rows).reshape(-1, 1 + len(system.components)).T

    troubles = [(value, why) for found in both for value, _, why in found if why is not None]
    return Diagram(name, columns(both[0]), columns(both[1]), troubles, system.components)


def exponents(
    system: FormulaSystem,
    span: tuple[float, float],
    begin: Begin,
    parameters: Mapping[str, float] | None,
    progress: Progress | None,
) -> Exponents:
    """See `FormulaSystem.exponents`."""
    values, first = system.values(parameters), first_of(system, begin)
    with reported(progress, "exponents") as report:
        found, spread, events = system._orbits.exponents(values, first, _span(span), report)
    return Exponents(np.array(found), spread, events)


def basins(
    system: FormulaSystem,
    components: tuple[str, str],
    grid: tuple[ArrayLike, ArrayLike],
    settle: float,
    begin: Begin,
    parameters: Mapping[str, float] | None,
    progress: Progress | None,
) -> Basins:
    """See `FormulaSystem.basins`."""
    names = list(system.components)
    for name in components:
        if name not in names:
            raise ValueError(f"component = {name!r}; expected one of {', '.join(names)}")
    places = [names.index(name) for name in components]
    rows = (_row(grid[0], "x"), _row(grid[1], "y"))
    values, first = system.values(parameters), first_of(system, begin)
    time = _number(settle, "settle")
    with reported(progress, "basins") as report:
        texts, labels = system._orbits.basins(values, first, places, rows, time, report)
    attractors = []
    for record in map(json.loads, texts):
        state = record.get("state")
        attractors.append(
            Attractor(
                orbit=_read(system, record["orbit"]) if "orbit" in record else None,
                mode=record.get("mode"),
                state=None if state is None else np.array(state),
                rule=record.get("rule"),
            )
        )
    table = np.array(labels, dtype=np.int64).reshape(len(rows[1]), len(rows[0]))
    pair = (components[0], components[1])
    return Basins(pair, np.array(rows[0]), np.array(rows[1]), attractors, table)


def _span(span: tuple[float, float]) -> tuple[float, float]:
    return _number(span[0], "skip"), _number(span[1], "time")


def _row(values: ArrayLike, name: str) -> list[float]:
    row = np.asarray(values, dtype=float)
    if row.ndim != 1:
        raise ValueError(f"{name} has {row.ndim} dimensions; expected a list of numbers")
    return [float(value) for value in row]


def _states(system: FormulaSystem, states: list[list[float]]) -> NDArray[np.float64]:
    return np.array(states).reshape(-1, len(system.components)).T
