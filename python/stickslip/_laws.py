"""Contact laws of particle codes."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeAlias

import numpy as np

from stickslip import _native

#: A law by its name, or its terms as in the JSON file of the program: normal ("linear", "hertz",
#: "dmt", "jkr"), damping ("none", "linear", "viscoelastic", "tsuji", "hysteretic", "hardening",
#: "yielding"), tangential ("constant", "mindlin"), history ("displacement", "force", "none"), rescaled, limit_damping
#: (bool), end ("force", "overlap"), coulomb_test ("total", "spring"), and friction, a mapping with
#: the numbers dynamic, mu_d/mu_s, and decay, B: Coulomb's limit is then
#: (dynamic + (1 - dynamic) exp(-B |w|)) |F|, and mu of psi is mu_s. With adhesion, "dmt" and "jkr",
#: there is also pull_off, the scaled force that separates the bodies:
#: {**laws()["granular/dmt/viscoelastic/mindlin"].law, "pull_off": 0.1}. A term that is not given is
#: that of the paper's law.
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


@dataclass(frozen=True)
class Keyword:
    """A keyword with which a particle code takes a coefficient of normal restitution."""

    keyword: str
    #: Where its formula was read.
    source: str
    #: The scaled damping that the code computes.
    damping: float
    #: What the code reaches with it, without errors of time steps.
    e_n: float


@dataclass(frozen=True)
class Restitution:
    """What it takes to have a coefficient of normal restitution."""

    e_n: float
    #: The scaled damping of the law that has it.
    damping: float
    #: The damping over the critical one; None where e_n depends on the velocity.
    critical_damping_ratio: float | None
    #: The keywords of the law's code.
    keywords: tuple[Keyword, ...]


def restitution(e_n: float, law: Law | None = None) -> Restitution:
    """The damping with which a contact law has the coefficient of normal restitution e_n.

    e_n: above 0, at most 1. law: as in `collide`. The damping is in closed form where that is known,
    and otherwise such that e_n is within 1e-12. A ValueError says if no damping of the law has e_n.

    >>> found = restitution(0.8, "liggghts/hertz/history")
    >>> found.keywords[0].keyword, round(found.keywords[0].e_n, 12)
    ('coefficientRestitution', 0.8)
    """
    fields = json.loads(_native.restitution(arguments(law, 0.0), float(e_n)))
    keywords = tuple(Keyword(**one) for one in fields.pop("keywords"))
    return Restitution(**fields, keywords=keywords)


def damping_of(damping: float, e_n: float | None, law: Law | None) -> float:
    """The scaled damping that is given, by itself or as the normal restitution that it makes."""
    if e_n is None:
        return damping
    if damping != 0.0:
        raise ValueError("damping and e_n are both given; expected one of them")
    return restitution(e_n, law).damping


def arguments(law: Law | None, tangential_damping: float) -> tuple[str, float]:
    """The law as the compiled module takes it."""
    if law is None:
        law = "paper"
    if not isinstance(law, str | Mapping):
        kind = type(law).__name__
        raise TypeError(f"law is of type {kind}; expected a name, or a mapping of terms")
    text = law if isinstance(law, str) else json.dumps(dict(law), sort_keys=True)
    _check(text)
    return text, float(tangential_damping)


def terms(law: Law | None) -> dict[str, Any]:
    """The terms of a law."""
    if not isinstance(law, str | None):
        return dict(law)
    name = (law or "paper").removesuffix("+limit_damping")
    known = laws()
    if name not in known:
        raise ValueError(_objection(name))
    found = dict(known[name].law)
    return found if name == law or law is None else {**found, "limit_damping": True}


def without_friction(law: Law | None) -> dict[str, Any]:
    """The terms of a law whose contact has no tangential force."""
    return {**terms(law), "history": "none"}


@cache
def _check(text: str) -> None:
    """Refuses what is no law, with names that are near."""
    try:
        # Without a single collision, nothing but the law is read.
        nothing = (np.empty(0), np.empty(0), np.empty(0))
        _native.eps_t(nothing, ("auto", None, None), (text, 0.0), True, 1)
    except ValueError as error:
        said = str(error)
        raise ValueError(said if "not computed" in said else _objection(text)) from None


def _objection(text: str) -> str:
    """What is wrong with a law."""
    known = laws()
    try:
        terms = json.loads(text)
    except ValueError:
        terms = None
    if not isinstance(terms, dict):
        names = [f"{name}+limit_damping" for name in known] if "+" in text else list(known)
        return f"law = {text!r}; expected a name of stickslip.laws(){_near(text, names)}"
    # The terms that laws with names have, and their values.
    values: dict[str, dict[Any, None]] = {}
    for one in known.values():
        for name, value in one.law.items():
            values.setdefault(name, {})[value] = None
    # A usual term is left out of a law.
    values.setdefault("coulomb_test", {})["total"] = None
    for name, value in terms.items():
        if name == "friction":
            numbers = value if isinstance(value, dict) else {}
            if set(numbers) <= {"dynamic", "decay"} and numbers:
                continue
            return f"law: friction = {value!r}; expected the numbers dynamic and decay"
        if name == "pull_off":
            if isinstance(value, int | float) and not isinstance(value, bool):
                continue
            return f"law: pull_off = {value!r}; expected a number"
        if name not in values:
            listed = f"{_listed(values)}{_near(name, values)}"
            return f"law: {name!r} is no term; expected one of {listed}"
        if isinstance(value, dict | list) or value not in values[name] or type(value) is int:
            listed = f"{_listed(values[name])}{_near(str(value), map(str, values[name]))}"
            return f"law: {name} = {value!r}; expected one of {listed}"
    return f"law = {text}; expected the terms of a law in stickslip.laws()"


def _listed(values: Iterable[Any]) -> str:
    return ", ".join(map(repr, values))


def _near(name: str, known: Iterable[str]) -> str:
    """Known names that look like this one."""
    from difflib import get_close_matches

    by_small = {one.lower(): one for one in known}
    near = get_close_matches(name.lower(), by_small, n=3, cutoff=0.75)
    return f"; perhaps {' or '.join(repr(by_small[one]) for one in near)}" if near else ""


def attributes(law: Law | None, tangential_damping: float) -> dict[str, str | float]:
    """The law as it stands in files: nothing if it is the paper's."""
    text, damping = arguments(law, tangential_damping)
    is_paper = (text, damping) == ("paper", 0.0)
    return {} if is_paper else {"law": text, "tangential_damping": damping}
