"""What all results have: short texts, copies, pictures, and tables of other libraries."""

import copy
import dataclasses
import inspect
import pickle
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from results import MADE, family, of

import stickslip
from stickslip import _atlas_results

mpl.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

#: An address means nothing in another process.
NOT_PICKLED = {"Compiled"}
DRAWN = [name for name in MADE if hasattr(getattr(stickslip, name), "plot")]
TABULAR = [name for name in MADE if hasattr(getattr(stickslip, name), "to_pandas")]


@pytest.fixture(autouse=True)
def _close() -> Any:
    yield
    plt.close("all")


def test_every_public_type_is_here() -> None:
    types = {
        name
        for name in stickslip.__all__
        if inspect.isclass(getattr(stickslip, name))
        and not issubclass(getattr(stickslip, name), BaseException)
    }
    assert types - NOT_PICKLED == set(MADE)
    assert {"Collision", "Collisions", "Fit", "Impacts", "Solution", "Study", "Table"} < set(DRAWN)
    assert {"Collision", "Collisions", "Solution", "Table", "TimeSteps"} < set(TABULAR)


@pytest.mark.parametrize("name", list(MADE))
def test_texts_are_short(name: str) -> None:
    text = repr(of(name))
    assert 1 <= len(text.splitlines()) <= 10 and len(text) < 1000
    assert " object at 0x" not in text


@pytest.mark.parametrize("name", list(MADE))
def test_copies_are_equal(name: str) -> None:
    one = of(name)
    for other in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), copy.copy(one)):
        assert type(other) is type(one) and repr(other) == repr(one)
        for field in dataclasses.fields(one) if dataclasses.is_dataclass(one) else ():
            assert repr(getattr(other, field.name)) == repr(getattr(one, field.name))


def test_copies_compute_the_same() -> None:
    bodies = pickle.loads(pickle.dumps(of("Bodies")))
    assert bodies.contacts(1.5, 1.0) == of("Bodies").contacts(1.5, 1.0)
    for name, at in (("RestitutionTable", (1.5, 1.2)), ("VelocityTable", (1.5, 1.0))):
        table = pickle.loads(pickle.dumps(of(name)))
        assert table.eps_t(*at) == of(name).eps_t(*at) and table.region(*at) == of(name).region(*at)
        assert table.largest_error == of(name).largest_error
    steps = copy.deepcopy(of("TimeSteps"))
    assert steps.largest_step(0.01) == of("TimeSteps").largest_step(0.01) == 1 / 100
    assert steps.picture() == of("TimeSteps").picture()
    assert pickle.loads(pickle.dumps(of("Fit"))).minima == of("Fit").minima
    for one in (of("HybridFamily"), family()):
        other = pickle.loads(pickle.dumps(one))
        assert other.label(0.6, 0.55) == one.label(0.6, 0.55) == family().label(0.6, 0.55)


def test_the_motions_of_a_file_are_pickled() -> None:
    path = Path(__file__).parents[2] / "tests" / "data"
    files = [file for file in path.glob("**/*.json") if '"spheres"' in file.read_text()]
    motion = {"position_m": [0, 0, 0], "velocity_m_per_s": [0, 0, -1.0]}
    material = {"young_modulus_pa": 63e9, "poisson_ratio": 0.24, "density_kg_per_m3": 2500}
    one = {"radius_m": 0.0015, "material": material, "motion": motion}
    wall = {"rigid": True, "motion": {"point_m": [0, 0, -0.0015], "normal": [0, 0, 1.0]}}
    surface = {"friction": 0.3, "tangential_stiffness_kg_per_s2": 5e6}
    read = stickslip.Bodies.read({"spheres": [one], "wall": wall, "surface": surface})
    for bodies in (read, *(stickslip.Bodies.read(file) for file in files)):
        assert copy.deepcopy(bodies).encounter() == bodies.encounter()


def test_compiled_functions_are_copied() -> None:
    from ctypes import CFUNCTYPE, POINTER, c_double

    array = POINTER(c_double)
    function = CFUNCTYPE(None, c_double, array, array, array)(lambda *_: None)
    one = stickslip.Compiled(function, [1.0, 2.0])
    one.direction = 1.0
    other = copy.deepcopy([one])[0]
    other.direction = -1.0
    assert (one.address, one.direction) == (other.address, 1.0)
    assert np.array_equal(copy.copy(one).parameters, [1.0, 2.0])


def axes_of(drawn: Any) -> list[Any]:
    return list(drawn) if isinstance(drawn, list) else [drawn]


