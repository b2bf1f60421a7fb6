"""Contact laws of particle codes."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import stickslip

DATA = Path(__file__).parents[2] / "tests" / "data" / "lammps_laws.json"


def test_collisions_are_those_of_lammps() -> None:
    alpha = 2 / 7
    tangential = {"lin": "constant"}
    for case in json.loads(DATA.read_text())["cases"][::7]:
        scaled = case["scaled"]
        law = {
            "normal": {"hooke": "linear"}.get(scaled["normal"], "hertz"),
            "damping": {"const": "linear", "sqrtx": "viscoelastic", "quarter": "tsuji"}[
                scaled["damp"]
            ],
            "tangential": tangential.get(scaled["tang"], "mindlin"),
            "history": "force" if scaled["tang"].endswith("force") else "displacement",
            "rescaled": "rescale" in scaled["tang"],
            "limit_damping": scaled["limit"],
            "end": "overlap",
        }
        collision = stickslip.collide(
            scaled["kappa"] / alpha,
            scaled["g0"] * alpha / scaled["mu"],
            scaled["cn"],
            law=law,
            tangential_damping=scaled["xt"] / alpha,
        )
        assert abs(collision.eps_t + case["eps_t"]) < 1e-4 + case["eps_t_error"]
        assert pickle.loads(pickle.dumps(collision)).eps_t == collision.eps_t


def test_arrays_and_single_collisions_agree() -> None:
    name = "granular/hertz/tsuji/mindlin"
    many = stickslip.collide_many([3.0, 30.0], 0.4, 0.3, law=name, tangential_damping=3.5)
    eps_t = stickslip.eps_t([3.0, 30.0], 0.4, 0.3, law=name, tangential_damping=3.5)
    assert np.array_equal(many.eps_t, eps_t)
    assert many[1].eps_t == eps_t[1]
    assert many.itinerary[0].startswith("-")


def test_starts_that_are_badly_conditioned_are_told() -> None:
    force = "granular/hertz/tsuji/mindlin/force"
    margin = stickslip.collide(2.0, 0.745, law=force).start_margin
    assert margin is not None and abs(margin - 1 / 150) < 1e-14
    overturned = stickslip.collide(
        3.0, 0.5, 0.3, law="granular/hertz/tsuji/mindlin", tangential_damping=4.0
    )
    assert overturned.start_layer is not None and abs(overturned.start_layer - 81.0) < 1e-9
    plain = stickslip.collide(2.0, 0.745)
    assert plain.start_margin is None and plain.start_layer is None


def test_laws_have_names() -> None:
    named = stickslip.laws()["yade/FrictPhys_CundallStrack"]
    assert named.code == "YADE" and named.equations.startswith("F = x;")
    by_name = stickslip.collide(2.0, 0.4, law=named.name)
    assert stickslip.collide(2.0, 0.4, law=named.law).eps_t == by_name.eps_t


def test_what_has_no_meaning_is_refused() -> None:
    with pytest.raises(ValueError, match=r"expected a name of stickslip.laws\(\)"):
        stickslip.collide(2.0, 0.4, law="hooke")
    for law, words in (
        ("gran/hooke/histry", r"a name of stickslip.laws\(\); perhaps 'gran/hooke/history' or"),
        ("Paper", "; perhaps 'paper'$"),
        ("paper+limit_dampin", "; perhaps 'paper\\+limit_damping'"),
        ('{"normal":', "expected a name"),
        ({"normal": "hooke"}, "normal = 'hooke'; expected one of 'hertz', 'linear', 'dmt', 'jkr'$"),
        ({"normal": "linaer"}, "'linear', 'dmt', 'jkr'; perhaps 'linear'$"),
        ({"nomal": "linear"}, "'nomal' is no term; expected one of .*; perhaps 'normal'$"),
        ({"rescaled": "yes"}, "rescaled = 'yes'; expected one of False, True$"),
        ({"rescaled": 1}, "rescaled = 1; expected one of False, True$"),
        ({"normal": ["hertz"]}, r"normal = \['hertz'\]; expected one of"),
    ):
        with pytest.raises(ValueError, match=words) as caught:
            stickslip.eps_t(2.0, [0.4], law=law)
        assert "line 1" not in str(caught.value)
    with pytest.raises(TypeError, match="law is of type int"):
        stickslip.collide(2.0, 0.4, law=3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="never end"):
        stickslip.collide(2.0, 0.4, 2.5, law="granular/hertz/tsuji/mindlin")
    with pytest.raises(ValueError, match="tangential_damping = 1.0 has no meaning"):
        stickslip.collide(2.0, 0.4, 0.1, law="mfix/LSD", tangential_damping=1)


def test_atlases_have_laws(tmp_path: Path) -> None:
    law = "gran/hooke/history+limit_damping"
    atlas = stickslip.trace((1, 3), (0.3, 0.9), law=law)
    assert "start-of-contact" in {boundary.kind for boundary in atlas.boundaries}
    atlas.save(tmp_path / "atlas.json")
    again = stickslip.Atlas.load(tmp_path / "atlas.json")
    kappa, psi = np.linspace(1.1, 2.9, 7), np.linspace(0.35, 0.85, 7)
    found = again.locate(kappa, psi).itinerary
    assert found.tolist() == stickslip.collide_many(kappa, psi, law=law).itinerary.tolist()


def test_what_is_known_of_the_paper_s_law_alone_is_refused() -> None:
    found = stickslip.collide(2.0, 0.4, 0.1, law="gran/hertz/history")
    for ask in (found.sensitivity, found.estimate):
        with pytest.raises(stickslip.ComputationError, match="for the paper's contact law only"):
            ask()


def test_courses_are_those_of_the_law() -> None:
    found = stickslip.collide(12.0, 0.6, 0.3, law="granular/hertz/tsuji/mindlin_rescale")
    course = found.history()
    assert course["velocity"][0] == 0.6 and course["velocity"][-1] == found.w_final
    assert course["normal_force"].min() < -0.05
    assert np.all(np.abs(course["tangential_force"]) <= np.abs(course["normal_force"]) + 1e-12)
    assert "b = " not in found.picture() and "stick" in found.picture()


def test_impacts_have_the_constants_of_their_law() -> None:
    file = Path(__file__).parents[2] / "examples" / "hooke_spheres.json"
    law = "gran/hooke/history"
    whole = stickslip.Bodies.read(file, law).encounter()
    assert whole["eps_n"] == pytest.approx(0.9, abs=1e-9)
    normal, tangential = (
        whole["contact"][name] for name in ("normal_m_per_s", "tangential_m_per_s")
    )
    found = stickslip.impact(file, [normal, 2 * normal], tangential, law=law)
    assert found.eps_t[0] == pytest.approx(whole["eps_t"], abs=1e-12)
    # Nothing depends on the velocity but the ratio.
    assert found.contact_time_s[0] == pytest.approx(found.contact_time_s[1], rel=1e-12)
    with pytest.raises(ValueError, match="normal_stiffness_kg_per_s2 = 50000 has no meaning"):
        stickslip.impact(file, 1.0, 1.0)
    with pytest.raises(ValueError, match="has no meaning in the law mfix/LSD"):
        stickslip.impact(file, 1.0, 1.0, law="mfix/LSD")
    material = stickslip.Material(1e7, 0.3, 2500.0)
    sphere = stickslip.Sphere(1e-3, material)
    surface = stickslip.Surface(0.3, normal_stiffness_kg_per_s2=5e4, damping_ratio=0.1)
    with pytest.raises(ValueError, match="tangential_stiffness_kg_per_s2 is missing"):
        stickslip.Bodies(sphere, sphere, surface, law)


def test_lines_on_which_a_law_begins_to_gain() -> None:
    name = "gran/hertz/history"
    found = stickslip.gaining_lines((1.2, 1.3), (0.85, 1.0), law=name)
    assert found.objection is None and found.document["agrees"]
    (line,) = found.lines
    eps_t = stickslip.eps_t(line.points[:, 0], line.points[:, 1], law=name)
    assert np.abs(eps_t - line.eps_t).max() < 1e-8
    middle = len(line.points) // 2
    (from_, low), (to, high) = line.points[middle - 1 : middle + 1]
    length = np.hypot(to - from_, high - low)
    left = from_ - 1e-4 * (high - low) / length, low + 1e-4 * (to - from_) / length
    assert (abs(stickslip.eps_t(*left, law=name)) > 1) == line.gains_left
    assert stickslip.gaining_lines((2, 3), (0.5, 0.6)).lines == ()


def test_restitution_is_an_input() -> None:
    law = "mfix/HERTZIAN"
    found = stickslip.restitution(0.8, law)
    ratio = -np.log(0.8) / np.hypot(np.pi, np.log(0.8))
    assert found.critical_damping_ratio == pytest.approx(ratio, rel=1e-14)
    (keyword,) = found.keywords
    assert keyword.keyword == "DES_EN_INPUT" and keyword.e_n == pytest.approx(0.8191524727)
    assert stickslip.collide(3, 0.4, found.damping, law=law).eps_n == pytest.approx(0.8, abs=1e-11)
    paper = stickslip.restitution(0.8)
    assert paper.critical_damping_ratio is None and not paper.keywords
    assert stickslip.collide(3, 0.4, paper.damping).eps_n == pytest.approx(0.8, abs=1e-12)
    with pytest.raises(ValueError, match="e_n = 2.0 is out of range"):
        stickslip.restitution(2)
    with pytest.raises(ValueError, match="no damping of this law has e_n = 0.5"):
        stickslip.restitution(0.5, "yade/FrictPhys_CundallStrack")
    sphere = stickslip.Sphere(1e-3, stickslip.Material(1e7, 0.3, 2500.0))
    surface = stickslip.Surface(0.3, 1e4, normal_stiffness_kg_per_s2=5e4, e_n=0.7)
    bodies = stickslip.Bodies(sphere, sphere, surface, "gran/hooke/history")
    assert stickslip.impact(bodies, 0.3, 0.1).eps_n == pytest.approx(0.7, abs=1e-11)


def test_laws_without_history_and_with_other_coulomb_tests() -> None:
    found = stickslip.collide(1, 0.5, 0.3, law="gran/hooke", tangential_damping=1.75)
    assert found.eps_t == pytest.approx(0.197878, abs=6e-7)
    terms = {**stickslip.laws()["gran/hooke/history"].law, "coulomb_test": "spring"}
    options = {"damping": 0.3, "tangential_damping": 0.5}
    same = stickslip.laws()["liggghts/hooke/history"].law
    first = stickslip.collide(3, 0.4, law=terms, **options)
    assert first.eps_t == stickslip.collide(3, 0.4, law=same, **options).eps_t
    assert first.eps_t != stickslip.collide(3, 0.4, law="gran/hooke/history", **options).eps_t


def test_hysteretic_forces() -> None:
    found = stickslip.collide(3, 0.4, law="walton-braun", e_n=0.5)
    assert found.damping == pytest.approx(3.0, rel=1e-14)
    assert found.eps_n == pytest.approx(0.5, abs=1e-12)
    assert stickslip.restitution(0.5, "walton-braun").critical_damping_ratio is None
    with pytest.raises(ValueError, match="a hysteretic force has no dashpot"):
        law = {"normal": "linear", "damping": "hysteretic"}
        stickslip.collide(3, 0.4, 0.5, law=law, tangential_damping=0.2)
    surface = stickslip.Surface(
        0.5,
        4e4,
        normal_stiffness_kg_per_s2=5e4,
        unloading_stiffness_ratio=4,
    )
    grain = stickslip.Sphere(1e-3, stickslip.Material(1e7, 0.3, 2500))
    bodies = stickslip.Bodies(grain, grain, surface, "walton-braun")
    assert stickslip.impact(bodies, 0.1, 0.05).eps_n == pytest.approx(0.5, abs=1e-12)
    with pytest.raises(ValueError, match="adhesion is not computed"):
        stickslip.collide(3, 0.4, law="liggghts/sjkr")


def test_bodies_that_yield() -> None:
    assert stickslip.collide(3, 0.4, 0.9, law="thornton").eps_n == pytest.approx(1, abs=1e-12)
    found = stickslip.collide(3, 0.4, 4, law="thornton")
    mindlin = {**stickslip.laws()["thornton"].law, "tangential": "mindlin"}
    other = stickslip.collide(3, 0.4, 4, law=mindlin)
    assert other.eps_n == pytest.approx(found.eps_n, abs=1e-12) and other.eps_t != found.eps_t
    assert found.eps_n == pytest.approx(0.8122788724014045, abs=1e-12)
    assert stickslip.restitution(found.eps_n, "thornton").damping == pytest.approx(4, rel=1e-11)
    grain = stickslip.Sphere(1e-3, stickslip.Material(210e9, 0.3, 7850))
    surface = stickslip.Surface(0.3, 1e7, yield_velocity_m_per_s=0.05)
    bodies = stickslip.Bodies(grain, grain, surface, "thornton")
    many = stickslip.impact(bodies, [0.04, 0.2], 0.1)
    assert many.eps_n == pytest.approx([1, found.eps_n], abs=1e-11)
    with pytest.raises(ValueError, match="are both given"):
        both = stickslip.Surface(0.3, 1e7, yield_velocity_m_per_s=0.05, yield_pressure_pa=1e9)
        stickslip.Bodies(grain, grain, both, "thornton")


def test_decaying_friction() -> None:
    usual = stickslip.laws()["gran/hertz/history"].law
    law = {**usual, "friction": {"dynamic": 0.4, "decay": 5.0}}
    found = stickslip.collide(30, 0.5, law=law)
    assert found.eps_t != stickslip.collide(30, 0.5, law=dict(usual)).eps_t
    assert stickslip.eps_t([30.0], 0.5, law=law).tolist() == [found.eps_t]
    same = {**usual, "friction": {"dynamic": 1, "decay": 5.0}}
    assert stickslip.collide(30, 0.5, law=same).eps_t == stickslip.collide(30, 0.5, law=usual).eps_t
    moments = found.history(moments=50)
    limit = moments["normal_force"] * (0.4 + 0.6 * np.exp(-5 * np.abs(moments["velocity"])))
    assert np.all(np.abs(moments["tangential_force"]) < limit + 1e-9)
    with pytest.raises(ValueError, match="expected the numbers dynamic and decay"):
        stickslip.collide(30, 0.5, law={**usual, "friction": 0.4})
    with pytest.raises(ValueError, match="a number from 0 to 1"):
        stickslip.collide(30, 0.5, law={**usual, "friction": {"dynamic": 2, "decay": 1}})
    surface = stickslip.Surface(
        0.5, 4e3, damping_time_s=0, dynamic_friction=0.2, friction_decay_s_per_m=20
    )
    grain = stickslip.Sphere(1e-3, stickslip.Material(1e7, 0.3, 2500))
    bodies = stickslip.Bodies(grain, grain, surface)
    many = stickslip.impact(bodies, 0.1, [0.2, 0.25])
    assert many.collisions[1].eps_t == many.eps_t[1]
    with pytest.raises(ValueError, match="expected one normal velocity a call"):
        stickslip.impact(bodies, [0.1, 0.2], 0.25)


def test_no_friction_and_no_spring() -> None:
    for law in (None, "gran/hooke/history+limit_damping", {"normal": "linear"}):
        assert stickslip.collide(3, ratio=0.7, mu=0, law=law).eps_t == 1
        assert stickslip.collide(0, 0.5, law=law).eps_t == 1
    assert stickslip.eps_t([3.0, 30.0], ratio=0.7, mu=0).tolist() == [1, 1]
    with pytest.raises(ValueError, match="expected a call of its own for mu = 0"):
        stickslip.eps_t(3.0, ratio=0.7, mu=[0, 0.4])
    with pytest.raises(ValueError, match="or a law without history"):
        stickslip.collide(0, 0.5, 0.2, law="gran/hooke/history", tangential_damping=1)
    steel = stickslip.Sphere(0.02, stickslip.Material(210e9, 0.3, 7850))
    bodies = stickslip.Bodies(steel, steel, stickslip.Surface(0, 1e9, 1e-6))
    many = stickslip.impact(bodies, [1.0, 2.0], 0.5)
    assert many.eps_t.tolist() == [1, 1]


def test_a_table_of_another_law() -> None:
    made = stickslip.table((2.5, 2.8), (0.3, 0.5), 0.4, law="walton-braun", bound=1e-4)
    exact = stickslip.eps_t(2.6, 0.4, 0.4, law="walton-braun")
    assert abs(made.eps_t(2.6, 0.4) - exact) < 1e-4
