"""Builds the site into a folder that any static host serves, and checks its links.

    python site/build.py [--out target/site] [--rustdoc target/doc]

It needs stickslip with its extra `plot`, and `requirements.txt`. The pages are those of the
repository, copied into a temporary tree with the same folders; README.md beside this file says what
is added. Whatever is wrong ends it with the exit status 1: a page that Sphinx warns of, a block of
the tutorial that fails, a public name that is in no page, a link that leads nowhere.
"""

import argparse
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

import nbformat
import stickslip
from conf import paragraph

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent
sys.path.insert(0, str(ROOT / "notebooks"))
import run as notebooks  # noqa: E402

#: The pages, but for those of this folder, which stand at the root of the site.
PAGES = (
    "*.md",
    "docs/**/*.md",
    "python/README.md",
    "web/README.md",
    "site/README.md",
    "tests/data/README.md",
    "crates/*/*.md",
    "notebooks/*.md",
    "notebooks/*.ipynb",
    "notebooks-data/**/*.md",
)
#: Pages of this folder, and where they stand in the site.
OWN = {FOLDER / "index.md": "index.md", FOLDER / "tutorial.md": "tutorial.ipynb"}
#: Pages that have others below them in the list of pages.
BELOW = {"notebooks/README.md": "*", "notebooks-data/README.md": "*/README"}
#: The pages of the reference of Python, and the modules whose names they have.
REFERENCE = {
    "Collisions": ("_collisions", "_laws", "_gaining"),
    "Impacts in SI units": ("_impacts",),
    "Boundaries and regions": ("_atlases", "_stacks"),
    "Maps and sweeps": ("_maps", "_sweeps"),
    "Time steps, fits and tables": ("_timesteps", "_fits", "_tables"),
    "The paper, and studies": ("_studies",),
    "Systems of your own": ("_hybrid", "_systems", "_solutions", "_derivatives", "_compiled"),
    "Systems of formulas": ("_formulas", "_many", "_recorded", "_sympy"),
    "Families of systems": ("_families", "_family_stacks"),
    "Periodic orbits": ("_orbits", "_orbit_regions", "_attractors"),
    "The explorer, and errors": ("_explorer", "_native"),
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=ROOT / "target" / "site")
    parser.add_argument("--rustdoc", type=Path, default=ROOT / "target" / "doc")
    arguments = parser.parse_args()
    begin = time.monotonic()
    documented = (arguments.rustdoc / "stickslip" / "index.html").exists()
    rustdoc = arguments.rustdoc if documented else None
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder, "source")
        assemble(tree, rustdoc)
        built = Path(folder, "site")
        sphinx = [sys.executable, "-m", "sphinx", "-b", "html", "-q", "-W", "--keep-going"]
        sphinx += ["-d", f"{folder}/doctrees", str(tree), str(built)]
        if subprocess.run(sphinx, check=False).returncode:
            return 1
        if rustdoc:
            shutil.copytree(rustdoc, built / "rust")
            for package in packages():
                adapt_front(package, built)
        broken = broken_links(built)
        print(*broken, sep="\n", end="\n" if broken else "")
        if broken:
            return 1
        # What was there is replaced at the end, by a site that is whole.
        shutil.rmtree(arguments.out, ignore_errors=True)
        shutil.copytree(built, arguments.out)
    pages = sum(1 for page in arguments.out.rglob("*.html") if "rust" not in page.parts)
    print(f"{arguments.out}: {pages} pages in {time.monotonic() - begin:.0f} s, 0 broken links")
    return 0


def assemble(tree: Path, rustdoc: Path | None) -> None:
    """The tree of sources that Sphinx reads."""
    for pattern in PAGES:
        for page in sorted(ROOT.glob(pattern)):
            copy_page(page, tree / page.relative_to(ROOT), tree)
    for name in ("conf.py", "_static"):
        copy = shutil.copytree if (FOLDER / name).is_dir() else shutil.copy
        copy(FOLDER / name, tree / name)
    copy_page(FOLDER / "index.md", tree / "index.md", tree)
    (tree / "tutorial.ipynb").write_text(tutorial(), encoding="utf-8")
    (tree / "examples.md").write_text(examples(), encoding="utf-8")
    reference = tree / "reference"
    reference.mkdir()
    for name, text in python_reference().items():
        (reference / name).write_text(text, encoding="utf-8")
    (reference / "rust.md").write_text(rust_reference(rustdoc), encoding="utf-8")
    extra = tree / "_extra"
    extra.mkdir()
    shutil.copy(ROOT / "crates" / "page" / "explorer.html", extra)


