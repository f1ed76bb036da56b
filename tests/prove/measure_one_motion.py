"""What is named and learned of one kind of motion, on other motions. By hand:

    PYTHONPATH=. python tests/prove/measure_one_motion.py KIND SEED COUNT

A case of KIND (unknown, single, pair) as `erdctl prove` draws it, but under one sine at five
duties, as a first bench log often is. NRMSE over the range of the case's fresh records, of other
strokes, frequencies and duties, without noise: of the paper's model, with what is named before
anything is learned, and with what is learned.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.conditions import one_motion
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs
from erdctl.plant.campaign import Campaign, CampaignRecord, DutyProgramme
from erdctl.plant.case import Case
from erdctl.plant.draw import draw
from erdctl.plant.logs import fresh, log
from erdctl.plant.trajectory import Trajectory
from erdctl.score.nrmse import Normalise, nrmse

DUTIES = 5
CYCLES, SHORTEST = 10, 4.0  # of a record; s
MOST_SAMPLES = 6000  # of a record


def under_one_sine(case: Case, random: np.random.Generator) -> Case:
    """The same damper and noise, driven so that all strokes are alike."""
    return replace(case, campaign=_sine(case.campaign, random), gains=(1.0,) * DUTIES, zeros=())


def _sine(c: Campaign, random: np.random.Generator) -> Campaign:
    frequency = float(np.exp(random.uniform(np.log(max(c.low, 0.4)), np.log(c.high))))
    amplitude = min(
        c.reach_x * c.rating.stroke * random.uniform(0.5, 1.0),
        c.reach_v * c.rating.speed * random.uniform(0.5, 1.0) / (2.0 * np.pi * frequency),
    )
    samples = min(round(max(CYCLES / frequency, SHORTEST) * c.rate), MOST_SAMPLES)
    records = []
    for i, phase in enumerate(random.uniform(0.0, 2.0 * np.pi, DUTIES)):
        motion = Trajectory("tones", (amplitude,), (frequency,), (float(phase),))
        duty = DutyProgramme((round(c.top * i / (DUTIES - 1), 3),), (0,))
        records.append(CampaignRecord(f"r{i + 1:02d}", c.rate, samples, motion, duty))
    return replace(c, records=tuple(records))


def read(table: pa.Table, folder: str) -> Recording:
    path = Path(folder) / "log.parquet"
    pq.write_table(table, path)
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording


def error(hypothesis: Hypothesis, held: Recording) -> float:
    assert held.force is not None
    model = hypothesis.model.force(Signals.of(held), hypothesis.values)
    return nrmse(held.force, model, Normalise.RANGE).nrmse


def row(kind: str, seed: int) -> str:
    known = [e.name for e in catalogue()]
    case = draw(seed, kind=kind, known=known)
    case = under_one_sine(case, np.random.default_rng(seed))
    with tempfile.TemporaryDirectory() as folder:
        recording, held = (read(t, folder) for t in (log(case), fresh(case)))
    assert one_motion(recording)
    found = diagnose(recording, catalogue(), limits=False)
    hidden = " + ".join(t.name for t in case.truth)
    names = ", ".join("/".join((f.effect.name, *f.equivalent)) for f in found.findings)
    laws = found.learned.laws if found.learned is not None else ()
    verdict = "cannot tell" if found.cannot_tell else found.verdict.value
    said = "; ".join([names, *(law.law.name for law in laws)])
    errors = [error(h, held) for h in (found.selection.base, found.selection.best)]
    if found.learned is not None:
        errors.append(error(found.learned.selection.best, held))
    numbers = " ".join(f"{e:.4f}" for e in errors)
    return f"{seed} {hidden}: {verdict} [{said}] {numbers}"


def main(arguments: Sequence[str]) -> None:
    kind, first, count = arguments[0], int(arguments[1]), int(arguments[2])
    for seed in range(first, first + count):
        print(row(kind, seed), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
