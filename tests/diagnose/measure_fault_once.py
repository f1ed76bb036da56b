"""What `diagnose` says of a fault that sets in once in several drives, by hand, minutes a case:

    PYTHONPATH=.:tests python tests/diagnose/measure_fault_once.py FIRST END

Each seed draws six drives of a car at 200 to 500 Hz. A fault sets in at some time in the second to
sixth, and of even seeds stays for those after it; every fifth log has none, and there nothing of
the kind may be said.
"""

from __future__ import annotations

import sys

import numpy as np
import quarter_car
from diagnosed_table import diagnosed

RECORDS, SECONDS = 6, 12.0


def main(first: int, end: int) -> None:
    faults = said = right = inside = 0
    left: list[float] = []
    for seed in range(first, end):
        g = np.random.default_rng([seed, 2])
        kind, f, stays = (
            str(g.choice(quarter_car.FAULTS)),
            float(g.uniform(0.3, 0.8)),
            seed % 2 == 0,
        )
        k, t_0, rate = (
            int(g.integers(1, RECORDS)),
            float(g.uniform(3.0, 9.0)),
            int(g.choice([200, 500])),
        )
        later = 0.0 if stays else np.inf
        onsets = [np.inf] * k + [t_0] + [later] * (RECORDS - 1 - k)
        healthy = seed % 5 == 4
        table = quarter_car.log(
            seed, rate, records=RECORDS, seconds=SECONDS, fault=kind, left=f,
            onsets=[] if healthy else onsets,
        )  # fmt: skip
        found = diagnosed(table)
        once, names = found.once, [e.effect.name for e in found.findings]
        truth = "none" if healthy else f"{kind} {f:.2f} r{k} {t_0:.2f} s, stays: {stays}"
        answer = "nothing said"
        if once is not None and once.confirmed is not None:
            name = found.problem.recording.names[once.record]
            answer = f"{once.effect.name} {once.f:.3f} {name} {once.when}, stays: {once.stays}"
            answer += f", {'' if once.confirmed.explained else 'not '}explained"
            answer += f", beside {once.confirmed.beside}, alike {once.confirmed.alike}"
            said += 1
        faults += not healthy
        if not healthy and once is not None and once.confirmed is not None:
            last = k == RECORDS - 1
            kinds = {once.effect.name, *once.confirmed.alike}
            right += kind in kinds and once.record == k and (last or once.stays == stays)
            inside += once.record == k and once.at[0] <= t_0 <= once.at[1]
            left += [abs(once.f - f)] if once.effect.name == kind else []
        print(f"{seed} {truth} at {rate} Hz: {found.verdict.value} {names}; {answer}", flush=True)
    print(f"{faults} faults, {said} said; kind and record right {right}, in its interval {inside}")
    print(f"what is left of the damper: off by {max(left, default=0.0):.3f} at most")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
