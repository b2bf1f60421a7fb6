"""Results of the native module, kept as the texts that they give."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Kept:
    """The numbers and the picture of a result that was copied or pickled."""

    text: str
    svg: Any

    def json(self) -> str:
        """All numbers."""
        return self.text

    def picture(self) -> Any:
        """The SVG document, or None if there is none."""
        return self.svg
