"""What crates/python exports; the modules that use it document shapes and units."""

import os
from collections.abc import Callable
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

_Floats: TypeAlias = NDArray[np.float64]
_Report: TypeAlias = Callable[..., object]
_Engine: TypeAlias = tuple[str, float | None, float | None]
_Law: TypeAlias = tuple[str, float]
_Vector: TypeAlias = tuple[float, float, float]
_Motion: TypeAlias = tuple[_Vector, _Vector, _Vector]
_Sphere: TypeAlias = tuple[float, float, float | None, float, float]

class ComputationError(RuntimeError): ...

def has_fused_products() -> bool: ...
def processor_has_fused_products() -> bool: ...
def program(arguments: list[str], output_is_closed: bool) -> int: ...
def version() -> str: ...
def explorer(view: str) -> str: ...
def laws() -> str: ...
def restitution(law: _Law, e_n: float) -> str: ...
def eps_t(
    parameters: tuple[_Floats, _Floats, _Floats],
    engine: _Engine,
    law: _Law,
    strict: bool,
    threads: int,
    progress: _Report | None = None,
) -> tuple[_Floats, NDArray[np.int32], list[tuple[int, str]]]: ...
def collide_many(
    parameters: tuple[_Floats, _Floats, _Floats],
    engine: _Engine,
    law: _Law,
    strict: bool,
    threads: int,
    progress: _Report | None = None,
) -> dict[str, Any]: ...

@final
class Collision:
    def __new__(
        cls, kappa: float, psi: float, damping: float, engine: _Engine, law: _Law
    ) -> Collision: ...
    def json(self) -> str: ...
    def estimate(self) -> tuple[float, float, bool]: ...
    def history(self, times: _Floats | None, moments: int) -> _Floats: ...
    def sensitivity(self) -> list[tuple[float, float, float, float]]: ...
    def picture(self) -> str: ...
    def animate(self, path: str | os.PathLike[str]) -> None: ...

@final
class Tape:
    def __new__(cls) -> Tape: ...
    def constant(self, x: float) -> int: ...
    def time(self) -> int: ...
    def component(self, index: int) -> int: ...
    def parameter(self, index: int) -> int: ...
    def value(self, formula: int) -> float | None: ...
    def unary(self, name: str, a: int) -> int: ...
    def binary(self, name: str, a: int, b: int) -> int: ...
    def select(self, condition: int, above: int, below: int) -> int: ...
    def evaluate(
        self,
        formulas: list[int],
        places: list[tuple[float, list[float]]],
        parameters: list[float],
    ) -> list[list[float]]: ...
    def text(self, formulas: list[int], n: int) -> list[str]: ...
    def zero_order(
        self,
        formula: int,
        slopes: list[int],
        t: float,
        y: list[float],
        parameters: list[float] = ...,
    ) -> int: ...
    def system(
        self,
        parameters: list[str],
        start: tuple[int, float, list[int], tuple[int, int] | None, list[int]],
        modes: list[tuple[str, list[int], list[dict[str, Any]]]],
        held: list[str],
        surfaces: list[tuple[str, int]],
    ) -> FormulaSystem: ...

@final
class FormulaSystem:
    def __new__(cls, text: str) -> FormulaSystem: ...
    @staticmethod
    def sliding(text: str, surfaces: list[str]) -> FormulaSystem: ...
    def text(self) -> str: ...
    def renamed(
        self, parameters: list[str], components: list[str], modes: list[str]
    ) -> FormulaSystem: ...
    def parameters(self) -> list[tuple[str, float, tuple[float, float] | None]]: ...
    def components(self) -> list[tuple[str, bool]]: ...
    def modes(self) -> list[tuple[str, list[str]]]: ...
    def sensitivities(
        self,
        by: list[tuple[bool, int]],
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        end: float | None,
        settings: dict[str, Any],
        progress: _Report | None,
    ) -> dict[str, Any]: ...
    def starts(self, parameters: _Floats) -> list[float]: ...
    def run(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        end: float | None,
        settings: dict[str, Any],
        times: _Floats | None,
        dense: bool,
        progress: _Report | None = None,
        compared: bool = False,
    ) -> dict[str, Any]: ...
    def converge(
        self,
        name: str,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        end: float | None,
        threads: int,
        progress: _Report | None = None,
    ) -> dict[str, Any]: ...

