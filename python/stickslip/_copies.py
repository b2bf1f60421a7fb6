"""Copies of functions, in which `math`, `max` and the like understand symbols.

Nothing that others see is changed: a copy has names of its own, and copies of what it could change.
"""

from __future__ import annotations

import builtins
import copy
import dis
import enum
import functools
import numbers
import sys
import types
from typing import Any, NamedTuple

import numpy as np

from stickslip._compiled import Compiled
from stickslip._numpy_functions import polyline_of, spline_of
from stickslip._states import state_of
from stickslip._swaps import BUILTINS, SWAPS, either, vectorized
from stickslip._symbols import REFUSALS, TEXT, CannotRecord, Decisions, Symbol, Symbols, boxed

#: Values that nobody can change.
_FIXED = (
    *(numbers.Number, str, bytes, np.ufunc, np.dtype),
    *(BaseException, Compiled, Symbol, Symbols),
)
#: Piecewise polynomials of SciPy.
_SPLINES = {"CubicSpline", "PchipInterpolator", "Akima1DInterpolator", "PPoly"}
#: Modules whose functions return something else each time.
_CHANGING = {"random", "_random", "numpy.random", "time", "datetime", "os", "secrets", "uuid"}
#: And modules that do something.
_CHANGING |= {"logging", "warnings", "_warnings"}
_LOADS = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
_FORBIDDEN = {"STORE_GLOBAL", "STORE_DEREF", "STORE_ATTR", "DELETE_ATTR", "DELETE_GLOBAL"}
#: Packages whose classes are used as they are.
_LIBRARIES = {"numpy", "scipy", "numba", "stickslip", "sympy", "pandas", "xarray"}
#: Exceptions of arithmetic, and more general ones.
_ARITHMETIC = {"ValueError", "ZeroDivisionError", "OverflowError", "ArithmeticError", "Exception"}
_ARITHMETIC |= {"FloatingPointError", "BaseException", "suppress"}


class _Module(types.ModuleType):
    """A module whose functions are copied when they are used."""

    def __init__(self, real: types.ModuleType, copies: Copies) -> None:
        super().__init__(real.__name__)
        self.__dict__.update(_real=real, _copies=copies)

    def __getattr__(self, name: str) -> Any:
        return self.__dict__["_copies"].later(getattr(self.__dict__["_real"], name))


class _Attribute:
    """What a class has, copied when it is used."""

    def __init__(self, value: Any, copies: Copies) -> None:
        self.value, self.copies = value, copies

    def __get__(self, instance: Any, owner: Any) -> Any:
        value, copied = self.value, self.copies.later
        if isinstance(value, staticmethod | classmethod):
            return type(value)(copied(value.__func__)).__get__(instance, owner)
        getter = getattr(value, "fget", None) or getattr(value, "func", None)
        if isinstance(value, property | functools.cached_property):
            return self if instance is None else copied(getter)(instance)
        found = copied(value)
        return found.__get__(instance, owner) if hasattr(type(value), "__get__") else found


class _Unusable:
    """What has no copy: whoever uses it learns why."""

    def __init__(self, reason: str) -> None:
        self.__dict__["_reason"] = reason

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return self()

    def __call__(self, *_: Any, **__: Any) -> Any:
        raise CannotRecord(self.__dict__["_reason"])

    __bool__ = __iter__ = __len__ = __getitem__ = __setitem__ = __float__ = __array__ = __call__
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __neg__ = __matmul__ = __call__


