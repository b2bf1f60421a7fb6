"""Systems with surfaces, variables and accumulating events, as formulas, against closed forms."""

import math
import pickle
import warnings

import numpy as np
import pytest

import stickslip
from stickslip import HybridFamily, HybridSystem, TraceOptions, VerifyOptions, solve, trace_family

FEW = {"options": TraceOptions(cells=8), "verify": VerifyOptions(random_points=200)}


def cross(rate=None):
    """Both surfaces hold the state as long as rate·t < 5/2."""
    system = HybridSystem(sliding={"x": lambda t, y, *p: y[0], "y": lambda t, y, *p: y[1]})

    def slope(t, y, sign, *p):
        push = (p[0] if p else 1.0) * t
        return [-sign.x - sign.y / 2, push - 2 * sign.y + sign.x]

    system.mode("main", slope)
    return system


def test_two_surfaces_are_decided() -> None:
    found = solve(cross(), (0, 4), [1.5, 0.75])
    assert found.guards == "decided"
    times = [1.0, 2.5 - math.sqrt(1.75), 2.5]
    assert np.abs(found.events["time"] - times).max() < 1e-13
    assert found.events["guard"].tolist() == ["x", "y", "y"]
    assert set(found.mode) == {"main"}
    assert found.events["sides_to"]["x"].tolist() == [0, 0, 0]
    assert found.events["sides_to"]["y"].tolist() == [1, 0, 1]
    assert (found.sides["x"][0], found.sides["y"][-1]) == (1, 1)
    assert np.abs(found.y[:, -1] - [0.0, 1.125]).max() < 1e-13
    called = solve(cross(), (0, 4), [1.5, 0.75], record=False)
    assert called.guards.startswith("sampled")
    assert called.events.dtype == found.events.dtype
    for name in ("guard", "from", "to", "sides_from", "sides_to", "unique"):
        assert (called.events[name] == found.events[name]).all()
    again = pickle.loads(pickle.dumps(found))
    assert again.sides["y"].tolist() == found.sides["y"].tolist()
    # Where it could go on in several ways, functions say so as before.
    away = HybridSystem(sliding={"x": lambda t, y: y[0]})
    away.mode("main", lambda t, y, sign: [sign.x])
    with pytest.raises(ValueError, match="not unique"):
        solve(away, (0, 1), [0.0])
    found = solve(away, (0, 1), [0.0], sides={"x": -1}, record=False)
    assert abs(found.y[0, -1] + 1.0) < 1e-14


def test_families_and_many_runs_of_surfaces_are_decided() -> None:
    start = lambda t, y, p, q: [1.5, q]  # noqa: E731
    families = [
        HybridFamily(cross(), (0, 4), [0.0, 0.0], start=start, record=record)
        for record in (None, False)
    ]
    assert families[0].reason is None and families[0].guards == families[1].guards
    x, y = np.meshgrid([0.3, 0.5, 0.62, 0.63, 0.9], [0.9, 1.2])
    one, other = (family.labels(x, y) for family in families)
    assert (one == other).all() and len(set(map(str, one.ravel()))) == 2
    # y is let go of before the end where 4p > 5/2.
    atlas = trace_family(families[0], (0.5, 0.8), (0.9, 1.2), **FEW)
    (curve,) = atlas.curves
    assert np.abs(curve.points[:, 0] - 0.625).max() < 1e-9
    rates = [0.5, 0.8, 1.0]
    found = stickslip.solve_many(cross(), (0, 4), [1.5, 0.75], parameters={"rate": rates})
    assert found.event_count.values.tolist() == [2, 3, 3] and found.decided.all()
    behind = [max(0.0, 4 - 2.5 / rate) ** 2 * rate / 2 for rate in rates]
    assert np.abs(found.end_state.sel(component="y1") - behind).max() < 1e-12


def heater():
    system = HybridSystem(variables={"on": 1.0, "count": 0.0})
    room = system.mode("room", lambda t, y, now, *p: 3.0 * now.on - y * (p[1] if p else 1.0))
    warm = lambda t, y, now, *p: (p[0] if p else 2.0) - y  # noqa: E731
    switch = lambda t, y, now, *p: {"on": 0.0, "count": now.count + 1}  # noqa: E731
    room.guard("warm", warm, direction="falling", sets=switch)
    return system


def test_families_and_many_runs_with_variables_are_decided() -> None:
    families = [HybridFamily(heater(), (0, 2), [0.0], record=record) for record in (None, False)]
    assert families[0].reason is None
    x, y = np.meshgrid([1.0, 1.5, 2.0, 2.5], [0.8, 1.0, 1.2])
    one, other = (family.labels(x, y) for family in families)
    assert (one == other).all() and len(set(map(str, one.ravel()))) == 2
    found = stickslip.solve_many(
        heater(), (0, 2), [0.0], parameters={"limit": [1.0, 2.0], "rate": [1.0]}
    )
    assert found.decided.all()
    off = -np.log(1 - np.array([1.0, 2.0]) / 3)
    assert np.abs(found.event_time.values - off).max() < 1e-9
    end = found.end_state.sel(component=["y0", "on", "count"]).values.reshape(2, 3)
    assert np.abs(end[:, 0] - np.array([1.0, 2.0]) * np.exp(off - 2)).max() < 1e-9
    assert (end[:, 1:] == [0.0, 1.0]).all()


