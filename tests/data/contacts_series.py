"""Frictional contacts with every switch found by Descartes' rule of signs, to 25 digits.

Normal and tangential motion are integrated together by Taylor series in s, with dt = 2u ds and
F = u(u² + a v):

    u' = v     v' = −2uF     t' = 2u     stick: y' = 2uw, w' = −2κuy     slip on side ±: ±w − v = const

What decides is then a polynomial on each step: F ∓ κy in stick, 2κu(±w) − F' in slip, u² + a v (u
without damping) for the end of contact. Its Bernstein coefficients bound its number of roots: no
change of sign, no root; one change, one root. Steps are halved until one of the two holds, so that
no pair of switches is missed and none invented, however close the two are. Zeros that are there by
construction (the start of contact, the double zero where stick starts) are divided out before.

The series are of degree 64, with 66 digits and a truncation error of 1e-52. `Arithmetic` may be made
finer to check the results. Uses gmpy2 if it is there, which is some ten times faster than mpmath.

Run:  python contacts_series.py > contacts_series.json
"""

import json
import math
import random
import sys
import time
from operator import mul

import mpmath
import numpy

try:
    import gmpy2
except ImportError:
    gmpy2 = None

DAMPED, UNDAMPED, SEED = 2000, 300, 2026


class Arithmetic:
    """Numbers of `bits` bits, series of degree `degree` and their truncation error."""

    def __init__(self, bits=220, degree=64, tolerance=1e-52):
        mpmath.mp.prec = bits
        self.number = mpmath.mpf
        if gmpy2:
            gmpy2.get_context().precision = bits
            self.number = gmpy2.mpfr
        self.bits, self.degree, self.tolerance = bits, degree, tolerance
        # Σ_j C(i,j)/C(n,j) c_j are the Bernstein coefficients of Σ_j c_j x^j on [0, 1], for each n.
        self.tables = {}

    def table(self, n):
        if n not in self.tables:
            exact = [
                [self.number(math.comb(i, j)) / math.comb(n, j) for j in range(i + 1)]
                for i in range(n + 1)
            ]
            rough = numpy.zeros((n + 1, n + 1))
            for i, row in enumerate(exact):
                rough[i, : i + 1] = [float(entry) for entry in row]
            self.tables[n] = exact, rough
        return self.tables[n]


def product(a, b, k):
    """Term k of the product of two series."""
    return sum(map(mul, a[: k + 1], b[k::-1]))


def value(terms, h):
    total = 0
    for term in reversed(terms):
        total = total * h + term
    return total


def changes_of_sign(coefficients):
    signs = [c > 0 for c in coefficients if c != 0]
    return sum(map(bool.__ne__, signs, signs[1:]))


def halves(b):
    """The Bernstein coefficients on both halves, by de Casteljau."""
    left, right = [b[0]], [b[-1]]
    while len(b) > 1:
        b = [(p + q) / 2 for p, q in zip(b, b[1:])]
        left.append(b[0])
        right.append(b[-1])
    return left, right[::-1]


def first_root(arithmetic, terms, h):
    """The first root in (0, h] of a polynomial that is positive at 0, or None."""
    power, scaled = arithmetic.number(1), []
    for term in terms:
        scaled.append(term * power)
        power *= h
    exact, rough = arithmetic.table(len(terms) - 1)
    # Double precision suffices where nothing comes near 0.
    doubles = numpy.array([float(c) for c in scaled])
    if (rough @ doubles).min() > 1e-11 * abs(doubles).max():
        return None
    if not scaled[0] > 0:
        raise ArithmeticError("not positive where it starts")
    todo = [(arithmetic.number(0), 0, [sum(map(mul, row, scaled)) for row in exact])]
    while todo:
        start, depth, b = todo.pop()
        changes = changes_of_sign(b)
        if changes == 0:
            continue
        width = arithmetic.number(1) / 2**depth
        if changes == 1:
            return h * refine(arithmetic, scaled, start, start + width)
        if depth > 160:
            raise ArithmeticError("a double root")
        left, right = halves(b)
        todo.append((start + width / 2, depth + 1, right))
        todo.append((start, depth + 1, left))
    return None


def refine(arithmetic, terms, low, high):
    """The only root between low and high, by Newton's method with bisection as a guard."""
    slope = [k * term for k, term in enumerate(terms)][1:]
    x = (low + high) / 2
    for _ in range(4 * arithmetic.bits):
        there = value(terms, x)
        if there > 0:
            low = x
        else:
            high = x
        rate = value(slope, x)
        new = x - there / rate if rate != 0 else low
        if abs(new - x) <= abs(x) / 2 ** (arithmetic.bits - 8):
            return new
        if not low < new < high:
            new = (low + high) / 2
            if high - low <= abs(high) / 2 ** (arithmetic.bits - 8):
                return new
        x = new
    return x


