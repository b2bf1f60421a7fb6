"""Sweeps: their values, their stores, and what happens when processes are killed."""

import hashlib
import os
import re
import runpy
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip
from stickslip import _blocks, _stores
from stickslip._blocks import QUANTITIES, SCHEMA
from stickslip._sweeps import sweep, write_sweep

xr = pytest.importorskip("xarray")
da = pytest.importorskip("dask.array")
pytest.importorskip("zarr")
distributed = pytest.importorskip("distributed")

KAPPA = np.linspace(0.5, 90, 23)
PSI = np.linspace(0.05, 4, 17)
ALL = tuple(QUANTITIES)
SMALL: dict[str, Any] = {"kappa": KAPPA, "psi": PSI, "chunks": {"kappa": 10, "psi": 7}}


def digest(found: Any) -> str:
    """Of all bits of all variables and coordinates."""
    total = hashlib.sha256()
    for name in sorted(found.variables):
        values = np.ascontiguousarray(found[name].values)
        total.update(f"{name} {found[name].dims} {values.dtype} {values.shape}".encode())
        total.update(values.tobytes())
    return total.hexdigest()


def files(store: Path) -> dict[str, int]:
    """When the chunks of results were written."""
    return {
        str(path.relative_to(store)): path.stat().st_mtime_ns
        for name in ALL
        for path in store.glob(f"{name}/c/**/*")
        if path.is_file()
    }


def script(body: str) -> str:
    """A program that may start processes, which do not import what it imports."""
    head = """
        import sys
        import numpy as np
        from stickslip import sweep, write_sweep
    """
    whole = textwrap.dedent(head) + textwrap.dedent(body)
    return 'if __name__ == "__main__":\n' + textwrap.indent(whole, "    ")


# Values


@pytest.mark.parametrize("damping", [0.0, 0.2])
@pytest.mark.parametrize("method", ["exact", "dop853"])
def test_values_are_those_of_collide_many(damping: float, method: Any) -> None:
    found = sweep(KAPPA, PSI, damping, method=method, quantities=ALL)
    many = stickslip.collide_many(KAPPA[:, None], PSI, damping, method)
    assert list(found.data_vars) == list(ALL)
    for name in ALL:
        assert found[name].dtype == QUANTITIES[name][0]
        np.testing.assert_array_equal(found[name].values, getattr(many, name))
    quick = sweep(KAPPA, PSI, damping, method=method)
    assert digest(quick) == digest(found[["eps_t", "switch_count"]])


LAW: dict[str, Any] = {"law": {"tangential": "mindlin", "end": "overlap"}}


@pytest.mark.parametrize("chunks", [None, 7])
def test_laws(tmp_path: Path, chunks: Any) -> None:
    law = LAW | {"tangential_damping": 0.5}
    many = stickslip.collide_many(KAPPA[:, None], PSI, 0.2, **law)
    found = sweep(KAPPA, PSI, 0.2, **law, quantities=ALL, chunks=chunks)
    for name in ALL:
        np.testing.assert_array_equal(found[name].values, getattr(many, name))
    assert found.attrs["tangential_damping"] == 0.5
    # The attribute is a law too.
    again = sweep(KAPPA, PSI, 0.2, law=found.attrs["law"], tangential_damping=0.5, quantities=ALL)
    assert digest(again) == digest(found.compute())
    if chunks is not None:
        arguments = {"kappa": KAPPA, "psi": PSI, "damping": 0.2, "quantities": ALL}
        stored = write_sweep(tmp_path / "s", **arguments, **law, chunks=chunks)
        assert digest(stored) == digest(again) and stored.attrs["law"] == found.attrs["law"]
        with pytest.raises(ValueError, match="tangential_damping is 0.4, in the store 0.5"):
            write_sweep(tmp_path / "s", **arguments, **law | {"tangential_damping": 0.4})
    assert "law" not in sweep(KAPPA, PSI, 0.2).attrs
    for wrong in ({"law": "hertz"}, {"law": {"normal": "hook"}}, LAW | {"tangential_damping": -1}):
        with pytest.raises(ValueError, match="hertz|hook|tangential_damping"):
            sweep(KAPPA, PSI, 0.2, **wrong, chunks=chunks, errors="raise").compute()


