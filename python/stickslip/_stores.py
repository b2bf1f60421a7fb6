"""Zarr stores of sweeps, which are written block by block, by anybody, in any order."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import math
import platform
import shutil
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip import _native
from stickslip._blocks import QUANTITIES, SCHEMA, Engine, Plan, aligned
from stickslip._libraries import library
from stickslip._collisions import (
    OnError,
    eps_t_and_switch_count,
)

if TYPE_CHECKING:
    import zarr
    from distributed import Client
    from xarray import Dataset


#: The attributes that say which law another than the paper's is.
LAW = ("law", "tangential_damping")


@functools.cache
def build_of_process() -> dict[str, str]:
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


class Refused(ValueError):
    """A store is another one than is expected."""


@contextlib.contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Says in words that a store is damaged."""
    try:
        yield
    except (Refused, OSError):
        raise
    except Exception as error:  # Zarr and its codecs have many.
        what = f"{type(error).__name__}: {error}"
        raise OSError(
            f"{path} is damaged in its metadata ({what}); expected a store as write_sweep made it"
        ) from error


def exists(path: Path) -> bool:
    return path.exists() and (not path.is_dir() or any(path.iterdir()))


def create_store(
    path: Path, plan: Plan, engine: Engine, block: tuple[int, ...], build: dict[str, str]
) -> None:
    """Makes the store without results; it appears whole or not at all."""
    zarr = library("zarr", "for write_sweep")
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
            if not exists(path):
                raise
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def open_store(path: Path) -> zarr.Group:
    """The store, if it is one of ours."""
    import zarr
    from zarr.storage import LocalStore

    with _readable(path):
        try:
            # Zarr would make the directory.
            group = zarr.open_group(LocalStore(path), mode="r+") if path.is_dir() else None
        except FileNotFoundError:
            group = None
        schema = group.attrs.get("schema") if group else None
    if group is None or schema != SCHEMA:
        raise Refused(
            f"{path} on {platform.node()} has the schema {schema!r}; expected {SCHEMA!r}, or "
            "nothing there; all workers must see the same files"
        )
    return group


def refuse_another(
    path: Path, group: zarr.Group, plan: Plan, engine: Engine, block: tuple[int, ...]
) -> None:
    """Raises unless the store is of this sweep, and has its arrays."""
    with _readable(path):
        _refuse_another(path, group, plan, engine, block)
        for name in engine.quantities:
            dtype, description = QUANTITIES[name]
            array = _array(group, name)
            found = (array.dtype, array.shape, _dims(array), array.attrs.asdict())
            if found != (dtype, plan.shape, plan.dims, description):
                raise ValueError(f"{name} is not as it was")


def _refuse_another(
    path: Path, group: zarr.Group, plan: Plan, engine: Engine, block: tuple[int, ...]
) -> None:
    marks: Any = group["_blocks"].attrs.asdict()
    names = ("method", "rtol", "atol", *LAW)
    stored = {name: group.attrs.get(name) for name in names}
    attributes = engine.attributes()
    asked: dict[str, Any] = {name: attributes.get(name) for name in names}
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
        raise Refused(f"{path} is of another sweep: {'; '.join(differ)}")


def _same(group: zarr.Group, plan: Plan, name: str) -> bool:
    variable = plan.coordinates[name].variable
    array = _array(group, name)
    return (
        _dims(array) == variable.dims
        and array.shape == variable.shape
        and array.dtype == variable.dtype
        and np.asarray(array[...]).tobytes() == variable.values.tobytes()
    )


def _dims(array: zarr.Array[Any]) -> tuple[Any, ...]:
    return tuple(array.metadata.dimension_names or ())  # type: ignore[union-attr]


def _array(group: zarr.Group, name: str) -> zarr.Array[Any]:
    import zarr

    array = group[name]
    if not isinstance(array, zarr.Array):
        raise TypeError(f"{name} is no array")
    return array


def write_block(store: str, place: tuple[int, ...], errors: OnError, threads: int | None) -> None:
    """Computes one block and writes it, unless it is there; runs on a worker, any number of times.

    The digest of the results is written after them. So a block without its digest, or with another
    one, was not finished or is damaged.
    """
    group = open_store(Path(store))
    attributes = group.attrs.asdict()
    build = build_of_process()
    if any(attributes.get(name) != value for name, value in build.items()):
        raise Refused(
            f"{store} has results of stickslip {attributes.get('stickslip_version')} with "
            f"{attributes.get('rounding')}; on {platform.node()} there is stickslip "
            f"{build['stickslip_version']} with {build['rounding']}. Their last digits differ: "
            "use processors of one kind (perhaps with STICKSLIP_PORTABLE=1), or another store"
        )
    with _readable(Path(store)):
        marks: Any = group["_blocks"].attrs.asdict()
        engine = Engine(
            attributes["method"],  # type: ignore[arg-type]
            attributes.get("rtol"),  # type: ignore[arg-type]
            attributes.get("atol"),  # type: ignore[arg-type]
            {name: attributes[name] for name in LAW if name in attributes},
            tuple(marks["quantities"]),
            errors,
        )
        targets = {name: _array(group, name) for name in engine.quantities}
        first = targets[engine.quantities[0]]
        dims = _dims(first)
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
            own = _dims(array)
            values = np.asarray(array[tuple(area[dim] for dim in own)])
            parameters[name] = aligned(values, own, dims)
    found = engine.compute(parameters, threads)
    with _readable(Path(store)):
        for name, target in targets.items():
            target[here] = found[name]
        digests[place] = np.uint64(_digest(found))


def _is_whole(
    targets: Mapping[str, zarr.Array[Any]],
    here: tuple[slice, ...],
    digests: zarr.Array[Any],
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


def on_workers(
    client: Client, store: str, places: list[tuple[int, ...]], errors: OnError, threads: int
) -> Iterator[None]:
    """Yields when a block is done; Dask runs those of a lost worker again."""
    from distributed import as_completed

    run = functools.partial(write_block, store, errors=errors, threads=threads)
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


def complete(path: Path) -> None:
    """Marks the store as complete."""
    metadata = path / "zarr.json"
    with _readable(path):
        found = json.loads(metadata.read_bytes())
        marked = found["attributes"]["complete"]
    if not marked:
        found["attributes"]["complete"] = 1
        # Zarr's own draft would lie beside it, and be warned of by those who open the store.
        draft = path / "_blocks" / f"{uuid.uuid4().hex}.partial"
        draft.write_text(json.dumps(found, indent=2), "utf-8")
        draft.replace(metadata)


def dataset(path: Path) -> Dataset:
    import xarray as xr
    from zarr.storage import LocalStore

    with _readable(path):
        found: xr.Dataset = xr.open_zarr(LocalStore(path, read_only=True), consolidated=False)
    return found
