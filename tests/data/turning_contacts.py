"""Contacts of two equal spheres whose normal turns, in polar coordinates and plain time.

With the overlap x, the distance r = D − x of the centres, the velocity c of the centres along the
tangent, the part s of the reduced tangential velocity that the spins have, and the angle θ:

    dx/dt = v    dv/dt = −F − c²/r    dc/dt = −μQ + vc/r    ds/dt = −(1 − α) Q r/D    dθ/dt = c/r
    F = x^p    w = (α/μ) c + s    stick: dQ/dt = κw, |Q| ≤ F    slip: Q = ±F, until ±κw < dF/dt

The contact ends at x = 0, and ε_n and ε_t are those of the first normal.

Run:  python turning_contacts.py > turning_contacts.json
"""

import json
import math
import random

from scipy.integrate import solve_ivp

COUNT, SEED = 24, 2012


def collide(power, kappa, psi, mu, alpha, overlap):
    greatest = 1.25**0.4 if power > 1.0 else 1.0
    distance = greatest / overlap
    starts_in_slip = power > 1.0 or kappa * psi > 1.0
    side = 1.0 if starts_in_slip else 0.0
    t, y = 0.0, [0.0, 1.0, mu * psi / alpha, 0.0, 0.0, 0.0]

    def velocity(y):
        return alpha / mu * y[2] + y[3]

    def force(x):
        return max(x, 0.0) ** power

    def rate(y):
        return power * max(y[0], 0.0) ** (power - 1.0) * y[1]

    while True:

        def slope(_, y):
            x, v, c, _s, _angle, q = y
            r = distance - x
            f = force(x)
            pull = side * f if side else q
            dq = side * rate(y) if side else kappa * velocity(y)
            return [v, -f - c * c / r, -mu * pull + v * c / r, -(1 - alpha) * pull * r / distance, c / r, dq]

        def end(t, y):
            return y[0] if t > 0.1 else 1.0

        def sticks(_, y):
            return side * kappa * velocity(y) - rate(y) if side else 1.0

        def slips(_, y):
            return 1.0 if side else force(y[0]) - y[5]

        def slips_back(_, y):
            return 1.0 if side else force(y[0]) + y[5]

        events = [end, sticks, slips, slips_back]
        for event in events:
            event.terminal, event.direction = True, -1.0
        run = solve_ivp(
            slope,
            (t, t + 100.0),
            y,
            "DOP853",
            events=events,
            max_step=0.01 / (1.0 + math.sqrt(kappa)),
            rtol=1e-12,
            atol=1e-14,
        )
        t, y = run.t[-1], list(run.y[:, -1])
        fired = next(event for event, times in zip(events, run.t_events) if len(times))
        if fired is end:
            _, v, c, s, angle, _ = y
            normal = -v * math.cos(angle) - c * math.sin(angle)
            tangential = -v * math.sin(angle) + c * math.cos(angle)
            return {"eps_n": normal, "eps_t": (alpha / mu * tangential + s) / psi}
        if fired is sticks:
            y[5], side = side * force(y[0]), 0.0
        else:
            side = 1.0 if fired is slips else -1.0


def main():
    draw = random.Random(SEED)
    cases = []
    for index in range(COUNT):
        case = {
            "power": 1.5 if index % 2 else 1.0,
            "kappa": 0.5 * 20.0 ** draw.random(),
            "psi": 0.3 * 8.0 ** draw.random(),
            "mu": 0.1 + 0.5 * draw.random(),
            "alpha": 2 / 7,
            "overlap": 1e-3 * 100.0 ** draw.random(),
        }
        cases.append(case | collide(**case))
    about = "contacts of equal spheres whose normal turns: turning_contacts.py"
    print(json.dumps({"about": about, "cases": cases}, indent=1))


main()
