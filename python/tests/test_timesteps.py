"""Errors of the time steps of particle codes."""

import json
from pathlib import Path

import numpy as np
import pytest

import stickslip

DATA = Path(__file__).parents[2] / "tests" / "data" / "lammps_laws.json"


def test_errors_are_those_of_lammps() -> None:
    alpha = 2 / 7
    cases = json.loads(DATA.read_text())["cases"]
    for case in [one for one in cases if one["law"] == "hooke/history damp1"]:
        scaled = case["scaled"]
        found = stickslip.timestep(
            scaled["kappa"] / alpha,
            scaled["g0"] * alpha / scaled["mu"],
            scaled["cn"],
            law="gran/hooke/history",
            tangential_damping=scaled["xt"] / alpha,
            steps=[20, 50],
        )
        for row, name in enumerate(["20", "50"]):
            expected = case["time_step"][name]
            assert abs(found.eps_t.root_mean_square[row] / expected["rms"] - 1) < 1e-3
            assert abs(found.eps_t.worst[row] / expected["max"] - 1) < 1e-3


def test_impacts_broadcast() -> None:
    found = stickslip.timestep([[3.0], [30.0]], [0.1, 0.5, 1.5], steps=[200, 20], threads=2)
    assert found.steps_per_contact.tolist() == [20, 200] and found.status == ["ok", "ok"]
    assert len(found.data["contacts"]) == 6 and "6 impacts" in repr(found)
    for errors in (found.eps_t, found.eps_n, found.energy):
        assert (errors.median <= errors.worst).all() and (np.diff(errors.worst) < 0).all()
        assert (errors.worst_contact < 6).all() and (errors.worst_phase < 1).all()
    worst = found.data["contacts"][found.eps_t.worst_contact[0]]
    alone = stickslip.timestep(worst["kappa"], worst["psi"], steps=[20], threads=1)
    assert alone.eps_t.worst[0] == found.eps_t.worst[0]
    assert found.picture().startswith("<svg") and found._repr_html_() == found.picture()


def test_what_fails_is_said() -> None:
    sticky = stickslip.timestep(4, 0.5, 1.99, law="gran/hooke/history", steps=[20])
    assert sticky.status == ["unfinished"] and np.isnan(sticky.eps_t.worst[0])
    assert sticky.eps_t.worst_contact[0] == -1 and sticky.largest_step(10) is None
    stiff = stickslip.timestep(1e5, 0.5, steps=[20, 1000])
    assert stiff.status == ["unstable", "ok"] and stiff.stiffness[0] > 1 > stiff.stiffness[1]
    assert stiff.largest_step(2.0, "energy") == 1 / 1000


def test_a_normal_that_turns_is_in_the_errors() -> None:
    arguments = {"law": "gran/hooke/history", "steps": [20000], "phases": 1}
    still = stickslip.timestep(3, 2, **arguments)  # type: ignore[arg-type]
    assert still.eps_t.worst[0] < 1e-3
    for scheme in ("lammps", "synchronized_verlet"):
        found = stickslip.timestep(3, 2, overlap=0.01, scheme=scheme, **arguments)  # type: ignore[arg-type]
        assert found.eps_t.worst[0] == pytest.approx(0.136061, abs=1e-3)


def test_bad_input_is_refused() -> None:
    for arguments, words in [
        ({"steps": [0.5]}, "steps = 0.5 is out of range"),
        ({"steps": []}, "0 time steps"),
        ({"phases": 0}, "phases = 0 is out of range"),
        ({"scheme": "verlet"}, r'scheme = "verlet"; expected one of \["lammps", "elapsed",'),
        ({"overlap": 0.6}, "a number from 0 to 0.5"),
        ({"mu": 0}, "mu = 0.0 is out of range"),
        ({"alpha": 2}, "alpha = 2.0 is out of range"),
        ({"damping": -1}, "damping = -1.0"),
        ({"law": "hooke"}, "expected a name of stickslip.laws"),
        ({"threads": 0}, "threads = 0"),
    ]:
        with pytest.raises(ValueError, match=words):
            stickslip.timestep(1.0, 1.0, **arguments)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="psi = 1e-300.*out of the range of the integrator"):
        stickslip.timestep(1.0, 1e-300, law="gran/hertz/history")
    with pytest.raises(ValueError, match="0 impacts"):
        stickslip.timestep([], [])
    with pytest.raises(ValueError, match="quantity = 'eps'; expected one of"):
        stickslip.timestep(1.0, 1.0, steps=[20]).largest_step(0.1, "eps")  # type: ignore[arg-type]