class Copies:
    """Copies of what functions use, while they are recorded."""

    def __init__(self, tape: Decisions) -> None:
        self.tape = tape
        self._done: dict[int, Any] = {}
        #: What has a copy lives on, so that no other value gets its number.
        self._kept: list[Any] = []
        #: Copies of what a function could change, and their states.
        self._outside: list[tuple[Any, Any]] = []
        self._depth = 0
        self._builtins = BUILTINS | {"__import__": self._import, "print": self._print}

    def changed(self) -> bool:
        """Whether a function has changed something outside."""
        return any(state_of(value) != state for value, state in self._outside)

    def function(self, function: Any) -> Any:
        """The function with other names, which understand symbols."""
        kinds = (types.FunctionType, types.MethodType, functools.partial)
        if isinstance(function, kinds) or _inner(function) or _is_own(type(function)):
            return self.value(function)
        kind = type(function).__name__
        raise CannotRecord(f"the function is of type {kind}, whose code cannot be read")

    def value(self, value: Any) -> Any:
        """What stands for a value outside of a function."""
        key = id(value)
        if key in SWAPS:
            return SWAPS[key]
        if value is None or isinstance(value, _FIXED):
            return value
        if key not in self._done:
            self._kept.append(value)
            try:
                self._done[key] = found = self._copied(value)
            except BaseException:
                self._done.pop(key, None)
                raise
            if not self._depth:
                self._outside.append((found, state_of(found)))
        return self._done[key]

    def later(self, value: Any) -> Any:
        """What stands for a value that is used now, whatever is being copied."""
        depth, self._depth = self._depth, 0
        try:
            return self.value(value)
        finally:
            self._depth = depth

    def _copied(self, value: Any) -> Any:
        _refuse_changing(value)
        if isinstance(value, types.FunctionType):
            return self._twin(value) if _root(value) not in ("numpy", "scipy") else value
        if isinstance(value, types.MethodType):
            function, owner = value.__func__, self.value(value.__self__)
            if isinstance(function, types.FunctionType):
                return types.MethodType(self.value(function), owner)
            return getattr(owner, value.__name__)
        if isinstance(value, functools.partial):
            function, *args = map(self.value, (value.func, *value.args))
            named = {name: self.value(one) for name, one in value.keywords.items()}
            return functools.partial(function, *args, **named)
        if (inner := _inner(value)) is not None:
            return self.value(inner)
        if isinstance(value, types.ModuleType):
            own = _root(value) not in ("numpy", "scipy")
            return _Module(value, self) if own else value
        if isinstance(value, type):
            return self._class(value) if _is_own(value) else value
        if isinstance(value, types.BuiltinFunctionType):
            owner = value.__self__
            whole = owner is None or isinstance(owner, types.ModuleType | type)
            return value if whole else getattr(self.value(owner), value.__name__)
        if type(value).__name__ in _SPLINES and _root(type(value)) == "scipy":
            return either(value, functools.partial(spline_of, value))
        if type(value).__name__ == "interp1d" and _root(type(value)) == "scipy":
            return either(value, functools.partial(polyline_of, value))
        if isinstance(value, np.vectorize):
            return vectorized(self.value(value.pyfunc))
        if _root(type(value)) in _LIBRARIES:
            is_fixed = isinstance(value, tuple) and all(isinstance(one, _FIXED) for one in value)
            return value if is_fixed else self._deep(value)
        self._depth += 1
        try:
            return self._whole(value)
        finally:
            self._depth -= 1

    def _deep(self, value: Any) -> Any:
        if isinstance(value, np.matrix | np.ma.MaskedArray):
            raise CannotRecord(f"the function uses a {type(value).__name__}")
        if type(value) is np.ndarray and value.dtype == np.float64:
            return value.copy("K").view(Numbers)
        if isinstance(value, np.ndarray) and value.dtype == object:
            return np.frompyfunc(self.value, 1, 1)(value)
        try:
            return copy.deepcopy(value)
        except Exception as error:
            kind = type(value).__name__
            raise CannotRecord(f"the function uses a {kind}, which has no copy: {error}") from None

    def _whole(self, value: Any) -> Any:
        """A list, a tuple, a dict, or an instance of a class of Python's."""
        kind = type(value)
        if isinstance(value, tuple):
            return tuple.__new__(self.value(kind), map(self.value, value))
        if isinstance(value, enum.Enum):
            return value
        if kind in (list, dict):
            found = copy.copy(value)
        elif _is_own(kind):
            found = self._instance(value, kind)
        else:
            return self._rebuilt(value)
        self._done[id(value)] = found
        if isinstance(found, list | dict):
            for place, one in list(enumerate(found) if isinstance(found, list) else found.items()):
                found[place] = self.value(one)
        slots = [getattr(one, "__slots__", ()) for one in kind.__mro__]
        named = {name for row in slots for name in ([row] if isinstance(row, str) else row)}
        for name in named - {"__dict__", "__weakref__"}:
            if hasattr(value, name):
                object.__setattr__(found, name, self._part(getattr(value, name)))
        for name, one in getattr(value, "__dict__", {}).items():
            found.__dict__[name] = self._part(one)
        return found

    def _instance(self, value: Any, kind: type) -> Any:
        """An instance of the copy of a class, without its attributes."""
        twin: Any = self.value(kind)
        try:
            return object.__new__(twin)
        except TypeError:
            # It is a list, a dict or the like, too.
            pass
        try:
            found = copy.copy(value)
            if found is value:
                raise TypeError("a copy is the same")
            object.__setattr__(found, "__class__", twin)
        except Exception as error:
            reason = f"the function uses a {kind.__name__}, which has no copy: {error}"
            raise CannotRecord(reason) from None
        return found

    def _rebuilt(self, value: Any) -> Any:
        """What is written in C, or belongs to Python: made anew as by `copy.deepcopy`."""
        kind = type(value).__name__
        try:
            parts: Any = value.__reduce_ex__(4)
            if isinstance(parts, str):
                return value
            make, args, state, items, pairs = [*parts, None, None, None][:5]
            found: Any = make(*map(self.value, args))
            self._done[id(value)] = found
            for one in items or ():
                found.append(self.value(one))
            for key, one in pairs or ():
                found[self.value(key)] = self.value(one)
            if state is None:
                return found
            if hasattr(found, "__setstate__"):
                found.__setstate__(self.value(state))
            else:
                found.__dict__.update(self.value(state))
        except Exception as error:
            raise CannotRecord(f"the function uses a {kind}, which has no copy: {error}") from None
        return found

    def _part(self, value: Any) -> Any:
        """What stands for an attribute, which may not be used at all."""
        try:
            return self.value(value)
        except CannotRecord as reason:
            # Nothing that a function catches.
            REFUSALS.count -= 1
            return _Unusable(str(reason))

    def _class(self, kind: type) -> Any:
        """A class whose functions are copied when they are used."""
        if issubclass(kind, BaseException | enum.Enum):
            return kind
        if _is_own(type(kind)):
            raise CannotRecord(f"the function uses {kind.__name__}, which has a metaclass")
        own: dict[str, Any] = {}
        for name, value in vars(kind).items():
            is_place = isinstance(value, types.GetSetDescriptorType | types.MemberDescriptorType)
            if is_place or name in ("_abc_impl", "__slotnames__", "__del__"):
                continue
            as_it_is = isinstance(value, _FIXED) or name in _OF_CLASSES or value is None
            if not hasattr(value, "__set__") or isinstance(value, property):
                own[name] = value if as_it_is else _Attribute(value, self)
            elif _is_own(type(value)):
                own[name] = _Unusable(f"the function uses the descriptor {name!r}")
            else:
                own[name] = value
        make: Any = type(kind)
        try:
            return make(kind.__name__, tuple(map(self.value, kind.__bases__)), own)
        except TypeError as error:
            raise CannotRecord(f"the function uses the class {kind.__name__}: {error}") from None

    def _twin(self, function: types.FunctionType) -> types.FunctionType:
        read = _read(function.__code__, function.__name__ in ("__init__", "__post_init__"))
        if read.reasons:
            raise CannotRecord(f"the function {read.reasons[0]}")
        self.tape.catches |= read.catches
        names: dict[str, Any] = {"__builtins__": self._builtins}
        cells = tuple(types.CellType() for _ in function.__closure__ or ())
        twin = types.FunctionType(function.__code__, names, function.__name__, None, cells)
        self._done[id(function)] = twin
        twin.__defaults__ = tuple(map(self.later, function.__defaults__ or ()))
        named = (function.__kwdefaults__ or {}).items()
        twin.__kwdefaults__ = {name: self.later(value) for name, value in named}
        twin.__dict__.update((name, self.later(value)) for name, value in vars(function).items())
        for name in read.names & function.__globals__.keys():
            names[name] = self.later(function.__globals__[name])
        for new, old in zip(cells, function.__closure__ or (), strict=True):
            try:
                new.cell_contents = self.later(old.cell_contents)
            except ValueError:
                # A name that has no value yet.
                continue
        return twin

    def _import(self, *args: Any, **options: Any) -> Any:
        return self.later(builtins.__import__(*args, **options))

    def _print(self, *values: Any, **options: Any) -> None:
        if options.get("file") is not None:
            raise CannotRecord("the function prints into a file")
        self.tape.texts -= sum(value.count(TEXT) for value in values if isinstance(value, str))


