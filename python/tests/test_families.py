"""Families of systems of one's own, against closed forms."""

import _thread
import copy
import math
import pickle
import re
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from numba import cfunc, types

import stickslip
from stickslip import (
    Compiled,
    FamilyAtlas,
    Guard,
    HybridFamily,
    HybridSystem,
    Itinerary,
    TraceInterrupted,
    TraceOptions,
    VerifyOptions,
    trace_family,
)

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)
DATA = Path(__file__).parent / "data"
#: Heights and restitutions of the bouncing ball.
HEIGHTS, RESTITUTIONS = (0.5, 2.0), (0.5, 0.8)
END = 2.4
FEW = VerifyOptions(random_points=200, near_points=5)
COARSE = TraceOptions(cells=4)


def compiled(function):
    return Compiled(cfunc(SIGNATURE)(function))


def c_fly(t, y, out, p):
    out[0] = y[1]
    out[1] = -1.0


def c_height(t, y, out, p):
    out[0] = y[0]


def c_bounce(t, y, out, p):
    out[0] = 0.0
    out[1] = -p[1] * y[1]


def c_drop(t, y, out, p):
    out[0] = p[0]
    out[1] = 0.0


def c_clock(t, y, out, p):
    out[0] = 1.0


def ball(end=END, **options):
    """A ball that is dropped from the height p and keeps the part q of its velocity; g = 1."""
    system = HybridSystem()
    fly = system.mode("fly", compiled(c_fly))
    fly.guard("floor", compiled(c_height), reset=compiled(c_bounce))
    named = {"name": "ball", "axes": ("height", "restitution")} | options
    return HybridFamily(system, (0, end), [1.0, 0.0], start=compiled(c_drop), **named)


def plain_ball(
    floor=lambda t, y, p, q: y[0],
    bounce=lambda t, y, p, q: [0.0, -q * y[1]],
    max_switches=None,
):
    """The same one of Python functions that are called and not recorded."""
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y, p, q: [y[1], -1.0])
    fly.guard("floor", floor, reset=bounce)
    start = lambda t, y, p, q: [p, 0.0]  # noqa: E731
    axes = ("height", "restitution")
    begin = (0, END), [1.0, 0.0]
    options = {"name": "ball", "axes": axes, "record": False, "max_switches": max_switches}
    return HybridFamily(system, *begin, start=start, **options)


def bounces(p, q, end=END, most=40):
    """How often the ball has bounced at the end: the k-th time at √(2p) (1 + 2 (q + … + qᵏ⁻¹))."""
    powers = np.asarray(q)[..., None] ** np.arange(1, most)
    times = np.sqrt(2 * np.asarray(p))[..., None] * (1 + 2 * np.cumsum(powers, axis=-1))
    return (np.sqrt(2 * np.asarray(p)) < end).astype(int) + (times < end).sum(axis=-1)


def random_points(count, x, y, seed=1):
    random = np.random.default_rng(seed)
    return random.uniform(*x, count), random.uniform(*y, count)


@pytest.fixture(scope="module")
def atlas():
    return trace_family(ball(), HEIGHTS, RESTITUTIONS)


def test_every_region_of_a_ball_has_its_bounces() -> None:
    window = ((0.2, 1.0), (0.3, 0.9))
    family = ball(4.0, max_switches=8)
    found = trace_family(family, *window)
    assert found.finished and found.objection is None and found.sure_area == pytest.approx(1.0)
    assert not found.unresolved and not found.findings and found.verification["mismatches"] == []
    p, q = random_points(20_000, *window)
    located = found.locate(p, q)
    inside = located.region >= 0
    assert inside.mean() > 0.9999 and not located.doubtful[inside].any()
    expected = np.minimum(bounces(p, q, 4.0), 8)
    assert np.array_equal(located.event_count[inside], expected[inside])
    for curve in found.curves:
        assert curve.margin.guard == "floor" and curve.margin.place == "end"
        (count,) = {len(side.guards) for side in curve.sides if side.kind == "fires"} & {
            len(curve.margin.after)
        }
        x, y = curve.points.T
        powers = sum(y**k for k in range(1, count + 1))
        # The measured error is 1.1e-13.
        assert np.abs(np.sqrt(2 * x) * (1 + 2 * powers) - 4.0).max() < 2e-13
        assert np.allclose(np.hypot(*curve.tangents.T), 1.0, atol=1e-15)


def test_callables_and_any_number_of_threads_give_the_same_bits(atlas: FamilyAtlas) -> None:
    single = trace_family(ball(), HEIGHTS, RESTITUTIONS, threads=1)
    assert single.document == atlas.document
    assert trace_family(ball(), HEIGHTS, RESTITUTIONS, threads=3).document == atlas.document
    options = {"options": COARSE, "verify": FEW}
    called = trace_family(plain_ball(), HEIGHTS, RESTITUTIONS, **options)
    assert called.document == trace_family(ball(), HEIGHTS, RESTITUTIONS, **options).document
    assert called.objection is None and called.statistics["free_runs"] > 0