@pytest.mark.parametrize("name", DRAWN)
def test_pictures(name: str) -> None:
    """Every axis has a label, and everything is inside the figure."""
    drawn = axes_of(of(name).plot())
    figure = drawn[0].figure
    renderer = figure.canvas.get_renderer()
    figure.draw(renderer)
    assert all(ax.get_ylabel() for ax in figure.axes) and drawn[-1].get_xlabel()
    box = figure.get_tightbbox(renderer)
    width, height = figure.get_size_inches()
    assert box.x0 > -0.02 and box.y0 > -0.02 and box.x1 < width + 0.02 and box.y1 < height + 0.02
    for ax in drawn:
        assert ax.lines or ax.collections
        if name not in {"Atlas", "FamilyAtlas"}:
            # A legend is beside its axes, and names what is drawn there.
            legend = ax.get_legend()
            assert legend is None or legend.get_window_extent(renderer).y0 >= ax.bbox.y1


@pytest.mark.parametrize("name", DRAWN)
def test_pictures_in_axes_of_ones_own(name: str) -> None:
    ax = plt.figure().add_subplot()
    assert set(axes_of(of(name).plot(ax))) == {ax}
    assert len(plt.get_fignums()) == 1


def test_pictures_of_several_panels() -> None:
    collision = of("Collision")
    _, given = plt.subplots(2)
    assert collision.plot(given, linewidth=3) == list(given)
    assert given[1].lines[-1].get_linewidth() == 3
    with pytest.raises(ValueError, match="ax has 3 axes; expected one, or 2"):
        collision.plot(plt.subplots(3)[1])
    found = of("Solution")
    assert len(found.plot(components=[1])) == 1
    with pytest.raises(ValueError, match="components: 2; expected 0 to 1"):
        found.plot(components=[2])


def test_solutions_show_jumps_and_events() -> None:
    found = of("Solution")
    _, speed = found.plot()
    times, states = speed.lines[0].get_data()
    for event in found.events:
        (before, _, after) = np.flatnonzero(times == event["time"])
        assert (states[before], states[after]) == (event["before"][1], event["after"][1])
        assert np.isnan(states[before + 1])
    # Without a dense output the run is repeated; without formulas there are the steps.
    for options, least in (({}, 60), ({"record": False}, 5)):
        other = stickslip.solve(of("HybridSystem"), (0.0, 2.6), [4.905, 0.0], **options)
        assert other.plot()[0].lines[0].get_xdata().size >= least


def test_arrays_of_collisions_are_drawn_over_what_varies() -> None:
    kappa, psi = np.linspace(1, 10, 8), np.linspace(0.1, 1, 6)[:, None]
    grid = stickslip.collide_many(kappa, psi).plot()
    assert grid.get_xlabel().startswith("scaled stiffness") and grid.get_xscale() == "linear"
    points = stickslip.collide_many(kappa, np.sqrt(kappa), 0.1).plot()
    assert points.get_ylabel().startswith("impact ratio")
    many = stickslip.collide_many(kappa, psi, np.array([0.0, 0.1])[:, None, None])
    with pytest.raises(ValueError, match="vary"):
        many.plot()
    assert many._repr_svg_() is None and "<svg" in stickslip.collide_many(kappa, psi)._repr_svg_()


@pytest.mark.parametrize("name", ["Stack", "FamilyStack"])
def test_stacks_show_numbers_of_regions(name: str) -> None:
    found = of(name)
    ax = _atlas_results.stack(found, None, {}, "end")
    assert ax.get_xlabel() == "end" and len(ax.lines[0].get_xdata()) == len(found.layers)
    counts = ax.lines[0].get_ydata()
    assert list(counts) == [_atlas_results._regions(layer) for layer in found.layers]
    assert len(ax.lines) >= 1 + len(found.changes)


@pytest.mark.parametrize("name", ["Atlas", "FamilyAtlas"])
def test_atlases_have_rows(name: str) -> None:
    columns = _atlas_results.regions(of(name))
    assert {len(column) for column in columns.values()} == {len(of(name).regions)}
    assert list(columns["itinerary"]) == [str(one.itinerary) for one in of(name).regions]


def test_tables_choose_columns() -> None:
    table = of("Table")
    assert table.plot(x="steps", y="time_error", by=["method"]).get_xlabel().startswith("steps: ")
    assert of("Study").plot(table="convergence_tolerances").get_legend() is not None
    for arguments, words in (
        ({"x": "nothing"}, "'nothing' is no column"),
        ({"y": "outcome"}, "has no numbers"),
    ):
        with pytest.raises(ValueError, match=words):
            table.plot(**arguments)
    with pytest.raises(ValueError, match="x and y are missing"):
        of("Study").tables["convergence_events"].plot()
    with pytest.raises(ValueError, match="table = 'none'"):
        of("Study").plot(table="none")


