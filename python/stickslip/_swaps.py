"""What stands for functions of `math`, numpy and Python, so that they understand symbols."""

from __future__ import annotations

import builtins
import math
import types
from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip._numpy_functions import NUMPY
from stickslip._symbols import (
    CannotRecord,
    Condition,
    Symbol,
    Symbols,
    applied,
    array_of,
    as_numbers,
    boxed,
    has_symbols,
    is_known,
    is_real,
    viewed,
)


class _Names(types.ModuleType):
    """A module of which some functions understand symbols."""

    def __init__(self, real: types.ModuleType, others: dict[str, Any]) -> None:
        super().__init__(real.__name__)
        self.__dict__["_real"] = real
        self.__dict__.update(others)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.__dict__["_real"], name)


def either(real: Callable[..., Any], other: Callable[..., Any]) -> Callable[..., Any]:
    """`other` for symbols, and `real` for numbers."""

    def function(*args: Any, **options: Any) -> Any:
        symbols = any(map(has_symbols, args)) or any(map(has_symbols, options.values()))
        return (other if symbols else real)(*args, **options)

    return function


def _takes_symbols(made: Any) -> Any:
    """An array of doubles as one that takes symbols later."""
    if not isinstance(made, np.ndarray) or made.dtype not in (np.float64, object):
        return made
    return as_numbers(made)


def _maker(name: str) -> Callable[..., Any]:
    """A function that makes an array."""
    real = getattr(np, name)

    def make(*args: Any, **options: Any) -> Any:
        options = {name: _plain(value) for name, value in options.items()}
        return _takes_symbols(real(*map(_plain, args), **options))

    return make


def _empty(name: str) -> Callable[..., Any]:
    """A function that makes an array whose entries are nothing."""
    real = getattr(np, name)

    def make(*args: Any, **options: Any) -> Any:
        made = real(*map(_plain, args), **options)
        if made.dtype not in (np.float64, object):
            return made
        return np.empty(made.shape, dtype=object).view(Symbols)

    return make


def _plain(value: Any) -> Any:
    return np.asarray(value) if isinstance(value, np.ndarray) else value


def _array(real: Callable[..., Any], copies: bool) -> Callable[..., Any]:
    """A function that makes an array of values."""

    def make(values: Any, dtype: Any = None, **options: Any) -> Any:
        same = not copies or not options.get("copy", True)
        if isinstance(values, np.ndarray) and same and (dtype is None or values.dtype == dtype):
            return values
        if not has_symbols(values):
            return _takes_symbols(real(values, dtype, **options))
        if isinstance(values, Symbols) and same and is_real(dtype):
            return values
        if options.keys() - {"copy", "order", "subok"}:
            raise CannotRecord(f"numpy.{real.__name__} with options")
        made = array_of(values).copy()
        if dtype is not None:
            return made.astype(dtype)
        truths = all(isinstance(one, Condition | bool | np.bool_) for one in made.flat)
        return made if truths else as_numbers(made)

    return make


def _joined(real: Callable[..., Any]) -> Callable[..., Any]:
    def join(parts: Any, *args: Any, **options: Any) -> Any:
        return viewed(real([boxed(part) for part in parts], *args, **options))

    return join


class _Universal:
    """A universal function of numpy, also of lists of symbols."""

    def __init__(self, real: np.ufunc) -> None:
        self.real = real

    def __call__(self, *args: Any, **options: Any) -> Any:
        listed = (list, tuple, np.ndarray)
        args = tuple(
            array_of(one) if isinstance(one, listed) and has_symbols(one) else one for one in args
        )
        return self.real(*args, **options)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.real, name)


def vectorized(function: Callable[..., Any], **options: Any) -> Callable[..., Any]:
    """`numpy.vectorize` of a function."""
    if options:
        raise CannotRecord("numpy.vectorize with options")
    return lambda *args: viewed(np.frompyfunc(function, len(args), 1)(*map(boxed, args)))


