"""Tables of the restitution, to be looked up."""

import os
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip.collisions import _broadcast, _threads


class RestitutionTable:
    """The tangential restitution over an interval of kappa and one of psi, at one damping."""

    def __init__(self, native: _native.RestitutionTable) -> None:
        self._native = native
        kappa, psi, damping, bound, eps_n, (largest, points) = native.facts
        #: The ends of the scaled stiffness.
        self.kappa: tuple[float, float] = kappa
        #: The ends of the reduced impact ratio.
        self.psi: tuple[float, float] = psi
        #: The scaled damping.
        self.damping: float = damping
        #: The bound of the error of eps_t.
        self.bound: float = bound
        #: The normal restitution, which is one number at one damping.
        self.eps_n: float = eps_n
        #: The largest error found when the table was compared with collisions.
        self.largest_error: float = largest
        #: The number of collisions it was compared with.
        self.points: int = points
        #: The itineraries of the regions, by their numbers; empty without regions.
        self.itineraries: list[str] = native.itineraries

    def eps_t(
        self, kappa: ArrayLike, psi: ArrayLike, *, threads: int | None = 1
    ) -> NDArray[np.float64]:
        """The tangential restitution; NaN outside the table. Arrays broadcast.

        threads: 1 to 1024, or None for one for each core.
        """
        flat_kappa, flat_psi, shape = _points(kappa, psi)
        return self._native.eps_t(flat_kappa, flat_psi, _threads(threads)).reshape(shape)

    def region(self, kappa: ArrayLike, psi: ArrayLike) -> NDArray[np.int64]:
        """The numbers of the regions; -1 where there is none. Arrays broadcast."""
        flat_kappa, flat_psi, shape = _points(kappa, psi)
        return self._native.region(flat_kappa, flat_psi).reshape(shape)

    def c_header(self, prefix: str = "stickslip") -> str:
        """The table as a self-contained header for C99, whose names begin with prefix."""
        return self._native.c_header(prefix)

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the JSON that the program writes."""
        Path(file).write_text(self._native.json() + "\n", encoding="utf-8")

    def __repr__(self) -> str:
        slabs, strips, size = self._native.size
        return (
            f"<RestitutionTable: kappa {self.kappa}, psi {self.psi}, damping {self.damping}, "
            f"bound {self.bound}, {strips} pieces in {slabs} intervals, {size} bytes>"
        )


def table(
    kappa: tuple[float, float],
    psi: tuple[float, float],
    damping: float = 0.0,
    *,
    bound: float = 1e-8,
    regions: bool = False,
    threads: int | None = None,
) -> RestitutionTable:
    """Makes a table of eps_t whose error is below a bound everywhere.

    kappa, psi: intervals, above 0. bound: 1e-12 to 1e-3. regions: whether the table has the regions
    of the atlas too. threads: 1 to 1024, or None for one for each core; results do not depend on
    it. The contact law is the paper's.

    Raises ValueError for parameters out of range, and ComputationError where the bound is not
    reached.

    >>> made = table((1, 2), (0.5, 1.5), bound=1e-6)
    >>> bool(abs(made.eps_t(1.5, 1.2) - eps_t(1.5, 1.2)) < 1e-6)
    True
    """
    interval = (float(kappa[0]), float(kappa[1])), (float(psi[0]), float(psi[1]))
    return RestitutionTable(
        _native.RestitutionTable.make(
            *interval, float(damping), float(bound), bool(regions), _threads(threads)
        )
    )


def load_table(file: str | os.PathLike[str]) -> RestitutionTable:
    """The table in a file that `stickslip table` or `RestitutionTable.save` has written.

    Raises ValueError if the file holds no table, or one that contradicts itself.
    """
    return RestitutionTable(_native.RestitutionTable.read(Path(file).read_text(encoding="utf-8")))


def _points(
    kappa: ArrayLike, psi: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], tuple[int, ...]]:
    """The points as flat arrays of equal length, and their shape."""
    _, (flat_kappa, flat_psi, _), shape = _broadcast(kappa, psi, 0.0)
    size = (int(np.prod(shape)),)
    kappa, psi = (np.ascontiguousarray(np.broadcast_to(one, size)) for one in (flat_kappa, flat_psi))
    return kappa, psi, shape
