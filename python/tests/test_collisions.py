"""Collisions, one and many, against the references and the program's rules."""

import json
import pickle
import threading
from pathlib import Path

import numpy as np
import pytest

import stickslip
from stickslip._collisions import DERIVED, MOMENT, SWITCH, Method

DATA = Path(__file__).parents[2] / "tests" / "data"


def test_one_collision() -> None:
    collision = stickslip.collide(63, 0.5)
    assert collision.itinerary == "+o-o+o-"
    assert collision.switch_count == 6 == collision.switches.shape[0]
    assert collision.switches.dtype == SWITCH
    assert collision.eps_t == pytest.approx(-0.041652207479456, abs=1e-14)
    assert collision.method == "exact" and collision.statistics == {}
    assert collision.w_final == collision.eps_t * 0.5
    assert np.all(np.diff(collision.switches["time"]) > 0)
    total = collision.switches["time"] + collision.switches["time_left"]
    assert np.abs(total - collision.contact_time).max() < 1e-14


def test_an_animation_is_what_its_name_says(tmp_path: Path) -> None:
    collision = stickslip.collide(18, 0.5)
    film = tmp_path / "film.gif"
    collision.animate(film)
    assert film.read_bytes().startswith(b"GIF89a")
    with pytest.raises(ValueError, match=r"expected a name that ends in \.gif or \.mp4"):
        collision.animate(tmp_path / "film.avi")
    with pytest.raises(OSError, match="cannot be written"):
        collision.animate(tmp_path / "nowhere" / "film.gif")


def test_history_has_the_shape_of_its_times() -> None:
    collision = stickslip.collide(63, 0.5)
    assert collision.history().dtype == MOMENT
    assert collision.history(moments=10).size == 7 * 11
    times = np.linspace(0, collision.contact_time, 12).reshape(3, 4)
    assert collision.history(times).shape == (3, 4)
    middle = collision.history(collision.contact_time / 2)
    assert middle.shape == () and abs(middle["compression"] - 1.25**0.4) < 1e-11
    assert np.isnan(collision.history(-1.0)["velocity"])
    with pytest.raises(ValueError, match="moments = 0"):
        collision.history(moments=0)


def test_sensitivity_is_the_slope() -> None:
    step = 1e-6
    found = stickslip.collide(63, 0.5, 0.1).sensitivity()
    assert found.eps_t.dtype == DERIVED and found.switch_times.shape == (7,)
    by_kappa = np.diff(stickslip.eps_t([63 - step, 63 + step], 0.5, 0.1))[0] / (2 * step)
    by_damping = np.diff(stickslip.eps_t(63, 0.5, [0.1 - step, 0.1 + step]))[0] / (2 * step)
    assert found.eps_t["kappa"] == pytest.approx(by_kappa, abs=1e-8)
    assert found.eps_t["damping"] == pytest.approx(by_damping, abs=1e-8)


def test_pictures_and_documents() -> None:
    collision = stickslip.collide(18, 0.4, 0.05, "dop853")
    assert collision.picture().startswith("<svg") and "</svg>" in collision._repr_html_()
    document = collision.to_dict()
    assert document["schema"] == "stickslip.collision/1"
    assert list(document)[:3] == ["schema", "parameters", "method"]
    assert document["statistics"]["accepted"] > 0
    assert collision.estimate().certain


def test_pickled_collisions_are_the_same() -> None:
    collision = stickslip.collide(18, 0.4, 0.05, rtol=1e-9)
    assert collision.method == "dop853"
    assert pickle.loads(pickle.dumps(collision)).eps_t == collision.eps_t