def test_maps_of_laws() -> None:
    found = stickslip.map((1.0, 9.0), (0.1, 2.0), (5, 4), 0.2, **LAW)
    one = stickslip.collide(found.kappa[3].item(), found.psi[2].item(), 0.2, **LAW)
    assert found.eps_t[2, 3] == one.eps_t and found.switch_count[2, 3] == one.switch_count
    again = stickslip.map((1.0, 9.0), (0.1, 2.0), (5, 4), 0.2, **found.attrs)
    assert digest(again) == digest(found)
    assert not stickslip.map((1.0, 9.0), (0.1, 2.0), (5, 4)).attrs


@pytest.mark.parametrize("order", [("eps_t", "switch_count"), ("switch_count", "eps_t")])
def test_two_quantities_in_any_order(order: Any) -> None:
    found = sweep(KAPPA, 0.5, quantities=order)
    many = stickslip.collide_many(KAPPA, 0.5)
    np.testing.assert_array_equal(found.eps_t, many.eps_t)
    np.testing.assert_array_equal(found.switch_count, many.switch_count)


def test_values_do_not_depend_on_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    expected = digest(sweep(KAPPA, PSI, [0.0, 0.1, 0.2], quantities=ALL))
    for piece in (1, 7, 50):
        monkeypatch.setattr(_blocks, "_PIECE", piece)
        assert digest(sweep(KAPPA, PSI, [0.0, 0.1, 0.2], quantities=ALL)) == expected


@pytest.mark.parametrize("chunks", ["auto", 1000, 5, {"kappa": 4}, {"ratio": -1, "kappa": 9}])
@pytest.mark.parametrize("scheduler", ["synchronous", "threads"])
def test_lazy_is_eager(chunks: Any, scheduler: str) -> None:
    parameters: dict[str, Any] = {"kappa": KAPPA, "ratio": PSI, "damping": [0.0, 0.1], "mu": 0.3}
    eager = sweep(**parameters, quantities=ALL, threads=1)
    lazy = sweep(**parameters, quantities=ALL, chunks=chunks)
    assert all(lazy[name].chunks is not None for name in ALL)
    xr.testing.assert_identical(eager, lazy.compute(scheduler=scheduler))
    one = lazy.eps_n.isel(kappa=3, damping=1).compute(scheduler=scheduler)
    xr.testing.assert_identical(eager.eps_n.isel(kappa=3, damping=1), one)


def test_lazy_with_dasks_array_expressions() -> None:
    pytest.importorskip("dask.array._array_expr._blockwise")
    body = """
        import dask
        dask.config.set({"array.query-planning": True})
        found = sweep([1.0, 20.0, 30.0], [0.5, 1.0], chunks=2, quantities=("eps_t", "reversals"))
        assert found.compute().identical(
            sweep([1.0, 20.0, 30.0], [0.5, 1.0], quantities=("eps_t", "reversals"))
        )
    """
    subprocess.run([sys.executable, "-c", script(body)], check=True)


def test_graph_of_a_hundred_million_is_small() -> None:
    found = sweep(np.linspace(1, 100, 10_000), np.linspace(0.1, 4, 10_000), chunks="auto")
    assert found.eps_t.size == 10**8
    assert len(found.__dask_graph__()) < 2000
    line = sweep(xr.DataArray(np.ones(10**6), dims="case"), 1.0, chunks="auto")
    assert len(line.__dask_graph__()) < 20


# Parameters


def test_dimensions_coordinates_and_attributes() -> None:
    found = sweep([1, 2, 3], np.float32([0.5, 1.0]), 0, method="dop853", rtol=1e-9)
    assert dict(found.sizes) == {"kappa": 3, "psi": 2}
    assert found.eps_t.dims == ("kappa", "psi")
    assert set(found.coords) == {"kappa", "psi", "damping"}
    assert found.damping.dims == ()
    for name in found.variables:
        assert found[name].attrs["units"] == "1"
        assert found[name].attrs["long_name"]
    assert found.kappa.dtype == found.psi.dtype == np.float64
    assert found.attrs == {
        "schema": SCHEMA,
        "stickslip_version": stickslip.__version__,
        "method": "dop853",
        "rtol": 1e-9,
    }


