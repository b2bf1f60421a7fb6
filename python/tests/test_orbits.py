"""Periodic orbits against closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import stickslip
from stickslip import ComputationError

BALL = """
parameter a = 0.02, r = 0.7
state x = 0.015, v = 0.5, phase = 0.8
table = a*sin(phase)
x' = v
v' = -1
phase' = 2*pi
when x < table "bounce"
  x := table
  v := (1 + r)*table' - r*v
when phase > 2*pi "period"
  phase := phase - 2*pi
"""


def test_an_orbit_has_its_closed_form() -> None:
    ball = stickslip.system(BALL)
    orbit = ball.orbit(itinerary=("period", "bounce"))
    a, w, r = 0.02, 2 * math.pi, 0.7
    phase = math.acos((1 - r) / (2 * (1 + r) * a * w))
    assert abs(orbit.segments[0].state[2] - phase) < 1e-11
    assert orbit.multipliers is not None
    trace = 1 + r**2 - (1 + r) ** 2 * a * w**2 * math.sin(phase)
    assert abs(orbit.multipliers.sum() - trace) < 1e-10
    assert abs(orbit.multipliers.prod() - r**2) < 1e-11
    assert orbit.admissible and orbit.stable and orbit.obstacle is None
    t, y = orbit.course(20)
    assert y.shape == (3, t.size) == (3, 42) and abs(t[-1] - t[0] - 1.0) < 1e-13
    # From an orbit at another parameter, and from a run that settles.
    near = ball.orbit(near=orbit, parameters={"a": 0.021})
    start = near.segments[1].state + [0.005, 0.01, 0.0]
    settled = ball.orbit(settle=200.0, start=start, parameters={"a": 0.021})
    assert near.parameters["a"] == 0.021
    found = [min(s.end[0] for s in it.segments) for it in (near, settled)]
    assert abs(found[0] - found[1]) < 1e-10


def test_a_branch_has_its_special_orbits() -> None:
    ball = stickslip.system(BALL)
    orbit = ball.orbit(itinerary=["period", "bounce"])
    branch = ball.branch(orbit, "a", (0.005, 0.05))
    assert branch.objection is None and not branch.closed
    special = {it.kind: it for it in branch.specials}
    assert abs(special["fold"].value - 0.014043083214) < 1e-11
    assert abs(special["flip"].value - 0.029654967002) < 1e-11
    assert branch.values.min() >= 0.014043083
    assert branch.ends("v", 1).shape == branch.values.shape == branch.admissible.shape
    assert branch.svg("v").startswith("<svg")
    curve = ball.curve(special["flip"], ("r", "a"), (0.6, 0.8), (0.01, 0.06))
    r, a = curve.values
    # Aω² sin φ = 2(1 + r²)/(1 + r)², with cos φ = (1 − r)/(2(1 + r)Aω).
    w = 2 * math.pi
    cosine, sine = (1 - r) / (2 * (1 + r)) / w, 2 * (1 + r**2) / (1 + r) ** 2 / w**2
    assert np.abs(a - np.hypot(cosine, sine)).max() < 1e-11 and a.size > 5
    assert {round(float(r[0]), 12), round(float(r[-1]), 12)} == {0.6, 0.8}
    doubled = ball.switched(branch, special["flip"])
    assert abs(doubled.period - 2.0) < 1e-12 and doubled.stable
    assert len(doubled.segments) == 4
    with pytest.raises(ValueError, match="component = 'y'; expected one of x, v, phase"):
        branch.svg("y")
    with pytest.raises(ValueError, match="expected a `flip` or a `branch-point`"):
        ball.switched(branch, special["fold"])


def test_a_branch_is_saved_and_goes_on(tmp_path: Path) -> None:
    ball = stickslip.system(BALL)
    part = ball.branch(ball.orbit(itinerary=["period", "bounce"]), "a", (0.018, 0.025))
    assert not part.specials
    path = tmp_path / "branch.json"
    part.save(path)
    read = ball.read_branch(path)
    assert read.document()["schema"] == "stickslip.orbit-branch/1"
    assert np.array_equal(read.values, part.values) and read.interval == (0.018, 0.025)
    assert np.array_equal(read.admissible, part.admissible)
    whole = ball.resumed(read, (0.005, 0.05))
    special = {it.kind: it.value for it in whole.specials}
    assert abs(special["fold"] - 0.014043083214) < 1e-11
    assert abs(special["flip"] - 0.029654967002) < 1e-11
    assert whole.objection is None and whole.interval == (0.005, 0.05)
    assert set(part.values) <= set(whole.values)
    with pytest.raises(ValueError, match="contains that of the branch"):
        ball.resumed(part, (0.019, 0.03))
    heavier = stickslip.system(BALL.replace("v' = -1", "v' = -1.01"))
    with pytest.raises(ValueError, match="from an orbit"):
        heavier.read_branch(path)
    path.write_text(path.read_text().replace('"period":1.0', '"period":1.1', 1))
    with pytest.raises(ValueError, match="points has changed since the file was written"):
        ball.read_branch(path)
    path.write_text("{")
    with pytest.raises(ValueError, match="EOF"):
        ball.read_branch(path)


def test_regions_say_where_an_orbit_is_stable(tmp_path: Path) -> None:
    ball = stickslip.system(BALL)
    orbit = ball.orbit(itinerary=["period", "bounce"])
    window = ((0.01, 0.04), (0.65, 0.75))
    found = ball.orbit_regions(orbit, ("a", "r"), *window, cells=2)
    assert found.objection is None and found.parameters == ("a", "r")
    assert {it.kind for it in found.boundaries} == {"fold", "flip"}
    assert {it.orbits for it in found.regions} == {(), (0,), (1,)}
    assert [it.stable for it in found.regions if it.orbits == (0,)] == [True]
    path = tmp_path / "regions.json"
    found.save(path)
    read = stickslip.read_orbit_regions(path)
    assert read.document()["schema"] == "stickslip.orbit-regions/1"
    random, w = np.random.default_rng(54), 2 * math.pi
    for a, r in zip(random.uniform(*window[0], 200), random.uniform(*window[1], 200), strict=True):
        fold = (1 - r) / (2 * (1 + r)) / w
        flip = math.hypot(fold, 2 * (1 + r**2) / (1 + r) ** 2 / w**2)
        expected = () if a < fold else (0,) if a < flip else (1,)
        assert found.at(a, r) == read.at(a, r) == expected, (a, r)
    assert found.svg().startswith("<svg") and found.at(1.0, 0.7) is None
    path.write_text(path.read_text().replace("0.0", "0.1", 1))
    with pytest.raises(ValueError, match="has changed since the file was written"):
        stickslip.read_orbit_regions(path)
    with pytest.raises(ValueError, match="the places of two parameters"):
        ball.orbit_regions(orbit, ("a", "a"), *window)
    with pytest.raises(ValueError, match="cells = 0"):
        ball.orbit_regions(orbit, ("a", "r"), *window, cells=0)


def test_a_tent_map_is_chaotic() -> None:
    tent = stickslip.system(
        "parameter m = 1.9\nstate x = 0.3\nx' = 0\n"
        'every 1 from 1 "folds"\n  x := m*min(x, 1 - x)'
    )
    found = tent.exponents(time=1000.0, skip=10.5)
    assert abs(found.values[0] - math.log(1.9)) < 1e-12
    assert found.spread < 1e-11 and found.events == 1000
    t, (x,) = tent.section("folds", time=20.0, skip=0.5)
    assert t.size == 20 and np.allclose(x[1:], 1.9 * np.minimum(x[:-1], 1 - x[:-1]), atol=1e-12)
    diagram = tent.diagram("m", [0.5, 1.5], "folds", time=10.0, skip=100.25)
    # Below 1 all falls to 0.
    assert diagram.up.shape == diagram.down.shape == (2, 20) and not diagram.troubles
    assert np.abs(diagram.up[1, :10]).max() < 1e-12 and diagram.up[0, -1] == 1.5
    with pytest.raises(ValueError, match="a rule of the system, which has folds"):
        tent.section("bounce", time=1.0)
    with pytest.raises(ValueError, match="the time to skip = -1"):
        tent.exponents(time=1.0, skip=-1.0)


def test_two_wells_have_their_basins() -> None:
    wells = stickslip.system(
        "state x = 0, v = 0\nx' = v\nv' = x - x^3 - 0.5*v\nwhen x > 3 \"out\" -> end"
    )
    x = [-1.1, -0.9, 0.9, 1.1]
    found = wells.basins(("x", "v"), x, [0.05, 9.0], settle=100.0)
    ends = [found.attractors[label] for label in found.labels[0]]
    assert all(it.state is not None for it in ends)
    assert [round(float(it.state[0])) for it in ends if it.state is not None] == [-1, -1, 1, 1]
    assert {found.attractors[label].rule for label in found.labels[1]} == {"out"}
    assert found.labels.shape == (2, 4) and found.components == ("x", "v")
    with pytest.raises(ValueError, match="component = 'y'"):
        wells.basins(("x", "y"), x, x, settle=1.0)


def test_functions_have_orbits_too() -> None:
    belt = stickslip.HybridSystem()
    stick = belt.mode("stick", lambda t, y: [y[1], 0.0])
    slip = belt.mode("slip", lambda t, y: [y[1], 0.6 - y[0]])
    stick.guard("breaks away", lambda t, y: 1.0 - y[0], to=slip)
    slip.guard("stops", lambda t, y: 0.5 - y[1], to=stick, reset=lambda t, y: [y[0], 0.5])
    formulas = stickslip.solve(belt, (0, 30), [0.0, 0.5], "stick").system
    assert formulas is not None
    orbit = formulas.orbit(itinerary=["breaks away", "stops"])
    assert abs(orbit.period - 6.533703422732) < 1e-11
    assert orbit.admissible and orbit.multipliers is not None
    # Where it sticks, it forgets where it was.
    assert orbit.multipliers.tolist() == [0.0]


def impacts(record: bool | None = None) -> stickslip.HybridFamily:
    """A driven oscillator with a wall, over the amplitude and the frequency of its force."""
    system = stickslip.HybridSystem()
    force = lambda y, a, w: a * np.cos(y[2]) - y[0] - 0.1 * y[1]  # noqa: E731
    free = system.mode("free", lambda t, y, a, w: [y[1], force(y, a, w), w])
    hit = lambda t, y, a, w: [1.0, -0.8 * y[1], y[2]]  # noqa: E731
    again = lambda t, y, a, w: [y[0], y[1], y[2] - 2 * np.pi]  # noqa: E731
    free.guard("impact", lambda t, y, a, w: 1.0 - y[0], reset=hit)
    free.guard("phase", lambda t, y, a, w: np.pi - y[2], reset=again)
    start, most = [-0.98, -0.29, -np.pi], 20
    return stickslip.HybridFamily(
        system, (0.0, 60.0), start, axes=("A", "w"), max_switches=most, record=record
    )


def test_families_have_orbits() -> None:
    text = (Path(__file__).parents[2] / "examples/orbits/oscillator.slip").read_text()
    of_text = stickslip.HybridFamily.of(stickslip.system(text), "a", "w", parameters={"e": 0.8})
    for family in (impacts(), of_text):
        around = ("impact", "phase")
        orbit = family.orbit(1.0, 1.0, start=[-0.98, -0.29, -math.pi], itinerary=around)
        assert abs(orbit.period - 2 * math.pi) < 1e-12 and orbit.admissible
        assert orbit.multipliers is not None
        assert abs(orbit.multipliers[0] + 0.58429531 - 0.00560035j) < 1e-8
        slower = family.orbit(1.0, 0.8, itinerary=around)
        branch = family.branch(slower, family.axes[0], (0.05, 1.2))
        graze = next(it for it in branch.specials if it.kind == "grazing")
        assert abs(graze.value - 0.368781778292) < 1e-10
        curve = family.curve(graze, (0.02, 1.0), (0.6, 1.4))
        for point in curve.points:
            a, w = (point.parameters[name] for name in curve.parameters)
            assert abs(a - math.hypot(1 - w**2, 0.1 * w)) < 1e-11
        with pytest.raises(ValueError, match="axis = 'p'; expected one of"):
            family.branch(slower, "p", (0.0, 1.0))
    with pytest.raises(ValueError, match="functions that can be recorded, but record = False"):
        impacts(record=False).orbit(1.0, 1.0, itinerary=["impact", "phase"])


def test_what_cannot_be_is_refused() -> None:
    ball = stickslip.system(BALL)
    with pytest.raises(ValueError, match="none given; expected one of itinerary, settle and near"):
        ball.orbit()
    with pytest.raises(ValueError, match="a rule of mode main, which has bounce, period"):
        ball.orbit(itinerary=["bonce"])
    with pytest.raises(ValueError, match="expected a list of names"):
        ball.orbit(itinerary="bounce")
    with pytest.raises(ComputationError, match="does not settle"):
        ball.orbit(settle=0.5)
    orbit = ball.orbit(itinerary=["period", "bounce"])
    with pytest.raises(ValueError, match="parameter = 'b'; expected one of a, r"):
        ball.branch(orbit, "b", (0.0, 1.0))
    with pytest.raises(ValueError, match="a = 0.02 is out of range"):
        ball.branch(orbit, "a", (1.0, 2.0))
    decay = stickslip.system("state x = 1\nx' = if x > 0.5 then -1 else 1\nend = 1")
    with pytest.raises(ValueError, match="equations that jump within a mode"):
        decay.orbit(itinerary=["a"])
