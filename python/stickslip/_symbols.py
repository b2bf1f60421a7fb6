"""Numbers that are not known yet: symbols, conditions and arrays of them.

numpy's protocols lead here: what a function does with symbols becomes nodes of a tape.
"""

from __future__ import annotations

import math
import numbers
import threading
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stickslip import _native

#: Decisions on one way through a function.
MOST_DECISIONS = 100
#: What a number that is not known yet is in a text.
TEXT = "<a number>"


class _Refusals(threading.local):
    """How often this thread has refused: what a function catches all the same is noticed."""

    count = 0


REFUSALS = _Refusals()


class CannotRecord(BaseException):
    """Why a function is no formula. A function that catches exceptions does not catch it."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        REFUSALS.count += 1


class Symbol:
    """A number that is not known yet: a node of a tape."""

    __slots__ = ("id", "tape")
    shape: tuple[int, ...] = ()
    ndim, size, imag = 0, 1, 0.0

    def __init__(self, tape: Decisions, node: int) -> None:
        self.tape, self.id = tape, node

    def __getattr__(self, name: str) -> Any:
        # A function may ask whether there is an attribute, as numpy does for `dtype`.
        if not name.startswith("__") and name != "dtype" and hasattr(np.float64, name):
            self._no(f".{name}")
        raise AttributeError(name)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        return _on_arrays(ufunc, method, inputs, options)

    def __array_function__(self, function: Any, _: Any, args: Any, options: Any) -> Any:
        return _on_numpy(function, args, options)

    def _no(self, what: str) -> Any:
        raise CannotRecord(f"{what} of a number that depends on time or state")

    def __bool__(self) -> bool:
        return bool(applied("not_equal", (self, 0.0)))

    def __float__(self) -> float:
        return float(self._no("float()"))

    def __int__(self) -> int:
        return int(self._no("int()"))

    __index__ = __int__

    def __hash__(self) -> int:
        return int(self._no("hash()"))

    def __round__(self, digits: int | None = None) -> Any:
        return self._no("round()")

    def __floor__(self) -> Any:
        return applied("floor", (self,))

    def __ceil__(self) -> Any:
        return applied("ceil", (self,))

    def __trunc__(self) -> Any:
        return applied("trunc", (self,))

    def __divmod__(self, other: Any) -> tuple[Any, Any]:
        return self // other, self % other

    def __rdivmod__(self, other: Any) -> tuple[Any, Any]:
        return other // self, other % self

    def __repr__(self) -> str:
        # A message may be made and printed; the tape counts that.
        self.tape.texts += 1
        return TEXT

    def __format__(self, spec: str) -> str:
        return repr(self)

    @property
    def real(self) -> Symbol:
        return self

    def item(self) -> Symbol:
        return self

    copy = conjugate = item

    def astype(self, dtype: Any, **options: Any) -> Any:
        return boxed(self).view(Symbols).astype(dtype, **options)[()]


# Functions ask whether an argument is a number, not an array.
numbers.Real.register(Symbol)


class Condition:
    """What holds where a number is negative, or where it is not."""

    __slots__ = ("negative", "symbol")

    def __init__(self, symbol: Symbol, negative: bool) -> None:
        self.symbol, self.negative = symbol, negative

    def __bool__(self) -> bool:
        return self.symbol.tape.decide(self)

    def choose(self, yes: Any, no: Any) -> Symbol:
        """`yes` where the condition holds, and else `no`."""
        above, below = (no, yes) if self.negative else (yes, no)
        return self.symbol.tape.select(self.symbol, above, below)

    def below(self) -> Symbol:
        """A number that is negative where the condition holds."""
        return self.symbol if self.negative else self.choose(-1.0, 1.0)

    def number(self) -> Symbol:
        return self.choose(1.0, 0.0)

    __float__, __int__, __index__ = Symbol.__float__, Symbol.__int__, Symbol.__index__
    __hash__, __repr__, __format__ = Symbol.__hash__, Symbol.__repr__, Symbol.__format__
    _no, astype = Symbol._no, Symbol.astype

    @property
    def tape(self) -> Decisions:
        return self.symbol.tape

    def __invert__(self) -> Condition:
        return Condition(self.symbol, not self.negative)

    def _join(self, other: Any, name: str) -> Any:
        if not isinstance(other, Condition):
            absorbed = bool(other) == (name == "minimum")
            return bool(other) if absorbed else self
        return Condition(applied(name, (self.below(), other.below())), True)

    def __and__(self, other: Any) -> Any:
        return self._join(other, "maximum")

    def __or__(self, other: Any) -> Any:
        return self._join(other, "minimum")

    __rand__, __ror__ = __and__, __or__

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        return _on_arrays(ufunc, method, inputs, options)

    def __array_function__(self, function: Any, _: Any, args: Any, options: Any) -> Any:
        return _on_numpy(function, args, options)


class Symbols(np.ndarray[Any, Any]):
    """An array of symbols and numbers, with which numpy's functions record."""

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        return _on_arrays(ufunc, method, inputs, options)

    def __array_function__(self, function: Any, _: Any, args: Any, options: Any) -> Any:
        return _on_numpy(function, args, options)

    def __repr__(self) -> str:
        symbols = [one for one in self.flat if isinstance(one, Symbol | Condition)]
        return repr(symbols[0]) if symbols else super().__repr__()

    def __format__(self, spec: str) -> str:
        return repr(self)

    __str__ = __repr__

    def astype(self, dtype: Any, *_: Any, **options: Any) -> Any:
        """A copy: truth values may become numbers, and numbers stay what they are."""
        plain = np.asarray(self)
        kind = np.dtype(dtype).kind
        truths = all(isinstance(one, Condition | bool | np.bool_) for one in plain.flat)
        if not (is_real(dtype) or truths and kind in "iub"):
            raise CannotRecord(f"an array of {np.dtype(dtype)}")
        return plain.copy().view(Symbols) if kind in "bO" else as_numbers(plain)

    def __setitem__(self, index: Any, values: Any) -> None:
        mask = np.asarray(index, dtype=object) if isinstance(index, np.ndarray) else index
        chosen: Any = [] if isinstance(index, tuple | slice) else np.ravel(boxed(mask))
        if any(isinstance(one, Condition) for one in chosen):
            if np.ndim(values) and np.shape(values) != self.shape:
                raise CannotRecord("a choice of entries by a condition")
            np.asarray(self)[...] = np.asarray(where_of(mask, values, self.copy()), dtype=object)
        else:
            super().__setitem__(index, values)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, Condition) or (
            isinstance(index, np.ndarray) and any(isinstance(i, Condition) for i in index.flat)
        ):
            raise CannotRecord("a choice of entries by a condition")
        return super().__getitem__(index)


