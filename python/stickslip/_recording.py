"""Functions of Python as formulas: each is called once with symbols instead of numbers.

numpy's protocols do most of it. The function itself runs as a copy, whose names `math`, `max` and
the like understand symbols too; nothing that others see is changed. An `if` is followed both ways.
What cannot be recorded raises `CannotRecord` with the reason.
"""

import builtins
import copy
import dis
import functools
import math
import numbers
import types
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from stickslip import _native
from stickslip._compiled import Compiled

#: Ways through a function that are followed, and decisions on one way.
MOST_WAYS, MOST_DECISIONS = 64, 100


#: What an array of symbols may be asked to consist of.
_DTYPES: tuple[Any, ...] = (None, float, object, np.float64, "float", "float64", "d")


class CannotRecord(BaseException):
    """Why a function is no formula. A function that catches exceptions does not catch it."""

    #: How many there have been: what a function catches all the same is noticed.
    count = 0

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        CannotRecord.count += 1


class Symbol:
    """A number that is not known yet: a node of a tape."""

    __slots__ = ("id", "tape")
    __hash__ = None  # type: ignore[assignment]
    shape: tuple[int, ...] = ()
    ndim, size = 0, 1

    def __init__(self, tape: "Tape", node: int) -> None:
        self.tape, self.id = tape, node

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        return _on_arrays(ufunc, method, inputs, options)

    def __array_function__(self, function: Any, _: Any, args: Any, options: Any) -> Any:
        return _on_numpy(function, args, options)

    def _no(self, what: str) -> Any:
        raise CannotRecord(f"{what} of a number that depends on time or state")

    def __bool__(self) -> bool:
        return bool(_apply("not_equal", (self, 0.0)))

    def __float__(self) -> float:
        return float(self._no("float()"))

    def __int__(self) -> int:
        return int(self._no("int()"))

    __index__ = __int__

    def __iter__(self) -> Any:
        return self._no("iteration")

    def __len__(self) -> int:
        return int(self._no("len()"))

    def __round__(self, digits: int | None = None) -> Any:
        return self._no("round()")

    def __format__(self, spec: str) -> str:
        # A message may be made, and is not a result.
        return "<a number>"

    @property
    def real(self) -> "Symbol":
        return self

    def item(self) -> "Symbol":
        return self

    copy = item


class Condition:
    """What holds where a number is negative, or where it is not."""

    __slots__ = ("negative", "symbol")
    __hash__ = None  # type: ignore[assignment]

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

    def __invert__(self) -> "Condition":
        return Condition(self.symbol, not self.negative)

    def _join(self, other: Any, name: str) -> Any:
        if not isinstance(other, Condition):
            absorbed = bool(other) == (name == "minimum")
            return bool(other) if absorbed else self
        return Condition(_apply(name, (self.below(), other.below())), True)

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


    def __setitem__(self, index: Any, values: Any) -> None:
        mask = np.asarray(index, dtype=object) if isinstance(index, np.ndarray) else index
        chosen: Any = [] if isinstance(index, tuple | slice) else np.ravel(_boxed(mask))
        if any(isinstance(one, Condition) for one in chosen):
            if np.ndim(values) and np.shape(values) != self.shape:
                raise CannotRecord("a choice of entries by a condition")
            np.asarray(self)[...] = np.asarray(_where(mask, values, self.copy()), dtype=object)
        else:
            super().__setitem__(index, values)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, Condition) or (
            isinstance(index, np.ndarray) and any(isinstance(i, Condition) for i in index.flat)
        ):
            raise CannotRecord("a choice of entries by a condition")
        return super().__getitem__(index)


