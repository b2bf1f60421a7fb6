"""Runs what the pages show: the blocks of Python, and the commands with what they print.

    python site/blocks.py --program target/release/stickslip [--long] [PAGE ...]

The blocks of a page run one after another in one folder, which has the examples of the repository.
What a page shows below a command must be among what the command prints, except for lines that leave
something out (…), and however the text is broken into lines. A command fails if and only if the
page shows an error below it. A file that is shown (`cat FILE`, or a block behind
`<!-- file NAME -->`) and is not there yet is made. Blocks behind `<!-- long -->` run with `--long`
alone, and those behind `<!-- elsewhere -->` need what is not here, such as a cluster.
"""

import argparse
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
# The blocks of the tutorial run while the site is built.
PAGES = ("README.md", "docs/*.md", "docs/python/*.md")


def blocks(page: Path) -> Iterator[tuple[str, str, int, str]]:
    """The note before each block of a page, its language, its line and its text."""
    text = page.read_text(encoding="utf-8")
    for block in re.finditer(r"^(?:<!-- ([^\n]*) -->\n)?```(\w+)\n(.*?)^```$", text, re.M | re.S):
        yield block[1] or "", block[2], text.count("\n", 0, block.start(2)) + 1, block[3]


def commands(text: str) -> Iterator[tuple[str, list[str]]]:
    """The commands of a block, and the lines below each."""
    text = text.replace("\\\n", " ")
    if not re.search(r"^\$ ", text, re.MULTILINE):
        yield from ((line, []) for line in text.splitlines() if line)
        return
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, *printed = part.splitlines()
        yield command, printed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--long", action="store_true")
    parser.add_argument("pages", nargs="*", type=Path)
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    pages = arguments.pages or [page for pattern in PAGES for page in sorted(ROOT.glob(pattern))]
    faults = 0
    for page in pages:
        with tempfile.TemporaryDirectory() as folder:
            for name in ("examples", "notebooks-data"):
                shutil.copytree(ROOT / name, Path(folder, name))
            for fault in run_page(page, Path(folder), program, arguments.long):
                print(f"{page}:{fault}")
                faults += 1
    return 1 if faults else 0


def run_page(page: Path, folder: Path, program: Path, long: bool) -> Iterator[str]:
    """What is wrong in the blocks of a page."""
    tools = folder / "tools"
    tools.mkdir()
    # A browser that opens nothing.
    (tools / "xdg-open").write_text("#!/bin/sh\n", encoding="utf-8")
    (tools / "xdg-open").chmod(0o755)
    (tools / "stickslip").symlink_to(program)
    names: dict[str, object] = {"__name__": "__main__"}
    for note, language, line, text in blocks(page):
        begin = time.monotonic()
        if note == "elsewhere" or note == "long" and not long:
            continue
        if note.startswith("file "):
            (folder / note.removeprefix("file ")).write_text(text, encoding="utf-8")
        elif language == "python":
            try:
                with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
                    exec(compile("\n" * line + text, str(page), "exec"), names)  # noqa: S102
            except Exception as error:  # noqa: BLE001
                yield f"{line}: {type(error).__name__}: {error}"
        elif language == "console":
            for command, printed in commands(text):
                yield from (f"{line}: {fault}" for fault in run_command(command, printed, folder))
        if (seconds := time.monotonic() - begin) > 2:
            print(f"{page}:{line}: {seconds:.1f} s", file=sys.stderr)


def run_command(command: str, shown: list[str], folder: Path) -> Iterator[str]:
    """What is wrong in a command and the lines below it."""
    command = command.replace("cargo run --release -- ", "stickslip ")
    tool, *rest = command.split()
    if tool in {"cargo", "pip", "python"}:
        return
    if tool == "cat" and not (folder / rest[0]).exists():
        (folder / rest[0]).write_text("\n".join([*shown, ""]), encoding="utf-8")
        return
    path = f"{folder / 'tools'}{os.pathsep}{os.environ['PATH']}"
    ran = subprocess.run(
        ["sh", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    if bool(ran.returncode) != any(line.startswith("error") for line in shown):
        yield f"{command}: exit code {ran.returncode}: {ran.stderr[-500:]}"
    printed = without_spaces(ran.stdout + ran.stderr)
    for line in shown:
        if "…" not in line and without_spaces(line) not in printed:
            yield f"{command}: does not print: {line}"


def without_spaces(text: str) -> str:
    return "".join(text.split())


if __name__ == "__main__":
    sys.exit(main())
