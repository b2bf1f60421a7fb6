"""Maps: collisions on a grid, as an xarray Dataset."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip import _laws
from stickslip._laws import Law
from stickslip._libraries import library
from stickslip._progress import Progress
from stickslip._collisions import (
    Floats,
    Method,
    OnError,
    eps_t_and_switch_count,
    psi_of_ratio,
)

if TYPE_CHECKING:
    from xarray import Dataset

#: What the variables and coordinates of maps and sweeps mean.
ATTRIBUTES: dict[str, dict[str, Any]] = {
    "kappa": {"long_name": "scaled stiffness", "units": "1"},
    "psi": {"long_name": "reduced impact ratio", "units": "1"},
    "ratio": {"long_name": "impact ratio g_t/g_n", "units": "1"},
    "damping": {"long_name": "scaled damping", "units": "1"},
    "eps_t": {"long_name": "coefficient of tangential restitution", "units": "1"},
    "eps_n": {"long_name": "coefficient of normal restitution", "units": "1"},
    "contact_time": {"long_name": "scaled contact time", "units": "1"},
    "switch_count": {
        "long_name": "number of switches",
        "units": "1",
        "comment": "-1 where there is no collision",
    },
}


def centres(interval: tuple[float, float], cells: int) -> Floats:
    """The centres of equal cells, where maps have their collisions; shape (cells,)."""
    low, high = interval
    cells = operator.index(cells)
    if not (0 <= low < high < np.inf):
        raise ValueError(f"interval {interval}; expected 0 <= LO < HI, both finite")
    if cells < 1:
        raise ValueError(f"cells = {cells}; expected at least 1")
    return low + (high - low) * ((np.arange(cells) + 0.5) / cells)


def map(
    kappa: tuple[float, float],
    psi: tuple[float, float] | None = None,
    size: tuple[int, int] = (400, 400),
    damping: float = 0.0,
    *,
    ratio: tuple[float, float] | None = None,
    mu: float = 0.4,
    alpha: float = 2 / 7,
    method: Method = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    errors: OnError = "nan",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Dataset:
    """eps_t and switch_count on a grid, at the points where `stickslip map` has them.

    kappa, psi: intervals, 0 or above; collisions are at the centres of `size` = (columns, rows)
    cells. ratio: interval of g_t/g_n instead of psi. The result has the dimensions (psi, kappa), or
    (ratio, kappa) with psi as a further coordinate. The other arguments are those of `eps_t`; a law is
    an attribute of the result.
    """
    library("xarray", "for map")
    import xarray as xr

    if (psi is None) == (ratio is None):
        raise ValueError("expected exactly one of psi and ratio")
    if not 0 <= damping < np.inf:
        raise ValueError(f"damping = {damping!r}; expected 0 or above, finite")
    mu, alpha = float(mu), float(alpha)
    columns, rows = size
    across = centres(kappa, columns)
    coordinates: dict[str, Any] = {"kappa": ("kappa", across, ATTRIBUTES["kappa"])}
    if ratio is None:
        assert psi is not None
        row, up = "psi", centres(psi, rows)
        coordinates["psi"] = ("psi", up, ATTRIBUTES["psi"])
    else:
        row, ratios = "ratio", centres(ratio, rows)
        up = psi_of_ratio(ratios, mu, alpha)
        coordinates["ratio"] = ("ratio", ratios, ATTRIBUTES["ratio"])
        coordinates["psi"] = ("ratio", up, ATTRIBUTES["psi"])
    coordinates["damping"] = ((), float(damping), ATTRIBUTES["damping"])
    found, counts = eps_t_and_switch_count(
        across[None, :], up[:, None], damping, method,
        rtol=rtol, atol=atol, law=law, tangential_damping=tangential_damping,
        errors=errors, threads=threads, progress=progress,
    )  # fmt: skip
    dimensions = (row, "kappa")
    return xr.Dataset(
        {
            "eps_t": (dimensions, found, ATTRIBUTES["eps_t"]),
            "switch_count": (dimensions, counts, ATTRIBUTES["switch_count"]),
        },
        coordinates,
        _laws.attributes(law, tangential_damping),
    )