def test_psi_is_a_coordinate_of_ratios() -> None:
    found = sweep(10.0, ratio=[0.7, 1.4])
    np.testing.assert_array_equal(found.psi, stickslip.psi_of_ratio([0.7, 1.4]))
    assert found.psi.dims == ("ratio",)
    assert float(found.mu) == 0.4
    np.testing.assert_array_equal(found.eps_t, stickslip.eps_t(10.0, found.psi.values))
    # Over ratio and mu it would have the size of the sweep.
    wide = sweep(10.0, ratio=[0.7, 1.4], mu=[0.2, 0.3, 0.4])
    assert dict(wide.sizes) == {"ratio": 2, "mu": 3}
    assert "psi" not in wide.coords
    np.testing.assert_array_equal(
        wide.eps_t,
        stickslip.eps_t(10.0, stickslip.psi_of_ratio(np.array([[0.7], [1.4]]), [0.2, 0.3, 0.4])),
    )


def test_data_arrays_are_taken_together_along_their_dimensions() -> None:
    label = {"case": ["a", "b", "c"]}
    kappa = xr.DataArray([1.0, 20.0, 300.0], dims="case", coords=label, attrs={"units": "1"})
    psi = xr.DataArray([0.5, 1.0, 2.0], dims="case")
    found = sweep(kappa, psi, [0.0, 0.1], chunks={"case": 2}).compute()
    assert found.eps_t.dims == ("case", "damping")
    assert found.case.values.tolist() == ["a", "b", "c"]
    assert found.kappa.dims == found.psi.dims == ("case",)
    np.testing.assert_array_equal(
        found.eps_t, stickslip.eps_t(kappa.values[:, None], psi.values[:, None], [0.0, 0.1])
    )


def test_data_arrays_in_another_order_of_dimensions() -> None:
    kappa = xr.DataArray(np.linspace(1, 60, 12).reshape(3, 4), dims=("x", "y"))
    psi = xr.DataArray(np.linspace(0.1, 3, 12).reshape(4, 3), dims=("y", "x"))
    damping = xr.DataArray(np.array([0.0, 0.1, 0.2, 0.3]), dims="y")
    found = sweep(kappa, psi, damping, chunks={"x": 2, "y": 3}).compute()
    assert found.eps_t.dims == ("x", "y")
    np.testing.assert_array_equal(
        found.eps_t, stickslip.eps_t(kappa.values, psi.values.T, damping.values)
    )


def test_coordinates_of_another_sweep_are_parameters() -> None:
    first = sweep(KAPPA, PSI)
    again = sweep(first.kappa, first.psi)
    xr.testing.assert_identical(first, again)
    # A coordinate that is left over from a selection is none of this sweep's.
    one = sweep(5.0, first.psi.sel(psi=0.05))
    assert one.eps_t.dims == ()
    point = sweep(first.isel(psi=3).kappa, 2.0)
    assert float(point.psi) == 2.0


def test_strange_but_good_parameters() -> None:
    values = [5.0, 1.0, np.nan, np.inf, -1.0, 0.0, 5.0]
    found = sweep(values, da.from_array(np.array([0.5, 1.0]), chunks=1))
    many = stickslip.collide_many(np.array(values)[:, None], [0.5, 1.0], errors="nan")
    np.testing.assert_array_equal(found.eps_t, many.eps_t)
    np.testing.assert_array_equal(found.switch_count, many.switch_count)
    assert (found.switch_count.values[2:5] == -1).all()
    # Without a spring, nothing switches.
    assert (found.switch_count.values[5] == 0).all()
    np.testing.assert_array_equal(found.eps_t[0], found.eps_t[-1])
    masked = sweep(np.ma.masked_array([1.0, 2.0], [False, True]), 1.0)
    assert np.isnan(masked.eps_t.values).tolist() == [False, True]
    assert np.isnan(sweep(1.0, ratio=0.5, mu=0.0).eps_t)


