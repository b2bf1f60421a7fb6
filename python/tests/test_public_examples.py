"""Forty systems as users write them, after public examples: recorded, and compared with their
functions."""

import dataclasses
import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from stickslip import solve
from stickslip._recording import Tape


@dataclasses.dataclass
class Example:
    """A run of a system. reason: why it is not recorded."""

    field: Callable[..., Any]
    span: tuple[float, float]
    start: Any
    events: tuple[Callable[..., Any], ...] = ()
    args: tuple[Any, ...] = ()
    reason: str | None = None


EXAMPLES: dict[str, Example] = {}


def example(name: str, span: tuple[float, float], start: Any, *events: Any, **more: Any) -> Any:
    def add(field: Any) -> Any:
        EXAMPLES[name] = Example(field, span, start, events, **more)
        return field

    return add


# Shots and falls.


def hits_ground(t, y):
    return y[0]


hits_ground.terminal = True
hits_ground.direction = -1


def apex(t, y):
    return y[1]


@example("cannon", (0, 100), [0, 10], hits_ground, apex)
def upward_cannon(t, y):
    return [y[1], -0.5]


def lands(t, state):
    return state[1]


lands.terminal, lands.direction = True, -1


@example("drag", (0, 20), [0.0, 1.0, 30.0, 40.0], lands, lambda t, s: s[3])
def shot_with_drag(t, state):
    x, y, vx, vy = state
    speed = math.hypot(vx, vy)
    k = 0.5 * 1.2 * 0.47 * math.pi * 0.05**2
    return vx, vy, -k * speed * vx / 0.5, -9.81 - k * speed * vy / 0.5


@example("terminal velocity", (0, 12), [0.0], lambda t, v: v[0] - 30.0)
def falling(t, v):
    g, k = 9.81, 0.01
    dv = np.zeros_like(v, dtype=np.float64)
    dv[0] = g - k * v[0] ** 2 * np.sign(v[0])
    return dv


@example("rocket", (0, 60), [0.0, 0.0, 1000.0], lambda t, y: y[2] - 600.0)
def rocket(t, y):
    height, speed, mass = y
    flow = np.where(mass > 500.0, 10.0, 0.0)
    gravity = 9.81 / (1 + height / 6371e3) ** 2
    return np.array([speed, 2500.0 * flow / mass - gravity, -flow])


# Populations.


def peak(t, z, a, b, c, d):
    return a * z[0] - b * z[0] * z[1]


@example("Lotka-Volterra", (0, 15), [10, 5], peak, args=(1.5, 1, 3, 1))
def lotkavolterra(t, z, a, b, c, d):
    x, y = z
    return [a * x - b * x * y, -c * y + d * x * y]


INTERACTIONS = np.array([[0.0, -0.4, 0.1], [0.3, 0.0, -0.2], [-0.1, 0.25, -0.05]])
GROWTH = np.array([0.6, -0.1, -0.2])


@example("three species", (0, 10), [0.8, 0.5, 0.6], lambda t, n: n.max() - 1.2)
def species(t, n):
    return n * (GROWTH + INTERACTIONS.dot(n))


BETA, GAMMA = 0.4, 0.1
EXAMPLES["SIR"] = Example(
    lambda t, y: (-BETA * y[0] * y[1], BETA * y[0] * y[1] - GAMMA * y[1], GAMMA * y[1]),
    (0, 100),
    [0.99, 0.01, 0.0],
    (lambda t, y: BETA * y[0] - GAMMA,),
)

PAYOFF = np.array([[0.0, -1.0, 2.0], [1.0, 0.0, -1.0], [-1.0, 1.5, 0.0]])


@example("replicator", (0, 10), [0.3, 0.3, 0.4], lambda t, x: x[0] - x[2])
def replicator(t, x):
    fitness = np.einsum("ij,j->i", PAYOFF, x)
    return x * (fitness - np.sum(x * fitness))


# Oscillators and chaos.


