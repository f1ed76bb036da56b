"""What `compare` finds in drawn fleets, and what it tells where nothing changes. By hand:

PYTHONPATH=.:tests python tests/compare/measure_compare.py FIRST:END [healthy]
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict

import numpy as np
from fleets import FIRST, MONTH, Wear, draw

from erdctl.compare.comparison import Damper, compare
from erdctl.compare.trend import Trend
from erdctl.io.campaign_in import histories


def months(date: float) -> float:
    """Since the first month, of days since 1970."""
    return (date - FIRST.timestamp() / 86400.0) / MONTH


class Score:
    """Of one kind of wear: what is found of it."""

    def __init__(self) -> None:
        self.dampers = self.first = self.parameters = self.found = self.inside = 0
        self.off: list[float] = []
        self.rates: list[float] = []

    def add(self, w: Wear, damper: Damper) -> None:
        changes = damper.changes
        self.dampers += 1
        self.first += bool(changes) and changes[0].series.name in w.parameters
        for name in w.parameters:
            self.parameters += 1
            t = damper.trends.get(name)
            if t is not None and t.since is not None:
                self._date(w, t)

    def _date(self, w: Wear, t: Trend) -> None:
        assert t.since is not None
        at, low, high = map(months, t.since)
        self.found += t.form.value == w.form
        self.off.append(at - w.since)
        self.inside += low <= w.since <= high
        if w.form == "ramp" and t.rate is not None:
            rate = w.rate * (t.start[0] if w.what == "leak" else 1.0)
            self.rates.append((t.rate[0] - rate) / t.rate[1])
        if abs(at - w.since) > 2.0 or t.form.value != w.form:
            print(
                f"  {t.series.name} {w.form} since {w.since:.1f}: {t.form.value}"
                f" {at:.1f} ({low:.1f} to {high:.1f})"
            )

    def row(self, name: str) -> str:
        off, z = np.abs(self.off), np.array(self.rates)
        rate = f"{np.mean(np.abs(z) < 1.96):.2f}, {np.sqrt(np.mean(z**2)):.2f}" if len(z) else "-"
        return (
            f"| {name} | {self.first} of {self.dampers} | {self.found} of {self.parameters}"
            f" | {(off <= 2.0).sum()} of {self.parameters} | {np.sqrt(np.mean(off**2)):.2f}"
            f" | {self.inside / max(len(off), 1):.2f} | {rate} |"
        )


def main(seeds: range, healthy: bool) -> None:
    scores: dict[str, Score] = defaultdict(Score)
    false = fleets = others = quiet = 0
    began = time.process_time()
    for seed in seeds:
        table, worn = draw(seed, healthy=healthy)
        print(f"seed {seed}", flush=True)
        fleet = {d.history.damper: d for d in compare(histories(table)).dampers}
        bad = {w.damper: w for w in worn}
        alarms = [(n, t) for n, d in fleet.items() if n not in bad for t in d.changes]
        for name, t in alarms:
            print(f"  false alarm: {name} {t.series.name} {t.form.value}")
        false, fleets = false + len(alarms), fleets + bool(alarms)
        quiet += len(fleet) - len(bad)
        for name, w in bad.items():
            scores[w.what].add(w, fleet[name])
            scores["all"].add(w, fleet[name])
            more = [t.series.name for t in fleet[name].changes if t.series.name not in w.parameters]
            others += len(more)
            if more:
                print(f"  in {name} ({w.what}) also {more}")
    print(
        "| wears | told first | form | within 2 months | rms [months] | in its interval | rates |"
    )
    for what, score in scores.items():
        print(score.row(what))
    print(
        f"false alarms: {false} in {quiet} healthy dampers of {len(seeds)} fleets, in {fleets} of"
        " these"
    )
    print(f"other parameters of worn dampers: {others}")
    print(f"{(time.process_time() - began) / len(seeds):.1f} s of processor time a fleet")


if __name__ == "__main__":
    first, _, end = sys.argv[1].partition(":")
    main(range(int(first), int(end)), "healthy" in sys.argv)
