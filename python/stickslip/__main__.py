"""`stickslip` and `python -m stickslip`: the program, without a compiler of Rust."""

from __future__ import annotations

import signal
import sys

from stickslip import _native


def main() -> int:
    """Carries out the command line of this process: its exit code."""
    # While the program computes, Python's own handler would wait for it to return.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # Nothing is written to a file that has got the number of a closed standard output.
    return _native.program(["stickslip", *sys.argv[1:]], sys.stdout is None)


if __name__ == "__main__":
    sys.exit(main())