@example("Lorenz", (0, 3), [1.0, 1.0, 1.0], lambda t, s, *p: s[2] - 27, args=(10, 28, 8 / 3))
def lorenz(t, state, sigma, rho, beta):
    x, y, z = state
    dx = sigma * (y - x)
    dy = x * (rho - z) - y
    dz = x * y - beta * z
    return np.array([dx, dy, dz])


@example("Van der Pol", (0, 12), [2.0, 0.0], lambda t, y, mu: y[1], args=(2.0,))
def vdp(t, y, mu):
    dydt = np.empty(2)
    dydt[0] = y[1]
    dydt[1] = mu * (1 - y[0] ** 2) * y[1] - y[0]
    return dydt


def gravity(theta, length=1.0):
    return -9.81 / length * np.sin(theta)


@example("pendulum", (0, 5), [2.5, 0.0], lambda t, y: y[0])
def pendulum(t, y):
    return np.array([y[1], gravity(y[0], length=0.7) - 0.1 * y[1]])


@example("double pendulum", (0, 3), [1.0, 0.5, 0.0, 0.0], lambda t, y: y[0] - y[1])
def double_pendulum(t, y):
    a, b = y[:2]
    rates = y[2:]
    coupling = 0.5 * np.cos(a - b)
    mass = np.array([[1.0, coupling], [coupling, 0.5]])
    turn = 0.5 * np.sin(a - b)
    force = np.array([-turn * rates[1] ** 2 - 9.81 * np.sin(a), turn * rates[0] ** 2])
    force[1] -= 0.5 * 9.81 * np.sin(b)
    return np.concatenate((rates, np.linalg.solve(mass, force)))


class Duffing:
    """An oscillator whose force is a polynomial."""

    damping = 0.2

    def __init__(self, *coefficients, drive=0.3):
        self.coefficients = list(coefficients)
        self.drive = drive

    def __call__(self, t, y):
        return [y[1], self.force(y[0]) - self.damping * y[1] + self.drive * math.cos(1.2 * t)]

    def force(self, x):
        return -np.polyval(self.coefficients, x)


EXAMPLES["Duffing"] = Example(
    Duffing(1.0, 0.0, -1.0, 0.0), (0, 15), [1.0, 0.0], (lambda t, y: y[0],)
)


def forced(t, y, *, omega, **options):
    push = options.get("amplitude", 1.0) * np.cos(options["drive"] * t)
    return [y[1], push - omega**2 * y[0]]


EXAMPLES["partial"] = Example(
    functools.partial(forced, omega=1.5, drive=0.8, amplitude=0.4),
    (0, 20),
    [1.0, 0.0],
    (lambda t, y: y[1],),
)


def damped(zeta, omega):
    def rhs(t, y):
        x, v = y
        return v, -2 * zeta * omega * v - omega**2 * x

    return rhs


EXAMPLES["closure"] = Example(damped(0.05, 3.0), (0, 10), [1, 0], (lambda t, y: y[0] - 0.5,))


@example("Kuramoto", (0, 8), np.linspace(0, 3, 6), lambda t, p: np.sin(p).sum() - 5)
def kuramoto(t, phases):
    natural = np.linspace(-0.5, 0.5, len(phases))
    pull = np.sin(phases[None, :] - phases[:, None]).mean(axis=1)
    return natural + 1.2 * pull


# Bodies in space.

MU = 0.012277471


def passes(t, u):
    return math.sqrt((u[0] + MU) ** 2 + u[1] ** 2) - 0.5


@example("Arenstorf", (0, 2), [0.994, 0.0, 0.0, -2.00158510637908], passes)
def arenstorf(t, u):
    x, y, vx, vy = u
    other = 1 - MU
    d1 = ((x + MU) ** 2 + y**2) ** 1.5
    d2 = ((x - other) ** 2 + y**2) ** 1.5
    ax = x + 2 * vy - other * (x + MU) / d1 - MU * (x - other) / d2
    ay = y - 2 * vx - other * y / d1 - MU * y / d2
    return [vx, vy, ax, ay]


MASSES = np.array([1.0, 0.5, 0.2])


