"""Options of a trace, as the native module reads them."""

from __future__ import annotations

import json
import operator
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from stickslip._compiled import _number


#: How much is done for an atlas.
Effort: TypeAlias = Literal["screen", "default", "certain"]


@dataclass(frozen=True)
class TraceOptions:
    """How boundaries are traced. Lengths are in the units of the parameters."""

    #: The largest distance of a point from its boundary, up to 1e-6.
    tolerance: float = 1e-12
    #: That of the curves between the points, from ten times the tolerance to 1e-2.
    interpolation: float = 1e-10
    #: The distance from a boundary at which itineraries are compared, up to 1e-4.
    offset: float = 1e-8
    #: The error of a margin, up to 1e-6: smaller values carry no information.
    noise: float = 1e-13
    #: The longest step, as a part of the window's shorter side, up to 0.25.
    max_step: float = 0.05
    #: The largest angle between the tangents of points that follow each other, up to 0.5.
    max_angle: float = 0.2
    #: How far beyond the window boundaries are followed, as a part of its shorter side, up to 1e-2.
    beyond: float = 0.0
    #: The cells of the grid along each axis, from 2 to 4096.
    cells: int = 32
    #: The greatest number of points of a curve.
    max_nodes: int = 20_000
    #: A window that shows more curves before it is traced is refused; that count misses some, so
    #: that up to twice as many are traced.
    max_curves: int = 10_000


@dataclass(frozen=True)
class VerifyOptions:
    """Where the regions are compared with runs."""

    #: Random points, spread evenly over the window.
    random_points: int = 10_000
    #: Random points on each side of every curve, at distances from `nearest` to `farthest`.
    near_points: int = 20
    nearest: float = 1e-8
    farthest: float = 1e-3
    seed: int = 1


#: Options that are whole numbers.
_COUNTS = {
    "cells",
    "max_nodes",
    "max_curves",
    "random_points",
    "near_points",
    "seed",
    "rounds",
}


def _json(fields: dict[str, Any]) -> str:
    """Options as JSON, which has no numbers that are not finite."""
    return json.dumps(_plain(fields, ""))


def _plain(value: Any, name: str) -> Any:
    if isinstance(value, dict):
        return {key: _plain(one, key) for key, one in value.items()}
    if name in _COUNTS:
        number = operator.index(value)
        if not 0 <= number < 2**63:
            raise ValueError(f"{name} = {value}; expected 0 or above")
        return number
    real = _number(value, name)
    if not np.isfinite(real):
        raise ValueError(f"{name} = {real}; expected a finite number")
    return real
