"""Fits of contact laws to measured impacts."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip import _laws, _native, _pictures
from stickslip._arrays import numbers
from stickslip._axes import Panels
from stickslip._kept import Kept
from stickslip._laws import Law
from stickslip._tabular import Columns, Tabular
from stickslip._progress import Progress, reported
from stickslip._collisions import _threads
from stickslip._impacts import Bodies

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Minimum:
    """A minimum of the misfit."""

    #: Stiffness and damping at normal incidence, in scaled units.
    kappa: float
    mu: float
    tangential_damping: float
    damping: float
    #: k_t in kg/s², or K in kg/(s² √m) where the stiffness is Mindlin's; None without bodies.
    stiffness: float | None
    #: Sum of the squares of the residuals over their errors, which count as 1 if none is known.
    misfit: float
    #: Root mean square of the residuals of each quantity.
    root_mean_squares: Mapping[str, float]
    #: Whether a free number is at an end of its range.
    at_end_of_range: bool


class Fit(Tabular):
    """A fit: all minima with the best one first, and intervals."""

    def __init__(self, native: _native.Fit | Kept) -> None:
        self._native = native
        #: All numbers, as the program prints them.
        self.data: dict[str, Any] = json.loads(native.json())
        #: All minima in the ranges, the best one first.
        self.minima: list[Minimum] = [_minimum(one) for one in self.data["minima"]]
        #: The pieces (low, high) of the interval of each free number; None without an interval.
        self.intervals: dict[str, list[tuple[float, float]] | None] = {
            one["parameter"]: _pieces(one["pieces"]) for one in self.data["intervals"]
        }
        #: What the data decide of each free number and what they leave open, a sentence each.
        self.verdicts: dict[str, str] = {
            one["parameter"]: one["verdict"] for one in self.data["intervals"]
        }

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (Kept(self._native.json(), self.picture()),)

    @property
    def best(self) -> Minimum:
        """The best minimum."""
        return self.minima[0]

    _dimension = "minimum"

    def _columns(self) -> Columns:
        names = [one.name for one in fields(Minimum) if one.name != "root_mean_squares"]
        columns: Columns = {}
        for name in names:
            column = [getattr(one, name) for one in self.minima]
            columns[name] = np.array([np.nan if one is None else one for one in column])
        for quantity in self.best.root_mean_squares:
            squares = [one.root_mean_squares[quantity] for one in self.minima]
            columns[f"root_mean_square_{quantity}"] = np.array(squares)
        return columns

    def plot(self, ax: Panels = None, **points: Any) -> list[Axes]:
        """Draws data and fit over the angle of incidence with matplotlib.

        ax: axes for each quantity of the data, or one for all of them; without it, new ones.
        points: properties of the measured points. The result is the axes, one for each quantity.
        """
        return _pictures.fit(self, ax, points)

    def input(self, code: str, bodies: Bodies) -> str:
        """The lines with which a particle code computes the contacts of the best fit.

        code: "lammps", "liggghts", "yade", "mfix" or "mercury". bodies: those of the fit. A
        ValueError says why if the code does not have the law, or not with these constants.
        """
        if isinstance(self._native, Kept):
            raise ValueError("a fit that was stored has no bodies; expected one that was made here")
        found: str = self._native.input(bodies._pair, code)
        return found

    def picture(self) -> str | None:
        """Data, fit and the boundaries of its switches over the angle as an SVG document."""
        found: str | None = self._native.picture()
        return found

    def _repr_html_(self) -> str | None:
        return self.picture()

    def _repr_svg_(self) -> str | None:
        return self.picture()

    def __repr__(self) -> str:
        best = self.best
        return f"<Fit: kappa = {best.kappa:.6g}, mu = {best.mu:.6g}, {len(self.minima)} minima>"


def fit(
    data: Mapping[str, ArrayLike],
    bodies: Bodies | Mapping[str, Any] | str | os.PathLike[str] | None = None,
    *,
    speed_m_per_s: float | None = None,
    free: Iterable[str] = ("k_t", "mu"),
    ranges: Mapping[str, tuple[float, float]] | None = None,
    eps_n: float | None = None,
    level: float = 0.95,
    relative_errors: bool = False,
    law: Law | None = None,
    kappa: float = 1.0,
    mu: float = 1.0,
    alpha: float = 2 / 7,
    damping: float = 0.0,
    tangential_damping: float = 0.0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Fit:
    """Fits the stiffness and the friction of a contact law, or other numbers, to measured impacts.

    data: columns of equal length by name, in which NaN is a missing value; `stickslip fit --help`
    lists the names. bodies: as in `impact`; without them all impacts have the same unknown speed,
    and kappa, mu, alpha, damping and tangential_damping are what is not fitted. speed_m_per_s: that
    of all impacts, if the data do not have it. free: up to two of "k_t" (or "kappa"), "mu" and
    "tangential_damping"; and "damping", which needs data of eps_n. ranges: where each is looked for,
    the stiffness as kappa at normal incidence. eps_n: at normal incidence, decides the damping.
    level: of the intervals. relative_errors: use only the ratios of the errors, as without errors.
    law: the contact law; `Bodies` have their own. threads: 1 to 1024, or None for one for each core;
    results do not depend on it. progress: called now and then with the steps done and all that are
    known; True shows a bar on stderr.

    Raises ValueError for bad data and parameters, and ComputationError where an impact has no result.

    >>> angles = [5.0, 10.0, 20.0, 30.0, 45.0, 60.0]
    >>> e_t = [0.6069, 0.5735, 0.5669, 0.5848, 0.6571, 0.7735]
    >>> data = {"centre_impact_angle_deg": angles, "centre_e_t": e_t}
    >>> found = fit(data, free=["mu"], kappa=6.0)
    >>> found.data["schema"], len(found.intervals["mu"])
    ('stickslip.fit/1', 1)
    """
    pair = None
    if bodies is not None:
        if isinstance(bodies, Bodies) and law is not None:
            raise ValueError(f"law = {law!r} is given for Bodies; expected in Bodies(..., law=...)")
        pair = (bodies if isinstance(bodies, Bodies) else Bodies.read(bodies, law))._pair
    columns = [(name, _column(name, values)) for name, values in data.items()]
    chosen = (_laws.arguments(law, tangential_damping), float(alpha))
    scaled = (*chosen, (float(kappa), float(mu), float(damping)))
    limits = [(name, float(low), float(high)) for name, (low, high) in (ranges or {}).items()]
    question = (list(free), limits, eps_n, float(level), bool(relative_errors))
    speed = None if speed_m_per_s is None else float(speed_m_per_s)
    with reported(progress, "fit") as report:
        count = _threads(threads)
        native = _native.Fit.make(columns, pair, scaled, speed, question, count, report)
    return Fit(native)


def _column(name: str, values: ArrayLike) -> np.ndarray[Any, np.dtype[np.float64]]:
    column = numbers(name, values)
    if column.ndim != 1:
        raise ValueError(f"{name} has {column.ndim} dimensions; expected 1")
    return column


def _minimum(fields: dict[str, Any]) -> Minimum:
    squares = {one["quantity"]: one["value"] for one in fields["root_mean_squares"]}
    return Minimum(**fields | {"root_mean_squares": squares})


def _pieces(pieces: list[dict[str, Any]] | None) -> list[tuple[float, float]] | None:
    return None if pieces is None else [(piece["low"], piece["high"]) for piece in pieces]
