"""Tables of the restitution."""

from pathlib import Path

import numpy as np
import pytest

import stickslip


@pytest.fixture(scope="module")
def made() -> stickslip.RestitutionTable:
    return stickslip.table((0.9, 4.5), (0.2, 2.4), bound=1e-6, regions=True)


def test_values_are_those_of_collisions(made: stickslip.RestitutionTable) -> None:
    random = np.random.default_rng(1)
    kappa, psi = random.uniform(0.9, 4.5, (50, 40)), random.uniform(0.2, 2.4, (50, 40))
    found = made.eps_t(kappa, psi)
    assert found.shape == (50, 40)
    assert np.abs(found - stickslip.eps_t(kappa, psi)).max() <= made.bound == 1e-6
    assert 0 < made.largest_error <= 1e-6 and made.points > 1000 and made.eps_n == 1
    assert (made.eps_t(kappa, psi, threads=2) == found).all()
    itineraries = np.array(made.itineraries)[made.region(kappa, psi)]
    assert (itineraries == stickslip.collide_many(kappa, psi).itinerary).all()
    assert made.eps_t(1.5, [0.5, 1.0]).shape == (2,) and made.eps_t([], 1.0).shape == (0,)
    assert np.isnan(made.eps_t([0.5, np.nan, -1, np.inf, 2, 2], [1, 1, 1, 1, 0.1, 3])).all()
    assert made.region([0.5, 2], [1, np.nan]).tolist() == [-1, -1]
    assert "bound 1e-06" in repr(made)


def test_files(made: stickslip.RestitutionTable, tmp_path: Path) -> None:
    file = tmp_path / "table.json"
    made.save(file)
    again = stickslip.load_table(file)
    kappa = np.linspace(0.9, 4.5, 1000)
    assert (again.eps_t(kappa, 1.0) == made.eps_t(kappa, 1.0)).all()
    assert again.itineraries == made.itineraries
    assert "double gas_eps_t(double kappa" in made.c_header("gas")
    file.write_text(file.read_text().replace("stickslip.table/1", "stickslip.table/0"))
    with pytest.raises(ValueError, match="schema has changed"):
        stickslip.load_table(file)


def test_what_cannot_be_is_refused(made: stickslip.RestitutionTable) -> None:
    for arguments in ({"bound": 1e-13}, {"bound": 1.0}, {"damping": -1.0}, {"threads": 0}):
        with pytest.raises(ValueError, match="expected"):
            stickslip.table((1, 2), (0.5, 1.5), **arguments)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="kappa"):
        stickslip.table((2, 1), (0.5, 1.5))
    with pytest.raises(ValueError, match="prefix"):
        made.c_header("1")


@pytest.fixture(scope="module")
def beads() -> stickslip.Bodies:
    bead = stickslip.Sphere(0.0015, stickslip.Material(63e9, 0.24, 2500))
    return stickslip.Bodies(bead, bead, stickslip.Surface(0.3, 5e6, 2e-7))


@pytest.fixture(scope="module")
def of_velocities(beads: stickslip.Bodies) -> stickslip.VelocityTable:
    return stickslip.table_of_velocities(beads, (1, 4), (0.5, 8), bound=1e-6, regions=True)


def test_values_are_those_of_impacts(
    beads: stickslip.Bodies, of_velocities: stickslip.VelocityTable
) -> None:
    random = np.random.default_rng(1)
    normal, tangential = random.uniform(1, 4, (30, 40)), random.uniform(0.5, 8, (30, 40))
    impacts = stickslip.impact(beads, normal, tangential)
    found = of_velocities.eps_t(normal, tangential)
    assert found.shape == (30, 40)
    assert np.abs(found - impacts.eps_t).max() <= of_velocities.bound == 1e-6
    assert np.abs(of_velocities.eps_n(normal) - impacts.eps_n).max() <= 1e-6
    assert of_velocities.eps_n(1) - of_velocities.eps_n(4) > 0.01
    assert 0 < of_velocities.largest_error_of_eps_n <= 1e-6
    assert (of_velocities.eps_t(normal, tangential, threads=2) == found).all()
    itineraries = np.array(of_velocities.itineraries)[of_velocities.region(normal, tangential)]
    assert (itineraries == impacts.collisions.itinerary).all()
    assert np.isnan(of_velocities.eps_t([0.9, np.nan, 2, 2], [1, 1, 0.4, 9])).all()
    assert np.isnan(of_velocities.eps_n([0.9, np.nan, 4.1, -1])).all()
    assert "normal_m_per_s (1.0, 4.0)" in repr(of_velocities)


def test_files_of_velocities(of_velocities: stickslip.VelocityTable, tmp_path: Path) -> None:
    file = tmp_path / "table.json"
    of_velocities.save(file)
    again = stickslip.load_table(file)
    assert isinstance(again, stickslip.VelocityTable)
    assert again.normal_m_per_s == (1, 4) and again.tangential_m_per_s == (0.5, 8)
    normal = np.linspace(1, 4, 1000)
    assert (again.eps_t(normal, 2.0) == of_velocities.eps_t(normal, 2.0)).all()
    assert (again.eps_n(normal) == of_velocities.eps_n(normal)).all()
    assert "double gas_eps_n(double g_n)" in of_velocities.c_header("gas")


def test_bodies_without_a_table_are_refused(beads: stickslip.Bodies) -> None:
    for normal, tangential in (((0, 1), (1, 2)), ((2, 1), (1, 2)), ((1, 2), (np.nan, 2))):
        with pytest.raises(ValueError, match="m_per_s"):
            stickslip.table_of_velocities(beads, normal, tangential)
