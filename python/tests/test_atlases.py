"""Atlases, against collisions."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import stickslip

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


@pytest.fixture(scope="module")
def atlas() -> stickslip.Atlas:
    return stickslip.trace((5, 20), (0.2, 2.5))


def test_regions_have_the_switches_of_their_collisions(atlas: stickslip.Atlas) -> None:
    assert atlas.objection is None and atlas.verification["agrees"]
    random = np.random.default_rng(1)
    kappa, psi = random.uniform(5, 20, 20_000), random.uniform(0.2, 2.5, 20_000)
    located = atlas.locate(kappa, psi)
    many = stickslip.collide_many(kappa, psi)
    inside = located.region >= 0
    assert inside.mean() > 0.999
    assert np.array_equal(located.itinerary[inside], many.itinerary[inside])
    assert np.array_equal(located.switch_count[inside], many.switch_count[inside])
    assert located.distance[inside].min() > 0


def test_points_of_boundaries_are_on_them(atlas: stickslip.Atlas) -> None:
    for boundary in atlas.boundaries:
        kappa, psi = boundary.points[len(boundary.points) // 2]
        if boundary.kind != "end-of-contact" or boundary.below != boundary.above:
            sides = stickslip.collide_many(kappa, [psi - 1e-7, psi + 1e-7]).itinerary
            assert set(sides) <= {boundary.below, boundary.above}


def test_places_of_every_shape(atlas: stickslip.Atlas) -> None:
    located = atlas.locate([[6.0], [30.0]], [1.0, 2.0, 3.0])
    assert located.region.shape == (2, 3)
    assert located.region[1].tolist() == [-2] * 3 and located.region[0, 2] == -2
    assert located.itinerary[0, 2] == "" and located.switch_count[0, 2] == -1
    # On the boundary itself the collision decides.
    assert located.itinerary[0, 1] == stickslip.collide(6.0, 2.0).itinerary
    with pytest.raises(ValueError, match="kappa = -1"):
        atlas.locate(-1, 1)


def test_files(atlas: stickslip.Atlas, tmp_path: Path) -> None:
    path = tmp_path / "atlas.json"
    atlas.save(path)
    assert [one.name for one in tmp_path.iterdir()] == ["atlas.json"]
    loaded = stickslip.Atlas.load(path)
    assert loaded.document == atlas.document == pickle.loads(pickle.dumps(atlas)).document
    assert loaded.geojson() == atlas.geojson()
    kinds = {one["properties"]["feature"] for one in atlas.geojson()["features"]}
    assert kinds == {"region", "boundary", "vertex"}
    for text, words in [
        ("{", "EOF"),
        ('{"schema": "other"}', 'schema is "other"'),
        (json.dumps(atlas.document | {"window": 3}), "window|invalid type"),
    ]:
        path.write_text(text)
        with pytest.raises(ValueError, match=words):
            stickslip.Atlas.load(path)


def test_pictures(atlas: stickslip.Atlas) -> None:
    assert atlas._repr_html_().startswith("<svg")
    axes = atlas.plot(linewidth=2)
    assert len(axes.lines) == len(atlas.boundaries) and axes.lines[0].get_linewidth() == 2
    assert axes.get_xlim() == (5, 20) and axes.texts
    assert atlas.plot(axes, labels=False) is axes
    matplotlib.pyplot.close("all")


def test_a_window_in_ratios() -> None:
    atlas = stickslip.trace((5, 8), ratio=(1.2, 1.6))
    assert atlas.window["ratio"] == [1.2, 1.6] and atlas.window["mu"] == 0.4
    assert atlas.window["psi"] == stickslip.psi_of_ratio([1.2, 1.6]).tolist()


def test_a_damped_window() -> None:
    atlas = stickslip.trace((5, 8), (0.8, 1.2), 0.1, threads=1)
    assert atlas.window["damping"] == 0.1 and atlas.objection is None


def test_bad_windows_are_named() -> None:
    for arguments, words in [
        ({"kappa": (5, 8)}, "exactly one of psi and ratio"),
        ({"kappa": (5, 8), "psi": (1, 2), "ratio": (1, 2)}, "exactly one"),
        ({"kappa": (-5, 8), "psi": (1, 2)}, "kappa = -5"),
        ({"kappa": (8, 5), "psi": (1, 2)}, "narrow|expected"),
        ({"kappa": (5, 8), "psi": (1, 2), "tolerance": 1.0}, "the tolerance 1.0"),
        ({"kappa": (5, 8), "psi": (1, 2), "damping": 1e-9}, "verified by integration"),
    ]:
        with pytest.raises(ValueError, match=words):
            stickslip.trace(**arguments)  # type: ignore[arg-type]
