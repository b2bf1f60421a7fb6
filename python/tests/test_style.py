"""Colours and line styles: one palette for the program's pictures and those of matplotlib."""

import re

import pytest

import stickslip
from stickslip import style


def test_boundaries_have_the_lines_of_the_picture() -> None:
    atlas = stickslip.trace((0.2, 10.0), (0.01, 3.0))
    picture = atlas.picture()
    kinds = {boundary.kind for boundary in atlas.boundaries}
    assert kinds == {"end-of-contact", "stick-graze", "slip-graze"} <= style.BOUNDARIES.keys()
    for kind in kinds:
        line = style.BOUNDARIES[kind]
        group = re.search(rf'<g class="{kind}">.*?</g>', picture, re.DOTALL)
        assert group is not None
        assert f'stroke="{line["color"]}"' in group[0]
        # Dashes are in widths of a line that is 1.6 wide.
        given = re.search(r'stroke-dasharray="([^"]*)"', group[0])
        dashes = () if line["linestyle"] == "-" else line["linestyle"][1]
        lengths = given[1].split() if given else []
        assert [float(length) / 1.6 for length in lengths] == pytest.approx(dashes)


def test_regions_say_their_itineraries() -> None:
    atlas = stickslip.trace((18.0, 21.0), (0.55, 0.65))
    hints = re.findall(r"<path[^>]*><title>([^<:]*): (\d+) switch(?:es)?</title>", atlas.picture())
    regions = {(region.itinerary, str(region.switch_count)) for region in atlas.regions}
    assert set(hints) == regions and len(hints) == len(atlas.regions)


def test_colours_of_series_differ() -> None:
    assert len(set(style.COLOURS)) == 7 and style.COLOURS[0] == style.BLUE == "#0072B2"
    assert style.PHASES.keys() == {"+", "o", "-"}


def test_maps_of_colours_have_white_or_light_where_nothing_is() -> None:
    pytest.importorskip("matplotlib")
    assert min(style.diverging()(0.5)[:3]) > 0.92
    light, dark = (sum(style.growing()(part)[:3]) for part in (0.0, 1.0))
    assert light > 2.5 and dark < 1.0
