"""Collisions in scaled parameters: one, or arrays of them."""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _laws, _native, _pictures
from stickslip._arrays import numbers, real
from stickslip._axes import Panels, svg
from stickslip._laws import Law
from stickslip._libraries import library
from stickslip._progress import Progress, keeping, reported
from stickslip._shown import Shown
from stickslip._tabular import Columns, Tabular, write_parquet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import Dataset

Floats: TypeAlias = NDArray[np.float64]
Method: TypeAlias = Literal["auto", "exact", "dop853", "dopri5"]
OnError: TypeAlias = Literal["raise", "nan"]

#: A switch: scaled time since the start and until the end of contact, the regime that begins, the
#: side of slip (1 or -1), the reduced spring y and velocity w.
SWITCH = np.dtype(
    [
        ("time", "f8"),
        ("time_left", "f8"),
        ("to", "U5"),
        ("side", "i1"),
        ("spring", "f8"),
        ("velocity", "f8"),
    ]
)

#: The greatest number of intervals of a phase.
MOST_MOMENTS = 10**6

#: A moment of a collision, in scaled variables: time t, compression x and its rate, normal force,
#: reduced spring y, tangential force F_t/mu, reduced tangential velocity w, and Coulomb's limit of
#: F_t/mu.
MOMENT = np.dtype(
    [
        ("time", "f8"),
        ("compression", "f8"),
        ("normal_velocity", "f8"),
        ("normal_force", "f8"),
        ("spring", "f8"),
        ("tangential_force", "f8"),
        ("velocity", "f8"),
        ("limit", "f8"),
    ]
)

#: A quantity and its derivatives with respect to kappa, psi and damping.
DERIVED = np.dtype([("value", "f8"), ("kappa", "f8"), ("psi", "f8"), ("damping", "f8")])


class Estimate(NamedTuple):
    """How good a collision is."""

    #: The error of eps_t to expect: 999 of 1000 errors are below it.
    eps_t_error: float
    #: Part of psi by which w would have to differ, at any moment, for another itinerary.
    distance: float
    #: Whether the itinerary is certain.
    certain: bool


@dataclass(frozen=True, repr=False)
class Sensitivity(Shown):
    """Derivatives through every switch, of dtype `DERIVED`."""

    eps_n: NDArray[np.void]
    eps_t: NDArray[np.void]
    w_final: NDArray[np.void]
    contact_time: NDArray[np.void]
    #: One for each switch.
    switch_times: NDArray[np.void]


