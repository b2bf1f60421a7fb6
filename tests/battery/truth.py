"""Writes cases.json: event-location cases whose true events follow from closed forms.

Every number of a case is a double, and the truth belongs to exactly these doubles. It is computed
with 40 digits (mpmath) and rounded once at the end. Only the Arenstorf orbit has no closed form;
its truth comes from a Taylor integration of order 40 with 40 digits.

Run with a Python that has mpmath:  python tests/battery/truth.py
"""

import json
from pathlib import Path

from mpmath import mp, mpf

mp.dps = 40
PI = mp.pi


# Expressions in prefix form.
def add(a, *rest):
    return add(["+", a, rest[0]], *rest[1:]) if rest else a


def sub(a, b):
    return ["-", a, b]


def mul(a, *rest):
    return mul(["*", a, rest[0]], *rest[1:]) if rest else a


def div(a, b):
    return ["/", a, b]


def call(name, *arguments):
    return [name, *arguments]


def power(a, n):
    return ["powi", a, n]


def guard(value, direction="either", to=None, reset=None, terminal=False, zero_order=0):
    """A guard. One without target and reset, and which is not terminal, is only noted."""
    it = {"value": value, "direction": direction, "to": to, "reset": reset}
    if terminal:
        it["terminal"] = True
    if zero_order:
        it["zero_order"] = zero_order
    return it


CASES = []


def case(name, kind, source, modes, start, end, events, **more):
    """Adds a case. `start` is (time, state) or (mode, time, state), `modes` (field, guards)."""
    start = start if len(start) == 3 else (0, *start)
    it = {
        "name": name,
        "kind": kind,
        "source": source,
        "modes": [{"field": field, "guards": guards} for field, guards in modes],
        "start": {"mode": start[0], "time": float(start[1]), "state": [float(x) for x in start[2]]},
        "end": float(end),
        "rtol": more.pop("rtol", 1e-12),
        "atol": more.pop("atol", 1e-12),
    }
    if "guard_scale" in more:
        it["guard_scale"] = more.pop("guard_scale")
    it["outcome"] = more.pop("outcome", "end")
    if "accumulation" in more:
        it["accumulation"] = float(more.pop("accumulation"))
    if "count" in more:
        it["count"] = more.pop("count")
        it["sampled"] = [[index, float(time), which] for index, time, which in events]
    else:
        times = [time for time, _ in events]
        assert times == sorted(times), name
        assert all(start[1] < time < end for time in times), name
        it["events"] = [[float(time), which] for time, which in events]
    it["tolerance"] = more.pop("tolerance", 1e-9)
    if "why" in more:
        it["why"] = more.pop("why")
    assert not more, more
    assert it["tolerance"] == 1e-9 or "why" in it, name
    CASES.append(it)


def merged(*lists):
    return sorted((event for events in lists for event in events), key=lambda event: event[0])


def multiples(first, period, end, start=0):
    """first + k period in the open interval from start to end."""
    k = int(mp.floor((mpf(start) - first) / period)) + 1
    times = []
    while first + k * period < end:
        times.append(first + k * period)
        k += 1
    return times


def sign_changes(function, start, end, cells):
    """All sign changes between neighbours of a uniform grid, bisected to 40 digits."""
    start, end = mpf(start), mpf(end)
    grid = [start + (end - start) * k / cells for k in range(cells + 1)]
    values = [function(t) for t in grid]
    times = []
    for a, b, f, g in zip(grid, grid[1:], values, values[1:]):
        if (f < 0) != (g < 0):
            below = f < 0
            while b - a > mpf(10) ** -35 * max(abs(b), mpf(10) ** -3):
                middle = (a + b) / 2
                a, b = (middle, b) if (function(middle) < 0) == below else (a, middle)
            times.append((a + b) / 2)
    return times


def noted(times, which=0):
    return [(time, which) for time in times]


CLOCK = [1.0]
# y0 = sin(t) from the state (0, 1).
OSCILLATOR = ["y1", ["neg", "y0"]]
PLANTED = "planted: true by construction"
GRAVITY = 9.81


def phase(angle):
    """A state of the oscillator, and the angle that its doubles really have."""
    y0, y1 = float(mp.sin(angle)), float(mp.cos(angle))
    return (y0, y1), mp.atan2(mpf(y0), mpf(y1)), mp.hypot(mpf(y0), mpf(y1))