@final
class OrbitSystem:
    def __new__(cls, system: FormulaSystem) -> OrbitSystem: ...
    def find(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        itinerary: list[str],
        durations: list[float] | None,
    ) -> str: ...
    def settled(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        time: float,
        progress: _Report | None,
    ) -> str: ...
    def continued(self, orbit: str, parameters: list[float]) -> str: ...
    def switched(self, special: str, beside: str, parameter: int, aside: float) -> str: ...
    def branch(
        self,
        orbit: str,
        parameter: int,
        range: tuple[float, float],
        longest_step: float,
        most_points: int,
        progress: _Report | None,
    ) -> str: ...
    def read_branch(self, text: str) -> str: ...
    def resumed(
        self,
        branch: str,
        range: tuple[float, float],
        longest_step: float,
        most_points: int,
        progress: _Report | None,
    ) -> str: ...
    def curve(
        self,
        special: str,
        parameters: list[int],
        window: list[list[float]],
        longest_step: float,
        progress: _Report | None,
    ) -> str: ...
    def regions(
        self,
        orbit: str,
        parameters: list[int],
        window: list[list[float]],
        cells: int,
        progress: _Report | None,
    ) -> OrbitMap: ...
    def section(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        rule: str,
        span: tuple[float, float],
        progress: _Report | None,
    ) -> list[tuple[float, list[float]]]: ...
    def diagram(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        over: tuple[int, list[float]],
        rule: str,
        span: tuple[float, float],
        progress: _Report | None,
    ) -> list[list[tuple[float, list[tuple[float, list[float]]], str | None]]]: ...
    def exponents(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        span: tuple[float, float],
        progress: _Report | None,
    ) -> tuple[list[float], float, int]: ...
    def basins(
        self,
        parameters: list[float],
        start: tuple[int | None, float | None, list[float] | None],
        components: list[int],
        values: tuple[list[float], list[float]],
        time: float,
        progress: _Report | None,
    ) -> tuple[list[str], list[int]]: ...
    def course(self, orbit: str, parts: int) -> list[tuple[float, list[float]]]: ...

@final
class OrbitMap:
    @staticmethod
    def read(text: str) -> OrbitMap: ...
    def at(self, x: float, y: float) -> list[int] | None: ...
    def regions(
        self,
    ) -> list[tuple[list[int] | None, float, tuple[float, float], list[int]]]: ...
    def boundaries(
        self,
    ) -> list[tuple[str, int | None, str | None, list[list[int]], list[tuple[float, float]]]]: ...
    def svg(self, title: str) -> str: ...
    @property
    def axes(self) -> list[str]: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def objection(self) -> str | None: ...
    @property
    def text(self) -> str: ...

def branch_picture(
    title: str,
    axes: tuple[str, str],
    points: list[tuple[float, float, bool, bool]],
    specials: list[tuple[str, float, float, int]],
) -> str: ...
def run_many(
    system: FormulaSystem,
    parameters: _Floats,
    states: _Floats | None,
    start: tuple[int | None, float | None],
    end: float | None,
    settings: dict[str, Any],
    times: list[float] | None,
    threads: int,
    progress: _Report | None = None,
) -> dict[str, Any]: ...
def homogeneous_mass(radius_m: float, density_kg_per_m3: float) -> float: ...

@final
class BodyPair:
    def __new__(
        cls,
        sphere: _Sphere,
        other: _Sphere | tuple[float, float] | None,
        forces: tuple[str, str],
    ) -> BodyPair: ...
    @property
    def reduction(self) -> tuple[float, float]: ...
    @property
    def tangential_damping(self) -> float: ...
    def pull_off(self, normal_m_per_s: float) -> float: ...
    def contacts(
        self, normal: _Floats, tangential: _Floats
    ) -> tuple[_Floats, _Floats, _Floats, _Floats]: ...
    def impacts(
        self,
        velocities: tuple[_Floats, _Floats],
        engine: _Engine,
        strict: bool,
        threads: int,
        progress: _Report | None,
    ) -> tuple[dict[str, Any], _Floats]: ...
    def encounter(self, motion: _Motion, other: _Motion, engine: _Engine) -> str: ...