@pytest.mark.parametrize("name", [name for name in DRAWN if name != "DenseOutput"])
def test_notebooks_show_pictures(name: str) -> None:
    one = of(name)
    show = one._repr_svg_ if hasattr(one, "_repr_svg_") else one._repr_html_
    shown = show()
    assert "<svg" in shown or "<table" in shown
    assert show() == shown


def test_maps_are_drawn_by_xarray() -> None:
    found = stickslip.map((0, 20), (0, 3), (6, 5))
    drawn = found["eps_t"].plot()
    assert drawn.axes.get_xlabel() == "scaled stiffness [1]"
    assert drawn.axes.get_ylabel() == "reduced impact ratio [1]"


@pytest.mark.parametrize("name", TABULAR)
def test_tables_of_other_libraries(name: str, tmp_path: Path) -> None:
    import pandas as pd
    import pyarrow.parquet as pq

    one = of(name)
    frame, dataset = one.to_pandas(), one.to_xarray()
    assert isinstance(frame, pd.DataFrame) and len(frame) > 0
    assert len(dataset.data_vars) > 0
    path = tmp_path / "rows.parquet"
    one.to_parquet(path)
    assert pq.read_table(path).num_rows == len(frame)
    assert [file.name for file in tmp_path.iterdir()] == ["rows.parquet"]


def test_columns_are_those_of_results() -> None:
    found = of("Solution")
    frame = found.to_pandas()
    assert list(frame) == ["time", "mode", "y0", "y1"] and np.array_equal(frame["y1"], found.y[1])
    states = found.to_xarray()["state"]
    assert states.dims == ("time", "component")
    assert np.array_equal(states.sel(component="y0"), found.y[0])
    course = of("Collision").to_pandas()
    assert "".join(dict.fromkeys(course["phase"])) == "+o-" and course["time"].iloc[0] == 0
    impacts = of("Impacts")
    assert impacts.to_xarray()["contact_time_s"].attrs["units"] == "s"
    assert np.array_equal(impacts.to_pandas()["eps_t"], impacts.eps_t)
    assert list(of("Fit").to_pandas()["mu"]) == [one.mu for one in of("Fit").minima]


def test_arrays_of_collisions_keep_their_shape() -> None:
    kappa, psi = np.linspace(1, 10, 4), np.linspace(0.1, 1, 3)[:, None]
    found = stickslip.collide_many(kappa, psi)
    dataset = found.to_xarray()
    assert dict(dataset.sizes) == {"psi": 3, "kappa": 4}
    assert float(dataset["eps_t"].sel(kappa=10.0, psi=0.1)) == found.eps_t[0, 3]
    assert dataset["kappa"].attrs["long_name"] == "scaled stiffness"
    together = stickslip.collide_many(kappa, np.sqrt(kappa)).to_xarray()
    assert dict(together.sizes) == {"dim_0": 4} and together["psi"].dims == ("dim_0",)
    assert dict(stickslip.collide_many(3.0, 0.5).to_xarray().sizes) == {}
    assert dict(stickslip.collide_many([], 0.5).to_xarray().sizes) == {"dim_0": 0}


def test_missing_libraries_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # They need pandas themselves.
    import xarray  # noqa: F401
    import zarr  # noqa: F401

    found = of("Solution")
    decay = stickslip.system("state x = 1\nx' = -x\nend = 1")
    for library, call in (
        ("pandas", found.to_pandas),
        ("pyarrow", lambda: found.to_parquet(tmp_path / "a")),
        ("matplotlib", found.plot),
        ("zarr", lambda: stickslip.write_sweep(tmp_path / "b", 1.0, 0.5)),
        ("xarray", found.to_xarray),
        ("xarray", lambda: stickslip.map((1, 2), (1, 2), (3, 3))),
        ("xarray", lambda: stickslip.sweep(1.0, 0.5)),
        ("xarray", lambda: stickslip.solve_many(decay)),
    ):
        for module in [one for one in sys.modules if one.partition(".")[0] == library]:
            monkeypatch.setitem(sys.modules, module, None)
        monkeypatch.setitem(sys.modules, library, None)
        with pytest.raises(ImportError, match=f"{library} is not .*pip install {library}"):
            call()
    assert found._repr_svg_() is None
