"""Pictures of collisions, impacts, fits, tables and time steps, in axes of matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip._axes import DASHES, MARKERS, Panels, cells, legend, one, panels, scale
from stickslip.style import COLOURS, INK, PHASES, RULE, diverging, growing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stickslip._collisions import Collision, Collisions
    from stickslip._fits import Fit
    from stickslip._gaining import GainingLines
    from stickslip._impacts import Impacts
    from stickslip._tables import RestitutionTable, VelocityTable
    from stickslip._timesteps import TimeSteps

#: Phases by their characters in an itinerary.
_PHASES = {"+": "slip +", "o": "stick", "-": "slip −"}
_EPS_T = "tangential restitution $\\varepsilon_t$"
_SWITCHES = "number of switches"
_AXES = {
    "kappa": "scaled stiffness $\\kappa$",
    "psi": "impact ratio $\\psi$",
    "damping": "scaled damping",
    "normal_m_per_s": "normal velocity in m/s",
    "tangential_m_per_s": "tangential velocity in m/s",
}


def collision(found: Collision, ax: Panels, line: dict[str, Any]) -> list[Axes]:
    """Forces and velocities in time, with shaded phases."""
    forces, velocities = drawn = panels(ax, 2)
    course = found.history()
    time = course["time"]
    for each in dict.fromkeys(drawn):
        _shade(found, each)
        each.axhline(0.0, color=RULE, linewidth=0.6)
    limit: dict[str, Any] = {"color": RULE, "linestyle": "--", "linewidth": 1.0}
    # With one coefficient and without adhesion.
    usual = np.allclose(course["limit"], np.abs(course["normal_force"]), atol=1e-12)
    name = "friction limit $\\pm F_n$" if usual else "friction limit"
    forces.plot(time, course["limit"], label=name, **limit)
    forces.plot(time, -course["limit"], **limit)
    rows: list[tuple[Any, str, str, Any]] = [
        (forces, "tangential_force", "tangential force $F_t/\\mu$", {"color": COLOURS[0]}),
        (velocities, "velocity", "tangential velocity $w$", {"color": COLOURS[1]}),
        (velocities, "normal_velocity", "normal velocity $\\dot x$",
         {"color": COLOURS[2], "linestyle": "-."}),
    ]  # fmt: skip
    for each, name, label, style in rows:
        each.plot(time, course[name], label=label, **(style | line))
    if forces is velocities:
        forces.set_ylabel("scaled force, scaled velocity")
    else:
        forces.set_ylabel("scaled force")
        velocities.set_ylabel("scaled velocity")
    for each in dict.fromkeys(drawn):
        each.set_xlim(0.0, found.contact_time)
        legend(each)
    velocities.set_xlabel("scaled time $t$")
    return drawn


def _shade(found: Collision, ax: Axes) -> None:
    ends = np.concatenate([[0.0], found.switches["time"], [found.contact_time]])
    kinds = np.array(list(found.itinerary))
    # Edges tell white phases from the ground in the legend, and mark the switches.
    edge: dict[str, Any] = {"edgecolor": RULE, "linewidth": 0.4}
    for kind, name in _PHASES.items():
        (places,) = np.nonzero(kinds == kind)
        spans = list(zip(ends[places], np.diff(ends)[places], strict=True))
        if spans:
            whole = ax.get_xaxis_transform()
            style: dict[str, Any] = {"facecolor": PHASES[kind], "zorder": 0, "label": name} | edge
            ax.broken_barh(spans, (0, 1), transform=whole, **style)


def collisions(found: Collisions, ax: Axes | None, options: dict[str, Any]) -> Axes:
    """The restitution over the parameter that varies, or as colours over two of them."""
    given = {name: getattr(found, name) for name in ("kappa", "psi", "damping")}
    varying = [name for name, values in given.items() if np.unique(values).size > 1]
    if len(varying) > 2:
        raise ValueError("kappa, psi and damping vary; expected one or two that do")
    if len(varying) < 2:
        name = (varying or ["kappa"])[0]
        count = found.switch_count
        ax = counted(one(ax), given[name].ravel(), found.eps_t.ravel(), count.ravel(), options)
        ax.set(xlabel=_AXES[name], ylabel=_EPS_T, xscale=scale(given[name]))
        return ax
    ax = one(ax)
    x, y = (given[name] for name in varying)
    style = _around_zero(found.eps_t) | options
    if found.eps_t.ndim == 2 and min(found.eps_t.shape) > 1 and _is_grid(x, y):
        drawn: Any = ax.pcolormesh(x, y, found.eps_t, shading="nearest", rasterized=True, **style)
    else:
        drawn = ax.scatter(x.ravel(), y.ravel(), c=found.eps_t.ravel(), s=12, **style)
    ax.figure.colorbar(drawn, ax=ax, label=_EPS_T)
    ax.set(xlabel=_AXES[varying[0]], ylabel=_AXES[varying[1]], xscale=scale(x), yscale=scale(y))
    return ax


def _is_grid(x: NDArray[Any], y: NDArray[Any]) -> bool:
    """Whether one varies along the one axis only, and the other along the other one."""
    ways = ((x, y), (x.T, y.T))
    return any(bool((a == a[:1]).all() and (b == b[:, :1]).all()) for a, b in ways)


def _around_zero(values: NDArray[Any]) -> dict[str, Any]:
    """Colours of a quantity, the same for both signs."""
    finite = values[np.isfinite(values)]
    largest = max(np.abs(finite).max(initial=0.0), 1e-300)
    return {"cmap": diverging(), "vmin": -largest, "vmax": largest}


def counted(
    ax: Axes,
    x: NDArray[Any],
    y: NDArray[Any],
    count: NDArray[Any],
    options: dict[str, Any],
    label: str | None = None,
) -> Axes:
    """Points with the colours of numbers of switches, and a line if they are in order."""
    from matplotlib.ticker import MaxNLocator

    steps = np.diff(x)
    if x.size > 1 and ((steps >= 0).all() or (steps <= 0).all()):
        ax.plot(x, y, color=RULE, linewidth=0.8, zorder=1)
    style: dict[str, Any] = {
        "cmap": growing(), "s": 16, "zorder": 2, "label": label,
        "edgecolors": INK, "linewidths": 0.3,
    }  # fmt: skip
    drawn = ax.scatter(x, y, c=count, **(style | options))
    ax.axhline(0.0, color=RULE, linewidth=0.6)
    ax.figure.colorbar(drawn, ax=ax, label=_SWITCHES, ticks=MaxNLocator(6, integer=True))
    return ax


def impacts(found: Impacts, ax: Axes | None, options: dict[str, Any]) -> Axes:
    """Both restitutions over the angle of incidence, or over the velocity if all angles agree."""
    normal, tangential = found.normal_m_per_s.ravel(), found.tangential_m_per_s.ravel()
    angle = np.degrees(np.arctan2(tangential, normal))
    if angle.size > 1 and np.ptp(angle) < 1e-9:
        x, label, way = normal, _AXES["normal_m_per_s"], scale(normal)
    else:
        x, label, way = angle, "angle of incidence in degrees", "linear"
    order = np.argsort(x, kind="stable")
    ax = one(ax)
    ax.plot(x[order], found.eps_n.ravel()[order], color=COLOURS[0], linestyle="--",
            label="normal $\\varepsilon_n$")  # fmt: skip
    eps_t, count = found.eps_t.ravel()[order], found.switch_count.ravel()[order]
    counted(ax, x[order], eps_t, count, options, "tangential $\\varepsilon_t$")
    ax.set(xlabel=label, ylabel="coefficient of restitution", xscale=way)
    legend(ax)
    return ax


def table(
    found: RestitutionTable | VelocityTable,
    x: tuple[str, tuple[float, float]],
    y: tuple[str, tuple[float, float]],
    ax: Axes | None,
    options: dict[str, Any],
) -> Axes:
    """The restitution as colours over both axes of a table, with the boundaries of its regions."""
    ax = one(ax)
    across, up = (cells(*ends) for _, ends in (x, y))
    eps_t = found.eps_t(across, up[:, None], threads=None)
    style = _around_zero(eps_t) | options
    drawn = ax.pcolormesh(across, up, eps_t, shading="nearest", rasterized=True, **style)
    ax.figure.colorbar(drawn, ax=ax, label=_EPS_T)
    if len(found.itineraries) > 1:
        regions = found.region(across, up[:, None])
        for number in range(len(found.itineraries)):
            ax.contour(across, up, regions == number, [0.5], colors=INK, linewidths=0.6)
    ax.set(xlabel=_AXES[x[0]], ylabel=_AXES[y[0]], xscale=scale(across), yscale=scale(up))
    return ax


def gaining(found: GainingLines, ax: Axes | None, line: dict[str, Any]) -> Axes:
    """The lines, with ticks on the side where energy is gained."""
    from matplotlib.patheffects import withTickedStroke

    ax = one(ax)
    for each in found.lines:
        side = 90 if each.gains_left else -90
        place = 0 if each.eps_t > 0 else 1
        value = f"$\\varepsilon_t = {each.eps_t:g}$"
        style: dict[str, Any] = {
            "color": COLOURS[place],
            "linestyle": "-",
            "label": f"{value}, energy is gained on the side of the ticks",
            "path_effects": [withTickedStroke(angle=side, length=0.6)],
        }
        ax.plot(each.points[:, 0], each.points[:, 1], **(style | line))
    window = found.document["window"]
    ax.set(xlim=window["kappa"], ylim=window["psi"], xscale=scale(window["kappa"]))
    ax.set(xlabel=_AXES["kappa"], ylabel=_AXES["psi"])
    legend(ax, ncols=1)
    return ax


def time_steps(found: TimeSteps, ax: Axes | None, line: dict[str, Any]) -> Axes:
    """The median and the largest errors over the step."""
    ax = one(ax)
    step = 1.0 / found.steps_per_contact
    names = {"eps_t": "$\\varepsilon_t$", "eps_n": "$\\varepsilon_n$", "energy": "energy"}
    for place, (name, label) in enumerate(names.items()):
        errors = getattr(found, name)
        style: dict[str, Any] = {"color": COLOURS[place], "marker": MARKERS[place], "markersize": 4}
        for values, dash, what in (
            (errors.worst, "-", f"{label}, largest"),
            (errors.median, "--", f"{label}, median"),
        ):
            ax.plot(step, values, label=what, **({"linestyle": dash} | style | line))
    ax.set(xscale="log", yscale="log")
    ax.set(xlabel="time step $\\Delta t/t_c$", ylabel="absolute error")
    legend(ax)
    return ax


def fit(found: Fit, ax: Panels, options: dict[str, Any]) -> list[Axes]:
    """Data and fit over the angle of incidence, a panel for each quantity."""
    rows = found.data["residuals"]
    quantities = list(dict.fromkeys(row["quantity"] for row in rows))
    drawn = panels(ax, len(quantities))
    course = found.data.get("course") or {"boundaries": []}
    for place, (each, quantity) in enumerate(zip(drawn, quantities, strict=True)):
        these = [row for row in rows if row["quantity"] == quantity]
        normal, tangential, value, fitted, error = (
            np.array([row[name] for row in these], dtype=float)
            for name in ("normal_m_per_s", "tangential_m_per_s", "value", "predicted", "error")
        )
        angle = np.degrees(np.arctan2(tangential, normal))
        order = np.argsort(angle, kind="stable")
        colour = COLOURS[place % len(COLOURS)] if len(set(drawn)) == 1 else COLOURS[0]
        style: dict[str, Any] = {"color": colour, "marker": "o", "linestyle": "none"}
        bars = None if np.isnan(error).all() else error[order]
        each.errorbar(
            angle[order], value[order], bars, label=f"{quantity}, measured", **(style | options)
        )
        each.plot(angle[order], fitted[order], color=colour, marker=".", linestyle=DASHES[1],
                  label=f"{quantity}, fitted")  # fmt: skip
    for each in dict.fromkeys(drawn):
        for number, boundary in enumerate(course["boundaries"]):
            label = None if number else "the switches change"
            where = np.degrees(boundary["angle_rad"])
            each.axvline(where, color=RULE, linewidth=0.8, linestyle=":", label=label)
        alone = len(quantities) == 1 or len(set(drawn)) > 1
        each.set_ylabel(quantities[drawn.index(each)] if alone else "value")
        legend(each)
    drawn[-1].set_xlabel("angle of incidence in degrees")
    return drawn
