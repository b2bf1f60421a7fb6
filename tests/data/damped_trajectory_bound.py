"""Bounds of all errors of the tabulated normal motion with damping.

The argument is in crates/exact/PROOFS.md. Balls (Arb) enclose the exact
motion (damped_enclosure.py). All other numbers here are sums of positive terms, which rounding
changes by less than SLACK. So every line that is printed is proved, for the table that is read.
The code writes this table:

    cargo test -q -p stickslip-exact --lib the_table_as_text -- --ignored --nocapture > table.txt
    python damped_trajectory_bound.py table.txt        (needs python-flint; some minutes)
"""

import math
import struct
import sys
from multiprocessing import Pool

from damped_enclosure import BEYOND, SLACK, TERMS, Contact, cells, least, size
from flint import arb, arb_poly

KEPT = 17  # orders of the series of the code
PARTS = 12  # of half a distance between nodes
UNIT = 2.0**-53 * 1.001  # one rounding; products of several are in the factor
CUBE_ROOT = 12 * UNIT  # relative error of alpha, with a cube root good to 2 units in the last place


def read(path):
    """For every interval its wide steps, counts of nodes, and coefficients of the rows."""
    tables = []
    for line in open(path, encoding="ascii"):
        kind, *words = line.replace("[", "").replace(",", "").replace("]", "").split() or [""]
        if kind == "table":
            tables.append((int(words[1]), (int(words[2]), int(words[3])), []))
        elif kind == "row":
            tables[-1][2].append([float(word) for word in words])
    return tables


def chebyshev_norm(p):
    """The sum of the Chebyshev coefficients: a bound of |p| without the loss of large powers."""
    total = [arb(0)] * (p.length() + 1)
    for c in reversed(p.coeffs()):
        # total * x + c
        shifted = [arb(0)] * len(total)
        for j, t in enumerate(total[:-1]):
            for k in (j + 1, abs(j - 1)):
                shifted[k] += t / 2
        total = shifted
        total[0] += c
    return sum(map(abs, total), arb(0))


def digest(tables):
    """All coefficients to 50 bits, in the order in which the code has them."""
    result = 0
    for _, _, rows in tables:
        for power in range(len(rows[0])):
            for row in rows:
                scaled = abs(row[power]) * 2.0**50
                whole = math.floor(scaled + 0.5) if scaled < 2.0**52 else scaled
                rounded = math.copysign(whole, row[power]) + 0.0
                bits = int.from_bytes(struct.pack(">d", rounded), "big")
                result = ((result << 7 | result >> 57) & (1 << 64) - 1) ^ bits
    return result


def table_errors(contact, coefficients):
    """For every row, lane and cell the error of the code's number, and the least exact size.

    The polynomial of the code is compared with the exact function; to this come Horner's rule, in
    which coefficient k has 2k + 1 roundings, one rounding for a table of another computer, and
    the rounding of r.
    """
    of_x = float(contact.high / contact.half_width + 1) * UNIT
    result, worst = [], 0
    for row, exact in enumerate(contact.rows):
        lanes = []
        for lane, (p, error) in enumerate(exact):
            own = coefficients[4 * row + lane][::-1]
            table = arb_poly([arb(c) * BEYOND**k for k, c in enumerate(own)])
            off = float(chebyshev_norm(table - p) + error) * SLACK
            worst = max(worst, off / max(1, size(p[0])))
            per_cell = []
            for cell in cells():
                x = size(cell)
                rounding = sum((2 * k + 2) * UNIT * abs(c) * x**k for k, c in enumerate(own))
                rounding += sum(k * abs(c) for k, c in enumerate(own)) * of_x
                per_cell.append(((off + rounding) * SLACK, float(p(cell).abs_lower())))
            lanes.append(per_cell)
        result.append(lanes)
    return result, worst


def convolution(a, b, n):
    return sum(a[j] * b[n - j] for j in range(n + 1))


def together(a, b):
    return [x + y for x, y in zip(a, b)]


def series_errors(u, v, q, start, alpha, beta, alpha_off):
    """Errors of the coefficients up to KEPT of U, V, Q and T that the code computes.

    u, v and q bound the exact coefficients; `start` has the errors of the state.
    """
    eu, ev, eq, et = [start[0]], [start[1]], [start[2]], [0.0]
    y = [convolution(u, u, n) for n in range(KEPT + 1)]
    ey, ep, p = [], [], []
    for n in range(KEPT + 1):
        if n:
            eu.append((ev[-1] + 3 * UNIT * (v[n - 1] + ev[-1])) / n)
            ev.append(2 * (ep[-1] + 3 * UNIT * p[-1]) / n)
            et.append(2 * (eu[n - 1] + 3 * UNIT * (u[n - 1] + eu[n - 1])) / n)
        roundings = (n + 3) * UNIT
        most = together(u, eu)
        ey.append(2 * convolution(u, eu, n) + convolution(eu, eu, n)
                  + roundings * convolution(most, most, n))
        if n:
            eq.append(alpha * ey[n] + beta * ev[n] + (alpha_off + 3 * UNIT) * alpha * (y[n] + ey[n])
                      + 3 * UNIT * beta * (v[n] + ev[n]))
        most, most_q = together(y, ey), together(q, eq)
        p.append(convolution(most, most_q, n) * (1 + 2 * roundings))
        ep.append(convolution(y, eq, n) + convolution(ey, q, n) + convolution(ey, eq, n)
                  + (roundings + 2 * UNIT) * convolution(most, most_q, n))
    return eu, ev, eq, et