def collide(arithmetic, kappa, psi, damping):
    """The itinerary, ε_t, ε_n and the contact time. The inputs are doubles, and exact."""
    number, degree = arithmetic.number, arithmetic.degree
    k, a = number(kappa), number(damping)
    root_k = math.sqrt(kappa)
    u, v, t = number(0), number(1), number(0)
    y, w = number(0), number(psi)
    # In slip ±w = v + offset. In stick `double` is the side on which a double zero starts the phase.
    side, double, offset = (0, 0, None) if damping > 0 else (1, 0, w - v)
    itinerary = "o" if damping > 0 else "+"
    at_start = True

    def reach(terms, size):
        """How far the last terms remain below the tolerance."""
        rates = (
            (float(abs(terms[n])) / (arithmetic.tolerance * size)) ** (1 / n)
            for n in range(degree - 7, degree + 1)
        )
        return 1 / max(max(rates), 1.0)

    while True:
        us, vs, uus, gs, fs = [u], [v], [], [], []
        ts, ys, ws = [t], [y], [w]
        for n in range(degree + 1):
            uus.append(product(us, us, n))
            gs.append(uus[n] + a * vs[n])
            fs.append(product(us, gs, n))
            if n == degree:
                break
            us.append(vs[n] / (n + 1))
            vs.append(-2 * product(us, fs, n) / (n + 1))
            ts.append(2 * us[n] / (n + 1))
            if side == 0:
                ys.append(2 * product(us, ws, n) / (n + 1))
                ws.append(-2 * k * product(us, ys, n) / (n + 1))
        h = min(reach(us, 1), reach(vs, 1))
        if side == 0:
            swing = math.sqrt(float(w) ** 2 + kappa * float(y) ** 2)
            h = min(h, reach(ws, swing), reach(ys, swing / root_k))
        h = number(h)

        force = gs if damping > 0 else us
        end = first_root(arithmetic, force[1:] if force[0] == 0 else force, h)
        if end is not None:
            h = end

        events = []
        if side == 0:
            for s in (1, -1):
                terms = [f - s * k * z for f, z in zip(fs, ys)]
                terms = terms[1:] if at_start else terms[2:] if s == double else terms
                root = first_root(arithmetic, terms, h)
                if root is not None:
                    events.append((root, s))
        else:
            uvs = [product(us, vs, n) for n in range(degree)]
            if damping > 0:
                terms = [
                    2 * k * (uvs[n] + offset * us[n]) - (n + 1) * fs[n + 1] for n in range(degree)
                ]
            else:
                # The same divided by u, which vanishes at both ends of contact.
                terms = [2 * k * vs[n] - 3 * uvs[n] for n in range(degree)]
                terms[0] += 2 * k * offset
            root = first_root(arithmetic, terms, h)
            if root is not None:
                events.append((root, 0))

        at_start = False
        if events:
            h, next_side = min(events)
        u, v, t = value(us, h), value(vs, h), value(ts, h)
        if side == 0:
            y, w, double = value(ys, h), value(ws, h), 0
        else:
            y, w = side * u * (u * u + a * v) / k, side * (v + offset)
        if events:
            double, side = side, next_side
            if side:
                offset = side * w - v
            itinerary += "+o-"[1 - side]
        elif end is not None:
            if side == 0:
                raise ArithmeticError("contact ends in stick")
            return itinerary, w / number(psi), -v, t


def digits(x, n=25):
    return mpmath.nstr(mpmath.mpf(str(x)), n, strip_zeros=False)


def contacts():
    """κ, ψ and a, log-uniform over twelve, eleven and ten decades; then a = 0."""
    source = random.Random(SEED)
    for n in range(DAMPED + UNDAMPED):
        kappa, psi = 10 ** source.uniform(-6, 6), 10 ** source.uniform(-10, 1)
        yield kappa, psi, 10 ** source.uniform(-6, 4) if n < DAMPED else 0.0


def main():
    arithmetic, started = Arithmetic(), time.time()
    about = "Random contacts with every switch found by Descartes' rule, to 25 digits"
    columns = ["kappa", "psi", "damping", "itinerary", "eps_t", "eps_n", "contact_time"]
    print(f'{{"about": {json.dumps(about)},\n"columns": {json.dumps(columns)},\n"cases": [')
    for n, contact in enumerate(contacts()):
        itinerary, *results = collide(arithmetic, *contact)
        row = json.dumps([*contact, itinerary, *map(digits, results)])
        print(("" if n == 0 else ",\n") + row, end="", flush=True)
        if n % 50 == 49:
            print(f"{n + 1} contacts, {time.time() - started:.0f} s", file=sys.stderr, flush=True)
    print("\n]}")


if __name__ == "__main__":
    main()
