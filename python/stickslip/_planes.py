"""What atlases of collisions and of families have in common: their file and their pictures."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar

from stickslip import _atlas_results, _native
from stickslip._axes import cells, one
from stickslip._tabular import Columns, Tabular
from stickslip._collisions import Floats
from stickslip.style import BOUNDARIES, PLACES, growing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Native = TypeVar("Native", _native.Atlas, _native.FamilyAtlas)

#: How boundaries are drawn, by their kind or by the place of their margin.
_STYLES = BOUNDARIES | PLACES


class Plane(Tabular, Generic[Native]):
    """Boundaries and regions of a window, with their file."""

    #: The part of the window's area from which on a region has room for a label.
    _ROOM = 0.005

    def __init__(self, native: Native) -> None:
        self._native: Native = native

    def __reduce__(self) -> tuple[Any, ...]:
        return (self._read, (self._native.json(),))

    @classmethod
    def _read(cls, text: str) -> Self:
        raise NotImplementedError

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Self:
        """The atlas in a file that `save` or `stickslip trace` has written, or Rust."""
        return cls._read(Path(file).read_text(encoding="utf-8"))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the file that `stickslip trace` would write, complete or not at all."""
        path = Path(file)
        beside = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            beside.write_text(self._native.json() + "\n", encoding="utf-8")
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)

    @cached_property
    def document(self) -> dict[str, Any]:
        """The object in the file of the atlas."""
        found: dict[str, Any] = json.loads(self._native.json())
        return found

    @property
    def objection(self) -> str | None:
        """What speaks against the atlas; None if nothing does."""
        return self._native.objection

    @property
    def verification(self) -> Mapping[str, Any]:
        """What the verification found: the comparison with runs."""
        report: Mapping[str, Any] = self.document["verification"]
        return report

    def _lines(self) -> Iterator[tuple[str, Floats]]:
        """The kind and the points of each boundary."""
        raise NotImplementedError

    def _labels(self) -> Iterator[tuple[str, float, tuple[float, float]]]:
        """The label of each region, its part of the window, and a point inside."""
        raise NotImplementedError

    def _counts(self, x: Floats, y: Floats) -> Floats:
        """The numbers of events at points, which broadcast; NaN where there is none."""
        raise NotImplementedError

    def _frame(self) -> dict[str, Any]:
        """Limits, scales and names of the axes."""
        raise NotImplementedError

    def plot(
        self,
        ax: Axes | None = None,
        *,
        labels: bool = True,
        colours: bool = True,
        **line: Any,
    ) -> Axes:
        """Draws the boundaries with matplotlib, and the number of events in large regions.

        ax: axes to draw in, or None for new ones. labels: whether regions are labelled. colours:
        whether they are coloured by the number of events. line: properties of all lines, e.g.
        `linewidth`.
        """
        ax = one(ax)
        frame = self._frame()
        if colours:
            x, y = cells(*frame["xlim"]), cells(*frame["ylim"])
            style: dict[str, Any] = {"cmap": growing(), "alpha": 0.5, "zorder": 0}
            ax.pcolormesh(x, y, self._counts(x, y[:, None]), shading="nearest", rasterized=True, **style)
        named = set()
        for kind, points in self._lines():
            name = None if kind in named else kind
            named.add(kind)
            ax.plot(points[:, 0], points[:, 1], label=name, **(_STYLES[kind] | {"linewidth": 1.0} | line))
        for text, part, sample in self._labels() if labels else ():
            if part > self._ROOM:
                ax.annotate(text, sample, ha="center", va="center")
        ax.set(**frame)
        return ax

    def _columns(self) -> Columns:
        return _atlas_results.regions(self)

    def picture(self) -> str:
        """The boundaries with the number of events in each region, as an SVG document."""
        return self._native.picture()

    def _repr_html_(self) -> str:
        return self.picture()
