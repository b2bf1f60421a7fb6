"""Stacks of families: atlases over a third parameter."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip import _atlas_results, _native
from stickslip._axes import svg
from stickslip._compiled import _count, _number
from stickslip._family_atlases import Cancelled, FamilyAtlas, Itinerary, _label
from stickslip._family_options import TraceOptions, VerifyOptions
from stickslip._progress import Progress, reported
from stickslip._atlases import AtlasWarning
from stickslip._collisions import _threads
from stickslip._families import HybridFamily, _check_calls, _events_of, _survey

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class FamilyLayer:
    """An atlas at one value of the third parameter."""

    value: float
    #: If something speaks against it, it is not compared with others.
    atlas: FamilyAtlas


@dataclass(frozen=True)
class FamilyChange:
    """A change of the regions as the third parameter grows."""

    #: Values of two atlases between which the change lies.
    between: tuple[float, float]
    #: crossing, touch, flat, edge, edge-touch, corner or swallowtail: what happens to the special
    #: points of the atlases; None if the change is only enclosed.
    kind: str | None
    #: Where it happens; None if the change is only enclosed.
    value: float | None
    x: float | None
    y: float | None
    #: Whether several changes may lie between the two values, or nothing could be solved for.
    doubtful: bool
    #: Pairs of what happens (born, splits, merge or dies) and the itinerary of the region. Without
    #: any, only neighbours change.
    effects: tuple[tuple[str, Itinerary], ...]


@dataclass(frozen=True)
class FamilyStack:
    """Atlases of a family at several values of a third parameter, from `stack_family`."""

    #: The atlases at the values; at the first ones of them, if the search was cancelled.
    layers: tuple[FamilyLayer, ...]
    #: The changes between the layers, in the order of the third parameter.
    changes: tuple[FamilyChange, ...]
    #: The number of atlases that were traced to find them.
    atlases: int
    #: Whether the search came to its end. If it was cancelled, what was not isolated by then is a
    #: bracket in doubt.
    finished: bool
    #: What speaks against the stack; None if nothing does.
    objection: str | None

    def plot(self, ax: Axes | None = None, name: str = "value", **line: Any) -> Axes:
        """Draws the number of regions over the third parameter, called `name`, with matplotlib."""
        return _atlas_results.stack(self, ax, line, name)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)

    def __repr__(self) -> str:
        text = f"FamilyStack: {len(self.layers)} layers, {len(self.changes)} changes"
        return text if self.finished else f"{text}, not finished"


class StackInterrupted(KeyboardInterrupt):
    """Ctrl-C during `stack_family`. `stack` has what was found."""

    def __init__(self, stack: FamilyStack) -> None:
        super().__init__("the stack was interrupted")
        self.stack = stack

    def __reduce__(self) -> tuple[Any, ...]:
        return (StackInterrupted, (self.stack,))


def stack_family(
    family: Callable[[float], HybridFamily],
    x: tuple[float, float],
    y: tuple[float, float],
    values: ArrayLike,
    *,
    options: TraceOptions | None = None,
    verify: VerifyOptions | None = None,
    tolerance: float = 1e-9,
    rounds: int = 8,
    width: float = 1e-5,
    atlases: int = 2000,
    threads: int | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> FamilyStack:
    """Atlases of a family at several values of a third parameter, and the values between them at
    which regions are born, split, merge or die.

    family: returns the `HybridFamily` at a value between the first and the last one. It is called
    for hundreds of values, or thousands: first on this thread, then on the one that traces. The
    systems must be defined a hundredth of the window beyond its edges, have the same guards, depend
    on the value as smoothly as on the two parameters, and all be compiled if the first one is.
    values: two or more, in ascending order. x, y, options, verify, tolerance, rounds, threads,
    progress, cancelled: as in `trace_family`, for every atlas; boundaries are followed up to the
    window's edges only, and `progress` counts atlases. The first Ctrl-C raises StackInterrupted,
    whose `stack` has what was found; a second one ends the run that is under way, and nothing is
    kept.

    width: of the bracket of a change, as a part of the greater one of its two values, from 1e-9 to
    0.1. It is wider where atlases are in doubt, or where a region is too small to be seen before it
    dies. atlases: their number, at most.

    Where neighbouring atlases differ, others between them isolate the changes, and what happens
    there is solved for in all three parameters, to about 1e-9 of their intervals, or to 1e-6 where
    two boundaries touch for every value. Changes that undo each other between two atlases are not
    seen. If anything speaks against the result, it says so in an AtlasWarning and in `objection`.

    Raises ValueError for what is not possible, TypeError for what is of another type, and what
    functions raise, with a note that has the third parameter.
    """
    if not callable(family):
        raise TypeError(f"family is of type {type(family).__name__}; expected a callable")
    window, text = _survey(x, y, options, verify, tolerance, rounds)
    _check_calls(progress, cancelled)
    heights = np.asarray(values, dtype=np.float64)
    ascend = heights.ndim == 1 and np.isfinite(heights).all() and (np.diff(heights) > 0).all()
    if heights.size < 2 or not ascend:
        raise ValueError(f"values = {values!r}; expected two or more, in ascending order")
    if not 1e-9 <= _number(width, "width") <= 0.1:
        raise ValueError(f"width = {width}; expected 1e-9 to 0.1")

    def family_at(value: float) -> HybridFamily:
        found = family(value)
        if not isinstance(found, HybridFamily):
            kind = type(found).__name__
            raise TypeError(f"family({value}) is of type {kind}; expected a HybridFamily")
        return found

    def accumulation_at(value: float) -> tuple[int, int, int] | None:
        try:
            return family_at(value)._accumulation(window)
        except Exception as error:
            error.add_note(f"with the third parameter {value!r}")
            raise

    events = _events_of(map(accumulation_at, heights.tolist()))

    def member(value: float) -> _native.HybridFamily:
        found = family_at(value)
        found._compare(*([*interval, sum(interval) / 2.0] for interval in window))
        return found._up_to(events)

    search = (text, width, _count(atlases, "atlases"))
    with reported(progress, "stack") as report:
        planes, changes, count, finished, objection, error = _native.stack_family(
            member, window, heights.tolist(), search, _threads(threads), (report, cancelled)
        )
    rows = zip(heights.tolist(), planes, strict=False)
    layers = [FamilyLayer(value, FamilyAtlas(plane)) for value, plane in rows]
    guards = layers[0].atlas._guards if layers else []
    made = tuple(_change(one, guards) for one in changes)
    stack = FamilyStack(tuple(layers), made, count, finished, objection)
    if isinstance(error, KeyboardInterrupt):
        raise StackInterrupted(stack) from error
    if error is not None:
        raise error
    if finished and objection is not None:
        warnings.warn(f"the stack may be wrong: {objection}", AtlasWarning, stacklevel=2)
    return stack


def _change(fields: Any, guards: list[str]) -> FamilyChange:
    (low, high), meeting, doubtful, effects = fields
    kind, value, x, y = meeting or (None, None, None, None)
    regions = tuple((effect, _label(label, guards)) for effect, label in effects)
    return FamilyChange((low, high), kind, value, x, y, doubtful, regions)
