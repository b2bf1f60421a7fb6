"""Periodic orbits of systems of formulas, and their branches."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native, _orbit_pictures
from stickslip._axes import Panels, svg
from stickslip._compiled import _number
from stickslip._progress import Progress, reported, reporting
from stickslip._run_arguments import state_at_start
from stickslip._shown import Shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._formulas import FormulaSystem


@dataclass(frozen=True, repr=False, eq=False)
class OrbitSegment(Shown):
    """A part of an orbit, in one mode. `rate` is that of the rule's condition at its end."""

    mode: str
    rule: str
    next: str
    duration: float
    state: NDArray[np.float64]
    end: NDArray[np.float64]
    rate: float


@dataclass(frozen=True, repr=False, eq=False)
class Orbit(Shown):
    """A periodic orbit. `multipliers` are complex, the largest first, without the trivial 1, and
    None at a graze. `obstacle` says why the system does not follow the orbit by itself.
    """

    parameters: dict[str, float]
    start: float
    period: float
    multipliers: NDArray[np.complex128] | None
    admissible: bool
    stable: bool
    obstacle: str | None
    segments: list[OrbitSegment]
    _system: FormulaSystem = field(repr=False)
    _record: dict[str, Any] = field(repr=False)

    def course(self, parts: int = 60) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Times, shape (n,), and states, shape (components, n), along the orbit, each segment in so
        many parts. At an event both states are there, one after the other.
        """
        if parts < 1:
            raise ValueError(f"parts = {parts!r}; expected at least 1")
        rows = self._system._orbits.course(json.dumps(self._record), parts)
        return np.array([s for s, _ in rows]), np.array([state for _, state in rows]).T

    def document(self) -> dict[str, Any]:
        """The orbit with names, as the program writes it."""
        return dict(self._record)

    def plot(self, ax: Panels = None, **line: Any) -> list[Axes]:
        """Draws the first six components over one period: in new axes below each other, in axes for
        each, or in one. `line` is for matplotlib."""
        return _orbit_pictures.orbit(self, ax, line)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot, min(len(self._system.components), _orbit_pictures.MOST_PANELS))


@dataclass(frozen=True, repr=False, eq=False)
class SpecialOrbit(Shown):
    """An orbit at which something changes along a branch: `kind` says what. `behind` is the number
    of orbits of the branch before it.
    """

    kind: str
    value: float
    behind: int
    segment: int | None
    rule: str | None
    orbit: Orbit
    _record: dict[str, Any] = field(repr=False)


@dataclass(frozen=True, repr=False, eq=False)
class SpecialCurve(Shown):
    """Special orbits of one kind over two parameters, in the order of the curve. `meetings` are
    orbits at which something else changes too, as name and orbit: `resonance-1-1`,
    `resonance-1-2`, `double-graze`, `cusp`, or both kinds, as `fold-grazing`.
    """

    kind: str
    parameters: tuple[str, str]
    points: list[Orbit]
    meetings: list[tuple[str, Orbit]]
    closed: bool
    objection: str | None

    @property
    def values(self) -> NDArray[np.float64]:
        """The values of both parameters, shape (2, n)."""
        rows = [[point.parameters[name] for point in self.points] for name in self.parameters]
        return np.array(rows)

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the curve in the plane of both parameters. `line` is for matplotlib."""
        return _orbit_pictures.curve(self, ax, line)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)


