"""Families whose functions are recorded, and families of formulas."""

import math

import numpy as np
import pytest
import stickslip
from stickslip import HybridFamily, HybridSystem, TraceOptions, VerifyOptions, trace_family

FEW = {"options": TraceOptions(cells=6), "verify": VerifyOptions(200, 4)}
BALL = """
parameter height = 1, restitution = 0.5, gravity = 1
state x = height, v = 0
x' = v
v' = -gravity
when x < 0 "floor"
  x := 0
  v := -restitution*v
end = 2.4
"""


def ball(record=None, **options):
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y, p, q: [y[1], -1.0])
    fly.guard("floor", lambda t, y, p, q: y[0], reset=lambda t, y, p, q: [0.0, -q * y[1]])
    start = lambda t, y, p, q: [p, 0.0]  # noqa: E731
    begin = (0.0, 2.4), [1.0, 0.0]
    return HybridFamily(system, *begin, start=start, record=record, max_switches=4, **options)


def points_of(atlas):
    return np.concatenate([curve.points for curve in atlas.curves])


def bounce(n, height, restitution):
    powers = [2.0 * restitution**k for k in range(1, n)]
    return math.sqrt(2.0 * height) * (1.0 + sum(powers))


def test_a_recorded_family_has_the_atlas_of_its_closed_form() -> None:
    family = ball()
    assert family.reason is None
    atlas = trace_family(family, (0.5, 1.5), (0.3, 0.6), **FEW)
    assert atlas.objection is None and len(atlas.curves) == 3
    for curve in atlas.curves:
        n = 1 + len(curve.margin.after)
        for height, restitution in curve.points:
            assert abs(bounce(n, height, restitution) - 2.4) < 1e-8, (n, height, restitution)
    single = trace_family(family, (0.5, 1.5), (0.3, 0.6), threads=1, **FEW)
    assert single.document == atlas.document


def test_a_system_of_formulas_has_the_same_atlas() -> None:
    system = stickslip.system(BALL)
    family = HybridFamily.of(system, "height", "restitution", max_switches=4, name="ball")
    assert family.guards == ("floor",) and family.axes == ("height", "restitution")
    one = trace_family(family, (0.5, 1.5), (0.3, 0.6), **FEW)
    other = trace_family(ball(), (0.5, 1.5), (0.3, 0.6), **FEW)
    assert [len(curve.points) for curve in one.curves] == [len(c.points) for c in other.curves]
    assert np.allclose(points_of(one), points_of(other), rtol=0, atol=1e-9)
    # Other values of the rest, and another end.
    moon = HybridFamily.of(system, "height", "restitution", parameters={"gravity": 0.25}, end=4.8)
    found = moon.labels([1.0, 0.6], [0.4, 0.5]).tolist()
    assert [str(label) for label in found] == ["floor", "floor, floor"]


def test_what_depends_on_more_falls_back() -> None:
    count = [0]

    def counts(t, y, p, q):
        count[0] += 1
        return y[0] - 1e-9 * count[0]

    system = HybridSystem()
    fly = system.mode("fly", lambda t, y, p, q: [y[1], -1.0])
    fly.guard("floor", counts, terminal=True)
    family = HybridFamily(system, (0, 2), [1.0, 0.0])
    assert family.reason is not None and "floor" in family.reason
    with pytest.raises(ValueError, match="record = True, but guard 'floor'"):
        HybridFamily(system, (0, 2), [1.0, 0.0], record=True)
    assert "record = False" in str(ball(record=False).reason)


def test_formulas_are_compared_before_they_are_used() -> None:
    factor = np.array([1.0])
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y, p, q: [y[1], -factor[0]])
    fly.guard("floor", lambda t, y, p, q: y[0] + p, terminal=True)
    family = HybridFamily(system, (0, 2), [1.0, 0.0])
    assert family.reason is None
    factor[0] = 2.0
    family.label(0.0, 0.0)
    assert "depends on more than t and y" in str(family.reason)
    factor[0] = 1.0
    strict = HybridFamily(system, (0, 2), [1.0, 0.0], record=True)
    factor[0] = 2.0
    with pytest.raises(ValueError, match="the right-hand side of mode 'fly'"):
        strict.label(0.0, 0.0)


