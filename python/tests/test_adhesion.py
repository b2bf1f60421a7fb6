"""Adhesion: contact laws in which bodies may stay together."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import stickslip

DATA = Path(__file__).parents[2] / "tests" / "data" / "lammps_adhesion.json"
NAME = "granular/jkr/viscoelastic/mindlin"


def law(pull_off: float, name: str = NAME) -> dict[str, object]:
    return {**stickslip.laws()[name].law, "pull_off": pull_off}


def test_collisions_are_those_of_lammps() -> None:
    for case in json.loads(DATA.read_text())["cases"][::5]:
        terms = {
            **law(case["pull_off"], f"granular/{case['normal']}/viscoelastic/mindlin"),
            "damping": case["eta"],
            "tangential": case["tangential"],
            "history": case["history"],
            "rescaled": case["rescaled"],
        }
        psi = case["psi"]
        collision = stickslip.collide(
            case["kappa"],
            psi,
            case["damping"],
            law=terms,
            tangential_damping=case["tangential_damping"],
        )
        assert collision.adheres == case["adheres"]
        if not collision.adheres:
            assert abs(collision.eps_t - case["eps_t"]) * psi < 2e-5 + 2e-4 * psi


def test_bodies_that_stay_together_have_no_restitution() -> None:
    held = stickslip.collide(18, 0.6, law=law(5.0))
    assert held.adheres and math.isnan(held.eps_n) and math.isnan(held.eps_t)
    with pytest.raises(stickslip.ComputationError, match="stay together"):
        held.history()
    many = stickslip.collide_many(18, [0.6, 0.7], law=law(0.2))
    assert np.all(many.eps_n < 1.0) and np.ptp(many.eps_n) < 1e-12
    assert np.all(np.isnan(stickslip.eps_t(18, [0.6, 0.7], law=law(5.0))))


def test_bodies_in_si_units() -> None:
    grain = stickslip.Sphere(1e-5, stickslip.Material(7e10, 0.25, 2500))
    surface = stickslip.Surface(0.3, damping_time_s=0.0, surface_energy_j_per_m2=0.05)
    bodies = stickslip.Bodies(grain, grain, surface, NAME)
    assert 0.9 < stickslip.impact(bodies, 0.1, 0.05).eps_n < 1.0
    assert math.isnan(stickslip.impact(bodies, 1e-3, 1e-3).eps_n)
    many = stickslip.impact(bodies, 0.1, [0.01, 0.05])
    single = many.collisions[1]
    assert single.eps_n == many.eps_n[1] and single.eps_t == many.eps_t[1]
    with pytest.raises(ValueError, match="expected one normal velocity a call"):
        stickslip.impact(bodies, [0.1, 0.2], 0.05)


def test_time_steps_are_those_of_lammps() -> None:
    for case in json.loads(DATA.read_text())["cases"]:
        if case["adheres"] or (case["eta"], case["tangential"]) != ("viscoelastic", "mindlin"):
            continue
        name = f"granular/{case['normal']}/viscoelastic/mindlin"
        terms = {**law(case["pull_off"], name), "history": case["history"]}
        terms["rescaled"] = case["rescaled"]
        numbers = [case[it] for it in ("kappa", "psi", "damping")]
        common: dict[str, object] = {"law": terms, "tangential_damping": case["tangential_damping"]}
        eps_n = stickslip.collide(*numbers, **common).eps_n  # type: ignore[arg-type]
        steps = stickslip.timestep(
            *numbers, **common, steps=[20], phases=1, overlap=0.01, mu=0.3  # type: ignore[arg-type]
        )
        assert abs(steps.eps_n.worst[0] - abs(case["in_steps"]["20"][0] - eps_n)) < 1e-9
    with pytest.raises(stickslip.ComputationError, match="stay together"):
        stickslip.timestep(18, 0.6, law=law(5.0))


def test_what_is_not_computed_is_refused() -> None:
    with pytest.raises(ValueError, match="without pull-off"):
        stickslip.collide(3, 0.4, law=NAME)
    with pytest.raises(ValueError, match="has adhesion"):
        stickslip.restitution(0.8, NAME)
    with pytest.raises(ValueError, match="boundaries are not computed"):
        stickslip.trace((1, 2), (0.5, 1), law=law(0.1))
    with pytest.raises(ValueError, match="pull_off = 'much'"):
        stickslip.collide(3, 0.4, law={**law(0.1), "pull_off": "much"})