def test_labels_and_margins() -> None:
    family = ball()
    assert family.guards == ("floor",) and "ball" in repr(family)
    labels = family.labels([[0.55], [1.9]], [0.55, 0.75, 0.79])
    assert labels.shape == (2, 3) and labels[0, 0] == family.label(0.55, 0.55)
    expected = bounces(np.array([[0.55], [1.9]]), np.array([0.55, 0.75, 0.79]))
    assert np.array_equal([[len(one.guards) for one in row] for row in labels], expected)
    assert str(labels[0, 0]) == "floor, floor" and labels[0, 0].kind == "fires"
    assert str(ball(0.3).label(1.0, 0.5)) == "no events"
    ended = ball(4.0, max_switches=2).label(0.5, 0.5)
    assert ended == Itinerary("begins", ("floor", "floor")) and str(ended) == "floor, floor, …"
    assert str(ball(40.0).label(1.0, 0.5)) == "accumulates"
    at_end = [pair for pair in family.margins(1.0, 0.5) if pair[0].place == "end"]
    ((margin, value),) = at_end
    # It leaves the floor with √2/2 at the time √2.
    since = END - math.sqrt(2)
    assert margin.after == ("floor",)
    assert value == pytest.approx(math.sqrt(0.5) * since - 0.5 * since**2, abs=1e-14)


def test_places(atlas: FamilyAtlas) -> None:
    located = atlas.locate([[0.55], [1.9], [5.0], [np.nan]], [0.55, 0.79])
    assert located.region.shape == (4, 2) and (located.region[2:] == -2).all()
    assert located.doubtful[2:].all() and (located.event_count[2:] == -1).all()
    assert located.itinerary[0, 0] == "floor, floor" and located.itinerary[2, 0] == ""
    # √(2p) (1 + 2q) = 2.4
    p = 0.6
    q = 0.5 * (END / math.sqrt(2 * p) - 1)
    on = atlas.locate(p, [q, q - 0.01])
    assert on.region.tolist()[0] == -1 and on.doubtful.tolist() == [True, False]
    assert on.distance[1] == pytest.approx(0.01, abs=1e-10)
    family = ball()
    x, y = np.array([p, p, p, 0.5, 9.0]), np.array([q - 1e-10, q + 1e-10, q - 0.01, 0.5, 0.6])
    decided = atlas.decide(family, x, y)
    assert decided[4] is None
    assert [len(one.guards) for one in decided[:4]] == bounces(x, y)[:4].tolist()
    (curve,) = atlas.curves
    assert sorted(curve.vertices) == [0, 1]
    assert [one.kind for one in atlas.vertices] == ["window-edge"] * 2
    assert all(one.curves == (0,) for one in [*atlas.vertices, *atlas.regions])
    assert sum(one.area for one in atlas.regions) == pytest.approx(0.45)


def test_files(atlas: FamilyAtlas, tmp_path: Path) -> None:
    path = tmp_path / "atlas.json"
    atlas.save(path)
    assert [one.name for one in tmp_path.iterdir()] == ["atlas.json"]
    loaded = FamilyAtlas.load(path)
    assert loaded.document == atlas.document == pickle.loads(pickle.dumps(atlas)).document
    assert loaded.family == "ball" and loaded.axes == ("height", "restitution")
    assert loaded.window == (HEIGHTS, RESTITUTIONS) and loaded.regions == atlas.regions
    with pytest.raises(ValueError, match=r"family-atlas/1"):
        path.write_text('{"schema": "else"}')
        FamilyAtlas.load(path)
    with pytest.raises(ValueError, match="EOF"):
        path.write_text("[")
        FamilyAtlas.load(path)
    path.write_text(re.sub(r'"ends":\[\d', '"ends":[7', atlas._native.json()))
    with pytest.raises(ValueError, match="curves has changed"):
        FamilyAtlas.load(path)
    path.write_text(re.sub(r',"digests":.*', "}", path.read_text()))
    with pytest.raises(ValueError, match="vertex 7"):
        FamilyAtlas.load(path)


def test_a_file_of_rust_is_read(atlas: FamilyAtlas) -> None:
    """That of `hybrid_systems_have_documents` in crates/tracer, without names of guards."""
    of_rust = FamilyAtlas.load(DATA / "ball_atlas.json")
    assert of_rust.objection is None and of_rust.family == "ball"
    assert [one.sides for one in of_rust.curves] == [
        (Itinerary("fires", ("0",)), Itinerary("fires", ("0", "0")))
    ]
    options = of_rust.document["options"]
    trace, verify = TraceOptions(**options["trace"]), VerifyOptions(**options["verify"])
    family = ball(rtol=1e-14, atol=1e-14)
    same = trace_family(family, HEIGHTS, RESTITUTIONS, options=trace, verify=verify)
    assert same.statistics == of_rust.statistics
    # The last bits depend on the processor for which both are built.
    assert np.abs(of_rust.curves[0].points - same.curves[0].points).max() < 1e-13
    p, q = random_points(1000, HEIGHTS, RESTITUTIONS)
    assert np.array_equal(of_rust.locate(p, q).event_count, atlas.locate(p, q).event_count)


def parabolas(*values, end=1.0, **guards):
    """A clock with guards of these values, which only report, from 0 to `end`."""
    system = HybridSystem()
    mode = system.mode("clock", compiled(c_clock))
    for name, value in zip("abcd", values, strict=False):
        mode.guard(name, compiled(value), direction="falling", **guards)
    return HybridFamily(system, (0, end), [0.0], max_step=0.1)