def value_errors(around, coefficients, errors, h):
    """Errors of U, V, Q and T at distances up to h, and those of truncation alone.

    In Horner's rule coefficient n has at most 3n/2 + 5 roundings.
    """
    tails = [float(t) * SLACK for t in around.tail(arb(h))]
    tails.append(2 * h * tails[0])
    cut_off = [sum(c[n] * h**n for n in range(KEPT + 1, len(c))) + t
               for c, t in zip(coefficients, tails)]
    rounded = [sum((e[n] + (1.5 * n + 5) * UNIT * (c[n] + e[n])) * h**n for n in range(KEPT + 1))
               for c, e in zip(coefficients, errors)]
    return [(r + c) * SLACK for r, c in zip(rounded, cut_off)], cut_off


def relative_at_end(coefficients, errors, first, lowest, h):
    """The relative error of c0 + c1 d + c2 d^2 + ..., all three not negative, for all d up to h.

    `first` is the relative error of c0 and c1, and `lowest` a lower bound of c2, to which all other
    terms and errors are compared.
    """
    quadratic = lowest - sum(coefficients[n] * h ** (n - 2) for n in range(3, len(coefficients)))
    assert quadratic > 0
    higher = sum((errors[n] + (1.5 * n + 5) * UNIT * coefficients[n]) * h ** (n - 2)
                 for n in range(2, KEPT + 1))
    higher += sum(coefficients[n] * h ** (n - 2) for n in range(KEPT + 1, len(coefficients)))
    return max(higher / quadratic, first) + 8 * UNIT


class Worst(dict):
    def note(self, name, value):
        assert value < math.inf, name
        self[name] = max(self.get(name, 0.0), value * SLACK)


def piece_errors(worst, contact, half, index, cell, start, time, ends):
    """Notes the worst errors of the motion around one node on one cell of r."""
    around, strong = contact.nodes[half][index], contact.strong
    alpha, beta = size(contact.alpha(cell)), size(contact.beta(cell))
    alpha_off = CUBE_ROOT if strong else 0.0
    balls = [[c(cell) for c in series] for series in (around.u, around.v, around.q)]
    u, v, q = ([size(b) for b in series] for series in balls)
    t = [0.0] + [2 * u[n - 1] / n for n in range(1, len(u))]
    errors = series_errors(u, v, q, start, alpha, beta, alpha_off)
    places = contact.places[half]
    gaps = [(places[index + 1] - places[index]) / 2]
    if index:
        gaps.append((places[index] - places[index - 1]) / 2)
    for name, series in zip("UVQT", (u, v, q, t)):
        most = max(c * (10 * gaps[0]) ** n for n, c in enumerate(series[:KEPT + 1]) if n)
        worst.note(name + " bound", most)
    for gap, away in zip(gaps, (True, False)):
        (eu, ev, eq, et), cut_off = value_errors(around, (u, v, q, t), errors, gap)
        u_most, q_most = (sum(c * gap**n for n, c in enumerate(series)) for series in (u, q))
        eu, eq, et = eu + UNIT * u_most, eq + UNIT * q_most, (et + time) / contact.shortest
        if strong:
            spring = alpha * u_most**2
            ev = eq + 2.01 * alpha * u_most * eu + (alpha_off + 3 * UNIT) * spring + UNIT
        for name, value in zip(("U", "V", "T"), (eu, ev + 2 * UNIT, et)):
            worst.note(name, value)
        for name, value in zip(("U cut", "V cut", None, "T cut"), cut_off):
            if name:
                worst.note(name, value)
        worst.note("28 orders", sum(c * gap**n for n, c in enumerate(v) if n > 28)
                   + float(around.tail(arb(gap))[1]))
        if index == 0:
            # q0 = beta or 0 and q1 = 2 alpha U V; t1 = 2U and t2 = V. At the start q1 = t1 = 0.
            lowest = float(balls[1][0].abs_lower())
            worst.note("T end", relative_at_end(t, errors[3], ends[0], lowest, gap))
            if half == 1 or not strong:
                lowest, first = float(balls[2][2].abs_lower()), sum(ends) + alpha_off + 6 * UNIT
                worst.note("Q end", relative_at_end(q, errors[2], first, lowest, gap))
                continue
        sign = 1 if away == (half == 0) else -1
        steepest = sum(n * c * gap ** (n - 1) for n, c in enumerate(q) if n)
        for part in range(PARTS):
            near, far = part * gap / PARTS, (part + 1) * gap / PARTS * SLACK
            (_, _, eq, _), cut_off = value_errors(around, (u, v, q, t), errors, far)
            here = around.q_near(sign * (near + far) / 2)(cell)
            lowest = float(here.abs_lower()) - (far - near) / 2 * steepest * SLACK - cut_off[2]
            assert lowest > 0, (contact.high, half, index, part)
            worst.note("Q", eq / lowest + 2 * UNIT)
            worst.note("Q cut", cut_off[2] / lowest)


