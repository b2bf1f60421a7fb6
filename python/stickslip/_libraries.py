"""Libraries that are imported when they are used, and need not be installed otherwise."""

from __future__ import annotations

import importlib
from typing import Any


def library(name: str, purpose: str) -> Any:
    """The module `name`, or an error that says what installs it."""
    try:
        return importlib.import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise ImportError(
            f"{package} is not installed, and needed {purpose}: pip install {package}"
        ) from None
