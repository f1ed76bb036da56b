"""How often strokes that lack a part of their force for a while are found, and what else is.

    PYTHONPATH=.:fixtures:tests:tests/bench/rig \\
        python tests/diagnose/measure_unlogged.py 1780000:1780200

In a log of the plant, with nothing or one effect hidden, a record is chosen in which 4 to 10
strokes in a row, the ends cut anywhere, lose a part of all force. The model that is fitted has the
hidden effect, so that this tells of the strokes and not of the search. Found is what lies in that
record and shares half of the time; all else is wrong.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
from test_rig_and_physics import recorded

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.bench.strokes import strokes
from erdctl.core.recording import Recording
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.residual.unlogged import Unlogged, unlogged
from erdctl.diagnose.slight_lag import freed
from erdctl.effects import get, names
from erdctl.estimate.starts import fresh_start

PARTS = (0.1, 0.2, 0.4)


def told(recording: Recording, effects: tuple[str, ...]) -> tuple[Unlogged, ...]:
    problem = freed(prepare(look(recording).usable()))
    best = fit_hypothesis(problem, tuple(get(n) for n in effects), [fresh_start(0.05, 0.4)])
    return unlogged(best)


def lacking(
    r: Recording, random: np.random.Generator
) -> tuple[Recording, int, float, float, float] | None:
    """The log with strokes that lack a part, their record, their time and the part; None where no
    record has as many."""
    assert r.force is not None
    found, many = strokes(r), 12
    able = [i for i in range(len(r.names)) if np.count_nonzero(found.record == i) >= many]
    if not able:
        return None
    record = int(random.choice(able))
    own = np.flatnonzero(found.record == record)
    count = int(random.integers(4, min(10, len(own) // 2) + 1))
    first = int(random.integers(3, len(own) - count - 1))
    begin, end = r.t[found.first[own[first]]], r.t[found.end[own[first + count - 1]] - 1]
    shift = random.uniform(-0.5, 0.5) * (end - begin) / count
    begin, end, part = begin + shift, end + shift, float(random.choice(PARTS))
    a, b = r.starts[record : record + 2].tolist()
    inside = np.zeros(len(r), np.bool_)
    inside[a:b] = (r.t[a:b] >= begin) & (r.t[a:b] < end)
    return replace(r, force=np.where(inside, 1.0 - part, 1.0) * r.force), record, begin, end, part


def right(u: Unlogged, record: int, begin: float, end: float) -> bool:
    shared = min(u.end, end) - max(u.begin, begin)
    return u.record == record and shared > 0.5 * (max(u.end, end) - min(u.begin, begin))


def main() -> None:
    low, high = (int(v) for v in sys.argv[1].split(":"))
    sound, wrong_sound, found, wrong, none = 0, 0, dict.fromkeys(PARTS, 0), 0, 0
    of = dict.fromkeys(PARTS, 0)
    for seed in range(low, high):
        kind = ("null", "single")[seed % 2]
        case = plant.draw(seed, kind=kind, known=frozenset(names()))
        r, effects = recorded(case), tuple(t.name for t in case.truth)
        sound += 1
        if extra := told(r, effects):
            wrong_sound += 1
            print(seed, effects, "sound, but", [(u.record, u.begin, u.end) for u in extra])
        made = lacking(r, np.random.default_rng(seed))
        if made is None:
            none += 1
            continue
        log, record, begin, end, part = made
        said = told(log, effects)
        of[part] += 1
        found[part] += any(right(u, record, begin, end) for u in said)
        wrong += any(u.record != record for u in said)
    for part in PARTS:
        print(f"{100 * part:.0f} % less: {found[part]} of {of[part]} found")
    print(f"in another record: {wrong} of {sum(of.values())}")
    print(f"in sound logs: {wrong_sound} of {sound}; no record with so many strokes: {none}")


if __name__ == "__main__":
    main()
