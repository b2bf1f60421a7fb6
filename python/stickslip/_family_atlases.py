"""Atlases of families: what `trace_family` returns."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip._arrays import numbers
from stickslip._atlases import AtlasWarning
from stickslip._planes import Plane
from stickslip._progress import Progress, reported
from stickslip._shown import Shown
from stickslip._collisions import Floats, _threads

if TYPE_CHECKING:
    from stickslip._families import HybridFamily

Cancelled: TypeAlias = Callable[[], object]


@dataclass(frozen=True)
class Itinerary:
    """What a run does: the label of a region."""

    #: fires (the run comes to its end), begins (it goes on after max_switches events), accumulates
    #: (its events do, before the end), unfinished (too many steps), fails, or no_start (a condition
    #: of the start does not hold).
    kind: Literal["fires", "begins", "accumulates", "unfinished", "fails", "no_start"]
    #: The guards that fire, in order, without one that ends the run.
    guards: tuple[str, ...] = ()
    #: The first condition of the start that does not hold, from 0, if there is no start.
    condition: int | None = None

    def __str__(self) -> str:
        names = ", ".join(self.guards)
        if self.kind == "fires":
            return names or "no events"
        if self.condition is not None:
            by = f", by condition {self.condition + 1}" if self.condition else ""
            return f"no start{by}"
        return f"{names}, …" if self.kind == "begins" else self.kind


@dataclass(frozen=True)
class FamilyMargin:
    """What vanishes on a boundary: the value of a guard at a place of a phase."""

    #: The guards that have fired before, one for each earlier phase.
    after: tuple[str, ...]
    guard: str
    #: minimum or maximum (a graze), end (of the run), start (of the phase), exit (where another
    #: guard ends the phase), branch (of a transition), or condition (of the start, which is named
    #: in the place of a guard).
    place: str


@dataclass(frozen=True, repr=False)
class FamilyCurve(Shown):
    """A curve on which the itinerary changes, between two vertices."""

    id: int
    margin: FamilyMargin
    #: The itineraries on the left and on the right, seen in the direction of the curve.
    sides: tuple[Itinerary, Itinerary]
    #: Points (x, y), shape (n, 2).
    points: Floats
    #: Unit vectors along the curve there, shape (n, 2).
    tangents: Floats
    #: The vertices at which it starts and ends; None if it is closed.
    vertices: tuple[int, int] | None


@dataclass(frozen=True)
class FamilyVertex:
    """A point at which curves end or meet."""

    id: int
    #: crossing, double-graze, cusp, graze-at-end, simultaneous-events, tangency, other, window-edge
    #: or window-corner.
    kind: str
    x: float
    y: float
    #: The curves that end here.
    curves: tuple[int, ...]


@dataclass(frozen=True)
class FamilyRegion:
    """A part of the window in which all runs have the same itinerary."""

    id: int
    #: None if no curve bounds the region, which is the whole window; `decide` tells it.
    itinerary: Itinerary | None
    area: float
    #: A point (x, y) inside, and its distance from the nearest curve or edge.
    sample: tuple[float, float]
    clearance: float
    #: The curves around it.
    curves: tuple[int, ...]
    #: Whether something unresolved, inconsistent or refuted by a run lies in it or on its boundary.
    doubtful: bool


@dataclass(frozen=True)
class Unresolved:
    """Something that the trace saw and could not explain."""

    #: change (of the itinerary, without a margin), stalled (a curve ends there), no-length,
    #: too-many-nodes or too-many-curves.
    kind: str
    #: Where, shape (n, 2): two points around a change, and else one.
    points: Floats
    #: The itineraries at both points of a change.
    itineraries: tuple[Itinerary, ...]
    text: str


@dataclass(frozen=True)
class FamilyLocated:
    """Where points lie in an atlas of a family; arrays of the shape of the points."""

    #: Index of the region; -1 on a curve within its error, -2 outside the window.
    region: NDArray[np.int64]
    #: Number of events before the end; -1 where there is no region, or it has no such number.
    event_count: NDArray[np.int64]
    #: The itinerary as text; empty where there is no region.
    itinerary: NDArray[np.str_]
    #: Whether the region is in doubt; also on curves, and outside.
    doubtful: NDArray[np.bool_]
    #: Distance in y from the nearest curve at the same x; NaN if there is none.
    distance: Floats


class TraceInterrupted(KeyboardInterrupt):
    """Ctrl-C during a trace. `atlas` has what was found, and `atlas.resume` goes on."""

    def __init__(self, atlas: FamilyAtlas) -> None:
        super().__init__("the trace was interrupted")
        self.atlas = atlas

    def __reduce__(self) -> tuple[Any, ...]:
        return (TraceInterrupted, (self.atlas,))


class FamilyAtlas(Plane[_native.FamilyAtlas]):
    """The boundaries and regions of a family in a window, from `trace_family` or `load`.

    Its file needs no family to be read and located in.
    """

    @classmethod
    def _read(cls, text: str) -> Self:
        return cls(_native.FamilyAtlas.read(text))

    def resume(
        self,
        family: HybridFamily,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
        cancelled: Cancelled | None = None,
    ) -> FamilyAtlas:
        """Goes on with an atlas that was cancelled, to the same bits as without interruption.

        family: the same one. One that is finished is returned as it is. The other arguments are
        those of `trace_family`.
        """
        with reported(progress, f"trace of {self.family}") as report:
            calls = (report, cancelled)
            return finished(family._in(self.window).resume(self._native, _threads(threads), calls))

    @property
    def family(self) -> str:
        """The name of the family."""
        return str(self.document["family"])

    @property
    def axes(self) -> tuple[str, str]:
        """The names of the two parameters."""
        x, y = self.document["axes"]
        return x, y

    @property
    def window(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The intervals of the two parameters."""
        (left, bottom), (right, top) = (self.document["window"][end] for end in ("low", "high"))
        return (left, right), (bottom, top)

    @property
    def finished(self) -> bool:
        """Whether the trace came to its end. If it was cancelled, everything is in doubt."""
        return self._native.finished

    @property
    def findings(self) -> tuple[str, ...]:
        """Inconsistencies between curves and vertices."""
        return tuple(self._native.doubts[0])

    @property
    def statistics(self) -> Mapping[str, int]:
        """The work of the trace: free_runs, prescribed_runs, nodes, rejected, seeds."""
        counts: Mapping[str, int] = self.document["statistics"]
        return counts

    @property
    def sure_area(self) -> float:
        """The part of the window's area in regions that are not in doubt."""
        # A sum of nothing is −0 in Rust.
        return self._native.sure[1] + 0.0

    @cached_property
    def curves(self) -> tuple[FamilyCurve, ...]:
        """The curves."""
        return tuple(
            FamilyCurve(
                id=index,
                margin=self._margin(one["margin"]),
                sides=(self._itinerary(one["sides"][0]), self._itinerary(one["sides"][1])),
                points=_points(node["point"] for node in one["nodes"]),
                tangents=_points(node["tangent"] for node in one["nodes"]),
                vertices=None if one["ends"] is None else (one["ends"][0], one["ends"][1]),
            )
            for index, one in enumerate(self.document["curves"])
        )

    @cached_property
    def vertices(self) -> tuple[FamilyVertex, ...]:
        """The points at which curves end or meet."""
        curves: list[list[int]] = [[] for _ in self.document["vertices"]]
        for curve in self.curves:
            for vertex in sorted(set(curve.vertices or ())):
                curves[vertex].append(curve.id)
        rows = zip(self.document["vertices"], self._native.vertex_kinds, curves, strict=True)
        return tuple(
            FamilyVertex(index, kind, one["point"][0], one["point"][1], tuple(ends))
            for index, (one, kind, ends) in enumerate(rows)
        )

    @cached_property
    def regions(self) -> tuple[FamilyRegion, ...]:
        """The regions."""
        rows = zip(self.document["regions"], self._native.sure[0], strict=True)
        return tuple(
            FamilyRegion(
                id=index,
                itinerary=None if one["label"] is None else self._itinerary(one["label"]),
                area=one["area"],
                sample=(one["sample"][0], one["sample"][1]),
                clearance=one["clearance"],
                curves=tuple(sorted({curve for curve, _ in one["boundary"]})),
                doubtful=doubtful,
            )
            for index, (one, doubtful) in enumerate(rows)
        )

    @cached_property
    def unresolved(self) -> tuple[Unresolved, ...]:
        """What the trace could not explain."""
        found = []
        for one, text in zip(self.document["unresolved"], self._native.doubts[1], strict=True):
            ((kind, fields),) = one.items()
            if "vertex" in fields:
                places = [self.document["vertices"][fields["vertex"]]["point"]]
            else:
                places = fields["between"] if "between" in fields else [fields["point"]]
            labels = tuple(self._itinerary(label) for label in fields.get("labels", ()))
            found.append(Unresolved(kind.replace("_", "-"), _points(places), labels, text))
        return tuple(found)

    def locate(self, x: ArrayLike, y: ArrayLike) -> FamilyLocated:
        """The regions in which points lie. x and y broadcast."""
        (x, y), shape = _pairs(x, y)
        region, distance = self._native.locate(x, y)
        labels = [one.itinerary for one in self.regions]
        counts = np.array([_count_events(one) for one in labels] + [-1])
        names = np.array(["" if one is None else str(one) for one in labels] + [""])
        doubtful = np.array([one.doubtful for one in self.regions] + [True])
        # -1 and -2 both stand for the last entry.
        index = np.maximum(region, -1)
        return FamilyLocated(
            region.reshape(shape),
            counts[index].reshape(shape),
            names[index].reshape(shape),
            doubtful[index].reshape(shape),
            distance.reshape(shape),
        )

    def decide(
        self,
        family: HybridFamily,
        x: ArrayLike,
        y: ArrayLike,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> NDArray[np.object_]:
        """The itinerary at every point: by a run of the family within the error of a curve or of
        the window's edge, and in regions in doubt. None outside the window. x and y broadcast.
        threads, progress: as in `HybridFamily.labels`.
        """
        (x, y), shape = _pairs(x, y)
        family._compare(x, y)
        own = family._in(self.window)
        with reported(progress, "decide") as report:
            found = own.decide(self._native, x, y, _threads(threads), report)
        return _objects([one and _label(one, family.guards) for one in found], shape)

    def _lines(self) -> Iterator[tuple[str, Floats]]:
        for curve in self.curves:
            yield curve.margin.place, self._native.polyline(curve.id).reshape(-1, 2)

    def _labels(self) -> Iterator[tuple[str, float, tuple[float, float]]]:
        (left, right), (bottom, top) = self.window
        whole = (right - left) * (top - bottom)
        for region in self.regions:
            count = _count_events(region.itinerary)
            text = "?" if region.doubtful or count < 0 else str(count)
            yield text, region.area / whole, region.sample

    def _counts(self, x: Floats, y: Floats) -> Floats:
        found = self.locate(x, y)
        return np.where(found.doubtful | (found.event_count < 0), np.nan, found.event_count)

    def _frame(self) -> dict[str, Any]:
        (xlim, ylim), (x, y) = self.window, self.axes
        return {"xlim": xlim, "ylim": ylim, "xlabel": x, "ylabel": y}

    def __repr__(self) -> str:
        counts = (len(self.curves), len(self.vertices), len(self.regions))
        text = "FamilyAtlas: {} curves, {} vertices, {} regions".format(*counts)
        return text if self.finished else f"{text}, not finished"

    @property
    def _guards(self) -> list[str]:
        return list(self.document.get("guards", ()))

    def _itinerary(self, label: Any) -> Itinerary:
        if isinstance(label, str):
            return _label((label, []), ())
        ((kind, guards),) = label.items()
        return _label((kind, guards if isinstance(guards, list) else [guards]), self._guards)

    def _margin(self, margin: Mapping[str, Any]) -> FamilyMargin:
        place = margin["place"]
        exits = [one["guard"] for one in margin["exits"]]
        name = place if isinstance(place, str) else str(next(iter(place)))
        return _margin((exits, margin["guard"], name), self._guards)


def _pairs(x: ArrayLike, y: ArrayLike) -> tuple[tuple[Floats, Floats], tuple[int, ...]]:
    """Two flat arrays of one length, and their shape."""
    given = np.broadcast_arrays(numbers("x", x), numbers("y", y))
    flat_x, flat_y = (np.ascontiguousarray(one).reshape(-1) for one in given)
    return (flat_x, flat_y), given[0].shape


def _points(pairs: Any) -> Floats:
    return np.array(list(pairs), dtype=np.float64).reshape(-1, 2)


def _objects(values: list[Any], shape: tuple[int, ...]) -> NDArray[np.object_]:
    found: NDArray[np.object_] = np.empty(len(values), dtype=object)
    found[:] = values
    return found.reshape(shape)


def _name(guard: int, names: Sequence[str]) -> str:
    """The name of a guard; its number in files without names."""
    return names[guard] if guard < len(names) else str(guard)


def _label(label: tuple[str, list[int]], names: Sequence[str]) -> Itinerary:
    kind: Any = label[0]
    if kind == "no_start":
        return Itinerary(kind, condition=label[1][0])
    return Itinerary(kind, tuple(_name(guard, names) for guard in label[1]))


def _margin(margin: tuple[list[int], int, str], names: Sequence[str]) -> FamilyMargin:
    exits, guard, place = margin
    name = f"condition {guard + 1}" if place == "condition" else _name(guard, names)
    return FamilyMargin(tuple(_name(one, names) for one in exits), name, place)


def _count_events(itinerary: Itinerary | None) -> int:
    if itinerary is None or itinerary.kind not in ("fires", "begins"):
        return -1
    return len(itinerary.guards)


def finished(found: tuple[_native.FamilyAtlas, BaseException | None]) -> FamilyAtlas:
    """The atlas, unless an exception has ended the trace early."""
    atlas, error = FamilyAtlas(found[0]), found[1]
    if isinstance(error, KeyboardInterrupt):
        raise TraceInterrupted(atlas) from error
    if error is not None:
        raise error
    if atlas.finished and atlas.objection is not None:
        warnings.warn(f"the atlas may be wrong: {atlas.objection}", AtlasWarning, stacklevel=3)
    return atlas
