"""Contacts with the adhesion of DMT and JKR, in plain time.

With the overlap x, the contact radius r and the pull-off force f, in scaled units:

    DMT   r = sqrt(x)             F_el = r^3 - f
    JKR   x = r^2 - c sqrt(r)     F_el = r^3 - 1.5 c r^1.5,  c = (4/3) sqrt(f)
    dx/dt = v    dv/dt = -(F_el + eta v)    eta = 0, a or a r    dw/dt = -Q
    stick: Q = k y + b eta w, dy/dt = w  or  Q = q + b eta w, dq/dt = k w,  k = kappa or kappa r
           |Q| <= F_el + 2 f; rescaled, while v < 0: d(y/r)/dt = w/r, and so with q
    slip:  Q = +-(F_el + 2 f), until the spring falls behind

The variable is x: the radius of JKR is found from it at every step. Each phase is integrated by
scipy's DOP853 with short steps, and ends where one of its conditions changes sign. A contact ends
at x = 0, in JKR where dF/dr = 0 (end force) or dx/dr = 0 (end overlap); the bodies stay together
where v rises through 0 behind greatest compression, or where neither has happened after long.

Run:  python adhesive_contacts.py > adhesive_contacts.json
"""

import json
import math
import random
import sys
from concurrent.futures import ProcessPoolExecutor

from scipy.integrate import solve_ivp

COUNT, SEED, LONGEST = 100, 1971, 200.0


class Contact:
    def __init__(self, case):
        self.jkr = case["normal"] == "jkr"
        self.f, self.a, self.b = case["pull_off"], case["damping"], case["tangential_damping"]
        self.kappa, self.psi = case["kappa"], case["psi"]
        self.by_radius = case["eta"] == "viscoelastic"
        self.stiffens = case["tangential"] == "mindlin"
        self.history, self.rescaled = case["history"], case["rescaled"]
        self.c = 4.0 / 3.0 * math.sqrt(self.f) if self.jkr else 0.0
        # At the least force, or at the least overlap.
        cube = (0.75 if case["end"] == "force" else 0.25) * self.c
        self.end = cube ** (1.0 / 3.0) * (cube - self.c)

    def radius(self, x):
        """The radius with its derivative."""
        if not self.jkr:
            r = math.sqrt(max(x, 0.0))
            return r, 0.5 / max(r, 1e-300)
        # z^4 - c z = x, from above, where the polynomial is convex.
        c, least = self.c, (self.c / 4.0) ** (1.0 / 3.0)
        z = max(x, 0.0) ** 0.25 + c ** (1.0 / 3.0)
        for _ in range(200):
            slope = 4.0 * z**3 - c
            step = (z**4 - c * z - x) / slope if slope > 0.0 else 0.0
            z -= step
            if z <= least:
                z = least
                break
            if abs(step) < 1e-16 * z:
                break
        slope = 4.0 * z**3 - c
        return z * z, 2.0 * z / slope if slope > 1e-9 else 2.0 * z / 1e-9

    def elastic(self, r):
        return r**3 - 1.5 * self.c * r**1.5 if self.jkr else r**3 - self.f

    def elastic_slope(self, r):
        return 3.0 * r * r - 2.25 * self.c * math.sqrt(r) if self.jkr else 3.0 * r * r

    def limit(self, r):
        return self.elastic(r) + 2.0 * self.f

    def eta(self, r):
        return self.a * (r if self.by_radius else 1.0)

    def k(self, r):
        return self.kappa * (r if self.stiffens else 1.0)

    def carried(self, r, v):
        """What the history is divided by."""
        return max(r, 1e-5) if self.rescaled and v < 0.0 else 1.0

    def spring(self, r, v, h):
        h *= self.carried(r, v)
        return {"displacement": self.k(r) * h, "force": h, "none": 0.0}[self.history]

    def history_of(self, r, v, spring):
        history = {"displacement": spring / max(self.k(r), 1e-300), "force": spring, "none": 0.0}
        return history[self.history] / self.carried(r, v)

    def history_rate(self, r, v, w):
        rate = {"displacement": w, "force": self.k(r) * w, "none": 0.0}[self.history]
        return rate / self.carried(r, v)

    def pull(self, r, v, w, h):
        return self.spring(r, v, h) + self.b * self.eta(r) * w

    def excess(self, side, x, v, w):
        """How fast the force would leave its limit in stick."""
        r, dr = self.radius(x)
        limit = self.limit(r)
        spring = side * limit - self.b * self.eta(r) * w
        rate = {"displacement": self.k(r) * w, "force": self.k(r) * w, "none": 0.0}[self.history]
        if self.stiffens and self.history == "displacement":
            rate += spring * dr * v / max(r, 1e-12)
        if self.rescaled and v < 0.0:
            rate += spring * dr * v / max(r, 1e-12)
        eta_rate = self.a * dr * v if self.by_radius else 0.0
        rate += self.b * (eta_rate * w - self.eta(r) * side * limit)
        return side * rate - self.elastic_slope(r) * dr * v

    def collide(self):
        r = self.radius(0.0)[0]
        touch = self.b * self.eta(r) * self.psi
        side, h = 0.0, 0.0
        if touch > self.limit(r):
            early = 1e-12
            behind = self.history != "none" and self.excess(1.0, early, 1.0, self.psi) < 0.0
            side = 0.0 if behind else 1.0
            h = self.history_of(r, 1.0, self.limit(r) - touch) if behind else 0.0
        phases = "+" if side else "o"
        t, y = 0.0, [0.0, 1.0, self.psi, h]
        while t < LONGEST:

            def slope(_, y):
                x, v, w, h = y
                r = self.radius(x)[0]
                force = self.elastic(r) + self.eta(r) * v
                if side:
                    return [v, -force, -side * self.limit(r), 0.0]
                return [v, -force, -self.pull(r, v, w, h), self.history_rate(r, v, w)]

            def end(_, y):
                return y[0] - self.end if y[1] < 0.0 or y[0] != 0.0 else 1.0

            def back(_, y):
                return -y[1] if y[0] < self.crest else 1.0

            def sticks(_, y):
                if not side:
                    return 1.0
                if self.history == "none":
                    r = self.radius(y[0])[0]
                    return side * self.b * self.eta(r) * y[2] - self.limit(r)
                return self.excess(side, *y[:3])

            def gap(s):
                def value(_, y):
                    if side:
                        return 1.0
                    r = self.radius(y[0])[0]
                    return self.limit(r) - s * self.pull(r, *y[1:])

                return value

            slips, slips_back = gap(1.0), gap(-1.0)
            self.crest = self.turning if y[1] < 0.0 else -math.inf
            crest = (lambda _, y: y[1]) if y[1] > 0.0 else (lambda _, y: 1.0)
            events = [end, back, sticks, slips, slips_back, crest]
            for event in events:
                event.terminal, event.direction = True, -1.0
            longest = 0.01 / (1.0 + math.sqrt(self.kappa) + self.a)
            accuracy = {"max_step": longest, "rtol": 1e-12, "atol": 1e-14}
            run = solve_ivp(slope, (t, LONGEST), y, "DOP853", events=events, **accuracy)
            assert run.success, run.message
            t, y = run.t[-1], list(run.y[:, -1])
            fired = [event for event, times in zip(events, run.t_events) if len(times)]
            if not fired or fired[0] is back:
                return {"adheres": True}
            fired, r = fired[0], self.radius(y[0])[0]
            if fired is end:
                return {
                    "adheres": False,
                    "eps_t": y[2] / self.psi,
                    "eps_n": -y[1],
                    "time": t,
                    "itinerary": phases,
                }
            if fired is crest:
                y[1], self.turning = -1e-15, y[0] * (1.0 - 1e-9)
                y[3] /= self.carried(r, -1.0)
            elif fired is sticks:
                # A little below the limit, so that rounding does not lead back to it at once.
                rest = side * self.limit(r) * (1.0 - 1e-11) - self.b * self.eta(r) * y[2]
                y[3], side, phases = self.history_of(r, y[1], rest), 0.0, phases + "o"
            else:
                side = 1.0 if fired is slips else -1.0
                phases += "+" if side > 0.0 else "-"
        return {"adheres": True}


