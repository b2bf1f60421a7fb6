"""The package as a whole: what its help says, what it imports, and its program."""

import inspect
import os
import pydoc
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip

#: Functions of the atlases, whose modules expand their types.
LONG = {"stack_family"}


def test_signatures_are_short() -> None:
    for name in set(stickslip.__all__) - LONG:
        one = getattr(stickslip, name)
        if callable(one) and not (inspect.isclass(one) and issubclass(one, BaseException)):
            assert len(str(inspect.signature(one))) < 800, name
    text = pydoc.render_doc(stickslip.solve)
    assert "t_span: 'ArrayLike'" in text and "_SupportsArray" not in text


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
