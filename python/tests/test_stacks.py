"""Atlases over the damping."""

from collections import Counter

import pytest

import stickslip


def test_changes_lead_from_one_atlas_to_the_next() -> None:
    stack = stickslip.stack((5, 20), (0.2, 2.5), (0, 0.05, 0.2, 0.4))
    assert stack.objection is None and stack.changes
    assert [layer.damping for layer in stack.layers] == [0, 0.05, 0.2, 0.4]
    assert stack.layers[0].as_stacked is None
    for low, high in zip(stack.layers[1:], stack.layers[2:], strict=False):
        assert high.agrees and high.as_stacked
        counts = Counter(low.regions)
        for change in stack.changes:
            if low.damping <= change.between[0] and change.between[1] <= high.damping:
                for effect, itinerary in change.effects:
                    counts[itinerary] += 1 if effect in ("born", "splits") else -1
        assert +counts == Counter(high.regions)
    for change in stack.changes:
        if change.damping is not None:
            assert change.between[0] < change.damping < change.between[1]
            assert 5 <= (change.kappa or 0) <= 20
    assert "<svg" in stack.svg


def test_dampings_ascend() -> None:
    for dampings in ((0.1,), (0, 0.1), (0.2, 0.1)):
        with pytest.raises(ValueError, match="ascending order"):
            stickslip.stack((5, 8), (0.5, 1), dampings)