class Numbers(np.ndarray[Any, Any]):
    """Doubles outside of a function; what its methods return may take symbols."""

    def dot(self, other: Any) -> Any:  # type: ignore[override]
        return np.dot(boxed(self).view(Symbols), other)

    def copy(self, *_: Any, **__: Any) -> Any:
        return boxed(self).copy().view(Symbols)


def _root(value: Any) -> str:
    """The package from which a function, a class or a module is."""
    name = value.__name__ if isinstance(value, types.ModuleType) else value.__module__
    return str(name or "").partition(".")[0]


def _is_own(kind: type) -> bool:
    """Whether a class is written in Python, and in no library."""
    root = _root(kind)
    is_heap_type = bool(kind.__flags__ & 1 << 9)
    return is_heap_type and root not in _LIBRARIES | sys.stdlib_module_names


def _inner(value: Any) -> Any:
    """The function of Python in a function with a cache, or one that is compiled by Numba."""
    if isinstance(value, functools._lru_cache_wrapper):
        return value.__wrapped__
    return value.py_func if _root(type(value)) == "numba" and hasattr(value, "py_func") else None


#: What a class has of its own.
_OF_CLASSES = {"__slots__", "__annotations__", "__match_args__", "__abstractmethods__"}
_OF_CLASSES |= {"__dataclass_fields__", "__dataclass_params__", "__static_attributes__"}


