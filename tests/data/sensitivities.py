"""Writes sensitivities.json: derivatives of collisions by central differences of a Taylor integration with 60 digits.

Run from this folder with mpmath: python3 sensitivities.py
"""

import json

from mpmath import fdot, mp, mpf, nstr, polyval, sqrt

mp.dps = 60
DEGREE = 40
STEP = mpf(1) / 16
SAMPLES = 16
CHANGE = mpf(10) ** -16
# Damping for the one-sided derivative at a = 0, whose error is of its size.
TINY = mpf(10) ** -20


def series(state, law, kappa, a):
    """Taylor coefficients in s of u, v, w, y, t while sliding or sticking."""
    regime, side = law
    u, v, w, y, t = [[x] for x in state]
    square, bracket, force, product = [], [], [], []

    def times(one, other, n):
        return fdot((one[i], other[n - i]) for i in range(n + 1))

    for n in range(DEGREE):
        square.append(times(u, u, n))
        bracket.append(square[n] + a * v[n])
        force.append(times(u, bracket, n))
        product.append(times(square, bracket, n))
        if regime == "stick":
            w_rate, y_rate = -2 * kappa * times(u, y, n), 2 * times(u, w, n)
        else:
            w_rate, y_rate = -2 * side * times(u, force, n), mpf(0)
        rates = (v[n], -2 * product[n], w_rate, y_rate, 2 * u[n])
        for component, rate in zip((u, v, w, y, t), rates):
            component.append(rate / (n + 1))
    return [component[::-1] for component in (u, v, w, y, t)]


def at(coefficients, h):
    return [polyval(component, h) for component in coefficients]


def normal_force(state, a):
    return state[0] * (state[0] ** 2 + a * state[1])


def guards(state, law, kappa, a):
    """What is positive while the phase lasts."""
    (u, v, w, y, _), (regime, side) = state, law
    bracket = u * u + a * v
    end = bracket if a > 0 else u
    if regime == "slip":
        if a == 0:
            return {"end": end, "same": kappa * side * w - mpf(3) / 2 * u * v}
        rate = v * bracket + u * (2 * u * v - 2 * a * u * u * bracket)
        return {"end": end, "same": 2 * u * kappa * side * w - rate}
    force = u * bracket
    return {"end": end, "same": force - side * kappa * y, "other": force + side * kappa * y}


def after(state, law, guard, kappa, a):
    (u, v, w, _, t), (regime, side) = state, law
    side = -side if guard == "other" else side
    if regime == "slip":
        return [u, v, w, side * normal_force(state, a) / kappa, t], ("stick", side)
    return [u, v, w, mpf(0), t], ("slip", side)


def secant(function, one, other):
    of_one, of_other = function(one), function(other)
    for _ in range(60):
        if of_one == of_other or abs(other - one) < mpf(10) ** -56:
            break
        step = of_other * (other - one) / (of_other - of_one)
        one, of_one = other, of_other
        other -= step
        of_other = function(other)
    return other


def free(kappa, psi, a):
    """Phases as (law, length in s, guard), found on a fine grid: for collisions that are not near a graze."""
    state, law = [mpf(0), mpf(1), psi, mpf(0), mpf(0)], ("stick" if a > 0 else "slip", 1)
    phases, length = [], mpf(0)
    while True:
        step = series(state, law, kappa, a)
        for i in range(1, SAMPLES + 1):
            h, before = STEP * i / SAMPLES, STEP * (i - 1) / SAMPLES
            values = guards(at(step, h), law, kappa, a)
            roots = []
            for guard in (guard for guard, value in values.items() if value < 0):
                low, high = before + (h - before) * mpf(10) ** -9, h
                for _ in range(20):
                    middle = (low + high) / 2
                    positive = guards(at(step, middle), law, kappa, a)[guard] > 0
                    low, high = (middle, high) if positive else (low, middle)
                value = lambda place: guards(at(step, place), law, kappa, a)[guard]
                roots.append((secant(value, low, high), guard))
            if roots:
                break
        else:
            state, length = at(step, STEP), length + STEP
            continue
        place, guard = min(roots)
        phases.append((law, length + place, guard))
        if guard == "end":
            return phases
        state, law = after(at(step, place), law, guard, kappa, a)
        length = mpf(0)


def follow(kappa, psi, a, phases):
    """Results of the collision with these phases, whose lengths need not be exact."""
    state, times = [mpf(0), mpf(1), psi, mpf(0), mpf(0)], []
    for law, left, guard in phases:
        while left > STEP:
            h = STEP if left > 2 * STEP else left / 2
            state, left = at(series(state, law, kappa, a), h), left - h
        step = series(state, law, kappa, a)
        value = lambda place: guards(at(step, place), law, kappa, a)[guard]
        state = at(step, secant(value, left, left * (1 + CHANGE)))
        times.append(state[4])
        if guard != "end":
            state, _ = after(state, law, guard, kappa, a)
    return [-state[1], state[2], times[-1], *times[:-1]]


def derivatives(kappa, psi, a):
    phases = free(kappa, psi, a)
    here = follow(kappa, psi, a, phases)

    def central(value, results):
        more, less = results(value * (1 + CHANGE)), results(value * (1 - CHANGE))
        return [(x - y) / (2 * CHANGE * value) for x, y in zip(more, less)]

    by_kappa = central(kappa, lambda value: follow(value, psi, a, phases))
    by_psi = central(psi, lambda value: follow(kappa, value, a, phases))
    if a > 0:
        return here, by_kappa, by_psi, central(a, lambda value: follow(kappa, psi, value, phases))
    # With damping a contact starts in stick, here until a/(κψ), and ends a little earlier.
    first = (kappa * psi - sqrt((kappa * psi) ** 2 - 4 * TINY)) / 2
    law, length, guard = phases[-1]
    end = (law, length - sqrt(TINY * here[0]), guard)
    damped = follow(kappa, psi, TINY, [(("stick", 1), first, "same"), *phases[:-1], end])
    damped.pop(3)
    return here, by_kappa, by_psi, [(x - y) / TINY for x, y in zip(damped, here)]


def main():
    collisions = []
    for name, count in (("undamped_random", 24), ("undamped_paper", 8), ("damped_random", 18)):
        with open(f"{name}.json") as file:
            cases = json.load(file)["cases"]
        for case in cases[:: max(1, len(cases) // count)][:count]:
            kappa, psi, damping = [mpf(float(case.get(key, 0))) for key in ("kappa", "psi", "damping")]
            found = derivatives(kappa, psi, damping)
            assert len(found[0]) == 3 + case["switch_count"]
            assert abs(found[0][1] - mpf(case["w_final"])) < mpf(10) ** -20
            names = ("value", "kappa", "psi", "damping")
            results = [dict(zip(names, (nstr(x, 22) for x in row))) for row in zip(*found)]
            inputs = {key: case.get(key, "0") for key in ("kappa", "psi", "damping")}
            outputs = dict(zip(("eps_n", "final_velocity", "contact_time"), results))
            collisions.append({**inputs, **outputs, "switch_times": results[3:]})
    about = (
        "Collisions with the derivatives of their results with respect to kappa, psi and damping (from above where damping is 0), "
        "written by sensitivities.py. Inputs are exact binary64 values."
    )
    with open("sensitivities.json", "w") as file:
        json.dump({"about": about, "cases": collisions}, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