@pytest.mark.parametrize("method", ["exact", "dop853", "dopri5", "auto"])
@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_many_are_as_one(method: Method, damping: float) -> None:
    kappa = np.geomspace(0.1, 300, 13)[:, None]
    psi = np.linspace(0.05, 2.5, 7)
    many = stickslip.collide_many(kappa, psi, damping, method)
    assert many.shape == (13, 7) == many.eps_t.shape and len(many) == 13 and many.size == 91
    alone = stickslip.eps_t(kappa, psi, damping, method)
    assert np.array_equal(alone, many.eps_t)
    for place in np.ndindex(many.shape):
        one = many[place]
        assert (one.kappa, one.psi) == (kappa[place[0], 0], psi[place[1]])
        assert one.eps_t == many.eps_t[place] and one.eps_n == many.eps_n[place]
        assert one.itinerary == many.itinerary[place]
        assert one.switch_count == many.switch_count[place]
        index = np.ravel_multi_index(place, many.shape)
        own = many.switches[many.offsets[index] : many.offsets[index + 1]]
        assert np.array_equal(own, one.switches)


def test_threads_do_not_change_a_bit() -> None:
    kappa = np.geomspace(0.1, 300, 70_001)
    alone = stickslip.collide_many(kappa, 0.3, 0.01, threads=1)
    together = stickslip.collide_many(kappa, 0.3, 0.01, threads=3)
    assert alone.itineraries == together.itineraries
    assert np.array_equal(alone.switches, together.switches)
    assert np.array_equal(alone.eps_t, together.eps_t)


def test_calls_from_several_threads() -> None:
    results: list[np.ndarray] = []
    kappa = np.geomspace(0.1, 300, 5000)

    def work() -> None:
        results.append(stickslip.eps_t(kappa, 0.3, 0.1))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(results[0], one) for one in results[1:])


def test_shapes_and_types() -> None:
    assert isinstance(stickslip.eps_t(18, 0.4), float)
    assert stickslip.eps_t([18], 0.4).shape == (1,)
    assert stickslip.eps_t([], 0.4).shape == (0,)
    assert stickslip.eps_t(np.ones((0, 3)), np.ones(3)).shape == (0, 3)
    assert stickslip.eps_t(np.ones((2, 1, 3)), np.ones((4, 1))).shape == (2, 4, 3)
    assert stickslip.eps_t(np.float32(18), 1).dtype == np.float64
    reversed_view = np.arange(1.0, 9.0)[::-2]
    expected = [stickslip.collide(kappa, 0.4).eps_t for kappa in reversed_view]
    assert stickslip.eps_t(reversed_view, 0.4).tolist() == expected
    assert len(stickslip.collide_many([], 0.4)) == 0
    with pytest.raises(ValueError, match="broadcast"):
        stickslip.eps_t([1, 2], [1, 2, 3])
    with pytest.raises(TypeError, match="collide_many"):
        stickslip.collide([18, 19], 0.4)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="no length"):
        len(stickslip.collide_many(18, 0.4))


def test_normal_restitution_in_place_of_damping() -> None:
    found = stickslip.collide(63, 0.5, e_n=0.8)
    assert found.damping == stickslip.restitution(0.8).damping
    linear = stickslip.collide(63, 0.5, e_n=0.8, law="gran/hooke/history")
    assert linear.eps_n == pytest.approx(0.8, abs=1e-12)
    with pytest.raises(ValueError, match="damping and e_n are both given"):
        stickslip.collide(63, 0.5, 0.1, e_n=0.8)
    with pytest.raises(ValueError, match="e_n"):
        stickslip.collide(63, 0.5, e_n=1.5)


def test_bad_parameters_are_named() -> None:
    for arguments, words in [
        ((-1, 0.5), "kappa = -1"),
        ((1, 0), "psi = 0"),
        ((1, 0.5, -0.1), "damping = -0.1"),
        ((1, float("nan")), "psi = NaN"),
        ((1e17, 0.5), "out of the range of the exact solution"),
    ]:
        with pytest.raises(ValueError, match=words):
            stickslip.collide(*arguments)
        with pytest.raises(ValueError, match=words):
            stickslip.eps_t(*arguments)
    with pytest.raises(ValueError, match=r"\[1\] kappa = -1.0, psi = 0.5"):
        stickslip.eps_t([1, -1], 0.5)
    for options, words in [
        ({"method": "euler"}, "euler"),
        ({"method": "exact", "rtol": 1e-6}, "no effect"),
        ({"rtol": 1.0}, "rtol = 1.0"),
        ({"errors": "ignore"}, "ignore"),
        ({"threads": 0}, "threads = 0"),
        ({"threads": 2000}, "threads = 2000"),
    ]:
        with pytest.raises(ValueError, match=words):
            stickslip.eps_t([1.0, 2.0], 0.5, **options)