class Collision(Tabular):
    """One collision, from `collide`. All quantities are scaled, without unit."""

    def __init__(
        self,
        kappa: float,
        psi: float,
        damping: float = 0.0,
        method: Method = "auto",
        rtol: float | None = None,
        atol: float | None = None,
        law: Law | None = None,
        tangential_damping: float = 0.0,
    ) -> None:
        chosen = _laws.arguments(law, tangential_damping)
        self._arguments = (kappa, psi, damping, method, rtol, atol, *chosen)
        self._native = _native.Collision(kappa, psi, damping, (method, rtol, atol), chosen)
        #: Scaled stiffness of the tangential spring.
        self.kappa = kappa
        #: Reduced impact ratio (g_t/g_n) alpha/mu.
        self.psi = psi
        #: Scaled damping of the normal force.
        self.damping = damping

    @cached_property
    def _fields(self) -> dict[str, Any]:
        return self.to_dict()

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), self._arguments)

    @property
    def method(self) -> str:
        """What computed the collision: exact, dop853 or dopri5."""
        return str(self._fields["method"]["name"])

    @property
    def adheres(self) -> bool:
        """Whether the bodies stay together for ever, held by adhesion.

        Then eps_t and eps_n are NaN, and all else is up to where that is certain.
        """
        return bool(self._fields.get("adheres", False))

    @property
    def eps_t(self) -> float:
        """Coefficient of tangential restitution; NaN if the bodies stay together."""
        return float("nan") if self.adheres else float(self._fields["eps_t"])

    @property
    def eps_n(self) -> float:
        """Coefficient of normal restitution; NaN if the bodies stay together."""
        return float("nan") if self.adheres else float(self._fields["eps_n"])

    @property
    def w_final(self) -> float:
        """Reduced tangential velocity at the end; eps_t is w_final/psi."""
        return float(self._fields["w_final"])

    @property
    def contact_time(self) -> float:
        """Scaled duration of the contact."""
        return float(self._fields["contact_time"])

    @property
    def itinerary(self) -> str:
        """One character a phase: + and - slip, o stick. `+o-o+` has four switches."""
        return str(self._fields["itinerary"])

    @property
    def start_margin(self) -> float | None:
        """1 - the ratio of tangential force and limit at the start, above 0 for stick.

        None where one of the two grows faster, and with the paper's law. With a history of force and
        without damping, a particle code needs some 1/abs(start_margin) steps in contact to tell how
        it starts.
        """
        margin = self._fields.get("start_margin")
        return None if margin is None else float(margin)

    @property
    def start_layer(self) -> float | None:
        """How badly the start is conditioned: a number of first overlaps; None if it is not."""
        layer = self._fields.get("start_layer")
        return None if layer is None else float(layer)

    @property
    def switch_count(self) -> int:
        """Number of switches between slip and stick."""
        return len(self._fields["switches"])

    @property
    def reversals(self) -> int:
        """Number of sign changes of the tangential velocity."""
        return int(self._fields["reversals"])

    @cached_property
    def switches(self) -> NDArray[np.void]:
        """The switches, an array of dtype `SWITCH` with shape (switch_count,)."""
        names = SWITCH.names or ()
        rows = [tuple(switch[name] for name in names) for switch in self._fields["switches"]]
        return np.array(rows, dtype=SWITCH)

    @property
    def energy(self) -> dict[str, float]:
        """Where the energy went, as the program prints it."""
        return dict(self._fields["energy"])

    @property
    def statistics(self) -> dict[str, int]:
        """The work of the integrator; empty for the exact solution."""
        return dict(self._fields["statistics"])

    def estimate(self) -> Estimate:
        """The error to expect of eps_t, and how far the itinerary is from changing."""
        return Estimate(*self._native.estimate())

    def history(self, times: ArrayLike | None = None, moments: int = 50) -> NDArray[np.void]:
        """The course of the collision, an array of dtype `MOMENT`.

        times: scaled times of any shape, which is that of the result; outside the contact a moment
        is NaN. Without times, each phase has `moments` intervals of equal length.
        """
        if not 1 <= moments <= MOST_MOMENTS:
            raise ValueError(f"moments = {moments!r}; expected 1 to {MOST_MOMENTS}")
        if times is None:
            rows = self._native.history(None, moments)
            return rows.view(MOMENT).reshape(-1)
        asked = numbers("times", times)
        rows = self._native.history(asked.reshape(-1), moments)
        return rows.view(MOMENT).reshape(asked.shape)

    def sensitivity(self) -> Sensitivity:
        """Derivatives of the results with respect to kappa, psi and damping, by integration."""
        rows = np.array([tuple(row) for row in self._native.sensitivity()], dtype=DERIVED)
        return Sensitivity(rows[0], rows[1], rows[2], rows[3], rows[4:])

    _dimension = "time"

    def _columns(self) -> Columns:
        course = self.history()
        switches = self.switches["time"]
        # Both ends of a phase are rows.
        phases = np.repeat(list(self.itinerary), course.size // (switches.size + 1))
        return {name: course[name] for name in course.dtype.names or ()} | {"phase": phases}

    def to_dict(self) -> dict[str, Any]:
        """The JSON object that `stickslip collide --format json` prints."""
        copy: dict[str, Any] = json.loads(self._native.json())
        return copy

    def plot(self, ax: Panels = None, **line: Any) -> list[Axes]:
        """Draws forces and velocities in time with matplotlib, and shades the phases.

        ax: two axes, or one for both; without it, new ones. line: properties of the lines. The
        result is the axes of the forces and of the velocities.

        >>> forces, velocities = collide(63, 0.5).plot()
        >>> forces.get_ylabel(), velocities.get_xlabel()
        ('scaled force', 'scaled time $t$')
        """
        return _pictures.collision(self, ax, line)

    def picture(self) -> str:
        """Forces and velocity against time, as an SVG document."""
        return self._native.picture()

    def animate(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture as it comes into being: a GIF, or an MP4 by ffmpeg.

        Raises ValueError for another name, and OSError if the file cannot be written or there is
        no ffmpeg.
        """
        self._native.animate(path)

    def _repr_html_(self) -> str:
        return self.picture()

    def _repr_svg_(self) -> str:
        return self.picture()

    def __repr__(self) -> str:
        return (
            f"Collision(kappa={self.kappa!r}, psi={self.psi!r}, damping={self.damping!r}): "
            f"{self.itinerary}, eps_t = {self.eps_t!r}"
        )


class Collisions(Tabular):
    """Arrays of collisions, from `collide_many`. All arrays have the broadcast `shape`."""

    def __init__(
        self,
        parameters: tuple[Floats, Floats, Floats],
        engine: tuple[Method, float | None, float | None, str, float],
        columns: dict[str, Any],
        shape: tuple[int, ...],
    ) -> None:
        self._engine = engine
        self._found = columns
        self.shape = shape
        #: Scaled stiffness, impact ratio and damping.
        self.kappa, self.psi, self.damping = (np.broadcast_to(one, shape) for one in parameters)
        #: Coefficients of tangential and normal restitution.
        self.eps_t: Floats = columns["eps_t"].reshape(shape)
        self.eps_n: Floats = columns["eps_n"].reshape(shape)
        #: Reduced tangential velocity at the end.
        self.w_final: Floats = columns["w_final"].reshape(shape)
        #: Scaled duration of the contact.
        self.contact_time: Floats = columns["contact_time"].reshape(shape)
        #: Number of sign changes of the tangential velocity; -1 where there is no collision.
        self.reversals: NDArray[np.int64] = columns["reversals"].reshape(shape)
        #: The itinerary of each collision as an index of `itineraries`; -1 where there is none.
        self.itinerary_codes: NDArray[np.int32] = columns["itinerary"].reshape(shape)
        #: The itineraries that occur, in the order in which they do.
        self.itineraries: tuple[str, ...] = tuple(columns["itineraries"])
        #: The switches of collision i, counted in C order, are `switches[offsets[i]:offsets[i +
        #: 1]]`.
        self.offsets: NDArray[np.int64] = columns["offsets"]
        #: Why collisions have no result, by their index in C order.
        self.failures: dict[int, str] = dict(columns["failures"])

    @property
    def size(self) -> int:
        """Number of collisions."""
        return self.eps_t.size

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single collision has no length")
        return self.shape[0]

    @property
    def switch_count(self) -> NDArray[np.int64]:
        """Number of switches of each; -1 where there is no collision."""
        counts = np.diff(self.offsets).reshape(self.shape)
        return np.where(self.itinerary_codes < 0, -1, counts)

    @property
    def itinerary(self) -> NDArray[np.str_]:
        """The itinerary of each; empty where there is no collision."""
        names = np.array([*self.itineraries, ""])
        return names[self.itinerary_codes]

    @cached_property
    def switches(self) -> NDArray[np.void]:
        """All switches one after another, an array of dtype `SWITCH`."""
        switches = np.empty(self._found["time"].size, dtype=SWITCH)
        for name in ("time", "time_left", "side", "spring", "velocity"):
            switches[name] = self._found[name]
        switches["to"] = np.where(self._found["stick"], "stick", "slip")
        return switches

    def __getitem__(self, index: int | tuple[int, ...]) -> Collision:
        """One of the collisions, computed again by the same method."""
        place = index if isinstance(index, tuple) else (index,)
        place = tuple(operator.index(one) for one in place)
        if len(place) != len(self.shape):
            raise IndexError(f"{len(place)} indices; expected {len(self.shape)}")
        kappa, psi, damping = (float(one[place]) for one in (self.kappa, self.psi, self.damping))
        return Collision(kappa, psi, damping, *self._engine)

    def __iter__(self) -> Iterator[Collision]:
        """The collisions in C order, computed again."""
        return (self[place] for place in np.ndindex(self.shape))

    def to_arrow(self) -> Any:
        """A `pyarrow.Table` with a row for each collision in C order.

        Itineraries are a dictionary array, the switches of a row a list of structs.
        """
        pa = library("pyarrow", "for to_arrow")
        present = self.itinerary_codes.reshape(-1) >= 0
        codes = pa.array(self.itinerary_codes.reshape(-1), mask=~present)
        fields = [
            (name, pa.array(self._found[name]))
            for name in ("time", "time_left", "stick", "side", "spring", "velocity")
        ]
        switches = pa.StructArray.from_arrays(
            [array for _, array in fields], names=[name for name, _ in fields]
        )
        columns = {
            name: np.ascontiguousarray(getattr(self, name)).reshape(-1) for name in _NUMBERS
        }
        return pa.table(
            {name: pa.array(column) for name, column in columns.items()}
            | {
                "reversals": pa.array(self.reversals.reshape(-1), mask=~present),
                "itinerary": pa.DictionaryArray.from_arrays(codes, list(self.itineraries)),
                "switches": pa.LargeListArray.from_arrays(pa.array(self.offsets), switches),
            }
        )

    def _columns(self) -> Columns:
        names = (*_NUMBERS, "reversals", "switch_count", "itinerary")
        return {name: np.ravel(getattr(self, name)) for name in names}

    def to_xarray(self) -> Dataset:
        """A `xarray.Dataset` with the shape of the collisions, without their switches.

        An axis along which only one parameter varies has its name; others are dim_0, dim_1 and so
        on.

        Raises ImportError if xarray is not installed.

        >>> found = collide_many([18.0, 63.0], [[0.5], [1.0]]).to_xarray()
        >>> dict(found.sizes), int(found.switch_count.sel(kappa=63, psi=0.5))
        ({'psi': 2, 'kappa': 2}, 6)
        """
        from stickslip._maps import ATTRIBUTES

        xr = library("xarray", "for to_xarray")
        given = {name: getattr(self, name) for name in ("kappa", "psi", "damping")}
        dims = _dimensions(given, self.shape)
        coordinates = {}
        for name, values in given.items():
            own = tuple(
                dim for axis, dim in enumerate(dims) if dim == name or _varies(values, axis)
            )
            index = tuple(slice(None) if dim in own else 0 for dim in dims)
            coordinates[name] = (own, values[index], ATTRIBUTES[name])
        names = [name for name in self._columns() if name not in given]
        variables = {
            name: (dims, np.reshape(getattr(self, name), self.shape), ATTRIBUTES.get(name, {}))
            for name in names
        }
        found: Dataset = xr.Dataset(variables, coordinates)
        return found

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes the rows of `to_arrow`, with all switches, to a Parquet file, complete or not at
        all.

        Raises ImportError if pyarrow is not installed.
        """
        write_parquet(self.to_arrow(), path)

    def plot(self, ax: Axes | None = None, **points: Any) -> Axes:
        """Draws eps_t with matplotlib over the parameter that varies, or as colours over two.

        ax: axes to draw in, or None for new ones. points: properties of points, or of the map of a
        grid. Over one parameter, the colours of points are the numbers of switches.

        Raises ValueError if all three parameters vary.
        """
        return _pictures.collisions(self, ax, points)

    def _repr_svg_(self) -> str | None:
        given = (self.kappa, self.psi, self.damping)
        unfit = self.size < 2 or all(np.ptp(one) > 0 for one in given)
        return None if unfit else svg(self.plot)

    def __repr__(self) -> str:
        return f"Collisions(shape={self.shape}, failures={len(self.failures)})"


#: Numbers of each collision.
_NUMBERS = ("kappa", "psi", "damping", "eps_n", "eps_t", "w_final", "contact_time")


def _varies(values: NDArray[Any], axis: int) -> bool:
    """Whether values change along an axis, or there are none."""
    return not values.shape[axis] or bool((values != values.take([0], axis)).any())


def _dimensions(given: dict[str, NDArray[Any]], shape: tuple[int, ...]) -> tuple[str, ...]:
    """The names of the axes: of the parameter that varies along this axis only, alone."""
    along = {
        name: [axis for axis in range(len(shape)) if _varies(values, axis)]
        for name, values in given.items()
    }
    dims = []
    for axis in range(len(shape)):
        names = [name for name, axes in along.items() if axis in axes]
        alone = len(names) == 1 and along[names[0]] == [axis]
        dims.append(names[0] if alone else f"dim_{axis}")
    return tuple(dims)


def psi_of_ratio(ratio: ArrayLike, mu: ArrayLike = 0.4, alpha: ArrayLike = 2 / 7) -> Any:
    """The reduced impact ratio psi = (g_t/g_n) alpha/mu.

    ratio: impact ratio g_t/g_n; mu: coefficient of friction; alpha: tangential inertia, 2/7 for
    homogeneous spheres. All without unit; they broadcast.

    >>> round(float(psi_of_ratio(0.7)), 12)
    0.5
    """
    return real("ratio", ratio) * real("alpha", alpha) / real("mu", mu)


def collide(
    kappa: float,
    psi: float | None = None,
    damping: float = 0.0,
    method: Method = "auto",
    *,
    ratio: float | None = None,
    mu: float | None = None,
    alpha: float | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    e_n: float | None = None,
) -> Collision:
    """One collision, with every switch.

    kappa: scaled stiffness, 0 or above. psi: reduced impact ratio, above 0; or ratio: g_t/g_n, with
    the friction mu, 0 or above, 0.4 without it, and the tangential inertia alpha, 2/7 without it, as
    for homogeneous spheres. damping: scaled damping, 0 or above; or e_n: the coefficient of normal
    restitution that it makes, above 0, at most 1. method: "exact", "dop853", "dopri5", or "auto",
    which is exact unless a tolerance is given. rtol, atol: tolerances of a step of the
    integrators. law: the contact law, a name of `laws` or its terms; the paper's if there is none.
    tangential_damping: (gamma_t/gamma_n)/alpha of a law, 0 or above.

    Raises ValueError for parameters out of range, and ComputationError where there is no result.

    >>> collision = collide(63, 0.5)
    >>> collision.itinerary, round(collision.eps_t, 10)
    ('+o-o+o-', -0.0416522075)
    >>> collision.switches["time"].shape
    (6,)
    >>> collide(63, ratio=0.7).itinerary
    '+o-o+o-'
    >>> round(collide(63, 0.5, e_n=0.8).eps_n, 12)
    0.8
    """
    damping = _laws.damping_of(damping, e_n, law)
    psi, law, tangential_damping = _rubbing(psi, ratio, mu, alpha, (law, tangential_damping))
    for name, value in (("kappa", kappa), ("psi", psi), ("damping", damping)):
        if np.ndim(value):
            raise TypeError(f"{name} is an array; expected a number, or use collide_many")
    return Collision(
        float(kappa), float(psi), float(damping), method, rtol, atol, law, tangential_damping
    )


def _broadcast(
    kappa: ArrayLike, psi: ArrayLike, damping: ArrayLike
) -> tuple[tuple[Floats, Floats, Floats], tuple[Floats, Floats, Floats], tuple[int, ...]]:
    """The parameters as given, as flat arrays (of one value, if they have only one), and the shape."""
    given = (numbers("kappa", kappa), numbers("psi", psi), numbers("damping", damping))
    shape = np.broadcast_shapes(*(one.shape for one in given))
    flat = tuple(
        one.reshape(-1) if one.size == 1 else np.broadcast_to(one, shape).reshape(-1)
        for one in given
    )
    # Without a single case, none of the three may pass for one.
    if 0 in shape:
        flat = tuple(np.empty(0) for _ in flat)
    return given, flat, shape  # type: ignore[return-value]


def _psi(
    psi: ArrayLike | None,
    ratio: ArrayLike | None,
    mu: ArrayLike | None,
    alpha: ArrayLike | None,
) -> Any:
    """psi as it is given, or from the impact ratio."""
    if (psi is None) == (ratio is None):
        given = "neither psi nor ratio is" if psi is None else "psi and ratio are both"
        raise ValueError(f"{given} given; expected exactly one of them")
    if ratio is None:
        for name, value in (("mu", mu), ("alpha", alpha)):
            if value is not None:
                raise ValueError(f"{name} = {value!r} has no effect with psi; expected with ratio")
        return psi
    return psi_of_ratio(ratio, 0.4 if mu is None else mu, 2 / 7 if alpha is None else alpha)


def _rubbing(
    psi: ArrayLike | None,
    ratio: ArrayLike | None,
    mu: ArrayLike | None,
    alpha: ArrayLike | None,
    law: tuple[Law | None, float],
) -> tuple[Any, Law | None, float]:
    """psi, and the law with its tangential damping: one without tangential force if mu is 0."""
    friction = real("mu", 0.4 if mu is None else mu)
    smooth = np.ravel(friction) == 0
    if ratio is None or not smooth.any():
        return _psi(psi, ratio, mu, alpha), *law
    if not smooth.all():
        raise ValueError("mu has values of 0 and others; expected a call of its own for mu = 0")
    return _psi(psi, ratio, np.ones_like(friction), alpha), _laws.without_friction(law[0]), 0.0


def _strict(errors: OnError) -> bool:
    if errors not in ("raise", "nan"):
        raise ValueError(f'errors = {errors!r}; expected "raise" or "nan"')
    return errors == "raise"


def _threads(threads: int | None) -> int:
    if threads is None:
        return _threads_of_environment()
    if not 1 <= operator.index(threads) <= 1024:
        raise ValueError(f"threads = {threads}; expected 1 to 1024, or None for one for each core")
    return threads


def _threads_of_environment() -> int:
    """The number of threads that RAYON_NUM_THREADS says, or 0, one for each core."""
    text = os.environ.get("RAYON_NUM_THREADS", "")
    if not text:
        return 0
    if not (text.isascii() and text.isdigit() and 1 <= int(text) <= 1024):
        expected = "expected a whole number from 1 to 1024"
        raise ValueError(f"RAYON_NUM_THREADS = {text!r}; {expected}")
    return int(text)


def eps_t(
    kappa: ArrayLike,
    psi: ArrayLike | None = None,
    damping: ArrayLike = 0.0,
    method: Method = "auto",
    *,
    ratio: ArrayLike | None = None,
    mu: ArrayLike | None = None,
    alpha: ArrayLike | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    errors: OnError = "raise",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Any:
    """Coefficients of tangential restitution; a number if all parameters are numbers.

    The parameters are those of `collide` and broadcast. errors: "raise", or "nan" for a NaN where a
    collision has no result. threads: 1 to 1024, or None for one for each core; results do not
    depend on it. progress: called now and then with the number of collisions that are done and of
    all; True shows a bar on stderr.

    >>> eps_t([18.0, 63.0], 0.5)
    array([-0.08488447, -0.04165221])
    """
    return eps_t_and_switch_count(
        kappa,
        psi,
        damping,
        method,
        ratio=ratio,
        mu=mu,
        alpha=alpha,
        rtol=rtol,
        atol=atol,
        law=law,
        tangential_damping=tangential_damping,
        errors=errors,
        threads=threads,
        progress=progress,
    )[0][()]


def eps_t_and_switch_count(
    kappa: ArrayLike,
    psi: ArrayLike | None = None,
    damping: ArrayLike = 0.0,
    method: Method = "auto",
    *,
    ratio: ArrayLike | None = None,
    mu: ArrayLike | None = None,
    alpha: ArrayLike | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    errors: OnError = "raise",
    threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[Floats, NDArray[np.int32]]:
    """Coefficients of tangential restitution and numbers of switches, as arrays.

    As `eps_t`; where a collision has no result, the number of switches is -1.
    """
    psi, law, tangential_damping = _rubbing(psi, ratio, mu, alpha, (law, tangential_damping))
    _, flat, shape = _broadcast(kappa, psi, damping)
    engine, chosen = (method, rtol, atol), _laws.arguments(law, tangential_damping)
    job = (flat, engine, chosen, _strict(errors), _threads(threads))
    with keeping(lambda left: left[:2]), reported(progress, "eps_t") as report:
        found, counts, _ = _native.eps_t(*job, report)
    return found.reshape(shape), counts.reshape(shape)


def collide_many(
    kappa: ArrayLike,
    psi: ArrayLike | None = None,
    damping: ArrayLike = 0.0,
    method: Method = "auto",
    *,
    ratio: ArrayLike | None = None,
    mu: ArrayLike | None = None,
    alpha: ArrayLike | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    errors: OnError = "raise",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Collisions:
    """Collisions of arrays of parameters, with every switch of each.

    As `eps_t`; with errors = "nan", `failures` says why collisions have no result. Ctrl-C keeps
    those that are done, in C order, as `partial` of the KeyboardInterrupt; of `eps_t` and
    `eps_t_and_switch_count` these are both arrays of the latter.

    >>> many = collide_many([18.0, 63.0], 0.5)
    >>> many.itinerary.tolist(), many.switch_count.tolist()
    (['+o+o-', '+o-o+o-'], [4, 6])
    >>> many.switches[many.offsets[1] : many.offsets[2]]["to"].tolist()
    ['stick', 'slip', 'stick', 'slip', 'stick', 'slip']
    """
    psi, law, tangential_damping = _rubbing(psi, ratio, mu, alpha, (law, tangential_damping))
    given, flat, shape = _broadcast(kappa, psi, damping)
    engine, chosen = (method, rtol, atol), _laws.arguments(law, tangential_damping)
    def first(left: dict[str, Any]) -> Collisions:
        shape = left["eps_t"].shape
        kappa, psi, damping = (one if one.size == 1 else one[: shape[0]] for one in flat)
        return Collisions((kappa, psi, damping), (*engine, *chosen), left, shape)

    job = (flat, engine, chosen, _strict(errors), _threads(threads))
    with keeping(first), reported(progress, "collide_many") as report:
        columns = _native.collide_many(*job, report)
    return Collisions(given, (*engine, *chosen), columns, shape)