@pytest.mark.parametrize(
    "kappa",
    [
        range(1, 4),
        (1, 2, 3),
        np.array([1, 2, 3], dtype=">f8"),
        np.array([1, 2, 3], dtype="f2"),
        np.array([1, 2, 3], dtype="u1"),
        np.longdouble([1, 2, 3]),
        np.array([3.0, 9.0, 2.0, 9.0, 1.0])[::-2],
        da.from_array(np.array([1.0, 2.0, 3.0]), chunks=2),
        xr.DataArray([1.0, 2.0, 3.0], dims="x").chunk(1),
        xr.DataArray([1.0, 2.0, 3.0], dims="x").stack(z=["x"]),
        xr.DataArray([1, 2, 3], dims="a/b", name="complete"),
    ],
)
def test_strange_types(tmp_path: Path, kappa: Any) -> None:
    expected = stickslip.eps_t([1.0, 2.0, 3.0], 0.5)
    np.testing.assert_array_equal(sweep(kappa, 0.5).eps_t, expected)
    np.testing.assert_array_equal(sweep(kappa, 0.5, chunks=2).eps_t, expected)
    if not (isinstance(kappa, xr.DataArray) and "z" in kappa.dims):
        np.testing.assert_array_equal(write_sweep(tmp_path / "s", kappa, 0.5).eps_t, expected)


@pytest.mark.parametrize("chunks", [None, "auto", 1, {}])
@pytest.mark.parametrize(
    ("kappa", "psi", "shape"),
    [(3.0, 1.0, ()), ([3.0], 1.0, (1,)), ([], [1.0, 2.0], (0, 2)), ([1.0, 2.0], [], (2, 0))],
)
def test_sizes_0_and_1(tmp_path: Path, kappa: Any, psi: Any, shape: Any, chunks: Any) -> None:
    eager = sweep(kappa, psi, quantities=ALL)
    assert eager.eps_t.shape == shape
    xr.testing.assert_identical(eager, sweep(kappa, psi, quantities=ALL, chunks=chunks).compute())
    if chunks is not None:
        stored = write_sweep(tmp_path / "s", kappa, psi, quantities=ALL, chunks=chunks)
        assert digest(stored) == digest(eager)
        assert stored.complete == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"psi": None}, "exactly one of psi and ratio"),
        ({"ratio": [1.0]}, "exactly one of psi and ratio"),
        ({"mu": 0.3}, "mu and alpha have no effect"),
        ({"kappa": np.ones((2, 2))}, "kappa has 2 dimensions without names"),
        ({"kappa": ["1.0"]}, "kappa has the type <U3"),
        ({"kappa": [1j]}, "kappa has the type complex128"),
        ({"kappa": [True]}, "kappa has the type bool"),
        ({"kappa": "1"}, "kappa has the type"),
        ({"kappa": None}, "kappa has the type object"),
        ({"kappa": xr.Dataset()}, "kappa is a Dataset"),
        ({"kappa": xr.DataArray([1.0], dims="k", attrs={"units": "N/m"})}, "has the units 'N/m'"),
        ({"kappa": xr.DataArray([1.0], dims=[3])}, "expected different names"),
        ({"kappa": xr.DataArray([1.0], dims="eps_t")}, "has the dimension 'eps_t'"),
        ({"kappa": xr.DataArray([1.0], dims="mu")}, "has the dimension 'mu'"),
        ({"kappa": xr.DataArray([1.0], dims="psi"), "psi": 1.0}, "has the dimension 'psi'"),
        ({"kappa": xr.DataArray([[1.0]], dims=["kappa", "x"])}, "has the dimension 'kappa'"),
        ({"kappa": xr.DataArray([1.0] * 5, dims="psi")}, "psi has 2 values along psi; expected 5"),
        (
            {"kappa": xr.DataArray([1.0, 2.0], dims="psi", coords={"psi": [3.0, 4.0]})},
            "given at other values of psi",
        ),
        ({"quantities": ()}, "expected some of eps_t"),
        ({"quantities": ("eps",)}, "expected some of eps_t"),
        ({"quantities": ("eps_t", "eps_t")}, "each once"),
        ({"method": "euler"}, 'expected "auto", "exact"'),
        ({"method": "exact", "rtol": 1e-9}, "has no effect"),
        ({"rtol": -1.0}, "rtol = -1.0 is out of range"),
        ({"errors": "ignore"}, "errors = 'ignore'"),
        ({"threads": 0}, "threads = 0"),
        ({"threads": 0, "chunks": 1}, "threads = 0"),
        ({"chunks": 0}, "expected at least 1"),
        ({"chunks": 1.5}, "float"),
        ({"chunks": "128MiB"}, 'expected "auto"'),
        ({"chunks": {"x": 3}}, "chunks along 'x'"),
        ({"kappa": np.ones(10**5 + 1), "chunks": 1}, "makes 200002 blocks"),
    ],
)
def test_what_is_refused(change: dict[str, Any], message: str) -> None:
    parameters: dict[str, Any] = {"kappa": [1.0, 2.0], "psi": [1.0, 2.0]}
    with pytest.raises((ValueError, TypeError), match=message):
        sweep(**(parameters | change))


