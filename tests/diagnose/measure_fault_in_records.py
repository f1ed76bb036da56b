"""What `diagnose` says of a fault that some drives of several have all along, by hand:

    PYTHONPATH=.:tests python tests/diagnose/measure_fault_in_records.py FIRST END

Each seed draws four to seven drives of a car, and some of them with a fault from beginning to end,
in any order. Every third log has none: its drives have gains of their own that differ by 1 to 10 %
(standard deviation), as of a rig that is off, and there nothing of the kind may be said.
"""

from __future__ import annotations

import sys

import numpy as np
import quarter_car
from diagnosed_table import diagnosed

SECONDS, RATE = 10.0, 200


def main(first: int, end: int) -> None:
    faults = said = right = wrong = 0
    left: list[float] = []
    for seed in range(first, end):
        g = np.random.default_rng([seed, 5])
        kind, f = str(g.choice(quarter_car.FAULTS)), float(g.uniform(0.3, 0.85))
        count = int(g.integers(4, 8))
        having = sorted(g.choice(count, int(g.integers(1, count)), replace=False).tolist())
        spread = float(np.exp(g.uniform(np.log(0.01), np.log(0.1))))
        scatters = seed % 3 == 2
        onsets = [0.0 if r in having else np.inf for r in range(count)]
        table = quarter_car.log(
            seed, RATE, records=count, seconds=SECONDS, fault=kind, left=f,
            onsets=[] if scatters else onsets,
        )  # fmt: skip
        if scatters:
            gains = dict(
                zip(table.record.unique(), 1.0 + spread * g.normal(size=count), strict=True)
            )
            table["force"] *= table.record.map(gains)
        found = diagnosed(table)
        once, names = found.once, [e.effect.name for e in found.findings]
        truth = f"gains off by {spread:.3f}" if scatters else f"{kind} {f:.2f} in {having}"
        answer = "nothing said"
        if once is not None and once.confirmed is not None:
            answer = f"{once.effect.name} {once.f:.3f} in {list(once.records)}"
            answer += (
                f"{'' if once.whole else ' from ' + once.when}, beside {once.confirmed.beside}"
            )
            answer += f", alike {once.confirmed.alike}, explained: {once.confirmed.explained}"
            said += not scatters
            wrong += scatters
        faults += not scatters
        if not scatters and once is not None and once.confirmed is not None:
            same = sorted(once.records) == having and once.whole
            right += same and kind in {once.effect.name, *once.confirmed.alike}
            left += [abs(once.f - f)] if once.effect.name == kind else []
        print(f"{seed} {truth} of {count}: {found.verdict.value} {names}; {answer}", flush=True)
    print(f"{faults} faults, {said} said; kind and records right {right}; of gains said {wrong}")
    print(f"what is left of the damper: off by {max(left, default=0.0):.3f} at most")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
