"""Impacts of two bodies in SI units."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from stickslip import _laws, _native, _pictures
from stickslip._arrays import numbers
from stickslip._axes import svg
from stickslip._laws import Law
from stickslip._progress import Progress, keeping, reported
from stickslip._tabular import Columns, Tabular
from stickslip._collisions import Collisions, Floats, Method, OnError, _strict, _threads

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Vector: TypeAlias = tuple[float, float, float]
#: A number, or None where it is not given.
Given: TypeAlias = "float | None"
T = TypeVar("T")


@dataclass(frozen=True)
class Material:
    """An elastic material."""

    #: Young's modulus in Pa.
    young_modulus_pa: float
    #: Poisson's ratio.
    poisson_ratio: float
    #: Density in kg/m³, for spheres whose mass is not given.
    density_kg_per_m3: float | None = None


@dataclass(frozen=True)
class Sphere:
    """A sphere. Without a moment of inertia it is homogeneous."""

    #: Radius in m.
    radius_m: float
    material: Material
    #: Mass in kg, where the material has no density.
    mass_kg: float | None = None
    #: Moment of inertia in kg m², with a mass only.
    moment_of_inertia_kg_m2: float | None = None

    def _arguments(self) -> tuple[float, float, float | None, float, float]:
        density = self.material.density_kg_per_m3
        if (self.mass_kg is None) == (density is None):
            given = "both missing" if density is None else "both given"
            raise ValueError(f"mass_kg and density_kg_per_m3 are {given}; expected exactly one")
        if self.mass_kg is None and self.moment_of_inertia_kg_m2 is not None:
            raise ValueError(
                "moment_of_inertia_kg_m2 contradicts a density, which makes the sphere "
                "homogeneous; expected beside mass_kg only"
            )
        mass = self.mass_kg
        if mass is None:
            assert density is not None
            mass = _native.homogeneous_mass(self.radius_m, density)
        return (
            self.radius_m,
            mass,
            self.moment_of_inertia_kg_m2,
            self.material.young_modulus_pa,
            self.material.poisson_ratio,
        )


@dataclass(frozen=True)
class Wall:
    """A plane wall of infinite mass, rigid if it has no material."""

    material: Material | None = None


@dataclass(frozen=True)
class Surface:
    """The constants of a contact law in SI units; `stickslip impact --help` says which law has which.

    The paper's law has the first three.
    """

    #: Coefficient of friction; the static one where it decays.
    friction: float
    #: Stiffness of the tangential spring in kg/s², where it is constant.
    tangential_stiffness_kg_per_s2: Given = None
    #: Damping time A of the normal force in s: 3/2 of the dissipative constant of Brilliantov and
    #: Pöschel with Hertz' force.
    damping_time_s: Given = None
    #: Stiffness of a linear normal force in kg/s².
    normal_stiffness_kg_per_s2: Given = None
    #: Constant of Hertz' force in kg/(s² √m); without it, that of the materials.
    hertz_stiffness_kg_per_s2_m0_5: Given = None
    #: Constant of Mindlin's stiffness in kg/(s² √m); without it, that of the materials.
    mindlin_stiffness_kg_per_s2_m0_5: Given = None
    #: Damping of the normal force in kg/(s mᵉ), with e = 0, 1/2 or 1/4 as the law says.
    damping_coefficient: Given = None
    #: Damping c of the normal force without unit, of Tsuji's law or of a linear one; half of it, or
    #: c over the root of 5, is critical_damping_ratio.
    damping_ratio: Given = None
    #: Ratio of tangential and normal damping; 0 without it.
    tangential_damping_ratio: Given = None
    #: Damping ratio as particle codes define it: the damping over the critical one.
    critical_damping_ratio: Given = None
    #: Ratio k2/k1 of the stiffnesses of a hysteretic normal force, falling and growing.
    unloading_stiffness_ratio: Given = None
    #: What k2/k1 − 1 is in 1/m of the greatest overlap, where the damping is hardening.
    hardening_per_m: Given = None
    #: Least normal velocity in m/s at which the bodies yield, where the damping is yielding.
    yield_velocity_m_per_s: Given = None
    #: Instead, the contact pressure in Pa up to which they are elastic.
    yield_pressure_pa: Given = None
    #: Surface energy of adhesion in J/m², half the work of adhesion, where the law has it.
    surface_energy_j_per_m2: Given = None
    #: Coefficient of normal restitution, instead of a damping.
    e_n: Given = None
    #: Normal velocity in m/s to which e_n belongs, in laws where it depends on the velocity.
    e_n_at_m_per_s: Given = None
    #: Coefficient to which friction decays with the tangential velocity, at most friction.
    dynamic_friction: Given = None
    #: That decay in s/m, which goes with it.
    friction_decay_s_per_m: Given = None

    def _constants(self, law: Law | None) -> str:
        constants = asdict(self)
        damping = (
            "damping_time_s",
            "damping_coefficient",
            "damping_ratio",
            "critical_damping_ratio",
            "e_n",
        )
        if law is None and all(constants[name] is None for name in damping):
            constants["damping_time_s"] = 0.0
        for name, value in constants.items():
            if value is not None and not math.isfinite(value):
                raise ValueError(f"{name} = {value!r} is out of range; expected a finite number")
        return json.dumps(constants)


@dataclass(frozen=True)
class Motion:
    """The motion of a sphere when the bodies touch."""

    #: Position of the centre in m.
    position_m: Vector
    #: Velocity of the centre in m/s.
    velocity_m_per_s: Vector
    #: Angular velocity in rad/s.
    spin_rad_per_s: Vector = (0.0, 0.0, 0.0)

    def _arguments(self) -> tuple[Vector, Vector, Vector]:
        return (self.position_m, self.velocity_m_per_s, self.spin_rad_per_s)


@dataclass(frozen=True)
class WallMotion:
    """Where a wall is, and its motion."""

    #: A point of the wall in m.
    point_m: Vector
    #: A vector at right angles to the wall, towards the sphere; any length but 0.
    normal: Vector
    #: Velocity in m/s.
    velocity_m_per_s: Vector = (0.0, 0.0, 0.0)

    def _arguments(self) -> tuple[Vector, Vector, Vector]:
        return (self.point_m, self.normal, self.velocity_m_per_s)


class Bodies:
    """Two bodies that collide: a sphere, and another one or a wall.

    law: the contact law, a name of `laws` or its terms; the paper's if there is none.
    """

    def __init__(
        self, sphere: Sphere, other: Sphere | Wall, surface: Surface, law: Law | None = None
    ) -> None:
        self.sphere = sphere
        self.other = other
        self.surface = surface
        self.law = law
        second: Any
        if isinstance(other, Sphere):
            second = other._arguments()
        elif other.material is None:
            second = None
        elif other.material.density_kg_per_m3 is not None:
            raise ValueError(
                "density_kg_per_m3 of a wall has no effect, since its mass is infinite; expected "
                "in spheres only"
            )
        else:
            second = (other.material.young_modulus_pa, other.material.poisson_ratio)
        chosen, _ = _laws.arguments(law, 0.0)
        forces = (surface._constants(law), chosen)
        self._pair = _native.BodyPair(sphere._arguments(), second, forces)
        self._motions: tuple[Any, Any] | None = None

    @classmethod
    def read(cls, file: str | os.PathLike[str] | Mapping[str, Any], law: Law | None = None) -> Self:
        """The bodies in a JSON file of the program, or in such an object, and their contact law."""
        fields = file if isinstance(file, Mapping) else json.loads(Path(file).read_text())
        _known("", fields, "$schema", "comment", "spheres", "wall", "surface")
        spheres = [_sphere(f"spheres[{i}]", one) for i, one in enumerate(fields.get("spheres", []))]
        walls = [_wall(fields["wall"])] if "wall" in fields else []
        if (len(spheres), len(walls)) not in ((2, 0), (1, 1)):
            raise ValueError(
                f"spheres has {len(spheres)} entries, and there is {'a' if walls else 'no'} wall; "
                "expected two spheres, or one sphere and a wall"
            )
        first, motion = spheres[0]
        second: Sphere | Wall
        other_motion: Motion | WallMotion | None
        second, other_motion = walls[0] if walls else spheres[1]
        surface = _made("surface", _object("", fields, "surface"), Surface)
        bodies = cls(first, second, surface, law)
        if motion is not None and other_motion is not None:
            bodies._motions = (motion, other_motion)
        return bodies

    @property
    def alpha(self) -> float:
        """Tangential inertia, without unit; 2/7 for homogeneous spheres."""
        return self._pair.reduction[0]

    def contacts(
        self, normal_m_per_s: ArrayLike, tangential_m_per_s: ArrayLike
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """kappa, psi, damping and the unit of time in s for velocities of the surfaces in m/s."""
        given = np.broadcast_arrays(
            numbers("normal_m_per_s", normal_m_per_s),
            numbers("tangential_m_per_s", tangential_m_per_s),
        )
        found = self._pair.contacts(*(np.ascontiguousarray(one).reshape(-1) for one in given))
        kappa, psi, damping, unit = (one.reshape(given[0].shape) for one in found)
        return kappa, psi, damping, unit

    def __reduce__(self) -> tuple[Any, ...]:
        made_from = (self.sphere, self.other, self.surface, self.law)
        return type(self), made_from, {"_motions": self._motions}

    def __repr__(self) -> str:
        law = "" if self.law is None else f",\n  law={self.law!r}"
        return f"Bodies(\n  {self.sphere},\n  {self.other},\n  {self.surface}{law})"

    def encounter(
        self,
        motion: Motion | None = None,
        other: Motion | WallMotion | None = None,
        method: Method = "auto",
        *,
        rtol: float | None = None,
        atol: float | None = None,
    ) -> dict[str, Any]:
        """The impact in three dimensions, as the object that `stickslip impact --format json` prints.

        motion, other: the motions of the two bodies, or those of the file that was read. Velocities
        and spins after the impact, restitution, switches in seconds and energies are in it.
        """
        if motion is None and other is None and self._motions is not None:
            motion, other = self._motions
        if motion is None or other is None:
            raise ValueError("a motion is missing; expected those of both bodies")
        if isinstance(other, Motion) != isinstance(self.other, Sphere):
            raise TypeError("other must be a Motion of a sphere, or a WallMotion of a wall")
        text = self._pair.encounter(motion._arguments(), other._arguments(), (method, rtol, atol))
        found: dict[str, Any] = json.loads(text)
        return found


#: Meanings and units of what impacts have beside their collisions.
_UNITS = {
    "normal_m_per_s": ("normal velocity before", "m/s"),
    "tangential_m_per_s": ("tangential velocity before", "m/s"),
    "normal_after_m_per_s": ("normal velocity after", "m/s"),
    "tangential_after_m_per_s": ("tangential velocity after", "m/s"),
    "contact_time_s": ("duration of the contact", "s"),
    "patch_impact_angle_rad": ("angle of the surfaces' velocity before, from the normal", "rad"),
    "patch_rebound_angle_rad": ("angle of the surfaces' velocity after, from the normal", "rad"),
    "centre_e_t": ("tangential restitution of the centres", "1"),
    "centre_impact_angle_rad": ("angle of the centres' velocity before, from the normal", "rad"),
    "centre_rebound_angle_rad": ("angle of the centres' velocity after, from the normal", "rad"),
    "impulse_ratio": ("tangential impulse over the normal one", "1"),
    "kinetic_before_j": ("kinetic energy before", "J"),
    "kinetic_after_j": ("kinetic energy after", "J"),
    "work_of_wall_j": ("work of the wall", "J"),
    "sliding_j": ("energy lost in slip", "J"),
    "damping_j": ("energy taken by damping", "J"),
    "tangential_damping_j": ("energy taken by the tangential dashpot in stick", "J"),
    "spring_left_j": ("energy left in the spring, or lost to it in stick", "J"),
    "compression_left_j": ("energy left in the compression", "J"),
    "unbalanced_j": ("what is missing in the balance of energy", "J"),
}

#: What an impact has beside its collision, in the order of the compiled module. The velocities and
#: spins of the spheres follow.
_NUMBERS = (
    *("kappa", "psi", "damping", "contact_time_s", "time_unit_s"),
    *list(_UNITS)[list(_UNITS).index("patch_impact_angle_rad") :],
)


class Impacts(Tabular):
    """Arrays of impacts, from `impact`, in the order and shape of the velocities.

    Where an impact has no result, its numbers are NaN, and `failures` says why. Where nothing is
    tangential, eps_t and centre_e_t are NaN, and where bodies stay together by adhesion, all that
    would be afterwards is.
    """

    def __init__(
        self,
        normal_m_per_s: Floats,
        tangential_m_per_s: Floats,
        found: Collisions,
        numbers: Mapping[str, Floats],
        spheres: Floats,
    ) -> None:
        #: The collisions in scaled parameters; psi is 0 where nothing is tangential.
        self.collisions = found
        #: Why impacts have no result, by their index in C order.
        self.failures = found.failures
        #: Velocities of the surfaces before, in m/s.
        self.normal_m_per_s = normal_m_per_s
        self.tangential_m_per_s = tangential_m_per_s
        #: Coefficients of restitution.
        self.eps_n = found.eps_n
        self.eps_t = found.eps_t
        #: Velocities after, in m/s: the normal one of separation, the tangential one in the
        #: direction of the one before.
        self.normal_after_m_per_s: Floats = found.eps_n * normal_m_per_s
        self.tangential_after_m_per_s: Floats = np.where(
            (tangential_m_per_s == 0) & np.isfinite(found.eps_n),
            0.0,
            found.eps_t * tangential_m_per_s,
        )
        #: Duration of the contact in s.
        self.contact_time_s = numbers["contact_time_s"]
        #: The unit of scaled times in s.
        self.time_unit_s = numbers["time_unit_s"]
        #: Number of switches; -1 without a result, as the reversals.
        self.switch_count = found.switch_count
        self.reversals = found.reversals
        #: A character a phase: + and - slip to either side, o stick; empty without a result.
        self.itinerary = found.itinerary
        #: Angles of the velocity of the surfaces and of the centres, from the normal, in rad.
        self.patch_impact_angle_rad = numbers["patch_impact_angle_rad"]
        self.patch_rebound_angle_rad = numbers["patch_rebound_angle_rad"]
        self.centre_impact_angle_rad = numbers["centre_impact_angle_rad"]
        self.centre_rebound_angle_rad = numbers["centre_rebound_angle_rad"]
        #: Tangential restitution of the centres.
        self.centre_e_t = numbers["centre_e_t"]
        #: Tangential impulse over the normal one.
        self.impulse_ratio = numbers["impulse_ratio"]
        #: Energies in J.
        self.kinetic_before_j = numbers["kinetic_before_j"]
        self.kinetic_after_j = numbers["kinetic_after_j"]
        self.work_of_wall_j = numbers["work_of_wall_j"]
        self.sliding_j = numbers["sliding_j"]
        self.damping_j = numbers["damping_j"]
        self.tangential_damping_j = numbers["tangential_damping_j"]
        self.spring_left_j = numbers["spring_left_j"]
        self.compression_left_j = numbers["compression_left_j"]
        self.unbalanced_j = numbers["unbalanced_j"]
        #: Velocities in m/s and spins in rad/s of the spheres after. Their shape is that of the
        #: velocities before, followed by the spheres, two or one, and by x, y and z.
        self.velocity_m_per_s: Floats = spheres[..., :3]
        self.spin_rad_per_s: Floats = spheres[..., 3:]

    _dimension = "impact"

    def _columns(self) -> Columns:
        names = (*_UNITS, "eps_n", "eps_t", "switch_count", "reversals", "itinerary")
        columns: Columns = {name: np.ravel(getattr(self, name)) for name in names}
        for name in ("velocity_m_per_s", "spin_rad_per_s"):
            vectors = getattr(self, name)
            for sphere, axis in np.ndindex(vectors.shape[-2:]):
                columns[f"spheres[{sphere}].{name}[{axis}]"] = np.ravel(vectors[..., sphere, axis])
        return columns

    def _meanings(self) -> dict[str, dict[str, str]]:
        return {name: {"long_name": text, "units": unit} for name, (text, unit) in _UNITS.items()}

    def plot(self, ax: Axes | None = None, **points: Any) -> Axes:
        """Draws both restitutions over the angle of incidence with matplotlib, or over the velocity
        if all angles are the same. The colours of points are the numbers of switches.

        ax: axes to draw in, or None for new ones. points: properties of the points.
        """
        return _pictures.impacts(self, ax, points)

    def _repr_svg_(self) -> str | None:
        return svg(self.plot) if self.collisions.size > 1 else None

    def __repr__(self) -> str:
        return f"Impacts(shape={self.collisions.shape})"


def impact(
    bodies: Bodies | Mapping[str, Any] | str | os.PathLike[str],
    normal_m_per_s: ArrayLike | None = None,
    tangential_m_per_s: ArrayLike | None = None,
    *,
    speed_m_per_s: ArrayLike | None = None,
    angle_rad: ArrayLike | None = None,
    method: Method = "auto",
    rtol: float | None = None,
    atol: float | None = None,
    errors: OnError = "raise",
    threads: int | None = None,
    law: Law | None = None,
    progress: Progress | None = None,
) -> Impacts:
    """Impacts of two bodies for arrays of velocities, which broadcast.

    bodies: two bodies, an object with the layout of docs/impact.schema.json, or the path of such a
    file. normal_m_per_s, tangential_m_per_s: velocities of the surfaces at the contact, above 0,
    and 0 or above. Instead of them speed_m_per_s and angle_rad, the angle between velocity and
    normal, 0 or above and below pi/2. law: the contact law of bodies that are read; `Bodies` have
    their own. The other arguments are those of `collide_many`, and Ctrl-C keeps as much.
    """
    if isinstance(bodies, Bodies) and law is not None:
        raise ValueError(f"law = {law!r} is given for Bodies; expected in Bodies(..., law=...)")
    pair = bodies if isinstance(bodies, Bodies) else Bodies.read(bodies, law)
    if speed_m_per_s is not None and angle_rad is not None:
        if normal_m_per_s is not None or tangential_m_per_s is not None:
            raise ValueError("velocities and a speed with an angle are both given; expected one")
        angle = numbers("angle_rad", angle_rad)
        wrong = ~((angle >= 0) & (angle < np.pi / 2))
        if np.any(wrong):
            first = float(angle[wrong].flat[0])
            raise ValueError(f"angle_rad = {first!r}; expected 0 or above and below pi/2")
        normal_m_per_s = np.multiply(speed_m_per_s, np.cos(angle))
        tangential_m_per_s = np.multiply(speed_m_per_s, np.sin(angle))
    elif speed_m_per_s is not None or angle_rad is not None:
        raise ValueError("expected speed_m_per_s and angle_rad together")
    if normal_m_per_s is None or tangential_m_per_s is None:
        raise ValueError("expected normal_m_per_s and tangential_m_per_s, or a speed and an angle")
    normal, tangential = np.broadcast_arrays(
        numbers("normal_m_per_s", normal_m_per_s),
        numbers("tangential_m_per_s", tangential_m_per_s),
    )
    flat: tuple[Floats, Floats] = (
        np.ascontiguousarray(normal).reshape(-1),
        np.ascontiguousarray(tangential).reshape(-1),
    )
    engine, shape = (method, rtol, atol), normal.shape
    count = _threads(threads)
    chosen = _laws.arguments(pair.law, pair._pair.tangential_damping)
    surface = pair.surface
    terms: dict[str, Any] = {}
    if surface.dynamic_friction is not None and surface.friction > 0 and normal.size:
        alpha, mu = pair._pair.reduction
        decay = (surface.friction_decay_s_per_m or 0.0) * mu / alpha
        decay *= _one_velocity(normal, "dynamic_friction: the scaled decay grows")
        terms["friction"] = {"dynamic": surface.dynamic_friction / mu, "decay": decay}
    if surface.surface_energy_j_per_m2 is not None and normal.size:
        velocity = _one_velocity(normal, "surface_energy_j_per_m2: the scaled pull-off force falls")
        terms["pull_off"] = pair._pair.pull_off(velocity)
    if terms:
        law = {**_laws.terms(pair.law), **terms}
        chosen = _laws.arguments(law, pair._pair.tangential_damping)
    if surface.friction == 0:
        chosen = _laws.arguments({**_laws.without_friction(pair.law), **terms}, 0.0)

    def made(
        found: tuple[dict[str, Any], Floats],
        velocities: tuple[Floats, Floats],
        shape: tuple[int, ...],
    ) -> Impacts:
        columns, rows = found
        count = 2 if isinstance(pair.other, Sphere) else 1
        table = rows.reshape(*shape, len(_NUMBERS) + 6 * count)
        values = {name: table[..., index] for index, name in enumerate(_NUMBERS)}
        spheres = table[..., len(_NUMBERS) :].reshape(*shape, count, 6)
        scaled = (values["kappa"], values["psi"], values["damping"])
        collisions = Collisions(scaled, (*engine, *chosen), columns, shape)
        before, across = velocities
        return Impacts(before, across, collisions, values, spheres)

    def done(found: tuple[dict[str, Any], Floats]) -> Impacts:
        count = found[0]["eps_t"].size
        return made(found, (flat[0][:count], flat[1][:count]), (count,))

    with keeping(done), reported(progress, "impact") as report:
        found = pair._pair.impacts(flat, engine, _strict(errors), count, report)
    return made(found, (normal, tangential), shape)


def _one_velocity(normal: Floats, what: str) -> float:
    """The normal velocity of all impacts, on which a term of the law depends."""
    if np.ptp(normal) != 0.0:
        raise ValueError(
            f"{what} with the normal velocity, and a call has one law; expected one normal "
            "velocity a call"
        )
    return float(normal.flat[0])


def _known(place: str, fields: Any, *names: str) -> None:
    if not isinstance(fields, Mapping):
        raise ValueError(f"{place or 'the file'} is {fields!r}; expected an object")
    for name in fields:
        if name not in names:
            expected = ", ".join(name for name in names if name != "comment")
            raise ValueError(
                f"{place}{'.' if place else ''}{name} is not known; expected {expected}"
            )


def _object(place: str, fields: Mapping[str, Any], name: str) -> Any:
    if name not in fields:
        raise ValueError(f"{place}{'.' if place else ''}{name} is missing; expected an object")
    return fields[name]


def _made(place: str, fields: Any, make: type[T]) -> T:
    """The dataclass whose fields the object has."""
    _known(place, fields, "comment", *make.__annotations__)
    given = {name: value for name, value in fields.items() if name != "comment"}
    for name, value in given.items():
        vector = isinstance(value, list) and len(value) == 3
        for number in value if vector else [value]:
            if isinstance(number, bool) or not isinstance(number, int | float | Material):
                raise ValueError(f"{place}.{name} is {value!r}; expected numbers")
    try:
        return make(**given)
    except TypeError as error:
        raise ValueError(f"{place}: {error}") from None


def _sphere(place: str, fields: Any) -> tuple[Sphere, Motion | None]:
    _known(place, fields, "comment", "radius_m", "mass_kg", "moment_of_inertia_kg_m2",
           "material", "motion")  # fmt: skip
    material = _made(f"{place}.material", _object(place, fields, "material"), Material)
    own = {name: value for name, value in fields.items() if name != "motion"}
    motion = _made(f"{place}.motion", fields["motion"], Motion) if "motion" in fields else None
    return _made(place, own | {"material": material}, Sphere), motion


def _wall(fields: Any) -> tuple[Wall, WallMotion | None]:
    _known("wall", fields, "comment", "rigid", "material", "motion")
    if bool(fields.get("rigid")) == ("material" in fields):
        given = "both given" if "material" in fields else "both missing"
        raise ValueError(f"wall.material and wall.rigid are {given}; expected exactly one of them")
    material = None
    if "material" in fields:
        material = _made("wall.material", fields["material"], Material)
    motion = _made("wall.motion", fields["motion"], WallMotion) if "motion" in fields else None
    return Wall(material), motion
