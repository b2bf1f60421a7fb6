"""Many runs of one system."""

import functools
import math
from pathlib import Path

import numpy as np
import pytest
import stickslip
import xarray as xr
from stickslip import HybridSystem, solve, solve_many

BALL = """
parameter height = 1, restitution = 0.5
state x = height, v = 0
x' = v
v' = -1
when x < 0 "floor"
  x := 0
  v := -restitution*v
end = 2.4
"""


def bounces(height, restitution, end, most=40):
    powers = restitution ** np.arange(1, most)
    times = np.sqrt(2 * height) * (1 + 2 * np.cumsum(powers))
    return int(math.sqrt(2 * height) < end) + int((times < end).sum())


def test_runs_of_a_text_are_those_of_closed_forms() -> None:
    ball = stickslip.system(BALL)
    heights, restitutions = np.linspace(0.5, 1.5, 7), np.linspace(0.5, 0.8, 5)
    found = solve_many(ball, parameters={"height": heights, "restitution": restitutions})
    assert found.end_time.dims == ("height", "restitution") and bool(found.decided.all())
    for i, height in enumerate(heights):
        for j, restitution in enumerate(restitutions):
            own = found.isel(height=i, restitution=j)
            if own.outcome == "zeno":
                limit = math.sqrt(2 * height) * (1 + restitution) / (1 - restitution)
                assert abs(float(own.end_time) - limit) < 1e-9 and limit < 2.4
                continue
            assert int(own.event_count) == bounces(height, restitution, 2.4)
            assert own.outcome == "reached_end" and own.end_mode == "main"
    # The events of each run, by its place in the flat array.
    first = found.event_time[found.event_run == 3].to_numpy()
    assert first[0] == pytest.approx(math.sqrt(2 * heights[0]), abs=1e-12)
    assert set(found.event_guard.to_numpy()) == {"floor"}
    after = found.event_after.to_numpy()
    assert (after[:, 0] == 0.0).all() and (after[:, 1] > 0.0).all()


def test_runs_are_those_of_solve_on_any_number_of_threads() -> None:
    ball = stickslip.system(BALL)
    parameters = {"restitution": np.linspace(0.3, 0.8, 40)}
    one = solve_many(ball, parameters=parameters, threads=1, t_eval=[0.5, 2.0])
    assert solve_many(ball, parameters=parameters, threads=3, t_eval=[0.5, 2.0]).identical(one)
    for index, restitution in enumerate(parameters["restitution"]):
        own = ball.solve(parameters={"restitution": restitution}, t_eval=[0.5, 2.0])
        row = one.isel(restitution=index)
        if own.outcome == "reached_end":
            assert (row.state.to_numpy().T == own.y).all()
        assert str(row.outcome.item()) == own.outcome
        assert (one.event_time[one.event_run == index].to_numpy() == own.t_events[0]).all()


def test_functions_get_parameters_in_their_order() -> None:
    found = solve_many(
        lambda t, y, rate, level, unit: [unit * (level - y[0]) * rate],
        (0.0, 2.0),
        [0.0],
        parameters={"rate": [1.0, 2.0, 3.0], "level": xr.DataArray([1.0, 5.0], dims="tank")},
        initial={"y0": [0.0, 0.5]},
        args=(1.0,),
        events=lambda t, y, rate, level, unit: y[0] - 0.75,
        t_eval=[1.0],
    )
    assert found.end_state.dims == ("rate", "tank", "y0", "component")
    for rate in (1.0, 2.0, 3.0):
        for tank, level in enumerate([1.0, 5.0]):
            for begin in (0.0, 0.5):
                own = found.sel(rate=rate, y0=begin).isel(tank=tank)
                expected = level + (begin - level) * np.exp(-rate * np.array([1.0, 2.0]))
                assert float(own.state[0, 0]) == pytest.approx(expected[0], abs=1e-9)
                assert float(own.end_state[0]) == pytest.approx(expected[1], abs=1e-9)
                assert int(own.event_count) == (expected[1] > 0.75)


def test_modes_of_a_system_of_functions() -> None:
    def belt():
        system = HybridSystem()
        stick = system.mode("stick", lambda t, y, v: [y[1], 0.0])
        slip = system.mode("slip", lambda t, y, v: [y[1], 0.6 - y[0]])
        stick.guard("breaks", lambda t, y, v: 1 - y[0], to="slip")
        slip.guard("stops", lambda t, y, v: v - y[1], to="stick", reset=lambda t, y, v: [y[0], v])
        return system

    speeds = [0.3, 0.5, 0.9]
    start = {"initial": {"y1": xr.DataArray(speeds, dims="v")}}
    many = solve_many(belt(), (0, 30), [0.0, 0.0], "stick", parameters={"v": speeds}, **start)
    for index, speed in enumerate(speeds):
        own = solve(belt(), (0, 30), [0.0, speed], "stick", args=(speed,))
        assert int(many.event_count[index]) == own.events.size
        assert np.allclose(many.end_state[index], own.y[:, -1], rtol=0, atol=1e-12)
        assert many.end_mode[index] == own.mode[-1]


def test_the_state_of_a_system_depends_on_its_parameters() -> None:
    ball = stickslip.system(BALL)
    found = solve_many(ball, parameters={"height": [1.0, 2.0]}, initial={"v": [0.0, 1.0]}, t_eval=[0])
    assert found.state[:, :, 0, 0].to_numpy().tolist() == [[1.0, 1.0], [2.0, 2.0]]
    assert found.state[:, :, 0, 1].to_numpy().tolist() == [[0.0, 1.0], [0.0, 1.0]]
    assert solve_many(ball).end_time.shape == ()
    assert solve_many(ball, parameters={"height": []}).end_time.shape == (0,)


