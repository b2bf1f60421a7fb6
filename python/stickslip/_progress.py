"""Progress of long calls: reported to a callable, or shown on stderr."""

from __future__ import annotations

import importlib
import inspect
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias, TypeVar

#: Called with what is done, and with all that is known to be done; and, if it takes three
#: arguments, with words that say what is done now, where this is known.
Report: TypeAlias = Callable[..., object]
#: A callable; True for a bar on stderr.
Progress: TypeAlias = Report | bool
Found = TypeVar("Found")
#: Seconds between two texts of a line.
_INTERVAL = 0.1


def check(progress: Any) -> None:
    """Refuses what is no progress."""
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        kind = type(progress).__name__
        raise TypeError(f"progress is of type {kind}; expected a callable, or True for a bar")


class keeping:
    """What Ctrl-C leaves of a native call becomes `partial` of the exception, made by `make`."""

    def __init__(self, make: Callable[[Any], object]) -> None:
        self.make = make

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, stopped: BaseException | None, traceback: object) -> None:
        if isinstance(stopped, KeyboardInterrupt):
            found = vars(stopped).get("partial")
            if found is not None:
                stopped.partial = self.make(found)  # type: ignore[attr-defined]


def reporting(progress: Progress | None, what: str, run: Callable[[Report | None], Found]) -> Found:
    """The result of `run`, which gets a callable that reports thousandths, and is done then."""
    if progress is None:
        return run(None)
    with reported(progress, what) as report:
        found = run(report)
        if report is not None:
            report(1000, 1000)
        return found


@contextmanager
def reported(progress: Progress | None, what: str) -> Iterator[Report | None]:
    """The callable that reports; with True a bar of tqdm, or a line where it is not installed."""
    check(progress)
    if progress is None:
        yield None
    elif not isinstance(progress, bool):
        yield _told(progress)
    elif not progress:
        yield None
    else:
        try:
            tqdm: Any = importlib.import_module("tqdm").tqdm
        except ImportError:
            yield from _line(what)
        else:
            with tqdm(desc=what, file=sys.stderr) as bar:
                yield lambda done, steps, doing="": _advance(bar, done, steps, doing)


def _told(progress: Callable[..., object]) -> Report:
    """The same callable, which gets words only if it takes them."""
    try:
        inspect.signature(progress).bind(0, 0, "")
    except (TypeError, ValueError):
        return lambda done, steps, doing="": progress(done, steps)
    return lambda done, steps, doing="": progress(done, steps, doing)


def _advance(bar: Any, done: int, steps: int, doing: str) -> None:
    bar.total = steps
    if doing:
        bar.set_postfix_str(doing, refresh=False)
    bar.update(done - bar.n)


def _line(what: str) -> Iterator[Report]:
    """A line that is written again and again, and ended whatever happens."""
    last = -_INTERVAL
    text = f"{what}: nothing is done yet"

    def report(done: int, steps: int, doing: str = "") -> None:
        nonlocal last, text
        text = f"{what}: {done} of {steps}{f', {doing}' if doing else ''}"
        if time.monotonic() - last >= _INTERVAL:
            last = time.monotonic()
            sys.stderr.write(f"\r{text}")
            sys.stderr.flush()

    try:
        yield report
    finally:
        sys.stderr.write(f"\r{text}\n")
