"""What a sweep computes: its parameters, quantities and blocks."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, Union

import numpy as np
from numpy.typing import ArrayLike

from stickslip import _native
from stickslip._arrays import unmasked
from stickslip._collisions import (
    Floats,
    Method,
    OnError,
    collide_many,
    eps_t_and_switch_count,
    psi_of_ratio,
)
from stickslip._libraries import library
from stickslip._maps import ATTRIBUTES

if TYPE_CHECKING:
    from xarray import DataArray, Dataset
Parameter: TypeAlias = Union[ArrayLike, "DataArray"]
Chunks: TypeAlias = int | Mapping[str, int] | Literal["auto"]
Quantity: TypeAlias = Literal[
    "eps_t", "switch_count", "eps_n", "contact_time", "w_final", "reversals"
]

#: The layout of sweeps, and of their Zarr stores.
SCHEMA = "stickslip.sweep/1"

_COUNT = {"units": "1", "comment": "-1 where a collision has no result"}

#: What a sweep can compute: dtype and attributes of each quantity.
QUANTITIES: dict[str, tuple[np.dtype[Any], dict[str, Any]]] = {
    "eps_t": (np.dtype("f8"), ATTRIBUTES["eps_t"]),
    "switch_count": (np.dtype("i4"), {"long_name": "number of switches", **_COUNT}),
    "eps_n": (np.dtype("f8"), ATTRIBUTES["eps_n"]),
    "contact_time": (np.dtype("f8"), ATTRIBUTES["contact_time"]),
    "w_final": (
        np.dtype("f8"),
        {"long_name": "reduced tangential velocity at the end", "units": "1"},
    ),
    "reversals": (
        np.dtype("i4"),
        {"long_name": "number of sign changes of the tangential velocity", **_COUNT},
    ),
}

_PARAMETERS: dict[str, dict[str, Any]] = {
    name: ATTRIBUTES[name] for name in ("kappa", "psi", "ratio", "damping")
} | {
    "mu": {"long_name": "coefficient of friction", "units": "1"},
    "alpha": {"long_name": "tangential inertia", "units": "1"},
}

#: Collisions of one call of the engine: enough for many threads, few enough for little memory.
_PIECE = 1 << 16

#: Collisions of a block with chunks = "auto": a fraction of a second of work, for exact ones.
_BLOCK = 1 << 18

#: With more blocks than this, their administration costs more than the collisions.
_MOST_BLOCKS = 100_000


@dataclass(frozen=True)
class Engine:
    """What is computed, and how."""

    method: Method
    rtol: float | None
    atol: float | None
    #: The law with its tangential damping, as for `collide`; nothing for the paper's.
    law: Mapping[str, Any]
    quantities: tuple[str, ...]
    errors: OnError

    @classmethod
    def of(
        cls,
        method: Method,
        rtol: float | None,
        atol: float | None,
        law: Mapping[str, Any],
        quantities: Sequence[str],
        errors: OnError,
        threads: int | None,
    ) -> Engine:
        names = (quantities,) if isinstance(quantities, str) else tuple(quantities)
        unknown = [name for name in names if name not in QUANTITIES]
        if unknown or not names or len(set(names)) < len(names):
            raise ValueError(
                f"quantities = {quantities!r}; expected some of {', '.join(QUANTITIES)}, each once"
            )
        # The engine checks the rest, here rather than on a worker.
        eps_t_and_switch_count(
            [], [], [], method, rtol=rtol, atol=atol, **law, errors=errors, threads=threads
        )
        rtol = None if rtol is None else float(rtol)
        atol = None if atol is None else float(atol)
        return cls(method, rtol, atol, law, names, errors)

    def attributes(self) -> dict[str, Any]:
        """The attributes of the Dataset."""
        given: dict[str, Any] = {"method": self.method, "rtol": self.rtol, "atol": self.atol}
        return {"schema": SCHEMA, "stickslip_version": _native.version()} | {
            name: value for name, value in {**given, **self.law}.items() if value is not None
        }

    def fields(self) -> np.dtype[Any]:
        """One collision with all quantities."""
        return np.dtype([(name, QUANTITIES[name][0]) for name in self.quantities])

    def compute(self, parameters: Mapping[str, Floats], threads: int | None) -> dict[str, Any]:
        """The quantities, for parameters that broadcast to the shape of the block."""
        shape = np.broadcast_shapes(*(one.shape for one in parameters.values()))
        if "ratio" in parameters:
            with np.errstate(all="ignore"):
                psi = psi_of_ratio(parameters["ratio"], parameters["mu"], parameters["alpha"])
        else:
            psi = parameters["psi"]
        inputs = [parameters["kappa"], psi, parameters["damping"]]
        found = {name: np.empty(shape, QUANTITIES[name][0]) for name in self.quantities}
        # Pieces of the broadcast parameters: never all of them at once.
        pieces: Any = np.nditer(  # type: ignore[call-overload]  # "contig" is missing there
            [*inputs, *found.values()],
            flags=["buffered", "external_loop", "zerosize_ok"],
            op_flags=[["readonly", "contig"]] * 3 + [["writeonly", "contig"]] * len(found),
            order="C",
            buffersize=_PIECE,
        )
        with pieces:
            for piece in pieces:
                results = self._piece(piece[0], piece[1], piece[2], threads)
                for target, result in zip(piece[3:], results, strict=True):
                    target[...] = result
        return found

    def _piece(self, kappa: Floats, psi: Floats, damping: Floats, threads: int | None) -> list[Any]:
        quick = ("eps_t", "switch_count")
        run = eps_t_and_switch_count if set(self.quantities) <= set(quick) else collide_many
        try:
            found: Any = run(
                kappa, psi, damping, self.method,
                rtol=self.rtol, atol=self.atol, **self.law, errors=self.errors, threads=threads,
            )  # fmt: skip
        except (ValueError, _native.ComputationError) as error:
            # The index counts within the piece; the parameters, which follow it, say where.
            raise type(error)(re.sub(r"^\[\d+\] ", "", str(error))) from None
        if run is collide_many:
            return [getattr(found, name) for name in self.quantities]
        return [found[quick.index(name)] for name in self.quantities]


@dataclass(frozen=True)
class Plan:
    """The parameters of a sweep, as coordinates, and its shape."""

    coordinates: Dataset
    #: The names of the parameters that determine the sweep, without psi where ratio is given.
    parameters: tuple[str, ...]
    dims: tuple[str, ...]
    shape: tuple[int, ...]

    @classmethod
    def of(
        cls,
        kappa: Parameter,
        psi: Parameter | None,
        damping: Parameter,
        ratio: Parameter | None,
        mu: Parameter | None,
        alpha: Parameter | None,
    ) -> Plan:
        xr = library("xarray", "for sweeps")
        if (psi is None) == (ratio is None):
            raise ValueError("expected exactly one of psi and ratio")
        if ratio is None and not (mu is None and alpha is None):
            raise ValueError("mu and alpha have no effect with psi; expected ratio")
        given: dict[str, Any] = {"kappa": kappa}
        given |= {"psi": psi} if ratio is None else {"ratio": ratio}
        given |= {"damping": damping}
        if ratio is not None:
            given |= {"mu": 0.4 if mu is None else mu, "alpha": 2 / 7 if alpha is None else alpha}

        arrays = {name: _named(name, value) for name, value in given.items()}
        sizes: dict[str, int] = {}
        for name, array in arrays.items():
            for dim, size in zip(array.dims, array.shape, strict=True):
                alone = dim in arrays and arrays[str(dim)].dims == (dim,)
                if dim in QUANTITIES or (dim in _PARAMETERS and not alone):
                    raise ValueError(
                        f"{name} has the dimension {dim!r}; expected another name, or {dim} as a "
                        "one-dimensional array too"
                    )
                if sizes.setdefault(str(dim), size) != size:
                    raise ValueError(
                        f"{name} has {size} values along {dim}; expected {sizes[str(dim)]}"
                    )
        dims = tuple(sizes)
        arrays = {
            name: array.transpose(*(dim for dim in dims if dim in array.dims))
            for name, array in arrays.items()
        }
        labels = [_labels(name, given[name], arrays) for name in arrays]
        coordinates = xr.merge(labels, join="exact", compat="equals", combine_attrs="override")
        coordinates = coordinates.drop_encoding().assign_coords(arrays)
        if ratio is not None:
            with np.errstate(all="ignore"):
                computed = arrays["ratio"] * arrays["alpha"] / arrays["mu"]
            # Over more dimensions than the ratio's it would grow with the sweep.
            if computed.dims == arrays["ratio"].dims:
                psi_variable = (computed.dims, computed.values, _PARAMETERS["psi"])
                coordinates = coordinates.assign_coords(psi=psi_variable)
        return cls(coordinates, tuple(arrays), dims, tuple(sizes.values()))

    def aligned(self) -> dict[str, Floats]:
        """The parameters with all dimensions of the sweep, of size 1 where they do not vary."""
        return {
            name: aligned(variable.values, variable.dims, self.dims)
            for name in self.parameters
            for variable in [self.coordinates[name].variable]
        }

    def block_shape(self, chunks: Chunks) -> tuple[int, ...]:
        """The size of a block along each dimension; blocks at the end may be smaller."""
        return block_shape(self.dims, self.shape, chunks)


def block_shape(
    dims: tuple[str, ...], shape: tuple[int, ...], chunks: Chunks, auto: int = _BLOCK
) -> tuple[int, ...]:
    """The size of a block along each dimension; blocks at the end may be smaller. With "auto" a
    block has so many places, or more."""
    if isinstance(chunks, str):
        if chunks != "auto":
            raise ValueError(f'chunks = {chunks!r}; expected "auto" or numbers')
        block = _auto(shape, auto)
    else:
        by_name = chunks if isinstance(chunks, Mapping) else dict.fromkeys(dims, chunks)
        unknown = [name for name in by_name if name not in dims]
        if unknown:
            raise ValueError(f"chunks along {unknown[0]!r}; the dimensions are {dims}")
        sizes = zip(dims, shape, strict=True)
        block = tuple(_chunk(dim, by_name.get(dim, -1), size) for dim, size in sizes)
    blocks = math.prod(math.ceil(n / most) for n, most in zip(shape, block, strict=True))
    if blocks > _MOST_BLOCKS:
        raise ValueError(
            f"chunks = {chunks!r} makes {blocks} blocks; expected at most {_MOST_BLOCKS}"
        )
    return block


def _named(name: str, value: Any) -> DataArray:
    """A parameter with names for its dimensions, its values as numbers in memory."""
    import xarray as xr

    if isinstance(value, xr.Dataset):
        raise TypeError(f"{name} is a Dataset; expected one of its variables")
    values = unmasked(value)
    if values.dtype.kind not in "iuf":
        raise TypeError(f"{name} has the type {values.dtype}; expected real numbers")
    if isinstance(value, xr.DataArray):
        dims: tuple[Any, ...] = value.dims
        units = value.attrs.get("units", "1")
        if units not in ("1", "", "dimensionless"):
            raise ValueError(f"{name} has the units {units!r}; expected a scaled one, without unit")
        if not all(isinstance(dim, str) for dim in dims) or len(set(dims)) < len(dims):
            raise ValueError(f"{name} has the dimensions {dims}; expected different names")
    elif values.ndim <= 1:
        dims = (name,) * values.ndim
    else:
        raise ValueError(
            f"{name} has {values.ndim} dimensions without names; expected one, or a DataArray"
        )
    return xr.DataArray(values.astype(np.float64), dims=dims, attrs=_PARAMETERS[name])


def _labels(name: str, value: Any, parameters: Mapping[str, DataArray]) -> Dataset:
    """What else a DataArray has along its dimensions."""
    import xarray as xr

    if not isinstance(value, xr.DataArray):
        return xr.Dataset()
    for dim in value.dims:
        if dim in value.coords and dim in parameters:
            expected = parameters[str(dim)]
            if expected.dims != (dim,) or not np.array_equal(
                value.coords[dim].values, expected.values, equal_nan=True
            ):
                raise ValueError(f"{name} is given at other values of {dim} than the sweep has")
    own = [label for label in value.coords if label in _PARAMETERS or label in QUANTITIES]
    return value.drop_vars(own).coords.to_dataset()


def aligned(values: Any, dims: Sequence[Any], all_dims: Sequence[Any]) -> Any:
    sizes = dict(zip(dims, values.shape, strict=True))
    return values.reshape([sizes.get(dim, 1) for dim in all_dims])


def _chunk(dim: str, asked: Any, size: int) -> int:
    number = operator.index(asked)
    if number < 1 and number != -1:
        raise ValueError(f"chunks along {dim} = {number}; expected at least 1, or -1 for all")
    return max(1, size if number == -1 else min(number, size))


def _auto(shape: tuple[int, ...], least: int) -> tuple[int, ...]:
    """Blocks of nearly equal sides, and nearly equal to each other."""
    left = max(least, math.prod(shape) // 10_000)
    block = [1] * len(shape)
    for place, axis in enumerate(sorted(range(len(shape)), key=lambda axis: shape[axis])):
        most = max(1, round(left ** (1 / (len(shape) - place))))
        block[axis] = max(1, math.ceil(shape[axis] / max(1, math.ceil(shape[axis] / most))))
        left = max(1, left // block[axis])
    return tuple(block)
