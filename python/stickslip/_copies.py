"""Copies of functions, in which `math`, `max` and the like understand symbols.

Nothing that others see is changed: a copy has names of its own, and copies of what it could change.
"""

import builtins
import copy
import dis
import functools
import math
import numbers
import types
from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip._compiled import Compiled
from stickslip._symbols import (
    NUMPY,
    CannotRecord,
    Condition,
    Symbol,
    Symbols,
    applied,
    array_of,
    boxed,
    has_symbols,
    is_real,
    spline_of,
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


def _either(real: Callable[..., Any], other: Callable[..., Any]) -> Callable[..., Any]:
    """`other` for symbols, and `real` for numbers."""

    def function(*args: Any, **options: Any) -> Any:
        symbols = any(map(has_symbols, args)) or any(map(has_symbols, options.values()))
        return (other if symbols else real)(*args, **options)

    return function


def _maker(name: str) -> Callable[..., Any]:
    """A function that makes an array, which may take symbols later."""
    real = getattr(np, name)

    def make(*args: Any, **options: Any) -> Any:
        made = real(*args, **options)
        return made.astype(object).view(Symbols) if made.dtype == np.float64 else made

    return make


def _made(values: Any, dtype: Any = None, **options: Any) -> Any:
    if not is_real(dtype):
        raise CannotRecord(f"an array of {dtype}")
    return array_of(values).copy()


def _joined(real: Callable[..., Any]) -> Callable[..., Any]:
    return lambda parts, *args, **options: viewed(real([boxed(p) for p in parts], *args, **options))


def _extreme(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
    def function(*args: Any, **options: Any) -> Any:
        values = list(args[0]) if len(args) == 1 else list(args)
        if options or not any(map(has_symbols, values)):
            return real(*args, **options)
        result = values[0]
        for value in values[1:]:
            result = applied(name, (result, value))
        return result

    return function


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
        *("log2", "floor", "ceil", "hypot", "copysign", "radians", "degrees", "erf"),
    )
}
_math: dict[str, Any] = {
    name: _either(getattr(math, name), lambda *args, to=to: applied(to, args))
    for name, to in _MATH.items()
}
_math["log"] = _either(
    math.log, lambda x, base=None: np.log(x) if base is None else np.log(x) / np.log(base)
)
_np: dict[str, Any] = {name: _maker(name) for name in ("zeros", "ones", "empty", "full")}
_np |= {
    name: _either(getattr(np, name), _made)
    for name in ("array", "asarray", "asanyarray", "ascontiguousarray")
}
_np |= {
    name: _either(getattr(np, name), _joined(getattr(np, name)))
    for name in ("concatenate", "hstack", "vstack", "stack", "column_stack")
}
_np |= {
    function.__name__: _either(function, other)
    for function, other in NUMPY.items()
    if function is not np.linalg.norm
}
_np["float64"] = _either(np.float64, lambda x: x)


class _NoRandomNumbers:
    def __getattr__(self, name: str) -> Any:
        raise CannotRecord("the function uses random numbers")


_np["random"] = _NoRandomNumbers()


class _FloatKind(type):
    def __instancecheck__(cls, value: Any) -> bool:
        return isinstance(value, float | Symbol)


class _Float(float, metaclass=_FloatKind):
    """`float`, but for symbols, which it leaves as they are."""

    def __new__(cls, value: Any = 0.0) -> Any:
        return value if has_symbols(value) else float(value)


_BUILTINS = vars(builtins) | {
    "max": _extreme("maximum", max),
    "min": _extreme("minimum", min),
    "float": _Float,
    "print": lambda *args, **options: None,
}
_SWAPS: dict[int, Any] = {id(math): _Names(math, _math), id(np): _Names(np, _np)}
_SWAPS |= {id(getattr(math, name)): other for name, other in _math.items()}
_SWAPS |= {id(getattr(np, name)): other for name, other in _np.items() if name != "random"}
#: Values that nobody can change, and types.
_FIXED = (
    *(numbers.Number, str, bytes, type, np.ufunc, np.dtype),
    *(BaseException, Compiled),
)
#: Piecewise polynomials of SciPy.
_SPLINES = {"CubicSpline", "PchipInterpolator", "Akima1DInterpolator", "PPoly"}
#: Modules whose functions return something else each time.
_CHANGING = {"random", "_random", "numpy.random", "numpy.random.mtrand", "time", "datetime", "os"}
_CHANGING |= {"numpy.random._generator", "secrets", "uuid"}
_FORBIDDEN = {"STORE_GLOBAL", "STORE_DEREF", "STORE_ATTR", "DELETE_ATTR"}