def _extreme(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
    def function(*args: Any, **options: Any) -> Any:
        values = list(args[0]) if len(args) == 1 else list(args)
        single = all(isinstance(value, Symbol | Condition | float | int) for value in values)
        if options or not single or is_known(values):
            return real(values, **options)
        result = values[0]
        for value in values[1:]:
            result = applied(name, (result, value))
        return result

    return function


def _hypot(*args: Any) -> Any:
    return applied("hypot", args) if len(args) == 2 else np.sqrt(sum(x * x for x in args))


def _sum(values: Any) -> Any:
    values = list(values)
    return math.fsum(values) if is_known(values) else sum(values)


def _log(x: Any, base: Any = None) -> Any:
    return np.log(x) if base is None else np.log(x) / np.log(base)


_MATH = {
    "fabs": "absolute",
    "pow": "power",
    "asin": "arcsin",
    "acos": "arccos",
    "atan": "arctan",
    "atan2": "arctan2",
    "asinh": "arcsinh",
    "acosh": "arccosh",
    "atanh": "arctanh",
}
_MATH |= {
    name: name
    for name in (
        *("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "expm1", "sqrt", "log1p", "log10"),
        *("log2", "floor", "ceil", "trunc", "fmod", "copysign", "radians", "degrees", "erf"),
        *("cbrt", "exp2"),
    )
}
_math: dict[str, Any] = {
    name: either(getattr(math, name), lambda *args, to=to: applied(to, args))
    for name, to in _MATH.items()
}
_math |= {
    "log": either(math.log, _log),
    "hypot": either(math.hypot, _hypot),
    "dist": either(math.dist, lambda p, q: _hypot(*(a - b for a, b in zip(p, q, strict=True)))),
    "fsum": _sum,
    "prod": either(math.prod, lambda values, start=1: np.multiply.reduce(array_of(values)) * start),
}
_np: dict[str, Any] = {
    name: _maker(name)
    for name in (
        *("zeros", "ones", "full", "eye", "identity"),
        *("zeros_like", "ones_like", "full_like"),
    )
}
_np |= {name: _empty(name) for name in ("empty", "empty_like")}
_np |= {
    name: _array(getattr(np, name), name == "array")
    for name in ("array", "asarray", "asanyarray", "ascontiguousarray")
}
_np |= {
    name: either(getattr(np, name), _joined(getattr(np, name)))
    for name in ("concatenate", "hstack", "vstack", "stack", "column_stack")
}
_np |= {
    function.__name__: either(function, other)
    for function, other in NUMPY.items()
    if function.__module__ != "numpy.linalg"
}


_np |= {name: _Universal(one) for name, one in vars(np).items() if isinstance(one, np.ufunc)}
_np["vectorize"] = vectorized


class _NoRandomNumbers:
    def __getattr__(self, name: str) -> Any:
        raise CannotRecord("the function uses random numbers")


_np["random"] = _NoRandomNumbers()


class _Kind(type):
    """The type of what stands for `float` and `int`."""

    kinds: tuple[type, ...]

    def __instancecheck__(cls, value: Any) -> bool:
        return isinstance(value, cls.kinds)

    def __subclasscheck__(cls, kind: type) -> bool:
        return issubclass(kind, cls.kinds[0])


class _Float(float, metaclass=_Kind):
    """`float`, but for symbols, which it leaves as they are."""

    kinds, dtype = (float, Symbol), np.dtype(float)

    def __new__(cls, value: Any = 0.0) -> Any:
        if isinstance(value, Symbols) and value.size == 1:
            value = value.item()
        if isinstance(value, Condition):
            return value.number()
        return value if isinstance(value, Symbol) else float(value)


class _Float64(float, metaclass=_Kind):
    """`numpy.float64`, but for symbols."""

    kinds, dtype = (np.float64, Symbol), np.dtype(float)

    def __new__(cls, value: Any = 0.0) -> Any:
        return as_numbers(array_of(value))[()] if has_symbols(value) else np.float64(value)


_np["float64"] = _Float64


class _Int(int, metaclass=_Kind):
    """`int`, but for symbols."""

    kinds, dtype = (int,), np.dtype(int)

    def __new__(cls, value: Any = 0, *base: Any) -> Any:
        if isinstance(value, Condition):
            return value.number()
        return applied("trunc", (value,)) if has_symbols(value) else int(value, *base)


def _type_of(*args: Any) -> Any:
    if len(args) == 1 and has_symbols(args[0]):
        raise CannotRecord("type() of a number that depends on time or state")
    return type(*args)


def _refused(name: str) -> Callable[..., Any]:
    def function(*args: Any, **options: Any) -> Any:
        raise CannotRecord(f"the function uses {name}()")

    return function


BUILTINS = vars(builtins) | {
    "max": _extreme("maximum", max),
    "min": _extreme("minimum", min),
    "float": _Float,
    "int": _Int,
    "type": _type_of,
}
BUILTINS |= {
    name: _refused(name)
    for name in ("open", "input", "globals", "setattr", "delattr", "breakpoint")
}
#: By the numbers of functions and modules, what stands for them.
SWAPS: dict[int, Any] = {id(math): _Names(math, _math), id(np): _Names(np, _np)}
SWAPS |= {id(getattr(math, name)): other for name, other in _math.items()}
SWAPS |= {id(getattr(np, name)): other for name, other in _np.items() if name != "random"}