def test_labels_that_differ_are_refused() -> None:
    kappa = xr.DataArray([1.0, 2.0], dims="case", coords={"case": [1, 2]})
    psi = xr.DataArray([1.0, 2.0], dims="case", coords={"case": [2, 1]})
    with pytest.raises(ValueError, match="case"):
        sweep(kappa, psi)


@pytest.mark.parametrize("chunks", [None, 1])
def test_errors_are_raised(chunks: Any) -> None:
    with pytest.raises(ValueError, match=r"^kappa = -2.0, psi = 0.5.*out of range"):
        sweep([1.0, -2.0], 0.5, errors="raise", chunks=chunks).compute()


# Stores


def test_store_is_the_sweep(tmp_path: Path) -> None:
    calls: list[tuple[int, int]] = []
    store = tmp_path / "not there" / "ä sweep%20?.zarr"
    stored = write_sweep(
        store, **SMALL, quantities=ALL, progress=lambda done, all: calls.append((done, all))
    )
    assert calls == [(number, 9) for number in range(1, 10)]
    eager = sweep(KAPPA, PSI, quantities=ALL)
    assert digest(stored) == digest(eager)
    assert set(eager.attrs.items()) < set(stored.attrs.items())
    assert ("fused" in stored.rounding) == stickslip._native.has_fused_products()
    stored.attrs = eager.attrs
    xr.testing.assert_identical(eager, stored.load())
    assert os.listdir(store.parent) == [store.name]
    # One block is one chunk, and nothing is written twice.
    before = files(store)
    assert len(before) == 9 * len(ALL)
    assert digest(write_sweep(str(store), **SMALL, quantities=ALL)) == digest(eager)
    assert files(store) == before


@pytest.mark.filterwarnings("ignore:The data type", "ignore:The codec")
def test_store_of_labels_and_several_dimensions(tmp_path: Path) -> None:
    kappa = xr.DataArray(
        np.linspace(1, 60, 12).reshape(3, 4), dims=("x", "y"), coords={"x": ["a", "b", "c"]}
    )
    # As it comes from a file in which it was packed.
    kappa.encoding = {"dtype": "i2", "scale_factor": 0.5, "chunks": (1, 1)}
    parameters: dict[str, Any] = {
        "kappa": kappa,
        "ratio": xr.DataArray([0.5, np.nan, 1.0, 2.0], dims="y"),
        "mu": [0.3, 0.4],
    }
    stored = write_sweep(tmp_path / "s", **parameters, chunks={"x": 2, "y": 3})
    assert digest(stored) == digest(sweep(**parameters))
    write_sweep(tmp_path / "s", **parameters, chunks={"x": 2, "y": 3})


def damage_nothing(store: Path) -> None:
    (store / "eps_t/c/1/0.1234.partial").write_bytes(b"half")


def delete_chunk(store: Path) -> None:
    (store / "eps_t/c/1/0").unlink()


def truncate_chunk(store: Path) -> None:
    path = store / "switch_count/c/1/0"
    path.write_bytes(path.read_bytes()[:20])