def _codes(function: types.FunctionType) -> list[types.CodeType]:
    codes, rest = [], [function.__code__]
    while rest:
        code = rest.pop()
        codes.append(code)
        rest += [inner for inner in code.co_consts if isinstance(inner, types.CodeType)]
    return codes


def copied(function: Any, done: dict[int, Any], outside: list[Any]) -> Any:
    """The function with other names, which understand symbols. What it could change is copied, and
    goes to `outside`."""
    if isinstance(function, types.MethodType):
        owner = swapped(function.__self__, done, outside)
        return types.MethodType(copied(function.__func__, done, outside), owner)
    if not isinstance(function, types.FunctionType):
        kind = type(function).__name__
        raise CannotRecord(f"the function is of type {kind}, whose code cannot be read")
    if id(function) in done:
        return done[id(function)]
    codes = _codes(function)
    own = {name for code in codes for name in code.co_cellvars}
    steps = [step for code in codes for step in dis.get_instructions(code)]
    for step in steps:
        inner = step.opname == "STORE_DEREF" and step.argval in own
        if step.opname in _FORBIDDEN and not inner:
            raise CannotRecord(f"the function changes {step.argval!r}, which others see")
    used = {step.argval for step in steps if step.opname in ("LOAD_GLOBAL", "LOAD_NAME")}
    used &= function.__globals__.keys()
    names: dict[str, Any] = {"__builtins__": _BUILTINS}
    cells = tuple(types.CellType() for _ in function.__closure__ or ())
    twin = types.FunctionType(function.__code__, names, function.__name__, None, cells)
    done[id(function)] = twin
    defaults = function.__defaults__ or ()
    twin.__defaults__ = tuple(swapped(value, done, outside) for value in defaults)
    named = (function.__kwdefaults__ or {}).items()
    twin.__kwdefaults__ = {name: swapped(value, done, outside) for name, value in named}
    for name in used:
        names[name] = swapped(function.__globals__[name], done, outside)
    for new, old in zip(cells, function.__closure__ or (), strict=True):
        try:
            new.cell_contents = swapped(old.cell_contents, done, outside)
        except ValueError:
            # A name that has no value yet.
            continue
    return twin


def swapped(value: Any, done: dict[int, Any], outside: list[Any]) -> Any:
    """What stands for a value outside of a function, while the function is recorded."""
    if id(value) in _SWAPS:
        return _SWAPS[id(value)]
    if isinstance(value, types.ModuleType):
        if value.__name__ in _CHANGING:
            raise CannotRecord(f"the function uses the module {value.__name__}")
        return value
    if isinstance(value, types.BuiltinFunctionType):
        source = getattr(value, "__self__", None)
        source = source if isinstance(source, types.ModuleType) else type(source)
        if (getattr(source, "__module__", None) or source.__name__) in _CHANGING:
            raise CannotRecord(f"the function uses {value.__name__}, which changes by itself")
        return value
    if isinstance(value, types.FunctionType | types.MethodType):
        own = (value.__module__ or "").partition(".")[0] not in ("numpy", "scipy")
        return copied(value, done, outside) if own else value
    if isinstance(value, _FIXED) or value is None:
        return value
    if isinstance(value, np.random.Generator | np.random.RandomState):
        raise CannotRecord("the function uses random numbers")
    if isinstance(value, Symbol | Symbols):
        return value
    if type(value).__name__ in _SPLINES and type(value).__module__.startswith("scipy"):
        return _either(value, functools.partial(spline_of, value))
    if id(value) not in done:
        try:
            done[id(value)] = copy.deepcopy(value)
        except Exception as error:
            kind = type(value).__name__
            raise CannotRecord(f"the function uses a {kind}, which has no copy: {error}") from None
        outside.append(done[id(value)])
    return done[id(value)]


def inside(value: Any) -> Any:
    """What a value consists of, to see whether it changes."""
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype != object else value.tolist()
    return vars(value) if hasattr(value, "__dict__") else value
