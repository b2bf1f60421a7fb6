"""Arrays as users have them: fields of records, masked, of other types, written to later."""

import sys
import types
from typing import Any

import numpy as np
import pytest

import stickslip
from stickslip import HybridSystem, _native, solve


def records() -> np.ndarray:
    """Fields at odd places, which Rust cannot read where they lie."""
    table = np.zeros(3, [("id", "i1"), ("kappa", "f8"), ("psi", "f8")])
    table["kappa"], table["psi"] = [18.0, 63.0, 200.0], [0.4, 0.5, 0.6]
    return table


def test_fields_of_records() -> None:
    table = records()
    plain = [table[name].copy() for name in ("kappa", "psi")]
    assert not table["kappa"].flags.aligned
    expected = stickslip.eps_t(*plain)
    assert np.array_equal(stickslip.eps_t(table["kappa"], table["psi"]), expected)
    many = stickslip.collide_many(table["kappa"], table["psi"])
    assert np.array_equal(many.eps_t, expected)
    course = stickslip.collide(63, 0.5).history(table["psi"])
    assert np.array_equal(course, stickslip.collide(63, 0.5).history(plain[1]))
    with pytest.raises(ValueError, match="not aligned"):
        _native.eps_t(
            (table["kappa"], plain[1], plain[1]), ("exact", None, None), ("paper", 0.0), True, 1
        )


def test_a_right_hand_side_may_return_a_field() -> None:
    table = np.zeros(2, [("id", "i1"), ("rate", "f8")])

    def decay(t: float, y: np.ndarray) -> np.ndarray:
        table["rate"] = -y
        return table["rate"]

    found = solve(decay, (0, 1), [1.0, 2.0], rtol=1e-10)
    assert np.allclose(found.y[:, -1], np.array([1.0, 2.0]) * np.exp(-1), rtol=1e-8)


def test_results_keep_their_own_parameters() -> None:
    kappa, psi = np.array([18.0, 63.0]), np.array([0.5, 0.5])
    many = stickslip.collide_many(kappa, psi)
    before = many[0].eps_t
    kappa[:], psi[:] = -1.0, np.nan
    assert many.kappa.tolist() == [18.0, 63.0] and many.psi.tolist() == [0.5, 0.5]
    assert many[0].eps_t == before == many.eps_t[0]


def test_masked_values_are_none() -> None:
    kappa = np.ma.array([18.0, 63.0, 200.0], mask=[False, True, False])
    found = stickslip.eps_t(kappa, 0.5, errors="nan")
    assert np.isnan(found[1]) and np.isfinite(found[[0, 2]]).all()


def test_another_thread_imports_what_masks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numpy.ma", types.ModuleType("numpy.ma"))
    assert stickslip.eps_t([3.0], 0.4)[0] == stickslip.collide(3.0, 0.4).eps_t


def test_masked_values_are_none_everywhere() -> None:
    two = np.ma.array([1, 2], mask=[False, True])
    assert np.isnan(stickslip.psi_of_ratio(two)).tolist() == [False, True]
    assert np.isnan(stickslip.map((1, 2), (1, 2), (1, 1)).eps_t).sum() == 0
    assert np.isnan(stickslip.sweep(kappa=two, psi=0.5).eps_t).values.tolist() == [False, True]
    run = stickslip.solve(lambda t, y: -y, (0, 3), [1.0], dense_output=True)
    assert run.sol is not None and run.sol.mode(two).tolist() == ["", ""]
    assert np.isnan(run.sol(two)).tolist() == [[False, True]]
    history = stickslip.collide(63, 0.5).history(two)
    assert np.isnan(history["velocity"]).tolist() == [False, True]
    for call in (
        lambda: stickslip.solve(lambda t, y: -y, (0, 3), two),
        lambda: stickslip.solve_many(
            lambda t, y, k: -k * y, (0, 3), [1.0], parameters={"k": two}
        ),
    ):
        with pytest.raises(ValueError, match="finite"):
            call()
    data = {"centre_impact_angle_deg": np.array([10.0, 30.0, 60.0])}
    e_t = np.ma.array([0.57, 0.58, 9.0], mask=[False, False, True])
    found = stickslip.fit(data | {"centre_e_t": e_t}, free=["mu"], kappa=6.0)
    assert [row["row"] for row in found.data["residuals"]] == [0, 1]


@pytest.mark.parametrize("value", ["63", True, 63j, np.array(["2020-01-01"], "M8[D]")])
def test_what_is_not_a_real_number(value: object) -> None:
    for function in (stickslip.eps_t, stickslip.collide_many):
        with pytest.raises(TypeError, match="kappa has the type .*; expected real numbers"):
            function(value, 0.5)  # type: ignore[operator]


def test_moments_and_terminal_are_bounded() -> None:
    with pytest.raises(ValueError, match="moments = 10000000000; expected 1 to 1000000"):
        stickslip.collide(63, 0.5).history(moments=10**10)
    mode = HybridSystem().mode("only", lambda t, y: [1.0])
    with pytest.raises(TypeError, match="terminal = 2.7; expected a whole number"):
        mode.guard("end", lambda t, y: y[0] - 1, terminal=2.7)  # type: ignore[arg-type]


def test_edges_of_an_atlas() -> None:
    atlas = stickslip.trace((5, 20), (0.2, 2.5))
    located = atlas.locate([7.0, np.nextafter(7.0, 8)], [0.2, 0.2])
    assert np.isfinite(located.distance).all()
    # Where a boundary ends on the lower edge.
    on_edge = [
        point
        for boundary in atlas.boundaries
        for point in (boundary.points[0], boundary.points[-1])
        if point[1] == 0.2
    ]
    assert on_edge
    for kappa, psi in on_edge:
        place = atlas.locate(kappa, psi)
        assert str(place.itinerary) in ("", stickslip.collide(kappa, psi).itinerary)
    # An edge along which a boundary runs: above it, the contact only slides.
    top = stickslip.trace((5, 20), (0.5, 2))
    kappa = np.linspace(5.1, 19.9, 20)
    found = top.locate(kappa, 2.0)
    computed = stickslip.collide_many(kappa, 2.0).itinerary
    decided = found.region >= 0
    assert np.array_equal(found.itinerary[decided], computed[decided])


def test_the_last_moment_is_in_the_course() -> None:
    random = np.random.default_rng(5)
    for damping in [0.0, 0.3, 1.0, 2.0]:
        for kappa, psi in random.uniform([0.1, 0.01], [50.0, 3.0], (20, 2)):
            collision = stickslip.collide(kappa, psi, damping)
            course = collision.history([0.0, collision.contact_time, 1.01 * collision.contact_time])
            assert np.isfinite(course["velocity"][:2]).all() and np.isnan(course["velocity"][2])
            assert course["time"][1] == collision.contact_time


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ({"size": (2.5, 2)}, TypeError),
        ({"damping": -1.0}, ValueError),
        ({"mu": [0.1, 0.2]}, TypeError),
    ],
)
def test_maps_of_nothing(arguments: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        stickslip.map((1.0, 2.0), ratio=(0.1, 1.0), **{"size": (2, 2), **arguments})