def steep():
    for digits, root in ((4, 0.3711), (6, 0.6173), (8, 0.2237)):
        value = call("tanh", mul(float(10**digits), sub("t", root)))
        case(f"steep-tanh-1e{digits}", "steep", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
             [(mpf(root), 0)], **({"guard_scale": 1e-4} if digits == 4 else {}))
    (y0, y1), angle, size = phase(0.2)
    value = call("tanh", mul(1e6, sub("y0", 0.5)))
    up = mp.asin(mpf(0.5) / size)
    crossings = multiples(up - angle, 2 * PI, 20) + multiples(PI - up - angle, 2 * PI, 20)
    case("steep-tanh-of-oscillator", "steep", PLANTED, [(OSCILLATOR, [guard(value)])],
         (0, [y0, y1]), 20, noted(sorted(crossings)))
    value = sub(call("exp", mul(-1e3, "t")), 0.5)
    case("steep-start", "steep", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 100,
         [(mp.log(2) / 1000, 0)])


def fast():
    value = call("sin", add(mul(1000.0, "t"), 0.3))
    case("fast-sine-1000", "fast", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         noted(multiples(-mpf(0.3) / 1000, PI / 1000, 1)), guard_scale=1e-3)
    value = call("sin", mul(10000.0, "y0"))
    case("fast-sine-10000-falling", "fast", PLANTED + "; starts from 0 and rises there",
         [(CLOCK, [guard(value, "falling")])], (0, [0]), 1,
         noted(multiples(PI / 10000, 2 * PI / 10000, 1)), guard_scale=1e-4)
    value = sub("y0", mul(2.0, call("exp", call("neg", power(div(sub("t", 5.3), 0.03), 2)))))
    decay = [mul(-0.1, "y0")]

    def gap(t):
        return mp.exp(-mpf(0.1) * t) - 2 * mp.exp(-((t - mpf(5.3)) / mpf(0.03)) ** 2)

    case("gaussian-dip", "fast", PLANTED, [(decay, [guard(value)])], (0, [1]), 20,
         noted(sign_changes(gap, 5, 5.6, 400)), guard_scale=0.03)


def tangent():
    for digits in (3, 6):
        half = 0.5 * 10.0 ** -digits
        root = 0.43
        value = sub(power(sub("t", root), 2), half * half)
        distance = mp.sqrt(mpf(half * half))
        case(f"near-tangent-pair-1e-{digits}", "near-tangent", PLANTED,
             [(CLOCK, [guard(value)])], (0, [0]), 1,
             [(mpf(root) - distance, 0), (mpf(root) + distance, 0)])
    value = sub(power(sub("y0", 0.43), 2), 0.25e-12)
    case("near-tangent-pair-1e-6-of-state", "near-tangent", PLANTED,
         [(CLOCK, [guard(value)])], (0, [0]), 1,
         [(mpf(0.43) - mp.sqrt(mpf(0.25e-12)), 0), (mpf(0.43) + mp.sqrt(mpf(0.25e-12)), 0)])
    value = add(power(sub("t", 0.43), 2), 1e-14)
    case("near-tangent-miss", "near-tangent", PLANTED + "; the guard stays above 1e-14",
         [(CLOCK, [guard(value)])], (0, [0]), 1, [])
    value = power(sub("t", 0.43), 2)
    case("tangent-touch", "near-tangent", PLANTED + "; the guard touches 0 and has no other sign",
         [(CLOCK, [guard(value)])], (0, [0]), 1, [])
    value = power(sub("t", 0.43), 3)
    case("triple-root", "near-tangent", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         [(mpf(0.43), 0)])
    (y0, y1), angle, size = phase(0.5)
    level = float(mp.cos(mpf(5e-4)))
    top = mp.acos(mpf(level) / size)
    value = sub("y0", level)
    crossings = (multiples(PI / 2 - top - angle, 2 * PI, 20)
                 + multiples(PI / 2 + top - angle, 2 * PI, 20))
    case("near-tangent-pairs-of-oscillator", "near-tangent", PLANTED,
         [(OSCILLATOR, [guard(value)])], (0, [y0, y1]), 20, noted(sorted(crossings)),
         rtol=1e-14, atol=1e-14, tolerance=1e-7,
         why="the slope of the guard is 5e-4, which makes errors of the state 2000 times larger")