def empty_chunk(store: Path) -> None:
    (store / "eps_t/c/1/0").write_bytes(b"")


def swap_chunk(store: Path) -> None:
    # As after a crash of the file system, with a chunk that still decodes: that of its neighbour.
    shutil.copy(store / "eps_t/c/0/0", store / "eps_t/c/1/0")


def delete_mark(store: Path) -> None:
    (store / "_blocks/digest/c/1/0").unlink()


def spoil_mark(store: Path) -> None:
    (store / "_blocks/digest/c/1/0").write_bytes(b"1234567")


@pytest.mark.parametrize(
    ("damage", "again"),
    [
        (damage_nothing, 0),
        (delete_chunk, 1),
        (truncate_chunk, 1),
        (empty_chunk, 1),
        (swap_chunk, 1),
        (delete_mark, 1),
        (spoil_mark, 1),
    ],
)
def test_damaged_blocks_are_computed_again(tmp_path: Path, damage: Any, again: int) -> None:
    store = tmp_path / "s"
    whole = digest(write_sweep(store, **SMALL))
    before = files(store)
    damage(store)
    assert digest(write_sweep(store, **SMALL)) == whole
    after = files(store)
    changed = {name for name in before if before[name] != after[name]}
    assert len(changed) == 2 * again
    assert all("c/1/0" in name for name in changed)


def test_damage_is_never_read_as_another_result() -> None:
    bench = runpy.run_path(str(Path(__file__).parents[1] / "benches/damaged_stores.py"))
    became = bench["battery"](60)
    assert became["wrong"] == 0 and became["refused"] > 5 and became["as written"] > 5, became


@pytest.mark.parametrize("name", ["zarr.json", "eps_t/zarr.json", "_blocks/zarr.json"])
def test_damaged_metadata_are_named(tmp_path: Path, name: str) -> None:
    write_sweep(tmp_path / "s", **SMALL)
    path = tmp_path / "s" / name
    path.write_text(path.read_text().replace(":", ";", 1))
    with pytest.raises(OSError, match="is damaged in its metadata"):
        write_sweep(tmp_path / "s", **SMALL)


def test_damaged_coordinates_are_refused(tmp_path: Path) -> None:
    write_sweep(tmp_path / "s", **SMALL)
    (tmp_path / "s/kappa/c/1").unlink()
    with pytest.raises(ValueError, match="kappa has other values"):
        write_sweep(tmp_path / "s", **SMALL)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kappa": KAPPA + 1e-14}, "kappa has other values"),
        ({"kappa": KAPPA[:-1]}, "kappa has other values"),
        ({"kappa": 3.0, "chunks": {"psi": 7}}, "kappa has other values"),
        ({"damping": 0.1}, "damping has other values"),
        ({"psi": None, "ratio": PSI, "chunks": {}}, "parameters is .*ratio"),
        ({"method": "dop853"}, "method is 'dop853', in the store 'auto'"),
        ({"rtol": 1e-9}, "rtol is 1e-09, in the store None"),
        ({"law": "gran/hertz/history"}, "law is 'gran/hertz/history', in the store None"),
        ({"tangential_damping": 0.5}, "law is 'paper', in the store None"),
        ({"quantities": ("eps_t",)}, "quantities is"),
        ({"chunks": 10}, r"chunks are \(10, 10\), in the store \(10, 7\)"),
    ],
)
def test_another_sweep_is_refused(tmp_path: Path, change: dict[str, Any], message: str) -> None:
    store = tmp_path / "s"
    whole = digest(write_sweep(store, **SMALL))
    with pytest.raises(ValueError, match=f"of another sweep: {message}"):
        write_sweep(store, **(SMALL | change))
    assert digest(write_sweep(store, **SMALL)) == whole


