"""Every ```python block of the docs runs; the blocks of a page follow each other."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [
    ROOT / "README.md",
    ROOT / "python" / "README.md",
    ROOT / "site" / "tutorial.md",
    ROOT / "docs" / "explorer.md",
    ROOT / "docs" / "systems.md",
    *sorted((ROOT / "docs" / "python").glob("*.md")),
]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_there_are_pages() -> None:
    assert "coming-from-solve-ivp.md" in {page.name for page in PAGES}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_blocks_run(page: Path, tmp_path: Path) -> None:
    text = page.read_text(encoding="utf-8")
    blocks = BLOCK.findall(text)
    assert blocks, f"{page.name} has no block that runs"
    # Empty lines in the place of the rest: a traceback then has the lines of the page.
    script = [""] * len(text.splitlines())
    for match in BLOCK.finditer(text):
        first = text[: match.start()].count("\n") + 1
        lines = match.group(1).splitlines()
        script[first : first + len(lines)] = lines
    # Some blocks read systems, as from the folder of the repository.
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    path = tmp_path / f"{page.stem}.py"
    path.write_text("\n".join(script), encoding="utf-8")
    found = subprocess.run(
        [sys.executable, str(path)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert found.returncode == 0, found.stderr
