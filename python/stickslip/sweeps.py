"""Sweeps: collisions over named parameters, as xarray Datasets; lazy on Dask, or kept in Zarr.

A sweep is cut into blocks. A block needs only its part of each parameter, and its results depend
on nothing else. So blocks are computed anywhere and in any order, and again where one got lost.
"""

import functools
import hashlib
import itertools
import json
import math
import operator
import os
import platform
import re
import shutil
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _native
from stickslip.collisions import (
    Floats,
    Method,
    OnError,
    collide_many,
    eps_t_and_switch_count,
    psi_of_ratio,
)
from stickslip.maps import ATTRIBUTES

if TYPE_CHECKING:
    import zarr
    from distributed import Client
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


def sweep(
    kappa: Parameter,
    psi: Parameter | None = None,
    damping: Parameter = 0.0,
    *,
    ratio: Parameter | None = None,
    mu: Parameter | None = None,
    alpha: Parameter | None = None,
    method: Method = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    quantities: Sequence[Quantity] = ("eps_t", "switch_count"),
    chunks: Chunks | None = None,
    errors: OnError = "nan",
    threads: int | None = None,
) -> "Dataset":
    """Collisions over every combination of parameters.

    kappa, psi, damping: each a number, a one-dimensional array, or a DataArray. An array makes a
    dimension with the parameter's name; a DataArray has its own dimensions, and parameters that
    share one are taken together along it. The dimensions of the result are in the order of the
    arguments, and all parameters are its coordinates. They are scaled, without unit.

    ratio: impact ratios g_t/g_n instead of psi, with the friction mu (0.4 unless given) and the
    inertia alpha (2/7 unless given), which may be arrays too.

    quantities: some of eps_t, switch_count, eps_n, contact_time, w_final and reversals. The first
    two take the least time and memory.

    chunks: without it, the sweep is computed here and now. With it, the result is lazy, on Dask:
    "auto", a number for every dimension, or a number for each by name (whole where none is given,
    or -1).

    errors: "nan", or "raise" where a collision has no result. With "nan", numbers of switches and
    reversals are -1 there. threads: 1 to 1024 for each block; without it, one for each core here,
    and one where it is lazy. Results do not depend on threads and chunks.

    >>> found = sweep(kappa=[18.0, 63.0, 200.0], psi=[0.5, 1.0])
    >>> dict(found.sizes)
    {'kappa': 3, 'psi': 2}
    >>> int(found.switch_count.sel(kappa=63, psi=0.5))
    6
    """
    import xarray as xr

    engine = _Engine.of(method, rtol, atol, quantities, errors, threads)
    plan = _Plan.of(kappa, psi, damping, ratio, mu, alpha)
    if chunks is None:
        found = engine.compute(plan.aligned(), threads)
        arrays: dict[str, Any] = {name: found[name] for name in engine.quantities}
    else:
        arrays = _lazy(plan, engine, plan.block_shape(chunks), threads or 1)
    variables = {name: (plan.dims, array, QUANTITIES[name][1]) for name, array in arrays.items()}
    return xr.Dataset(variables, plan.coordinates, engine.attributes())


def write_sweep(
    store: str | os.PathLike[str],
    kappa: Parameter,
    psi: Parameter | None = None,
    damping: Parameter = 0.0,
    *,
    ratio: Parameter | None = None,
    mu: Parameter | None = None,
    alpha: Parameter | None = None,
    method: Method = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    quantities: Sequence[Quantity] = ("eps_t", "switch_count"),
    chunks: Chunks = "auto",
    errors: OnError = "nan",
    threads: int | None = None,
    client: "Client | None" = None,
    progress: Callable[[int, int], None] | None = None,
) -> "Dataset":
    """Computes a sweep into a Zarr store, or goes on with one; returns it, opened lazily.

    store: path of a directory, which every worker must see. Each block is a chunk of the store. A
    block that is there and whole is not computed again. So the same call goes on after whatever
    stopped it, and a call with other parameters is refused with what differs. A store holds results
    of one rounding: another version of stickslip, or a processor that rounds otherwise, is refused.

    client: a `distributed.Client`, whose workers compute the blocks; without it, they are computed
    here. threads: for each block; without it, one for each core here, and one with a client.
    progress: called with the number of finished blocks and of all blocks. The other arguments are
    those of `sweep`.

    Raises ValueError for what is refused, and OSError where the store cannot be written.
    """
    engine = _Engine.of(method, rtol, atol, quantities, errors, threads)
    plan = _Plan.of(kappa, psi, damping, ratio, mu, alpha)
    block = plan.block_shape(chunks)
    if "://" in os.fspath(store):
        raise ValueError(f"{os.fspath(store)}: expected a path; for others use sweep().to_zarr")
    path = Path(store).absolute()
    if not _exists(path):
        # The workers' build, not the client's, which may be another.
        build = _build() if client is None else client.submit(_build, pure=False).result()
        _create(path, plan, engine, block, build)
    group = _open(path)
    _refuse_another(path, group, plan, engine, block)

    grid = [range(math.ceil(n / most)) for n, most in zip(plan.shape, block, strict=True)]
    places = list(itertools.product(*grid))
    if client is None:
        write = functools.partial(_write_block, str(path), errors=errors, threads=threads)
        done: Iterator[None] = map(write, places)
    else:
        done = _on_workers(client, str(path), places, errors, threads or 1)
    for number, _ in enumerate(done, start=1):
        if progress is not None:
            progress(number, len(places))
    _complete(path)
    return _dataset(path)