def clustered():
    roots = [0.5, 0.500001, 0.500003]
    value = mul(*[sub("t", root) for root in roots])
    case("cluster-of-three", "clustered", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         noted(map(mpf, roots)))
    roots = [0.3 + 10.0 ** -k for k in (6, 5, 4, 3, 2, 1)]
    value = mul(*[sub("y0", root) for root in roots])
    case("cluster-geometric", "clustered", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         noted(map(mpf, roots)))
    roots = [1e-10, 3e-10]
    value = mul(sub("t", roots[0]), sub("t", roots[1]))
    case("just-after-the-start", "clustered", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         noted(map(mpf, roots)), tolerance=1e-13,
         why="the roots are 2e-10 apart, and doubles there 1e-26")


def kinked():
    value = sub(call("abs", sub("t", 0.4)), 1e-3)
    case("kink-v", "kinked", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         [(mpf(0.4) - mpf(1e-3), 0), (mpf(0.4) + mpf(1e-3), 0)])
    value = sub(call("abs", call("sin", mul(50.0, "t"))), 0.01)
    shift = mp.asin(mpf(0.01)) / 50
    crossings = multiples(shift, PI / 50, 1) + multiples(-shift, PI / 50, 1)
    case("kink-abs-sine", "kinked", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         noted(sorted(crossings)), guard_scale=0.02)
    value = call("max", call("sin", mul(7.0, "t")), call("cos", mul(11.0, "t")))

    def larger(t):
        return max(mp.sin(7 * t), mp.cos(11 * t))

    case("kink-max", "kinked", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 10,
         noted(sign_changes(larger, 0, 10, 7919)), guard_scale=0.1)
    (y0, y1), angle, size = phase(0.7)
    value = sub(call("abs", "y0"), 1e-4)
    shift = mp.asin(mpf(1e-4) / size)
    crossings = multiples(shift - angle, PI, 20) + multiples(-shift - angle, PI, 20)
    case("kink-of-oscillator", "kinked", PLANTED, [(OSCILLATOR, [guard(value)])], (0, [y0, y1]),
         20, noted(sorted(crossings)))


def jumps():
    value = sub(call("floor", mul(3.0, "t")), 1.5)
    case("jump-floor", "jump", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 1,
         [(mpf(2) / 3, 0)])
    turns = mul(7.0, "t")
    value = sub(0.5, sub(turns, call("floor", turns)))
    case("jump-sawtooth", "jump", PLANTED + "; falls through 0 and jumps back over it",
         [(CLOCK, [guard(value)])], (0, [0]), 1.9, noted(mpf(k) / 14 for k in range(1, 27)),
         guard_scale=0.07)
    value = call("select", sub("t", 0.3), -1.0, 1.0)
    case("jump-step-ends", "jump", PLANTED, [(CLOCK, [guard(value, "below", terminal=True)])],
         (0, [0]), 1, [(mpf(0.3), 0)], outcome="guard")
    (y0, y1), angle, _ = phase(0.7)
    value = add(call("floor", mul(4.0, "y0")), 0.5)
    case("jump-of-oscillator", "jump", PLANTED, [(OSCILLATOR, [guard(value)])], (0, [y0, y1]), 20,
         noted(multiples(-angle, PI, 20)))


def poles():
    case("pole-tan", "pole", PLANTED, [(CLOCK, [guard(call("tan", "t"))])], (0.5, [0]), 20,
         noted(multiples(mpf(0), PI, 20, 0.5)))
    value = sub(div(1.0, sub("t", 0.3)), 2.0)
    case("pole-and-zero", "pole", PLANTED, [(CLOCK, [guard(value)])], (0, [0]), 2,
         [(mpf(0.3) + mpf(0.5), 0)])
    (y0, y1), angle, _ = phase(0.7)
    case("pole-of-oscillator", "pole", PLANTED, [(OSCILLATOR, [guard(div("y1", "y0"))])],
         (0, [y0, y1]), 20, noted(multiples(PI / 2 - angle, PI, 20)))


