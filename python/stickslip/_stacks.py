"""Stacks: atlases over the damping, and where regions are born, split, merge and die."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from stickslip import _atlas_results, _native
from stickslip._progress import Progress, reported
from stickslip._shown import Shown
from stickslip._atlases import AtlasWarning
from stickslip._collisions import _threads

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Layer:
    """An atlas at one damping."""

    damping: float
    #: Number of regions with each itinerary.
    regions: Mapping[str, int]
    #: Whether nothing speaks against the atlas.
    agrees: bool
    #: Whether its regions are those that the changes leave; None without damping and inside the
    #: bracket of a change.
    as_stacked: bool | None


@dataclass(frozen=True)
class Change:
    """A change of the regions as the damping grows."""

    #: Dampings of two atlases between which the change lies.
    between: tuple[float, float]
    #: crossing, touch, flat, edge, edge-touch, corner or swallowtail; None if the change is only
    #: enclosed.
    kind: str | None
    #: Where it happens; None if the change is only enclosed.
    damping: float | None
    kappa: float | None
    psi: float | None
    #: Whether several changes may lie between the two dampings, or nothing could be solved for.
    doubtful: bool
    #: Pairs of what happens (born, splits, merge, dies) and the itinerary of the region.
    effects: tuple[tuple[str, str], ...]


@dataclass(frozen=True, repr=False)
class Stack(Shown):
    """Atlases at several dampings, and the changes between them, from `stack`."""

    #: The object that `stickslip stack` writes.
    document: Mapping[str, Any]
    layers: tuple[Layer, ...]
    changes: tuple[Change, ...]
    #: What speaks against the stack; None if nothing does.
    objection: str | None
    #: The picture as SVG.
    svg: str

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the number of regions over the damping with matplotlib, and where it changes."""
        return _atlas_results.stack(self, ax, line)

    def _repr_svg_(self) -> str:
        return self.svg


def stack(
    kappa: tuple[float, float],
    psi: tuple[float, float],
    damping: Sequence[float] = (0, 1e-6, 0.1, 0.2, 0.5, 1, 1.5, 2),
    *,
    tolerance: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Stack:
    """Atlases at several dampings, and the dampings between them at which regions change.

    kappa, psi: intervals, above 0. damping: in ascending order, two above 0 or more, and 0 before
    them or not. tolerance, progress: as in `trace`. If something speaks against the result, it says
    so in an AtlasWarning and in `objection`.
    """
    dampings = [float(one) for one in damping]
    with reported(progress, "stack") as report:
        count = _threads(threads)
        text, svg, objection = _native.stack(kappa, psi, dampings, tolerance, count, report)
    document = json.loads(text)
    layers = tuple(
        Layer(one["damping"], one["regions"], one["agrees"], one["as_stacked"])
        for one in document["layers"]
    )
    if objection is not None:
        warnings.warn(f"the stack may be wrong: {objection}", AtlasWarning, stacklevel=2)
    changes = tuple(_change(one) for one in document["changes"])
    return Stack(document, layers, changes, objection, svg)


def _change(fields: Mapping[str, Any]) -> Change:
    low, high = fields["between"]
    meeting = fields["meeting"] or {}
    return Change(
        between=(low, high),
        kind=meeting.get("kind"),
        damping=meeting.get("damping"),
        kappa=meeting.get("kappa"),
        psi=meeting.get("psi"),
        doubtful=fields["doubtful"],
        effects=tuple((one["effect"], one["itinerary"]) for one in fields["effects"]),
    )
