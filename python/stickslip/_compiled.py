"""Compiled functions: addresses of numba, SciPy and ctypes."""

from __future__ import annotations

import ctypes
import operator
import re
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip._arrays import unmasked

Floats: TypeAlias = NDArray[np.float64]


class Compiled:
    """A compiled function with the signature

        void f(double t, const double *y, double *out, const double *parameters)

    `out` takes the derivative of the state, the values of guards, or the state after a guard has
    fired, whichever the function is used for. If all functions of a system are compiled, it runs
    without the interpreter's lock.

    function: a `cfunc` of Numba, a `scipy.LowLevelCallable` (whose user data are the parameters), a
    function of ctypes, or the address of the code. parameters: numbers that are copied, and passed
    with each call.

    What is at an address cannot be checked; the types that Numba, SciPy or ctypes declare are.
    Another signature, or a function that reads or writes beyond its arrays, ends in wrong numbers
    or in a crash of the interpreter. The function may be called by any thread, and by several at
    once. It cannot raise an exception; NaN says that there is no value.
    """

    #: What `solve` asks of an event.
    terminal: bool | int = False
    direction: float = 0.0
    from_zero: int = 0
    smooth: bool = False

    def __init__(self, function: Any, parameters: ArrayLike | None = None) -> None:
        self._keeps = function
        self.__name__ = str(getattr(function, "__name__", "compiled"))
        address, pointer, signature = _code_of(function)
        if signature is not None and not _SIGNATURE.fullmatch(signature.replace(" ", "")):
            raise TypeError(
                f"the signature is {signature!r}; expected "
                "void (double t, double *y, double *out, double *parameters)"
            )
        if not 0 < address < 2 ** (8 * ctypes.sizeof(ctypes.c_void_p)):
            raise ValueError(f"{address} is not the address of a function")
        self.address = address
        self.parameters: Floats | None = None
        if parameters is not None:
            if pointer:
                raise ValueError("parameters are given twice: here and as user data")
            self.parameters = _reals(parameters, "parameters").reshape(-1)
            self.parameters.setflags(write=False)
            pointer = self.parameters.ctypes.data
        self._pointer = pointer

    def __reduce__(self) -> Any:
        raise TypeError("an address means nothing in another process: Compiled cannot be pickled")

    def __copy__(self) -> Compiled:
        copy = object.__new__(type(self))
        copy.__dict__.update(self.__dict__)
        return copy

    def __deepcopy__(self, memo: Any) -> Compiled:
        # The code and its parameters never change.
        return self.__copy__()

    def __repr__(self) -> str:
        return f"Compiled({self._keeps!r})"


_FUNCTION_OF_CTYPES: Any = type(ctypes.CFUNCTYPE(None)()).__mro__[1]
_POINTER = r"(const)?(double|float64|void)\*(const)?"
_SIGNATURE = re.compile(rf"void\((double|float64),{_POINTER},{_POINTER},{_POINTER}\)")


def _signature_of_ctypes(function: Any) -> str | None:
    """The signature that a function of ctypes declares, if it does.

    Without a declaration ctypes takes the result to be an int, which says nothing.
    """
    if function.argtypes is None:
        return None
    names: dict[Any, str] = {ctypes.c_double: "double", ctypes.c_void_p: "void*", None: "void"}
    names[ctypes.POINTER(ctypes.c_double)] = "double*"

    def name(one: Any) -> str:
        # NumPy's ndpointer says what it points to.
        dtype = getattr(one, "_dtype_", None)
        return f"{dtype}*" if dtype is not None else names.get(one, str(one))

    result = "void" if function.restype is ctypes.c_int else name(function.restype)
    return f"{result} ({', '.join(name(one) for one in function.argtypes)})"


def _code_of(function: Any) -> tuple[int, int, str | None]:
    """The addresses of a function and of its parameters, or 0, and its signature, if it has one."""
    if isinstance(function, int) and not isinstance(function, bool):
        return function, 0, None
    if isinstance(function, tuple) and type(function).__name__ == "LowLevelCallable":
        # Its own [] refuses.
        capsule = ctypes.py_object(tuple.__getitem__(function, 0))
        api = ctypes.pythonapi
        name = ctypes.PYFUNCTYPE(ctypes.c_char_p, ctypes.py_object)(("PyCapsule_GetName", api))(
            capsule
        )
        pointer = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object, ctypes.c_char_p)(
            ("PyCapsule_GetPointer", api)
        )(capsule, name)
        context = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object)(
            ("PyCapsule_GetContext", api)
        )(capsule)
        return int(pointer), int(context or 0), name.decode()
    if isinstance(function, _FUNCTION_OF_CTYPES):
        code = int(ctypes.cast(function, ctypes.c_void_p).value or 0)
        return code, 0, _signature_of_ctypes(function)
    address = getattr(function, "address", None)
    if isinstance(address, int):
        signature = getattr(function, "_sig", None)
        if signature is None:
            return address, 0, None
        result = str(signature.return_type).replace("none", "void")
        return address, 0, f"{result} ({', '.join(str(one) for one in signature.args)})"
    raise TypeError(
        f"a {type(function).__name__} is not compiled; expected a cfunc of Numba, a "
        "LowLevelCallable of SciPy, a function of ctypes, or an address"
    )


Function: TypeAlias = Callable[..., Any] | Compiled


def _reals(values: ArrayLike, what: str) -> Floats:
    """A copy as doubles."""
    array = unmasked(values)
    if array.dtype.kind == "c":
        raise TypeError(f"{what} is complex; expected real numbers (real and imaginary parts)")
    if array.dtype.kind not in "biufO" or (array.ndim == 0 and array.dtype.kind == "O"):
        raise TypeError(f"{what} is {values!r}; expected numbers")
    if array.dtype.kind == "O":
        array = np.array([float(one) for one in array.flat]).reshape(array.shape)
    return np.array(array, dtype=np.float64, order="C")


def _number(value: Any, what: str) -> float:
    if type(value) is float:
        return value
    array = _reals(value, what)
    if array.size != 1:
        if array.size and (array == array.flat[0]).all():
            return float(array.flat[0])
        raise ValueError(f"{what} has {array.size} values; expected one number for all components")
    return float(array.reshape(-1)[0])


def _count(value: int, what: str) -> int:
    number = operator.index(value)
    if not 1 <= number < 2**63:
        raise ValueError(f"{what} = {value}; expected 1 or above")
    return number
