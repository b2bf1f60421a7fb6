"""Pictures of runs: states in time, coloured by mode, with events; derivatives; boundaries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip._axes import DASHES, MARKERS, Panels, legend, one, panels
from stickslip.style import COLOURS, RULE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._derivatives import Sensitivities
    from stickslip._solutions import DenseOutput, Solution
    from stickslip._families import Followed

#: Times, states of shape (n, k), and modes: a line, interrupted by NaN where the state jumps.
_Line: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.str_]]
#: The mode of a gap in a line: no other one has this name.
_GAP = "\x01"
#: Components that have panels of their own if none are chosen.
MOST_PANELS = 8
#: Points of the line in each step.
_POINTS = 8
#: And of the whole line, unless it has more steps.
_MOST_POINTS = 200_000
#: A run of fewer calls is repeated for a smooth line.
_CHEAP = 1_000_000
#: More events are marked by points alone.
_MOST_LINES = 200


def solution(
    found: Solution, ax: Panels, components: Sequence[int] | None, line: dict[str, Any]
) -> list[Axes]:
    """The components of the state in time, a panel for each."""
    drawn, chosen = _panels(ax, components, len(found.y))
    _lines(drawn, chosen, found._components, _line(found), line)
    events = found.events
    known = [name for name in found.event_names if (events["guard"] == name).any()]
    for axes, place in zip(drawn, chosen, strict=True):
        for number, name in enumerate(known):
            rows = events[events["guard"] == name]
            axes.plot(
                rows["time"], rows["before"][:, place], linestyle="none", color=COLOURS[-1],
                marker=MARKERS[number % len(MARKERS)], markersize=4, zorder=3,
                markerfacecolor="none", label=name,
            )  # fmt: skip
    for axes in dict.fromkeys(drawn):
        if events.size <= _MOST_LINES:
            for when in np.unique(events["time"]):
                axes.axvline(when, color=RULE, linewidth=0.5, alpha=0.5, zorder=0)
    return _finish(drawn)


def dense(
    found: DenseOutput, ax: Panels, components: Sequence[int] | None, line: dict[str, Any]
) -> list[Axes]:
    """The components of the state in time, a panel for each."""
    times = _times(found)
    states = found(times)
    drawn, chosen = _panels(ax, components, len(states))
    names = [f"y{place}" for place in range(len(states))]
    _lines(drawn, chosen, names, (times, states, found.mode(times)), line)
    return _finish(drawn)


def sensitivities(found: Sensitivities, ax: Axes | None, line: dict[str, Any]) -> Axes:
    """The derivatives of the times of events."""
    ax = one(ax)
    events = found.event != ""
    ax.axhline(0.0, color=RULE, linewidth=0.6)
    for place, name in enumerate(found.by):
        style: dict[str, Any] = {
            "color": COLOURS[place % len(COLOURS)],
            "marker": MARKERS[place % len(MARKERS)],
            "linestyle": DASHES[place % len(DASHES)],
            "linewidth": 0.8,
            "label": f"by {name}",
        }
        ax.plot(found.t[events], found.t_by[events, place], **(style | line))
    ax.set(xlabel="time $t$ of the event", ylabel="derivative of this time")
    legend(ax)
    return ax


def followed(found: Followed, ax: Axes | None, line: dict[str, Any]) -> Axes:
    """The boundary, and where monitors vanish on it."""
    ax = one(ax)
    label = f"{found.margin.guard} ({found.margin.place})"
    x, y = found.points.T
    ax.plot(x, y, **({"color": COLOURS[0], "label": label} | line))
    for number in dict.fromkeys(zero.monitor for zero in found.zeros):
        places = [zero.point for zero in found.zeros if zero.monitor == number and zero.point]
        x, y = np.array(places, dtype=float).reshape(-1, 2).T
        ax.plot(x, y, MARKERS[number % len(MARKERS)], color=COLOURS[1], markerfacecolor="none",
                label=f"monitor {number} vanishes")  # fmt: skip
    ax.set(xlabel="first parameter", ylabel="second parameter")
    legend(ax)
    return ax


def _panels(
    ax: Panels, components: Sequence[int] | None, count: int
) -> tuple[list[Axes], list[int]]:
    chosen = list(range(min(count, MOST_PANELS)) if components is None else components)
    for place in chosen:
        if not 0 <= place < count:
            raise ValueError(f"components: {place}; expected 0 to {count - 1}")
    if not chosen:
        raise ValueError("components is empty; expected at least one")
    return panels(ax, len(chosen)), chosen


def _lines(
    drawn: list[Axes], chosen: list[int], names: list[str], of: _Line, line: dict[str, Any]
) -> None:
    """The lines, a colour for each mode; and a dash for each component, if they share axes."""
    time, states, modes = of
    known = list(dict.fromkeys(mode for mode in modes.tolist() if mode != _GAP))
    together = len(drawn) > 1 and len(set(drawn)) == 1
    for number, (axes, place) in enumerate(zip(drawn, chosen, strict=True)):
        for colour, mode in enumerate(known):
            label = ", ".join(part for part in (names[place] if together else "", mode) if part)
            style: dict[str, Any] = {
                "color": COLOURS[colour % (len(COLOURS) - 1)],
                "linestyle": DASHES[(number if together else colour // 6) % len(DASHES)],
                "label": label or None,
            }
            if len(known) == 1 and together:
                style["color"] = COLOURS[number % (len(COLOURS) - 1)]
            axes.plot(time, np.where(modes == mode, states[place], np.nan), **(style | line))
        axes.set_ylabel("state" if together else names[place])


def _finish(drawn: list[Axes]) -> list[Axes]:
    drawn[-1].set_xlabel("time $t$")
    for axes in dict.fromkeys(drawn):
        legend(axes)
    return drawn


def _line(found: Solution) -> _Line:
    """The states at many times, both of an event among them, and a gap between these."""
    curve = found.sol or found._smooth(_CHEAP)
    times, states, modes = found.t, found.y, found.mode
    if curve is not None:
        times = _times(curve)
        states, modes = curve(times)[: len(states)], curve.mode(times)
    events = found.events
    keep = ~np.isin(times, events["time"])
    times, states, modes = times[keep], states[:, keep], modes[keep]
    sign = -1.0 if times.size and times[-1] < times[0] else 1.0
    places = np.repeat(np.searchsorted(sign * times, sign * events["time"]), 3)
    inner = np.full((len(states), 3 * events.size), np.nan)
    inner[:, 0::3], inner[:, 2::3] = events["before"].T, events["after"].T
    of_events = np.stack([events["from"], np.full(events.size, _GAP), events["to"]], axis=1)
    return (
        np.insert(times, places, np.repeat(events["time"], 3)),
        np.insert(states, places, inner, axis=1),
        np.insert(modes.astype(np.result_type(modes, of_events)), places, of_events.ravel()),
    )


def _times(curve: DenseOutput) -> NDArray[np.float64]:
    """The same number of times in each step of a run, with both ends."""
    starts, sizes, _ = curve._segments
    points = int(np.clip(_MOST_POINTS // max(1, starts.size), 2, _POINTS))
    inside = starts[:, None] + sizes[:, None] * np.linspace(0.0, 1.0, points)
    # Just before the end of a step: an event there may change the state.
    inside[:, -1] = np.nextafter(inside[:, -1], starts)
    return np.append(inside.ravel(), curve._end[0])
