"""Results in a few lines of text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

#: The longest text of a value, and of a result in one line.
_VALUE, _LINE = 60, 100
#: Longer sequences are counted.
_ENTRIES = 4
#: Rows of a table that HTML shows.
_ROWS = 20


class Shown:
    """A dataclass whose text has at most a line for each field, however long its arrays are."""

    def __repr__(self) -> str:
        shown = [
            f"{one.name}={_text(getattr(self, one.name))}"
            for one in fields(self)  # type: ignore[arg-type]
            if one.repr
        ]
        name = type(self).__name__
        line = f"{name}({', '.join(shown)})"
        return line if len(line) <= _LINE else "\n  ".join([f"{name}:", *shown])


def _text(value: Any) -> str:
    """A value in one short line."""
    if isinstance(value, np.ndarray):
        if value.dtype.names is None and value.size <= _ENTRIES and value.dtype.kind != "O":
            return str(value.tolist())
        return f"array of shape {value.shape}"
    if isinstance(value, np.void):
        return _text(dict(zip(value.dtype.names or (), value.item(), strict=True)))
    if isinstance(value, Mapping | list | tuple) and len(value) > _ENTRIES:
        return f"{len(value)} entries"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{name}: {_text(one)}" for name, one in value.items())
        text = f"{{{inner}}}"
    elif isinstance(value, list | tuple):
        text = f"({', '.join(map(_text, value))})"
    else:
        text = repr(value)
    if "\n" not in text and len(text) <= _VALUE:
        return text
    if isinstance(value, str):
        return repr(value[: _VALUE - 5] + " …")
    if isinstance(value, Mapping | list | tuple):
        return f"{len(value)} entries" if len(value) != 1 else "1 entry"
    return f"a {type(value).__name__}"


def html_table(columns: Mapping[str, Any], title: str) -> str:
    """Columns as a table of HTML: the first rows, and how many there are."""
    from html import escape

    count = max((len(column) for column in columns.values()), default=0)
    cut = min(count, _ROWS)
    heads = "".join(f"<th>{escape(name)}</th>" for name in columns)
    cells = (
        "".join(f"<td>{escape(_cell(column[row]))}</td>" for column in columns.values())
        for row in range(cut)
    )
    rows = "".join(f"<tr>{one}</tr>" for one in cells)
    rest = f"<p>{count} rows, of which {cut} are shown</p>" if cut < count else ""
    table = f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"
    return f"<h4>{escape(title)}</h4>{table}{rest}"


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
