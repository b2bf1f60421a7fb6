"""Collisions of frictional spheres and other piecewise-smooth ODEs, with every switch found.

Start with `collide` (one collision), `eps_t` and `collide_many` (arrays), `impact` (SI units),
`trace` (every boundary in a window), `gaining_lines` (where a law creates energy), `stack`
(regions over the damping), `map` and `sweep` (xarray), `timestep` (errors of the steps of particle
codes), `fit` (contact laws to measured impacts), `table` (restitution to be looked up), `solve`
(systems of your own), `trace_family` (where their events change over two parameters),
`stack_family` (and how that changes with a third one), `explore` (a page that computes all that).
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    __version__: str
    from stickslip._compiled import Compiled
    from stickslip._derivatives import Sensitivities
    from stickslip._explorer import Explorer, explore
    from stickslip._laws import Keyword, NamedLaw, Restitution, laws, restitution
    from stickslip._native import ComputationError
    from stickslip._attractors import Attractor, Basins, Diagram, Exponents
    from stickslip._orbit_regions import (
        OrbitBoundary,
        OrbitRegion,
        OrbitRegions,
        read_orbit_regions,
    )
    from stickslip._orbits import Branch, Orbit, OrbitSegment, SpecialCurve, SpecialOrbit
    from stickslip._solutions import DenseOutput, Solution
    from stickslip._systems import Guard, HybridSystem, Mode
    from stickslip._atlases import Atlas, AtlasWarning, Boundary, Located, Region, Vertex, trace
    from stickslip._collisions import (
        Collision,
        Collisions,
        Estimate,
        Sensitivity,
        collide,
        collide_many,
        eps_t,
        eps_t_and_switch_count,
        psi_of_ratio,
    )
    from stickslip._families import (
        FamilyAtlas,
        FamilyCurve,
        FamilyLocated,
        FamilyMargin,
        FamilyRegion,
        FamilyVertex,
        Followed,
        HybridFamily,
        Itinerary,
        MonitorZero,
        TraceInterrupted,
        TraceOptions,
        Unresolved,
        VerifyOptions,
        trace_family,
    )
    from stickslip._family_stacks import (
        FamilyChange,
        FamilyLayer,
        FamilyStack,
        StackInterrupted,
        stack_family,
    )
    from stickslip._fits import Fit, fit
    from stickslip._recorded import recorded
    from stickslip._sympy import from_sympy
    from stickslip._formulas import FormulaSystem, read, system
    from stickslip._gaining import GainingLine, GainingLines, gaining_lines
    from stickslip._hybrid import SampledGuardsWarning, solve
    from stickslip._impacts import (
        Bodies,
        Impacts,
        Material,
        Motion,
        Sphere,
        Surface,
        Wall,
        WallMotion,
        impact,
    )
    from stickslip._many import solve_many
    from stickslip._maps import map
    from stickslip._stacks import Change, Layer, Stack, stack
    from stickslip._studies import (
        Study,
        Table,
        asymptote,
        contact_laws,
        converge,
        reproduce,
        reproduction_parts,
    )
    from stickslip._sweeps import sweep, write_sweep
    from stickslip._tables import (
        RestitutionTable,
        VelocityTable,
        load_table,
        table,
        table_of_velocities,
    )
    from stickslip._timesteps import StepErrors, TimeSteps, timestep

__all__ = [
    "Atlas",
    "AtlasWarning",
    "Attractor",
    "Basins",
    "Bodies",
    "Boundary",
    "Branch",
    "Change",
    "Collision",
    "Collisions",
    "Compiled",
    "ComputationError",
    "DenseOutput",
    "Diagram",
    "Estimate",
    "Explorer",
    "Exponents",
    "FamilyAtlas",
    "FamilyChange",
    "FamilyCurve",
    "FamilyLayer",
    "FamilyLocated",
    "FamilyMargin",
    "FamilyRegion",
    "FamilyStack",
    "FamilyVertex",
    "Fit",
    "Followed",
    "FormulaSystem",
    "GainingLine",
    "GainingLines",
    "Guard",
    "HybridFamily",
    "HybridSystem",
    "Impacts",
    "Itinerary",
    "Keyword",
    "Layer",
    "Located",
    "Material",
    "Mode",
    "MonitorZero",
    "Motion",
    "NamedLaw",
    "Orbit",
    "OrbitBoundary",
    "OrbitRegion",
    "OrbitRegions",
    "OrbitSegment",
    "Region",
    "Restitution",
    "RestitutionTable",
    "SampledGuardsWarning",
    "Sensitivities",
    "Sensitivity",
    "Solution",
    "SpecialCurve",
    "SpecialOrbit",
    "Sphere",
    "Stack",
    "StackInterrupted",
    "StepErrors",
    "Study",
    "Surface",
    "Table",
    "TimeSteps",
    "TraceInterrupted",
    "TraceOptions",
    "Unresolved",
    "VelocityTable",
    "VerifyOptions",
    "Vertex",
    "Wall",
    "WallMotion",
    "asymptote",
    "collide",
    "collide_many",
    "contact_laws",
    "converge",
    "eps_t",
    "eps_t_and_switch_count",
    "explore",
    "fit",
    "from_sympy",
    "gaining_lines",
    "impact",
    "laws",
    "load_table",
    "map",
    "psi_of_ratio",
    "read",
    "read_orbit_regions",
    "recorded",
    "reproduce",
    "reproduction_parts",
    "restitution",
    "solve",
    "solve_many",
    "stack",
    "stack_family",
    "sweep",
    "system",
    "table",
    "table_of_velocities",
    "timestep",
    "trace",
    "trace_family",
    "write_sweep",
]

#: The modules that have the public names; one is imported when a name of it is first used.
_MODULES = {
    "_compiled": "Compiled",
    "_derivatives": "Sensitivities",
    "_explorer": "Explorer explore",
    "_laws": "Keyword NamedLaw Restitution laws restitution",
    "_native": "ComputationError",
    "_attractors": "Attractor Basins Diagram Exponents",
    "_orbit_regions": "OrbitBoundary OrbitRegion OrbitRegions read_orbit_regions",
    "_orbits": "Branch Orbit OrbitSegment SpecialCurve SpecialOrbit",
    "_solutions": "DenseOutput Solution",
    "_systems": "Guard HybridSystem Mode",
    "_atlases": "Atlas AtlasWarning Boundary Located Region Vertex trace",
    "_collisions": (
        "Collision Collisions Estimate Sensitivity collide collide_many eps_t "
        "eps_t_and_switch_count psi_of_ratio"
    ),
    "_families": (
        "FamilyAtlas FamilyCurve FamilyLocated FamilyMargin FamilyRegion FamilyVertex Followed "
        "HybridFamily Itinerary MonitorZero TraceInterrupted TraceOptions Unresolved "
        "VerifyOptions trace_family"
    ),
    "_family_stacks": "FamilyChange FamilyLayer FamilyStack StackInterrupted stack_family",
    "_fits": "Fit fit",
    "_recorded": "recorded",
    "_sympy": "from_sympy",
    "_formulas": "FormulaSystem read system",
    "_gaining": "GainingLine GainingLines gaining_lines",
    "_hybrid": "SampledGuardsWarning solve",
    "_impacts": "Bodies Impacts Material Motion Sphere Surface Wall WallMotion impact",
    "_many": "solve_many",
    "_maps": "map",
    "_stacks": "Change Layer Stack stack",
    "style": "",
    "_studies": "Study Table asymptote contact_laws converge reproduce reproduction_parts",
    "_sweeps": "sweep write_sweep",
    "_tables": "RestitutionTable VelocityTable load_table table table_of_velocities",
    "_timesteps": "StepErrors TimeSteps timestep",
}
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        found: Any = importlib.import_module("stickslip._native").version()
    elif name in _MODULE_OF:
        found = getattr(importlib.import_module(f"stickslip.{_MODULE_OF[name]}"), name)
    elif name in _MODULES:
        return importlib.import_module(f"stickslip.{name}")
    else:
        raise AttributeError(f"module 'stickslip' has no attribute {name!r}")
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
