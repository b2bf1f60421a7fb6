"""Contact time and normal restitution of damped contacts with 40 digits, whatever the damping.

The normal motion does not feel the tangential one, so both depend on the damping a alone. The Taylor
series of u and q = v + u²/a in s, with dt = 2u ds, have the recurrences of

    u' = q − u²/a     q' = −2a u² q + 2u (q − u²/a)/a     t' = 2u,

and contact ends where q falls through 0: there the force u a q does, and q is never the difference
of nearly equal numbers.

Run:  python normal_motion.py > normal_motion.json
"""

import json

from mpmath import mp, mpf

mp.dps = 60
DEGREE = 60
TOLERANCE = mpf(10) ** -50


def product(a, b, k):
    return sum(a[j] * b[k - j] for j in range(k + 1))


def series(u0, q0, a):
    u, q, t = [u0], [q0], [mpf(0)]
    uu, v, uv, uuq = [], [], [], []
    for k in range(DEGREE):
        uu.append(product(u, u, k))
        v.append(q[k] - uu[k] / a)
        uv.append(product(u, v, k))
        uuq.append(product(uu, q, k))
        u.append(v[k] / (k + 1))
        q.append((2 * uv[k] / a - 2 * a * uuq[k]) / (k + 1))
        t.append(2 * u[k] / (k + 1))
    return u, q, t


def value(terms, h):
    total = mpf(0)
    for term in reversed(terms):
        total = total * h + term
    return total


def normal_motion(a):
    u, q, t = mpf(0), mpf(1), mpf(0)
    while True:
        us, qs, ts = series(u, q, a)
        # q may be much smaller than u: each has its own scale.
        def reach(terms, size):
            last = max(abs(term) for term in terms[-4:])
            return (TOLERANCE * size / last) ** (mpf(1) / DEGREE) if last else mpf(1)
        scale_q = max(abs(q), mpf(1) / a**3)
        h = min(reach(us, max(abs(u), mpf(1) / (1 + a))), reach(qs, scale_q))

        def touches(h):
            # Without much damping q rises again where u is negative.
            return value(qs, h) > 0 and value(us, h) >= 0

        if touches(h):
            u, q, t = value(us, h), value(qs, h), t + value(ts, h)
            continue
        low, high = mpf(0), h
        for _ in range(220):
            middle = (low + high) / 2
            low, high = (middle, high) if touches(middle) else (low, middle)
        u = value(us, low)
        return t + value(ts, low), u * u / a


rows = []
for exponent in range(-24, 25):
    a = float(10 ** (exponent / 6))
    time, eps_n = normal_motion(mpf(a))
    rows.append({"damping": a, "contact_time": mp.nstr(time, 25), "eps_n": mp.nstr(eps_n, 25)})
about = "Contact time and normal restitution for damping 1e-4 to 1e4, to 25 digits"
print(json.dumps({"about": about, "cases": rows}, indent=1))