@example(
    "three bodies",
    (0, 3),
    [1.0, 0.0, -1.0, 0.2, 0.0, 2.0, 0.0, 0.4, 0.1, -0.5, 0.7, 0.0],
    lambda t, w: np.linalg.norm(w[0:2] - w[2:4]) - 1.9,
)
def bodies(t, w):
    n = len(w) // 4
    r = w[: 2 * n].reshape(n, 2)
    v = w[2 * n :].reshape(n, 2)
    a = np.zeros((n, 2))
    for i in range(n):
        for j in range(n):
            if i != j:
                d = r[j] - r[i]
                a[i] += MASSES[j] * d / (np.linalg.norm(d) ** 2 + 0.01) ** 1.5
    return np.concatenate([v, a]).flatten()


@example(
    "all pairs",
    (0, 2),
    [1.0, 0.0, -0.5, 0.8, -0.5, -0.9, 0.0, 0.5, -0.4, -0.2, 0.4, -0.3],
    lambda t, w: w[0],
)
def pairs(t, w):
    r, v = w.reshape(2, -1, 2)
    d = r[:, np.newaxis, :] - r[np.newaxis, :, :]
    distance = np.linalg.norm(d, axis=-1)
    np.fill_diagonal(distance, np.inf)
    return np.hstack([v.ravel(), -(d / distance[..., None] ** 3).sum(axis=1).ravel()])


FIELD = np.array([0.0, 0.1, 1.0])


@example("charge", (0, 6), [0.0, 0.0, 0.0, 1.0, 0.0, 0.5], lambda t, s: s[0])
def charge(t, s):
    velocity = s[3:]
    push = np.array([0.0, 0.0, 0.1 * math.cos(t)]) + np.cross(velocity, FIELD)
    return np.stack([velocity, push]).reshape(-1)


@dataclasses.dataclass(frozen=True)
class Body:
    inertia: tuple[float, float, float] = (1.0, 2.0, 3.0)
    drag: float = 0.01

    def momentum(self, omega):
        return np.diag(self.inertia) @ omega


@example("rigid body", (0, 20), [0.01, 1.0, 0.02], lambda t, w, body: w[1], args=(Body(),))
def rigid(t, omega, body):
    torque = -np.cross(omega, body.momentum(omega)) - body.drag * omega
    return torque / np.array(body.inertia)


@example("pursuit", (0, 4), [0.0, 0.0], lambda t, p: math.dist(p, (5.0, 1.5 * t)) - 3.0)
def pursuit(t, p):
    angle = np.arctan2(1.5 * t - p[1], 5.0 - p[0])
    return 2.0 * np.cos(angle), 2.0 * np.sin(angle)


# Chemistry and fields.


@example("Robertson", (0, 0.3), [1.0, 0.0, 0.0], lambda t, y: y[0] - 0.995)
def robertson(t, y):
    slow, fast, pair = 0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] ** 2
    return [-slow + fast, slow - fast - pair, pair]


RATES = np.array([[-0.5, 0.1, 0.0], [0.5, -0.3, 0.2], [0.0, 0.2, -0.2]])


@example("decay", (0, 10), [2, 4, 8], lambda t, y: y[0] - 1.5)
def decay(t, y):
    return RATES @ y


@example("heat", (0, 0.05), np.sin(np.pi * np.linspace(0, 1, 12)) * 100, lambda t, u: u[6] - 80)
def heat(t, u):
    dx = 1.0 / (len(u) - 1)
    du = np.empty_like(u)
    du[0] = du[-1] = 0.0
    du[1:-1] = (u[2:] - 2 * u[1:-1] + u[:-2]) / dx**2
    return du


@example("Brusselator", (0, 4), [1.2, 1.0, 0.9, 1.0, 3.0, 3.1, 2.9, 3.0], lambda t, y: y[0] - 1.5)
def brusselator(t, y):
    u, v = np.split(y, 2)

    def spread(w):
        return np.diff(np.pad(w, 1, mode="edge"), n=2)

    du = 1.0 + u**2 * v - 4.0 * u + 0.02 * spread(u)
    dv = 3.0 * u - u**2 * v + 0.02 * spread(v)
    return np.concatenate([du, dv])


