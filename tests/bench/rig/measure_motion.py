"""How often a record is said to have a deflection of another gain, or to be turned round, where
none is, and where one is:

    PYTHONPATH=.:tests:fixtures:tests/bench/rig python tests/bench/rig/measure_motion.py FIRST:END

Logs of the plant, of every kind that is drawn without being asked for; then each once more with a
gain of 1.2 to 5 either way of one record's motion, and with one record of the other sign.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

import numpy as np
from test_rig_and_physics import recorded

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.core.recording import Recording
from erdctl.effects import catalogue

CODES = ("record_deflection", "record_turned")


def with_gains(r: Recording, k: int, motion: float, force: float) -> Recording:
    """The same with one record's motion and force multiplied."""
    out = {"x": r.x.copy(), "xdot": r.xdot.copy(), "force": np.array(r.force)}
    for name, gain in (("x", motion), ("xdot", motion), ("force", force)):
        out[name][r.slices[k]] *= gain
    return replace(r, **out)


def main(seeds: range) -> None:
    known = frozenset(e.name for e in catalogue())
    count: Counter[str] = Counter()
    for seed in seeds:
        r = recorded(plant.draw(seed, known=known))
        random = np.random.default_rng(seed)
        k, gain = (
            int(random.integers(len(r.names))),
            random.uniform(1.2, 5.0) ** random.choice([-1, 1]),
        )
        count["logs"] += 1
        wrong = [f for f in look(r).faults if f.code in CODES]
        count["accused"] += bool(wrong)
        spoiled = with_gains(r, k, gain, 1.0), with_gains(r, k, -1.0, -1.0)
        for log, code in zip(spoiled, CODES, strict=True):
            found = look(log).faults
            faults = [f for f in found if f.blocks and f.record == k]
            other = [f for f in found if f.code in CODES and f.record != k]
            for f in other:
                print(f"{seed}, motion of {k} times {gain:.3g}: {f.record}, {f.text}", flush=True)
            said = ", ".join(f.code for f in faults) or "nothing"
            count[f"{code}: {said}"] += 1
            count[f"{code}: another record accused"] += bool(other)
        for f in wrong:
            print(seed, f.record, f.text, flush=True)
    for what, number in sorted(count.items()):
        print(f"{number:5d} {what}")


if __name__ == "__main__":
    main(range(*map(int, sys.argv[1].split(":"))))