def test_failures_leave_the_others() -> None:
    many = stickslip.collide_many([18, -1, 63], 0.5, errors="nan")
    assert np.isnan(many.eps_t).tolist() == [False, True, False]
    assert many.switch_count.tolist() == [4, -1, 6] and many.reversals[1] == -1
    assert many.itinerary.tolist() == ["+o+o-", "", "+o-o+o-"]
    assert list(many.failures) == [1] and "kappa = -1" in many.failures[1]
    assert many.offsets.tolist() == [0, 4, 4, 10]
    values, counts = stickslip.eps_t_and_switch_count([18, -1], 0.5, errors="nan")
    assert np.isnan(values[1]) and counts.tolist() == [4, -1]


def test_arrow() -> None:
    many = stickslip.collide_many([[18, -1], [63, 0.1]], 0.5, errors="nan")
    table = many.to_arrow()
    assert table.num_rows == 4
    assert table["itinerary"].to_pylist() == ["+o+o-", None, "+o-o+o-", many.itinerary[1, 1]]
    assert [len(one) for one in table["switches"].to_pylist()][:3] == [4, 0, 6]
    assert table["switches"][2][0]["time"].as_py() == many.switches["time"][4]


def test_ratios() -> None:
    assert stickslip.psi_of_ratio([0.7, 1.4]).tolist() == [0.7 * (2 / 7) / 0.4, 1.4 * (2 / 7) / 0.4]


@pytest.mark.parametrize("name", ["contacts_series.json"])
def test_references_with_25_digits(name: str) -> None:
    cases = json.loads((DATA / name).read_text())["cases"]
    kappa, psi, damping = (np.array([case[i] for case in cases]) for i in range(3))
    many = stickslip.collide_many(kappa, psi, damping, errors="nan")
    assert not many.failures
    assert many.itinerary.tolist() == [case[3] for case in cases]
    error = np.abs(many.eps_t - np.array([float(case[4]) for case in cases]))
    assert np.all(error < 1e-15 * (1 + np.sqrt(kappa)))


def test_a_ratio_stands_for_psi() -> None:
    psi = stickslip.psi_of_ratio(1.4, 0.5, 0.3)
    assert stickslip.collide(18, ratio=1.4, mu=0.5, alpha=0.3).eps_t == stickslip.eps_t(18, psi)
    ratios = [0.7, 1.4]
    expected = stickslip.eps_t(18, stickslip.psi_of_ratio(ratios))
    assert stickslip.eps_t(18, ratio=ratios).tolist() == expected.tolist()
    assert stickslip.collide_many(18, ratio=ratios).eps_t.tolist() == expected.tolist()
    for arguments, words in [
        ({}, "neither psi nor ratio is given"),
        ({"psi": 1, "ratio": 1}, "psi and ratio are both given"),
        ({"psi": 1, "mu": 0.4}, "mu = 0.4 has no effect with psi"),
    ]:
        with pytest.raises(ValueError, match=words):
            stickslip.collide(18, **arguments)


@pytest.mark.parametrize("text", ["0", "1025", "many", "-1"])
def test_threads_of_the_environment_have_limits(
    monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    monkeypatch.setenv("RAYON_NUM_THREADS", text)
    with pytest.raises(ValueError, match="RAYON_NUM_THREADS = .*; expected a whole number"):
        stickslip.eps_t([18, 63], 0.5)
    assert stickslip.eps_t([18, 63], 0.5, threads=1).shape == (2,)
