"""Pictures of orbits, of their branches and regions, and of what runs lead to, in axes of
matplotlib."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip._axes import DASHES, MARKERS, Panels, legend, one, panels
from stickslip.style import COLOURS, INK, RULE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._attractors import Basins, Diagram
    from stickslip._orbit_regions import OrbitRegions
    from stickslip._orbits import Branch, Orbit, SpecialCurve

#: More components get no panel unless they are asked for.
MOST_PANELS = 6
#: How the orbits of a stretch of a branch are drawn.
_STRETCHES: dict[str, dict[str, Any]] = {
    "stable": {"color": COLOURS[0], "linestyle": "-"},
    "unstable": {"color": COLOURS[1], "linestyle": "--"},
    "not followed": {"color": RULE, "linestyle": ":"},
}


def orbit(found: Orbit, ax: Panels, line: dict[str, Any]) -> list[Axes]:
    """The components over one period, with the events."""
    names = found._system.components[:MOST_PANELS]
    times, states = found.course()
    drawn = panels(ax, len(names))
    for place, (each, name) in enumerate(zip(drawn, names, strict=True)):
        style = {"color": COLOURS[place % len(COLOURS)], "label": name}
        each.plot(times, states[place], **(style | line))
        end = found.start
        for segment in found.segments:
            end += segment.duration
            each.axvline(end, color=RULE, linewidth=0.6, zorder=0)
        each.set(ylabel=name)
    drawn[-1].set(xlabel="time $t$, with the events")
    return drawn


def branch(found: Branch, ax: Axes | None, component: str | None, line: dict[str, Any]) -> Axes:
    """A component at the end of the first segment, with the special orbits."""
    ax = one(ax)
    name = found._components[0] if component is None else component
    values, ends = found.values, found.ends(name)

    def stretch(place: int) -> str:
        point = found.points[place]
        return ("stable" if point.stable else "unstable") if point.admissible else "not followed"

    for what, run in groupby(range(len(values)), stretch):
        places = list(run)
        # Up to the first orbit of the next stretch.
        chosen = slice(places[0], places[-1] + 2)
        ax.plot(values[chosen], ends[chosen], **(_STRETCHES[what] | {"label": what} | line))
    place = found._place(name)
    at = [(it.kind, it.value, float(it.orbit.segments[0].end[place])) for it in found.specials]
    _marked(ax, at)
    ax.set(xlabel=found.parameter, ylabel=f"{name} before {found.points[0].segments[0].rule}")
    legend(ax)
    return ax


def curve(found: SpecialCurve, ax: Axes | None, line: dict[str, Any]) -> Axes:
    """The curve in the plane of both parameters."""
    ax = one(ax)
    x, y = found.parameters
    ax.plot(*found.values, **({"color": COLOURS[0], "label": found.kind} | line))
    places = [(name, it.parameters[x], it.parameters[y]) for name, it in found.meetings]
    _marked(ax, places)
    ax.set(xlabel=x, ylabel=y)
    legend(ax)
    return ax


def regions(found: OrbitRegions, ax: Axes | None, line: dict[str, Any]) -> Axes:
    """The boundaries by their kinds; each region says whether a stable orbit is followed there."""
    ax = one(ax)
    kinds = list(dict.fromkeys(it.kind for it in found.boundaries))
    for boundary in found.boundaries:
        place = kinds.index(boundary.kind)
        style: dict[str, Any] = {
            "color": COLOURS[place % len(COLOURS)],
            "linestyle": DASHES[place % len(DASHES)],
            "label": boundary.kind,
        }
        ax.plot(*boundary.points, **(style | line))
    for region in found.regions:
        text = "?" if region.orbits is None else _followed(region.orbits)
        ax.annotate(text, region.sample, ha="center", va="center", fontsize="small", color=INK)
    ax.set(xlabel=found.parameters[0], ylabel=found.parameters[1])
    legend(ax)
    return ax


def _followed(orbits: tuple[int, ...]) -> str:
    """What the system follows, from the numbers of multipliers outside the unit circle."""
    words = ["stable" if outside == 0 else "unstable" for outside in orbits]
    return " + ".join(words) or "none"


def diagram(found: Diagram, ax: Axes | None, component: str | None, points: dict[str, Any]) -> Axes:
    """A component on the section, upwards and downwards."""
    ax = one(ax)
    place = found._place(component)
    for way, (label, rows) in enumerate((("upwards", found.up), ("downwards", found.down))):
        style: dict[str, Any] = {
            "color": COLOURS[way],
            "marker": (".", "x")[way],
            "markersize": (3, 2)[way],
            "linestyle": "none",
            "label": label,
        }
        ax.plot(rows[0], rows[1 + place], **(style | points))
    ax.set(xlabel=found.parameter, ylabel=found.components[place])
    legend(ax)
    return ax


def basins(found: Basins, ax: Axes | None, colours: dict[str, Any]) -> Axes:
    """The place of the attractor of each run, in colours."""
    from matplotlib.colors import ListedColormap

    ax = one(ax)
    count = len(found.attractors)
    shades = ["white", *(COLOURS[place % len(COLOURS)] for place in range(count))]
    style: dict[str, Any] = {"cmap": ListedColormap(shades), "vmin": -1.5, "vmax": count - 0.5}
    x, y = _edges(found.x), _edges(found.y)
    ax.pcolormesh(x, y, found.labels, **(style | {"rasterized": True} | colours))
    for place in np.unique(found.labels):
        label = f"attractor {place}" if place >= 0 else "does not settle"
        ax.plot([], [], "s", color=shades[place + 1], markeredgecolor=INK, label=label)
    one_name, other_name = found.components
    ax.set(xlabel=f"{one_name} at the start", ylabel=f"{other_name} at the start")
    legend(ax)
    return ax


def _edges(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The edges of cells around values."""
    steps = np.diff(values)
    if not steps.size:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middles = values[:-1] + 0.5 * steps
    first, last = values[0] - 0.5 * steps[0], values[-1] + 0.5 * steps[-1]
    return np.concatenate([[first], middles, [last]])


def _marked(ax: Axes, places: list[tuple[str, float, float]]) -> None:
    """Marks places by what is there."""
    kinds = list(dict.fromkeys(kind for kind, *_ in places))
    for number, kind in enumerate(kinds):
        at = np.array([place[1:] for place in places if place[0] == kind]).T
        style: dict[str, Any] = {"marker": MARKERS[number % len(MARKERS)], "linestyle": "none"}
        ax.plot(*at, color=INK, markerfacecolor="none", label=kind, **style)
