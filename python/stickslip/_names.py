"""Numbers with names: variables that only events change, and signs of surfaces."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from keyword import iskeyword
from math import prod
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from stickslip._compiled import Compiled, _reals

Floats: TypeAlias = NDArray[np.float64]


class Named:
    """Numbers and arrays with names: one after another, or as a named tuple."""

    def __init__(self, kind: str, values: Mapping[str, Any]) -> None:
        for name in values:
            if not isinstance(name, str) or not name.isidentifier() or iskeyword(name):
                raise ValueError(f"{name!r} is not a name of one of {kind}; expected an identifier")
            if name.startswith("_"):
                raise ValueError(f"{name!r} is not a name of one of {kind}: it begins with _")
        arrays = {name: _reals(value, f"{kind}[{name!r}]") for name, value in values.items()}
        self.names = tuple(arrays)
        self.shapes = {name: array.shape for name, array in arrays.items()}
        self.flat = self._flat(arrays)
        if not np.isfinite(self.flat).all():
            raise ValueError(f"{kind} = {dict(values)!r}; expected finite numbers")
        self._made_from = (kind, arrays)

    def __reduce__(self) -> Any:
        # The class of the tuples is not found by its name.
        return Named, self._made_from

    @cached_property
    def _tuple(self) -> Any:
        # Most systems have none, and a class takes longer than a short run.
        return namedtuple(self._made_from[0].capitalize(), self.names)

    def __bool__(self) -> bool:
        return bool(self.names)

    def named(self, flat: Any) -> Any:
        """The named tuple of numbers that are listed one after another."""
        flat = np.asarray(flat, dtype=np.float64)
        parts = self.columns(flat.reshape(1, -1))
        values = [float(part[0]) if part.ndim == 1 else part[0] for part in parts.values()]
        for value in values:
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        return self._tuple(*values)

    @property
    def labels(self) -> list[str]:
        """A name for each number."""
        shapes = self.shapes.items()
        return ["_".join([name, *map(str, at)]) for name, shape in shapes for at in np.ndindex(shape)]

    def tuple_of(self, parts: Sequence[Any], view: type[NDArray[Any]]) -> Any:
        """The named tuple of numbers of another kind, in arrays of this kind."""
        flat = np.empty((1, len(parts)), dtype=object)
        flat[0] = parts
        flat.setflags(write=False)
        rows = self.columns(flat).values()
        return self._tuple(*(part[0] if part.ndim == 1 else part[0].view(view) for part in rows))

    def columns(self, rows: NDArray[Any]) -> dict[str, NDArray[Any]]:
        """The columns of rows of numbers by their names, shape (k, ...)."""
        found, first = {}, 0
        for name, shape in self.shapes.items():
            size = prod(shape)
            found[name] = rows[:, first : first + size].reshape(len(rows), *shape)
            first += size
        return found

    def setter(self, given: Any, what: str) -> Callable[..., Floats]:
        """The function that returns all numbers where some are `given`: a mapping, or a callable
        that returns one."""
        self._expect(given if isinstance(given, Mapping) else {}, what)

        def numbers(t: float, y: Floats, old: Any, *args: Any) -> Floats:
            found = given(t, y, old, *args) if callable(given) else given
            about = f"{what}, at t = {t}"
            if not isinstance(found, Mapping):
                raise TypeError(f"{about}: {found!r}; expected a mapping of names to numbers")
            self._expect(found, about)
            new = {name: getattr(old, name) for name in self.names} | dict(found)
            return self._flat({name: _reals(value, about) for name, value in new.items()}, about)

        return numbers

    def _expect(self, given: Mapping[str, Any], what: str) -> None:
        for name in given:
            if name not in self.names:
                raise ValueError(f"{what}: {name!r} is no variable; expected some of {self.names}")

    def _flat(self, arrays: Mapping[str, Floats], what: str = "") -> Floats:
        for name, array in arrays.items():
            if array.shape != self.shapes[name]:
                raise ValueError(
                    f"{what}: {name!r} has shape {array.shape}; expected {self.shapes[name]}"
                )
        return np.concatenate([np.empty(0), *(array.reshape(-1) for array in arrays.values())])


def check_sets(sets: Any, about: str) -> None:
    """Refuses what sets no variables."""
    if isinstance(sets, Compiled) or not (callable(sets) or isinstance(sets, Mapping)):
        raise TypeError(
            f"{about}: sets = {sets!r}; expected a mapping of names to numbers, or a callable that "
            "returns one"
        )
