"""What `compare` finds in drawn fleets, and what it tells where nothing changes; by hand:

    PYTHONPATH=.:tests/compare python tests/compare/measure_compare.py FIRST:END [healthy]
"""

from __future__ import annotations

import sys
import time

import numpy as np
from fleets import FIRST, MONTH, Wear, draw

from erdctl.compare.comparison import compare
from erdctl.io.campaign_in import histories


def months(date: float) -> float:
    """Since the first month, of days since 1970."""
    return (date - FIRST.timestamp() / 86400.0) / MONTH


def main(seeds: range, healthy: bool) -> None:
    wanted = found = near = inside = rates = false = spurious = 0
    off, rate_errors, fleets = [], [], 0
    began = time.time()
    for seed in seeds:
        table, worn = draw(seed, healthy=healthy)
        fleet = {d.history.damper: d for d in compare(histories(table)).dampers}
        bad = [w.damper for w in worn]
        alarms = [(n, t.series.name, t.form.value) for n, d in fleet.items() if n not in bad for t in d.changes]
        false += len(alarms)
        fleets += bool(alarms)
        lines = [f"  false: {a}" for a in alarms]
        for w in worn:
            d = fleet[w.damper]
            wanted += 1
            first = d.changes[0] if d.changes else None
            found += first is not None and first.series.name in w.parameters
            others = [t.series.name for t in d.changes if t.series.name not in w.parameters]
            spurious += len(others)
            if others:
                lines.append(f"  other: {w.damper} {w.what} {others}")
            for name in w.parameters:
                t = d.trends.get(name)
                if t is None or not t.changed:
                    lines.append(f"  missed: {w.damper} {name}")
                    off.append(np.inf)
                    continue
                at, low, high = (months(v) for v in t.since) if t.since else (np.inf,) * 3
                off.append(abs(at - w.since))
                near += abs(at - w.since) <= 2.0
                inside += low <= w.since <= high
                rate_errors.append(np.nan)
                if w.form == "ramp" and t.rate:
                    value = w.rate if w.what != "leak" else w.rate * t.start[0]
                    rate_errors[-1] = (t.rate[0] - value) / t.rate[1]
                if abs(at - w.since) > 2.0 or t.form.value != w.form or abs(rate_errors[-1]) > 2.5:
                    lines.append(f"  {w.damper} {name} {w.form} since {w.since:.1f}: {t.form.value} {at:.1f} [{low:.1f} {high:.1f}] rate z {rate_errors[-1]:.2f}")
        print(f"seed {seed}: " + ("" if lines else "all right"))
        print("\n".join(lines))
    z = np.array(rate_errors)
    z = z[np.isfinite(z)]
    n = len(off)
    print(f"{len(seeds)} fleets in {time.time() - began:.0f} s")
    print(f"worn dampers {wanted}, first named right {found}; parameters {n}, change within 2 months {near}, in its interval {inside}")
    if len(z):
        print(f"rates {len(z)}: within 1.96 errors {np.mean(np.abs(z) < 1.96):.3f}, rms of error over its error {np.sqrt(np.mean(z**2)):.2f}")
    print(f"false alarms {false} in {fleets} fleets; others in worn dampers {spurious}")


if __name__ == "__main__":
    first, _, end = sys.argv[1].partition(":")
    main(range(int(first), int(end)), "healthy" in sys.argv)
