"""Results as tables of other libraries, which are imported when they are used."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip._libraries import library

if TYPE_CHECKING:
    from xarray import Dataset

#: Columns of equal length by name.
Columns: TypeAlias = dict[str, NDArray[Any]]


class Tabular:
    """A result with rows. A subclass has `_columns`."""

    #: The dimension of the rows in xarray.
    _dimension = "row"

    def _columns(self) -> Columns:
        raise NotImplementedError

    def _meanings(self) -> Mapping[str, Mapping[str, str]]:
        """What columns hold, as attributes of xarray: long_name and units."""
        return {}

    def to_pandas(self) -> Any:
        """A `pandas.DataFrame` with a row for each entry.

        Raises ImportError if pandas is not installed.
        """
        return library("pandas", "for to_pandas").DataFrame(self._columns())

    def to_xarray(self) -> Dataset:
        """A `xarray.Dataset` with the columns, their meanings and their units.

        Raises ImportError if xarray is not installed.
        """
        xr = library("xarray", "for to_xarray")
        meanings = self._meanings()
        columns = self._columns().items()
        found: Dataset = xr.Dataset(
            {name: (self._dimension, one, dict(meanings.get(name, {}))) for name, one in columns}
        )
        return found

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes the rows to a Parquet file, complete or not at all.

        Raises ImportError if pyarrow is not installed.
        """
        write_parquet(library("pyarrow", "for to_parquet").table(self._columns()), path)


def write_parquet(table: Any, path: str | os.PathLike[str]) -> None:
    """Writes a `pyarrow.Table`, complete or not at all."""
    from pathlib import Path

    parquet = library("pyarrow.parquet", "for to_parquet")
    file = Path(path)
    beside = file.with_name(f".{file.name}.{os.getpid()}.part")
    try:
        parquet.write_table(table, beside)
        beside.replace(file)
    finally:
        beside.unlink(missing_ok=True)


def flat(prefix: str, values: NDArray[Any]) -> Columns:
    """The columns of an array whose first dimension is that of the rows."""
    places = np.ndindex(values.shape[1:])
    return {"_".join([prefix, *map(str, at)]): values[(slice(None), *at)] for at in places}