class Tape:
    """The formulas of a system, as they are recorded."""

    def __init__(self) -> None:
        self.native = _native.Tape()
        self.way: list[tuple[int, bool, bool]] = []
        self.place = 0

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

    def record(self, function: Callable[..., Any], n: int, args: tuple[Any, ...]) -> list[Symbol]:
        """The numbers that function(t, y, *args) returns, for y of shape (n,)."""
        outside: list[Any] = []
        done: dict[int, Any] = {}
        recorded = _copy(function, done, outside)
        args = tuple(_swapped(value, done, outside) for value in args)
        refusals = CannotRecord.count
        time = Symbol(self, self.native.time())
        state = np.empty(n, dtype=object)
        state[:] = [Symbol(self, self.native.component(i)) for i in range(n)]
        ways: list[tuple[list[tuple[int, bool, bool]], list[Symbol]]] = []
        self.way = []
        before = repr(list(map(_inside, outside)))
        while True:
            self.place = 0
            found = recorded(time, state.copy().view(Symbols), *args)
            whole = np.asarray(_array(found), dtype=object)
            flat = whole.reshape(-1)
            if whole.ndim > 1:
                raise CannotRecord(f"it returns an array of shape {whole.shape}")
            if any(isinstance(value, Condition | bool | np.bool_) for value in flat):
                raise CannotRecord("it returns a truth value")
            ways.append((self.way[: self.place], [self.number(value) for value in flat]))
            if len(ways) > MOST_WAYS:
                raise CannotRecord(f"more than {MOST_WAYS} ways through the function")
            del self.way[self.place :]
            while self.way and self.way[-1][2]:
                self.way.pop()
            if not self.way:
                break
            node, is_negative, _ = self.way.pop()
            self.way.append((node, not is_negative, True))
        if CannotRecord.count != refusals:
            raise CannotRecord("it catches what a number that is not known yet cannot do")
        if repr(list(map(_inside, outside))) != before:
            raise CannotRecord("the function changes something outside")
        return self._merged(ways, 0)

    def _merged(self, ways: list[Any], depth: int) -> list[Symbol]:
        if len(ways) == 1:
            return list(ways[0][1])
        node = ways[0][0][depth][0]
        below, above = (
            self._merged([way for way in ways if way[0][depth][1] == side], depth + 1)
            for side in (True, False)
        )
        if len(below) != len(above):
            raise CannotRecord("the number of results depends on a condition")
        condition = Symbol(self, node)
        return [self.select(condition, a, b) for a, b in zip(above, below, strict=True)]


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
_LOGICAL = {"logical_not", "invert", "logical_and", "bitwise_and", "logical_or", "bitwise_or"}


def _apply(name: str, args: Sequence[Any]) -> Any:
    """A function of symbols and numbers by its numpy name."""
    args = [a[()] if isinstance(a, np.ndarray) and a.ndim == 0 else a for a in args]
    tape = next((_tape(a) for a in args if isinstance(a, Symbol | Condition)), None)
    if tape is None:
        return getattr(np, name)(*args)
    if name in _LOGICAL:
        return _DERIVED[name](*args)
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
        return Condition(_apply("subtract", (a, b)), negative)
    if name in _DERIVED:
        return _DERIVED[name](*args)
    raise CannotRecord(f"numpy.{name}")


def _tape(value: Symbol | Condition) -> Tape:
    return value.tape if isinstance(value, Symbol) else value.symbol.tape


def _operator(name: str, turned: bool = False) -> Any:
    ufunc = getattr(np, name)

    def operate(self: Any, other: Any) -> Any:
        args = (other, self) if turned else (self, other)
        if isinstance(other, np.ndarray):
            return _on_arrays(ufunc, "__call__", args, {})
        if not isinstance(other, Symbol | Condition | numbers.Real):
            return NotImplemented
        return _apply(name, args)

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
    setattr(Symbol, f"__{_python}__", _operator(_name))
for _python, _name in {"neg": "negative", "pos": "positive", "abs": "absolute"}.items():
    setattr(Symbol, f"__{_python}__", lambda self, name=_name: _apply(name, (self,)))
for _name in _UNARY:
    # numpy calls these for the elements of arrays of objects.
    setattr(Symbol, _name, lambda self, name=_name: _apply(name, (self,)))


def _has_symbols(value: Any) -> bool:
    if isinstance(value, Symbol | Condition):
        return True
    if isinstance(value, np.ndarray):
        return bool(value.dtype == object)
    return isinstance(value, list | tuple) and any(map(_has_symbols, value))


def _boxed(value: Any) -> Any:
    """Something as an array of objects."""
    if isinstance(value, np.ndarray):
        return np.asarray(value, dtype=object)
    if isinstance(value, list | tuple):
        return np.asarray(_array(value), dtype=object)
    box = np.empty((), dtype=object)
    box[()] = value
    return box