def kinds_inside(found):
    assert found.objection is None
    return [
        (one.kind, one.x, one.y) for one in found.vertices if not one.kind.startswith("window")
    ]


def test_events_that_swap_their_order() -> None:
    """A particle passes p and q; the run ends at 1."""

    def first(t, y, out, p):
        out[0] = p[0] - y[0]

    def second(t, y, out, p):
        out[0] = p[1] - y[0]

    family, window = parabolas(first, second), ((0.2, 1.3), (0.3, 1.2))
    found = trace_family(family, *window, verify=FEW)
    ((kind, x, y),) = kinds_inside(found)
    assert kind == "simultaneous-events" and abs(x - 1) + abs(y - 1) < 1e-9
    assert len(found.curves) == 5 and len(found.regions) == 5
    assert {one.margin.place for one in found.curves} == {"end", "exit"}
    p, q = random_points(5000, *window)
    located = found.locate(p, q)
    text = np.where(p < q, "a, b", "b, a")
    text = np.where(q > 1, "a", np.where(p > 1, "b", text))
    text = np.where((q > 1) & (p > 1), "no events", text)
    inside = located.region >= 0
    assert inside.mean() > 0.999 and np.array_equal(located.itinerary[inside], text[inside])


def test_boundaries_that_have_nothing_to_do_with_each_other_cross() -> None:
    def grazes(t, y, out, p):
        out[0] = (y[0] - 0.3) ** 2 + p[0]

    def late(t, y, out, p):
        out[0] = 1.0 + p[1] - y[0]

    found = trace_family(parabolas(grazes, late), (-0.01, 0.012), (-0.011, 0.01), verify=FEW)
    ((kind, x, y),) = kinds_inside(found)
    assert kind == "crossing" and abs(x) + abs(y) < 1e-9 and len(found.curves) == 4
    assert {one.margin.place for one in found.curves} == {"minimum", "end"}


def belt_switches(velocity, friction, end):
    """How often a mass on a belt breaks away and stops until the end."""
    slip = 2 * np.pi - 2 * np.arctan((1 - friction) / velocity)
    first, period = 1 / velocity, slip + (2 - 2 * friction) / velocity
    return sum(
        (first + k * period + after < end).astype(int) for k in range(9) for after in (0, slip)
    )


def test_a_mass_on_a_belt_in_two_modes() -> None:
    """The belt of the docs with its velocity p and its friction q in slip."""

    def stick(t, y, out, p):
        out[0], out[1] = y[1], 0.0

    def slip(t, y, out, p):
        out[0], out[1] = y[1], p[1] - y[0]

    def breaks(t, y, out, p):
        out[0] = 1.0 - y[0]

    def stops(t, y, out, p):
        out[0] = p[0] - y[1]

    def sticks(t, y, out, p):
        out[0], out[1] = y[0], p[0]

    def begins(t, y, out, p):
        out[0], out[1] = 0.0, p[0]

    system, end, window = HybridSystem(), 12.0, ((0.3, 1.0), (0.2, 0.8))
    sticking, slipping = system.mode("stick", compiled(stick)), system.mode("slip", compiled(slip))
    sticking.guard("breaks away", compiled(breaks), to=slipping)
    slipping.guard("stops", compiled(stops), to=sticking, reset=compiled(sticks), from_zero=1)
    family = HybridFamily(system, (0, end), [0.0, 0.0], "stick", start=compiled(begins))
    found = trace_family(family, *window, verify=FEW)
    assert found.objection is None and family.guards == ("breaks away", "stops")
    p, q = random_points(20_000, *window)
    located = found.locate(p, q)
    inside = located.region >= 0
    assert inside.mean() > 0.999
    assert np.array_equal(located.event_count[inside], belt_switches(p, q, end)[inside])

    # `solve` counts the same, with other code for guards.
    plain = HybridSystem()
    sticking = plain.mode("stick", lambda t, y, p, q: [y[1], 0.0])
    slipping = plain.mode("slip", lambda t, y, p, q: [y[1], q - y[0]])
    sticking.guard("breaks away", lambda t, y, p, q: 1.0 - y[0], to=slipping)
    slipping.guard(
        "stops",
        lambda t, y, p, q: p - y[1],
        to=sticking,
        reset=lambda t, y, p, q: [y[0], p],
        from_zero=1,
    )
    for one in range(20):
        point = (p[one], q[one])
        solved = stickslip.solve(plain, (0, end), [0.0, p[one]], "stick", args=point, t_eval=[])
        assert tuple(solved.events["guard"]) == family.label(*point).guards


def test_two_grazes_in_one_run() -> None:
    def first(t, y, out, p):
        out[0] = (y[0] - 0.3) ** 2 + p[0]

    def second(t, y, out, p):
        out[0] = (y[0] - 0.7) ** 2 + p[1]

    found = trace_family(parabolas(first, second), (-0.01, 0.012), (-0.011, 0.01), verify=FEW)
    ((kind, x, y),) = kinds_inside(found)
    assert kind == "double-graze" and abs(x) + abs(y) < 1e-9
    assert len(found.curves) == 4 and {one.margin.place for one in found.curves} == {"minimum"}


