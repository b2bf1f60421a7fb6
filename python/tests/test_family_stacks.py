"""Stacks of families, against closed forms."""

import itertools
import pickle
import re
import signal
import time

import numpy as np
import pytest
from numba import cfunc, types

import stickslip
from stickslip import Compiled, HybridFamily, HybridSystem, StackInterrupted, stack_family

POINTER = types.CPointer(types.float64)
SIGNATURE = types.void(types.float64, POINTER, POINTER, POINTER)
#: Heights and restitutions of the bouncing ball, and ends of its runs.
HEIGHTS, RESTITUTIONS = (0.5, 2.0), (0.5, 0.8)
ENDS = [2.3, 2.55, 2.8]


@cfunc(SIGNATURE)
def c_fly(t, y, out, p):
    out[0] = y[1]
    out[1] = -1.0


@cfunc(SIGNATURE)
def c_height(t, y, out, p):
    out[0] = y[0]


@cfunc(SIGNATURE)
def c_bounce(t, y, out, p):
    out[0] = 0.0
    out[1] = -p[1] * y[1]


@cfunc(SIGNATURE)
def c_drop(t, y, out, p):
    out[0] = p[0]
    out[1] = 0.0


def ball(end, guard="floor", **options):
    """A ball that is dropped from the height p and keeps the part q of its velocity; g = 1."""
    system = HybridSystem()
    fly = system.mode("fly", Compiled(c_fly))
    fly.guard(guard, Compiled(c_height), reset=Compiled(c_bounce))
    return HybridFamily(system, (0, end), [1.0, 0.0], start=Compiled(c_drop), **options)


def plain_ball(end, floor=lambda t, y, p, q: y[0]):
    """The same one of Python functions."""
    system = HybridSystem()
    fly = system.mode("fly", lambda t, y, p, q: [y[1], -1.0])
    fly.guard("floor", floor, reset=lambda t, y, p, q: [0.0, -q * y[1]])
    start = lambda t, y, p, q: [p, 0.0]  # noqa: E731
    return HybridFamily(system, (0, end), [1.0, 0.0], start=start, record=False)


@pytest.fixture(scope="module")
def stack():
    return stack_family(ball, HEIGHTS, RESTITUTIONS, ENDS)


def test_regions_are_born_in_corners(stack) -> None:
    """The k-th bounce is at √(2p) (1 + 2 (q + … + qᵏ⁻¹)), which ascends with p and q: it first is
    before the end in the corner of the least p and q."""
    assert stack.finished and stack.objection is None
    assert [layer.value for layer in stack.layers] == ENDS
    assert all(layer.atlas.objection is None for layer in stack.layers)
    corners = [(2.5, 0.5, 0.5, 3), (2.6, 0.5, 0.8, None), (2.75, 0.5, 0.5, 4)]
    assert len(stack.changes) == len(corners)
    for change, (end, p, q, bounces) in zip(stack.changes, corners, strict=True):
        assert change.kind == "corner" and not change.doubtful
        assert np.allclose((change.value, change.x, change.y), (end, p, q), rtol=0, atol=1e-9)
        low, high = change.between
        assert low < end < high and high - low < 1.1e-5 * high
        born = [(effect, len(region.guards)) for effect, region in change.effects]
        assert born == ([] if bounces is None else [("born", bounces)])
    for layer in stack.layers:
        most = max(len(region.itinerary.guards) for region in layer.atlas.regions)
        assert most == 2 + sum(2.0 < end <= layer.value for end in (2.5, 2.75))


def test_any_number_of_threads_gives_the_same_stack(stack) -> None:
    single = stack_family(ball, HEIGHTS, RESTITUTIONS, ENDS, threads=1)
    assert (single.changes, single.atlases) == (stack.changes, stack.atlases)
    again = pickle.loads(pickle.dumps(stack))
    assert again.changes == stack.changes and repr(again) == "FamilyStack: 3 layers, 3 changes"
    for one, other, copy in zip(single.layers, stack.layers, again.layers, strict=True):
        assert one.atlas.document == other.atlas.document == copy.atlas.document


def test_functions_of_python() -> None:
    asked, done = [], []
    few = {"options": stickslip.TraceOptions(cells=4), "verify": stickslip.VerifyOptions(100, 2)}

    def family(end):
        asked.append(end)
        return plain_ball(end)

    found = stack_family(
        family,
        HEIGHTS,
        (0.5, 0.7),
        [2.45, 2.55],
        **few,
        progress=lambda one, all: done.append((one, all)),
    )
    (change,) = found.changes
    assert change.kind == "corner" and change.value == pytest.approx(2.5, abs=1e-9)
    assert min(asked) == 2.45 and max(asked) == 2.55
    assert all(one != other for one, other in itertools.pairwise(asked))
    assert done[-1] == (found.atlases, found.atlases)