def ball():
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y, height, e: [y[1], -1.0])
    fly.guard("floor", lambda t, y, height, e: y[0], reset=lambda t, y, height, e: [0.0, -e * y[1]])
    return system


def test_events_that_accumulate_are_few_in_an_atlas() -> None:
    start = lambda t, y, height, e: [height, 0.0]  # noqa: E731
    family = HybridFamily(ball(), (0, 3), [1.0, 0.0], start=start)
    # Bounce n comes at √(2h)·(1 + 2e + … + 2eⁿ⁻¹), and all of them before the end where e is small.
    with pytest.warns(UserWarning, match="told apart up to event"):
        atlas = trace_family(family, (0.5, 1.0), (0.3, 0.6), **FEW)
    assert atlas.finished and atlas.sure_area > 0.99 * 0.5 * 0.3
    for curve in atlas.curves:
        height, e = curve.points.T
        bounces = len(curve.margin.after) + 1
        last = np.sqrt(2 * height) * (1 + 2 * sum(e**n for n in range(1, bounces)))
        assert np.abs(last - 3).max() < 1e-8
    # A number that is given is not replaced, and an atlas without accumulation needs none.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        given = HybridFamily(ball(), (0, 3), [1.0, 0.0], start=start, max_switches=3)
        trace_family(given, (0.5, 1.0), (0.3, 0.6), **FEW)
    assert family.label(0.5, 0.4).kind == "accumulates"


def test_a_text_that_chooses_has_the_boundary_of_its_condition() -> None:
    plate = stickslip.system("""
        parameter strength = 1, e = 0.5
        state x = 1, v = 0
        x' = v
        v' = -1
        mode above
          when x < 0 "plate" if v < -strength -> below else -> above
            x := 0
            v := if v < -strength then v else -e*v
        mode below
          when x < -1 "ground" -> end
        start in above
        end = 4
    """)
    family = HybridFamily.of(plate, "strength", "e", max_switches=5)
    atlas = trace_family(family, (1.2, 1.6), (0.2, 0.4), **FEW)
    # It falls through if it is faster than the plate is strong: at √2.
    assert any(np.abs(curve.points[:, 0] - math.sqrt(2)).max() < 1e-9 for curve in atlas.curves)
    # So has a start.
    start = plate.text.replace("start in above", "start if strength > 2*e in above else below")
    family = HybridFamily.of(stickslip.system(start), "strength", "e", max_switches=5)
    assert "start" in family.guards
    atlas = trace_family(family, (0.5, 0.9), (0.3, 0.4), **FEW)
    ends = [curve.points[:, 0] - 2 * curve.points[:, 1] for curve in atlas.curves]
    assert any(np.abs(one).max() < 1e-9 for one in ends)


def test_a_start_that_chooses_the_mode_has_a_boundary() -> None:
    def family(record=None):
        system = HybridSystem()
        for name, slope in (("up", 1.0), ("down", -1.0)):
            mode = system.mode(name, lambda t, y, p, q, slope=slope: [slope * q])
            mode.guard("floor", lambda t, y, p, q: y[0], reset=lambda t, y, p, q: [9.0])

        def start(t, y, p, q):
            return ("up" if p > 2 * q else "down"), [p]

        return HybridFamily(system, (0, 4), [1.0], "up", start=start, record=record)

    recorded, called = family(), family(False)
    assert recorded.reason is None and recorded.guards == ("floor", "start")
    assert str(called.label(1.0, 0.6)) == "floor" and str(called.label(1.0, 0.4)) == "no events"
    assert str(recorded.label(1.0, 0.6)) == "start, floor"
    assert str(recorded.label(1.0, 0.4)) == "start"
    atlas = trace_family(recorded, (0.9, 1.1), (0.4, 0.6), **FEW)
    (curve,) = atlas.curves
    assert np.abs(curve.points[:, 0] - 2 * curve.points[:, 1]).max() < 1e-9
    assert curve.margin.place == "branch" and curve.margin.guard == "start"


def test_a_stack_counts_as_few_events_in_all_its_atlases() -> None:
    ball = stickslip.system("""
        parameter g = 1, e = 0.5, height = 1
        state x = height, v = 0
        x' = v
        v' = -g
        when x < 0 "floor"
          x := 0
          v := -e*v
        end = 3
    """)
    with pytest.warns(UserWarning, match="told apart up to event 4"):
        stack = stickslip.stack_family(
            lambda height: HybridFamily.of(ball, "g", "e", parameters={"height": height}),
            (0.6, 0.9),
            (0.3, 0.5),
            [0.9, 1.0],
            atlases=10,
            **FEW,
        )
    assert len(stack.layers) == 2 and stack.objection is None