@final
class Atlas:
    @staticmethod
    def trace(
        kappa: tuple[float, float],
        psi: tuple[float, float],
        ratio: tuple[tuple[float, float], float, float] | None,
        collisions: tuple[float, _Law],
        accuracy: tuple[float | None, str],
        threads: int,
        progress: _Report | None = None,
    ) -> Atlas: ...
    @staticmethod
    def read(text: str) -> Atlas: ...
    def json(self) -> str: ...
    def geojson(self) -> str: ...
    @property
    def objection(self) -> str | None: ...
    def picture(self) -> str: ...
    def locate(self, kappa: _Floats, psi: _Floats) -> tuple[NDArray[np.int64], _Floats]: ...

_Label: TypeAlias = tuple[str, list[int]]
_MarginFields: TypeAlias = tuple[list[int], int, str, float]
_Window: TypeAlias = tuple[tuple[float, float], tuple[float, float]]
_Calls: TypeAlias = tuple[_Report | None, Callable[[], object] | None]

@final
class HybridFamily:
    def __new__(
        cls,
        system: tuple[list[Any], list[Any], tuple[Any, Any]],
        args: tuple[Any, ...],
        start: tuple[tuple[int, float, _Floats, list[int]], Any, list[Any]],
        end: float,
        settings: dict[str, Any],
        description: tuple[str, list[str], list[str]],
    ) -> HybridFamily: ...
    @staticmethod
    def of_formulas(
        system: FormulaSystem,
        axes: list[int],
        parameters: list[float],
        end: float | None,
        settings: dict[str, Any],
        names: tuple[str, list[str]],
        order: tuple[list[str], list[list[int]]] | None,
    ) -> HybridFamily: ...
    def guards(self) -> list[str]: ...
    def accumulation(self, window: _Window) -> tuple[int, int, int] | None: ...
    def up_to(self, events: int) -> HybridFamily: ...
    def trace(
        self, window: _Window, options: str, threads: int, callbacks: _Calls
    ) -> tuple[FamilyAtlas, BaseException | None]: ...
    def resume(
        self, atlas: FamilyAtlas, threads: int, callbacks: _Calls
    ) -> tuple[FamilyAtlas, BaseException | None]: ...
    def labels(
        self,
        x: _Floats,
        y: _Floats,
        threads: int,
        progress: _Report | None,
    ) -> list[_Label]: ...
    def decide(
        self,
        atlas: FamilyAtlas,
        x: _Floats,
        y: _Floats,
        threads: int,
        progress: _Report | None,
    ) -> list[_Label | None]: ...
    def margins(self, x: float, y: float) -> tuple[_Label, list[_MarginFields]]: ...
    def follow(
        self,
        window: _Window,
        options: str,
        between: _Window,
        monitors: list[Callable[[float, float], float]],
        progress: _Report | None,
    ) -> dict[str, Any] | None: ...

_ChangeFields: TypeAlias = tuple[
    list[float],
    tuple[str, float, float, float] | None,
    bool,
    list[tuple[str, _Label]],
]

def stack_family(
    function: Callable[[float], HybridFamily],
    window: _Window,
    values: list[float],
    options: tuple[str, float, int],
    threads: int,
    callbacks: _Calls,
) -> tuple[
    list[FamilyAtlas], list[_ChangeFields], int, bool, str | None, BaseException | None
]: ...

@final
class FamilyAtlas:
    @staticmethod
    def read(text: str) -> FamilyAtlas: ...
    def json(self) -> str: ...
    @property
    def finished(self) -> bool: ...
    @property
    def objection(self) -> str | None: ...
    @property
    def doubts(self) -> tuple[list[str], list[str]]: ...
    @property
    def sure(self) -> tuple[list[bool], float]: ...
    @property
    def vertex_kinds(self) -> list[str]: ...
    def polyline(self, curve: int) -> _Floats: ...
    def picture(self) -> str: ...
    def locate(self, x: _Floats, y: _Floats) -> tuple[NDArray[np.int64], _Floats]: ...

