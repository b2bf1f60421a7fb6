"""Atlases: every boundary in a window of the (kappa, psi) plane, and the regions between them."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _laws, _native
from stickslip._arrays import numbers
from stickslip._family_options import Effort
from stickslip._laws import Law
from stickslip._planes import Plane
from stickslip._progress import Progress, reported
from stickslip._shown import Shown
from stickslip._collisions import Floats, _threads, psi_of_ratio


class AtlasWarning(UserWarning):
    """An atlas is complete, but may be wrong."""


@dataclass(frozen=True, repr=False)
class Boundary(Shown):
    """A curve on which the switches of a collision change."""

    id: int
    #: end-of-contact, stick-graze or slip-graze; with other laws than the paper's also
    #: start-of-contact and start-of-tail.
    kind: str
    #: Itineraries on both sides: at smaller and at larger psi.
    below: str
    above: str
    #: Points (kappa, psi), shape (n, 2).
    points: Floats
    #: Directions of the boundary there, shape (n, 2).
    tangents: Floats
    #: Why the curve ends: window-edge, vertex or closed.
    start: str
    end: str


@dataclass(frozen=True)
class Vertex:
    """A point at which boundaries meet or end."""

    id: int
    kind: str
    kappa: float
    psi: float
    #: The boundaries that end here.
    boundaries: tuple[int, ...]


@dataclass(frozen=True)
class Region:
    """A part of the window in which all collisions have the same switches."""

    id: int
    switch_count: int
    itinerary: str
    #: A point (kappa, psi) inside.
    sample: tuple[float, float]
    #: Share of the window's area, in traced coordinates (docs/command-line.md).
    area_share: float
    #: The boundaries around it.
    boundaries: tuple[int, ...]


@dataclass(frozen=True)
class Located:
    """Where points lie in an atlas; arrays of the shape of the points."""

    #: Index of the region; -1 on a boundary or on the edge, where the
    #: collision has the switches of no region; -2 outside the window.
    region: NDArray[np.int64]
    #: Number of switches; -1 where there is no region.
    switch_count: NDArray[np.int64]
    #: Itinerary; empty where there is no region.
    itinerary: NDArray[np.str_]
    #: Distance in psi from the nearest boundary at the same kappa; NaN if there is none.
    distance: Floats


class Atlas(Plane[_native.Atlas]):
    """The subdivision of a window, from `trace` or `Atlas.load`."""

    @classmethod
    def _read(cls, text: str) -> Self:
        return cls(_native.Atlas.read(text))

    @property
    def window(self) -> Mapping[str, Any]:
        """Intervals of kappa and psi, and the damping."""
        window: Mapping[str, Any] = self.document["window"]
        return window

    @property
    def tolerance(self) -> float:
        """Accuracy of the boundaries in psi."""
        return float(self.document["tolerance"])

    @cached_property
    def boundaries(self) -> tuple[Boundary, ...]:
        """The boundaries."""
        return tuple(
            Boundary(
                id=one["id"],
                kind=one["kind"],
                below=one["below"]["itinerary"],
                above=one["above"]["itinerary"],
                points=np.array(one["points"], dtype=np.float64).reshape(-1, 2),
                tangents=np.array(one["tangents"], dtype=np.float64).reshape(-1, 2),
                start=one["start"],
                end=one["end"],
            )
            for one in self.document["boundaries"]
        )

    @cached_property
    def vertices(self) -> tuple[Vertex, ...]:
        """The points at which boundaries meet or end."""
        return tuple(
            Vertex(one["id"], one["kind"], one["kappa"], one["psi"], tuple(one["boundaries"]))
            for one in self.document["vertices"]
        )

    @cached_property
    def regions(self) -> tuple[Region, ...]:
        """The regions."""
        return tuple(
            Region(
                id=one["id"],
                switch_count=one["switch_count"],
                itinerary=one["itinerary"],
                sample=(one["sample"][0], one["sample"][1]),
                area_share=one["area_share"],
                boundaries=tuple(one["boundaries"]),
            )
            for one in self.document["regions"]
        )

    def locate(self, kappa: ArrayLike, psi: ArrayLike) -> Located:
        """The regions in which points lie. kappa and psi broadcast."""
        given = np.broadcast_arrays(numbers("kappa", kappa), numbers("psi", psi))
        shape = given[0].shape
        flat = (np.ascontiguousarray(one).reshape(-1) for one in given)
        region, distance = self._native.locate(*flat)
        counts = np.array([one.switch_count for one in self.regions] + [-1])
        names = np.array([one.itinerary for one in self.regions] + [""])
        # -1 and -2 both stand for the last entry.
        index = np.maximum(region, -1)
        return Located(
            region.reshape(shape),
            counts[index].reshape(shape),
            names[index].reshape(shape),
            distance.reshape(shape),
        )

    def geojson(self) -> dict[str, Any]:
        """Regions, boundaries and vertices as GeoJSON; coordinates are kappa and psi."""
        found: dict[str, Any] = json.loads(self._native.geojson())
        return found

    def _lines(self) -> Iterator[tuple[str, Floats]]:
        return ((boundary.kind, boundary.points) for boundary in self.boundaries)

    def _labels(self) -> Iterator[tuple[str, float, tuple[float, float]]]:
        return ((str(one.switch_count), one.area_share, one.sample) for one in self.regions)

    def _counts(self, x: Floats, y: Floats) -> Floats:
        count = self.locate(x, y).switch_count
        return np.where(count < 0, np.nan, count)

    def _frame(self) -> dict[str, Any]:
        (low, high), psi = self.window["kappa"], self.window["psi"]
        return {
            "xlim": (low, high),
            "ylim": psi,
            "xscale": "log" if high > 10 * low else "linear",
            "xlabel": r"scaled stiffness $\kappa$",
            "ylabel": r"impact ratio $\psi$",
        }

    def __repr__(self) -> str:
        counts = (len(self.boundaries), len(self.vertices), len(self.regions))
        return "Atlas: {} boundaries, {} vertices, {} regions".format(*counts)


def trace(
    kappa: tuple[float, float],
    psi: tuple[float, float] | None = None,
    damping: float = 0.0,
    *,
    ratio: tuple[float, float] | None = None,
    mu: float = 0.4,
    alpha: float = 2 / 7,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    tolerance: float | None = None,
    effort: Effort = "default",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Atlas:
    """Every boundary in a window, and the regions between them, verified.

    kappa, psi: intervals, above 0. ratio: interval of g_t/g_n instead of psi, which mu and alpha
    reduce. law, tangential_damping: as in `collide`. tolerance: accuracy of the boundaries in psi,
    from 1e-11 to 1e-9 times 1 + the largest psi. effort: how much is done, as in `trace_family`;
    the atlas is compared with 20 000 random collisions, "screen" with 500 and "certain" with 100 000.
    progress: called now and then with the steps done, all that are known, and, if it takes it, what
    is done now; True shows a bar on stderr. If something speaks against the atlas, it
    says so in an AtlasWarning and in `objection`.

    >>> atlas = trace((5, 8), (0.8, 1.2))
    >>> atlas.locate([5.5, 7.5], [0.9, 1.1]).itinerary.tolist()
    ['+o-', '+o-']
    """
    interval = None
    if (psi is None) == (ratio is None):
        raise ValueError("expected exactly one of psi and ratio")
    if ratio is not None:
        low, high = (float(psi_of_ratio(end, mu, alpha)) for end in ratio)
        psi, interval = (low, high), (ratio, mu, alpha)
    assert psi is not None
    chosen = _laws.arguments(law, tangential_damping)
    with reported(progress, "trace") as report:
        native = _native.Atlas.trace(
            kappa, psi, interval, (damping, chosen), (tolerance, effort), _threads(threads), report
        )
    atlas = Atlas(native)
    if atlas.objection is not None:
        warnings.warn(f"the atlas may be wrong: {atlas.objection}", AtlasWarning, stacklevel=2)
    return atlas
