"""Fits of contact laws to measured impacts."""

from pathlib import Path

import numpy as np
import pytest

import stickslip

EXAMPLES = Path(__file__).parents[2] / "examples"

ANGLES = np.array([4.0, 10.0, 18.0, 27.0, 36.0, 50.0, 65.0])


def scaled(kappa: float, mu: float) -> dict[str, np.ndarray]:
    """Exact data of impacts at one speed."""
    angles = np.radians(ANGLES)
    eps_t = stickslip.eps_t(kappa * np.cos(angles) ** -0.4, np.tan(angles) * (2 / 7) / mu)
    return {"centre_impact_angle_deg": ANGLES, "eps_t": eps_t}


def test_exact_data_give_back_their_numbers() -> None:
    found = stickslip.fit(scaled(6.0, 0.2), free=["kappa", "mu"], ranges={"kappa": (1, 20)})
    assert abs(found.best.kappa - 6) < 1e-6 and abs(found.best.mu - 0.2) < 1e-7
    assert found.best.root_mean_squares["eps_t"] < 1e-7
    (piece,) = found.intervals["kappa"] or []
    assert piece[0] <= found.best.kappa <= piece[1]
    assert "best fit" in (found.picture() or "")
    assert f"{len(found.minima)} minima" in repr(found)


def test_the_example_in_si_units() -> None:
    table = np.genfromtxt(
        EXAMPLES / "oblique_impacts.csv", delimiter=",", skip_header=2, usecols=(1, 2)
    )
    data = {"centre_impact_angle_deg": table[:, 0], "centre_e_t": table[:, 1]}
    bodies = stickslip.Bodies.read(EXAMPLES / "aluminium_oxide_on_glass.json")
    found = stickslip.fit(data, bodies, speed_m_per_s=3.9, ranges={"kappa": (1, 10)}, threads=2)
    assert found.best.stiffness is not None and found.best.stiffness > 1e6
    assert found.data["mindlin"]["excluded"]
    again = stickslip.fit(data, bodies, speed_m_per_s=3.9, ranges={"kappa": (1, 10)}, threads=1)
    assert again.data == found.data
    lines = found.input("lammps", bodies)
    assert "tangential linear_history" in lines and repr(found.best.stiffness) in lines
    with pytest.raises(ValueError, match="mfix has no input for these contacts"):
        found.input("mfix", bodies)


def test_friction_that_decays() -> None:
    angles = np.radians(ANGLES[1:5])
    eps_t = [
        stickslip.collide(
            6.0 * np.cos(angle) ** -0.4,
            np.tan(angle) * (2 / 7) / 0.2,
            law={"friction": {"dynamic": 0.5, "decay": np.cos(angle)}},
        ).eps_t
        for angle in angles
    ]
    data = {"centre_impact_angle_deg": ANGLES[1:5], "eps_t": eps_t}
    decaying = {"friction": {"dynamic": 0.5, "decay": 1.0}}
    found = stickslip.fit(data, free=["mu"], kappa=6.0, ranges={"mu": (0.1, 0.4)}, law=decaying)
    assert abs(found.best.mu - 0.2) < 1e-7
    assert "velocity reverses" in found.data["course"]["untraced"]


def test_missing_values_and_errors() -> None:
    data = scaled(6.0, 0.2)
    data["eps_t"] = data["eps_t"].copy()
    data["eps_t"][2] = np.nan
    data["eps_t_error"] = np.full(len(ANGLES), 0.01)
    found = stickslip.fit(data, free=["mu"], kappa=6.0)
    assert found.data["data"] == len(ANGLES) - 1 and not found.data["estimated_errors"]


@pytest.mark.parametrize(
    ("change", "options", "expected"),
    [
        ({"e_t": ANGLES}, {}, "column 'e_t' is unknown"),
        ({"eps_n": ANGLES[:2]}, {}, "7"),
        ({}, {"free": ["k_t", "kappa"]}, "kappa is free twice"),
        ({}, {"free": ["nothing"]}, "nothing"),
        ({}, {"law": "nothing"}, "law"),
        ({}, {"speed_m_per_s": None, "bodies": EXAMPLES / "steel_pair.json"}, "speed is missing"),
        ({}, {"level": 2.0}, "level = 2.0"),
        ({"centre_impact_angle_deg": ANGLES + 50}, {}, "below 90"),
        ({"eps_t": [ANGLES]}, {}, "dimensions"),
    ],
)
def test_bad_input(change: dict, options: dict, expected: str) -> None:
    with pytest.raises(ValueError, match=expected):
        stickslip.fit(scaled(6.0, 0.2) | change, **options)