@example(
    "chain",
    (0, 6),
    [0.0, 0.3, 0.1, -0.2, 0.0, 0.0, 0.0, 0.5, 0.0, -0.1],
    lambda t, y: y[2] - 0.3,
)
def chain(t, y):
    n = y.size // 2
    x, v = y[:n], y[n:]
    right, left = np.roll(x, -1) - x, x - np.roll(x, 1)
    dy = np.zeros(y.shape)
    dy[:n] = v
    dy[n:] = right - left
    dy[n:] += 0.25 * (right**2 - left**2)
    return dy


TANKS = [{"volume": 2.0, "flow": 0.5}, {"volume": 1.0, "flow": 0.5}, {"volume": 4.0, "flow": 0.25}]


@example("tanks", (0, 8), [1.0, 0.0, 0.0], lambda t, c: c[1] - c[2])
def tanks(t, c):
    dc = [0.0] * len(c)
    for i, (tank, level) in enumerate(zip(TANKS, c, strict=True)):
        out = tank["flow"] / tank["volume"] * level
        dc[i] -= out
        if i + 1 < len(c):
            dc[i + 1] += out
    return dc


@example("ring", (0, 5), [1.0, 0.0, 0.5, 0.2], lambda t, y: max(y) - 0.6)
def ring(t, y):
    n = len(y)
    return [y[i - 1] * y[(i + 1) % n] - y[i] * abs(y[i]) for i in range(n)]


# Neurons.


@example("FitzHugh-Nagumo", (0, 40), [-1.2, -0.6], lambda t, y: y[0])
def fitzhugh_nagumo(t, y):
    v, w = y
    if 5.0 <= t < 25.0:
        current = 0.5
    else:
        current = 0.0
    return [v - v**3 / 3 - w + current, 0.08 * (v + 0.7 - 0.8 * w)]


NEURON = {"tau": 10.0, "rest": -65.0, "resistance": 10.0, "threshold": -50.0}


def spike(t, v):
    return v[0] - NEURON["threshold"]


spike.terminal = True
spike.direction = 1


@example("integrate and fire", (0, 100), [-65.0], spike)
def leaky(t, v, p=NEURON):
    current = 2.0 if t > 10 else 0.0
    return (-(v - p["rest"]) + p["resistance"] * current) / p["tau"]


def rate(v, scale, middle, width):
    x = (v - middle) / width
    return scale * x / (1 - np.exp(-x))


@example("Hodgkin-Huxley", (0, 6), [-60.0, 0.1, 0.4, 0.5], lambda t, y: y[0])
def hodgkin_huxley(t, y):
    v, m, n, h = y
    current = 10.0 * np.heaviside(t - 1.0, 1.0)
    i_na = 120.0 * m**3 * h * (v - 50.0)
    i_k = 36.0 * n**4 * (v + 77.0)
    dm = rate(v, 1.0, -40.0, 10.0) * (1 - m) - 4.0 * np.exp(-(v + 65.0) / 18.0) * m
    dn = rate(v, 0.1, -55.0, 10.0) * (1 - n) - 0.125 * np.exp(-(v + 65.0) / 80.0) * n
    dh = 0.07 * np.exp(-(v + 65.0) / 20.0) * (1 - h) - h / (1 + np.exp(-(v + 35.0) / 10.0))
    return [current - i_na - i_k - 0.3 * (v + 54.4), dm, dn, dh]


# Control, and right-hand sides with corners and jumps.


class Room:
    """A room whose heater has a dead band."""

    def __init__(self, outside=5.0):
        self.outside = outside
        self.log = []

    def heating(self, temperature):
        if temperature < 18.0:
            return 4.0
        elif temperature < 22.0:
            return 4.0 * (22.0 - temperature) / 4.0
        return 0.0

    def slope(self, t, y):
        dy = np.zeros(1)
        dy[0] = self.heating(y[0]) - 0.2 * (y[0] - self.outside)
        return dy


EXAMPLES["thermostat"] = Example(Room().slope, (0, 10), [10.0], (lambda t, y: y[0] - 18.0,))


@example("dry friction", (0, 8), [0.0, 5.0], lambda t, y: y[1] - 4.0)
def dry_friction(t, y):
    x, v = y
    return [v, -0.3 * np.sign(v) - 0.1 * x]


