"""Derivatives of runs, as the native module finds them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip._progress import Progress, reporting
from stickslip._shown import Shown, html_table
from stickslip._tabular import Columns, Tabular, flat

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._formulas import FormulaSystem

#: The values of parameters; mode, time and state at the start; the end; and settings.
Rerun = tuple[list[float], tuple[int | None, float | None, list[float] | None], float | None, Any]


@dataclass(frozen=True, repr=False)
class Sensitivities(Tabular, Shown):
    """Derivatives of the events of a run, and of its end, with respect to parameters and initial
    values. They hold as long as the order of events stays, and grow without bound towards a graze.
    """

    #: What the run is differentiated by: names of parameters, and of components at the start.
    by: tuple[str, ...]
    #: The names of the events, and "" for the end of a run that no event ended; shape (k,).
    event: NDArray[np.str_]
    #: Their times, shape (k,), and the derivatives of these, shape (k, by).
    t: NDArray[np.float64]
    t_by: NDArray[np.float64]
    #: The states before them, shape (k, n), and the derivatives at places that move along, shape
    #: (k, by, n).
    y: NDArray[np.float64]
    y_by: NDArray[np.float64]
    #: As `Solution.outcome`.
    outcome: str

    _dimension = "event"

    def _columns(self) -> Columns:
        columns: Columns = {"event": self.event, "t": self.t}
        columns |= {f"t_by_{name}": self.t_by[:, place] for place, name in enumerate(self.by)}
        columns |= flat("y", self.y)
        for place, name in enumerate(self.by):
            columns |= flat(f"y_by_{name}", self.y_by[:, place])
        return columns

    def _repr_html_(self) -> str:
        return html_table(self._columns(), "Derivatives of the events")

    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draws the derivatives of the times of the events with matplotlib.

        ax: axes to draw in, or None for new ones. line: properties of all lines.
        """
        from stickslip import _solution_pictures

        return _solution_pictures.sensitivities(self, ax, line)


def sensitivities_of(
    system: FormulaSystem, by: tuple[str, ...], rerun: Rerun, progress: Progress | None
) -> Sensitivities:
    """The derivatives of a run of a system."""
    parameters, components = list(system.parameters), system.components
    places = []
    for name in by:
        if name in parameters:
            places.append((False, parameters.index(name)))
        elif name in components:
            places.append((True, components.index(name)))
        else:
            known = ", ".join([*parameters, *components])
            raise ValueError(f"{name!r} is no parameter and no component; expected some of {known}")
    run = partial(system._native.sensitivities, places, *rerun)
    found = reporting(progress, "sensitivities", run)
    labels = [rules for _, rules in system._native.modes()]
    count, n = found["t"].size, len(components)
    events = [labels[mode][rule] for mode, rule in found["rules"]]
    return Sensitivities(
        by=by,
        event=np.array(events + [""] * (count - len(events)), dtype=str),
        t=found["t"],
        t_by=found["t_by"].reshape(count, len(by)),
        y=found["y"].reshape(count, n),
        y_by=found["y_by"].reshape(count, len(by), n),
        outcome=found["outcome"],
    )
