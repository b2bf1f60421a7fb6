"""What functions of Python depend on, so that those that were recorded are known again.

Functions with the same signature return the same numbers: their code is the same, and so is all
that it reads: closures, defaults, attributes, globals, and what it takes out of modules. What is not
made of numbers, texts, small arrays, rows, modules and functions has no signature.
"""

from __future__ import annotations

import dis
import functools
import operator
import types
from collections.abc import Callable, Iterable
from functools import partial
from itertools import chain
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from stickslip._systems import Guard, HybridSystem, Mode, _Clock

#: Values that are their own signatures, and numbers, whose zeros have signs.
_PLAIN = {bool, int, str, bytes, type(None)}
_NUMBERS = {float, complex, np.float64, np.float32, np.int64, np.int32, np.bool_}
#: Functions of libraries that always do the same, but for those in `_INDIRECT`.
_FIXED = (type(np.dot), types.FunctionType)
#: Modules whose functions written in C do, but for those that read by other names than those in the
#: code, or what is outside.
_PURE = {"builtins", "math", "cmath", "_operator", "numpy"}
_INDIRECT = {"eval", "exec", "compile", "globals", "locals", "vars", "dir", "getattr", "hasattr"}
_INDIRECT |= {"__import__", "open", "input", "id", "hash", "fromfile", "fromregex", "genfromtxt"}
_INDIRECT |= {"load", "loadmat", "loadtxt", "mmread", "read", "readsav"}
_INDIRECT |= {"getbufsize", "geterr", "geterrcall", "get_printoptions"}
#: Attributes that lead to other names.
_LEADING = {"format", "format_map"}
_OF_MODES = {"right_hand_side", "guard_list", "_sources"}
_LOADS = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
_HIDING = {"IMPORT_NAME", "LOAD_BUILD_CLASS"}
#: Entries of arrays and rows that are compared.
_MOST_ENTRIES = 256
#: What can be set of a function; its closure, its globals and its builtins cannot.
_OF_FUNCTIONS = operator.attrgetter(
    "__code__", "__defaults__", "__kwdefaults__", "__dict__", "__name__"
)
_CONTENTS = partial(map, operator.attrgetter("cell_contents"))
_SIZES, _TYPES = partial(map, len), partial(map, type)


#: How something was read, of what, and what was found.
_Read: TypeAlias = tuple[Callable[[Any], Iterable[Any]], Any, list[Any]]


class Unsigned(Exception):
    """A value has no signature."""


class _Uses(NamedTuple):
    #: Names of globals.
    names: tuple[str, ...]
    #: The same, and those of attributes.
    every: frozenset[str]
    is_open: bool


@functools.lru_cache(maxsize=1024)
def _uses(code: types.CodeType) -> _Uses:
    """What code reads, also that of functions inside."""
    codes, rest = [], [code]
    while rest:
        codes.append(rest.pop())
        rest += [inner for inner in codes[-1].co_consts if isinstance(inner, types.CodeType)]
    steps = [step for one in codes for step in dis.get_instructions(one)]
    names = {step.argval for step in steps if step.opname in _LOADS}
    every = frozenset(name for one in codes for name in one.co_names)
    hides = any(step.opname in _HIDING for step in steps) or not _LEADING.isdisjoint(every)
    # What Python has of a function or an object: its name, its code, its attributes.
    hides |= any(name.startswith("__") for name in every)
    return _Uses(tuple(sorted(names)), every, not hides)


class Watch(NamedTuple):
    """What was read for a signature, to see without signing again that it is there still.

    The same objects are: those that can change were looked into. Equal ones may not be.
    """

    how: tuple[Callable[[Any], Iterable[Any]], ...]
    what: tuple[Any, ...]
    found: list[Any]
    arrays: list[tuple[Any, Any]]

    def holds(self) -> bool:
        """Whether the signature is the same. It may be if this is false."""
        now = chain.from_iterable(map(operator.call, self.how, self.what))
        try:
            same = all(map(operator.is_, now, self.found))
        except (KeyError, ValueError):
            # A name has no value any more.
            return False
        return same and all(_entries(array) == then for array, then in self.arrays)


