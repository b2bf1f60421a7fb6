"""Studies: stiff springs, convergence, contact laws, and the paper checked."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from stickslip import _native, _study_pictures
from stickslip._atlases import AtlasWarning
from stickslip._shown import Shown, html_table
from stickslip._tabular import Tabular
from stickslip._progress import Progress, reported
from stickslip._collisions import _threads

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False)
class Table(Tabular, Shown):
    """Rows of values."""

    name: str
    title: str
    #: What the columns hold, with units, by their names.
    meanings: dict[str, str]
    rows: list[list[float | int | str]]

    @cached_property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns as arrays."""
        turned = zip(*self.rows, strict=True) if self.rows else ([] for _ in self.meanings)
        return {name: np.array(column) for name, column in zip(self.meanings, turned, strict=True)}

    def _columns(self) -> dict[str, NDArray[Any]]:
        return self.columns

    def _meanings(self) -> dict[str, dict[str, str]]:
        return {name: {"long_name": text} for name, text in self.meanings.items()}

    def _repr_html_(self) -> str:
        return html_table(self.columns, self.title)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        x: str | None = None,
        y: str | None = None,
        by: Sequence[str] | None = None,
        **line: Any,
    ) -> Axes:
        """Draws one column over another one with matplotlib.

        ax: axes to draw in, or None for new ones. x, y: names of columns of numbers; some tables
        have usual ones. by: columns that tell lines apart. line: properties of all lines.

        Raises ValueError if there is no such column, or if none are usual and none are given.

        >>> import stickslip
        >>> study = stickslip.system("state x = 1\\nx' = -x\\nwhen x < 0.5\\nend = 2").converge()
        >>> axes = study.tables["convergence_tolerances"].plot(x="steps", y="time_error")
        >>> axes.get_xlabel()
        'steps: accepted steps'
        """
        return _study_pictures.table(self, ax, (x, y, by), line)


@dataclass(frozen=True, repr=False)
class Study(Shown):
    """Numbers, tables, pictures and sentences of a study."""

    name: str
    title: str
    #: The results in sentences.
    findings: list[str]
    #: All numbers.
    data: dict[str, Any]
    tables: dict[str, Table]
    #: SVG documents.
    pictures: dict[str, str]
    captions: dict[str, str]
    #: What speaks against the results.
    objections: list[str]

    def plot(self, ax: Axes | None = None, *, table: str | None = None, **line: Any) -> Axes:
        """Draws a table of the study with matplotlib; see `Table.plot`, which has the arguments.

        table: its name; without it, the first one that has usual columns. The pictures of the
        program are in `pictures`.

        Raises ValueError if no table has usual columns.
        """
        if table is None:
            tables = [one for one in self.tables.values() if _study_pictures.usual(one)]
            if not tables:
                raise ValueError(f"table is missing; expected one of {list(self.tables)}")
            return tables[0].plot(ax, **line)
        if table not in self.tables:
            raise ValueError(f"table = {table!r}; expected one of {list(self.tables)}")
        return self.tables[table].plot(ax, **line)

    def save(self, directory: str | Path) -> None:
        """Writes the JSON, CSV and SVG files of the study."""
        import csv

        folder = Path(directory)
        folder.mkdir(parents=True, exist_ok=True)
        text = json.dumps({"title": self.title, "findings": self.findings} | self.data, indent=2)
        (folder / f"{self.name}.json").write_text(text + "\n", encoding="utf-8")
        for table in self.tables.values():
            path = folder / f"{table.name}.csv"
            with path.open("w", newline="", encoding="utf-8") as file:
                csv.writer(file).writerows([table.meanings, *table.rows])
        for name, svg in self.pictures.items():
            (folder / f"{name}.svg").write_text(svg, encoding="utf-8")

    def _repr_html_(self) -> str:
        items = "".join(f"<li>{one}</li>" for one in self.findings)
        return f"<h3>{self.title}</h3><ul>{items}</ul>" + "".join(self.pictures.values())


