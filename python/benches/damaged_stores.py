"""Stores of sweeps with random damage: none may be opened with other results than were written.

python python/benches/damaged_stores.py [number of damages]
"""

import random
import shutil
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from stickslip import write_sweep

SWEEP: dict[str, Any] = {
    "kappa": np.linspace(1, 60, 5),
    "psi": np.linspace(0.1, 3, 4),
    "chunks": {"psi": 2},
}


def damaged(content: bytes, dice: random.Random) -> bytes:
    """The content with damage at up to three places."""
    found = bytearray(content)
    for _ in range(dice.randint(1, 3)):
        if not found:
            break
        start = dice.randrange(len(found))
        end = min(len(found), start + dice.randint(1, 40))
        match dice.randrange(6):
            case 0:
                found[start] = dice.randrange(256)
            case 1:
                found[start] ^= 1 << dice.randrange(8)
            case 2:
                del found[start:end]
            case 3:
                found[start:start] = found[start:end]
            case 4:
                digits = [place for place, one in enumerate(found) if chr(one).isdigit()]
                if digits:
                    found[dice.choice(digits)] = ord(dice.choice("0123456789"))
            case _ if dice.random() < 0.1:
                del found[start:]
    return bytes(found)


def battery(count: int, seed: int = 0) -> dict[str, int]:
    """What became of so many damages."""
    dice = random.Random(seed)
    became = {"refused": 0, "as written": 0, "wrong": 0}
    with tempfile.TemporaryDirectory() as folder:
        whole, store = Path(folder) / "whole", Path(folder) / "store"
        with write_sweep(whole, **SWEEP) as written:
            expected = {name: written[name].values for name in written.variables}
        files = sorted(one for one in whole.rglob("*") if one.is_file())
        for _ in range(count):
            shutil.rmtree(store, ignore_errors=True)
            shutil.copytree(whole, store)
            target = store / dice.choice(files).relative_to(whole)
            target.write_bytes(damaged(target.read_bytes(), dice))
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    with write_sweep(store, **SWEEP) as found:
                        values = {name: found[name].values for name in found.variables}
            except (OSError, ValueError):
                became["refused"] += 1
                continue
            same = values.keys() == expected.keys() and all(
                one.dtype == values[name].dtype and one.tobytes() == values[name].tobytes()
                for name, one in expected.items()
            )
            became["as written" if same else "wrong"] += 1
    return became


if __name__ == "__main__":
    counts = battery(int(sys.argv[1]) if len(sys.argv) > 1 else 5000)
    print(", ".join(f"{count} {name}" for name, count in counts.items()))
    if counts["wrong"]:
        sys.exit(1)
