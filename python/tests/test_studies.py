"""Studies and maps."""

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import stickslip


def test_stiff_springs(tmp_path: Path) -> None:
    study = stickslip.asymptote((10, 1e5), [0.3])
    assert study.findings and not study.objections
    assert all(svg.startswith("<svg") for svg in study.pictures.values())
    table = next(iter(study.tables.values()))
    assert set(table.columns) == set(table.meanings)
    study.save(tmp_path)
    names = {one.name for one in tmp_path.iterdir()}
    assert f"{study.name}.json" in names and f"{table.name}.csv" in names
    assert json.loads((tmp_path / f"{study.name}.json").read_text())["findings"] == study.findings
    with pytest.raises(ValueError, match="psi has 0 values"):
        stickslip.asymptote(psi=[])
    with pytest.raises(ValueError, match="kappa 1"):
        stickslip.asymptote((1, 2))


def test_convergence() -> None:
    study = stickslip.converge([(18, 0.4, 0), (63, 0.5, 0.1)])
    assert "<h3>" in study._repr_html_() and study.data
    with pytest.raises(ValueError, match="0 collisions"):
        stickslip.converge([])
    with pytest.raises(ValueError, match="kappa"):
        stickslip.converge([(1e7, 0.4, 0)])


def test_contact_laws() -> None:
    study = stickslip.contact_laws(damping=0.1, cells=6)
    table = study.tables["contact_laws"]
    assert len(study.pictures) == 2 * len(table.rows)
    listed = {name for names in table.columns["names"] for name in names.split(", ")}
    named = stickslip.laws().items()
    assert listed == {name for name, known in named if known.law["normal"] in ("linear", "hertz")}
    for names, largest, kappa, psi in (
        (row["names"], row["largest"], row["at_kappa"], row["at_psi"])
        for row in (dict(zip(table.meanings, row, strict=True)) for row in table.rows)
    ):
        alone = stickslip.collide(kappa, psi, law=names.split(", ")[0])
        assert abs(alone.eps_t) == pytest.approx(largest, rel=0, abs=1e-12)
    for wrong in ({"cells": 0}, {"damping": -0.1}, {"damping": float("nan")}, {"threads": 0}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            stickslip.contact_laws(**wrong)  # type: ignore[arg-type]


def test_parts_of_the_paper() -> None:
    titles = stickslip.reproduction_parts()
    assert len(titles) == 10
    figure = stickslip.reproduce(titles[0], cells=20)
    assert figure.pictures and not figure.objections
    for part, words in [(10, "part = 10"), ("Figure 99", "expected one of")]:
        with pytest.raises(ValueError, match=words):
            stickslip.reproduce(part)
    with pytest.raises(ValueError, match="cells = 0"):
        stickslip.reproduce(0, cells=0)


def test_maps() -> None:
    found = stickslip.map((0, 20), (0, 3), (30, 20), 0.1)
    assert found["eps_t"].dims == ("psi", "kappa") and found["eps_t"].shape == (20, 30)
    assert found["kappa"].attrs["units"] == "1"
    assert found["kappa"].values[0] == 20 * (0.5 / 30)
    at = found.isel(psi=7, kappa=11)
    one = stickslip.collide(float(at["kappa"]), float(at["psi"]), 0.1)
    assert (float(at["eps_t"]), int(at["switch_count"])) == (one.eps_t, one.switch_count)
    ratios = stickslip.map((0, 20), ratio=(0, 3.5), size=(5, 4))
    assert ratios["eps_t"].dims == ("ratio", "kappa")
    assert np.array_equal(ratios["psi"], stickslip.psi_of_ratio(ratios["ratio"]))
    for arguments, words in [
        ({"kappa": (0, 20)}, "exactly one of psi and ratio"),
        ({"kappa": (20, 0), "psi": (0, 3)}, "expected 0 <= LO < HI"),
        ({"kappa": (0, 20), "psi": (0, 3), "size": (0, 3)}, "cells = 0"),
    ]:
        with pytest.raises(ValueError, match=words):
            stickslip.map(**arguments)  # type: ignore[arg-type]


def test_all_parts_are_on_one_page(tmp_path: Path) -> None:
    told = []
    with warnings.catch_warnings():
        # Maps of twenty cells are too coarse for some statements.
        warnings.simplefilter("ignore", stickslip.AtlasWarning)
        page = stickslip.reproduce(
            tmp_path / "out", cells=20, progress=lambda done, steps, doing="": told.append(done)
        )
    assert page == tmp_path / "out/index.html" and told[-1] == 11
    text = page.read_text()
    titles = stickslip.reproduction_parts()
    assert all(title in text for title in titles) and text.count("<svg") >= len(titles)
    study = stickslip.reproduce(0, cells=20)
    assert all((tmp_path / f"out/{name}.svg").exists() for name in study.pictures)
