"""The explorer: a page with a view."""

import copy
import pickle
from urllib.parse import parse_qs

import pytest

import stickslip


def test_a_view_is_in_the_page():
    page = stickslip.explore("file:///tmp/explorer.html#preset=figure3&point=%5B18%2C0.5%5D")
    assert page.point == (18.0, 0.5)
    assert '<meta name="stickslip-view" content="preset=figure3&amp;point=%5B18' in page.html
    assert repr(page) == "Explorer('preset=figure3&point=%5B18%2C0.5%5D')"


@pytest.mark.parametrize("shown", [None, "", "file:///tmp/explorer.html", "preset=figure3"])
def test_a_view_need_not_have_a_point(shown):
    assert stickslip.explore(shown).point is None


@pytest.mark.parametrize("point", ["[1]", "x", "[1,2,3]", "null", '["a","b"]'])
def test_a_point_that_is_none(point):
    assert stickslip.explore(f"point={point}").point is None


def test_a_collision_is_shown_at_its_place():
    collision = stickslip.collide(
        3.3, 0.4, damping=0.2, law="gran/hertz/history", tangential_damping=0.5
    )
    view = parse_qs(stickslip.explore(collision).view)
    assert view == {
        "point": ["[3.3, 0.4]"],
        "damping": ["0.2"],
        "law": ["gran/hertz/history"],
        "tangential": ["0.5"],
    }


@pytest.mark.parametrize("name", ["paper", "gran/hertz/history+limit_damping"])
def test_friction_of_a_collision_is_shown(name):
    base = stickslip.laws()[name.partition("+")[0]].law
    law = {**base, "friction": {"dynamic": 0.4, "decay": 5.0}}
    if "+" in name:
        law["limit_damping"] = True
    view = parse_qs(stickslip.explore(stickslip.collide(3, 0.4, damping=0.1, law=law)).view)
    assert view["law"] == [name] and view["dynamic"] == ["0.4"] and view["decay"] == ["5.0"]


def test_an_atlas_is_shown_with_its_window():
    atlas = stickslip.trace((4, 5), (0.8, 0.9), damping=0.1)
    view = parse_qs(stickslip.explore(atlas).view)
    assert view["x"] == ['{"low": 4.0, "high": 5.0, "log": true}']
    assert view["y"] == ['{"low": 0.8, "high": 0.9, "log": true}']
    assert view["damping"] == ["0.1"]
    of_ratio = stickslip.explore(stickslip.trace((4, 5), ratio=(0.8, 0.9), mu=0.3))
    view = parse_qs(of_ratio.view)
    assert (view["axes"], view["mu"]) == (["kappa-ratio"], ["0.3"])
    assert view["y"] == ['{"low": 0.8, "high": 0.9, "log": true}']
    assert of_ratio.point == (4.5, pytest.approx(0.85))


def test_a_system_is_shown_as_its_text():
    system = stickslip.system("parameter a = 1\nstate x = 1\nx' = -a*x\nend = 1")
    view = parse_qs(stickslip.explore(system).view)
    assert view == {"tab": ["system"], "text": [system.text]}


def test_what_a_notebook_shows_and_what_is_saved(tmp_path):
    page = stickslip.explore("preset=figure3", height=500)
    frame = page._repr_html_()
    assert frame.startswith('<iframe title="explorer" style="width: 100%; height: 500px')
    assert frame.count("<") == 2, "the page is escaped"
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html
    for again in (copy.deepcopy(page), pickle.loads(pickle.dumps(page))):
        assert again.html == page.html


def test_what_cannot_be_explored():
    with pytest.raises(TypeError, match="int cannot be explored; expected a Collision, an Atlas"):
        stickslip.explore(3)
    with pytest.raises(ValueError, match="height = 0; expected pixels"):
        stickslip.explore(height=0)
    law = {"normal": "linear", "history": "force", "damping": "tsuji"}
    with pytest.raises(ValueError, match="has no name; expected one of stickslip.laws"):
        stickslip.explore(stickslip.collide(3, 0.4, law=law))
