"""How often a sound record is accused, and one with an error found: `measure_unlike.py FIRST:END`.

Logs of the plant, of every kind that is drawn without being asked for; then each once more with one
error in one record, that of the widest control.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import replace

import numpy as np
from test_rig_and_physics import LEFT_OUT, SPOILED, recorded

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.core.recording import Recording
from erdctl.effects import catalogue

FEWEST = 4  # records, below which none is held against the others


def accused(r: Recording) -> set[tuple[str, int | None]]:
    """Records that are said to be unlike the others."""
    return {(f.code, f.record) for f in look(r).faults if f.code.startswith("record_")}


def main(seeds: range) -> None:
    """Draw, look, and print a line for each sound log that is accused, then the counts."""
    known = frozenset(e.name for e in catalogue())
    count: Counter[str] = Counter()
    for seed in seeds:
        case = plant.draw(seed, known=known)
        hidden = {e["name"] for e in plant.key(case)["effects"]}
        r = recorded(case)
        if hidden & LEFT_OUT or len(r.names) < FEWEST:
            continue
        count["logs"] += 1
        if found := accused(r):
            count["accused"] += 1
            print(seed, *sorted(hidden), *sorted(found))
        at = max(range(len(r.names)), key=lambda k: float(np.ptp(r.duty[r.slices[k]])))
        assert r.force is not None
        for code, spoil in SPOILED.items():
            force, part = r.force.copy(), r.slices[at]
            span = float(np.ptp(np.percentile(force, [0.1, 99.9])))
            force[part] = spoil(r.t[part], force[part], span)
            said = accused(replace(r, force=force)) - found
            count[f"{code} found"] += (code, at) in said
            count[f"{code}, another accused"] += bool(said - {(code, at)})
    for what, n in count.items():
        print(f"{what:32} {n}")


if __name__ == "__main__":
    first, end = map(int, sys.argv[1].split(":"))
    main(range(first, end))