def compute(case):
    return case | Contact(case).collide()


def main():
    draw = random.Random(SEED)
    cases = []
    for index in range(2 * COUNT):
        eta = draw.choice(["linear", "viscoelastic"])
        springs = [(h, t) for h in ("displacement", "force") for t in ("constant", "mindlin")]
        history, tangential = draw.choice([*springs, ("none", "constant")])
        damped = draw.random() < 0.8
        # What a dashpot sets a spring to that stiffens from 0 has no plain equation.
        soft = (history, tangential, eta) == ("displacement", "mindlin", "linear")
        soft = soft and index % 2 == 0
        cases.append(
            {
                "normal": "jkr" if index % 2 else "dmt",
                "end": "force" if index % 4 == 1 else "overlap",
                "pull_off": 1e-3 * 600.0 ** draw.random(),
                "eta": eta,
                "damping": 0.01 * 80.0 ** draw.random() if damped else 0.0,
                "tangential": tangential,
                "history": history,
                "rescaled": history != "none" and tangential == "mindlin" and draw.random() < 0.5,
                "kappa": 0.05 * 2000.0 ** draw.random(),
                "psi": 0.02 * 100.0 ** draw.random(),
                "tangential_damping": 0.0 if soft or draw.random() < 0.3 else 4.0 * draw.random(),
            }
        )
    with ProcessPoolExecutor(int(sys.argv[1]) if len(sys.argv) > 1 else 1) as pool:
        cases = list(pool.map(compute, cases))
    about = "contacts with adhesion in plain time: adhesive_contacts.py"
    print(json.dumps({"about": about, "cases": cases}, indent=1))


main()