@example("saturation", (0, 10), [0.0, 0.0, 0.0], lambda t, y: y[0] - 1.0)
def saturated(t, y):
    error = 1.0 - y[0]
    wanted = 4.0 * error + y[2]
    force = np.clip(wanted, -1.5, 1.5)
    windup = error if abs(wanted) < 1.5 else 0.0
    return [y[1], force - y[1] - min(max(y[0], 0.0), 0.5), windup]


ROAD = np.linspace(0.0, 10.0, 21)
HEIGHT = 0.1 * np.sin(ROAD) * np.exp(-0.1 * ROAD)


@example("table", (0, 8), [0.0, 0.0], lambda t, y: y[0] - np.interp(t, ROAD, HEIGHT))
def on_a_road(t, y):
    return [y[1], 20.0 * (np.interp(t, ROAD, HEIGHT) - y[0]) - 2.0 * y[1]]


@example("square wave", (0, 5), [0.0, 0.0], lambda t, y: y[0] - 0.6)
def square_wave(t, y):
    on = int(t / 1.25) % 2 == 0
    ramp = (t % 1.0) * (np.floor(2 * t) % 2)
    return np.array([(1.0 if on else 0.0) - y[0], ramp - y[1]])


@example("gears", (0, 10), [1.0], lambda t, v: v[0] - 12.0)
def gears(t, v):
    ratio = np.select([v < 5, v < 10], [4.0, 2.0], default=1.0)
    return ratio * (1 - v / 40) - 0.001 * v * np.abs(v)


# What is not recorded.


@example("complex", (0, 5), [0.5, 0.1], lambda t, y: y[0], reason="complex numbers")
def stuart_landau(t, y):
    z = y[0] + 1j * y[1]
    dz = (1 + 2j) * z - abs(z) ** 2 * z
    return [dz.real, dz.imag]


@example("checked", (0, 1), [1.0], lambda t, y: y[0] - 0.5, reason="ValueError")
def checked(t, y):
    if y[0] < 0:
        raise ValueError(f"negative concentration at t = {t}")
    return -y


TOLERANCES = {"rtol": 1e-9, "atol": 1e-11}


def test_most_examples_are_recorded() -> None:
    assert len(EXAMPLES) >= 40
    assert sum(one.reason is None for one in EXAMPLES.values()) >= 0.95 * len(EXAMPLES)


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_recorded_as_what_it_computes(name: str) -> None:
    one = EXAMPLES[name]
    run = functools.partial(
        solve, one.field, one.span, one.start, events=one.events, args=one.args, **TOLERANCES
    )
    if one.reason is not None:
        with pytest.raises(ValueError, match=one.reason):
            run(record=True)
        assert one.reason in run().guards
        return
    found, called = run(record=True), run(record=False)
    assert found.guards == "decided" and found.status == called.status
    assert sum(map(len, called.t_events)) > 0
    # Both runs have many steps, each with an error of the tolerances.
    size = np.abs(called.y).max(axis=1)
    assert (np.abs(found.y[:, -1] - called.y[:, -1]) <= 1e-6 * size + 1e-9).all()
    for times, others in zip(found.t_events, called.t_events, strict=True):
        np.testing.assert_allclose(times, others, rtol=1e-6, atol=1e-7)
    # The formulas, at states of the run and beside them.
    random = np.random.default_rng(len(name))
    for function in (one.field, *one.events):
        tape = Tape()
        formulas = [symbol.id for symbol in tape.record(function, called.y.shape[0], one.args)]
        for column in random.integers(0, called.t.size, 20):
            t = float(called.t[column] + random.uniform(0, 1e-3))
            y = called.y[:, column] + random.uniform(-1e-3, 1e-3, size.size) * size
            expected = np.asarray(function(t, y.copy(), *one.args), dtype=float).reshape(-1)
            (values,) = tape.native.evaluate(formulas, [(t, y.tolist())], [])
            near = 1e-12 * np.abs(expected).max()
            np.testing.assert_allclose(values, expected, rtol=1e-11, atol=near)