class Decisions:
    """A tape of formulas, and the way that is followed through a function."""

    def __init__(self) -> None:
        self.native = _native.Tape()
        self.way: list[tuple[int, bool, bool]] = []
        self.place = 0
        #: Texts that were made of numbers, and not printed.
        self.texts = 0
        #: Whether a function catches exceptions of arithmetic.
        self.catches = False

    def number(self, value: Any) -> Symbol:
        """A symbol, a condition or a number as a symbol."""
        if isinstance(value, Symbol):
            return value
        if isinstance(value, Condition):
            return value.number()
        if isinstance(value, np.ndarray) and value.ndim == 0:
            return self.number(value[()])
        if isinstance(value, numbers.Real):
            return Symbol(self, self.native.constant(float(value)))
        raise CannotRecord(f"a {type(value).__name__} where a number is expected")

    def select(self, condition: Symbol, above: Any, below: Any) -> Symbol:
        above, below = self.number(above), self.number(below)
        return Symbol(self, self.native.select(condition.id, above.id, below.id))

    def decide(self, condition: Condition) -> bool:
        """The outcome of a condition on the way that is followed."""
        known = self.native.value(condition.symbol.id)
        if known is not None:
            return (known < 0.0) == condition.negative
        for node, is_negative, _ in self.way[: self.place]:
            if node == condition.symbol.id:
                return is_negative == condition.negative
        if self.place >= MOST_DECISIONS:
            raise CannotRecord(f"more than {MOST_DECISIONS} decisions on one way")
        if self.place == len(self.way):
            self.way.append((condition.symbol.id, True, False))
        self.place += 1
        return self.way[self.place - 1][1] == condition.negative


