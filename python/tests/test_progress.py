"""Progress of long calls."""

import sys
from pathlib import Path

import pytest
from results import COARSE, FEW, WINDOW, family

import stickslip
from stickslip._progress import reported


def trace(progress: object) -> stickslip.FamilyAtlas:
    return stickslip.trace_family(
        family(), *WINDOW, options=COARSE, verify=FEW, progress=progress
    )  # type: ignore[call-overload]


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_a_bar_or_a_line(
    with_tqdm: bool,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    if with_tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm", None)
    quiet = trace(False)
    assert capsys.readouterr() == ("", "")
    assert trace(True).document == quiet.document
    shown = capsys.readouterr().err
    assert "trace of systems: " in shown and shown.endswith("\n")
    assert "%|" in shown if with_tqdm else " of " in shown
    store = tmp_path / "sweep"
    stickslip.write_sweep(store, [1.0, 2.0, 3.0], 0.5, chunks=1, progress=True)
    last = capsys.readouterr().err.rstrip().rpartition("\r")[2]
    assert "3/3" in last if with_tqdm else last == "sweep: 3 of 3"


def test_a_line_is_ended_by_an_error(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "tqdm", None)
    with pytest.raises(ArithmeticError), reported(True, "work") as report:
        assert report is not None
        report(1, 4)
        raise ArithmeticError
    assert capsys.readouterr().err.endswith("\rwork: 1 of 4\n")


def test_what_is_no_progress_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="progress is of type int; expected a callable, or True"):
        trace(3)
    with pytest.raises(TypeError, match="progress is of type str"):
        stickslip.write_sweep(tmp_path / "s", 1.0, 0.5, progress="yes")  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())
