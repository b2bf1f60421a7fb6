"""Checks of the statements on which the exact solution with damping decides.

The statements and their proofs are in crates/exact/PROOFS.md. Here every identity is checked by
algebra over the rational numbers, and every sign of a polynomial by counting its roots. Only the section COMPUTED uses floating-point numbers: it is not a proof.

Each statement is one line of output. A statement that does not hold ends the program.

Run:  python damped_decisions.py
"""

from mpmath import mp, mpf
from sympy import (
    Poly, QQ, Rational, S, cancel, diff, expand, factor_list, limit, oo, rem, resultant, simplify,
    sqrt, symbols, together,
)

p, k = symbols("p k")


def holds(statement, truth):
    assert truth, statement
    print("ok ", statement)


def zero(expression):
    return simplify(expression) == 0


def rate(f):
    """The derivative in T = t/a along the flow p' = -p^2 - k(1 + p), k' = pk/2."""
    return diff(f, p) * (-p**2 - k * (1 + p)) + diff(f, k) * p * k / 2


def keeps_sign(f, low, high, sign):
    """Whether the polynomial f has the sign everywhere in the open interval."""
    f = Poly(f, p, domain=QQ)
    # Zeros at the ends themselves do not count.
    for end in (low, high):
        while end.is_finite and f.eval(end) == 0:
            f = f.quo(Poly(p - end, p, domain=QQ))
            sign = sign if end == low else -sign
    bounds = [end if end.is_finite else None for end in (low, high)]
    inside = (low + high) / 2 if high.is_finite else low + 1
    return f.count_roots(*bounds) == 0 and f.eval(inside) * sign > 0


print("THE MOTION")
a, u, v, s, w, kappa, alpha, beta, q0 = symbols("a u v s w kappa alpha beta q0", positive=True)


def along_time(f, q, others=()):
    """d/dt = (1/2u) d/ds."""
    pairs = [(u, v), (v, -2 * u**2 * q), *others]
    return sum(diff(f, x) * slope for x, slope in pairs) / (2 * u)


q = u**2 + a * v
force = u * q
p_here, k_here = a * v / u**2, a**2 * u
flow = {p: p_here, k: k_here}
holds("dp/dT = -p^2 - k(1 + p)",
      zero(a * along_time(p_here, q) + p_here**2 + k_here * (1 + p_here)))
holds("dk/dT = pk/2", zero(a * along_time(k_here, q) - p_here * k_here / 2))
holds("a^6 F = k^3 (1 + p)", zero((k**3 * (1 + p)).subs(flow) - a**6 * force))
holds("p k^2 = a^5 v, which is a^5 at the start", zero((p * k**2).subs(flow) - a**5 * v))
general = alpha * u**2 + beta * v
rate_here = v * general / (2 * u) + u * (alpha * v - beta * u * general)
holds("dF/dt = vq/(2u) + u(alpha v - beta u q)", zero(along_time(u * general, general) - rate_here))
bend = (
    2 * alpha * v**2
    - general * (u * general + 3 * beta * u * v + 2 * alpha * u**3)
    - v**2 * general / (2 * u**2)
    + 2 * beta * u**3 * (beta * u * general - alpha * v)
)
holds("2u d2F/dt2 as in PROOFS.md", zero(along_time(rate_here, general) - bend / (2 * u)))
at_end = along_time(force, q).subs(a, -(u**2) / v)
holds("at the end of contact, q = 0, dF/dt = uv", zero(at_end - u * v))

t = symbols("t", positive=True)
tau, omega, L0, L1, L2, y0, y1 = symbols("tau omega L0 L1 L2 y0 y1")
# Second-order polynomials in t around any moment: L'' = L2, y'' = -kappa y.
limit_here = L0 + L1 * t + L2 * t**2 / 2
spring = y0 + y1 * t - kappa * y0 * t**2 / 2
turning = limit_here * diff(spring, t) - diff(limit_here, t) * spring
holds("stick: dW/dt = -q_y P", zero(diff(turning, t).subs(t, 0) + y0 * (kappa * L0 + L2)))
holds("stick: dR/dt = W/L^2", zero((diff(spring / limit_here, t) - turning / limit_here**2)))

# Without damping K = -F''/F has a short form.
undamped = -along_time(along_time(u**3, u**2), u**2) / u**3
holds("without damping K = (3/2)u - (3/4)v^2/u^4", zero(undamped - 3 * u / 2 + 3 * v**2 / u**4 / 4))

