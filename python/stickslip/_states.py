"""What values consist of, to see whether a function changes them."""

from __future__ import annotations

import types
from collections.abc import Iterator
from typing import Any

import numpy as np

from stickslip._symbols import CannotRecord, Condition, Symbol

#: Values that are compared as they are: a change of them is noticed elsewhere, or there is none.
_WHOLE = (type, types.BuiltinFunctionType, types.ModuleType)


def state_of(value: Any, seen: dict[int, Any] | None = None) -> Any:
    """What a value consists of, which is equal as long as nothing in it changes."""
    seen = {} if seen is None else seen
    if value is None or isinstance(value, int | float | complex | str | bytes):
        return type(value), repr(value)
    if isinstance(value, Symbol | Condition):
        return id(value)
    if id(value) in seen:
        return "again", seen[id(value)][0]
    # What is seen lives on, so that no other value gets its number.
    seen[id(value)] = len(seen), value
    if isinstance(value, types.FunctionType):
        return id(value), state_of(vars(value), seen)
    if isinstance(value, types.MethodType):
        return state_of(value.__self__, seen)
    if isinstance(value, _WHOLE):
        return id(value)
    if isinstance(value, np.ndarray):
        inside = [state_of(one, seen) for one in value.flat] if value.dtype == object else None
        return value.shape, str(value.dtype), value.tobytes() if inside is None else inside
    if isinstance(value, dict) and not hasattr(value, "__dict__"):
        return [(state_of(key, seen), state_of(one, seen)) for key, one in value.items()]
    if isinstance(value, list | tuple | set | frozenset) and not hasattr(value, "__dict__"):
        return type(value), [state_of(one, seen) for one in value]
    try:
        parts = value.__reduce_ex__(4)
    except Exception as error:
        raise CannotRecord(f"the function uses a {type(value).__name__}: {error}") from None
    if isinstance(parts, str):
        return parts
    parts = [list(part) if isinstance(part, Iterator) else part for part in parts]
    return [state_of(part, seen) for part in parts]