_UNARY = {
    "negative": "neg",
    "absolute": "abs",
    "fabs": "abs",
    "floor": "floor",
    "square": "square",
    "sqrt": "sqrt",
    "exp": "exp",
    "expm1": "expm1",
    "log": "log",
    "log1p": "log1p",
    "sin": "sin",
    "cos": "cos",
    "tan": "tan",
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "sinh": "sinh",
    "cosh": "cosh",
    "tanh": "tanh",
    "arcsinh": "asinh",
    "arccosh": "acosh",
    "arctanh": "atanh",
    "erf": "erf",
}
_BINARY = {
    "add": "add",
    "subtract": "sub",
    "multiply": "mul",
    "divide": "div",
    "true_divide": "div",
    "minimum": "min",
    "fmin": "min",
    "maximum": "max",
    "fmax": "max",
    "arctan2": "atan2",
    "power": "power",
    "float_power": "power",
    "mod": "mod",
    "remainder": "mod",
}
#: What may raise an exception for some numbers: divisions, and functions with a domain or a range.
_RAISING = {"divide", "true_divide", "floor_divide", "mod", "remainder", "power", "float_power"}
_RAISING |= {"sqrt", "log", "log1p", "log10", "log2", "arcsin", "arccos", "arccosh", "arctanh"}
_RAISING |= {"exp", "expm1", "exp2", "sinh", "cosh", "fmod"}
_COMPARE = {
    "less": (False, True),
    "greater": (True, True),
    "less_equal": (True, False),
    "greater_equal": (False, False),
}
_DERIVED: dict[str, Callable[..., Any]] = {
    "positive": lambda a: a,
    "conjugate": lambda a: a,
    "reciprocal": lambda a: 1.0 / a,
    "sign": lambda a: (a < 0.0).choose(-1.0, (a > 0.0).choose(1.0, 0.0)),
    "heaviside": lambda a, b: (a < 0.0).choose(0.0, (a > 0.0).choose(1.0, b)),
    "ceil": lambda a: -np.floor(-a),
    "trunc": lambda a: (a < 0.0).choose(-np.floor(-a), np.floor(a)),
    "fmod": lambda a, b: (a < 0.0).choose(-np.mod(-a, np.abs(b)), np.mod(a, np.abs(b))),
    "clip": lambda a, low, high: np.minimum(np.maximum(a, low), high),
    "cbrt": lambda a: np.copysign(np.abs(a) ** (1.0 / 3.0), a),
    "expit": lambda a: 1.0 / (1.0 + np.exp(-a)),
    "logaddexp": lambda a, b: np.maximum(a, b) + np.log1p(np.exp(-np.abs(a - b))),
    "floor_divide": lambda a, b: np.floor(a / b),
    "hypot": lambda a, b: np.sqrt(a * a + b * b),
    "log10": lambda a: np.log(a) / math.log(10.0),
    "log2": lambda a: np.log(a) / math.log(2.0),
    "exp2": lambda a: np.exp(a * math.log(2.0)),
    "deg2rad": lambda a: a * (math.pi / 180.0),
    "radians": lambda a: a * (math.pi / 180.0),
    "rad2deg": lambda a: a * (180.0 / math.pi),
    "degrees": lambda a: a * (180.0 / math.pi),
    "copysign": lambda a, b: np.abs(a) * (b < 0.0).choose(-1.0, 1.0),
    "logical_not": lambda a: ~a,
    "invert": lambda a: ~a,
    "logical_and": lambda a, b: a & b,
    "bitwise_and": lambda a, b: a & b,
    "logical_or": lambda a, b: a | b,
    "bitwise_or": lambda a, b: a | b,
    "equal": lambda a, b: Condition(-np.abs(a - b), False),
    "not_equal": lambda a, b: Condition(-np.abs(a - b), True),
}
_DERIVED |= {"logical_xor": _DERIVED["not_equal"]}
_LOGICAL = {"logical_not", "invert", "logical_and", "bitwise_and", "logical_or", "bitwise_or"}
#: What truth values have as numbers.
_OF_TRUTHS = {"multiply", "equal", "not_equal", "logical_xor", *_COMPARE}


