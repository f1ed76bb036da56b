"""How often a record is said to have another duty than is logged, where none has, and where one
has: `PYTHONPATH=.:tests:fixtures python tests/bench/rig/measure_labels.py FIRST:END`.

Logs of the plant, of every kind that is drawn without being asked for; then each once more with a
lower level, that another record has, in the place of that of a record whose own level others have.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

import numpy as np
from test_rig_and_physics import recorded

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.bench.rig.fault import RigFault
from erdctl.core.recording import Recording
from erdctl.effects import catalogue

HELD, APART = 0.02, 0.04  # of full scale


def said(r: Recording) -> list[RigFault]:
    return [f for f in look(r).faults if f.code == "record_duty"]


def mislabelled(r: Recording, random: np.random.Generator) -> tuple[Recording, int, float] | None:
    """With a wrong label, the record that has it and its duty; None where no level would do."""
    levels = {
        k: round(float(np.median(r.duty[part])), 3)
        for k, part in enumerate(r.slices) if np.ptp(r.duty[part]) < HELD
    }  # fmt: skip
    pairs = [
        (k, low) for k, own in levels.items() for low in sorted(set(levels.values()))
        if low < own - APART and list(levels.values()).count(own) > 1
    ]  # fmt: skip
    if not pairs:
        return None
    k, low = pairs[random.integers(len(pairs))]
    duty = r.duty.copy()
    duty[r.slices[k]] = low
    return replace(r, duty=duty), k, levels[k]


def main(seeds: range) -> None:
    known = frozenset(e.name for e in catalogue())
    count: Counter[str] = Counter()
    for seed in seeds:
        r = recorded(plant.draw(seed, known=known))
        count["logs"] += 1
        count["accused"] += bool(said(r))
        wrong = mislabelled(r, np.random.default_rng(seed))
        if wrong is None:
            continue
        log, at, level = wrong
        faults = said(log)
        own = [f for f in faults if f.record == at]
        count["mislabelled"] += 1
        count["found"] += bool(own)
        count["with its level"] += any(f" at {100 * level:.3g} % duty" in f.text for f in own)
        count["another accused"] += len(faults) > len(own)
    print(dict(count))


if __name__ == "__main__":
    first, end = map(int, sys.argv[1].split(":"))
    main(range(first, end))
