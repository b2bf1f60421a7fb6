"""Writes linear_contacts.json: collisions with linear force, damping and spring; needs mpmath.

In every regime the overlap x, its rate v, the velocity w and the spring's force h = ky obey linear
equations, whose Taylor series of 30 terms advance in steps short beside all rates. On a step, the
functions that end a regime are polynomials. Whether they have a root there is decided by the signs of
their Bernstein coefficients (Descartes' rule), on halves where these do not tell.
"""

import json
import random

from mpmath import binomial, mp, mpf, nstr, sqrt

mp.dps = 40
ORDER = 30
RATIO = [[binomial(j, k) / binomial(ORDER, k) for k in range(j + 1)] for j in range(ORDER + 1)]


class Contact:
    def __init__(self, kappa, psi, a, b, end):
        self.kappa, self.psi, self.a, self.c = mpf(kappa), mpf(psi), mpf(a), mpf(a) * mpf(b)
        self.attracts = end == "overlap" and a > 0
        self.step = mpf(1) / 2 / (1 + sqrt(self.kappa) + self.a + self.c)

    def force(self, y):
        return y[0] + self.a * y[1]

    def rate(self, y, regime, sign):
        """dy/dt; regime 0 is stick, otherwise the side of slip; sign is that of the normal force."""
        x, v, w, h = y
        pull = regime * sign * self.force(y) if regime else h + self.c * w
        return [v, -self.force(y), -pull, mpf(0) if regime else self.kappa * w]

    def series(self, y, regime, sign, length):
        """Taylor coefficients of the state over a step of this length."""
        terms = [list(y)]
        for k in range(1, ORDER + 1):
            rate = self.rate(terms[-1], regime, sign)
            terms.append([length * r / k for r in rate])
        return terms

    def guards(self, y, regime, sign):
        """What ends the regime where it falls below 0, as a linear function of the state."""
        x, v, w, h = y
        limit = sign * self.force(y)
        slope = sign * (v - self.a * self.force(y))
        if regime:
            return [self.kappa * regime * w - self.c * limit - slope]
        pull = h + self.c * w
        return [limit - pull, limit + pull]


def crossing(p, low, high):
    """The first root of a polynomial with Bernstein coefficients p, if it falls through 0."""
    signs = [q < 0 for q in p if q != 0]
    changes = sum(one != other for one, other in zip(signs, signs[1:]))
    if changes == 0:
        return None
    if high - low < mpf(10) ** -30:
        return low if p[0] > 0 > p[-1] else None
    if changes == 1:
        return low + (high - low) * bisected(p) if p[0] > 0 else None
    left, right, row = [p[0]], [p[-1]], p
    while len(row) > 1:
        row = [(one + other) / 2 for one, other in zip(row, row[1:])]
        left.append(row[0])
        right.append(row[-1])
    middle = (low + high) / 2
    first = crossing(left, low, middle)
    return first if first is not None else crossing(right[::-1], middle, high)


def bisected(p):
    """The root of a polynomial on [0, 1] whose Bernstein coefficients change their sign once."""

    def value(t):
        return sum(
            binomial(len(p) - 1, j) * q * t**j * (1 - t) ** (len(p) - 1 - j)
            for j, q in enumerate(p)
        )

    low, high, below, above = mpf(0), mpf(1), p[0], p[-1]
    if below < 0:
        low, high, below, above = high, low, above, below
    for _ in range(300):
        t = (low * above - high * below) / (above - below)
        if not min(low, high) < t < max(low, high):
            break
        now = value(t)
        if abs(high - low) < mpf(10) ** -36 or now == 0:
            break
        if now > 0:
            low, below, above = t, now, above / 2
        else:
            high, above, below = t, now, below / 2
    return t


def bernstein(coefficients, zeros):
    """Bernstein coefficients of a polynomial divided by t**zeros."""
    c = coefficients[zeros:] + [mpf(0)] * zeros
    return [sum(RATIO[j][k] * c[k] for k in range(j + 1)) for j in range(ORDER + 1)]