@dataclass(frozen=True, repr=False, eq=False)
class Branch(Shown):
    """Orbits over a parameter, in the order of the branch, and the special ones among them."""

    parameter: str
    interval: tuple[float, float]
    points: list[Orbit]
    specials: list[SpecialOrbit]
    closed: bool
    objection: str | None
    _components: list[str] = field(repr=False)
    _text: str = field(repr=False)

    @property
    def values(self) -> NDArray[np.float64]:
        """The values of the parameter."""
        return np.array([point.parameters[self.parameter] for point in self.points])

    @property
    def admissible(self) -> NDArray[np.bool_]:
        """Which orbits the system follows by itself."""
        return np.array([point.admissible for point in self.points])

    def document(self) -> dict[str, Any]:
        """The branch with names, as the program writes it."""
        return dict(json.loads(self._text))

    def save(self, path: str | Path) -> None:
        """Writes the branch to a JSON file, which `FormulaSystem.read_branch` reads."""
        Path(path).write_text(self._text, encoding="utf-8")

    def ends(self, component: str, segment: int = 0) -> NDArray[np.float64]:
        """A component of the states at the ends of a segment."""
        place = self._place(component)
        return np.array([point.segments[segment].end[place] for point in self.points])

    def plot(self, ax: Axes | None = None, *, component: str | None = None, **line: Any) -> Axes:
        """Draws a component at the end of the first segment over the parameter. `line` is for
        matplotlib."""
        return _orbit_pictures.branch(self, ax, component, line)

    def svg(self, component: str | None = None, *, title: str = "periodic orbits") -> str:
        """The picture of the branch: a component at the end of the first segment."""
        name = self._components[0] if component is None else component
        place = self._place(name)

        def at(orbit: Orbit) -> tuple[float, float]:
            return orbit.parameters[self.parameter], float(orbit.segments[0].end[place])

        axes = (self.parameter, f"{name} before {self.points[0].segments[0].rule}")
        points = [(*at(it), it.admissible, it.stable) for it in self.points]
        specials = [(it.kind, *at(it.orbit), it.behind) for it in self.specials]
        return _native.branch_picture(title, axes, points, specials)

    def save_svg(self, path: str | Path, component: str | None = None) -> None:
        """Writes the picture of the branch to a file."""
        Path(path).write_text(self.svg(component), encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg()

    def _place(self, component: str) -> int:
        if component not in self._components:
            expected = ", ".join(self._components)
            raise ValueError(f"component = {component!r}; expected one of {expected}")
        return self._components.index(component)


#: The state, the mode and the time at the start, where they are not those of the system.
Begin: TypeAlias = "tuple[ArrayLike | None, str | None, float | None]"


def first_of(
    system: FormulaSystem, begin: Begin
) -> tuple[int | None, float | None, list[float] | None]:
    """The start as the native module reads it."""
    start, mode, time = begin
    if mode is not None and mode not in system.modes:
        raise ValueError(f"mode = {mode!r}; expected one of {system.modes}")
    place = None if mode is None else system.modes.index(mode)
    state = None if start is None else state_at_start(start).tolist()
    return place, None if time is None else _number(time, "time"), state


def orbit(
    system: FormulaSystem,
    itinerary: Sequence[str] | None,
    begin: Begin,
    durations: ArrayLike | None,
    settle: float | None,
    near: Orbit | None,
    parameters: Mapping[str, float] | None,
    progress: Progress | None,
) -> Orbit:
    """See `FormulaSystem.orbit`."""
    given = [name for name, it in _ways(itinerary, settle, near) if it is not None]
    if len(given) != 1:
        found = " and ".join(given) or "none"
        raise ValueError(f"{found} given; expected one of itinerary, settle and near")
    if near is not None:
        values = system.values({**near.parameters, **(parameters or {})})
        found = system._orbits.continued(json.dumps(near._record), values)
        return _read(system, json.loads(found)["orbit"])
    values, first = system.values(parameters), first_of(system, begin)
    if settle is not None:
        run = partial(system._orbits.settled, values, first, _number(settle, "settle"))
        found = reporting(progress, "orbit", run)
    else:
        if isinstance(itinerary, str) or itinerary is None:
            raise ValueError(f"itinerary = {itinerary!r}; expected a list of names of rules")
        lengths = None if durations is None else np.asarray(durations, dtype=float).tolist()
        found = system._orbits.find(values, first, list(itinerary), lengths)
    return _read(system, json.loads(found)["orbit"])


def _ways(
    itinerary: Sequence[str] | None, settle: float | None, near: Orbit | None
) -> list[tuple[str, Any]]:
    return [("itinerary", itinerary), ("settle", settle), ("near", near)]


def branch(
    system: FormulaSystem,
    orbit: Orbit,
    parameter: str,
    interval: tuple[float, float],
    steps: tuple[float, int],
    progress: Progress | None,
) -> Branch:
    """See `FormulaSystem.branch`."""
    begin = (json.dumps(orbit._record), _parameter(system, parameter), _ends(interval))
    step = _number(steps[0], "longest_step")
    with reported(progress, "branch") as report:
        text = system._orbits.branch(*begin, step, steps[1], report)
    return _read_branch(system, text)


def resumed(
    system: FormulaSystem,
    branch: Branch,
    interval: tuple[float, float],
    steps: tuple[float, int],
    progress: Progress | None,
) -> Branch:
    """See `FormulaSystem.resumed`."""
    step = _number(steps[0], "longest_step")
    with reported(progress, "branch") as report:
        text = system._orbits.resumed(branch._text, _ends(interval), step, steps[1], report)
    return _read_branch(system, text)


def read_branch(system: FormulaSystem, path: str | Path) -> Branch:
    """See `FormulaSystem.read_branch`."""
    return _read_branch(system, system._orbits.read_branch(Path(path).read_text(encoding="utf-8")))


def _ends(interval: tuple[float, float]) -> tuple[float, float]:
    low, high = interval
    return _number(low, "interval"), _number(high, "interval")


def _read_branch(system: FormulaSystem, text: str) -> Branch:
    """The branch of a document."""
    found = json.loads(text)
    specials = [
        SpecialOrbit(
            kind=it["kind"],
            value=it["value"],
            behind=it["behind"],
            segment=it["segment"],
            rule=it["rule"],
            orbit=_read(system, it["orbit"]),
            _record=it,
        )
        for it in found["specials"]
    ]
    low, high = found["range"]
    return Branch(
        parameter=found["parameter"],
        interval=(low, high),
        points=[_read(system, it) for it in found["points"]],
        specials=specials,
        closed=found["closed"],
        objection=found["objection"],
        _components=found["components"],
        _text=text,
    )


def curve(
    system: FormulaSystem,
    special: SpecialOrbit,
    parameters: tuple[str, str],
    intervals: tuple[tuple[float, float], tuple[float, float]],
    longest_step: float,
    progress: Progress | None,
) -> SpecialCurve:
    """See `FormulaSystem.curve`."""
    places = [_parameter(system, name) for name in parameters]
    window = [[_number(end, "interval") for end in interval] for interval in intervals]
    step = _number(longest_step, "longest_step")
    with reported(progress, "curve") as report:
        text = system._orbits.curve(json.dumps(special._record), places, window, step, report)
    found = json.loads(text)
    return SpecialCurve(
        kind=found["kind"],
        parameters=(parameters[0], parameters[1]),
        points=[_read(system, it) for it in found["points"]],
        meetings=[(it["name"], _read(system, it["orbit"])) for it in found["meetings"]],
        closed=found["closed"],
        objection=found["objection"],
    )


def switched(system: FormulaSystem, branch: Branch, special: SpecialOrbit, aside: float) -> Orbit:
    """See `FormulaSystem.switched`."""
    place, away = _parameter(system, branch.parameter), _number(aside, "aside")
    beside = branch.points[max(special.behind - 1, 0)]
    records = [json.dumps(it._record) for it in (special, beside)]
    found = system._orbits.switched(records[0], records[1], place, away)
    return _read(system, json.loads(found)["orbit"])


def _parameter(system: FormulaSystem, name: str) -> int:
    names = list(system.parameters)
    if name not in names:
        raise ValueError(f"parameter = {name!r}; expected one of {', '.join(names) or 'none'}")
    return names.index(name)


def _read(system: FormulaSystem, record: dict[str, Any]) -> Orbit:
    """The orbit of a record."""
    pairs = record["multipliers"]
    multipliers = None if pairs is None else np.array([complex(*it) for it in pairs])
    segments = [
        OrbitSegment(
            mode=it["mode"],
            rule=it["rule"],
            next=it["next"],
            duration=it["duration"],
            state=np.array(it["state"]),
            end=np.array(it["end"]),
            rate=it["rate"],
        )
        for it in record["segments"]
    ]
    return Orbit(
        parameters=dict(record["parameters"]),
        start=record["start"],
        period=record["period"],
        multipliers=multipliers,
        admissible=record["admissible"],
        stable=record["stable"],
        obstacle=record["obstacle"],
        segments=segments,
        _system=system,
        _record=record,
    )
