"""Sweeps: collisions over named parameters, as xarray Datasets; lazy on Dask, or kept in Zarr.

A sweep is cut into blocks. A block needs only its part of each parameter, and its results depend
on nothing else. So blocks are computed anywhere and in any order, and again where one got lost.
"""

from __future__ import annotations

import functools
import itertools
import math
import operator
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip import _laws, _stores
from stickslip._blocks import QUANTITIES, Chunks, Engine, Parameter, Plan, Quantity, aligned
from stickslip._laws import Law
from stickslip._libraries import library
from stickslip._progress import Progress, check, reported
from stickslip._collisions import (
    Floats,
    Method,
    OnError,
)

if TYPE_CHECKING:
    from distributed import Client
    from xarray import Dataset


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
    law: Law | None = None,
    tangential_damping: float = 0.0,
    quantities: Sequence[Quantity] = ("eps_t", "switch_count"),
    chunks: Chunks | None = None,
    errors: OnError = "nan",
    threads: int | None = None,
) -> Dataset:
    """Collisions over every combination of parameters.

    kappa, psi, damping: each a number, a one-dimensional array, or a DataArray. An array makes a
    dimension with the parameter's name; a DataArray has its own dimensions, and parameters that
    share one are taken together along it. The dimensions of the result are in the order of the
    arguments, and all parameters are its coordinates. They are scaled, without unit.

    ratio: impact ratios g_t/g_n instead of psi, with the friction mu (0.4 unless given) and the
    inertia alpha (2/7 unless given), which may be arrays too.

    law: the contact law of all collisions, as for `collide`, with its tangential_damping; attributes of
    the result.

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
    library("xarray", "for sweep")
    import xarray as xr

    engine = Engine.of(
        method, rtol, atol, _laws.attributes(law, tangential_damping), quantities, errors, threads
    )
    plan = Plan.of(kappa, psi, damping, ratio, mu, alpha)
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
    law: Law | None = None,
    tangential_damping: float = 0.0,
    quantities: Sequence[Quantity] = ("eps_t", "switch_count"),
    chunks: Chunks = "auto",
    errors: OnError = "nan",
    threads: int | None = None,
    client: Client | None = None,
    progress: Progress | None = None,
) -> Dataset:
    """Computes a sweep into a Zarr store, or goes on with one; returns it, opened lazily.

    store: path of a directory, which every worker must see. Each block is a chunk of the store. A
    block that is there and whole is not computed again. So the same call goes on after whatever
    stopped it, and a call with other parameters is refused with what differs. A store holds results
    of one rounding: another version of stickslip, or a processor that rounds otherwise, is refused.

    client: a `distributed.Client`, whose workers compute the blocks; without it, they are computed
    here. threads: for each block; without it, one for each core here, and one with a client.
    progress: called with the number of finished blocks and of all blocks; True shows a bar on
    stderr. The other arguments are
    those of `sweep`.

    Raises ValueError for what is refused, and OSError where the store cannot be written.
    """
    engine = Engine.of(
        method, rtol, atol, _laws.attributes(law, tangential_damping), quantities, errors, threads
    )
    check(progress)
    plan = Plan.of(kappa, psi, damping, ratio, mu, alpha)
    block = plan.block_shape(chunks)
    if "://" in os.fspath(store):
        raise ValueError(f"{os.fspath(store)}: expected a path; for others use sweep().to_zarr")
    path = Path(store).absolute()
    if not _stores.exists(path):
        # The workers' build, not the client's, which may be another.
        build = (
            _stores.build_of_process()
            if client is None
            else client.submit(_stores.build_of_process, pure=False).result()
        )
        _stores.create_store(path, plan, engine, block, build)
    group = _stores.open_store(path)
    _stores.refuse_another(path, group, plan, engine, block)

    grid = [range(math.ceil(n / most)) for n, most in zip(plan.shape, block, strict=True)]
    places = list(itertools.product(*grid))
    if client is None:
        write = functools.partial(_stores.write_block, str(path), errors=errors, threads=threads)
        done: Iterator[None] = map(write, places)
    else:
        done = _stores.on_workers(client, str(path), places, errors, threads or 1)
    with reported(progress, "sweep") as report:
        for number, _ in enumerate(done, start=1):
            if report is not None:
                report(number, len(places))
    _stores.complete(path)
    return _stores.dataset(path)


def _lazy(plan: Plan, engine: Engine, block: tuple[int, ...], threads: int) -> dict[str, Any]:
    """Dask arrays of the quantities. A task holds only its part of each parameter."""
    library("dask.array", "for chunks")
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
    engine: Engine,
    own_dims: dict[str, tuple[str, ...]],
    dims: tuple[str, ...],
    threads: int,
) -> NDArray[np.void]:
    parameters = {
        name: aligned(part, own, dims)
        for part, (name, own) in zip(parts, own_dims.items(), strict=True)
    }
    found = engine.compute(parameters, threads)
    fields = np.empty(next(iter(found.values())).shape, engine.fields())
    for name, values in found.items():
        fields[name] = values
    return fields