@dataclass(frozen=True)
class _Engine:
    """What is computed, and how."""

    method: Method
    rtol: float | None
    atol: float | None
    quantities: tuple[str, ...]
    errors: OnError

    @classmethod
    def of(
        cls,
        method: Method,
        rtol: float | None,
        atol: float | None,
        quantities: Sequence[str],
        errors: OnError,
        threads: int | None,
    ) -> "_Engine":
        names = (quantities,) if isinstance(quantities, str) else tuple(quantities)
        unknown = [name for name in names if name not in QUANTITIES]
        if unknown or not names or len(set(names)) < len(names):
            raise ValueError(
                f"quantities = {quantities!r}; expected some of {', '.join(QUANTITIES)}, each once"
            )
        # The engine checks the rest, here rather than on a worker.
        eps_t_and_switch_count(
            [], [], [], method, rtol=rtol, atol=atol, errors=errors, threads=threads
        )
        rtol = None if rtol is None else float(rtol)
        atol = None if atol is None else float(atol)
        return cls(method, rtol, atol, names, errors)

    def attributes(self) -> dict[str, Any]:
        """The attributes of the Dataset."""
        given = {"method": self.method, "rtol": self.rtol, "atol": self.atol}
        return {"schema": SCHEMA, "stickslip_version": _native.version()} | {
            name: value for name, value in given.items() if value is not None
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
                rtol=self.rtol, atol=self.atol, errors=self.errors, threads=threads,
            )  # fmt: skip
        except (ValueError, _native.ComputationError) as error:
            # The index counts within the piece; the parameters, which follow it, say where.
            raise type(error)(re.sub(r"^\[\d+\] ", "", str(error))) from None
        if run is collide_many:
            return [getattr(found, name) for name in self.quantities]
        return [found[quick.index(name)] for name in self.quantities]


@dataclass(frozen=True)
class _Plan:
    """The parameters of a sweep, as coordinates, and its shape."""

    coordinates: "Dataset"
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
    ) -> "_Plan":
        import xarray as xr

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
            name: _aligned(variable.values, variable.dims, self.dims)
            for name in self.parameters
            for variable in [self.coordinates[name].variable]
        }

    def block_shape(self, chunks: Chunks) -> tuple[int, ...]:
        """The size of a block along each dimension; blocks at the end may be smaller."""
        if isinstance(chunks, str):
            if chunks != "auto":
                raise ValueError(f'chunks = {chunks!r}; expected "auto" or numbers')
            block = _auto(self.shape)
        else:
            by_name = chunks if isinstance(chunks, Mapping) else dict.fromkeys(self.dims, chunks)
            unknown = [name for name in by_name if name not in self.dims]
            if unknown:
                raise ValueError(f"chunks along {unknown[0]!r}; the dimensions are {self.dims}")
            block = tuple(
                _chunk(dim, by_name.get(dim, -1), size)
                for dim, size in zip(self.dims, self.shape, strict=True)
            )
        blocks = math.prod(math.ceil(n / most) for n, most in zip(self.shape, block, strict=True))
        if blocks > _MOST_BLOCKS:
            raise ValueError(
                f"chunks = {chunks!r} makes {blocks} blocks; expected at most {_MOST_BLOCKS}"
            )
        return block