def test_a_graze_that_leaves_through_the_end() -> None:
    def parabola(t, y, out, p):
        out[0] = p[1] + (1.0 + p[0] - y[0]) ** 2

    found = trace_family(parabolas(parabola), (-0.1, 0.12), (-0.11, 0.1), verify=FEW)
    ((kind, x, y),) = kinds_inside(found)
    assert kind == "graze-at-end" and abs(x) + abs(y) < 1e-8


def test_extrema_that_merge_in_a_cusp() -> None:
    """The guard q − p u − 4u³ from u = −1/2 to 1/2. It may fire again where it has risen."""

    def ends(t, y, out, p):
        out[0] = 0.5 - y[0]

    def falls(t, y, out, p):
        out[0] = p[1] - p[0] * y[0] - 4 * y[0] ** 3

    def rises(t, y, out, p):
        out[0] = -p[1] + p[0] * y[0] + 4 * y[0] ** 3

    system = HybridSystem()
    above, below = system.mode("above", compiled(c_clock)), system.mode("below", compiled(c_clock))
    above.guard("end", compiled(ends), terminal=True)
    above.guard("cubic", compiled(falls), direction="falling", to="below")
    below.guard("end", compiled(ends), terminal=True)
    below.guard("cubic", compiled(rises), direction="falling", to="above", from_zero=1)
    family = HybridFamily(system, (0, 2.0), [-0.5], "above", max_step=0.1)
    assert family.guards == ("end", "cubic")
    found = trace_family(family, (-0.1, 0.12), (-0.11, 0.1), verify=FEW)
    kinds = kinds_inside(found)
    # Each branch may have an end of its own there; the measured distance is 1e-13.
    assert kinds and all(kind == "cusp" and abs(x) + abs(y) < 1e-7 for kind, x, y in kinds)
    # 27 q² = −p³ (for a cubic −4u³ − pu + q) where two extrema graze.
    for curve in found.curves:
        assert curve.margin.place in ("minimum", "maximum")
        p, q = curve.points.T
        assert np.abs(27 * q**2 + p**3).max() < 1e-12


def branching(condition):
    """At u = 1/2 the run goes on with a second event if q > p², and without one if not."""

    def half(t, y, out, p):
        out[0] = 0.5 - y[0]

    def late(t, y, out, p):
        out[0] = 0.8 - y[0]

    system = HybridSystem()
    first, more = system.mode("first", compiled(c_clock)), system.mode("more", compiled(c_clock))
    system.mode("no more", compiled(c_clock))
    more.guard("late", compiled(late), to="no more")
    first.guard(
        "half",
        compiled(half),
        transition=lambda t, y, p, q: "more" if q > p * p else "no more",
        condition=condition,
    )
    return HybridFamily(system, (0, 1), [0.0], mode="first", max_step=0.25)


def test_a_transition_that_branches() -> None:
    window = ((-0.5, 0.45), (-0.15, 0.4))
    family = branching(lambda t, y, p, q: q - p * p)
    found = trace_family(family, *window, options=COARSE, verify=FEW)
    assert found.objection is None
    (curve,) = found.curves
    assert curve.margin.place == "branch" and curve.margin.guard == "half"
    assert np.abs(curve.points[:, 1] - curve.points[:, 0] ** 2).max() < 2e-12
    assert {str(side) for side in curve.sides} == {"half", "half, late"}
    # Nobody says where it branches: the change is seen, and has no margin.
    with pytest.warns(stickslip.AtlasWarning, match="unresolved"):
        found = trace_family(branching(None), *window, options=COARSE, verify=FEW)
    assert found.unresolved and all(one.kind == "change" for one in found.unresolved)
    one = found.unresolved[0]
    assert {str(label) for label in one.itineraries} == {"half", "half, late"}
    assert np.abs(one.points[:, 1] - one.points[:, 0] ** 2).max() < 1e-6
    assert "without a boundary" in one.text


def test_a_start_in_a_mode_that_depends_on_the_parameters() -> None:
    system = HybridSystem()
    up = system.mode("up", lambda t, y, p, q: [1.0])
    system.mode("down", lambda t, y, p, q: [-1.0])
    up.guard("top", lambda t, y, p, q: 0.5 - y[0], to="down")
    start = lambda t, y, p, q: ("up" if p < 0.5 else "down", [q])  # noqa: E731
    family = HybridFamily(system, (0, 1), [0.0], "up", start=start)
    assert str(family.label(0.4, 0.0)) == "start, top" and str(family.label(0.6, 0.0)) == "start"
    other = HybridFamily(system, (0, 1), [0.0], "up", start=lambda t, y, p, q: "down")
    assert str(other.label(0.0, 0.0)) == "no events"