def copy_page(page: Path, target: Path, tree: Path) -> None:
    """Copies a page, and into the tree the files that it links to."""
    target.parent.mkdir(parents=True, exist_ok=True)
    text = page.read_text(encoding="utf-8")
    target.write_text(text if page.suffix == ".ipynb" else adapted(text, page), encoding="utf-8")
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        path = (page.parent / link.partition("#")[0]).resolve()
        if path.is_file() and path.suffix not in {".md", ".ipynb"}:
            copy = tree / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)


def place(page: Path) -> Path:
    """The place of a page in the tree."""
    return Path(OWN.get(page) or page.relative_to(ROOT))


def adapted(text: str, page: Path) -> str:
    """The text of a page as the site shows it."""

    def address(match: re.Match[str]) -> str:
        words, link, anchor = match[1], match[2], match[3] or ""
        target = (page.parent / link).resolve()
        if "://" in link or not link:
            return match[0]
        if target.is_dir():
            target /= "README.md"
            if not target.exists():
                # A folder without a page of its own is nothing that the site has.
                return words
        return f"[{words}]({os.path.relpath(place(target), place(page).parent)}{anchor})"

    below = BELOW.get(page.relative_to(ROOT).as_posix())
    if below:
        text += f"\n```{{toctree}}\n:hidden:\n:glob:\n\n{below}\n```\n"
    text = re.sub(r"\[([^]\[]*)\]\(([^)\s#]*)(#[^)\s]*)?\)", address, text)
    # A paragraph that is a link to a system is its text.
    text = re.sub(
        r"^\[[^\]]*\]\(([^)]+\.slip)\)$",
        lambda match: shown((place(page).parent / match[1]), len(place(page).parts)),
        text,
        flags=re.MULTILINE,
    )
    # Lines that rustdoc hides.
    return re.sub(
        r"^```rust\n.*?^```$",
        lambda block: re.sub(r"^# .*\n", "", block[0], flags=re.MULTILINE),
        text,
        flags=re.MULTILINE | re.DOTALL,
    )


def shown(system: Path, depth: int) -> str:
    """A system as text, with a link that opens it in the explorer; `depth` is that of the page."""
    text = (ROOT / system).read_text(encoding="utf-8")
    link = f"{'../' * (depth - 1)}explorer.html#tab=system&amp;text={quote(text, safe='')}"
    return f'```text\n{text}```\n\n<a href="{link}">Open it in the explorer</a>'


def examples() -> str:
    """The page of the systems that stand in the folder `examples/systems`."""
    page = [
        "# Systems as text",
        "Each file of `examples/systems` is compared with a closed form in the tests. [What the "
        "language means](docs/systems.md). The text is run by `stickslip run FILE`, and by "
        "`stickslip.read(file).solve()` in Python.",
    ]
    for system in sorted((ROOT / "examples" / "systems").glob("*.slip")):
        page += [f"## {system.name}", shown(system, 1)]
    return "\n\n".join(page) + "\n"


def tutorial() -> str:
    """The tutorial as a notebook that has been run."""
    text = adapted((FOLDER / "tutorial.md").read_text(encoding="utf-8"), FOLDER / "tutorial.md")
    notebook = nbformat.v4.new_notebook()
    notebook.metadata["language_info"] = {"name": "python"}
    parts = re.split(r"^```python\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    for i, part in enumerate(parts):
        new = nbformat.v4.new_code_cell if i % 2 else nbformat.v4.new_markdown_cell
        notebook.cells.append(new(part.strip()))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "tutorial.ipynb")
        nbformat.write(notebook, path)
        executed, failure = notebooks.run(path)
    if failure:
        raise SystemExit(failure)
    return str(nbformat.writes(executed))


def python_reference() -> dict[str, str]:
    """The pages of the reference of Python, by their names."""
    left = set(stickslip.__all__)
    overview = ["Python", "======", "", ".. currentmodule:: stickslip", ""]
    overview += [inspect.getdoc(stickslip) or "", "", ".. toctree::", "   :hidden:", ""]
    pages = {}
    tables = []
    for title, modules in REFERENCE.items():
        names = [name for name in stickslip.__all__ if stickslip._MODULE_OF[name] in modules]
        left -= set(names)
        stem = re.sub(r"\W+", "-", title.lower())
        overview.append(f"   python-{stem}")
        tables += ["", title, "-" * len(title), ""]
        page = [title, "=" * len(title), "", ".. currentmodule:: stickslip", ""]
        # Functions first, since they make the rest.
        for name in sorted(names, key=lambda name: (not name[0].islower(), name.lower())):
            one = getattr(stickslip, name)
            kind = "autofunction" if not inspect.isclass(one) else "autoclass"
            if inspect.isclass(one) and issubclass(one, BaseException):
                kind = "autoexception"
            page.append(f".. {kind}:: {name}\n")
            first = (inspect.getdoc(one) or "").partition("\n\n")[0]
            tables.append(f"- `{name}`: {paragraph(first, set())}")
        pages[f"python-{stem}.rst"] = "\n".join(page) + "\n"
    if left:
        raise SystemExit(f"no page of the reference has {', '.join(sorted(left))}: see REFERENCE")
    pages["python.rst"] = "\n".join(overview + tables) + "\n"
    return pages