print("1. ONE MAXIMUM OF L")
k1 = p * (3 + p) / (2 * (1 + p))
log_rate = cancel(rate(k**3 * (1 + p)) / (k**3 * (1 + p)))
holds("d ln L/dT = k1(p) - k, k1 = p(3 + p)/(2(1 + p))", zero(log_rate - k1 + k))
holds("dk1/dp = (p^2 + 2p + 3)/(2(1 + p)^2)",
      zero(diff(k1, p) - (p**2 + 2 * p + 3) / (2 * (1 + p)**2)))
holds("dk1/dp > 0", keeps_sign(p**2 + 2 * p + 3, S(-1), oo, 1))
holds("k1 <= 0 for -1 < p <= 0", keeps_sign(p * (3 + p), S(-1), S(0), -1) and k1.subs(p, 0) == 0)
holds("k1 rises from 0 to infinity for p > 0", limit(k1, p, oo) == oo)

print("2. K AND ITS SLOPE")
K = -(k**2) + k * (4 * p**2 + 9 * p + 3) / (2 * (1 + p)) + p**2 * (p - 3) / (4 * (1 + p))
holds("a^2 K = -F''/F", zero(rate(rate(k**3 * (1 + p))) / (k**3 * (1 + p)) + K))
A = 4 * (p + 1) * (3 * p**2 + 5 * p + 3)
B = p * (6 * p**3 + 5 * p**2 - 6 * p - 9)
C = 2 * p**3 * (p**2 - 3)
M = A * k**2 + B * k + C
holds("4(1 + p)^2 a^2 dK/dT = -(A k^2 + B k + C)", zero(4 * (1 + p)**2 * rate(K) + M))
near_one = Rational(17, 10)
holds("17/10 < sqrt(3) < 7/4", near_one**2 < 3 < Rational(7, 4)**2)
holds("A > 0 for p > -1", keeps_sign(A, S(-1), oo, 1))
holds("B > 0 for -1 < p < 0", keeps_sign(B, S(-1), S(0), 1))
holds("B > 0 for p > 17/10", keeps_sign(B, near_one, oo, 1))
holds("C > 0 for -1 < p < 0", keeps_sign(C, S(-1), S(0), 1))
holds("C has no zeros but 0 and +-sqrt(3)", factor_list(C)[1] == [(p, 3), (p**2 - 3, 1)])
holds("C < 0 for 0 < p < sqrt(3), C > 0 beyond", C.subs(p, 1) < 0 < C.subs(p, 2))
holds("at p = 0, M = A k^2 with A > 0", zero(M.subs(p, 0) - 12 * k**2))
# With p k^2 = a^5 v, k goes to 0 as 1/sqrt(p) at the start.
c, x = symbols("c x", positive=True)
holds("K -> +oo at the start", limit(K.subs(k, c / x).subs(p, x**2), x, oo) == oo)
holds("K -> -oo at the end", limit(K.subs(k, c).subs(p, x - 1), x, 0, "+") == -oo)

print("3. WHERE TRAJECTORIES CROSS THE CURVE M = 0")
N = expand(rate(M))
square = 3 * p**2 + 5 * p + 3
E = 120*p**7 + 548*p**6 + 1058*p**5 + 884*p**4 + 14*p**3 - 537*p**2 - 378*p - 81
G = 2 * p**2 * (30*p**6 + 96*p**5 + 102*p**4 - 58*p**3 - 171*p**2 - 126*p - 27)
reduced = rem(Poly(N, k), Poly(M, k)).as_expr()
expected = -3 * p * (p + 1) * (E * k + G) / (4 * square**2)
holds("on M = 0, dM/dT = -3p(p + 1)(E k + G)/(4(3p^2 + 5p + 3)^2)", zero(reduced - expected))
nonic = (
    800*p**9 + 3600*p**8 + 4600*p**7 - 5062*p**6 - 19926*p**5 - 16680*p**4 + 4575*p**3 + 15363*p**2
    + 8829*p + 1701
)
product = expand(resultant(M, N, k))
holds("the resultant is 36 p^6 (p + 1)^6 Z(p)",
      expand(36 * p**6 * (p + 1)**6 * nonic - product) == 0)