def table():
    omega = float(2 * PI * 100)
    stone = ["y1", -GRAVITY]
    value = sub("y0", mul(0.01, call("sin", mul(omega, "t"))))
    source = "a stone falls on a table that shakes at 100 Hz; closed form"
    for name, start in (("", 1.0), ("-from-0.05", 0.05)):

        def height(t):
            return start - mpf(GRAVITY) * t * t / 2 - mpf(0.01) * mp.sin(mpf(omega) * t)

        # The stone is where the table may be while its height is within 0.01 of 0.
        first, last = (mp.sqrt(2 * (mpf(start) + side * mpf(0.01)) / mpf(GRAVITY))
                       for side in (-1, 1))
        times = sign_changes(height, first - mpf(0.001), last + mpf(0.001), 20000)
        case(f"shaking-table{name}", "fast", source,
             [(stone, [guard(value, "below", terminal=True)])], (0, [start, 0]), 1,
             [(times[0], 0)], outcome="guard", guard_scale=1 / omega)
        case(f"shaking-table{name}-all", "fast", source + ", every crossing",
             [(stone, [guard(value)])], (0, [start, 0]), 1, noted(times), guard_scale=1 / omega)


def bounces(height, velocity, restitution, count):
    """Times of bounces and apexes of a ball from `height`, thrown with `velocity`."""
    g, h, v = mpf(GRAVITY), mpf(height), mpf(velocity)
    r = mpf(restitution)
    impact = mp.sqrt(v * v + 2 * g * h)
    time = (v + impact) / g
    floor, apex = [time], [v / g] if v > 0 else []
    for _ in range(count - 1):
        impact *= r
        apex.append(time + impact / g)
        time += 2 * impact / g
        floor.append(time)
    return floor, apex


def literature():
    ball = ["y1", -GRAVITY]
    bounce = guard("y0", "below", to=0, reset=[0.0, mul(-0.5, "y1")])
    floor, _ = bounces(1.5, 0, 0.5, 34)
    rest = mp.sqrt(2 * mpf(1.5) / mpf(GRAVITY)) * 3
    case("bouncing-ball-comes-to-rest", "zeno",
         "textbook; the bounces accumulate at sqrt(2h/g) (1 + r)/(1 - r)", [(ball, [bounce])],
         (0, [1.5, 0]), 10, noted(time for time in floor if rest - time > mpf("1e-7")),
         outcome="zeno", accumulation=rest)
    floor, apex = bounces(1.5, 2.0, 0.5, 12)
    end = (floor[9] + apex[10]) / 2
    events = [e for e in merged(noted(floor, 0), noted(apex, 1)) if e[0] < end]
    case("bouncing-ball-with-apex", "literature",
         "textbook; a second guard notes where the velocity falls through 0",
         [(ball, [bounce, guard("y1", "falling")])], (0, [1.5, 2.0]), end, events)
    balls = ["y1", -GRAVITY, "y3", -GRAVITY]
    first, _ = bounces(1.0, 0, 0.75, 12)
    second, _ = bounces(1.3, 1.0, 0.875, 12)
    end = min(first[9], second[9]) + mpf(0.01)
    events = [e for e in merged(noted(first, 0), noted(second, 1)) if e[0] < end]
    guards = [guard("y0", "below", to=0, reset=[0.0, mul(-0.75, "y1"), "y2", "y3"]),
              guard("y2", "below", to=0, reset=["y0", "y1", 0.0, mul(-0.875, "y3")])]
    case("two-bouncing-balls", "literature",
         "after the idea of Zhang, Yeddanapudi & Mosterman, Zero-crossing location and detection "
         "algorithms for hybrid system simulation, IFAC 2008; closed form",
         [(balls, guards)], (0, [1.0, 0, 1.3, 1.0]), end, events)

    # A ball bounces down the ramp x + y = 1: x' becomes -k y', and y' becomes k x'.
    keeps = 0.35
    g, vx, vy, time, times = mpf(GRAVITY), mpf(0.5), mpf(4), mpf(0), []
    for _ in range(8):
        lasts = 2 * (vx + vy) / g
        vx, vy, time = -mpf(keeps) * (vy - g * lasts), mpf(keeps) * vx, time + lasts
        times.append(time)
    end = (times[5] + times[6]) / 2
    # After a bounce, rounding decides whether x + y - 1 is exactly 0: flights start from a zero.
    bounce = guard(sub(add("y0", "y2"), 1.0), "below", to=0, zero_order=1,
                   reset=["y0", mul(-keeps, "y3"), sub(1.0, "y0"), mul(keeps, "y1")])
    case("ball-down-a-ramp", "literature",
         "after the idea of Shampine & Thompson, Event location for ordinary differential "
         "equations, Comput. Math. Appl. 39 (2000) 43-54; closed form",
         [(["y1", 0.0, "y3", -GRAVITY], [bounce])], (0, [0, 0.5, 1, 4]), end,
         noted(t for t in times if t < end))

    case("zero-at-the-start", "literature",
         "after the idea of Shampine & Thompson 2000: the guard is 0 at the start and leaves "
         "against its direction", [(OSCILLATOR, [guard("y0", "falling")])], (0, [0, 1]), 30,
         noted(multiples(PI, 2 * PI, 30)))

    # y' = 1 until 1, then y' = 1/2. Each mode watches the same place from its own side.
    up = guard(sub(1.0, "y0"), "below", to=1)
    down = guard(sub("y0", 1.0), "below", to=0, zero_order=1)
    case("discontinuity-sticking", "literature",
         "after the idea of Park & Barton, State event location in differential-algebraic models, "
         "ACM TOMACS 6 (1996) 137-165: the place of a switch must not switch back",
         [([1.0], [up]), ([0.5], [down])], (0, [1 / 3]), 4, [(1 - mpf(1 / 3), 0)])

    source = ("after the idea of Esposito, Kumar & Pappas, Accurate event detection for simulating "
              "hybrid systems, HSCC 2001: ")
    root = [call("neg", call("sqrt", "y0"))]
    case("undefined-field-behind-guard", "literature",
         source + "y' = -sqrt(y) is undefined shortly behind the guard",
         [(root, [guard(sub("y0", 1e-4), "below", terminal=True)])], (0, [1]), 5,
         [(2 * (1 - mp.sqrt(mpf(1e-4))), 0)], outcome="guard", tolerance=1e-8,
         why="the slope of the guard is 0.01, which makes errors of the state 100 times larger")
    case("undefined-guard-behind-zero", "literature",
         source + "guard and field are undefined shortly behind the guard's zero",
         [(root, [guard(sub(call("sqrt", "y0"), 0.01), "below", terminal=True)])], (0, [1]), 5,
         [(2 * (1 - mpf(0.01)), 0)], outcome="guard", tolerance=1e-8,
         why="the slope of y is 0.01 there, which makes errors of the state 100 times larger")