def packages() -> list[dict[str, Any]]:
    """The packages of the repository, by their names."""
    metadata = json.loads(
        subprocess.run(
            ["cargo", "metadata", "--no-deps", "--format-version", "1"],
            cwd=ROOT,
            capture_output=True,
            check=True,
        ).stdout
    )
    return sorted(metadata["packages"], key=lambda package: str(package["name"]))


def adapt_front(package: dict[str, Any], built: Path) -> None:
    """The front page of a crate is its README, whose links lead to files beside the manifest. They
    are made to lead to the pages of the site, and to copies of other files."""
    page = built / "rust" / package["name"].replace("-", "_") / "index.html"
    if not page.exists():
        return
    folder = Path(package["manifest_path"]).parent

    def address(match: re.Match[str]) -> str:
        kind, file, anchor = match[1], unquote(match[2]), match[3] or ""
        source = (folder / file).resolve()
        if ":" in file or (page.parent / file).exists() or not source.exists():
            return match[0]
        if source.is_dir():
            source /= "README.md"
            if not source.exists():
                # A folder without a page of its own is nothing that the site has.
                return ""
        target = built / place(source)
        if source.suffix in {".md", ".ipynb"}:
            target = target.with_suffix(".html")
        elif not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
        return f'{kind}="{os.path.relpath(target, page.parent)}{anchor}"'

    text = page.read_text(encoding="utf-8")
    text = re.sub(r'(href|src)="([^"#]+)(#[^"]*)?"', address, text)
    page.write_text(text, encoding="utf-8")


def rust_reference(rustdoc: Path | None) -> str:
    """The page of the crates."""
    rows = []
    for package in packages():
        readme = Path(package["manifest_path"]).with_name("README.md").relative_to(ROOT)
        library = package["name"].replace("-", "_")
        name = f"[{package['name']}](../{readme})" if (ROOT / readme).exists() else package["name"]
        if readme.parent == Path():
            name = f"[{package['name']}](../README.md#as-a-library-of-rust)"
        documented = rustdoc and (rustdoc / library / "index.html").exists()
        docs = f'<a href="../rust/{library}/index.html">documentation</a>' if documented else ""
        # Those that are not published are for this repository alone.
        if package["publish"] is None:
            rows.append(f"| {name} | {package['description']} | {docs} |")
    whole = "" if rustdoc else "`cargo doc --no-deps --open` in the repository builds their pages."
    return "\n".join(
        [
            "# Crates of Rust",
            "",
            "A program depends on `stickslip`, which has the rest behind features, or on single "
            f"crates. [Architecture](../docs/architecture.md) has their layers. {whole}",
            "",
            "| crate | what it is | |",
            "|---|---|---|",
            *rows,
            "",
            "```{toctree}",
            ":hidden:",
            ":glob:",
            "",
            "/crates/*/README",
            "/crates/exact/PROOFS",
            "/crates/validation/JOURNAL",
            "/web/README",
            "/tests/data/README",
            "```",
            "",
        ]
    )


class Page(HTMLParser):
    """The anchors and the links of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.anchors = {""}
        self.links: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name in {"id", "name"}:
                self.anchors.add(value or "")
            elif name in {"href", "src"} and tag != "base":
                self.links.append(value or "")


def broken_links(site: Path) -> list[str]:
    """Links of a built site to files or anchors of it that are not there. Of the crates, those of
    the front pages are looked at; `cargo doc` checks the others."""
    fronts = site.glob("rust/*/index.html")
    pages = (path for path in site.rglob("*.html") if "rust" not in path.parts)
    own = {path: Page(path) for path in (*pages, *fronts)}
    broken = []
    for path, page in own.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            file, _, anchor = link.partition("#")
            target = (path.parent / unquote(file.partition("?")[0])).resolve() if file else path
            # The explorer reads what is behind the #.
            anchors = own[target].anchors if target in own and target.stem != "explorer" else None
            if not target.is_file() or (anchors and unquote(anchor) not in anchors):
                broken.append(f"{path.relative_to(site)}: {link}")
    return broken


if __name__ == "__main__":
    sys.exit(main())
