"""Where a periodic orbit exists and is stable over two parameters."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip import _native, _orbit_pictures
from stickslip._compiled import _number
from stickslip._orbits import _parameter
from stickslip._progress import Progress, reported
from stickslip._shown import Shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._formulas import FormulaSystem
    from stickslip._orbits import Orbit


@dataclass(frozen=True, repr=False, eq=False)
class OrbitRegion(Shown):
    """A region. `orbits` has, for each orbit that the system follows there, the number of its
    multipliers outside the unit circle, and is None in doubt. `sample` is a point inside.
    """

    orbits: tuple[int, ...] | None
    area: float
    sample: tuple[float, float]
    #: The places of its boundaries.
    boundaries: list[int]

    @property
    def stable(self) -> bool:
        """Whether the system follows a stable orbit there."""
        return self.orbits is not None and 0 in self.orbits


@dataclass(frozen=True, repr=False, eq=False)
class OrbitBoundary(Shown):
    """A boundary: the kind of special orbit on it, the orbits on its left and its right side, and
    its points, shape (2, n).
    """

    kind: str
    segment: int | None
    rule: str | None
    sides: tuple[tuple[int, ...], tuple[int, ...]]
    points: NDArray[np.float64]


@dataclass(frozen=True, repr=False, eq=False)
class OrbitRegions(Shown):
    """The regions of an orbit over two parameters. `tolerance` is the error of the boundaries;
    `objection` says what is in doubt.
    """

    parameters: tuple[str, str]
    regions: list[OrbitRegion]
    boundaries: list[OrbitBoundary]
    tolerance: float
    objection: str | None
    _text: str = field(repr=False)

    @cached_property
    def _map(self) -> _native.OrbitMap:
        return _native.OrbitMap.read(self._text)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._text,)

    def at(self, x: float, y: float) -> tuple[int, ...] | None:
        """The orbits that the system follows at a point, as `OrbitRegion.orbits` has them; None on
        a boundary, outside the window, and in doubt.
        """
        found = self._map.at(_number(x, "x"), _number(y, "y"))
        return None if found is None else tuple(found)

    def document(self) -> dict[str, Any]:
        """The regions with names, as the program writes them."""
        return dict(json.loads(self._text))

    def save(self, path: str | Path) -> None:
        """Writes the regions to a JSON file, which `read_orbit_regions` reads."""
        Path(path).write_text(self._text, encoding="utf-8")

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the boundaries, and whether a stable orbit is followed in each region. `line` is
        for matplotlib."""
        return _orbit_pictures.regions(self, ax, line)

    def svg(self, *, title: str = "orbits that the system follows") -> str:
        """The picture of the regions."""
        return self._map.svg(title)

    def save_svg(self, path: str | Path) -> None:
        """Writes the picture to a file."""
        Path(path).write_text(self.svg(), encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg()


def read_orbit_regions(path: str | Path) -> OrbitRegions:
    """The regions in a JSON file that `OrbitRegions.save` or the program has written.

    Raises ValueError if the file has no regions of an orbit.
    """
    return _restored(Path(path).read_text(encoding="utf-8"))


def _restored(text: str) -> OrbitRegions:
    return _of(_native.OrbitMap.read(text))


def regions(
    system: FormulaSystem,
    orbit: Orbit,
    parameters: tuple[str, str],
    intervals: tuple[tuple[float, float], tuple[float, float]],
    cells: int,
    progress: Progress | None,
) -> OrbitRegions:
    """See `FormulaSystem.orbit_regions`."""
    places = [_parameter(system, name) for name in parameters]
    window = [[_number(end, "interval") for end in interval] for interval in intervals]
    if cells < 1:
        raise ValueError(f"cells = {cells!r}; expected 1 to 100")
    with reported(progress, "orbit_regions") as report:
        found = system._orbits.regions(json.dumps(orbit._record), places, window, cells, report)
    return _of(found)


def _of(native: _native.OrbitMap) -> OrbitRegions:
    regions = [
        OrbitRegion(None if orbits is None else tuple(orbits), area, sample, boundaries)
        for orbits, area, sample, boundaries in native.regions()
    ]
    boundaries = [
        OrbitBoundary(kind, segment, rule, (tuple(left), tuple(right)), np.array(points).T)
        for kind, segment, rule, (left, right), points in native.boundaries()
    ]
    one, other = native.axes
    return OrbitRegions(
        (one, other), regions, boundaries, native.tolerance, native.objection, native.text
    )
