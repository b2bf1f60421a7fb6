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
    with pytest.raises(ValueError, match="table/0"):
        stickslip.load_table(file)


def test_what_cannot_be_is_refused(made: stickslip.RestitutionTable) -> None:
    for arguments in ({"bound": 1e-13}, {"bound": 1.0}, {"damping": -1.0}, {"threads": 0}):
        with pytest.raises(ValueError, match="expected"):
            stickslip.table((1, 2), (0.5, 1.5), **arguments)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="kappa"):
        stickslip.table((2, 1), (0.5, 1.5))
    with pytest.raises(ValueError, match="prefix"):
        made.c_header("1")