class Signer:
    """Signs values, and keeps alive those that are told apart by their places."""

    def __init__(self) -> None:
        self.kept: list[Any] = []
        self._names: set[str] = set()
        self._modules: dict[int, types.ModuleType] = {}
        self._under_way: set[int] = set()
        self._has_modes = False
        self._functions: set[int] = set()
        self._reads: list[_Read] = []
        self._arrays: list[tuple[Any, Any]] = []

    def signature(self, values: Any) -> Any:
        """The signature of values. Raises Unsigned if they have none."""
        own = self._sign(values)
        while True:
            before = len(self._names), len(self._modules)
            modules = [self._module(module) for module in [*self._modules.values()]]
            if before == (len(self._names), len(self._modules)):
                if self._has_modes and not self._names.isdisjoint(_OF_MODES):
                    raise Unsigned
                return own, tuple(modules)

    def watch(self, functions: Iterable[Any], reads: Iterable[_Read]) -> Watch | None:
        """What was read, and was before, unless a function has no code that was signed."""
        if not self._functions.issuperset(map(id, functions)):
            return None
        how, what, found = zip(*self._reads, *reads, strict=True)
        return Watch(how, what, [*chain.from_iterable(found)], self._arrays)

    def _sign(self, value: Any) -> Any:
        kind = type(value)
        if kind in _PLAIN:
            return kind, value
        if kind in _NUMBERS:
            return kind, repr(value)
        if kind is types.ModuleType:
            self._modules[id(value)] = value
        elif kind is types.FunctionType and not _is_of_library(value.__module__):
            return self._inside(value, self._function)
        elif kind is tuple:
            return kind, self._inside(value, self._row) if value else ()
        elif kind is list:
            return kind, self._inside(value, self._list)
        elif kind is dict:
            return kind, self._inside(value, self._mapping)
        elif kind is np.ndarray and value.size <= _MOST_ENTRIES and value.dtype.kind in "fiub":
            self._arrays.append((value, _entries(value)))
            return self._arrays[-1][1]
        elif kind is Guard or kind is _Clock:
            return kind, self._row(self._read(dict.values, vars(value)))
        elif kind is Mode:
            self._read(dict.values, vars(value))
            self._has_modes = True
            return kind, value.name
        elif not _is_fixed(value):
            raise Unsigned
        self.kept.append(value)
        return kind, id(value)

    def _inside(self, value: Any, sign: Callable[[Any], Any]) -> Any:
        """What `sign` makes of a value that is not inside itself."""
        if id(value) in self._under_way:
            raise Unsigned
        self._under_way.add(id(value))
        signed = sign(value)
        self._under_way.discard(id(value))
        return signed

    def _row(self, values: Any) -> Any:
        if len(values) > _MOST_ENTRIES:
            raise Unsigned
        sign, plain = self._sign, _PLAIN
        return tuple([(type(it), it) if type(it) in plain else sign(it) for it in values])

    def _read(self, how: Callable[[Any], Iterable[Any]], what: Any) -> list[Any]:
        """What is found now, and must be found again."""
        found = [*how(what)]
        if what:
            self._reads.append((how, what, found))
        return found

    def _values(self, of: dict[str, Any], names: list[str]) -> list[Any]:
        return self._read(partial(map, of.__getitem__), names)

    def _absent(self, of: dict[str, Any], names: list[str]) -> None:
        self._read(partial(map, of.__contains__), names)

    def _list(self, values: list[Any]) -> Any:
        self._size(values)
        return self._row(self._read(iter, values))

    def _mapping(self, values: dict[Any, Any]) -> Any:
        self._size(values)
        return self._row(self._read(iter, values)), self._row(self._read(dict.values, values))

    def _size(self, values: Any) -> None:
        # It is read before the entries, so that none of these takes the place of another one.
        if self._read(_SIZES, (values,))[0] > _MOST_ENTRIES:
            raise Unsigned

    def _module(self, module: types.ModuleType) -> Any:
        own = vars(module)
        # A module may make up what it does not have.
        if "__getattr__" in own and not _is_of_library(module.__name__):
            raise Unsigned
        names = sorted(self._names | {"__getattr__"})
        found = [name for name in names if name in own]
        self._absent(own, [name for name in names if name not in own])
        self._read(_TYPES, (module,))
        return id(module), tuple(found), tuple(map(self._sign, self._values(own, found)))

    def _function(self, function: types.FunctionType) -> Any:
        code, defaults, named, attributes, _ = self._read(_OF_FUNCTIONS, function)
        uses, names = _uses(code), function.__globals__
        others: dict[str, Any] = getattr(function, "__builtins__")
        if not (uses.is_open and type(names) is type(others) is dict):
            raise Unsigned
        self._names |= uses.every
        own = [name for name in uses.names if name in names]
        rest = [name for name in uses.names if name not in names]
        self._absent(names, rest)
        try:
            read = self._values(names, own) + self._values(others, rest)
            read += self._read(_CONTENTS, function.__closure__ or ())
        except (KeyError, ValueError):
            # A name that has no value yet.
            raise Unsigned from None
        self._size(attributes)
        if defaults or named or attributes:
            read += [defaults, named, attributes]
        self.kept.append(code)
        self._functions.add(id(function))
        return id(code), tuple(own), self._row(read)


def reads_of(system: HybridSystem) -> list[_Read]:
    """What a system consists of, down to the functions of its modes."""
    reads: list[_Read] = []

    def read(how: Any, what: Any) -> None:
        reads.append((_SIZES, (what,), [len(what)]))
        reads.append((how, what, [*how(what)]))

    read(dict.values, vars(system))
    read(dict.values, system._modes)
    read(dict.values, system._sliding)
    for mode in system.modes:
        read(dict.values, vars(mode))
        read(iter, mode._sources)
        for source in mode._sources:
            read(dict.values, vars(source))
    return reads


def _entries(array: Any) -> Any:
    return array.shape, array.strides, array.dtype.str, array.tobytes()


def _is_of_library(module: str | None) -> bool:
    """Whether what a module of this name has is used as it is."""
    return str(module).partition(".")[0] in ("numpy", "scipy")


def _is_fixed(value: Any) -> bool:
    """Whether what a value does never changes."""
    if isinstance(value, type):
        # Classes that are written in C have no attributes that can be set.
        return value.__module__ in ("builtins", "numpy") and not value.__flags__ & 1 << 9
    if isinstance(value, types.BuiltinFunctionType):
        owned = isinstance(value.__self__, types.ModuleType | None)
        return owned and value.__module__ in _PURE and value.__name__ not in _INDIRECT
    if isinstance(value, np.ufunc):
        # One of objects may call a function of Python.
        return any("d" in loop for loop in value.types)
    return isinstance(value, _FIXED) and value.__name__ not in _INDIRECT