def applied(name: str, args: Sequence[Any]) -> Any:
    """A function of symbols and numbers by its numpy name."""
    args = [a[()] if isinstance(a, np.ndarray) and a.ndim == 0 else a for a in args]
    tape = next((a.tape for a in args if isinstance(a, Symbol | Condition)), None)
    if tape is None:
        return getattr(np, name)(*args)
    if name in _LOGICAL:
        return _DERIVED[name](*args)
    if name in _RAISING and tape.catches:
        raise CannotRecord(f"numpy.{name} where an exception may be caught")
    if name not in _OF_TRUTHS and sum(isinstance(a, Condition) for a in args) > 1:
        # numpy's truth values have other sums than Python's.
        raise CannotRecord(f"numpy.{name} of two truth values")
    if not all(isinstance(a, Symbol | Condition | numbers.Real) for a in args):
        kinds = ", ".join(type(a).__name__ for a in args)
        raise CannotRecord(f"numpy.{name} of {kinds}")
    args = [tape.number(a) for a in args]
    if name in _UNARY and len(args) == 1:
        return Symbol(tape, tape.native.unary(_UNARY[name], args[0].id))
    if name in _BINARY and len(args) == 2:
        return Symbol(tape, tape.native.binary(_BINARY[name], args[0].id, args[1].id))
    if name in _COMPARE:
        turned, negative = _COMPARE[name]
        a, b = reversed(args) if turned else args
        return Condition(applied("subtract", (a, b)), negative)
    if name in _DERIVED:
        return _DERIVED[name](*args)
    raise CannotRecord(f"numpy.{name}")


def _operator(name: str, turned: bool = False) -> Any:
    ufunc = getattr(np, name)

    def operate(self: Any, other: Any) -> Any:
        args = (other, self) if turned else (self, other)
        if isinstance(other, np.ndarray):
            return _on_arrays(ufunc, "__call__", args, {})
        if isinstance(other, complex | np.complexfloating):
            raise CannotRecord("complex numbers")
        if not isinstance(other, Symbol | Condition | numbers.Real):
            return NotImplemented
        return applied(name, args)

    return operate


for _python, _name in {
    "add": "add",
    "sub": "subtract",
    "mul": "multiply",
    "truediv": "divide",
    "pow": "power",
    "mod": "mod",
    "floordiv": "floor_divide",
}.items():
    for _class in (Symbol, Condition):
        setattr(_class, f"__{_python}__", _operator(_name))
        setattr(_class, f"__r{_python}__", _operator(_name, True))
for _python, _name in {
    "lt": "less",
    "le": "less_equal",
    "gt": "greater",
    "ge": "greater_equal",
    "eq": "equal",
    "ne": "not_equal",
}.items():
    for _class in (Symbol, Condition):
        setattr(_class, f"__{_python}__", _operator(_name))
setattr(Condition, "__xor__", _operator("not_equal"))
for _python, _name in {"neg": "negative", "pos": "positive", "abs": "absolute"}.items():
    setattr(Symbol, f"__{_python}__", lambda self, name=_name: applied(name, (self,)))
for _name in (*_UNARY, "log10", "log2", "exp2", "deg2rad", "rad2deg", "cbrt", "trunc"):
    # numpy calls these for the elements of arrays of objects.
    setattr(Symbol, _name, lambda self, name=_name: applied(name, (self,)))


def is_real(dtype: Any) -> bool:
    """Whether an array of this type may consist of symbols."""
    if isinstance(dtype, type) and issubclass(dtype, float):
        return True
    return dtype in (None, object, "float", "float64", "d")


def has_symbols(value: Any) -> bool:
    if isinstance(value, Symbol | Condition):
        return True
    if isinstance(value, np.ndarray):
        return bool(value.dtype == object)
    return isinstance(value, list | tuple) and any(map(has_symbols, value))


def boxed(value: Any) -> Any:
    """Something as an array of objects."""
    if isinstance(value, np.ndarray):
        return np.asarray(value, dtype=object)
    if isinstance(value, list | tuple):
        return np.asarray(array_of(value), dtype=object)
    box = np.empty((), dtype=object)
    box[()] = value
    return box


def array_of(values: Any) -> Any:
    """An array of what may be symbols, lists and arrays."""
    if isinstance(values, list | tuple):
        parts = [np.asarray(array_of(value), dtype=object) for value in values]
        shapes = {part.shape for part in parts}
        if len(shapes) > 1:
            raise CannotRecord("a list of parts with different shapes")
        array = np.empty((len(parts), *(shapes.pop() if shapes else ())), dtype=object)
        for index, part in enumerate(parts):
            array[index] = part if part.ndim else part[()]
        return array.view(Symbols)
    return boxed(values).view(Symbols)


def viewed(result: Any) -> Any:
    if isinstance(result, np.ndarray) and result.dtype == object:
        return result.view(Symbols) if result.ndim else result[()]
    if isinstance(result, list | tuple):
        return type(result)(map(viewed, result))
    return result


def as_numbers(values: Any) -> Any:
    """An array of symbols and doubles: truth values and integers become numbers."""

    def one(value: Any) -> Any:
        if isinstance(value, Symbol) or value is None:
            return value
        return value.number() if isinstance(value, Condition) else np.float64(value)

    array = np.empty(np.shape(values), dtype=object)
    array.reshape(-1)[:] = list(map(one, np.asarray(values, dtype=object).flat))
    return array.view(Symbols)