Z = Poly(nonic, p, domain=QQ)
holds("Z has two zeros in (0, 7/4)", Z.count_roots(0, Rational(7, 4)) == 2)
star = (Rational(9692288274, 10**10), Rational(9692288275, 10**10))
other = (Rational(15916, 10**4), Rational(15917, 10**4))
holds("one is p* = 0.9692288274...", Z.count_roots(*star) == 1)
holds("the other is 1.5916..., below sqrt(3)", Z.count_roots(*other) == 1 and other[1]**2 < 3)
holds("E and G have no common zero for p > 0", resultant(E, G / p**2, p) != 0)
holds("at 1.5916... E > 0 and G > 0: the common k is negative", keeps_sign(E, *other, 1)
      and keeps_sign(G, *other, 1))
holds("at p* E > 0 and G < 0: the common k is positive", keeps_sign(E, *star, 1)
      and keeps_sign(G, *star, -1))


def turning_sign(place):
    """The sign of E k + G at k+ (place), exactly: M(k) < 0 means k < k+ for k > 0."""
    e, g = E.subs(p, place), G.subs(p, place)
    assert e != 0
    common = -g / e
    before = common < 0 or M.subs({p: place, k: common}) < 0
    return (1 if e > 0 else -1) * (1 if before else -1)


holds("dM/dT > 0 on the curve at p = 1/100, 1/2 and 9/10: K stops rising",
      all(turning_sign(Rational(n, 100)) < 0 for n in (1, 50, 90)))
holds("dM/dT < 0 on the curve at p = 1, 3/2 and 17/10: K starts to rise",
      all(turning_sign(Rational(n, 10)) > 0 for n in (10, 15, 17)))
# The one trajectory that touches the curve at p*: the sign of d2M/dT2 there.
bending = together(rate(N).subs(k, -G / E))
top, bottom = bending.as_numer_denom()
holds("where p = p* and dM/dT = 0, d2M/dT2 > 0: M >= 0 around the touch",
      keeps_sign(top * bottom, *star, 1))

print("6. THE FIRST INSTANTS UNDER A WEAK DAMPING")
ratio = sqrt(t) / (t + a)
top_slope = (a - t) / (2 * sqrt(t) * (t + a)**2)
holds("sqrt(t)/(t + a) rises until t = a and falls from there", zero(diff(ratio, t) - top_slope))
holds("its top is 1/(2 sqrt(a))", zero(ratio.subs(t, a) - 1 / (2 * sqrt(a))))
holds("a^2 K -> p^2(p - 3)/(4(1 + p)) as k -> 0, least at p = sqrt(3)",
      zero(diff(K.subs(k, 0), p).subs(p, sqrt(3))))
holds("K_min -> -(6 sqrt(3) - 9)/(4 a^2) as a -> 0",
      zero(K.subs({k: 0, p: sqrt(3)}) + (6 * sqrt(3) - 9) / 4))

print("COMPUTED")


def step(u0, v0, damping, h, number, orders):
    """The Taylor series of u' = v, v' = -2u^2(u^2 + a v), summed at h."""
    us, vs, squares, sums, products = [u0], [v0], [], [], []
    for n in range(orders):
        squares.append(sum((us[j] * us[n - j] for j in range(n + 1)), number(0)))
        sums.append(squares[n] + damping * vs[n])
        products.append(sum((squares[j] * sums[n - j] for j in range(n + 1)), number(0)))
        us.append(vs[n] / (n + 1))
        vs.append(-2 * products[n] / (n + 1))
    total_u, total_v = number(0), number(0)
    for term_u, term_v in zip(reversed(us), reversed(vs)):
        total_u, total_v = total_u * h + term_u, total_v * h + term_v
    return total_u, total_v


def damping_through(place, height, number=float, orders=20, width=0.125):
    """The damping whose trajectory passes (p, k): followed back to u = 0, with u = 1 at the place.

    In these units the damping is sqrt(k). As p k^2 = a^5 v, the damping wanted is sqrt(k) v0^(1/5).
    """
    b = height ** number("0.5")
    here, speed = number(1), place / b
    for _ in range(1000):
        ahead = -number(width)
        if here < speed * number(width):
            ahead = -here / speed
        here, speed = step(here, speed, b, ahead, number, orders)
        if abs(here) < number(10) ** (-mp.dps if number is mpf else -15):
            return b * speed ** (number(1) / 5)
    raise AssertionError("the start was not reached")


def numbers(place):
    return (
        4 * (place + 1) * (3 * place**2 + 5 * place + 3),
        place * (6 * place**3 + 5 * place**2 - 6 * place - 9),
        2 * place**3 * (place**2 - 3),
    )


