"""What Sphinx makes of the pages. `build.py` says where they come from."""

import inspect
import re
from typing import Any

import stickslip
from sphinx.application import Sphinx

project = "stickslip"
author = "The stickslip developers"
version = release = stickslip.__version__
copyright = author

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx_copybutton"]
html_theme = "furo"
html_title = f"stickslip {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
# Browsers do not fetch them from the disk.
html_show_search_summary = False
html_extra_path = ["_extra"]

# The anchors of headings are those of GitHub.
myst_heading_anchors = 4
suppress_warnings = [
    # The page of a crate may begin with a heading of any level.
    "myst.header",
    # Languages that Pygments does not know.
    "misc.highlighting_failure",
]

# Notebooks are stored with what they show.
nb_execution_mode = "off"
nb_merge_streams = True

# `name` in a docstring is a name of the package.
default_role = "py:obj"
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
# Names in the place of what they stand for.
autodoc_type_aliases = {"ArrayLike": "ArrayLike", "NDArray": "NDArray"}
autodoc_default_options = {"members": True, "undoc-members": True}
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 80

# Prompts are not copied.
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True


def setup(app: Sphinx) -> None:
    app.connect("autodoc-process-docstring", as_rst)
    app.connect("autodoc-process-signature", with_names)


def with_names(
    app: Sphinx, what: str, name: str, one: Any, options: Any, *texts: str | None
) -> tuple[str | None, ...]:
    """Sphinx leaves some of `autodoc_type_aliases` as what it uses inside."""
    plain = r"TypeAliasForwardRef\('(\w+)'\)"
    return tuple(text and re.sub(plain, r"\1", text) for text in texts)


def as_rst(app: Sphinx, what: str, name: str, one: Any, options: Any, lines: list[str]) -> None:
    """Docstrings are text with `names`, doctests, and code that is indented; here, as RST."""
    try:
        known = {parameter.lstrip("*") for parameter in inspect.signature(one).parameters}
    except (TypeError, ValueError):
        known = set()
    paragraphs = re.split(r"\n\s*\n", "\n".join(lines).strip("\n"))
    lines[:] = "\n\n".join(paragraph(text, known) for text in paragraphs).split("\n") + [""]


def paragraph(text: str, known: set[str]) -> str:
    if text.lstrip().startswith(">>>"):
        return text
    if text.startswith("    "):
        return f"::\n\n{text}"
    text = " ".join(text.split())
    # Outside of `names`, these are no markup.
    text = "".join(
        part if i % 2 else re.sub(r"([*|])", r"\\\1", part)
        for i, part in enumerate(re.split(r"(`[^`]*`)", text))
    )
    # "name: what it is." for parameters, one after the other, becomes a list.
    begins = [
        match
        for match in re.finditer(r"(?:^|(?<=[.;] ))(\w+(?:, \w+)*): ", text)
        if known.issuperset(match[1].split(", "))
    ]
    ends = [match.start() for match in begins[1:]] + [len(text)] * bool(begins)
    items = [
        f"- **{match[1].replace(', ', '**, **')}**: {text[match.end() : end].strip()}"
        for match, end in zip(begins, ends, strict=True)
    ]
    before = text[: begins[0].start()].strip() if begins else text
    return "\n\n".join(filter(None, [before, "\n".join(items)]))