def _refuse_changing(value: Any) -> None:
    """Refuses modules, functions and generators that return something else each time."""
    if isinstance(value, types.ModuleType):
        name, module = f"the module {value.__name__}", value.__name__
    elif isinstance(value, types.BuiltinFunctionType):
        source = value.__self__
        source = source if isinstance(source, types.ModuleType) else type(source)
        module = getattr(source, "__module__", None) or source.__name__
        name = f"{value.__name__}, which changes by itself"
    elif type(value).__module__.startswith("numpy.random."):
        name, module = "random numbers", "random"
    else:
        kind = value if isinstance(value, type) else type(value)
        name, module = f"a {kind.__name__} of the module {kind.__module__}", kind.__module__
    if module in _CHANGING or module.startswith(("numpy.random.", "scipy.stats")):
        raise CannotRecord(f"the function uses {name}")


class _Code(NamedTuple):
    """What the code of a function, and of functions inside, does."""

    names: frozenset[str]
    #: What it does that makes it no formula.
    reasons: list[str]
    #: Whether it may catch exceptions of arithmetic.
    catches: bool


@functools.lru_cache(maxsize=1024)
def _read(code: types.CodeType, makes: bool) -> _Code:
    """makes: it is a constructor, which changes its own instance."""
    codes, rest = [], [code]
    while rest:
        codes.append(rest.pop())
        rest += [inner for inner in codes[-1].co_consts if isinstance(inner, types.CodeType)]
    own = {name for one in codes for name in one.co_cellvars}
    steps = [step for one in codes for step in dis.get_instructions(one)]
    names = {step.argval for step in steps if step.opname in _LOADS}
    reasons = []
    for before, step in zip([None, *steps], steps, strict=False):
        inner = step.opname == "STORE_DEREF" and step.argval in own
        if makes and step.opname == "STORE_ATTR" and before and "LOAD_FAST" in before.opname:
            loaded = before.argval if isinstance(before.argval, tuple) else (before.argval,)
            inner = loaded[-1:] == code.co_varnames[:1]
        if step.opname in _FORBIDDEN and not inner:
            reasons.append(f"changes {step.argval!r}, which others see")
        if step.opname == "IS_OP" and before and isinstance(before.argval, bool):
            reasons.append(f"asks whether something is {before.argval}")
    return _Code(frozenset(names), reasons, any(map(_catches, codes)))


def _catches(code: types.CodeType) -> bool:
    """Whether code may catch exceptions of arithmetic."""
    steps = list(dis.get_instructions(code))
    pairs = [(a.opname, b.opname) for a, b in zip(steps, steps[1:], strict=False)]
    handles = any(first == "PUSH_EXC_INFO" for first, _ in pairs)
    bare = ("PUSH_EXC_INFO", "POP_TOP") in pairs
    return handles and (bare or bool(_ARITHMETIC & set(code.co_names)))