def on_curve(place):
    """k+ at p."""
    square, linear, constant = numbers(place)
    root = (linear * linear - 4 * square * constant) ** type(place)("0.5")
    return -2 * constant / (linear + root) if linear > 0 else (root - linear) / (2 * square)


def scaled_k(place, height):
    return (
        -height * height
        + height * (4 * place**2 + 9 * place + 3) / (2 * (1 + place))
        + place**2 * (place - 3) / (4 * (1 + place))
    )


def extreme(place, number=float, orders=20, width=0.125):
    """The damping for which K is stationary at p, and K there."""
    height = on_curve(place)
    damping = damping_through(place, height, number, orders, width)
    return damping, scaled_k(place, height) / damping**2


mp.dps = 30
exact_star = mpf(str(Z.refine_root(*star, eps=Rational(1, 10**34))[0].evalf(34)))
largest, inflection = extreme(exact_star, mpf, 40)
print("    p* =", mp.nstr(exact_star, 16))
print("    K has extremes for a below", mp.nstr(largest, 16))
print("    there both tend to", mp.nstr(inflection, 10))
holds("K has extremes for a < 0.58775875568488...",
      mpf("0.58775875568488") < largest < mpf("0.58775875568489"))

count = 400
# From p = 0 to p* along the maxima, from sqrt(3) to p* along the minima: this covers all dampings.
maxima = [extreme(float(exact_star) * (i / count) ** 3) for i in range(1, count)]
minima = [extreme(3**0.5 - (3**0.5 - float(exact_star)) * i / count) for i in range(1, count)]
dampings = [damping for damping, _ in maxima]
holds(f"a rises with p along the maxima, from {dampings[0]:.5f} to {dampings[-1]:.6f}",
      all(low < high for low, high in zip(dampings, dampings[1:])))
holds("a rises as p falls along the minima",
      all(low < high for (low, _), (high, _) in zip(minima, minima[1:])))
holds("K_max -> (3/2)(5/4)^(1/5) = 1.5684... for a -> 0",
      abs(maxima[0][1] - 1.5 * 1.25**0.2) < 1e-3)
least = min(range(len(maxima)), key=lambda i: maxima[i][1])
holds(f"K_max falls to {maxima[least][1]:.4f} at a = {dampings[least]:.2f} and rises from there",
      all(maxima[i][1] > maxima[i + 1][1] for i in range(least))
      and all(maxima[i][1] < maxima[i + 1][1] for i in range(least, len(maxima) - 1)))
holds("every K_max is below its limit at the largest a, 1.8620002..., below 1.8622",
      all(value < inflection for _, value in maxima) and mpf("1.862") < inflection < mpf("1.8621"))
positive = next(damping for damping, value in minima if value > 0)
holds(f"K_min rises with a, and is positive from about a = {positive:.3f} on",
      all(low < high for (_, low), (_, high) in zip(minima, minima[1:])))


def forward(damping):
    """The extremes of K from a contact followed from its start, in the order of time."""
    here, speed, inside, found = 0.0, 1.0, False, []
    h = min(0.02, 0.05 * damping**0.5)

    def state(pair):
        return damping * pair[1] / pair[0] ** 2, damping**2 * pair[0]

    def rises(pair):
        square, linear, constant = numbers(state(pair)[0])
        height = state(pair)[1]
        return square * height**2 + linear * height + constant < 0

    for _ in range(100000):
        after = step(here, speed, damping, h, float, 12)
        if after[1] < 0:
            return found
        if rises(after) != inside:
            low, high = 0.0, h
            for _ in range(60):
                middle = (low + high) / 2
                if rises(step(here, speed, damping, middle, float, 12)) == inside:
                    low = middle
                else:
                    high = middle
            found.append(scaled_k(*state(step(here, speed, damping, low, float, 12))) / damping**2)
            inside = not inside
        here, speed = after
    raise AssertionError("v did not fall to 0")


for damping in (0.001, 0.01, 0.05, 0.1, 0.2, 0.228, 0.25, 0.3, 0.4, 0.5, 0.55, 0.58):
    found = forward(damping)
    holds(f"followed forwards, a = {damping}: K_min = {found[0]:.6f}, K_max = {found[1]:.6f}",
          len(found) == 2 and found[0] < found[1] < 1.8622)
holds("followed forwards, a = 0.59 and 2: K has no extremes", forward(0.59) == forward(2.0) == [])
