"""The package as a whole: what its help says, what it imports, and its program."""

import ast
import inspect
import os
import pydoc
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip

SOURCE = Path(stickslip.__file__).read_text(encoding="utf-8")


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
    assert stickslip.maps.map is stickslip.map and stickslip.__version__


def test_an_import_takes_little() -> None:
    script = """
import sys, time
import numpy
begin, before = time.perf_counter(), set(sys.modules)
import stickslip
seconds = time.perf_counter() - begin
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
    assert not heavy & set(second.split())


def run(arguments: list[str], path: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "stickslip", *arguments],
        env=os.environ | {"PATH": str(path)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.skipif(os.name != "posix", reason="the program is a script here")
def test_the_program_is_found(tmp_path: Path) -> None:
    beside = Path(sys.executable).parent / "stickslip"
    if beside.exists():
        pytest.skip("a program is installed beside the interpreter")
    missing = run(["collide"], tmp_path)
    assert missing.returncode == 1 and "stickslip is not installed" in missing.stderr
    program = tmp_path / "stickslip"
    program.write_text('#!/bin/sh\necho "$@"\nexit 3\n')
    program.chmod(0o755)
    found = run(["collide", "63", "two words"], tmp_path)
    assert (found.returncode, found.stdout) == (3, "collide 63 two words\n")
