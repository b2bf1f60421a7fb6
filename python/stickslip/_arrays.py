"""Numbers as they are given: arrays of one's own of doubles."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def unmasked(values: Any) -> NDArray[Any]:
    """The values as an array: of doubles, with NaN where they are masked, if they can be masked."""
    # Without this module, which takes long to import, there are no masked arrays, nor while another
    # thread imports it.
    ma: Any = sys.modules.get("numpy.ma")
    masked = getattr(ma, "MaskedArray", None)
    if masked is not None and isinstance(values, masked):
        filled: NDArray[np.float64] = ma.filled(ma.asarray(values, dtype=np.float64), np.nan)
        return filled
    return np.asarray(values)


def real(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """The values as doubles, NaN where they are masked; the array itself if it is one of doubles."""
    array = unmasked(values)
    if array.dtype.kind not in "iufO":
        raise TypeError(f"{name} has the type {array.dtype}; expected real numbers")
    return np.asarray(array, dtype=np.float64)


def numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A copy of `values` as doubles that lie one after another, NaN where they are masked."""
    return np.array(real(name, values), order="C")