def interval_errors(task):
    interval, (wide, counts, coefficients) = task
    contact, worst = Contact(interval, wide, counts), Worst()
    table, off = table_errors(contact, coefficients)
    worst["table"] = off
    worst["enclosure"] = max(float(e) for row in contact.rows for _, e in row)
    contact.shortest = float(least(contact.rows[0][1][0]))
    strong = contact.strong
    for index, cell in enumerate(cells()):
        end, duration, impulse, end_u = (lane[index] for lane in table[0])
        alpha = size(contact.alpha(cell))
        worst.note("end", end[0])
        worst.note("duration", duration[0] / duration[1])
        end_v = float(contact.nodes[1][0].v[0](cell).abs_lower())
        if strong:
            u_relative = end_u[0] / end_u[1]
            v_relative = 2 * u_relative + CUBE_ROOT + 3 * UNIT
        else:
            v_relative = impulse[0] / end_v + UNIT
            u_relative = v_relative / 2 + 2 * UNIT
        worst.note("end U", u_relative)
        worst.note("end V", v_relative)
        for half in (0, 1):
            v_off, deficit, time, elapsed = 0.0 if half == 0 else impulse[0] + UNIT, 0.0, 0.0, 0.0
            for node, around in enumerate(contact.nodes[half]):
                lanes = [lane[index] for lane in table[1 + half * counts[0] + node]]
                u, q = (size(series[0](cell)) for series in (around.u, around.q))
                eu, eq = lanes[0][0], lanes[1][0]
                if node == 0:
                    eu, eq = (0.0 if half == 0 else u * u_relative), 0.0
                ev = v_off + deficit + 2 * UNIT
                if strong:
                    ev = eq + alpha * (2.01 * u * eu + (CUBE_ROOT + 3 * UNIT) * u * u) + UNIT * q
                if node == 0:
                    ev = 0.0 if half == 0 else v_relative * size(around.v[0](cell))
                ends = (u_relative, v_relative) if half else (0.0, 0.0)
                start = (eu, ev, eq)
                piece_errors(worst, contact, half, node, cell, start, time + UNIT * elapsed, ends)
                deficit += lanes[2][0] + 2 * UNIT
                elapsed += size(contact.rows[1 + half * counts[0] + node][3][0](cell))
                time += lanes[3][0] + UNIT * elapsed
    return interval, worst


# What PROOFS.md quotes: the largest value for a < 1, and for 1 <= a < 2^14.
QUOTED = {
    "enclosure": ("half width of the enclosures of all rows", 1e-24, 1e-20),
    "table": ("polynomials of the table, relative to max(1, value)", 1.2e-16, 1.2e-16),
    "end": ("S at the end", 8e-16, 5e-15),
    "duration": ("duration, relative", 4e-16, 6e-16),
    "end U": ("U at the end, relative", 1e-15, 6e-16),
    "end V": ("V at the end, relative: the restitution", 1.5e-15, 3e-15),
    "28 orders": ("terms beyond 28 orders, V", 1e-26, 1e-25),
    "U cut": ("terms beyond 17 orders, U", 2e-18, 1e-17),
    "V cut": ("terms beyond 17 orders, V", 4e-17, 1.2e-16),
    "T cut": ("terms beyond 17 orders, T", 2e-19, 1e-18),
    "Q cut": ("terms beyond 17 orders, Q, relative", 2e-17, 4e-16),
    "U": ("U, all errors", 1.5e-15, 2e-15),
    "V": ("V, all errors", 5e-15, 8e-15),
    "T": ("time from the nearer end, all errors, over the duration", 1e-15, 3e-15),
    "Q": ("Q, all errors, relative", 6e-14, 2e-13),
    "Q end": ("Q in the piece at the end, relative", 1.2e-14, 5e-14),
    "T end": ("time in the pieces at the ends, relative", 5e-15, 6e-15),
    "U bound": ("largest |coefficient n of U| (10 h)^n, n up to 17", 1.6, 5.0),
    "V bound": ("the same of V", 30.0, 100.0),
    "Q bound": ("the same of Q", 15.0, 100.0),
    "T bound": ("the same of T", 2.2, 6.5),
}


if __name__ == "__main__":
    tables = read(sys.argv[1])
    assert len(tables) == 37
    print(f"    the table with the digest {digest(tables):#018x}")
    tasks = enumerate(tables)
    overall = [Worst(), Worst()]
    with Pool(2) as pool:
        for interval, worst in pool.imap(interval_errors, tasks):
            for name, value in worst.items():
                overall[interval > 8].note(name, value)
    weak, strong = overall
    for name, (text, most_weak, most_strong) in QUOTED.items():
        found = weak[name], strong[name]
        assert found[0] < most_weak and found[1] < most_strong, (name, found)
        print(f"ok  {text}: {found[0]:.2e} < {most_weak}, {found[1]:.2e} < {most_strong}")
