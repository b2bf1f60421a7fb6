"""Contact laws of particle codes."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from stickslip import _native

#: A law by its name, or its terms as in the JSON file of the program: normal ("linear", "hertz"),
#: damping ("none", "linear", "viscoelastic", "tsuji"), tangential ("constant", "mindlin"), history
#: ("displacement", "force"), rescaled, limit_damping (bool), end ("force", "overlap"). A term that is
#: not given is that of the paper's law.
Law: TypeAlias = str | Mapping[str, Any]


@dataclass(frozen=True)
class NamedLaw:
    """A contact law that has a name: keywords of the code that computes it."""

    name: str
    code: str
    #: Its terms.
    law: Mapping[str, Any]
    #: Its equations in scaled units.
    equations: str
    #: Whether the code's law has this form with tangential damping too.
    tangential_damping: bool
    #: Where the equations were read.
    source: str
    #: What was compared, and what was not.
    checked: str


def laws() -> dict[str, NamedLaw]:
    """The contact laws that have names; "+limit_damping" may be added to a name.

    >>> laws()["gran/hooke/history"].law["normal"]
    'linear'
    """
    return {fields["name"]: NamedLaw(**fields) for fields in json.loads(_native.laws())}


def arguments(law: Law | None, tangential_damping: float) -> tuple[str, float]:
    """The law as the compiled module takes it."""
    if law is None:
        law = "paper"
    text = law if isinstance(law, str) else json.dumps(dict(law), sort_keys=True)
    return text, float(tangential_damping)


def attributes(law: Law | None, tangential_damping: float) -> dict[str, str | float]:
    """The law as it stands in files: nothing if it is the paper's."""
    text, damping = arguments(law, tangential_damping)
    is_paper = (text, damping) == ("paper", 0.0)
    return {} if is_paper else {"law": text, "tangential_damping": damping}