def test_what_cannot_be_is_refused() -> None:
    def trace(family=ball, values=ENDS, **options):
        return stack_family(family, HEIGHTS, RESTITUTIONS, values, **options)

    for values in ([], [2.3], [2.5, 2.3], [2.3, 2.3], [2.3, np.nan], [[2.3, 2.5]]):
        with pytest.raises(ValueError, match="ascending order"):
            trace(values=values)
    with pytest.raises(ValueError, match=re.escape("width = 0.5; expected 1e-9 to 0.1")):
        trace(width=0.5)
    with pytest.raises(ValueError, match="tolerance = 1.0"):
        trace(tolerance=1.0)
    with pytest.raises(TypeError, match="expected a callable"):
        trace(ball(2.0))
    with pytest.raises(TypeError, match=re.escape("family(2.3) is of type NoneType")):
        trace(lambda end: None)
    with pytest.raises(ValueError, match="as in the first one") as caught:
        trace(lambda end: ball(end, guard="floor" if end < 2.5 else "table"))
    assert caught.value.__notes__ == ["with the third parameter 2.55"]
    with pytest.raises(ValueError, match="expected compiled ones"):
        trace(lambda end: ball(end) if end < 2.5 else plain_ball(end))


def test_few_atlases_leave_a_doubt() -> None:
    with pytest.warns(stickslip.AtlasWarning, match="nothing is known of what changes"):
        few = stack_family(ball, HEIGHTS, (0.5, 0.7), [2.45, 2.55], atlases=2)
    (change,) = few.changes
    assert few.finished and change.doubtful and change.kind is None and change.value is None


def test_exceptions_come_out_as_they_are() -> None:
    def family(end):
        if end not in ENDS:
            raise RuntimeError(f"no ball until {end!r}")
        return ball(end)

    with pytest.raises(RuntimeError, match="no ball until") as caught:
        stack_family(family, HEIGHTS, RESTITUTIONS, ENDS)
    (note,) = caught.value.__notes__
    assert str(caught.value).split()[-1] == note.split()[-1]

    def broken(t, y, p, q):
        raise ZeroDivisionError("no floor")

    with pytest.raises(ZeroDivisionError, match="no floor") as caught:
        stack_family(lambda end: plain_ball(end, broken), HEIGHTS, RESTITUTIONS, ENDS)
    assert caught.value.__notes__[-1] == "with the third parameter 2.3"


def test_it_is_cancelled() -> None:
    part = stack_family(ball, HEIGHTS, RESTITUTIONS, ENDS, cancelled=lambda: True)
    assert not part.finished and part.layers == () and part.changes == ()
    assert part.objection == "it is not finished" and repr(part).endswith("not finished")


@pytest.mark.parametrize("make", [ball, plain_ball])
def test_an_interruption_keeps_what_was_found(make) -> None:
    """It comes when the first family behind the layers is made."""
    few = {"options": stickslip.TraceOptions(cells=4), "verify": stickslip.VerifyOptions(100, 2)}
    ends = [2.45, 2.55]
    whole = stack_family(make, HEIGHTS, (0.5, 0.7), ends, **few)
    between = []

    def family(end):
        if end not in ends and not between:
            between.append(end)
            signal.raise_signal(signal.SIGINT)
            # Beside another thread, this one gives it the time to see that.
            time.sleep(0.3)
        return make(end)

    with pytest.raises(StackInterrupted) as caught:
        stack_family(family, HEIGHTS, (0.5, 0.7), ends, **few)
    found = caught.value.stack
    assert not found.finished and found.objection == "it is not finished"
    assert [layer.value for layer in found.layers] == ends
    for layer, known in zip(found.layers, whole.layers, strict=True):
        assert layer.atlas.document == known.atlas.document
    (change,) = found.changes
    assert change.doubtful


def test_a_second_interruption_ends_the_run() -> None:
    def floor(t, y, p, q):
        signal.raise_signal(signal.SIGINT)
        return y[0]

    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt) as caught:
        stack_family(lambda end: plain_ball(end, floor), HEIGHTS, RESTITUTIONS, ENDS)
    assert not isinstance(caught.value, StackInterrupted)
    assert time.monotonic() - began < 60.0
