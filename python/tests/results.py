"""One result of each public type, for tests that walk over all of them."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

import stickslip
from stickslip import (
    Bodies,
    Guard,
    HybridFamily,
    HybridSystem,
    Itinerary,
    Material,
    Sphere,
    Surface,
)
from stickslip._family_options import TraceOptions, VerifyOptions

LAW = "gran/hertz/history"
BALL = """
parameter height = 1, restitution = 0.5
state x = height, v = 0
x' = v
v' = -1
when x < 0 "floor"
  x := 0
  v := -restitution*v
end = 2.4
"""


def fly(t: float, y: Any) -> Any:
    return [y[1], -9.81]


def floor(t: float, y: Any) -> Any:
    return y[0]


def bounce(t: float, y: Any) -> Any:
    return [0.0, -0.5 * y[1]]


def ball() -> HybridSystem:
    """A ball that bounces."""
    system = HybridSystem()
    system.mode("fly", fly).guard("floor", floor, reset=bounce)
    return system


def fly_in_family(t: float, y: Any, p: float, q: float) -> Any:
    return [y[1], -1.0]


def floor_in_family(t: float, y: Any, p: float, q: float) -> Any:
    return y[0]


def bounce_in_family(t: float, y: Any, p: float, q: float) -> Any:
    return [0.0, -q * y[1]]


def start_in_family(t: float, y: Any, p: float, q: float) -> Any:
    return [p, 0.0]


@cache
def family() -> HybridFamily:
    """Of formulas."""
    return HybridFamily.of(stickslip.system(BALL), "height", "restitution")


@cache
def family_of_functions() -> HybridFamily:
    system = HybridSystem()
    mode = system.mode("fly", fly_in_family)
    mode.guard("floor", floor_in_family, reset=bounce_in_family)
    return HybridFamily(system, (0, 2.4), [1.0, 0.0], start=start_in_family)


def _family_at(end: float) -> HybridFamily:
    return HybridFamily.of(stickslip.system(BALL), "height", "restitution", end=end)


@cache
def bodies() -> Bodies:
    bead = Sphere(0.0015, Material(63e9, 0.24, 2500))
    return Bodies(bead, bead, Surface(0.3, 5e6, 1e-7))


def _gaining_lines() -> stickslip.GainingLines:
    # As `gaining_lines` returns them after many seconds.
    line = stickslip.GainingLine(-1.0, False, np.array([[1.2, 0.93], [1.25, 0.91], [1.3, 0.89]]))
    window = {"kappa": [1.2, 1.3], "psi": [0.85, 1.0], "damping": 0.0}
    return stickslip.GainingLines({"window": window}, (line,), None)


def _fit() -> stickslip.Fit:
    data = {
        "centre_impact_angle_deg": [5.0, 10.0, 20.0, 30.0, 45.0, 60.0],
        "centre_e_t": [0.6069, 0.5735, 0.5669, 0.5848, 0.6571, 0.7735],
    }
    return stickslip.fit(data, free=["mu"], kappa=6.0)



@cache
def relay() -> stickslip.FormulaSystem:
    return stickslip.system(
        "parameter width = 0.5\nstate x = 0\n"
        "mode up\n  x' = 1 - x\n  when x > width \"down\" -> down\n"
        "mode down\n  x' = -1 - x\n  when x < -width \"up\" -> up\nstart in up"
    )


@cache
def table() -> stickslip.FormulaSystem:
    """A ball on a table that shakes."""
    return stickslip.system(
        "parameter a = 0.02, r = 0.7\nstate x = 0.015, v = 0.5, phase = 0.8\n"
        "table = a*sin(phase)\nx' = v\nv' = -1\nphase' = 2*pi\n"
        'when x < table "bounce"\n  x := table\n  v := (1 + r)*table\' - r*v\n'
        'when phase > 2*pi "period"\n  phase := phase - 2*pi'
    )


def _branch() -> stickslip.Branch:
    return table().branch(table().orbit(itinerary=["period", "bounce"]), "a", (0.02, 0.035))


WINDOW: Any = ((0.5, 2.0), (0.5, 0.8))
COARSE, FEW = TraceOptions(cells=8), VerifyOptions(random_points=50, near_points=2)

#: How to make a result of each type that has rows, or that can be drawn, or both.
MADE: dict[str, Callable[[], Any]] = {
    "Atlas": lambda: stickslip.trace((5, 8), (0.8, 1.2)),
    "Attractor": lambda: of("Basins").attractors[0],
    "Basins": lambda: table().basins(("x", "v"), [0.015, 0.02], [0.5], settle=100.0),
    "Bodies": bodies,
    "Boundary": lambda: of("Atlas").boundaries[0],
    "Collision": lambda: stickslip.collide(63, 0.5),
    "Collisions": lambda: stickslip.collide_many(np.geomspace(1, 100, 50), 0.5),
    "Diagram": lambda: table().diagram("a", [0.02, 0.021], "bounce", time=5.0, skip=20.0),
    "Exponents": lambda: table().exponents(time=50.0, skip=20.0),
    "DenseOutput": lambda: of("Solution").sol,
    "Estimate": lambda: of("Collision").estimate(),
    "FamilyAtlas": lambda: stickslip.trace_family(family(), *WINDOW, options=COARSE, verify=FEW),
    "FamilyCurve": lambda: of("FamilyAtlas").curves[0],
    "FamilyLocated": lambda: of("FamilyAtlas").locate(1.0, 0.6),
    "FamilyMargin": lambda: of("FamilyCurve").margin,
    "FamilyRegion": lambda: of("FamilyAtlas").regions[0],
    "FamilyStack": lambda: stickslip.stack_family(
        _family_at, *WINDOW, [2.45, 2.55], options=COARSE, verify=FEW
    ),
    "FamilyChange": lambda: of("FamilyStack").changes[0],
    "FamilyLayer": lambda: of("FamilyStack").layers[0],
    "FamilyVertex": lambda: of("FamilyAtlas").vertices[0],
    "Explorer": lambda: stickslip.explore(),
    "Fit": _fit,
    "Followed": lambda: family().follow(
        *WINDOW, [(0.6, 0.55), (1.9, 0.75)], [lambda p, q: q - 0.65]
    ),
    "FormulaSystem": lambda: stickslip.system(BALL),
    "GainingLine": lambda: of("GainingLines").lines[0],
    "GainingLines": _gaining_lines,
    "Guard": lambda: Guard("floor", to="fly"),
    "HybridFamily": family_of_functions,
    "HybridSystem": ball,
    "Impacts": lambda: stickslip.impact(
        bodies(), speed_m_per_s=2.0, angle_rad=np.linspace(0.1, 1.4, 40)
    ),
    "Itinerary": lambda: Itinerary("fires", ("floor",)),
    "Located": lambda: of("Atlas").locate([5.5, 7.5], [0.9, 1.1]),
    "Material": lambda: Material(63e9, 0.24, 2500),
    "Mode": lambda: ball()["fly"],
    "MonitorZero": lambda: of("Followed").zeros[0],
    "Motion": lambda: stickslip.Motion((0, 0, 0), (0, 0, 1)),
    "Keyword": lambda: stickslip.restitution(0.8, "mfix/HERTZIAN").keywords[0],
    "NamedLaw": lambda: stickslip.laws()[LAW],
    "Restitution": lambda: stickslip.restitution(0.8, LAW),
    "Branch": _branch,
    "Orbit": lambda: relay().orbit(itinerary=["down", "up"]),
    "OrbitSegment": lambda: of("Orbit").segments[0],
    "OrbitRegions": lambda: table().orbit_regions(
        table().orbit(itinerary=["period", "bounce"]),
        ("a", "r"),
        (0.01, 0.03),
        (0.65, 0.75),
        cells=1,
    ),
    "OrbitRegion": lambda: of("OrbitRegions").regions[0],
    "OrbitBoundary": lambda: of("OrbitRegions").boundaries[0],
    "SpecialCurve": lambda: table().curve(
        of("SpecialOrbit"), ("r", "a"), (0.68, 0.72), (0.01, 0.06)
    ),
    "SpecialOrbit": lambda: next(it for it in of("Branch").specials if it.kind == "flip"),
    "Region": lambda: of("Atlas").regions[0],
    "RestitutionTable": lambda: stickslip.table((1, 2), (0.5, 1.5), bound=1e-5, regions=True),
    "Sensitivities": lambda: stickslip.system(BALL).sensitivities("restitution", "v"),
    "Sensitivity": lambda: of("Collision").sensitivity(),
    "Solution": lambda: stickslip.solve(ball(), (0.0, 2.6), [4.905, 0.0], dense_output=True),
    "Sphere": lambda: bodies().sphere,
    "Stack": lambda: stickslip.stack((5, 8), (0.8, 1.2), (0.1, 0.2)),
    "Layer": lambda: of("Stack").layers[0],
    "StepErrors": lambda: of("TimeSteps").eps_t,
    "Study": lambda: stickslip.system(BALL).converge(),
    "Surface": lambda: bodies().surface,
    "Table": lambda: of("Study").tables["convergence_tolerances"],
    "TimeSteps": lambda: stickslip.timestep(3.0, 0.4, 0.3, law=LAW, steps=[20, 100]),
    "TraceOptions": TraceOptions,
    "Unresolved": lambda: stickslip.Unresolved("stalled", np.zeros((1, 2)), (), "it stalled"),
    "VelocityTable": lambda: stickslip.table_of_velocities(
        bodies(), (1, 2), (0.5, 2), bound=1e-4, regions=True
    ),
    "VerifyOptions": VerifyOptions,
    "Vertex": lambda: of("Atlas").vertices[0],
    "Wall": stickslip.Wall,
    "WallMotion": lambda: stickslip.WallMotion((0, 0, 0), (0, 0, 1)),
    "Change": lambda: stickslip.Change((0.1, 0.2), "touch", 0.15, 5.0, 1.0, False, ()),
}


@cache
def of(name: str) -> Any:
    """The result of a type, made once."""
    return MADE[name]()