def _array(values: Any) -> Any:
    """An array of what may be symbols, lists and arrays."""
    if isinstance(values, list | tuple):
        parts = [np.asarray(_array(value), dtype=object) for value in values]
        shapes = {part.shape for part in parts}
        if len(shapes) > 1:
            raise CannotRecord("a list of parts with different shapes")
        array = np.empty((len(parts), *(shapes.pop() if shapes else ())), dtype=object)
        for index, part in enumerate(parts):
            array[index] = part if part.ndim else part[()]
        return array.view(Symbols)
    return _boxed(values).view(Symbols)


def _viewed(result: Any) -> Any:
    if isinstance(result, np.ndarray) and result.dtype == object:
        return result.view(Symbols) if result.ndim else result[()]
    if isinstance(result, list | tuple):
        return type(result)(map(_viewed, result))
    return result


def _on_arrays(ufunc: Any, method: str, inputs: Any, options: dict[str, Any]) -> Any:
    """What a universal function of numpy does with symbols."""
    out = options.pop("out", None)
    if options.pop("where", True) is not True or options.pop("dtype", None) not in _DTYPES:
        raise CannotRecord(f"numpy.{ufunc.__name__} with options")
    # Where these say nothing, arrays of objects do not take them.
    kept = {"axis", "keepdims"}
    options = {name: value for name, value in options.items() if name in kept}
    plain = [_boxed(value) for value in inputs]
    if ufunc.__name__ in {"matmul", "vecdot", "matvec", "vecmat"}:
        result = ufunc(*plain, **options)
    else:
        each = np.frompyfunc(lambda *args: _apply(ufunc.__name__, args), ufunc.nin, 1)
        result = getattr(each, method)(*plain, **options)
    if out is not None:
        np.asarray(out[0])[...] = result
        return out[0]
    return _viewed(result)


def _where(condition: Any, yes: Any = None, no: Any = None) -> Any:
    if yes is None or no is None:
        raise CannotRecord("numpy.where with one argument")

    def one(condition: Any, yes: Any, no: Any) -> Any:
        if isinstance(condition, Symbol):
            condition = _apply("not_equal", (condition, 0.0))
        if isinstance(condition, Condition):
            return condition.choose(yes, no)
        return yes if condition else no

    return _viewed(np.frompyfunc(one, 3, 1)(*map(_boxed, (condition, yes, no))))


def _clip(a: Any, a_min: Any = None, a_max: Any = None, **options: Any) -> Any:
    low, high = options.pop("min", a_min), options.pop("max", a_max)
    if options:
        raise CannotRecord("numpy.clip with options")
    a = a if low is None else np.maximum(a, low)
    return a if high is None else np.minimum(a, high)


def _interp(x: Any, xp: Any, fp: Any, left: Any = None, right: Any = None) -> Any:
    """Linear pieces between given points."""
    if isinstance(x, np.ndarray) and x.ndim:
        return _array([_interp(one, xp, fp, left, right) for one in x])
    xp, fp = np.asarray(xp, dtype=float), np.asarray(fp, dtype=float)
    result: Any = fp[0] if left is None else left
    for a, b, p, q in zip(xp, xp[1:], fp, fp[1:], strict=False):
        result = (x >= a).choose(p + (x - a) * ((q - p) / (b - a)), result)
    return (x >= xp[-1]).choose(fp[-1] if right is None else right, result)


def _select(conditions: Any, choices: Any, default: Any = 0.0) -> Any:
    result = default
    for condition, choice in reversed(list(zip(conditions, choices, strict=True))):
        result = _where(condition, choice, result)
    return result


def _spline(spline: Any, t: Any, derivative: int = 0) -> Any:
    """A piecewise polynomial of SciPy."""
    if spline.extrapolate is not True or spline.c.ndim != 2 or derivative:
        raise CannotRecord("a spline that is periodic, ends, has several values, or is derived")
    if isinstance(t, np.ndarray) and t.ndim:
        return _array([_spline(spline, one) for one in t])
    result: Any = None
    for start, coefficients in zip(spline.x, spline.c.T, strict=False):
        piece: Any = coefficients[0]
        for coefficient in coefficients[1:]:
            piece = piece * (t - start) + coefficient
        result = piece if result is None else (t >= start).choose(piece, result)
    return result


def _norm(x: Any, order: Any = None) -> Any:
    if order not in (None, 2):
        raise CannotRecord("this norm")
    x = _array(x).reshape(-1)
    return np.sqrt((x * x).sum())


