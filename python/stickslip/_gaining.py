"""Where a contact law gives back more tangential energy than it took: the lines |eps_t| = 1."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip import _laws, _native, _pictures
from stickslip._axes import svg
from stickslip._family_options import Effort
from stickslip._laws import Law
from stickslip._shown import Shown
from stickslip._tabular import Columns, Tabular
from stickslip._progress import Progress, reported
from stickslip._atlases import AtlasWarning
from stickslip._collisions import Floats, _threads

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False)
class GainingLine(Shown):
    """A line in the (kappa, psi) plane on which |eps_t| is 1."""

    #: 1 or -1.
    eps_t: float
    #: Whether |eps_t| is above 1 on the left of the line, in the order of its points, with kappa to
    #: the right and psi upwards. On the other side it is not.
    gains_left: bool
    #: Points (kappa, psi), shape (n, 2).
    points: Floats


@dataclass(frozen=True, repr=False)
class GainingLines(Tabular, Shown):
    """The lines of a window, from `gaining_lines`."""

    #: The object that `stickslip trace --gaining` writes.
    document: Mapping[str, Any]
    lines: tuple[GainingLine, ...]
    #: What speaks against the lines; None if nothing does.
    objection: str | None

    _dimension = "point"

    def _columns(self) -> Columns:
        sizes = [len(line.points) for line in self.lines]
        points = np.concatenate([np.empty((0, 2)), *(line.points for line in self.lines)])
        return {
            "line": np.repeat(np.arange(len(sizes)), sizes),
            "eps_t": np.repeat([line.eps_t for line in self.lines], sizes),
            "gains_left": np.repeat([line.gains_left for line in self.lines], sizes),
            "kappa": points[:, 0],
            "psi": points[:, 1],
        }

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the lines with matplotlib, with ticks on the side where energy is gained.

        ax: axes to draw in, or None for new ones. line: properties of all lines.
        """
        return _pictures.gaining(self, ax, line)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)


def gaining_lines(
    kappa: tuple[float, float],
    psi: tuple[float, float],
    damping: float = 0.0,
    *,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    tolerance: float | None = None,
    effort: Effort = "default",
    threads: int | None = None,
    progress: Progress | None = None,
) -> GainingLines:
    """The lines in a window on which eps_t is 1 or -1, beyond which a law creates energy, verified.

    kappa, psi, tolerance, effort, progress: as in `trace`. law, tangential_damping: as in
    `collide`. A line ends where the switches change, and another goes on there. If something speaks
    against the lines, it says so in an AtlasWarning and in `objection`.

    >>> found = gaining_lines((1.2, 1.3), (0.85, 1.0), law="gran/hertz/history")
    >>> [line.eps_t for line in found.lines]
    [-1.0]
    """
    chosen = _laws.arguments(law, tangential_damping)
    with reported(progress, "gaining_lines") as report:
        text, objection = _native.gaining_lines(
            kappa, psi, (damping, chosen), (tolerance, effort), _threads(threads), report
        )
    document = json.loads(text)
    lines = tuple(
        GainingLine(one["eps_t"], one["gains_left"], np.array(one["points"], dtype=np.float64))
        for one in document["lines"]
    )
    if objection is not None:
        warnings.warn(f"the lines may be wrong: {objection}", AtlasWarning, stacklevel=2)
    return GainingLines(document, lines, objection)