def kepler():
    e = mpf(0.5)
    p = 1 - e * e
    x, y = mpf(0), mpf(float(p))
    vx, vy = mpf(float(-1 / mp.sqrt(p))), mpf(float(e / mp.sqrt(p)))
    radius = mp.hypot(x, y)
    a = 1 / (2 / radius - vx * vx - vy * vy)
    radial = x * vx + y * vy
    # e cos E = 1 - r/a and e sin E = r·v/sqrt(a).
    sine, cosine = radial / mp.sqrt(a), 1 - radius / a
    anomaly = mp.atan2(sine, cosine) - sine
    pace = mp.sqrt(a) ** 3
    end = 100 * 2 * PI
    times = multiples(-anomaly * pace, PI * pace, end)
    r3 = power(call("sqrt", add(power("y0", 2), power("y1", 2))), 3)
    field = ["y2", "y3", call("neg", div("y0", r3)), call("neg", div("y1", r3))]
    value = add(mul("y0", "y2"), mul("y1", "y3"))
    case("kepler-apsides", "literature", "Kepler's ellipse with e = 0.5, 100 orbits; closed form",
         [(field, [guard(value)])], (0, [x, y, vx, vy]), end, noted(times),
         rtol=1e-14, atol=1e-14, tolerance=1e-7,
         why="errors of the energy change the period, so that errors of places grow with t^2")


# Series for the Arenstorf orbit.
def product(a, b, n):
    return mp.fdot(a[:n + 1], reversed(b[:n + 1]))


