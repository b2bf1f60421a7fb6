"""Pictures of the tables of studies: one column over another one, a line for each case."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip._axes import DASHES, MARKERS, legend, one, scale
from stickslip.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._studies import Table

_METHODS = ("method", "coordinates", "switches")
#: What is drawn of a table unless it is said: x, y, and the columns that tell lines apart.
_USUAL = {
    "asymptote_envelope": ("kappa", "w_final", ("psi",)),
    "asymptote_restitution": ("kappa", "eps_t", ("range",)),
    "asymptote_counts": ("kappa", "ratio", ("psi",)),
    "asymptote_profile": ("phase", "f", ()),
    "asymptote_convergence": ("start", "difference", ("coefficients",)),
    "convergence_steps": ("step", "velocity_error", _METHODS),
    "convergence_tolerances": ("tolerance", "velocity_error", _METHODS),
}
#: The same of a system of the user, by the columns that its tables have.
_USUAL_OF_SYSTEMS = {"convergence_tolerances": ("tolerance", "state_error", ("method",))}


def usual(table: Table) -> tuple[str, str, tuple[str, ...]] | None:
    """What is drawn of a table unless it is said; None if that is not known."""
    for choices in (_USUAL, _USUAL_OF_SYSTEMS):
        found = choices.get(table.name)
        if found and {found[0], found[1], *found[2]} <= set(table.meanings):
            return found
    return None


def table(
    found: Table,
    ax: Axes | None,
    choice: tuple[str | None, str | None, Sequence[str] | None],
    line: dict[str, Any],
) -> Axes:
    """One column over another one."""
    x, y, by = _chosen(found, choice)
    columns = found.columns
    keys = list(zip(*(columns[name].tolist() for name in by), strict=True)) if by else []
    lines = list(dict.fromkeys(keys)) or [()]
    ax = one(ax)
    for place, key in enumerate(lines):
        rows = [row for row, own in enumerate(keys) if own == key] if by else slice(None)
        style: dict[str, Any] = {
            "color": COLOURS[place % len(COLOURS)],
            "linestyle": DASHES[place % len(DASHES)],
            "marker": MARKERS[place % len(MARKERS)],
            "markersize": 4,
            "markerfacecolor": "none",
            "linewidth": 1.0,
            "label": _label(by, key),
        }
        ax.plot(columns[x][rows], columns[y][rows], **(style | line))
    ax.set(xscale=scale(columns[x]), yscale=scale(_above_zero(columns[y])))
    ax.set(xlabel=_axis(found, x), ylabel=_axis(found, y))
    legend(ax)
    return ax


def _above_zero(values: Any) -> Any:
    """The values, without errors that are exactly 0, which no logarithmic axis shows."""
    return values[values != 0.0] if (values >= 0.0).all() else values


def _chosen(
    found: Table, choice: tuple[str | None, str | None, Sequence[str] | None]
) -> tuple[str, str, Sequence[str]]:
    """What is drawn: what is given, and else what is usual."""
    x, y, by = choice
    if x is None or y is None:
        known = usual(found)
        if known is None:
            raise ValueError(f"x and y are missing; expected two of {list(found.meanings)}")
        x, y, by = x or known[0], y or known[1], known[2] if by is None else by
    for name in (x, y, *(by or ())):
        if name not in found.meanings:
            raise ValueError(f"{name!r} is no column; expected one of {list(found.meanings)}")
    for name in (x, y):
        if found.columns[name].dtype.kind not in "iuf":
            raise ValueError(f"column {name!r} has no numbers")
    return x, y, by or ()


def _label(by: Sequence[str], key: tuple[Any, ...]) -> str | None:
    parts = (
        one if isinstance(one, str) else f"{name} = {one:g}"
        for name, one in zip(by, key, strict=True)
    )
    return ", ".join(parts) or None


def _axis(found: Table, name: str) -> str:
    """The name of a column and its meaning, in lines that fit beside an axis."""
    words, lines = f"{name}: {found.meanings[name]}".split(" "), [""]
    for word in words:
        if len(lines[-1]) + len(word) > 40:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)
