"""Contacts whose friction decays with the tangential velocity, in plain time.

With the overlap x, its rate v, the tangential velocity w and the force q of the spring:

    dx/dt = v    dv/dt = −F    F = x^p + η v, not below 0    η = 0, a or a x^(1/4)
    dw/dt = −Q   stick: Q = q + b η w    dq/dt = κ w, or κ √x w + q v/(2x) where v < 0
                 slip:  Q = ±μ(w) F, and q such that this is so
    |Q| ≤ μ(w) F    μ(w) = r + (1 − r) e^(−B |w|)

Slip ends where ±dQ/dt, as it would be in stick, falls below d(μF)/dt. Each phase is integrated by
scipy's DOP853 with steps of at most 0.01/(1 + √κ + B) of a time unit, and ends where one of its
conditions changes sign, or w does. Nothing is scaled or divided out.

Run:  python decaying_friction.py > decaying_friction.json
"""

import json
import math
import random

from scipy.integrate import solve_ivp

COUNT, SEED = 150, 8518

#: The normal force, its damping, and whether the stiffness is κ √x.
KINDS = [
    ("linear", "none", False),
    ("linear", "linear", False),
    ("hertz", "none", False),
    ("hertz", "none", True),
    ("hertz", "tsuji", True),
]


class Contact:
    def __init__(self, kind, case):
        normal, self.damped, self.mindlin = kind
        self.power = 1.5 if normal == "hertz" else 1.0
        self.kappa, self.psi = case["kappa"], case["psi"]
        self.a, self.b = case["damping"], case["tangential_damping"]
        self.r, self.decay = case["dynamic"], case["decay"]

    def eta(self, x):
        """The damping and its derivative."""
        if self.damped == "none":
            return 0.0, 0.0
        if self.damped == "linear":
            return self.a, 0.0
        x = max(x, 1e-300)
        return self.a * x**0.25, 0.25 * self.a * x**-0.75

    def force(self, x, v):
        return max(x, 0.0) ** self.power + self.eta(x)[0] * v

    def force_rate(self, x, v):
        eta, slope = self.eta(x)
        elastic = self.power * max(x, 0.0) ** (self.power - 1.0) * v
        return elastic + slope * v * v - eta * self.force(x, v)

    def share(self, w):
        return self.r + (1.0 - self.r) * math.exp(-self.decay * abs(w))

    def share_rate(self, w, heading, dw):
        excess = (1.0 - self.r) * math.exp(-self.decay * abs(w))
        return -self.decay * heading * excess * dw

    def limit(self, x, v, w):
        return self.share(w) * self.force(x, v)

    def spring_rate(self, x, v, w, q):
        if not self.mindlin:
            return self.kappa * w
        falls = q * v / (2.0 * x) if v < 0.0 and x > 0.0 else 0.0
        return self.kappa * math.sqrt(max(x, 0.0)) * w + falls

    def sticking(self, x, w, q):
        return q + self.b * self.eta(x)[0] * w

    def excess(self, side, heading, x, v, w):
        """How much faster than its limit Q would grow, from there on in stick."""
        eta, slope = self.eta(x)
        limit = self.limit(x, v, w)
        q = side * limit - self.b * eta * w
        dw = -side * limit
        pull = self.spring_rate(x, v, w, q) + self.b * (slope * v * w + eta * dw)
        grows = self.share(w) * self.force_rate(x, v)
        grows += self.share_rate(w, heading, dw) * self.force(x, v)
        return side * pull - grows


def starts_in_slip(c):
    limit = c.share(c.psi)
    if c.damped == "linear":
        return c.b * c.psi > limit
    if c.damped == "tsuji":
        return False
    if c.mindlin:
        return 2.0 / 3.0 * c.kappa * c.psi > limit
    return c.power > 1.0 or c.kappa * c.psi > limit


def collide(c):
    side = 1.0 if starts_in_slip(c) else 0.0
    phases = "+" if side else "o"
    t, y, heading = 0.0, [0.0, 1.0, c.psi, 0.0], 1.0
    if c.mindlin or c.damped != "none":
        # Past the singular start, where spring and limit are known as powers.
        t = 1e-12
        spring = 2.0 / 3.0 * c.kappa * c.psi * t**1.5 if c.mindlin else c.kappa * c.psi * t
        y = [t, 1.0, c.psi, spring]
        if not side and spring + c.b * c.eta(t)[0] * c.psi > c.limit(*y[:3]):
            side, phases = 1.0, "+"
        elif side and c.excess(side, heading, *y[:3]) < 0.0:
            # The dashpot exceeds the limit, and the spring that is reset falls behind it.
            side, phases = 0.0, "o"
            y[3] = c.limit(*y[:3]) - c.b * c.eta(t)[0] * c.psi
    while True:

        def slope(_, y):
            x, v, w, q = y
            f = c.force(x, v)
            if side:
                return [v, -f, -side * c.limit(x, v, w), 0.0]
            return [v, -f, -c.sticking(x, w, q), c.spring_rate(x, v, w, q)]

        def end(_, y):
            return c.force(y[0], y[1]) if c.damped != "none" else y[0]

        def sticks(_, y):
            return c.excess(side, heading, *y[:3]) if side else 1.0

        def slips(_, y):
            return 1.0 if side else c.limit(*y[:3]) - c.sticking(y[0], y[2], y[3])

        def slips_back(_, y):
            return 1.0 if side else c.limit(*y[:3]) + c.sticking(y[0], y[2], y[3])

        def turns(_, y):
            return heading * y[2]

        def crest(_, y):
            return y[1]

        events = [end, sticks, slips, slips_back, turns, crest]
        for event in events:
            event.terminal, event.direction = True, -1.0
        longest = 0.01 / (1.0 + math.sqrt(c.kappa) + c.a + c.decay * (1.0 - c.r))
        run = solve_ivp(
            slope, (t, t + 100.0), y, "DOP853", events=events, max_step=longest, rtol=1e-13, atol=1e-15
        )
        t, y = run.t[-1], list(run.y[:, -1])
        fired = next(event for event, times in zip(events, run.t_events) if len(times))
        if fired is end:
            return {"eps_t": y[2] / c.psi, "eps_n": -y[1], "itinerary": phases}
        if fired is turns:
            y[2], heading = 0.0, -heading
        elif fired is crest:
            y[1] = -1e-300
        elif fired is sticks:
            y[3] = side * c.limit(*y[:3]) - c.b * c.eta(y[0])[0] * y[2]
            side, phases = 0.0, phases + "o"
        else:
            side = 1.0 if fired is slips else -1.0
            phases += "+" if side > 0.0 else "-"


def main():
    draw = random.Random(SEED)
    cases = []
    for index in range(COUNT):
        kind = KINDS[index % len(KINDS)]
        normal, damped, mindlin = kind
        case = {
            "normal": normal,
            "damping_of": damped,
            "mindlin": mindlin,
            "kappa": 0.1 * 1000.0 ** draw.random(),
            "psi": 0.02 * 150.0 ** draw.random(),
            "damping": 0.02 * 50.0 ** draw.random() if damped != "none" else 0.0,
            "tangential_damping": 2.0 * draw.random() if damped == "linear" else 0.0,
            "dynamic": draw.choice([0.0, draw.random(), draw.random()]),
            "decay": 0.1 * 1000.0 ** draw.random(),
        }
        cases.append(case | collide(Contact(kind, case)))
    about = "contacts with decaying friction in plain time: decaying_friction.py"
    print(json.dumps({"about": about, "cases": cases}, indent=1))


main()