def test_many_components_and_guards() -> None:
    """Fifteen clocks at rates 1 to 15 and fifteen guards at p."""

    def clocks(t, y, out, p):
        for one in range(15):
            out[one] = one + 1.0

    def late(t, y, out, p):
        for one in range(15):
            out[one] = p[0] - y[one]

    system = HybridSystem()
    mode = system.mode("run", compiled(clocks))
    mode.guards(compiled(late), *(Guard(name, "falling") for name in "abcdefghijklmno"))
    family = HybridFamily(system, (0, 1), np.zeros(15))
    found = trace_family(family, (11.5, 15.5), (0.0, 1.0), options=COARSE, verify=FEW)
    assert found.objection is None and len(found.curves) == 4
    regions = sorted(found.regions, key=lambda r: r.sample)
    assert [len(one.itinerary.guards) for one in regions] == [4, 3, 2, 1, 0]
    xs = sorted(curve.points[0, 0] for curve in found.curves)
    assert np.abs(np.array(xs) - [12, 13, 14, 15]).max() < 1e-11


def test_names_of_guards_in_several_modes() -> None:
    def system(second, terminal=False):
        made = HybridSystem()
        for name, guards in (("one", "ab"), ("two", second)):
            mode = made.mode(name, lambda t, y, p, q: [0.0])
            for guard in guards:
                mode.guard(guard, lambda t, y, p, q: 1.0, direction="rising", terminal=terminal)
        return HybridFamily(made, (0, 1), [0.0], "one")

    assert system("ab").guards == ("a", "b")
    assert system("b").guards == ("a", "b")
    # The first one counts of those that fire together, so that the order cannot be shared.
    assert system("ba").guards == ("one: a", "one: b", "two: b", "two: a")
    assert system("c", terminal=2).guards == ("a", "b", "c")
    assert system("b", terminal=2).guards == ("a", "one: b", "two: b")


def test_parameters_of_compiled_functions_come_after_those_of_the_point() -> None:
    def passes(t, y, out, p):
        out[0] = p[0] + p[2] * p[1] - p[3] * y[0]

    system = HybridSystem()
    system.mode("clock", compiled(c_clock)).guard(
        "passes", Compiled(cfunc(SIGNATURE)(passes), [2.0, 4.0]), direction="falling"
    )
    family = HybridFamily(system, (0, 1), [0.0])
    x, y = random_points(100, (0, 3), (0, 3))
    fires = [len(one.guards) for one in family.labels(x, y)]
    assert fires == (x + 2 * y < 4).astype(int).tolist()
    found = trace_family(family, (0.5, 3.0), (0.1, 1.5), options=COARSE, verify=FEW)
    (curve,) = found.curves
    assert np.abs(curve.points @ [1, 2] - 4).max() < 1e-12
    pointer = Compiled(0x1000)
    pointer._pointer = 8
    system.mode("other", pointer)
    with pytest.raises(ValueError, match="user data"):
        HybridFamily(system, (0, 1), [0.0], "clock")


def test_arguments_after_the_parameters() -> None:
    system = HybridSystem()
    clock = system.mode("clock", lambda t, y, p, q, rate: [rate])
    clock.guard("passes", lambda t, y, p, q, rate: p - y[0], direction="falling")
    family = HybridFamily(system, (0, 1), [0.0], args=(2.0,))
    assert [len(one.guards) for one in family.labels([1.9, 2.1], 0.0)] == [1, 0]


def test_one_boundary_with_monitors() -> None:
    """The ball falls from its top q² p after the first bounce; where is that top at 0.2?"""
    between = [(0.6, 0.55), (1.9, 0.75)]
    tops = [lambda p, q: q * q * p - 0.2, lambda p, q: math.nan]
    for family in (ball(), plain_ball()):
        found = family.follow(HEIGHTS, RESTITUTIONS, between, tops)
        assert found.ends == ("window-edge", "window-edge")
        assert found.values.shape == (2, len(found.points)) and np.isnan(found.values[1]).all()
        p, q = found.points.T
        assert np.abs(np.sqrt(2 * p) * (1 + 2 * q) - END).max() < 1e-11
        assert np.array_equal(found.values[0], q * q * p - 0.2)
        assert {len(side.guards) for side in found.sides} == {1, 2}
        (zero,) = found.zeros
        root = END - 2 * math.sqrt(0.4)
        exact = 0.5 * root**2, math.sqrt(0.4) / root
        assert zero.monitor == 0 and zero.point == pytest.approx(exact, abs=1e-10)
    assert family.follow(HEIGHTS, RESTITUTIONS, [between[0], between[0]]) is None
    with pytest.raises(ZeroDivisionError):
        family.follow(HEIGHTS, RESTITUTIONS, between, [lambda p, q: 1 / 0])
    with pytest.raises(TypeError, match="monitor 0"):
        family.follow(HEIGHTS, RESTITUTIONS, between, [3.0])
    with pytest.raises(ValueError, match="two points"):
        family.follow(HEIGHTS, RESTITUTIONS, [0.6, 0.55])
    with pytest.raises(ValueError, match="max_angle"):
        family.follow(HEIGHTS, RESTITUTIONS, between, options=TraceOptions(max_angle=2))


