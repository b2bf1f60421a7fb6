"""Tables of the restitution, to be looked up."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native, _pictures
from stickslip._arrays import real
from stickslip._axes import svg
from stickslip._progress import Progress, reported
from stickslip._collisions import _threads
from stickslip._impacts import Bodies
from stickslip._laws import Law, arguments, damping_of


if TYPE_CHECKING:
    from matplotlib.axes import Axes


class _Table:
    """A table of the restitution over two axes."""

    def __init__(self, native: _native.RestitutionTable) -> None:
        self._native = native
        _, _, bound, (largest, largest_of_eps_n, points) = native.facts
        #: The bound of the errors.
        self.bound: float = bound
        #: The largest error of eps_t found when the table was compared with collisions.
        self.largest_error: float = largest
        #: The largest error of eps_n.
        self.largest_error_of_eps_n: float = largest_of_eps_n
        #: The number of collisions it was compared with.
        self.points: int = points
        #: The itineraries of the regions, by their numbers; empty without regions.
        self.itineraries: list[str] = native.itineraries

    def __reduce__(self) -> tuple[Any, ...]:
        return _read, (self._native.json(),)

    def c_header(self, prefix: str = "stickslip") -> str:
        """The table as a self-contained header for C99, whose names begin with prefix."""
        return self._native.c_header(prefix)

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the JSON that the program writes."""
        Path(file).write_text(self._native.json() + "\n", encoding="utf-8")

    def plot(self, ax: Axes | None = None, **colours: Any) -> Axes:
        """The picture of a table over its own axes."""
        raise NotImplementedError

    def _repr_svg_(self) -> str | None:
        return svg(self.plot)

    def _eps_t(self, x: ArrayLike, y: ArrayLike, threads: int | None) -> NDArray[np.float64]:
        flat_x, flat_y, shape = _points(x, y)
        return self._native.eps_t(flat_x, flat_y, _threads(threads)).reshape(shape)

    def _region(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.int64]:
        flat_x, flat_y, shape = _points(x, y)
        return self._native.region(flat_x, flat_y).reshape(shape)

    def _shown(self, window: str) -> str:
        slabs, strips, size = self._native.size
        return (
            f"<{type(self).__name__}: {window}, bound {self.bound}, {strips} pieces in {slabs} "
            f"intervals, {size} bytes>"
        )


class RestitutionTable(_Table):
    """The tangential restitution over an interval of kappa and one of psi, at one damping."""

    def __init__(self, native: _native.RestitutionTable) -> None:
        super().__init__(native)
        scaled = native.scaled
        if scaled is None:
            raise ValueError("the table is one over velocities; expected one over kappa and psi")
        kappa, psi, *_ = native.facts
        #: The ends of the scaled stiffness.
        self.kappa: tuple[float, float] = kappa
        #: The ends of the reduced impact ratio.
        self.psi: tuple[float, float] = psi
        #: The scaled damping.
        self.damping: float = scaled[0]
        #: The normal restitution, which is one number at one damping.
        self.eps_n: float = scaled[1]

    def eps_t(
        self, kappa: ArrayLike, psi: ArrayLike, *, threads: int | None = 1
    ) -> NDArray[np.float64]:
        """The tangential restitution; NaN outside the table. Arrays broadcast.

        threads: 1 to 1024, or None for one for each core.
        """
        return self._eps_t(kappa, psi, threads)

    def region(self, kappa: ArrayLike, psi: ArrayLike) -> NDArray[np.int64]:
        """The numbers of the regions; -1 where there is none. Arrays broadcast."""
        return self._region(kappa, psi)

    def plot(self, ax: Axes | None = None, **colours: Any) -> Axes:
        """Draws eps_t as colours with matplotlib, and the boundaries of regions, if there are any.

        ax: axes to draw in, or None for new ones. colours: properties of the map.
        """
        return _pictures.table(self, ("kappa", self.kappa), ("psi", self.psi), ax, colours)

    def __repr__(self) -> str:
        return self._shown(f"kappa {self.kappa}, psi {self.psi}, damping {self.damping}")