def test_what_is_no_store_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    (tmp_path / "full").mkdir()
    (tmp_path / "full/mine").write_text("mine")
    for name in ("file", "full"):
        with pytest.raises(ValueError, match="expected 'stickslip.sweep/1', or nothing there"):
            write_sweep(tmp_path / name, **SMALL)
    sweep(KAPPA, PSI).drop_attrs(deep=False).to_zarr(tmp_path / "other", consolidated=False)
    with pytest.raises(ValueError, match="schema None"):
        write_sweep(tmp_path / "other", **SMALL)
    with pytest.raises(ValueError, match="expected a path"):
        write_sweep("s3://bucket/sweep.zarr", **SMALL)
    with pytest.raises(OSError, match="file"):
        write_sweep(tmp_path / "file" / "below", **SMALL)
    (tmp_path / "empty").mkdir()
    assert write_sweep(tmp_path / "empty", **SMALL).complete == 1


def test_another_build_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "s"
    write_sweep(store, **SMALL)
    build = _stores.build_of_process()
    for change in ({"stickslip_version": "0.0.9"}, {"rounding": "separate products"}):
        with monkeypatch.context() as patch:
            patch.setattr(_stores, "build_of_process", lambda change=change: build | change)
            with pytest.raises(ValueError, match="last digits differ"):
                write_sweep(store, **SMALL)
    write_sweep(store, **SMALL)


def test_worker_that_does_not_see_the_store(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="all workers must see the same files"):
        _stores.write_block(str(tmp_path / "s"), (0, 0), "nan", None)
    assert not os.listdir(tmp_path)


def test_errors_of_stores(tmp_path: Path) -> None:
    parameters: dict[str, Any] = {"kappa": [1.0, 2.0, -3.0, 4.0], "psi": 0.5, "chunks": 1}
    store = tmp_path / "s"
    with pytest.raises(ValueError, match="kappa = -3.0"):
        write_sweep(store, **parameters, errors="raise")
    assert len(files(store)) == 4
    stored = write_sweep(store, **parameters)
    assert digest(stored) == digest(sweep(parameters["kappa"], 0.5))
    with pytest.raises(ValueError, match="kappa = -3.0"):
        write_sweep(store, **parameters, errors="raise")


def test_two_clients_write_one_store(tmp_path: Path) -> None:
    store, failures = tmp_path / "s", []

    def write() -> None:
        try:
            write_sweep(store, **SMALL)
        except Exception as error:
            failures.append(error)

    clients = [threading.Thread(target=write) for _ in range(4)]
    for client in clients:
        client.start()
    for client in clients:
        client.join()
    assert not failures
    assert digest(write_sweep(store, **SMALL)) == digest(sweep(KAPPA, PSI))
    assert os.listdir(tmp_path) == ["s"]


def test_store_that_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import zarr.storage._local as local

    put, room = local._put, [12]

    def full(*arguments: Any, **named: Any) -> Any:
        room[0] -= 1
        if room[0] < 0:
            raise OSError(28, "No space left on device")
        return put(*arguments, **named)

    monkeypatch.setattr(local, "_put", full)
    stops = 0
    while True:
        try:
            stored = write_sweep(tmp_path / "s", **SMALL)
        except OSError:
            assert os.listdir(tmp_path) in ([], ["s"])
            stops += 1
            room[0] = 12 + 3 * stops
        else:
            break
    assert stops > 2
    assert digest(stored) == digest(sweep(KAPPA, PSI))
    room[0] = 0
    assert digest(write_sweep(tmp_path / "s", **SMALL)) == digest(stored)


def test_killed_client_goes_on(tmp_path: Path) -> None:
    store = tmp_path / "s"
    body = f"""
        write_sweep(
            {str(store)!r}, np.linspace(0.5, 90, 60), np.linspace(0.05, 4, 50), method="dop853",
            chunks={{"kappa": 5}}, progress=lambda done, all: print(done, all, flush=True),
            threads=1,
        )
    """
    command = [sys.executable, "-c", script(body)]
    done, runs = 0, 0
    while done < 12:
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as client:
            assert client.stdout is not None
            for line in client.stdout:
                done = int(line.split()[0])
                if done >= 6 * (runs + 1) and done < 12:
                    client.send_signal(signal.SIGKILL)
                    break
        runs += 1
        assert client.returncode == (0 if done == 12 else -signal.SIGKILL)
        assert len(list(store.glob("_blocks/digest/c/*/*"))) >= done
    assert runs == 2
    found = xr.open_zarr(store, consolidated=False)
    expected = sweep(np.linspace(0.5, 90, 60), np.linspace(0.05, 4, 50), method="dop853")
    assert found.complete == 1
    assert digest(found) == digest(expected)