@pytest.mark.parametrize("calls", [0, 1, 4])
def test_a_cancelled_trace_goes_on_to_the_same_bits(atlas, tmp_path, calls) -> None:
    left = iter(range(calls))
    begun = trace_family(
        ball(), HEIGHTS, RESTITUTIONS, cancelled=lambda: next(left, None) is None
    )
    assert not begun.finished
    assert "not finished" in repr(begun) and "not finished" in begun.objection
    assert begun.locate(0.6, 0.55).doubtful and all(one.doubtful for one in begun.regions)
    begun.save(tmp_path / "begun.json")
    read = FamilyAtlas.load(tmp_path / "begun.json")
    assert read.document == begun.document
    done = read.resume(ball(), threads=1)
    assert done.finished and done.document == atlas.document
    assert done.resume(ball()).document == done.document
    with pytest.raises(ValueError, match='of the family "ball"'):
        begun.resume(ball(name="another"))


def test_progress(atlas: FamilyAtlas) -> None:
    seen: list[tuple[int, int]] = []
    found = trace_family(
        ball(), HEIGHTS, RESTITUTIONS, progress=lambda done, steps: seen.append((done, steps))
    )
    assert found.document == atlas.document
    assert len(seen) >= 2 and all(0 <= done <= steps for done, steps in seen)
    # The last stage is the verification, or a second look.
    assert seen[-1][0] == seen[-1][1]


@pytest.mark.parametrize("make", [ball, plain_ball])
def test_exceptions_of_those_who_watch(make) -> None:
    def fails(*_):
        raise LookupError("watching")

    with pytest.raises(LookupError, match="watching"):
        trace_family(make(), HEIGHTS, RESTITUTIONS, progress=fails)
    with pytest.raises(LookupError, match="watching"):
        trace_family(make(), HEIGHTS, RESTITUTIONS, cancelled=fails)
    with pytest.raises(TypeError, match="progress is of type int"):
        trace_family(make(), HEIGHTS, RESTITUTIONS, progress=3)


@pytest.mark.parametrize("make", [lambda: ball(60.0, max_switches=60, max_step=1e-3), plain_ball])
def test_an_interrupted_trace_can_go_on(make) -> None:
    family = make()
    pressed: list[float] = []

    def press(*_: object) -> None:
        if not pressed:
            pressed.append(time.monotonic())
            _thread.interrupt_main()

    options = {"options": TraceOptions(cells=16), "verify": FEW}
    with pytest.raises(KeyboardInterrupt) as stopped:
        trace_family(family, HEIGHTS, RESTITUTIONS, **options, progress=press)
    assert time.monotonic() - pressed[0] < 10
    assert isinstance(stopped.value, TraceInterrupted)
    begun = stopped.value.atlas
    assert not begun.finished
    if make is plain_ball:
        whole = trace_family(ball(), HEIGHTS, RESTITUTIONS, **options)
        assert begun.resume(ball()).document == whole.document


def test_a_second_interruption_ends_the_run_that_is_under_way() -> None:
    def floor(t, y, p, q):
        while True:
            time.sleep(0.01)

    timers = [threading.Timer(seconds, _thread.interrupt_main) for seconds in (0.3, 0.8)]
    for timer in timers:
        timer.start()
    with pytest.raises(KeyboardInterrupt) as stopped:
        # Without the search for events that accumulate, which the first one ends.
        trace_family(plain_ball(floor, max_switches=60), HEIGHTS, RESTITUTIONS)
    assert type(stopped.value) is KeyboardInterrupt
    for timer in timers:
        timer.cancel()


def test_an_exception_of_a_function_comes_out_with_its_place() -> None:
    def floor(t, y, p, q):
        if p > 1.2:
            raise ArithmeticError("too high")
        return y[0]

    with pytest.raises(ArithmeticError, match="too high") as raised:
        trace_family(plain_ball(floor), HEIGHTS, RESTITUTIONS)
    (note,) = raised.value.__notes__
    assert note.startswith("with the parameters (")
    assert float(note.split("(")[1].split(",")[0]) > 1.2
    with pytest.raises(ArithmeticError):
        plain_ball(floor).label(1.5, 0.5)
    with pytest.raises(ArithmeticError):
        plain_ball(floor).margins(1.5, 0.5)
    with pytest.raises(ArithmeticError):
        plain_ball(floor).follow(HEIGHTS, RESTITUTIONS, [(0.6, 0.55), (1.9, 0.75)])
    assert str(plain_ball(floor).label(1.1, 0.5)) == "floor"


@pytest.mark.parametrize(
    ("value", "error", "message"),
    [
        (None, TypeError, "it returns None"),
        ("1", TypeError, "guard 'floor' of mode 'fly'"),
        ([1.0, 2.0], ValueError, "shape"),
        (True, TypeError, "a bool"),
        (1j, TypeError, "complex"),
    ],
)
def test_values_that_are_no_numbers(value, error, message) -> None:
    with pytest.raises(error, match=message):
        trace_family(plain_ball(lambda t, y, p, q: value), HEIGHTS, RESTITUTIONS)
    with pytest.raises((TypeError, ValueError), match="the reset of guard 'floor'"):
        trace_family(plain_ball(bounce=lambda t, y, p, q: [1.0]), HEIGHTS, RESTITUTIONS)