_NUMPY: dict[Any, Callable[..., Any]] = {
    np.where: _where,
    np.clip: _clip,
    np.interp: _interp,
    np.select: _select,
    np.linalg.norm: _norm,
    np.max: lambda a, axis=None: np.maximum.reduce(_array(a), axis=axis),
    np.min: lambda a, axis=None: np.minimum.reduce(_array(a), axis=axis),
}
_NUMPY |= {np.amax: _NUMPY[np.max], np.amin: _NUMPY[np.min]}


def _on_numpy(function: Any, args: Any, options: Any) -> Any:
    """What a function of numpy does with symbols: that of objects, unless it needs numbers."""
    if function in _NUMPY:
        return _NUMPY[function](*args, **options)
    if function.__module__.startswith("numpy.linalg") or function.__module__ == "numpy.fft":
        raise CannotRecord(f"{function.__module__}.{function.__name__}")

    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return np.asarray(value)
        if isinstance(value, Symbol | Condition):
            return _boxed(value)
        return type(value)(map(plain, value)) if isinstance(value, list | tuple) else value

    try:
        result = function(*map(plain, args), **{k: plain(v) for k, v in options.items()})
    except (TypeError, ValueError) as error:
        raise CannotRecord(f"numpy.{function.__name__}: {error}") from error
    return _viewed(result)


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
        symbols = any(map(_has_symbols, args)) or any(map(_has_symbols, options.values()))
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
    if dtype not in _DTYPES:
        raise CannotRecord(f"an array of {dtype}")
    return _array(values).copy()


def _joined(real: Callable[..., Any]) -> Callable[..., Any]:
    return lambda parts, *args, **options: _viewed(real([_boxed(p) for p in parts], *args, **options))


def _extreme(name: str, real: Callable[..., Any]) -> Callable[..., Any]:
    def function(*args: Any, **options: Any) -> Any:
        values = list(args[0]) if len(args) == 1 else list(args)
        if options or not any(map(_has_symbols, values)):
            return real(*args, **options)
        result = values[0]
        for value in values[1:]:
            result = _apply(name, (result, value))
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
    name: _either(getattr(math, name), lambda *args, to=to: _apply(to, args))
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
    for function, other in _NUMPY.items()
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
        return value if _has_symbols(value) else float(value)


_DTYPES += (_Float,)
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


def _copy(function: Any, done: dict[int, Any], outside: list[Any]) -> Any:
    """The function with other names, which understand symbols. What it could change is copied, and
    goes to `outside`."""
    if isinstance(function, types.MethodType):
        owner = _swapped(function.__self__, done, outside)
        return types.MethodType(_copy(function.__func__, done, outside), owner)
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
    copied = types.FunctionType(function.__code__, names, function.__name__, None, cells)
    done[id(function)] = copied
    defaults = function.__defaults__ or ()
    copied.__defaults__ = tuple(_swapped(value, done, outside) for value in defaults)
    named = (function.__kwdefaults__ or {}).items()
    copied.__kwdefaults__ = {name: _swapped(value, done, outside) for name, value in named}
    for name in used:
        names[name] = _swapped(function.__globals__[name], done, outside)
    for new, old in zip(cells, function.__closure__ or (), strict=True):
        try:
            new.cell_contents = _swapped(old.cell_contents, done, outside)
        except ValueError:
            # A name that has no value yet.
            continue
    return copied


def _swapped(value: Any, done: dict[int, Any], outside: list[Any]) -> Any:
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
        return _copy(value, done, outside) if own else value
    if isinstance(value, _FIXED) or value is None:
        return value
    if isinstance(value, np.random.Generator | np.random.RandomState):
        raise CannotRecord("the function uses random numbers")
    if isinstance(value, Symbol | Symbols):
        return value
    if type(value).__name__ in _SPLINES and type(value).__module__.startswith("scipy"):
        return _either(value, functools.partial(_spline, value))
    if id(value) not in done:
        try:
            done[id(value)] = copy.deepcopy(value)
        except Exception as error:
            kind = type(value).__name__
            raise CannotRecord(f"the function uses a {kind}, which has no copy: {error}") from None
        outside.append(done[id(value)])
    return done[id(value)]


def _inside(value: Any) -> Any:
    """What a value consists of, to see whether it changes."""
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype != object else value.tolist()
    return vars(value) if hasattr(value, "__dict__") else value
