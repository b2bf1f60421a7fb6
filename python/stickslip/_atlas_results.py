"""Pictures of stacks and rows of atlases, of collisions and of families alike."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip._axes import MARKERS, legend, one
from stickslip._tabular import Columns
from stickslip.style import COLOURS, RULE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._family_stacks import FamilyStack
    from stickslip._stacks import Stack

_EFFECTS = ("born", "splits", "merge", "dies")


def stack(
    found: Stack | FamilyStack, ax: Axes | None, line: dict[str, Any], name: str = "damping"
) -> Axes:
    """The number of regions over the third parameter, and where it changes."""
    ax = one(ax)
    layers: list[Any] = list(found.layers)
    places = [layer.damping if hasattr(layer, "damping") else layer.value for layer in layers]
    counts = [_regions(layer) for layer in layers]
    style: dict[str, Any] = {"color": COLOURS[0], "marker": "o", "linestyle": "none"}
    ax.plot(places, counts, label="atlases", **(style | line))
    for change in found.changes:
        low, high = change.between
        dash = ":" if change.doubtful else "-"
        ax.axvline((low + high) / 2, color=RULE, linewidth=0.8, linestyle=dash, zorder=0)
    for number, effect in enumerate(_EFFECTS):
        where = [
            sum(change.between) / 2
            for change in found.changes
            if effect in {kind for kind, _ in change.effects}
        ]
        if where:
            # Above the numbers, in a row for each effect.
            height = np.full(len(where), 0.96 - 0.05 * number)
            ax.plot(
                where, height, linestyle="none", color=COLOURS[1 + number], marker=MARKERS[number],
                transform=ax.get_xaxis_transform(), label=f"a region: {effect}",
            )  # fmt: skip
    ax.set_ylim(0, 1.35 * max([1, *counts]))
    ax.set(xlabel=name, ylabel="number of regions")
    legend(ax)
    return ax


def _regions(layer: Any) -> int:
    """The number of regions of a layer."""
    own = getattr(layer, "regions", None)
    return len(layer.atlas.regions) if own is None else sum(own.values())


def regions(atlas: Any) -> Columns:
    """A row for each region: its itinerary, its area, and a point inside."""
    rows: list[Any] = list(atlas.regions)
    samples = np.array([row.sample for row in rows], dtype=float).reshape(-1, 2)
    name = "area" if rows and hasattr(rows[0], "area") else "area_share"
    columns: Columns = {
        "region": np.arange(len(rows)),
        "itinerary": np.array([str(row.itinerary) for row in rows], dtype=str),
        name: np.array([getattr(row, name) for row in rows], dtype=float),
    }
    return columns | {"sample_x": samples[:, 0], "sample_y": samples[:, 1]}
