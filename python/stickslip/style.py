"""Colours and line styles of all pictures, those of the program's.

Lines have the colours of Okabe and Ito (2008), which readers with any common colour blindness can
tell apart: BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY and INK, nearly black.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stickslip import _native

if TYPE_CHECKING:
    from matplotlib.colors import ListedColormap

_STYLE = _native.style()
BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, INK = (colour for _, colour in _STYLE["colours"])
#: Colours of series, in the order in which they are used.
COLOURS: tuple[str, ...] = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, INK)
#: Lines that divide.
RULE: str = _STYLE["rule"]
#: Shades of the phases of a collision, by their characters in an itinerary.
PHASES: dict[str, str] = dict(_STYLE["phases"])


def _lines(styles: dict[str, tuple[str, list[float]]]) -> dict[str, dict[str, Any]]:
    """Properties of lines of matplotlib, whose dashes are in widths of the line."""
    return {
        name: {"color": colour, "linestyle": (0, tuple(dashes)) if dashes else "-"}
        for name, (colour, dashes) in styles.items()
    }


#: Properties of lines of matplotlib, by the kind of a boundary of collisions.
BOUNDARIES: dict[str, dict[str, Any]] = _lines(_STYLE["boundaries"])
#: The same by the place of the margin of a boundary of a family.
PLACES: dict[str, dict[str, Any]] = _lines(_STYLE["places"])


def diverging() -> ListedColormap:
    """From blue through white to red, for quantities around 0."""
    return _map("diverging")


def growing() -> ListedColormap:
    """From light to dark, for numbers from small to large."""
    return _map("growing")


def _map(name: str) -> ListedColormap:
    from matplotlib.colors import ListedColormap

    return ListedColormap(_STYLE[name], name=f"stickslip-{name}")