def atlas_options(effort: str) -> str: ...
def gaining_lines(
    kappa: tuple[float, float],
    psi: tuple[float, float],
    collisions: tuple[float, _Law],
    accuracy: tuple[float | None, str],
    threads: int,
    progress: _Report | None = None,
) -> tuple[str, str | None]: ...
def stack(
    kappa: tuple[float, float],
    psi: tuple[float, float],
    dampings: list[float],
    tolerance: float | None,
    threads: int,
    progress: _Report | None = None,
) -> tuple[str, str, str | None]: ...
@final
class TimeSteps:
    @staticmethod
    def measure(
        parameters: tuple[_Floats, _Floats, _Floats],
        law: _Law,
        steps: tuple[list[float], int],
        scheme: tuple[str, float],
        reduction: tuple[float, float],
        threads: int,
        progress: _Report | None = None,
    ) -> TimeSteps: ...
    def json(self) -> str: ...
    def picture(self) -> str: ...

@final
class Fit:
    @staticmethod
    def make(
        columns: list[tuple[str, _Floats]],
        bodies: BodyPair | None,
        scaled: tuple[_Law, float, tuple[float, float, float]],
        speed: float | None,
        question: tuple[list[str], list[tuple[str, float, float]], float | None, float, bool],
        threads: int,
        progress: _Report | None = None,
    ) -> Fit: ...
    def input(self, bodies: BodyPair, code: str) -> str: ...
    def json(self) -> str: ...
    def picture(self) -> str | None: ...

@final
class RestitutionTable:
    @staticmethod
    def make(
        kappa: tuple[float, float],
        psi: tuple[float, float],
        collisions: tuple[float, tuple[str, float]],
        bound: float,
        regions: bool,
        threads: int,
        progress: _Report | None = None,
    ) -> RestitutionTable: ...
    @staticmethod
    def make_of_velocities(
        pair: BodyPair,
        normal: tuple[float, float],
        tangential: tuple[float, float],
        bound: float,
        regions: bool,
        threads: int,
        progress: _Report | None = None,
    ) -> RestitutionTable: ...
    @staticmethod
    def read(text: str) -> RestitutionTable: ...
    def json(self) -> str: ...
    def c_header(self, prefix: str) -> str: ...
    @property
    def facts(
        self,
    ) -> tuple[tuple[float, float], tuple[float, float], float, tuple[float, float, int]]: ...
    @property
    def scaled(self) -> tuple[float, float] | None: ...
    @property
    def itineraries(self) -> list[str]: ...
    @property
    def size(self) -> tuple[int, int, int]: ...
    def eps_t(self, x: _Floats, y: _Floats, threads: int) -> _Floats: ...
    def eps_n(self, x: _Floats) -> _Floats: ...
    def region(self, x: _Floats, y: _Floats) -> NDArray[np.int64]: ...

def style() -> dict[str, Any]: ...
def asymptote(
    kappa: tuple[float, float],
    psi: list[float],
    threads: int,
    progress: _Report | None = None,
) -> dict[str, Any]: ...
def converge(
    contacts: list[tuple[float, float, float]] | None,
    damping: float,
    threads: int,
    progress: _Report | None = None,
) -> dict[str, Any]: ...
def contact_laws(
    damping: float,
    tangential_damping: float,
    cells: int,
    threads: int,
    progress: _Report | None = None,
) -> dict[str, Any]: ...
def reproduction_parts() -> list[str]: ...
def reproduce(
    part: int, cells: int, threads: int, progress: _Report | None = None
) -> dict[str, Any]: ...
def reproduce_all(
    directory: os.PathLike[str], cells: int, threads: int, progress: _Report | None = None
) -> str | None: ...
def run_hybrid(
    system: tuple[list[Any], list[Any], tuple[Any, Any]],
    args: tuple[Any, ...],
    start: tuple[int, float, _Floats, list[int]],
    end: float,
    settings: dict[str, Any],
    output: tuple[_Floats | None, bool],
    progress: _Report | None = None,
) -> dict[str, Any]: ...
def evaluate_dense(
    segments: tuple[_Floats, _Floats, _Floats], end: tuple[float, _Floats], times: _Floats
) -> _Floats: ...