def asymptote(
    kappa: tuple[float, float] = (10.0, 1e8),
    psi: Iterable[float] = (0.3, 1.0, 1.7),
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Study:
    """The limit of stiff springs: how eps_t and the velocity vanish as kappa grows.

    kappa: interval within 3 to 1e10. psi: one to four impact ratios above 0 and below 2.
    progress: called now and then with the steps done and all that are known; True shows a bar.
    """
    with reported(progress, "asymptote") as report:
        found = _native.asymptote(kappa, list(psi), _threads(threads), report)
    return _study(found)


def converge(
    contacts: Iterable[tuple[float, float, float]] | None = None,
    *,
    damping: float = 0.0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Study:
    """How accurate the integrators are, at which cost.

    contacts: collisions (kappa, psi, damping) with kappa up to 1e6; without them the usual ones
    with this damping. progress: as in `asymptote`.
    """
    given = None if contacts is None else [tuple(map(float, contact)) for contact in contacts]
    with reported(progress, "converge") as report:
        found = _native.converge(given, damping, _threads(threads), report)  # type: ignore[arg-type]
    return _study(found)


def contact_laws(
    *,
    damping: float = 0.2,
    tangential_damping: float = 0.0,
    cells: int = 60,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Study:
    """What the contact laws of particle codes do, for kappa up to 30 and psi up to 3.

    Maps of every law without and with damping, its difference from the paper's law, the forces of
    a standard impact, and where its spring creates energy. tangential_damping is for the laws whose
    codes have it in this form. cells: columns and rows of maps, at most 1000.
    progress: as in `asymptote`.
    """
    if not 1 <= cells <= 1000:
        raise ValueError(f"cells = {cells}; expected 1 to 1000")
    with reported(progress, "contact_laws") as report:
        count = _threads(threads)
        found = _native.contact_laws(damping, tangential_damping, cells, count, report)
    return _study(found)


def reproduction_parts() -> list[str]:
    """The titles of the parts of `reproduce`."""
    return _native.reproduction_parts()


@overload
def reproduce(
    part: int | str,
    *,
    cells: int = 200,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Study: ...
@overload
def reproduce(
    part: Path,
    *,
    cells: int = 200,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Path: ...
def reproduce(
    part: int | str | Path,
    *,
    cells: int = 200,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Study | Path:
    """A part of the paper, computed anew, or all of them on one page.

    part: its title, or its index in `reproduction_parts()`; or the `Path` of a directory, which
    gets the files of all parts and a page, whose path is the result. cells: columns and rows of
    maps. progress: as in `asymptote`. If anything speaks against the page, it says so in an
    AtlasWarning.
    """
    titles = _native.reproduction_parts()
    if isinstance(part, Path):
        with reported(progress, "reproduce") as report:
            objection = _native.reproduce_all(part, _cells(cells), _threads(threads), report)
        if objection is not None:
            warnings.warn(f"the page may be wrong: {objection}", AtlasWarning, stacklevel=2)
        return part / "index.html"
    if isinstance(part, str):
        if part not in titles:
            raise ValueError(f"part = {part!r}; expected one of {titles}")
        part = titles.index(part)
    if not 0 <= part < len(titles):
        raise ValueError(f"part = {part}; expected 0 to {len(titles) - 1}")
    with reported(progress, titles[part]) as report:
        return _study(_native.reproduce(part, _cells(cells), _threads(threads), report))


def _cells(cells: int) -> int:
    if not 1 <= cells <= 100_000:
        raise ValueError(f"cells = {cells}; expected 1 to 100000")
    return cells


def _study(found: dict[str, Any]) -> Study:
    tables = {
        name: Table(name, title, dict(columns), rows)
        for name, title, columns, rows in found["tables"]
    }
    return Study(
        name=found["name"],
        title=found["title"],
        findings=found["findings"],
        data=json.loads(found["json"]),
        tables=tables,
        pictures={name: svg for name, _, svg in found["pictures"]},
        captions={name: caption for name, caption, _ in found["pictures"]},
        objections=found.get("objections", []),
    )
