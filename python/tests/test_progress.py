"""Progress of long calls."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
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


OSCILLATOR = "state x = 1, v = 0\nx' = v\nv' = -1e6*x\nend = 100"


def oscillate(t: float, y: np.ndarray) -> list[float]:
    return [y[1], -1e6 * y[0]]


@pytest.mark.parametrize(
    "run",
    [
        lambda report: stickslip.system(OSCILLATOR).solve(t_eval=[], progress=report),
        lambda report: stickslip.solve(
            oscillate, (0, 100), [1, 0], t_eval=[], progress=report
        ),
        lambda report: stickslip.solve(
            oscillate, (9, 1), [1, 0], t_eval=[], record=False, progress=report
        ),
    ],
)
def test_a_run_says_how_far_it_is(run: Callable[[object], stickslip.Solution]) -> None:
    told: list[tuple[int, int]] = []
    found = run(lambda done, steps: told.append((done, steps)))
    assert found.success and len(told) > 2
    assert told == sorted(told) and told[-1] == (1000, 1000) and told[0][0] < 1000

    def fails(done: int, steps: int) -> None:
        raise ArithmeticError(done)

    with pytest.raises(ArithmeticError):
        run(fails)


def test_a_run_without_an_end_is_never_done() -> None:
    told: list[int] = []
    stickslip.system(OSCILLATOR.replace("end = 100", "when t > 60 -> end")).solve(
        t_eval=[], progress=lambda done, steps: told.append(done)
    )
    assert set(told[:-1]) == {0} and told[-1] == 1000
