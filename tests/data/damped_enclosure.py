"""Enclosures of the normal motion with damping, for whole intervals of r = sqrt(a).

damped_trajectory_bound.py uses them. Everything here is ball arithmetic (Arb). A *model* is a
polynomial in x with ball coefficients, where r = middle + x half width. It contains a function of x
if at every x in [-1, 1] the function has the value of the polynomial for some choice of
coefficients in the balls. Sums and products of models are models, and a coefficient that is left
out goes into the ball of the constant one.
"""

from flint import arb, arb_mat, arb_poly, arb_series, ctx

DEGREE = 44  # of the models in x
TERMS = 40  # of the series in s
RADII = (2.5, 1.8, 1.3, 1, 0.75, 0.55, 0.4, 0.3)  # at which tails are bounded
CELLS = 8  # parts of an interval on which models are bounded
LONGEST_TAIL = 1e-36  # of a series; longer steps are halved
SLACK = 1 + 1e-9  # more than what rounding does to a sum of positive numbers
BEYOND = 1 + arb(2) ** -30  # a rounded r may be beyond the interval

ctx.prec = 200
ctx.cap = DEGREE + 1


def radius(ball_radius):
    return arb(0, ball_radius.upper())


def norm(p):
    return sum((abs(c) for c in p.coeffs()), arb(0)).upper()


def cut(p):
    if p.length() <= DEGREE + 1:
        return p
    c = p.coeffs()
    c[0] += radius(sum((abs(z) for z in c[DEGREE + 1:]), arb(0)))
    return arb_poly(c[:DEGREE + 1])


def wider(p, error):
    return p + arb_poly([radius(error)])


def thin(p):
    """The middle of a model, and the largest distance from it."""
    c = p.coeffs()
    return arb_poly([z.mid() for z in c]), sum((z.rad() for z in c), arb(0)).upper()


def least(p):
    """A lower bound of |p|."""
    return min((p(cell).abs_lower() for cell in cells()), key=float)


def cells():
    return [arb(arb(2 * i + 1) / CELLS - 1, arb(1) / CELLS) for i in range(CELLS)]


def size(ball):
    return float(abs(ball).upper()) * SLACK


