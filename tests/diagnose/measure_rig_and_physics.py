"""One effect of the plant and one error of the rig in one log: is the effect named, and that alone?

    PYTHONPATH=.:tests:fixtures python tests/diagnose/measure_rig_and_physics.py FIRST END

Single effects of five times the noise, each with the next of the errors of `tests/rig_errors.py`
that leave a log to be read, or of slighter ones that no check has to see.
"""

from __future__ import annotations

import io
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
from rig_errors import ERRORS, chosen

from erdctl import plant
from erdctl.core.recording import Array, Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.one_after_another import with_a_fault_once
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs

Random = np.random.Generator
LEVEL = 5.0
UNITS = ("speed", "taken for", "in kN", "lbf", "per cent", "force reversed", "xdot reversed")


def _force(change: Callable[[Array, Random], Array], *, everywhere: bool = True):
    """Change the force of every record, or of the chosen one."""

    def spoil(r: Recording, random: Random) -> Recording:
        assert r.force is not None
        force = r.force.copy()
        for part in r.slices if everywhere else [r.slices[chosen(r)]]:
            force[part] = change(force[part], random)
        return replace(r, force=force)

    return spoil


def _jitter(r: Recording, random: Random) -> Recording:
    t = r.t.copy()
    for part in r.slices:
        t[part] += random.uniform(-0.3, 0.3, part.stop - part.start) * np.median(np.diff(t[part]))
    return replace(r, t=t)


def _counts(force: Array, random: Random) -> Array:
    step = float(np.ptp(force)) / 200
    return np.asarray(np.round(force / step) * step)


def _stale(force: Array, random: Random) -> Array:
    """Three samples of a hundred are those before them."""
    fresh = np.where(random.random(len(force)) < 0.03, 0, np.arange(len(force)))
    return force[np.maximum.accumulate(fresh)]


SLIGHT = {
    "a gain of 0.93 in one record": _force(lambda f, _: 0.93 * f, everywhere=False),
    "a zero of 4 % in one record": _force(lambda f, _: f + 0.04 * np.ptp(f), everywhere=False),
    "one record two samples late": _force(
        lambda f, _: f[np.r_[0, 0, : len(f) - 2]], everywhere=False
    ),
    "a drift of 8 % over one record": _force(
        lambda f, _: f + 0.08 * np.ptp(f) * np.linspace(0.0, 1.0, len(f)), everywhere=False
    ),
    "200 counts": _force(_counts),
    "every third sample held": _force(lambda f, _: f[np.arange(len(f)) // 3 * 3]),
    "stale samples": _force(_stale),
    "a clock that jitters": _jitter,
}  # fmt: skip
ALL = {n: e.spoil for n, e in ERRORS.items() if not any(u in n for u in UNITS)} | SLIGHT


def main(first: int, end: int) -> None:
    """A line for each log, and how many have the name first, and no other."""
    count: Counter[str] = Counter()
    known = frozenset(e.name for e in catalogue())
    for seed in range(first, end):
        error = list(ALL)[seed % len(ALL)]
        case, sink = plant.draw(seed, kind="single", known=known, level=LEVEL), io.BytesIO()
        pq.write_table(plant.log(case), sink)
        held = {"log.parquet": bytearray(sink.getvalue())}
        sound = read_logs(["log.parquet"], need_force=True, held=held, report=lambda _: None)
        spoiled = ALL[error](sound.recording, np.random.default_rng(seed))

        def run(r: Recording, **options: bool):
            return diagnose(r, catalogue(), **{"limits": False, **options})

        found = with_a_fault_once(run, spoiled)
        (hidden,) = (e["name"] for e in plant.key(case)["effects"])
        named = [(f.effect.name, *f.equivalent) for f in found.findings]
        count["logs"] += 1
        count["first"] += bool(named) and hidden in named[0]
        count["beside"] += sum(hidden not in n for n in named)
        count[found.verdict.value] += 1
        said = sorted({f.code for f in found.rig.faults})
        print(
            seed, error, "|", hidden, "|", *("/".join(n) for n in named), "|",
            found.verdict.value, "|", *said, flush=True,
        )  # fmt: skip
    print(dict(count))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