def arenstorf_series(state, mu, order):
    """Taylor coefficients of x and y of the restricted three-body problem."""
    rest = 1 - mu
    x, y, vx, vy = ([c] for c in state)
    squares, powers, offsets = ([], []), ([], []), (mu, -rest)
    shifted = ([], [])
    for n in range(order):
        for which in (0, 1):
            shifted[which].append(x[n] + (offsets[which] if n == 0 else 0))
            d, w = squares[which], powers[which]
            d.append(product(shifted[which], shifted[which], n) + product(y, y, n))
            # w = d^(-3/2), from w' d = -3/2 d' w.
            if n == 0:
                w.append(1 / mp.sqrt(d[0]) ** 3)
            else:
                total = sum((-mpf(3) / 2 * k - (n - k)) * d[k] * w[n - k] for k in range(1, n + 1))
                w.append(total / (n * d[0]))
        ax = (x[n] + 2 * vy[n] - rest * product(shifted[0], powers[0], n)
              - mu * product(shifted[1], powers[1], n))
        ay = (y[n] - 2 * vx[n] - rest * product(y, powers[0], n) - mu * product(y, powers[1], n))
        x.append(vx[n] / (n + 1))
        y.append(vy[n] / (n + 1))
        vx.append(ax / (n + 1))
        vy.append(ay / (n + 1))
    return x, y, vx, vy


def arenstorf():
    mu = 0.012277471
    order = 40
    state = [mpf(0.994), mpf(0), mpf(0), mpf(-2.00158510637908252)]

    def follow(state, end):
        time, crossings = mpf(0), []
        while time < end:
            series = arenstorf_series(state, mpf(mu), order)
            size = max(abs(series[0][order]), abs(series[1][order]))
            h = min((mpf(10) ** -36 / size) ** (mpf(1) / order), end - time)

            def at(c, s):
                return mp.polyval(c[::-1], s)

            crossings += [time + s for s in sign_changes(lambda s: at(series[1], s), 0, h, 16)]
            state = [at(c, h) for c in series]
            time += h
        return state, crossings

    state, _ = follow(state, mpf(0.5))
    state = [mpf(float(c)) for c in state]
    _, times = follow(state, mpf(16))
    x, y = "y0", "y1"
    rest = float(1 - mpf(mu))
    cubes = [power(call("sqrt", add(power(sub(x, shift), 2), power(y, 2))), 3)
             for shift in (-mu, rest)]
    fx = sub(sub(add(x, mul(2.0, "y3")), div(mul(rest, sub(x, -mu)), cubes[0])),
             div(mul(mu, sub(x, rest)), cubes[1]))
    fy = sub(sub(sub(y, mul(2.0, "y2")), div(mul(rest, y), cubes[0])), div(mul(mu, y), cubes[1]))
    case("arenstorf-axis", "literature",
         "Arenstorf's orbit as in Hairer, Norsett & Wanner, Solving Ordinary Differential "
         "Equations I, section II.0; crossings of the axis by Taylor series with 40 digits",
         [(["y2", "y3", fx, fy], [guard(y)])], (0, state), 16, noted(times),
         rtol=1e-14, atol=1e-14, tolerance=1e-6,
         why="passages near the Moon amplify errors of the state a million times")


def belt():
    slip = guard(sub(1.0, "y0"), "below", to=1)
    stick = guard(sub(0.5, "y1"), "below", to=0, reset=["y0", 0.5])
    mu = mpf(0.6)
    time, place, events = mpf(0), mpf(0), []
    while len(events) < 40:
        time += (1 - place) / mpf(0.5)
        events.append((time, 0))
        # From (1, 1/2) the velocity is again 1/2 on the other side of the centre 0.6.
        time += 2 * PI - 2 * mp.atan2(1 - mu, mpf(0.5))
        events.append((time, 0))
        place = 2 * mu - 1
    case("friction-belt", "literature", "textbook stick-slip of a mass on a belt; closed form",
         [(["y1", 0.0], [slip]), (["y1", sub(0.6, "y0")], [stick])], (0, 0, [0, 0.5]),
         events[-1][0] + 1, events, tolerance=1e-8,
         why="40 phases follow one another, and each adds its error")


