"""The explorer: one page that computes."""

from __future__ import annotations

import json
import os
import tempfile
import webbrowser
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any, TypeAlias
from urllib.parse import parse_qs, quote, urlencode

from stickslip import _native
from stickslip._laws import laws
from stickslip._atlases import Atlas
from stickslip._collisions import Collision
from stickslip._formulas import FormulaSystem

Explored: TypeAlias = Collision | Atlas | FormulaSystem | str | None


class Explorer:
    """The explorer at a view. A cell of a notebook shows it; `explore` makes one."""

    def __init__(self, view: str, height: int) -> None:
        #: What the page shows, as the part of a link behind its #.
        self.view = view
        #: Pixels in a notebook.
        self.height = height

    @property
    def point(self) -> tuple[float, float] | None:
        """The place of the contact in the axes of the plane, if the view says it."""
        found = parse_qs(self.view).get("point")
        if found is None:
            return None
        try:
            one, other = json.loads(found[0])
            return float(one), float(other)
        except (TypeError, ValueError):
            return None

    @property
    def html(self) -> str:
        """The page. It needs no server and no network."""
        return _native.explorer(self.view)

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the page into a file."""
        Path(file).write_text(self.html, encoding="utf-8")

    def open(self) -> bool:
        """Opens the page in a browser, and says whether one was found."""
        file = Path(tempfile.gettempdir(), "stickslip-explorer.html")
        self.save(file)
        return webbrowser.open(file.as_uri())

    def _repr_html_(self) -> str:
        style = f"width: 100%; height: {self.height}px; border: 0"
        return f'<iframe title="explorer" style="{style}" srcdoc="{escape(self.html)}"></iframe>'

    def __repr__(self) -> str:
        return f"Explorer({self.view!r})"


def explore(shown: Explored = None, *, height: int = 760) -> Explorer:
    """The explorer: the switching of two spheres, or of a system, under one's finger.

    shown: what it shows first: a collision at its place, an atlas with its window, a system of
    formulas, or a link that was copied from the page (its part behind # is enough). height: pixels
    in a notebook.

    The result is what a cell of a notebook shows; `open()` opens it in a browser, and `save(file)`
    writes it. A link that was copied from the page is read back by `explore(link).point`.

    >>> import stickslip
    >>> page = stickslip.explore(stickslip.collide(18, 0.5, damping=0.1))
    >>> page.point
    (18.0, 0.5)
    >>> stickslip.explore("explorer.html#preset=figure3").view
    'preset=figure3'
    """
    if isinstance(height, bool) or not isinstance(height, int) or height < 1:
        raise ValueError(f"height = {height!r}; expected pixels, an integer above 0")
    match shown:
        case None:
            view = ""
        case str():
            view = shown.partition("#")[2] or ("" if "://" in shown else shown.removesuffix("#"))
        case FormulaSystem():
            view = _view(tab="system", text=shown.text)
        case Collision():
            view = _of_collision(shown)
        case Atlas():
            view = _of_atlas(shown)
        case _:
            raise TypeError(
                f"{type(shown).__name__} cannot be explored; expected a Collision, an Atlas, a "
                "FormulaSystem or a link"
            )
    return Explorer(view, height)


def _of_collision(collision: Collision) -> str:
    parameters = collision.to_dict()["parameters"]
    return _view(point=[parameters["kappa"], parameters["psi"]], **_scene(parameters))


def _of_atlas(atlas: Atlas) -> str:
    """The window of an atlas, in its own coordinates, with the contact in its middle."""
    window = atlas.window
    sides = [window["kappa"], window.get("ratio", window["psi"])]
    x, y = ({"low": low, "high": high, "log": low > 0} for low, high in sides)
    fields = {"x": x, "y": y, "point": [(low + high) / 2 for low, high in sides]}
    if "ratio" in window:
        fields |= {"axes": "kappa-ratio", "mu": window["mu"], "alpha": window["alpha"]}
    return _view(**fields, **_scene(window))


def _scene(given: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a view for the law and the dampings of a collision or a window."""
    scene = {"damping": given["damping"]}
    if "law" not in given:
        return scene
    law = dict(given["law"])
    scene |= {"tangential": given.get("tangential_damping", 0.0), **law.pop("friction", {})}
    for name, known in laws().items():
        if law == dict(known.law):
            return {**scene, "law": name}
        if law == {**known.law, "limit_damping": True}:
            return {**scene, "law": f"{name}+limit_damping"}
    raise ValueError(f"the law {given['law']} has no name; expected one of stickslip.laws()")


def _view(**fields: Any) -> str:
    text = {key: one if isinstance(one, str) else json.dumps(one) for key, one in fields.items()}
    return urlencode(text, quote_via=quote)