# Clusters


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    )
    with cluster, distributed.Client(cluster) as connected:
        yield connected


def test_lazy_on_a_cluster(client: Any) -> None:
    xr.testing.assert_identical(
        sweep(KAPPA, PSI, quantities=ALL), sweep(**SMALL, quantities=ALL).compute()
    )
    with pytest.raises(ValueError, match=r"^kappa = -2.0"):
        sweep([1.0, -2.0], 0.5, errors="raise", chunks=1).compute()


def test_errors_on_a_cluster(client: Any, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="kappa = -2.0"):
        write_sweep(tmp_path / "s", [1.0, -2.0], 0.5, errors="raise", chunks=1, client=client)
    stored = write_sweep(tmp_path / "s", [1.0, -2.0], 0.5, chunks=1, client=client)
    assert digest(stored) == digest(sweep([1.0, -2.0], 0.5))


def test_killed_workers_lose_nothing(client: Any, tmp_path: Path) -> None:
    parameters: dict[str, Any] = {
        "kappa": np.linspace(0.5, 90, 120),
        "psi": np.linspace(0.05, 4, 100),
        "method": "dop853",
    }
    killed: list[int] = []

    def kill(done: int, all: int) -> None:
        if done == 2:
            # The workers are asked by the scheduler: their processes may be new.
            pid = next(iter(client.run(os.getpid).values()))
            os.kill(pid, signal.SIGKILL)
            killed.append(pid)

    stored = write_sweep(
        tmp_path / "s", **parameters, chunks={"kappa": 7, "psi": 60}, client=client, progress=kill
    )
    assert len(killed) == 1
    assert digest(stored) == digest(sweep(**parameters))
    assert stored.complete == 1


def test_workers_with_threads(tmp_path: Path) -> None:
    with distributed.Client(
        processes=False, n_workers=1, threads_per_worker=4, dashboard_address=":0"
    ) as threaded:
        stored = write_sweep(tmp_path / "s", **SMALL, method="dop853", client=threaded)
    assert digest(stored) == digest(sweep(KAPPA, PSI, method="dop853"))


def test_example_for_slurm(client: Any, tmp_path: Path) -> None:
    example = runpy.run_path(str(Path(__file__).parents[1] / "examples/slurm.py"))
    found = example["compute"](str(tmp_path / "s"), 12, client)
    assert found.complete == 1
    assert dict(found.sizes) == {"kappa": 12, "psi": 12, "damping": 5}


def test_page_of_the_documentation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = Path(__file__).parents[2] / "docs/python/sweeps.md"
    if not page.exists():
        pytest.skip("without the repository")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    assert len(blocks) >= 8
    for block in blocks:
        exec(block, names)


def test_worker_of_another_build_is_refused(tmp_path: Path) -> None:
    if "_x86_64_v3" not in str(stickslip._native.__file__):
        pytest.skip("there is one build only")
    store = tmp_path / "s"
    with pytest.raises(ValueError, match="kappa = -2.0"):
        write_sweep(store, [-2.0, 1.0], 0.5, errors="raise", chunks=1)
    body = f"""
        from distributed import Client, LocalCluster
        cluster = LocalCluster(
            n_workers=1, threads_per_worker=1, dashboard_address=":0",
            env={{"STICKSLIP_PORTABLE": "1"}},
        )
        with cluster, Client(cluster) as client:
            try:
                write_sweep({str(store)!r}, [-2.0, 1.0], 0.5, chunks=1, client=client)
            except ValueError as error:
                assert "separate products" in str(error), error
                assert "has results of stickslip" in str(error), error
            else:
                sys.exit("no error")
            # The store is of the workers' build, not of the client's.
            found = write_sweep({str(store) + "2"!r}, [-2.0, 1.0], 0.5, chunks=1, client=client)
            assert "separate" in found.rounding
    """
    path = tmp_path / "program.py"
    path.write_text(script(body))
    subprocess.run([sys.executable, path], check=True)
