"""Every example of a docstring holds."""

import doctest
import importlib
import linecache
import pkgutil
from typing import Any

import matplotlib as mpl
import pytest

import stickslip

mpl.use("Agg")

#: Another test has the example of this module, which takes long.
SLOW = {"_gaining"}
MODULES = [
    module.name
    for module in pkgutil.iter_modules(stickslip.__path__)
    if not module.ispkg and module.name not in {"__main__", "_native", *SLOW}
]


def test_there_are_examples() -> None:
    assert {"_collisions", "_hybrid", "_solutions", "_formulas"} <= set(MODULES)


@pytest.mark.parametrize("name", MODULES)
def test_examples_hold(name: str) -> None:
    module = importlib.import_module(f"stickslip.{name}")
    names: dict[str, Any] = {one: getattr(stickslip, one) for one in stickslip.__all__}
    # Python 3.11 forgets to look whether generated code is there still.
    for file in [file for file in linecache.cache if file.startswith("<")]:
        del linecache.cache[file]
    found = doctest.testmod(module, extraglobs=names)
    assert not found.failed