def test_a_transition_that_chooses_is_recorded() -> None:
    """A ball on a plate that breaks: fast, it falls through."""

    def lands(t, y, p, q):
        if y[1] < -p:
            return "below"
        return "above", [0.0, -q * y[1]]

    def choosing(record):
        system = HybridSystem()
        above = system.mode("above", lambda t, y, p, q: [y[1], -1.0])
        system.mode("below", lambda t, y, p, q: [y[1], -1.0])
        above.guard("plate", lambda t, y, p, q: y[0], transition=lands)
        start = [1.0, 0.0]
        return HybridFamily(system, (0, 4), start, "above", record=record, max_switches=5)

    # What it returns depends on the way: a state on one, none on the other.
    assert "depends on a condition" in str(choosing(None).reason)

    def lands(t, y, p, q):  # noqa: F811
        if y[1] < -p:
            return "below", [0.0, y[1]]
        return "above", [0.0, -q * y[1]]

    recorded, called = choosing(None), choosing(False)
    assert recorded.reason is None
    x, y = np.meshgrid(np.linspace(0.3, 2.0, 9), np.linspace(0.2, 0.8, 5))
    one, other = recorded.labels(x, y), called.labels(x, y)
    assert (one == other).all() and len(set(map(str, one.ravel()))) > 2
    # It falls through if it is faster than p: at √2.
    atlas = trace_family(recorded, (1.2, 1.6), (0.2, 0.4), **FEW)
    assert any(abs(curve.points[:, 0] - math.sqrt(2)).max() < 1e-9 for curve in atlas.curves)


def test_guards_that_are_counted_in_each_mode_are_not_recorded() -> None:
    def family(record=None):
        system = HybridSystem()
        one = system.mode("one", lambda t, y, p, q: [1.0])
        two = system.mode("two", lambda t, y, p, q: [1.0])
        up = lambda t, y, p, q: y[0] - p  # noqa: E731
        reset = lambda t, y, p, q: [0.0]  # noqa: E731
        one.guard("up", up, direction="rising", to="two", reset=reset, terminal=2)
        two.guard("up", up, direction="rising", to="one", reset=reset, terminal=2)
        return HybridFamily(system, (0, 10), [0.0], "one", record=record)

    assert "counted until the run ends" in str(family().reason)
    found = family().label(1.0, 0.0)
    assert found == family(False).label(1.0, 0.0) and len(found.guards) == 2


def test_what_does_not_fit_is_refused() -> None:
    system = stickslip.system(BALL)
    for arguments, options, message in [
        (("height", "mass"), {}, "'mass' is no parameter"),
        (("height", "height"), {}, "two different parameters"),
        (("height", "gravity"), {"parameters": {"mass": 1.0}}, "'mass' is no parameter"),
        (("height", "gravity"), {"rtol": 0.5}, "rtol"),
        (("height", "gravity"), {"end": math.nan}, "end"),
    ]:
        with pytest.raises(ValueError, match=message):
            HybridFamily.of(system, *arguments, **options)
    with pytest.raises(TypeError, match="expected HybridFamily.of"):
        HybridFamily(system, (0, 1), [1.0])
    with pytest.raises(TypeError, match="is not a FormulaSystem"):
        HybridFamily.of(HybridSystem(), "p", "q")