class VelocityTable(_Table):
    """The restitution of two bodies over intervals of the velocities of their surfaces."""

    def __init__(self, native: _native.RestitutionTable) -> None:
        super().__init__(native)
        if native.scaled is not None:
            raise ValueError("the table is one over kappa and psi; expected one over velocities")
        normal, tangential, *_ = native.facts
        #: The ends of the normal velocity in m/s.
        self.normal_m_per_s: tuple[float, float] = normal
        #: The ends of the tangential velocity in m/s.
        self.tangential_m_per_s: tuple[float, float] = tangential

    def eps_t(
        self,
        normal_m_per_s: ArrayLike,
        tangential_m_per_s: ArrayLike,
        *,
        threads: int | None = 1,
    ) -> NDArray[np.float64]:
        """The tangential restitution; NaN outside the table. Arrays broadcast.

        threads: 1 to 1024, or None for one for each core.
        """
        return self._eps_t(normal_m_per_s, tangential_m_per_s, threads)

    def eps_n(self, normal_m_per_s: ArrayLike) -> NDArray[np.float64]:
        """The normal restitution, in the shape of the velocities; NaN outside the table."""
        normal, _, shape = _points(normal_m_per_s, 1.0)
        return self._native.eps_n(normal).reshape(shape)

    def region(self, normal_m_per_s: ArrayLike, tangential_m_per_s: ArrayLike) -> NDArray[np.int64]:
        """The numbers of the regions; -1 where there is none. Arrays broadcast."""
        return self._region(normal_m_per_s, tangential_m_per_s)

    def plot(self, ax: Axes | None = None, **colours: Any) -> Axes:
        """Draws eps_t as colours with matplotlib, and the boundaries of regions, if there are any.

        ax: axes to draw in, or None for new ones. colours: properties of the map.
        """
        x = ("normal_m_per_s", self.normal_m_per_s)
        y = ("tangential_m_per_s", self.tangential_m_per_s)
        return _pictures.table(self, x, y, ax, colours)

    def __repr__(self) -> str:
        normal, tangential = self.normal_m_per_s, self.tangential_m_per_s
        return self._shown(f"normal_m_per_s {normal}, tangential_m_per_s {tangential}")


def table(
    kappa: tuple[float, float],
    psi: tuple[float, float],
    damping: float = 0.0,
    *,
    e_n: float | None = None,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    bound: float = 1e-8,
    regions: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> RestitutionTable:
    """Makes a table of eps_t whose error is below a bound everywhere.

    kappa, psi: intervals, above 0. damping, e_n, law, tangential_damping: as in `collide`. bound:
    1e-12 to 1e-3, and with another law than the paper's from 1e-9. regions: whether the table has
    the regions of the atlas too. threads: 1 to 1024, or None for one for each core; results do not
    depend on it. progress: called now and then with the steps done and all that are known; True shows a bar on
    stderr.

    Raises ValueError for parameters out of range, and ComputationError where the bound is not
    reached.

    >>> made = table((1, 2), (0.5, 1.5), bound=1e-6)
    >>> bool(abs(made.eps_t(1.5, 1.2) - eps_t(1.5, 1.2)) < 1e-6)
    True
    """
    collisions = float(damping_of(damping, e_n, law)), arguments(law, tangential_damping)
    window = _interval(kappa), _interval(psi), collisions
    with reported(progress, "table") as report:
        native = _native.RestitutionTable.make(
            *window, float(bound), bool(regions), _threads(threads), report
        )
    return RestitutionTable(native)


def table_of_velocities(
    bodies: Bodies | Mapping[str, Any] | str | os.PathLike[str],
    normal_m_per_s: tuple[float, float],
    tangential_m_per_s: tuple[float, float],
    *,
    bound: float = 1e-8,
    regions: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> VelocityTable:
    """Makes a table of eps_t and eps_n of two bodies whose errors are below a bound everywhere.

    bodies: as in `impact`, with their contact law. normal_m_per_s, tangential_m_per_s:
    intervals of the velocities of the surfaces at the contact, above 0. The other arguments are
    those of `table`.

    Raises ValueError for parameters out of range, and ComputationError where the bound is not
    reached.

    >>> from stickslip import Bodies, Material, Sphere, Surface
    >>> bead = Sphere(0.0015, Material(63e9, 0.24, 2500))
    >>> beads = Bodies(bead, bead, Surface(0.3, 5e6, 1e-7))
    >>> made = table_of_velocities(beads, (1, 2), (0.5, 2), bound=1e-5)
    >>> one = impact(beads, 1.5, 1.0)
    >>> bool(abs(made.eps_t(1.5, 1.0) - one.eps_t) < 1e-5)
    True
    >>> bool(abs(made.eps_n(1.5) - one.eps_n) < 1e-5)
    True
    """
    window = _interval(normal_m_per_s), _interval(tangential_m_per_s)
    pair = (bodies if isinstance(bodies, Bodies) else Bodies.read(bodies))._pair
    with reported(progress, "table_of_velocities") as report:
        native = _native.RestitutionTable.make_of_velocities(
            pair, *window, float(bound), bool(regions), _threads(threads), report
        )
    return VelocityTable(native)


def load_table(file: str | os.PathLike[str]) -> RestitutionTable | VelocityTable:
    """The table in a file that `stickslip table` or `save` has written.

    Raises ValueError if the file holds no table, or one that contradicts itself.
    """
    return _read(Path(file).read_text(encoding="utf-8"))


def _read(text: str) -> RestitutionTable | VelocityTable:
    native = _native.RestitutionTable.read(text)
    return VelocityTable(native) if native.scaled is None else RestitutionTable(native)


def _interval(ends: tuple[float, float]) -> tuple[float, float]:
    low, high = ends
    return float(low), float(high)


def _points(
    x: ArrayLike, y: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], tuple[int, ...]]:
    """The points as flat arrays of equal length, and their shape."""
    given = np.broadcast_arrays(real("x", x), real("y", y))
    flat_x, flat_y = (np.require(one, requirements=("C", "A")).reshape(-1) for one in given)
    return flat_x, flat_y, given[0].shape