def test_runs_that_fail_are_named() -> None:
    wild = stickslip.system("parameter b = 1\nstate x = 1\nx' = b*x^2\nend = 1")
    found = solve_many(wild, parameters={"b": [0.5, 2.0, 0.25]})
    assert found.outcome.to_numpy().tolist() == ["reached_end", "failed", "reached_end"]
    assert np.isnan(found.end_state[1, 0]) and int(found.event_count[1]) == -1
    assert float(found.end_state[0, 0]) == pytest.approx(2.0, rel=1e-8)
    (failure,) = found.attrs["failures"]
    assert failure.startswith("run 1: ")


def test_what_does_not_fit_is_refused() -> None:
    ball = stickslip.system(BALL)
    count = [0]

    def counts(t, y, rate):
        count[0] += 1
        return [-rate * y[0]]

    for call, message in [
        (lambda: solve_many(ball, parameters={"mass": [1.0]}), "'mass' is no parameter"),
        (lambda: solve_many(ball, initial={"z": [1.0]}), "'z' is no component"),
        (lambda: solve_many(ball, parameters={"height": [[1.0]]}), "height has 2 dimensions"),
        (lambda: solve_many(ball, parameters={"height": [1.0, math.nan]}), "not finite"),
        (lambda: solve_many(ball, y0=[1.0]), "y0 has 1 components; expected 2"),
        (lambda: solve_many(ball, mode="fly"), "mode = 'fly'"),
        (lambda: solve_many(ball, rtol=2.0), "rtol"),
        (
            lambda: solve_many(counts, (0, 1), [1.0], parameters={"rate": [1.0]}),
            "many runs are those of formulas, but the right-hand side",
        ),
        (
            lambda: solve_many(
                lambda t, y, y0: [-y0], (0, 1), [1.0], parameters={"y0": 1.0}, initial={"y0": 1.0}
            ),
            "is given as a parameter and as an initial value",
        ),
    ]:
        with pytest.raises(ValueError, match=message):
            call()
    with pytest.raises(TypeError, match="functions have no start of their own"):
        solve_many(lambda t, y: -y)
    with pytest.raises(TypeError, match="the rules of a system are its events"):
        solve_many(ball, args=(1.0,))


def test_guards_that_are_sampled_are_said_once(monkeypatch) -> None:
    from stickslip import _hybrid

    monkeypatch.setattr(_hybrid, "_warned", [])

    def lost(t, y):
        return float(str(y[0])) - 0.5

    with pytest.warns(stickslip.SampledGuardsWarning, match=r"guards are sampled: .*guard_scale"):
        found = solve(lambda t, y: [-y[0]], (0, 1), [1.0], events=lost)
    assert not found.decided and found.events.size == 1
    solve(lambda t, y: [-y[0]], (0, 1), [1.0], events=lost)
    monkeypatch.setattr(_hybrid, "_warned", [])
    solve(lambda t, y: [-y[0]], (0, 1), [1.0], events=lost, guard_scale=0.1)
    solve(lambda t, y: [-y[0]], (0, 1), [1.0], events=lost, record=False)
    assert _hybrid._warned == []


def test_the_collision_as_text_has_the_switches_of_the_engine() -> None:
    path = Path(__file__).parents[2] / "examples" / "systems" / "collision.slip"
    random = np.random.default_rng(5)
    kappa = xr.DataArray(random.uniform(1.0, 100.0, 300), dims="collision")
    psi = xr.DataArray(random.uniform(0.05, 2.5, 300), dims="collision")
    found = solve_many(stickslip.read(path), parameters={"kappa": kappa, "psi": psi})
    assert (found.outcome == "ended_by_guard").all() and bool(found.decided.all())
    switches = stickslip.eps_t_and_switch_count(kappa.values, psi.values, 0.1)[1]
    # The last event is the end of the contact.
    assert (found.event_count.to_numpy() - 1 == switches).all()
    assert found.event_guard[-1] == "parts"


def test_lazy_runs_are_those_at_once():
    da = pytest.importorskip("dask.array")
    kwargs = {
        "parameters": {"k": np.linspace(1.0, 3.0, 7), "c": np.linspace(0.1, 0.5, 5)},
        "initial": {"y1": [0.0, 1.0]},
        "events": lambda t, y, k, c: y[0],
        "t_eval": [0.5, 1.5],
    }
    run = functools.partial(
        solve_many, lambda t, y, k, c: [y[1], -k * y[0] - c * y[1]], (0, 4), [1.0, 0.0]
    )
    whole = run(**kwargs)
    for chunks in ("auto", 3, {"k": 2}):
        lazy = run(**kwargs, chunks=chunks)
        assert isinstance(lazy.end_state.data, da.Array) and "event_time" not in lazy
        found = lazy.compute(scheduler="threads")
        for name in found:
            assert found[name].dims == whole[name].dims and found[name].equals(whole[name]), name
    part = run(**kwargs, chunks={"k": 1, "c": 1}).event_count.isel(k=3, c=2)
    assert part.compute().equals(whole.event_count.isel(k=3, c=2))
    # Blocks are computed elsewhere as well.
    again = run(**kwargs, chunks=3).end_time.compute(scheduler="processes", num_workers=1)
    assert again.equals(whole.end_time)
    for chunks, message in [(0, "at least 1"), ({"x": 1}, "the dimensions are"), ("big", "auto")]:
        with pytest.raises(ValueError, match=message):
            run(**kwargs, chunks=chunks)
    with pytest.raises(ValueError, match="nothing varies"):
        run(parameters={"k": 1.0, "c": 0.1}, chunks=1)
