"""Functions of numpy and SciPy that need more than arithmetic, for symbols."""

from __future__ import annotations

import bisect
from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip._symbols import STANDS_FOR, CannotRecord, array_of, is_known, known, where_of

#: Sizes of matrices of symbols that are inverted.
MOST_ROWS = 3


def _clip(a: Any, a_min: Any = None, a_max: Any = None, **options: Any) -> Any:
    low, high = options.pop("min", a_min), options.pop("max", a_max)
    if options:
        raise CannotRecord("numpy.clip with options")
    a = a if low is None else np.maximum(a, low)
    return a if high is None else np.minimum(a, high)


def _interp(x: Any, xp: Any, fp: Any, left: Any = None, right: Any = None) -> Any:
    """Linear pieces between given points."""
    if isinstance(x, np.ndarray | list | tuple) and np.ndim(x):
        return array_of([_interp(one, xp, fp, left, right) for one in x])
    if not is_known([xp, fp]):
        raise CannotRecord("numpy.interp of a table that depends on time or state")
    xp, fp = (np.asarray(known(values), dtype=float).tolist() for values in (xp, fp))
    result: Any = fp[0] if left is None else left
    for a, b, p, q in zip(xp, xp[1:], fp, fp[1:], strict=False):
        result = (x >= a).choose(p + (x - a) * ((q - p) / (b - a)), result)
    return (x >= xp[-1]).choose(fp[-1] if right is None else right, result)


def _select(conditions: Any, choices: Any, default: Any = 0.0) -> Any:
    result = default
    for condition, choice in reversed(list(zip(conditions, choices, strict=True))):
        result = where_of(condition, choice, result)
    return result


def _norm(x: Any, ord: Any = None, axis: Any = None, keepdims: bool = False) -> Any:
    order, x = ord, array_of(x)
    if axis is None and not keepdims and (x.ndim == 1 or order is None):
        x, axis = x.reshape(-1), 0
    if isinstance(axis, tuple) or axis is None or order not in (None, 1, 2, np.inf):
        raise CannotRecord("this norm")
    if order == 1:
        return np.abs(x).sum(axis=axis, keepdims=keepdims)
    if order == np.inf:
        return np.abs(x).max(axis=axis, keepdims=keepdims)
    return np.sqrt((x * x).sum(axis=axis, keepdims=keepdims))


def _minor(a: Any, row: int, column: int) -> Any:
    return np.delete(np.delete(a, row, axis=0), column, axis=1)


def _determinant(a: Any) -> Any:
    a = array_of(a)
    if is_known(a):
        return np.linalg.det(known(np.asarray(a)))
    if a.ndim != 2 or a.shape[0] != a.shape[1] or len(a) > MOST_ROWS:
        raise CannotRecord(f"a determinant of a matrix of shape {a.shape}")
    if len(a) == 1:
        return a[0, 0]
    return sum((-1.0) ** j * a[0, j] * _determinant(_minor(a, 0, j)) for j in range(len(a)))


def _inverse(a: Any) -> Any:
    """The inverse of a matrix of numbers, or of a small one of symbols, by its minors."""
    a = array_of(a)
    if is_known(a):
        return np.linalg.inv(known(np.asarray(a)))
    whole, n = _determinant(a), len(a)
    if n == 1:
        return 1.0 / a
    signs = (-1.0) ** np.add.outer(range(n), range(n))
    minors = [[_determinant(_minor(a, j, i)) for j in range(n)] for i in range(n)]
    return signs * array_of(minors) / whole


def spline_of(spline: Any, t: Any, derivative: int = 0) -> Any:
    """A piecewise polynomial of SciPy."""
    if spline.extrapolate is not True or spline.c.ndim != 2 or derivative:
        raise CannotRecord("a spline that is periodic, ends, has several values, or is derived")
    if isinstance(t, np.ndarray) and t.ndim:
        return array_of([spline_of(spline, one) for one in t])
    result: Any = None
    for start, coefficients in zip(spline.x, spline.c.T, strict=False):
        piece: Any = coefficients[0]
        for coefficient in coefficients[1:]:
            piece = piece * (t - start) + coefficient
        result = piece if result is None else (t >= start).choose(piece, result)
    return result


def _gradient(f: Any, *spacing: Any, **options: Any) -> Any:
    f = array_of(f)
    if options or f.ndim != 1 or len(f) < 2 or any(map(np.ndim, spacing)):
        raise CannotRecord("numpy.gradient with options")
    (h,) = spacing or (1.0,)
    ends = (f[1] - f[0]) / h, (f[-1] - f[-2]) / h
    return array_of([ends[0], *((f[2:] - f[:-2]) / (2.0 * h)), ends[1]])


def _searchsorted(a: Any, v: Any, side: str = "left", sorter: Any = None) -> Any:
    """A place in a table, on each way through the function."""
    if np.ndim(v) or sorter is not None:
        raise CannotRecord("numpy.searchsorted of an array, or with a sorter")
    return (bisect.bisect_left if side == "left" else bisect.bisect_right)(list(a), v)


def _sinc(x: Any) -> Any:
    x = np.pi * array_of(x)
    return where_of(x == 0.0, 1.0, np.sin(x) / x)


def polyline_of(curve: Any, t: Any) -> Any:
    """A linear `interp1d` of SciPy; beyond its ends it is what it is filled with, or NaN."""
    kind, extrapolates = getattr(curve, "_kind", None), getattr(curve, "_extrapolate", True)
    if kind != "linear" or extrapolates or np.ndim(curve.y) != 1 or np.ndim(t):
        raise CannotRecord("an interp1d that is not linear, extrapolates, or has several values")
    left, right = np.ravel(curve._fill_value_below), np.ravel(curve._fill_value_above)
    return _interp(t, curve.x, curve.y, float(left[0]), float(right[0]))


def _reduction(ufunc: Any) -> Any:
    def reduce(a: Any, axis: Any = None, dtype: Any = None, out: Any = None, **options: Any) -> Any:
        if out is not None:
            raise CannotRecord(f"numpy.{ufunc.__name__} with options")
        return ufunc.reduce(array_of(a), axis=axis, dtype=dtype, **options)

    return reduce


def _mean(a: Any, axis: Any = None, **options: Any) -> Any:
    return array_of(a).mean(axis=axis, **options)


#: Functions of numpy, and what stands for them.
NUMPY: dict[Any, Callable[..., Any]] = {
    np.where: where_of,
    np.clip: _clip,
    np.interp: _interp,
    np.select: _select,
    np.linalg.norm: _norm,
    np.linalg.det: _determinant,
    np.linalg.inv: _inverse,
    np.linalg.solve: lambda a, b: _inverse(a) @ array_of(b),
    np.gradient: _gradient,
    np.searchsorted: _searchsorted,
    np.sinc: _sinc,
    np.max: _reduction(np.maximum),
    np.min: _reduction(np.minimum),
    np.sum: _reduction(np.add),
    np.prod: _reduction(np.multiply),
    np.any: _reduction(np.logical_or),
    np.all: _reduction(np.logical_and),
    np.mean: _mean,
}
NUMPY |= {np.amax: NUMPY[np.max], np.amin: NUMPY[np.min]}
STANDS_FOR.update(NUMPY)