class Around:
    """The series in s around a place, for a whole interval of r."""

    def __init__(self, u, v, alpha, beta):
        self.alpha, self.beta = alpha, beta
        self.u, self.v, self.q = [u], [v], []
        squares = []
        for n in range(TERMS + 1):
            twice = sum((self.u[j] * self.u[n - j] for j in range((n + 1) // 2)), arb_poly([0]))
            middle = self.u[n // 2] * self.u[n // 2] if n % 2 == 0 else arb_poly([0])
            squares.append(cut(2 * twice + middle))
            self.q.append(cut(alpha * squares[n] + beta * self.v[n]))
            if n == TERMS:
                break
            product = sum((squares[j] * self.q[n - j] for j in range(n + 1)), arb_poly([0]))
            self.u.append(self.v[n] * (arb(1) / (n + 1)))
            self.v.append(cut(product) * (arb(-2) / (n + 1)))
        self.norms = [[norm(c) for c in series] for series in (self.u, self.v)]
        self.tails = [tail for tail in map(self.tail_within, RADII) if tail]
        self.known = {}

    def tail_within(self, rho):
        """Norms with weights rho^n of the terms beyond TERMS, if the fixed point is proved."""
        rho, order = arb(rho), TERMS + 1
        a, b = norm(self.alpha), norm(self.beta)
        u, v = (arb_poly([c * rho**n for n, c in enumerate(series)]) for series in self.norms)
        square = u * u
        known = sum((square * (a * square + b * v)).coeffs()[TERMS:], arb(0))
        all_u, all_v = u(arb(1)), v(arb(1))
        inner = all_u**2 * (a * all_u**2 + b * all_v)

        def image(eu, ev):
            changed = (all_u + eu) ** 2 * (a * (all_u + eu) ** 2 + b * (all_v + ev)) - inner
            rate = 2 * (known + changed)
            return (rho / order * (v[TERMS] + ev)).upper(), (rho / order * rate).upper()

        eu = ev = arb(0)
        for _ in range(30):
            eu, ev = image(eu, ev)
        eu, ev = 2 * eu, 2 * ev
        found = image(eu, ev)
        if not (found[0] <= eu and found[1] <= ev):
            return None
        eq = a * (sum(square.coeffs()[order:], arb(0)) + 2 * all_u * eu + eu**2) + b * ev
        return rho, eu, ev, eq

    def tail(self, h):
        """Bounds of the terms beyond TERMS in U, V and Q, at distances up to h."""
        choices = [[e * (h / rho) ** (TERMS + 1) for e in rest]
                   for rho, *rest in self.tails if rho > h]
        return min(choices, key=lambda choice: float(sum(choice)))

    def moved(self, h):
        """Models of U, V and the change of T at h, a number or a model."""
        most = norm(h) if isinstance(h, arb_poly) else abs(h)
        eu, ev, _ = self.tail(most)
        t = [c * (arb(2) / (n + 1)) for n, c in enumerate(self.u)]
        u, v, t = (self.sum(c, h) for c in (self.u, self.v, t))
        return wider(u, eu), wider(v, ev), wider(cut(t * h), 2 * most * eu)

    def q_near(self, h):
        """A model of Q at a distance h, a float."""
        if h not in self.known:
            self.known[h] = wider(self.sum(self.q, arb(h)), self.tail(abs(arb(h)))[2])
        return self.known[h]

    @staticmethod
    def sum(series, h):
        total = arb_poly([0])
        for c in reversed(series):
            total = cut(total * h + c)
        return total

    def carried(self, errors, h):
        """Bounds of |U - U'| and |V - V'| at h for a solution that starts with `errors`."""
        size = abs(h)
        change = [sum((c * size**n for n, c in enumerate(series) if n), self.tail(size)[i])
                  for i, series in enumerate(self.norms)]
        small = arb(2) ** -60  # more than any error
        most_u, most_v = (series[0] + c + small for series, c in zip(self.norms, change))
        first = self.u[0].coeffs() or [arb(0)]
        low = (first[0] - norm(self.u[0] - arb_poly([first[0]])) - change[0] - small).lower()
        least_u = low if low > 0 else arb(0)
        a, b = norm(self.alpha), norm(self.beta)
        least_b = least(self.beta)
        own = -2 * least_b * least_u**2 if h > 0 else 2 * b * most_u**2
        other = 8 * a * most_u**3 + 4 * b * most_u * most_v
        grown = (size * arb_mat([[0, 1], [other, own]])).exp()
        assert max(map(float, errors)) < float(small) / 100
        rows = ((abs(grown[i, 0]), abs(grown[i, 1])) for i in (0, 1))
        return [(first * errors[0] + second * errors[1]).upper() for first, second in rows]


def step(around, errors, h):
    """The middle of the state at h, its errors, and the change of T with its error."""
    if float(sum(around.tail(abs(h)))) > LONGEST_TAIL:
        u, v, errors, (t, et) = step(around, errors, h / 2)
        u, v, errors, (rest, more) = step(Around(u, v, around.alpha, around.beta), errors, h / 2)
        return u, v, errors, (t + rest, et + more)
    u, v, t = around.moved(h)
    carried = around.carried(errors, h)
    (u, eu), (v, ev), (t, et) = thin(u), thin(v), thin(t)
    most = max(carried[0], errors[0], key=float)
    return u, v, [carried[0] + eu, carried[1] + ev], (t, et + 2 * abs(h) * most)


class Contact:
    """The contact on one interval of r: the exact rows of the table, and series at its nodes."""

    def __init__(self, interval, wide, counts):
        self.strong = interval > 8
        octave, part = divmod(interval - 1, 4)
        low, width = ((0.0, 0.25) if interval == 0 else
                      (2.0**octave * (4 + part) / 16, 2.0**octave / 16))
        self.high, self.half_width = low + width, width / 2
        spacing, self.middle = (0.25, 1.0) if self.strong else (0.2, 1.2)
        self.places = [[index * spacing for index in range(counts[0] + 1)],
                       [min(index, wide) * 0.5 + (index - min(index, wide)) * spacing
                        for index in range(counts[1] + 1)]]
        self.r = arb_poly([arb(low) + width / 2, arb(width) / 2 * BEYOND])
        self.alpha, self.beta = (self.spring(), arb_poly([1])) if self.strong else (
            arb_poly([1]), self.r * self.r)
        self.rows, self.nodes = [], [[], []]
        self.forwards(spacing, counts[0])
        self.backwards(counts[1])

    def spring(self):
        """alpha = r^(-10/3), by the binomial series."""
        middle, z, power = self.r[0], self.r[1] / self.r[0], -arb(10) / 3
        c = [middle**power]
        for k in range(DEGREE):
            c.append(c[-1] * (power - k) / (k + 1) * z)
        ratio = z * (DEGREE - power) / (DEGREE + 1)  # later ratios are smaller
        return wider(arb_poly(c), abs(c[-1]) * ratio / (1 - ratio))

    def around(self, u, v):
        return Around(u, v, self.alpha, self.beta)

    def row(self, around, change, duration, errors):
        """[U, Q, |change of V|, |change of T|] with errors, for the node that is added."""
        q, more = thin(around.q[0])
        more += norm(self.beta) * errors[1] + 3 * norm(self.alpha * around.u[0]) * errors[0]
        return [(around.u[0], errors[0]), (q, more), change, duration]

    def forwards(self, spacing, count):
        u, v, errors, time = arb_poly([0]), arb_poly([1]), [arb(0), arb(0)], []
        for index in range(1000):
            around, here = self.around(u, v), arb(index * spacing)
            width = arb((index + 1) * spacing) - here
            if not self.before_end(around, width):
                break
            after_u, after_v, after, dt = step(around, errors, width)
            time.append(dt)
            if index < count:
                self.nodes[0].append(around)
                change = (v - after_v, errors[1] + after[1])
                self.rows.append(self.row(around, change, dt, errors))
            u, v, errors = after_u, after_v, after
        # The end for the middle of the interval, and from there for all of it.
        near, far = arb(0), width
        for _ in range(60):
            part = ((near + far) / 2).mid()
            near, far = (part, far) if self.before_end(around, part) else (near, part)
        u, v, errors, dt = step(around, errors, near)
        time.append(dt)
        around, h = self.around(u, v), arb_poly([0])
        for _ in range(9):
            guard, slope = self.end_guard(around, h)[:2]
            change = arb_series(guard.coeffs()) / arb_series(slope.coeffs())
            h = thin(cut(h - arb_poly(change.coeffs())))[0]
        guard, slope, (u, v, q), (root, off) = self.end_guard(around, h)
        most = norm(h)
        carried = around.carried(errors, -most)
        slack = arb(10) ** -18
        if self.strong:
            errors_in_guard = 2 * norm(self.alpha) * 2 * carried[0] + carried[1]
            # Within `slack` around h the slope -2 alpha^2 U^3 changes by less than a tenth.
            steepness = 2 * (least(self.alpha) ** 2) * least(u) ** 3 * 0.9
            expected = -2 * cut(self.alpha * self.alpha) * u * u * u
            assert norm(u) < 2 and norm(slope - expected) < steepness / 100
        else:
            errors_in_guard = carried[0] + (self.high * carried[1] / least(root)) + off
            assert norm(q) < 1e-9 and norm(u) < 2
            steepness = least(v) - arb(10) ** -6
        late = (norm(guard) + errors_in_guard) / steepness
        assert late < slack, late
        state_error = [carried[0] + 2 * late, carried[1] + 10 * late * (norm(q) + 10 * late)]
        _, _, dt = around.moved(h)
        dt, more = thin(dt)
        time.append((dt, more + 2 * most * carried[0] + 4 * late))
        (u, eu), (v, ev) = thin(u), thin(v)
        if self.strong:
            eu += state_error[0]
            v, more = thin(-cut(self.alpha * u * u))
            ev = more + norm(self.alpha) * 3 * norm(u) * eu
        else:
            ev += state_error[1]
            u, more = thin(cut(self.r * root))
            eu = more + self.high * (off + ev / least(root))
        self.end_state = u, v, [eu, ev]
        end = arb_poly([here + near]) + h
        duration = cut(sum((t for t, _ in time), arb_poly([0]))), sum((e for _, e in time), arb(0))
        self.rows.insert(0, [(end, late), duration, (1 - v, ev), (u, eu)])

    def before_end(self, around, h):
        """Whether the place at h is before the end, for the middle of the interval."""
        u, v = (arb_poly([c[0] for c in series])(h) for series in (around.u, around.v))
        q = self.alpha[0] * u * u + self.beta[0] * v
        return bool(u > 0) and bool(q > 0)

    def end_guard(self, around, h):
        """A function that is 0 at the end, its slope, the state, and sqrt(-V) with its error."""
        u, v, _ = around.moved(h)
        q = cut(cut(self.alpha * cut(u * u)) + self.beta * v)
        rate = cut(cut(u * u) * q) * -2
        if self.strong:
            slope = cut(2 * cut(self.alpha * u) * v + rate)
            return q, slope, (u, v, q), (None, None)
        root = thin(cut(arb_poly(arb_series((-v).coeffs()).sqrt().coeffs())))[0]
        off = norm(root * root + v) / least(root)
        inverse = arb_poly((1 / arb_series(root.coeffs())).coeffs())
        slope = v + cut(self.r * cut(rate * cut(inverse))) * (arb(1) / 2)
        return u - cut(self.r * root), slope, (u, v, q), (root, off)

    def backwards(self, count):
        u, v, errors = self.end_state
        for index in range(count):
            around = self.around(u, v)
            width = arb(self.places[1][index + 1]) - arb(self.places[1][index])
            after_u, after_v, after, (dt, et) = step(around, errors, -width)
            self.nodes[1].append(around)
            change = (after_v - v, errors[1] + after[1])
            self.rows.append(self.row(around, change, (-dt, et), errors))
            u, v, errors = after_u, after_v, after
