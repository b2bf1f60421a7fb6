"""The package as a whole: what its help says, what it imports, and its program."""

import ast
import inspect
import os
import pydoc
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

import stickslip

SOURCE = Path(stickslip.__file__).read_text(encoding="utf-8")
BESIDE = Path(sys.executable).parent / "stickslip"


def test_signatures_are_short() -> None:
    for name in stickslip.__all__:
        one = getattr(stickslip, name)
        if callable(one) and not (inspect.isclass(one) and issubclass(one, BaseException)):
            assert len(str(inspect.signature(one))) < 800, name
    text = pydoc.render_doc(stickslip.solve)
    assert "t_span: 'ArrayLike'" in text and "_SupportsArray" not in text


def test_names_are_imported_when_they_are_used() -> None:
    """What type checkers import are the names, in the modules that have them."""
    (block,) = [
        node
        for node in ast.parse(SOURCE).body
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
    ]
    checked = {
        alias.name: str(node.module)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    named = {name: f"stickslip.{module}" for name, module in stickslip._MODULE_OF.items()}
    assert checked == named and sorted(named) == sorted(stickslip.__all__)
    assert set(stickslip.__all__) <= set(dir(stickslip))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = stickslip.nothing
    assert stickslip._maps.map is stickslip.map and stickslip.__version__


def test_an_import_takes_little() -> None:
    script = """
import sys, time
import numpy
begin, before = time.process_time(), set(sys.modules)
import stickslip
seconds = time.process_time() - begin
print(seconds, *(set(sys.modules) - before))
stickslip.solve(lambda t, y: -y, (0.0, 1.0), [1.0])
print(*sys.modules)
"""
    found = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    first, second = found.stdout.splitlines()
    seconds, *modules = first.split()
    # Less than a millisecond was measured.
    assert float(seconds) < 0.02 and modules == ["stickslip"]
    heavy = {"matplotlib", "pandas", "xarray", "scipy", "sympy", "numba", "dask"}
    heavy |= {f"stickslip.{name}" for name in ("_orbits", "_studies", "_collisions", "_pictures")}
    assert not heavy & set(second.split())


def test_the_package_has_the_program(tmp_path: Path) -> None:
    """As a module, and as the command that is installed beside the interpreter."""
    arguments = ["collide", "--kappa", "63", "--psi", "0.5"]
    whole = None
    for command in ([sys.executable, "-m", "stickslip"], [str(BESIDE)]):
        if command == [str(BESIDE)] and not BESIDE.exists():
            continue
        run = partial(subprocess.run, capture_output=True, text=True, check=False, cwd=tmp_path)
        found = run([*command, *arguments])
        assert found.returncode == 0 and "+o-o+o-" in found.stdout
        assert whole in (None, found.stdout)
        whole = found.stdout
        assert run([*command, "--version"]).stdout.startswith(f"stickslip {stickslip.__version__}")
        wrong = run([*command, "collide", "--kappa", "-1", "--psi", "1"])
        assert wrong.returncode == 2 and "kappa" in wrong.stderr
        failed = run([*command, "impact", "missing.json"])
        assert failed.returncode in (1, 2) and "missing.json" in failed.stderr


@pytest.mark.skipif(os.name != "posix", reason="no other shell closes it")
def test_a_closed_output_is_an_error() -> None:
    line = f"{sys.executable} -m stickslip collide --kappa 63 --psi 0.5 >&-"
    found = subprocess.run(line, shell=True, check=False, stderr=subprocess.PIPE, text=True)
    assert found.returncode == 1 and "it is closed" in found.stderr


@pytest.mark.skipif(os.name != "posix", reason="there are no such signals")
def test_an_interrupt_ends_the_program(tmp_path: Path) -> None:
    """What is not complete is removed."""
    given, folder = tmp_path / "cases.csv", tmp_path / "results"
    given.write_text("kappa,psi\n" + "1e6,1\n" * 100_000)
    folder.mkdir()
    batch = ["collide", "--method", "dop853", "--batch", str(given), "--out", "results.csv"]
    with subprocess.Popen([sys.executable, "-m", "stickslip", *batch], cwd=folder) as running:
        while not any(folder.iterdir()):
            assert running.poll() is None
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        assert running.wait(10) == -signal.SIGINT
    assert list(folder.iterdir()) == []