def is_known(value: Any) -> bool:
    """Whether there are no symbols inside."""
    if isinstance(value, np.ndarray):
        return value.dtype != object or all(map(is_known, value.flat))
    if isinstance(value, list | tuple):
        return all(map(is_known, value))
    return not isinstance(value, Symbol | Condition)


def known(value: Any) -> Any:
    """Numbers where arrays of objects, also in lists, have no symbols inside."""
    if isinstance(value, np.ndarray) and value.dtype == object:
        return np.array(value, dtype=float)
    return type(value)(map(known, value)) if type(value) in (list, tuple) else value


_PRODUCTS = {"matmul", "vecdot", "matvec", "vecmat"}


def _on_arrays(ufunc: Any, method: str, inputs: Any, options: dict[str, Any]) -> Any:
    """What a universal function of numpy does with symbols."""
    name = ufunc.__name__
    arrays = any(isinstance(value, np.ndarray | list | tuple) for value in inputs)
    if not arrays and not options and method == "__call__" and name not in _PRODUCTS:
        return applied(name, inputs)
    out, where = options.pop("out", None), options.pop("where", True)
    dtype = options.pop("dtype", None)
    is_usual = is_real(dtype) or (name in _LOGICAL and np.dtype(dtype) == bool)
    if not is_usual or (where is not True and (not out or method != "__call__")):
        raise CannotRecord(f"numpy.{name} with options")
    first = options.pop("initial", None)
    if method not in ("__call__", "outer", "reduce", "accumulate"):
        raise CannotRecord(f"numpy.{name}.{method}")
    # Where these say nothing, arrays of objects do not take them.
    kept = {"axis", "keepdims"}
    options = {name: value for name, value in options.items() if name in kept}
    plain = [boxed(value) for value in inputs]
    if name == "add" and method != "__call__":
        # A sum of truth values counts.
        plain = [as_numbers(value) for value in plain]
    if name in _PRODUCTS:
        result = ufunc(*map(np.asarray, plain), **options)
    else:
        each = np.frompyfunc(lambda *args: applied(name, args), ufunc.nin, 1)
        result = getattr(each, method)(*map(np.asarray, plain), **options)
    if first is not None and first is not np._NoValue:
        result = ufunc(viewed(result), first)
    if out is None:
        return viewed(result)
    result = result if where is True else where_of(where, result, out[0])
    np.asarray(out[0])[...] = result
    return out[0]


def where_of(condition: Any, yes: Any = None, no: Any = None) -> Any:
    """`yes` where a condition holds, and else `no`, entry by entry."""
    if yes is None or no is None:
        raise CannotRecord("numpy.where with one argument")

    def one(condition: Any, yes: Any, no: Any) -> Any:
        if isinstance(condition, Symbol):
            condition = applied("not_equal", (condition, 0.0))
        if isinstance(condition, Condition):
            return condition.choose(yes, no)
        return yes if condition else no

    return viewed(np.frompyfunc(one, 3, 1)(*map(boxed, (condition, yes, no))))


#: Functions of numpy for which others stand.
STANDS_FOR: dict[Any, Callable[..., Any]] = {}


def _on_numpy(function: Any, args: Any, options: Any) -> Any:
    """What a function of numpy does with symbols: that of objects, unless it needs numbers."""
    if function in STANDS_FOR:
        return STANDS_FOR[function](*args, **options)

    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return np.asarray(value)
        if isinstance(value, Symbol | Condition):
            return boxed(value)
        return type(value)(map(plain, value)) if isinstance(value, list | tuple) else value

    def with_numbers(why: str) -> Any:
        if not all(map(is_known, (*args, *options.values()))):
            raise CannotRecord(why)
        found = function(*map(known, args), **{k: known(v) for k, v in options.items()})
        return as_numbers(found) if isinstance(found, np.ndarray) else found

    name = f"{function.__module__}.{function.__name__}"
    if name.startswith(("numpy.linalg.", "numpy.fft.")) or function.__name__.startswith("nan"):
        return with_numbers(name)
    try:
        result = function(*map(plain, args), **{k: plain(v) for k, v in options.items()})
    except (TypeError, ValueError) as error:
        return with_numbers(f"numpy.{function.__name__}: {error}")
    return viewed(result)
