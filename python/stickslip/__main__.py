"""`python -m stickslip`: the program of this name, where it is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys


def program() -> str:
    """The path of the program: beside this interpreter, or one of the PATH."""
    beside = os.path.dirname(sys.executable)
    found = shutil.which("stickslip", path=beside) or shutil.which("stickslip")
    if found is None:
        sys.exit(
            "the program stickslip is not installed; the Python package does not contain it: "
            "cargo install --path crates/cli, in the repository"
        )
    return found


if __name__ == "__main__":
    sys.exit(subprocess.call([program(), *sys.argv[1:]]))
