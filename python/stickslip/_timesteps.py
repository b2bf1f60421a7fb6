"""Errors of the time steps of particle codes."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip import _laws, _native, _pictures
from stickslip._kept import Kept
from stickslip._laws import Law
from stickslip._shown import Shown
from stickslip._tabular import Columns, Tabular
from stickslip._progress import Progress, reported
from stickslip._collisions import _broadcast, _threads

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Quantity: TypeAlias = Literal["eps_t", "eps_n", "energy"]


@dataclass(frozen=True, repr=False)
class StepErrors(Shown):
    """Absolute errors of one quantity over impacts and start phases, a value for each step.

    Where contacts do not end there are no errors, but NaN and -1.
    """

    median: NDArray[np.float64]
    root_mean_square: NDArray[np.float64]
    worst: NDArray[np.float64]
    #: The index of the impact with the largest error, in the flat arrays of parameters.
    worst_contact: NDArray[np.int64]
    #: The part of a step after which that contact begins.
    worst_phase: NDArray[np.float64]


class TimeSteps(Tabular):
    """Errors of time steps against collisions without steps, from the longest step to the shortest."""

    def __init__(self, native: _native.TimeSteps | Kept) -> None:
        self._native = native
        #: All numbers, as the program prints them.
        self.data: dict[str, Any] = json.loads(native.json())
        rows = self.data["rows"]
        #: Numbers t_c/dt of steps in the undamped contact time.
        self.steps_per_contact: NDArray[np.float64] = _column(rows, "steps_per_contact")
        #: "ok"; "unstable", where a spring is not resolved; "unfinished", where contacts do not end.
        self.status: list[str] = [row["status"] for row in rows]
        #: The largest (k dt^2 + 2 D dt)/4 of both springs, which are resolved below 1.
        self.stiffness: NDArray[np.float64] = _column(rows, "stiffness")
        self.eps_t: StepErrors = _errors(rows, "eps_t")
        self.eps_n: StepErrors = _errors(rows, "eps_n")
        #: Of the kinetic energy after the contact, as a part of that before.
        self.energy: StepErrors = _errors(rows, "energy")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (Kept(self._native.json(), self.picture()),)

    def largest_step(self, wanted: float, quantity: Quantity = "eps_t") -> float | None:
        """The largest dt/t_c at which all errors are at most wanted, as at all shorter steps here.

        None if that does not hold at the shortest step. Nothing is promised of other steps.
        """
        if quantity not in get_args(Quantity):
            raise ValueError(f"quantity = {quantity!r}; expected one of {get_args(Quantity)}")
        worst = getattr(self, quantity).worst
        largest = None
        for status, error, steps in zip(
            reversed(self.status), worst[::-1], self.steps_per_contact[::-1], strict=True
        ):
            if status != "ok" or not error <= wanted:
                break
            largest = 1.0 / float(steps)
        return largest

    _dimension = "step"

    def _columns(self) -> Columns:
        columns: Columns = {
            "steps_per_contact": self.steps_per_contact,
            "status": np.array(self.status),
            "stiffness": self.stiffness,
        }
        for quantity in get_args(Quantity):
            errors = getattr(self, quantity)
            names = [one.name for one in fields(errors)]
            columns |= {f"{quantity}_{name}": getattr(errors, name) for name in names}
        return columns

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the median and the largest errors over dt/t_c with matplotlib.

        ax: axes to draw in, or None for new ones. line: properties of all lines.
        """
        return _pictures.time_steps(self, ax, line)

    def picture(self) -> str:
        """The median and the largest errors over dt/t_c as an SVG document."""
        return str(self._native.picture())

    def _repr_html_(self) -> str:
        return self.picture()

    def _repr_svg_(self) -> str:
        return self.picture()

    def __repr__(self) -> str:
        impacts, steps = len(self.data["contacts"]), len(self.status)
        return f"<TimeSteps: {impacts} impacts, {steps} steps, scheme {self.data['scheme']}>"


def timestep(
    kappa: ArrayLike,
    psi: ArrayLike,
    damping: ArrayLike = 0.0,
    *,
    law: Law | None = None,
    tangential_damping: float = 0.0,
    steps: Iterable[float] = (10, 20, 50, 100, 200, 500, 1000),
    phases: int = 16,
    scheme: str = "lammps",
    overlap: float = 0.0,
    mu: float = 0.4,
    alpha: float = 2 / 7,
    threads: int | None = None,
    progress: Progress | None = None,
) -> TimeSteps:
    """Errors of eps_t, eps_n and the energy in the time steps of a particle code.

    kappa, psi, damping: impacts as in `collide_many`; arrays broadcast. law, tangential_damping: as
    in `collide`. steps: numbers t_c/dt of steps in the undamped contact time t_c, 1 to 1e7. phases:
    number of parts of a step after which a contact begins, 1 to 4096. scheme: "lammps", or
    "elapsed", in which the history advances in the first step by the time since the contact began,
    or "synchronized_verlet", in which velocities are taken along the normal in the middle of a step.
    overlap: greatest overlap over the distance of the centres, 0 to 0.5, with which the normal of
    two equal spheres without spins turns during the contact; what that changes is in the errors.
    mu, alpha: weigh the tangential energy, and how much spheres turn. threads: 1 to 1024, or None for one for
    each core; results do not depend on it. progress: called now and then with the steps done and all
    that are known; True shows a bar on stderr.

    Raises ValueError for parameters out of range, and ComputationError where an impact has no result
    without steps.

    >>> found = timestep(3.0, 0.4, 0.3, law="gran/hertz/history", steps=[20, 100])
    >>> found.largest_step(0.01)
    0.01
    >>> found.status
    ['ok', 'ok']
    """
    _, flat, _ = _broadcast(kappa, psi, damping)
    chosen = _laws.arguments(law, tangential_damping)
    counts = ([float(one) for one in steps], phases)
    weights = (float(mu), float(alpha))
    with reported(progress, "timestep") as report:
        native = _native.TimeSteps.measure(
            flat, chosen, counts, (scheme, float(overlap)), weights, _threads(threads), report
        )
    return TimeSteps(native)


def _column(rows: list[dict[str, Any]], name: str) -> NDArray[np.float64]:
    return np.array([row[name] for row in rows], dtype=float)


def _errors(rows: list[dict[str, Any]], name: str) -> StepErrors:
    nothing = {"error": np.nan, "contact": -1, "phase": np.nan}
    found = [
        row[name] or {"median": np.nan, "root_mean_square": np.nan, "worst": nothing}
        for row in rows
    ]
    worst = [one["worst"] for one in found]
    return StepErrors(
        median=_column(found, "median"),
        root_mean_square=_column(found, "root_mean_square"),
        worst=_column(worst, "error"),
        worst_contact=np.array([one["contact"] for one in worst], dtype=np.int64),
        worst_phase=_column(worst, "phase"),
    )
