"""The damping from which contacts with Hertz' force and linear damping never end; needs mpmath.

x'' = -x^{3/2} - a x', x(0) = 0, x'(0) = 1. With x = u^2 and dt = 2u ds: u' = v, v' = -2u(u^3 + a v).
The trajectory that arrives at u = 0 along v = -a u^2 separates contacts that end from others. With
a = 1 it is followed backwards from its series, to u = 0 and a speed V. With x = L X and t = T t' the
equation keeps its form if L = T^-4, with a = T, and the speed is 1 if T = V^{-1/5}.
"""

from mpmath import mp, mpf

mp.dps = 30
ORDER = 60


def separatrix() -> list[mpf]:
    """Coefficients of v as a series in u, by v dv/du + 2uv + 2u^4 = 0."""
    c = [mpf(0)] * (ORDER + 1)
    c[2] = mpf(-1)
    for k in range(3, ORDER + 1):
        known = sum(i * c[i] * c[k + 2 - i] for i in range(3, k))
        c[k] = -(known + (2 if k == 3 else 0)) / (2 * c[2] + k * c[2] + 2)
    return c


def step(u: mpf, v: mpf, order: int = 40) -> tuple[list[mpf], list[mpf]]:
    """Taylor series of u and v backwards in s."""
    series_u, series_v = [u], [v]

    def product(a: list[mpf], b: list[mpf], k: int) -> mpf:
        return sum(a[i] * b[k - i] for i in range(k + 1))

    for k in range(order):
        squares = [product(series_u, series_u, j) for j in range(k + 1)]
        force = product(squares, squares, k) + product(series_u, series_v, k)
        series_u.append(-series_v[k] / (k + 1))
        series_v.append(2 * force / (k + 1))
    return series_u, series_v


def value(series: list[mpf], at: mpf) -> mpf:
    return sum(term * at**i for i, term in enumerate(series))


h = mpf(1) / 50
u = mpf(1) / 20
v = value(separatrix(), u)
while True:
    series_u, series_v = step(u, v)
    if value(series_u, h) < 0:
        end = mp.findroot(lambda s: value(series_u, s), h / 2)
        print(value(series_v, end) ** (-mpf(1) / 5))
        break
    u, v = value(series_u, h), value(series_v, h)
