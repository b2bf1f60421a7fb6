"""Guards of Python functions with planted zeros: how many are found, recorded and sampled?

Run with `python python/benches/planted_dips.py [NUMBER]`, 1000 of each kind without an argument.
"""

import sys

import numpy as np

from stickslip import solve

#: Functions of t, a place, a width and a phase, with the zeros in a span from 0 to 10.
KINDS = {
    "dip": (
        lambda t, p, w, c: 0.5 - np.exp(-(((t - p) / w) ** 2)),
        lambda p, w, c: [p - w * np.sqrt(np.log(2)), p + w * np.sqrt(np.log(2))],
    ),
    "kink": (
        lambda t, p, w, c: abs(t - p) - w,
        lambda p, w, c: [p - w, p + w],
    ),
    "jump": (
        lambda t, p, w, c: np.where((t > p) & (t < p + w), -1.0, 1.0),
        lambda p, w, c: [p, p + w],
    ),
    "steep": (
        lambda t, p, w, c: np.tanh((t - p) / w**2) * np.tanh((t - p - w) / w**2),
        lambda p, w, c: [p, p + w],
    ),
    "fast": (
        lambda t, p, w, c: np.sin(t / w + c),
        lambda p, w, c: [
            (k * np.pi - c) * w for k in range(int(c // np.pi) + 1, int((10 / w + c) // np.pi) + 1)
        ],
    ),
    "branch": (
        lambda t, p, w, c: (t - p) * (t - p - w) if t > p - 1 else 1.0,
        lambda p, w, c: [p, p + w],
    ),
}


def main() -> None:
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    for name, (function, zeros) in KINDS.items():
        wrong = {True: 0, False: 0}
        for seed in range(number):
            random = np.random.default_rng(seed)
            place, width = random.uniform(1.5, 8.5), 10 ** random.uniform(-3, -1)
            phase = random.uniform(0, 3)
            expected = np.array(zeros(place, width, phase))
            for record in (True, False) if seed < number // 10 else (True,):
                found = solve(
                    lambda t, y: [1.0],
                    (0, 10),
                    [0.0],
                    events=lambda t, y, a=(place, width, phase): function(t, *a),
                    t_eval=[],
                    record=record,
                )
                times = found.t_events[0]
                right = times.size == expected.size and np.abs(times - expected).max() < 1e-9
                wrong[record] += not right
        print(f"{name}: recorded {wrong[True]} wrong of {number}, ", end="")
        print(f"sampled {wrong[False]} of {number // 10}")


if __name__ == "__main__":
    main()
