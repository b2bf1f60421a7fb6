"""Runs notebooks, each in a fresh kernel of this interpreter, and compares their outputs.

    python notebooks/run.py                             all of this folder
    python notebooks/run.py a_figure_for_your_paper     some of them
    python notebooks/run.py --write                     and stores what they show

A line for each notebook has its name and its seconds. If a cell fails, or shows something else than
what is stored, the cell and what is wrong follow, and the exit status is 1 at the end. Of pictures
only the kind is compared, numbers in texts to six digits, and nothing in cells with the tag
`varies`, which show times or the numbers of processes.
"""

import argparse
import base64
import io
import math
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
from PIL import Image

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
    parser.add_argument("--write", action="store_true", help="store the outputs")
    arguments = parser.parse_args()
    chosen = [Path(name).stem for name in arguments.name] or list(known)
    unknown = [name for name in chosen if name not in known]
    if unknown or not chosen:
        parser.error(f"no notebook {' '.join(unknown)}; expected some of {', '.join(known)}")
    failures = 0
    for name in chosen:
        begin = time.monotonic()
        stored = nbformat.read(known[name], as_version=4)
        found, failure = run(known[name])
        if arguments.write and not failure:
            nbformat.write(found, known[name])
        elif not failure:
            failure = difference(stored, found)
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
        # Times would be another reason for a notebook to change.
        record_timing=False,
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
        for cell in notebook.cells:
            for output in cell.get("outputs", ()):
                if "data" in output:
                    make_small(output.data)
        return notebook, None
    place = started[-1] if started else 0
    return notebook, f"cell {place} of {path.name}, counted from 0: {message}"


def make_small(data: Any) -> None:
    """Bitmaps of more than 100 kB get 256 colours, and a picture is there once."""
    if data.get("text/html", "") == data.get("image/svg+xml"):
        del data["text/html"]
    if len(data.get("image/png", "")) > 4 / 3 * 100_000:
        picture = Image.open(io.BytesIO(base64.b64decode(data["image/png"]))).convert("RGB")
        file = io.BytesIO()
        picture.quantize(256, dither=Image.Dither.NONE).save(file, "PNG", optimize=True)
        data["image/png"] = base64.b64encode(file.getvalue()).decode()


def difference(stored: Any, found: Any) -> str | None:
    """The first cell that shows something else than what is stored."""
    for place, (cell, again) in enumerate(zip(stored.cells, found.cells, strict=True)):
        if cell.cell_type != "code":
            continue
        one, other = shown(cell), shown(again)
        if [kind for kind, _ in one] != [kind for kind, _ in other]:
            return f"cell {place}, counted from 0, shows {other}, and not {one} as it is stored"
        if "varies" not in cell.metadata.get("tags", ()):
            for (_, text), (_, new) in zip(one, other, strict=True):
                if not alike(text, new):
                    return f"cell {place}, counted from 0, shows\n{new}\nand not\n{text}"
    return None


def shown(cell: Any) -> list[tuple[str, str]]:
    """What a cell shows: kinds, with the text of those that are text alone."""
    outputs = []
    for output in cell.outputs:
        if output.output_type == "stream":
            outputs.append((output.name, output.text))
        else:
            kinds = sorted(output.data)
            text = output.data["text/plain"] if kinds == ["text/plain"] else ""
            outputs.append((" ".join(kinds), text))
    return outputs


def alike(one: str, other: str) -> bool:
    """Whether texts are the same, with numbers that are the same to six digits."""
    number = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")
    if number.sub("#", one) != number.sub("#", other):
        return False
    pairs = zip(number.findall(one), number.findall(other), strict=True)
    return all(math.isclose(float(a), float(b), rel_tol=1e-6, abs_tol=1e-12) for a, b in pairs)


if __name__ == "__main__":
    sys.exit(main())