@pytest.mark.parametrize("record", [True, False])
def test_a_start_exists_under_conditions(record, tmp_path) -> None:
    system = HybridSystem()
    fall = system.mode("fall", lambda t, y, p, q: [-1.0])
    fall.guard("floor", lambda t, y, p, q: y[0], direction="falling")
    asked = []

    def start(t, y, p, q):
        return [q + np.sqrt(p)]

    def plain(t, y, p, q):
        asked.append(p)
        return [q + (math.sqrt(p) if p >= 0 else math.nan)]

    family = HybridFamily(
        system,
        (0.0, 1.0),
        [1.0],
        start=start if record else plain,
        requires=[lambda t, y, p, q: p, lambda t, y, p, q: 1.0 + y[0] - q - p],
        record=record,
    )
    assert (family.reason is None) == record
    assert str(family.label(-1.0, 1.0)) == "no start"
    assert str(family.label(1.0, 1.5)) == "no start, by condition 2"
    assert family.label(1.0, 1.5) == stickslip.Itinerary("no_start", condition=1)
    margins = dict(family.margins(-1.0, 1.0))
    assert margins == {stickslip.FamilyMargin((), "condition 1", "condition"): -1.0}
    asked.clear()
    family.labels(-0.5, [0.5, 1.0, 1.5])
    # Where no run starts, nothing asks for the start.
    assert not asked
    atlas = trace_family(family, (-0.5, 1.5), (0.1, 1.9), **FEW)
    assert atlas.objection is None and len(atlas.regions) == 4
    assert not any(region.doubtful for region in atlas.regions)
    kinds = {str(region.itinerary) for region in atlas.regions}
    assert kinds == {"no start", "no start, by condition 2", "no events", "floor"}
    for curve in atlas.curves:
        if curve.margin.place == "condition":
            off = {
                "condition 1": lambda p, q: p,
                "condition 2": lambda p, q: 2.0 - q - p,
            }[curve.margin.guard]
            assert max(abs(off(p, q)) for p, q in curve.points) < 1e-9
    atlas.save(tmp_path / "atlas.json")
    read = stickslip.FamilyAtlas.load(tmp_path / "atlas.json")
    assert [one.itinerary for one in read.regions] == [one.itinerary for one in atlas.regions]


def test_what_a_start_requires_is_checked() -> None:
    text = "parameter a = 1, b = 1\nstate x = 1\nx' = -a\nrequires a > b\nend = 1"
    system = stickslip.system(text)
    with pytest.raises(ValueError, match="condition 1 that the system requires"):
        system.solve()
    family = HybridFamily.of(system, "a", "b")
    assert [str(one) for one in family.labels([2.0, 1.0], 1.5)] == ["no events", "no start"]
    plain = HybridSystem()
    fall = plain.mode("fall", lambda t, y, p, q: [-1.0])
    fall.guard("floor", lambda t, y, p, q: y[0], direction="falling")
    with pytest.raises(TypeError, match="requires 2 is of type int"):
        HybridFamily(plain, (0.0, 1.0), [1.0], requires=[lambda t, y, p, q: p, 3])


def test_effort_and_progress_in_words() -> None:
    family, said = ball(), []

    def report(done, steps, doing):
        said.append(doing)

    atlas = trace_family(family, (0.5, 1.5), (0.3, 0.6), effort="screen", progress=report)
    options = atlas.document["options"]
    assert options["effort"] == "screen" and options["verify"]["random_points"] == 250
    assert options["rounds"] == 1 and len(atlas.curves) == 3 and atlas.objection is None
    assert said and all(isinstance(one, str) for one in said)
    few = trace_family(family, (0.5, 1.5), (0.3, 0.6), effort="certain", **FEW)
    assert few.document["options"]["verify"]["random_points"] == 200
    assert few.document["options"]["rounds"] == 16
    with pytest.raises(ValueError, match='effort = "much"; expected one of screen, default'):
        trace_family(family, (0.5, 1.5), (0.3, 0.6), effort="much")
    window = (5.0, 6.0), (2.5, 3.0)
    screened = stickslip.trace(*window, effort="screen").document["verification"]
    assert (screened["effort"], screened["random_points"]) == ("screen", 500)
    assert "effort" not in stickslip.trace(*window).document["verification"]