def _named(name: str, value: Any) -> "DataArray":
    """A parameter with names for its dimensions, its values as numbers in memory."""
    import xarray as xr

    if isinstance(value, xr.Dataset):
        raise TypeError(f"{name} is a Dataset; expected one of its variables")
    values = np.ma.filled(value, np.nan) if np.ma.isMaskedArray(value) else np.asarray(value)
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


def _labels(name: str, value: Any, parameters: "Mapping[str, DataArray]") -> "Dataset":
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


def _aligned(values: Any, dims: Sequence[Any], all_dims: Sequence[Any]) -> Any:
    sizes = dict(zip(dims, values.shape, strict=True))
    return values.reshape([sizes.get(dim, 1) for dim in all_dims])


def _chunk(dim: str, asked: Any, size: int) -> int:
    number = operator.index(asked)
    if number < 1 and number != -1:
        raise ValueError(f"chunks along {dim} = {number}; expected at least 1, or -1 for all")
    return max(1, size if number == -1 else min(number, size))


def _auto(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Blocks of nearly equal sides, and nearly equal to each other."""
    left = max(_BLOCK, math.prod(shape) // 10_000)
    block = [1] * len(shape)
    for place, axis in enumerate(sorted(range(len(shape)), key=lambda axis: shape[axis])):
        most = max(1, round(left ** (1 / (len(shape) - place))))
        block[axis] = max(1, math.ceil(shape[axis] / max(1, math.ceil(shape[axis] / most))))
        left = max(1, left // block[axis])
    return tuple(block)


def _lazy(plan: _Plan, engine: _Engine, block: tuple[int, ...], threads: int) -> dict[str, Any]:
    """Dask arrays of the quantities. A task holds only its part of each parameter."""
    import dask.array as da

    most = dict(zip(plan.dims, block, strict=True))
    pairs: list[Any] = []
    for name in plan.parameters:
        variable = plan.coordinates[name].variable
        chunks = tuple(most[str(dim)] for dim in variable.dims)
        part: Any = da.from_array(variable.values, chunks=chunks)  # type: ignore[no-untyped-call]
        pairs += [part, variable.dims]
    own_dims = {name: plan.coordinates[name].dims for name in plan.parameters}
    # All quantities of a block come from one task.
    none = np.empty((0,) * len(plan.dims), engine.fields())
    fields: Any = da.blockwise(  # type: ignore[no-untyped-call]
        _block_fields, plan.dims, *pairs,
        engine=engine, own_dims=own_dims, dims=plan.dims, threads=threads,
        concatenate=True, align_arrays=False, dtype=none.dtype, meta=none,
    )  # fmt: skip
    return {
        name: da.map_blocks(  # type: ignore[no-untyped-call]
            operator.itemgetter(name), fields, dtype=none[name].dtype, meta=none[name]
        )
        for name in engine.quantities
    }


def _block_fields(
    *parts: Floats,
    engine: _Engine,
    own_dims: dict[str, tuple[str, ...]],
    dims: tuple[str, ...],
    threads: int,
) -> NDArray[np.void]:
    parameters = {
        name: _aligned(part, own, dims)
        for part, (name, own) in zip(parts, own_dims.items(), strict=True)
    }
    found = engine.compute(parameters, threads)
    fields = np.empty(next(iter(found.values())).shape, engine.fields())
    for name, values in found.items():
        fields[name] = values
    return fields


@functools.cache
def _build() -> dict[str, str]:
    """The version and the rounding of this process; results of equal builds have equal bits.

    The mathematical functions of the system differ too, by the processor. 7 of 10 000 exact results
    show it, so 16 384 collisions are computed, and some by each integrator.
    """
    number = np.arange(1 << 14)
    kappa, psi = (number % 128 + 1) * 0.75, (number // 128 + 1) / 32
    parts = [
        eps_t_and_switch_count(kappa, psi, number % 2 * 0.1, errors="nan", threads=1)[0],
        *(
            eps_t_and_switch_count(
                kappa[::128], psi[::128], 0.1, method, errors="nan", threads=1
            )[0]
            for method in ("dop853", "dopri5")
        ),
    ]  # fmt: skip
    probe = hashlib.sha256(np.concatenate(parts).astype("<f8").tobytes()).hexdigest()[:16]
    products = "fused" if _native.has_fused_products() else "separate"
    where = f"{platform.machine()} {platform.system()}"
    return {
        "stickslip_version": _native.version(),
        "rounding": f"{products} products, {where}, probe {probe}",
    }


def _exists(path: Path) -> bool:
    return path.exists() and (not path.is_dir() or any(path.iterdir()))


def _create(
    path: Path, plan: _Plan, engine: _Engine, block: tuple[int, ...], build: dict[str, str]
) -> None:
    """Makes the store without results; it appears whole or not at all."""
    import zarr
    from zarr.storage import LocalStore

    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(f".{path.name}.{uuid.uuid4().hex}.partial")
    try:
        chunks = dict(zip(plan.dims, block, strict=True))
        encoding = {
            name: {"chunks": tuple(chunks[str(dim)] for dim in variable.dims)}
            for name in plan.parameters
            if (variable := plan.coordinates[name].variable).dims
        }
        attributes = engine.attributes() | build | {"complete": 0}
        plan.coordinates.assign_attrs(attributes).to_zarr(
            LocalStore(draft), mode="w-", encoding=encoding, consolidated=False, zarr_format=3
        )
        group = zarr.open_group(LocalStore(draft), mode="r+")
        for name in engine.quantities:
            dtype, description = QUANTITIES[name]
            group.create_array(
                name,
                shape=plan.shape,
                chunks=block,
                dtype=dtype,
                fill_value=np.nan if dtype.kind == "f" else -1,
                dimension_names=plan.dims,
                attributes=description,
            )
        marks = group.create_group(
            "_blocks",
            attributes={"parameters": plan.parameters, "quantities": engine.quantities},
        )
        grid = tuple(math.ceil(n / most) for n, most in zip(plan.shape, block, strict=True))
        marks.create_array(
            "digest",
            shape=grid,
            chunks=(1,) * len(grid),
            dtype="u8",
            fill_value=0,
            compressors=None,
        )
        try:
            draft.rename(path)
        except OSError:
            # Another client may have made it meanwhile.
            if not _exists(path):
                raise
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _open(path: Path) -> "zarr.Group":
    """The store, if it is one of ours."""
    import zarr
    from zarr.storage import LocalStore

    try:
        # Zarr would make the directory.
        group = zarr.open_group(LocalStore(path), mode="r+") if path.is_dir() else None
    except FileNotFoundError:
        group = None
    schema = group.attrs.get("schema") if group else None
    if group is None or schema != SCHEMA:
        raise ValueError(
            f"{path} on {platform.node()} has the schema {schema!r}; expected {SCHEMA!r}, or "
            "nothing there; all workers must see the same files"
        )
    return group


def _refuse_another(
    path: Path, group: "zarr.Group", plan: _Plan, engine: _Engine, block: tuple[int, ...]
) -> None:
    """Raises unless the store is of this sweep."""
    marks: Any = group["_blocks"].attrs.asdict()
    stored = {name: group.attrs.get(name) for name in ("method", "rtol", "atol")}
    asked: dict[str, Any] = {name: getattr(engine, name) for name in stored}
    stored |= {name: tuple(marks[name]) for name in ("parameters", "quantities")}
    asked |= {"parameters": plan.parameters, "quantities": engine.quantities}
    differ = [
        f"{name} is {asked[name]!r}, in the store {stored[name]!r}"
        for name in asked
        if asked[name] != stored[name]
    ]
    if not differ:
        differ += [
            f"{name} has other values" for name in plan.parameters if not _same(group, plan, name)
        ]
    if not differ:
        chunks = _array(group, engine.quantities[0]).chunks
        if chunks != block:
            differ.append(f"chunks are {block}, in the store {chunks}")
    if differ:
        raise ValueError(f"{path} is of another sweep: {'; '.join(differ)}")


def _same(group: "zarr.Group", plan: _Plan, name: str) -> bool:
    variable = plan.coordinates[name].variable
    array = _array(group, name)
    return (
        tuple(array.metadata.dimension_names or ()) == variable.dims  # type: ignore[union-attr]
        and array.shape == variable.shape
        and np.asarray(array[...]).tobytes() == variable.values.tobytes()
    )


def _array(group: "zarr.Group", name: str) -> "zarr.Array[Any]":
    import zarr

    array = group[name]
    assert isinstance(array, zarr.Array)
    return array


def _write_block(store: str, place: tuple[int, ...], errors: OnError, threads: int | None) -> None:
    """Computes one block and writes it, unless it is there; runs on a worker, any number of times.

    The digest of the results is written after them. So a block without its digest, or with another
    one, was not finished or is damaged.
    """
    group = _open(Path(store))
    attributes = group.attrs.asdict()
    build = _build()
    if any(attributes.get(name) != value for name, value in build.items()):
        raise ValueError(
            f"{store} has results of stickslip {attributes.get('stickslip_version')} with "
            f"{attributes.get('rounding')}; on {platform.node()} there is stickslip "
            f"{build['stickslip_version']} with {build['rounding']}. Their last digits differ: "
            "use processors of one kind (perhaps with STICKSLIP_PORTABLE=1), or another store"
        )
    marks: Any = group["_blocks"].attrs.asdict()
    engine = _Engine(
        attributes["method"],  # type: ignore[arg-type]
        attributes.get("rtol"),  # type: ignore[arg-type]
        attributes.get("atol"),  # type: ignore[arg-type]
        tuple(marks["quantities"]),
        errors,
    )
    targets = {name: _array(group, name) for name in engine.quantities}
    first = targets[engine.quantities[0]]
    dims = first.metadata.dimension_names or ()  # type: ignore[union-attr]
    area = {
        dim: slice(at * most, min((at + 1) * most, size))
        for dim, at, most, size in zip(dims, place, first.chunks, first.shape, strict=True)
    }
    here = tuple(area.values())
    digests = _array(group, "_blocks/digest")
    if _is_whole(targets, here, digests, place, errors):
        return

    parameters = {}
    for name in marks["parameters"]:
        array = _array(group, name)
        own = array.metadata.dimension_names or ()  # type: ignore[union-attr]
        values = np.asarray(array[tuple(area[dim] for dim in own)])
        parameters[name] = _aligned(values, own, dims)
    found = engine.compute(parameters, threads)
    for name, target in targets.items():
        target[here] = found[name]
    digests[place] = np.uint64(_digest(found))


def _is_whole(
    targets: "Mapping[str, zarr.Array[Any]]",
    here: tuple[slice, ...],
    digests: "zarr.Array[Any]",
    place: tuple[int, ...],
    errors: OnError,
) -> bool:
    """Whether a block has the results that were written; to raise, it must have all of them."""
    try:
        recorded = int(np.asarray(digests[place])[()])
        if recorded == 0:
            return False
        found = {name: np.asarray(target[here]) for name, target in targets.items()}
    except Exception:  # Each codec has its own error for a chunk that is damaged.
        return False
    missing = any(
        bool((np.isnan(values) if values.dtype.kind == "f" else values < 0).any())
        for values in found.values()
    )
    return _digest(found) == recorded and not (missing and errors == "raise")


def _digest(found: Mapping[str, NDArray[Any]]) -> int:
    """64 bits of all results of a block, never 0."""
    digest = hashlib.blake2b(digest_size=8)
    for values in found.values():
        little = values.astype(values.dtype.newbyteorder("<"), copy=False)
        digest.update(np.ascontiguousarray(little).data)
    return int.from_bytes(digest.digest(), "little") or 1


def _on_workers(
    client: "Client", store: str, places: list[tuple[int, ...]], errors: OnError, threads: int
) -> Iterator[None]:
    """Yields when a block is done; Dask runs those of a lost worker again."""
    from distributed import as_completed

    run = functools.partial(_write_block, store, errors=errors, threads=threads)
    # Those that are done are forgotten, or Dask would run them again with the worker that did them.
    left = set(client.map(run, places, pure=False, key="stickslip-block"))
    try:
        for future in as_completed(list(left)):  # type: ignore[no-untyped-call]
            # Its result is nothing, and may be lost again with the worker; the block is not.
            if future.status in ("error", "cancelled"):
                future.result()
            left.discard(future)
            future.release()
            yield
    finally:
        client.cancel(list(left))  # type: ignore[no-untyped-call]


def _complete(path: Path) -> None:
    """Marks the store as complete."""
    metadata = path / "zarr.json"
    found = json.loads(metadata.read_bytes())
    if not found["attributes"]["complete"]:
        found["attributes"]["complete"] = 1
        # Zarr's own draft would lie beside it, and be warned of by those who open the store.
        draft = path / "_blocks" / f"{uuid.uuid4().hex}.partial"
        draft.write_text(json.dumps(found, indent=2), "utf-8")
        draft.replace(metadata)


def _dataset(path: Path) -> "Dataset":
    import xarray as xr
    from zarr.storage import LocalStore

    found: xr.Dataset = xr.open_zarr(LocalStore(path, read_only=True), consolidated=False)
    return found