def test_where_a_function_has_no_value_runs_fail_and_others_do_not() -> None:
    """Behind p = 1 the right-hand side is NaN: a region of its own, whose edge has no margin."""

    def nowhere(t, y, out, p):
        out[0] = y[1]
        out[1] = -1.0 if p[0] < 1.0 else np.nan

    system = HybridSystem()
    system.mode("fly", compiled(nowhere)).guard(
        "floor", compiled(c_height), reset=compiled(c_bounce)
    )
    family = HybridFamily(system, (0, END), [1.0, 0.0], start=compiled(c_drop))
    assert family.label(1.5, 0.5) == Itinerary("fails")
    with pytest.warns(stickslip.AtlasWarning, match="unresolved"):
        found = trace_family(family, HEIGHTS, RESTITUTIONS, options=COARSE, verify=FEW)
    assert found.finished and found.objection is not None
    assert all(one.kind == "change" for one in found.unresolved)
    near = np.concatenate([one.points for one in found.unresolved])
    assert np.abs(near[:, 0] - 1).max() < 1e-6
    # The boundary before it is traced, and no wrong label is given without a doubt.
    p, q = found.curves[0].points.T
    assert np.abs(np.sqrt(2 * p) * (1 + 2 * q) - END).max() < 1e-11
    p, q = random_points(2000, HEIGHTS, RESTITUTIONS)
    located = found.locate(p, q)
    sure = ~located.doubtful
    count = np.where(p < 1, bounces(p, q), -1)
    assert np.array_equal(located.event_count[sure], count[sure])
    decided = found.decide(family, p, q)
    assert [len(one.guards) if one.kind == "fires" else -1 for one in decided] == count.tolist()


def test_windows_and_options_that_are_none() -> None:
    family = ball()
    for x in ((2.0, 0.5), (1.0, 1.0), (0.5, np.nan), (0.5, np.inf), (0.5,), 3.0, "ab", None):
        with pytest.raises((ValueError, TypeError), match=r"x\b"):
            trace_family(family, x, RESTITUTIONS)
    for options in (
        {"tolerance": 0.0},
        {"tolerance": np.nan},
        {"tolerance": 1e-3},
        {"rounds": 0},
        {"threads": 0},
        {"options": TraceOptions(tolerance=1.0)},
        {"options": TraceOptions(cells=1)},
        {"options": TraceOptions(cells=-1)},
        {"options": TraceOptions(noise=np.inf)},
        {"verify": VerifyOptions(nearest=1.0)},
        {"verify": VerifyOptions(random_points=-1)},
    ):
        with pytest.raises(ValueError, match=r"expected|tolerance|distances"):
            trace_family(family, HEIGHTS, RESTITUTIONS, **options)
    with pytest.raises(TypeError, match="not a HybridFamily"):
        trace_family(HybridSystem(), HEIGHTS, RESTITUTIONS)
    with pytest.raises(stickslip.ComputationError, match="regions"):
        most = TraceOptions(max_curves=2)
        trace_family(ball(4.0, max_switches=8), (0.2, 1.0), (0.3, 0.9), options=most)


def test_numbers_of_other_kinds() -> None:
    """Arrays, integers, NumPy's numbers; parameters that are masked or not finite have no run."""
    masked = np.ma.array([0.6, 0.6], mask=[False, True])
    kinds = [one.kind for one in ball().labels(masked, 0.55)]
    assert kinds == ["fires", "fails"]
    assert [one.kind for one in ball().labels([np.nan, np.inf], 0.5)] == ["fails"] * 2
    assert ball().labels([], []).shape == (0,)
    with pytest.raises(TypeError, match="complex"):
        ball().labels([1j], 0.5)
    with pytest.raises(ValueError, match="broadcast"):
        ball().labels([1, 2, 3], [1, 2])

    def keeps(t, y, p, q, kept=[]):  # noqa: B006
        kept.append(y)
        y[:] = 5.0
        return np.float64(p) - t

    system = HybridSystem()
    clock = system.mode("clock", lambda t, y, p, q: (1,))
    clock.guard("passes", keeps, direction="falling")
    family = HybridFamily(system, (0, 1), [0])
    found = trace_family(family, (0, 2), (0, 1), options=COARSE, verify=FEW)
    (curve,) = found.curves
    assert found.objection is None and np.abs(curve.points[:, 0] - 1).max() < 1e-12


def test_a_wide_window_and_edges_on_curves() -> None:
    """The guard p − u passes zero for p from 0 to 1."""

    def passes(t, y, out, p):
        out[0] = p[0] - y[0]

    family = parabolas(passes)
    wide = trace_family(family, (-1e4, 2e4), (-1e4, 1e4), tolerance=1e-6, verify=FEW)
    assert wide.objection is None and len(wide.regions) == 3
    xs = sorted(curve.points[0, 0] for curve in wide.curves)
    assert np.abs(np.array(xs) - [0, 1]).max() < 1e-9
    exactly = trace_family(family, (0.0, 1.0), (0.0, 1.0), options=COARSE, verify=FEW)
    assert exactly.objection is None and len(exactly.regions) == 1
    assert [str(one) for one in exactly.decide(family, 0.5, [0.0, 0.5])] == ["a", "a"]


