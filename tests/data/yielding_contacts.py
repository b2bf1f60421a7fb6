"""Contacts of bodies that yield (Thornton, J. Appl. Mech. 64, 383, 1997), in plain time.

With the overlap x, its rate v, and x_y where yield begins, ½ (1/a)² = (2/5) x_y^{5/2}:

    F = x^{3/2} up to x_y, then its tangent, and √r (x − x0)^{3/2} behind greatest compression,
    where x − x0 is x/r, and F the same: r = x^{3/2}/F
    dx/dt = v    dv/dt = −F    dw/dt = −Q    |Q| ≤ F

Q is κ y with dy/dt = w, or with Mindlin's stiffness κ r_c y, or q with dq/dt = κ r_c w. The contact
radius r_c is √x, and √(r (x − x0)) behind greatest compression, where a rescaled y or q also falls
as r_c does. In all, dQ/dt = k w + m Q (dr_c/dt)/r_c in stick, with m = 0, 1 or 2. Slip ends where
±dQ/dt, as it would be in stick, falls below dF/dt. While the overlap grows, y or q is integrated,
and Q behind.

Each phase is integrated by scipy's DOP853 with steps of at most 0.01/(1 + √κ) of a time unit, and
ends where one of its conditions changes sign. The greatest overlap is that of the integration.

Run:  python yielding_contacts.py > yielding_contacts.json
"""

import json
import math
import random

from scipy.integrate import solve_ivp

COUNT, SEED = 100, 1997
MINDLIN = 60


class Force:
    """The normal force, with its rate."""

    def __init__(self, a):
        self.yields_at = (5.0 / (4.0 * a * a)) ** 0.4
        self.yielded, self.falls, self.left, self.radius = False, False, 0.0, 1.0

    def __call__(self, x):
        if self.falls:
            return math.sqrt(self.radius) * max(x - self.left, 0.0) ** 1.5
        if self.yielded:
            return self.yields_at**1.5 + self.slope() * (x - self.yields_at)
        return max(x, 0.0) ** 1.5

    def slope(self):
        return 1.5 * math.sqrt(self.yields_at)

    def rate(self, x, v):
        if self.falls:
            return 1.5 * math.sqrt(self.radius * max(x - self.left, 0.0)) * v
        return (self.slope() if self.yielded else 1.5 * math.sqrt(max(x, 0.0))) * v

    def radius_of(self, x):
        """The contact radius."""
        return math.sqrt(max(self.radius * (x - self.left), 0.0) if self.falls else max(x, 0.0))

    def turn(self, x):
        if self.yielded:
            self.radius = x**1.5 / self(x)
            self.left = x - x / self.radius
        self.falls = True


def collide(kappa, psi, a, mindlin=False, history="displacement", rescaled=False):
    force = Force(a)
    kept = mindlin and history == "force"
    sticks_first = mindlin and kappa * psi * (2.0 / 3.0 if kept else 1.0) < 1.0
    side, phases = (0.0, "o") if sticks_first else (1.0, "+")
    t, y = 0.0, [0.0, 1.0, psi, 0.0]

    def stiffness(x):
        return kappa * (force.radius_of(x) if mindlin else 1.0)

    def pull(y):
        return y[3] if force.falls or kept else stiffness(y[0]) * y[3]

    def growth(y, q):
        """dQ/dt in stick."""
        power = (mindlin and not kept) + (rescaled and force.falls)
        rate = stiffness(y[0]) * y[2]
        return rate + power * q * y[1] / (2.0 * (y[0] - force.left)) if power and q else rate
    while True:

        def slope(_, y):
            x, v, w, q = y
            f = force(x)
            if side:
                return [v, -f, -side * f, 0.0]
            if force.falls:
                return [v, -f, -q, growth(y, q)]
            return [v, -f, -pull(y), stiffness(x) * w if kept else w]

        def crest(_, y):
            return y[1]

        def begins_to_yield(_, y):
            return force.yields_at - y[0]

        def end(_, y):
            return y[0] - force.left if force.falls else 1.0

        def sticks(_, y):
            return side * growth(y, side * force(y[0])) - force.rate(y[0], y[1]) if side else 1.0

        def slips(_, y):
            return 1.0 if side else force(y[0]) - pull(y)

        def slips_back(_, y):
            return 1.0 if side else force(y[0]) + pull(y)

        events = [end, sticks, slips, slips_back]
        if not force.falls:
            events.append(crest)
            if not force.yielded:
                events.append(begins_to_yield)
        for event in events:
            event.terminal, event.direction = True, -1.0
        longest = 0.01 / (1.0 + math.sqrt(kappa))
        run = solve_ivp(
            slope, (t, t + 100.0), y, "DOP853", events=events, max_step=longest, rtol=1e-13, atol=1e-15
        )
        t, y = run.t[-1], list(run.y[:, -1])
        fired = next(event for event, times in zip(events, run.t_events) if len(times))
        if fired is end:
            return {"eps_t": y[2] / psi, "eps_n": -y[1], "time": t, "itinerary": phases}
        if fired is crest:
            y[1], y[3] = 0.0, pull(y)
            force.turn(y[0])
        elif fired is begins_to_yield:
            y[0] = force.yields_at
            force.yielded = True
        elif fired is sticks:
            force_of = side * force(y[0])
            y[3] = force_of if force.falls or kept else force_of / stiffness(y[0])
            side, phases = 0.0, phases + "o"
        else:
            side = 1.0 if fired is slips else -1.0
            phases += "+" if side > 0.0 else "-"


def main():
    draw = random.Random(SEED)
    cases = []
    for index in range(COUNT):
        # One in ten does not yield.
        case = {
            "kappa": 0.05 * 2000.0 ** draw.random(),
            "psi": 0.02 * 100.0 ** draw.random(),
            "damping": 0.3 * 3.0 ** draw.random() if index % 10 == 9 else 1.01 * 50.0 ** draw.random(),
        }
        cases.append(case | collide(case["kappa"], case["psi"], case["damping"]))
    for index in range(MINDLIN):
        case = {
            "kappa": 0.05 * 2000.0 ** draw.random(),
            "psi": 0.02 * 100.0 ** draw.random(),
            "damping": 1.01 * 50.0 ** draw.random(),
            "mindlin": True,
            "history": ["displacement", "force"][index % 2],
            "rescaled": index % 4 > 1,
        }
        names = ("kappa", "psi", "damping", "mindlin", "history", "rescaled")
        cases.append(case | collide(*(case[name] for name in names)))
    about = "contacts of bodies that yield, in plain time: yielding_contacts.py"
    print(json.dumps({"about": about, "cases": cases}, indent=1))


main()
