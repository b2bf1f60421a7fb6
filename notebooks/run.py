"""Runs notebooks, each in a fresh kernel of this interpreter, and writes nothing back.

    python notebooks/run.py                             all of this folder
    python notebooks/run.py a_figure_for_your_paper     some of them

A line for each notebook has its name and its seconds. If a cell fails, the cell and its error
follow, and the exit status is 1 at the end.
"""

import argparse
import re
import sys
import time
from pathlib import Path
from typing import Any

import nbformat
from ipykernel.kernelspec import get_kernel_dict
from jupyter_client.kernelspec import KernelSpec
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, DeadKernelError

FOLDER = Path(__file__).resolve().parent


class ThisInterpreter(AsyncKernelManager):
    """Starts kernels of the running interpreter, whatever else is installed as "python3"."""

    @property
    def kernel_spec(self) -> KernelSpec:
        # Otherwise each kernel warns that it listens on TCP.
        command = get_kernel_dict(extra_arguments=["--log-level=ERROR"])
        return KernelSpec(resource_dir="", **command)


def main() -> int:
    known = {path.stem: path for path in sorted(FOLDER.glob("*.ipynb"))}
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("name", nargs="*", help="notebooks without .ipynb; all if none is given")
    chosen = [Path(name).stem for name in parser.parse_args().name] or list(known)
    unknown = [name for name in chosen if name not in known]
    if unknown or not chosen:
        parser.error(f"no notebook {' '.join(unknown)}; expected some of {', '.join(known)}")
    failures = 0
    for name in chosen:
        begin = time.monotonic()
        _, failure = run(known[name])
        state = "FAILED after " if failure else ""
        print(f"{name}: {state}{time.monotonic() - begin:.1f} s", flush=True)
        if failure:
            failures += 1
            print(failure, flush=True)
    return 1 if failures else 0


def run(path: Path) -> tuple[Any, str | None]:
    """The notebook with its outputs, and what failed in which cell."""
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(
        notebook,
        kernel_manager_class=ThisInterpreter,
        timeout=None,
        resources={"metadata": {"path": str(path.parent)}},
    )
    started = []
    client.on_cell_start = lambda cell, cell_index: started.append(cell_index)
    try:
        client.execute()
    except CellExecutionError as error:
        # It begins with the source of the cell.
        message = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
    except DeadKernelError as error:
        message = f"{notebook.cells[started[-1]].source if started else ''}\n{error}"
    else:
        return notebook, None
    place = started[-1] if started else 0
    return notebook, f"cell {place} of {path.name}, counted from 0: {message}"


if __name__ == "__main__":
    sys.exit(main())