def long():
    (y0, y1), angle, _ = phase(0.5)
    for count in (10**3, 10**5):
        times = multiples(-angle, PI, -angle + (count + mpf(0.5)) * PI)
        assert len(times) == count
        samples = [0, count // 3, count // 2, count - 1]
        case(f"long-run-1e{len(str(count)) - 1}", "long", PLANTED,
             [(OSCILLATOR, [guard("y0")])], (0, [y0, y1]), times[-1] + 1,
             [(index, times[index], 0) for index in samples], count=count, rtol=1e-13, atol=1e-13,
             tolerance=count * 3e-12,
             why="phase errors of about 1e-13 in each step add up over about 8 steps a crossing")


def offset():
    (y0, y1), angle, _ = phase(0.7)
    base = 10.0**9
    why = "doubles are 1.2e-7 apart there"
    case("offset-1e9-oscillator", "offset", PLANTED, [(OSCILLATOR, [guard("y0")])],
         (base, [y0, y1]), base + 20, noted(mpf(base) + t for t in multiples(-angle, PI, 20)),
         tolerance=3e-7, why=why)
    value = call("sin", add(mul(100.0, sub("t", base)), 0.5))
    case("offset-1e9-fast-guard", "offset", PLANTED, [(CLOCK, [guard(value)])], (base, [0]),
         base + 2, noted(mpf(base) + t for t in multiples(-mpf(0.5) / 100, PI / 100, 2)),
         tolerance=3e-7, why=why, guard_scale=0.01)


def scale():
    why = "1e-9 of the time scale"
    (y0, y1), angle, size = phase(0.2)
    for digits in (-150, 150):
        unit = float(f"1e{digits}")
        a, b, level = y0 * unit, y1 * unit, 0.5 * unit
        here, amplitude = mp.atan2(mpf(a), mpf(b)), mp.hypot(mpf(a), mpf(b))
        up = mp.asin(mpf(level) / amplitude)
        crossings = (multiples(up - here, 2 * PI, 20) + multiples(PI - up - here, 2 * PI, 20))
        case(f"scale-state-1e{digits}", "scale", PLANTED,
             [(OSCILLATOR, [guard(sub("y0", level))])], (0, [a, b]), 20,
             noted(sorted(crossings)), atol=1e-12 * unit)
    for digits in (-9, 9):
        unit = float(f"1e{digits}")
        omega = float(f"1e{-digits}")
        field = [mul(omega, "y1"), mul(-omega, "y0")]
        crossings = [t / mpf(omega) for t in multiples(-angle, PI, 20)]
        case(f"scale-time-1e{digits}", "scale", PLANTED, [(field, [guard("y0")])],
             (0, [y0, y1]), 20 * unit, noted(crossings), tolerance=1e-9 * unit, why=why)


def many():
    levels = [k / 33 for k in range(1, 33)]
    guards = [guard(sub("y0", level)) for level in levels]
    case("many-guards-32", "many-guards", PLANTED, [(CLOCK, guards)], (0, [0]), 1,
         [(mpf(level), k) for k, level in enumerate(levels)])
    guards = [guard(mul(factor, sub(0.5, "t")), "falling") for factor in (1.0, 3.0, 1e-3)]
    guards.append(guard(sub(0.75, "t"), "falling"))
    case("guards-together", "many-guards", PLANTED + "; three guards fall at one place",
         [(CLOCK, guards)], (0, [0]), 1,
         [(mpf(0.5), 0), (mpf(0.5), 1), (mpf(0.5), 2), (mpf(0.75), 3)])


def relays():
    down, up = [-1.0], [1.0]
    case("relay-without-hysteresis", "chatter",
         "textbook; both modes lead back to 0, where no solution continues without sliding",
         [(down, [guard("y0", "below", to=1)]), (up, [guard(call("neg", "y0"), "below", to=0)])],
         (0, [1]), 3, [(mpf(1), 0)], outcome="stuck", accumulation=1)
    h, gain = 1e-3, 1.0
    on = guard(sub(h, "y0"), "below", to=1)
    off = guard(add(h, "y0"), "below", to=0)
    first = mp.log(mpf(gain) / (mpf(gain) - mpf(h)))
    half = mp.log((mpf(gain) + mpf(h)) / (mpf(gain) - mpf(h)))
    times = [first + k * half for k in range(500)]
    case("relay-with-hysteresis", "chatter", "textbook; a relay with hysteresis 1e-3; closed form",
         [([sub(gain, "y0")], [on]), ([sub(-gain, "y0")], [off])], (0, [0]),
         times[-1] + half / 2, noted(times))


def main():
    for family in (steep, fast, tangent, clustered, kinked, jumps, poles, table, literature, kepler,
                   arenstorf, belt, long, offset, scale, many, relays):
        family()
    assert len({it["name"] for it in CASES}) == len(CASES)
    lines = ",\n".join(json.dumps(it, ensure_ascii=False) for it in CASES)
    Path(__file__).with_name("cases.json").write_text(f"[\n{lines}\n]\n")
    print(len(CASES), "cases")


if __name__ == "__main__":
    main()