def test_families_that_are_none() -> None:
    system = HybridSystem()
    with pytest.raises(ValueError, match="no modes"):
        HybridFamily(system, (0, 1), [0.0])
    with pytest.raises(TypeError, match="not a HybridSystem"):
        HybridFamily(lambda t, y: y, (0, 1), [0.0])
    system.mode("one", lambda t, y, p, q: [0.0])
    for arguments, error in (
        (((1, 0), [0.0]), "end after"),
        (((0, np.inf), [0.0]), "infinite"),
        (((0, 1), [np.nan]), "finite"),
        (((0, 1), [[0.0]]), "dimensions"),
        (((0, 1), [0.0], "two"), "mode = 'two'"),
    ):
        with pytest.raises(ValueError, match=error):
            HybridFamily(system, *arguments)
    for options in ({"rtol": 0.0}, {"axes": "xy"}, {"max_switches": 0}, {"start": 3}, {"name": 1}):
        with pytest.raises((ValueError, TypeError)):
            HybridFamily(system, (0, 1), [0.0], **options)
    # Functions without a name cannot be pickled, but their family is copied.
    with pytest.raises((AttributeError, pickle.PicklingError), match="<lambda>"):
        pickle.dumps(HybridFamily(system, (0, 1), [0.0]))
    assert copy.deepcopy(HybridFamily(system, (0, 1), [0.0])).label(0.5, 0.5).kind == "fires"
    # No guards, and no curves.
    found = trace_family(
        HybridFamily(system, (0, 1), [0.0]), (0, 1), (0, 1), options=COARSE, verify=FEW
    )
    labels = [str(one.itinerary) for one in found.regions]
    assert found.objection is None and labels == ["no events"]


def test_small_and_far_windows() -> None:
    p = 0.6
    q = 0.5 * (END / math.sqrt(2 * p) - 1)
    for size in (1e-3, 1e-5):
        window = ((p - size, p + size), (q - size, q + size))
        found = trace_family(ball(), *window, tolerance=1e-11, options=COARSE, verify=VerifyOptions(
            random_points=200, near_points=5, nearest=1e-10, farthest=0.1 * size
        ))  # fmt: skip
        assert found.objection is None and len(found.curves) == 1
        x, y = found.curves[0].points.T
        assert np.abs(np.sqrt(2 * x) * (1 + 2 * y) - END).max() < 1e-11


def test_traces_on_several_threads_of_python(atlas: FamilyAtlas) -> None:
    family, found = ball(), []

    def work():
        found.append(trace_family(family, HEIGHTS, RESTITUTIONS, threads=1).document)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [atlas.document] * 3


def test_a_function_may_trace_and_run() -> None:
    def floor(t, y, p, q):
        stickslip.solve(lambda t, y: -y, (0, 1), [1.0], t_eval=[])
        return y[0]

    assert str(plain_ball(floor).label(1.0, 0.5)) == "floor"

    def deeper(t, y, p, q):
        return plain_ball(deeper).margins(p, q)[0][1]

    with pytest.raises(RecursionError):
        plain_ball(deeper).label(1.0, 0.5)


def test_pictures(atlas: FamilyAtlas) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ax = atlas.plot(linewidth=2.0)
    assert len(ax.lines) == len(atlas.curves) and ax.get_xlabel() == "height"
    assert {text.get_text() for text in ax.texts} == {"1", "2"}
    svg = atlas.picture()
    assert svg.startswith("<svg") and svg.rstrip().endswith("</svg>") and "restitution" in svg
    assert atlas._repr_html_() == svg
    matplotlib.pyplot.close("all")


def test_clocks_and_jumps_are_of_families():
    """A dose at 1 lifts the level to 2 where dose = 2 - exp(-rate)."""
    tank = HybridSystem()
    empties = tank.mode("empties", lambda t, y, rate, dose: -rate * y)
    empties.at("dose", [1.0], reset=lambda t, y, rate, dose: y + dose)
    empties.guard("high", lambda t, y, rate, dose: y - 2.0, direction="rising", sees_jumps=True)
    family = HybridFamily(tank, (0.0, 3.0), [1.0])
    assert str(family.label(1.0, 1.5)) == "dose"
    assert str(family.label(1.0, 1.7)) == "dose, high"
    found = family.follow((0.5, 1.5), (1.2, 2.0), [(1.0, 1.5), (1.0, 1.7)])
    rate, dose = found.points.T
    assert len(rate) > 3 and np.abs(dose - 2.0 + np.exp(-rate)).max() < 1e-11


def test_families_rest():
    ball = HybridSystem()
    fly = ball.mode("fly", lambda t, y, restitution, g: [y[1], -g])
    fly.guard(
        "floor",
        lambda t, y, restitution, g: y[0],
        reset=lambda t, y, restitution, g: [0.0, -restitution * y[1]],
        rest=lambda t, y, restitution, g: ("lie", [0.0, 0.0]),
    )
    lie = ball.mode("lie", lambda t, y, restitution, g: [0.0, 0.0])
    lie.at("kick", [4.0], to="fly", reset=lambda t, y, restitution, g: [0.0, g])
    family = HybridFamily(ball, (0.0, 5.0), [1.0, 0.0], "fly")
    # It lies from 3 on, is kicked at 4, and is in the air then.
    found = family.label(0.5, 2.0)
    assert found.kind == "fires" and found.guards[-2:] == ("floor", "kick")