def collide(contact):
    """Itinerary, switch times, w at the end, -v at the end and the time of the end."""
    c = contact
    y, sign, time = [mpf(0), mpf(1), c.psi, mpf(0)], 1, mpf(0)
    # The start: which side of the limit spring and dashpot are on.
    dashed = c.a > 0
    ratio = c.c / c.a * c.psi if dashed else c.kappa * c.psi
    zeros = [0, 0] if dashed else [1, 1]
    if ratio < 1:
        regime, side = 0, 1
    elif c.guards([y[0], y[1], y[2], c.a - c.c * y[2]], 1, 1)[0] > 0:
        regime, side = 1, 1
    else:
        regime, side, zeros, y[3] = 0, 1, [1, 0], c.a - c.c * y[2]
    itinerary, times = ["o", "+"][regime], []
    while True:
        terms = c.series(y, regime, sign, c.step)
        guards = list(zip(*(c.guards(t, regime, sign) for t in terms)))
        fired = []
        for number, guard in enumerate(guards):
            order = zeros[number] if number < len(zeros) else 0
            at = crossing(bernstein(list(guard), order), mpf(0), mpf(1))
            if at is not None:
                fired.append((at, number))
        stop = [sign * c.force(t) for t in terms] if sign > 0 else [t[0] for t in terms]
        started = time == 0 and not dashed
        at = crossing(bernstein(stop, 1 if started else 0), mpf(0), mpf(1))
        if at is not None:
            fired.append((at, "end"))
        theta, guard = min(fired, key=lambda f: f[0]) if fired else (mpf(1), None)
        y = [sum(t[i] * theta**k for k, t in enumerate(terms)) for i in range(4)]
        time += theta * c.step
        zeros = []
        if guard is None:
            continue
        if guard == "end":
            if sign < 0 or not c.attracts:
                return itinerary, times, y[2], -y[1], time
            sign = -1
            if regime and c.guards(y, regime, sign)[0] > 0:
                continue
            # The spring holds from where its force is 0.
            assert regime, "spring and limit vanish together"
            regime, zeros, y[3] = 0, [1, 1], -c.c * y[2]
        elif regime:
            y[3] = regime * sign * c.force(y) - c.c * y[2]
            regime, zeros = 0, [2, 0] if regime > 0 else [0, 2]
        else:
            regime = 1 if guard == 0 else -1
        itinerary += {0: "o", 1: "+", -1: "-"}[regime]
        times.append(time)


def cases():
    """Random contacts: laws in turn, under- and overdamped."""
    source = random.Random(20)

    def between(low, high):
        return low * (high / low) ** source.random()

    for number in range(180):
        law = ["overlap", "force"][number % 2]
        kappa, psi = between(1e-2, 400), between(1e-3, 4)
        a = between(1e-3, 1.95) if law == "overlap" else between(1e-3, 20)
        a = 0.0 if number % 9 < 2 else a
        b = source.random() * 3 if number % 4 > 1 else 0.0
        yield kappa, psi, a, b, law


def main():
    rows = []
    for kappa, psi, a, b, end in cases():
        itinerary, times, w, eps_n, time = collide(Contact(kappa, psi, a, b, end))
        text = lambda x: nstr(x, 24)
        numbers = [text(w / mpf(psi)), text(eps_n), text(time), [text(t) for t in times]]
        rows.append([kappa, psi, a, b, end, itinerary, *numbers])
    about = (
        "linear contacts: kappa, psi, damping, tangential damping, where the contact ends, itinerary, "
        "eps_t, eps_n, contact time, times of the switches; linear_contacts.py writes them"
    )
    with open("linear_contacts.json", "w") as out:
        out.write('{"about": ' + json.dumps(about) + ', "cases": [\n')
        out.write(",\n".join(json.dumps(row) for row in rows) + "\n]}\n")


if __name__ == "__main__":
    main()
