"""Axes of matplotlib, which is imported when a picture is drawn, and what all pictures share."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from stickslip._libraries import library

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: What a picture with several panels takes: its panels, one that holds all of them, or none.
Panels: TypeAlias = "Axes | Sequence[Axes] | None"

DASHES = ("-", "--", "-.", ":")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
#: Columns and rows of a map.
_CELLS = 300
#: Lines with more points are pixels in SVG documents.
_MOST_POINTS = 20_000


def one(ax: Axes | None) -> Axes:
    """The axes, or new ones."""
    return panels(ax, 1)[0]


def panels(ax: Panels, count: int) -> list[Axes]:
    """So many axes: those that are given, one for all, or new ones one below the other."""
    if ax is None:
        figure = _new_figure(count)
        return list(figure.subplots(count, sharex=True, squeeze=False)[:, 0])
    if not hasattr(ax, "__len__"):
        return [ax] * count
    given = list(ax)  # type: ignore[arg-type]
    if len(given) != count:
        raise ValueError(f"ax has {len(given)} axes; expected one, or {count}")
    return given


def _new_figure(count: int) -> Any:
    plt = library("matplotlib.pyplot", "to draw")
    return plt.figure(figsize=_size(count), layout="constrained")


def svg(plot: Callable[..., Any], count: int = 1) -> str | None:
    """The picture that a method `plot` draws, as SVG; None without matplotlib."""
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ImportError:
        return None
    figure = Figure(figsize=_size(count), layout="constrained")
    axes = list(figure.subplots(count, sharex=True, squeeze=False)[:, 0])
    plot(axes if count > 1 else axes[0])
    for line in (line for ax in axes for line in ax.lines):
        line.set_rasterized(len(line.get_xdata()) > _MOST_POINTS)
    text = io.StringIO()
    # The same picture is the same text, and words are words.
    with mpl.rc_context({"svg.hashsalt": "stickslip", "svg.fonttype": "none"}):
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def _size(count: int) -> tuple[float, float]:
    return 6.4, {1: 4.2, 2: 5.6}.get(count, 2.2 * count)


def legend(ax: Axes, **options: Any) -> None:
    """A legend above the axes, where it hides nothing, if anything has a label."""
    handles, labels = ax.get_legend_handles_labels()
    known = dict(zip(labels, handles, strict=True))
    if known:
        # What all numbers of the axis share stands above it too.
        ax.yaxis.set_offset_position("right")
        columns = max(1, min(len(known), 84 // (8 + max(map(len, known)))))
        place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
        style: dict[str, Any] = {"ncols": columns, "frameon": False, "fontsize": "small"}
        ax.legend(known.values(), known.keys(), **(place | style | options))


def scale(values: Any) -> Any:
    """The scale of an axis for these values: logarithmic if they span more than a decade, unless
    they lie at equal distances."""
    found = np.unique(np.asarray(values)[np.isfinite(values)])
    if not found.size or found[0] <= 0 or found[-1] <= 10 * found[0]:
        return "linear"
    steps = np.diff(found)
    return "linear" if steps.size > 1 and np.ptp(steps) < 1e-6 * found[-1] else "log"


def cells(low: float, high: float) -> Any:
    """The centres of cells of a map, in the scale of an axis."""
    parts = (np.arange(_CELLS) + 0.5) / _CELLS
    if scale([low, high]) == "log":
        return low * (high / low) ** parts
    return low + (high - low) * parts
