"""Contacts with a hysteretic normal force, in plain time.

With the stiffnesses 1 and 1 + a while the overlap x grows and falls, and with p = 1 or 3/2:

    dx/dt = v    dv/dt = −F    F = x^p, then (1 + a)(x − x0)^p behind greatest compression
    dw/dt = −Q   stick: dQ/dt = κw, |Q| ≤ F   slip: Q = ±F, until ±κw falls below dF/dt

Each phase is integrated by scipy's DOP853 with steps of at most 0.01/(1 + √κ) of a time unit, and
ends where one of its conditions changes sign. Nothing is scaled or divided out.

Run:  python hysteretic_contacts.py > hysteretic_contacts.json
"""

import json
import math
import random

from scipy.integrate import solve_ivp

COUNT, SEED = 100, 1986


class Force:
    """The normal force, with its rate."""

    def __init__(self, power, a):
        self.power, self.factor, self.left, self.falls = power, 1.0, 0.0, False
        self.a = a

    def __call__(self, x):
        return self.factor * max(x - self.left, 0.0) ** self.power

    def rate(self, x, v):
        pushed = max(x - self.left, 0.0)
        return self.factor * self.power * (pushed ** (self.power - 1.0)) * v

    def turn(self, x):
        """Greatest compression: the overlap that pushes is smaller, and the force the same."""
        self.factor = 1.0 + self.a
        self.left = x - x * self.factor ** (-1.0 / self.power)
        self.falls = True


def collide(kappa, psi, a, power):
    force = Force(power, a)
    starts_in_slip = power > 1.0 or kappa * psi > 1.0
    side = 1.0 if starts_in_slip else 0.0
    phases = "+" if starts_in_slip else "o"
    t, y = 0.0, [0.0, 1.0, psi, 0.0]
    while True:

        def slope(_, y):
            x, v, w, q = y
            f = force(x)
            if side:
                return [v, -f, -side * f, side * force.rate(x, v)]
            return [v, -f, -q, kappa * w]

        def crest(_, y):
            return y[1]

        def end(_, y):
            return y[0] - force.left if force.falls else 1.0

        def sticks(_, y):
            return side * kappa * y[2] - force.rate(y[0], y[1]) if side else 1.0

        def slips(_, y):
            return 1.0 if side else force(y[0]) - y[3]

        def slips_back(_, y):
            return 1.0 if side else force(y[0]) + y[3]

        events = [end, sticks, slips, slips_back] + ([] if force.falls else [crest])
        for event in events:
            event.terminal, event.direction = True, -1.0
        longest = 0.01 / (1.0 + math.sqrt(kappa) + math.sqrt(a))
        run = solve_ivp(
            slope, (t, t + 100.0), y, "DOP853", events=events, max_step=longest, rtol=1e-13, atol=1e-15
        )
        t, y = run.t[-1], list(run.y[:, -1])
        fired = next(event for event, times in zip(events, run.t_events) if len(times))
        if fired is end:
            return {"eps_t": y[2] / psi, "eps_n": -y[1], "time": t, "itinerary": phases}
        if fired is crest:
            y[1] = 0.0
            force.turn(y[0])
        elif fired is sticks:
            y[3], side, phases = side * force(y[0]), 0.0, phases + "o"
        else:
            side = 1.0 if fired is slips else -1.0
            phases += "+" if side > 0.0 else "-"


def main():
    draw = random.Random(SEED)
    cases = []
    for index in range(COUNT):
        power = 1.5 if index % 4 == 3 else 1.0
        case = {
            "normal": "hertz" if power > 1.0 else "linear",
            "kappa": 0.05 * 2000.0 ** draw.random(),
            "psi": 0.02 * 100.0 ** draw.random(),
            "damping": 0.01 * 1000.0 ** draw.random(),
        }
        cases.append(case | collide(case["kappa"], case["psi"], case["damping"], power))
    about = "hysteretic contacts in plain time: hysteretic_contacts.py"
    print(json.dumps({"about": about, "cases": cases}, indent=1))


main()
