"""The diagnosis of a log in which a fault seems to set in once: again, as one record after another.

In a time that goes on from record to record the law of a fault says what happened once. So the log
is diagnosed in that time as well, the record of a fault that is in no other put last, and what the
second diagnosis names says what the first could not. A few seconds of one record are a single place
to a search, where anything may have happened; a fault that takes what is missing there is fitted
beside what was named before.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from erdctl.core.recording import Recording, running_time
from erdctl.diagnose import thresholds
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, Verdict
from erdctl.diagnose.fault_beside import fault_beside
from erdctl.diagnose.residual.localisation import Region, said
from erdctl.diagnose.sets_in_once import Confirmed, SetsInOnce
from erdctl.model.effect import Variable
from erdctl.model.onset import AMOUNT, START


def with_a_fault_once(run: Callable[..., Diagnosis], recording: Recording) -> Diagnosis:
    """The diagnosis of a recording by `run`: `diagnose` with all its options but those set here."""
    found = run(recording)
    if found.once is None:
        return found
    left = found.verdict is Verdict.UNEXPLAINED
    used = found.problem.recording  # without records that the rig has spoilt
    order = _order(len(used.names), found.once)
    ordered = _one_after_another(used, order)
    again = run(ordered, limits=False, learning=False, once=False)
    once = _confirmed(found, again, order)
    if once is None:
        once = _beside(found, found.once, ordered, order)
    if once is None or once.confirmed is None:
        # Where more is left there are laws to learn.
        return run(recording, once=False) if left else replace(found, once=None)
    places = (_place(used, once, once.confirmed.share), *found.mismatch)
    return replace(found, verdict=Verdict.UNEXPLAINED, once=once, mismatch=places)


def _place(recording: Recording, once: SetsInOnce, share: float) -> Region:
    """Where to look first: from the onset on."""
    k, last = once.record, len(recording.names) - 1 if once.stays else once.record
    after = recording.starts[last + 1] - recording.starts[k]
    after -= int(np.searchsorted(recording.t[recording.slices[k]], float(np.mean(once.at))))
    time = float(after) / len(recording)
    where = f"after the onset of a fault at {once.when} of record {recording.names[k]!r}"
    return Region(Variable.RECORD, k + 1.0, last + 1.0, share, time, said(share, time, where))


def _order(count: int, once: SetsInOnce) -> list[int]:
    if once.stays:
        return list(range(count))
    return [r for r in range(count) if r != once.record] + [once.record]


def _one_after_another(recording: Recording, order: list[int]) -> Recording:
    ordered = recording.select(order)
    return replace(ordered, t=running_time(ordered.t, ordered.starts))


def _confirmed(found: Diagnosis, again: Diagnosis, order: list[int]) -> SetsInOnce | None:
    """What the second diagnosis says of the fault, in its record's time; None if it has none."""
    finding = next((f for f in again.findings if f.effect.sets_in), None)
    before, after = (d.carried.overall.rms**2 for d in (found, again))
    misfit = before - again.noise_rms**2
    share = min((before - after) / misfit, 1.0) if misfit > 0.0 else 0.0
    if finding is None or found.once is None or share < thresholds.SETS_IN_ONCE:
        return None
    fault = finding.effect
    estimates = parameters(again).estimates
    onset, left = estimates[fault.key(START)], estimates[fault.key(AMOUNT)]
    assert onset.value is not None
    assert left.value is not None
    confirmed = Confirmed(
        share=share,
        alike=finding.equivalent,
        beside=tuple(f.effect.name for f in again.findings if f is not finding),
        explained=again.verdict is not Verdict.UNEXPLAINED,
        rms=again.carried.overall.rms,
    )
    within = onset.within or (onset.value, onset.value)
    ordered = _one_after_another(found.problem.recording, order)
    return _in_its_record(
        replace(found.once, effect=fault, f=left.value, confirmed=confirmed),
        found.problem.recording, ordered, order, onset.value, within,
    )  # fmt: skip


def _beside(
    found: Diagnosis, once: SetsInOnce, ordered: Recording, order: list[int]
) -> SetsInOnce | None:
    """The same of a fault beside what was named without it; None if that takes too little."""
    fault = fault_beside(found.problem, found.selection.best, once.kinds, ordered)
    least = thresholds.SETS_IN_ONCE
    missed = least * found.lack_of_fit.misfit_rms**2
    if fault is None or fault.share < least or fault.taken < missed:
        return None
    confirmed = Confirmed(
        share=fault.share,
        alike=fault.alike,
        beside=tuple(e.name for e in found.selection.named),
        explained=fault.explained,
        rms=fault.rms,
    )
    return _in_its_record(
        replace(once, effect=fault.effect, f=fault.onset.f, confirmed=confirmed),
        found.problem.recording, ordered, order, fault.onset.t_0, fault.within,
    )  # fmt: skip


def _in_its_record(
    once: SetsInOnce, recording: Recording, ordered: Recording, order: list[int],
    onset: float, within: tuple[float, float],
) -> SetsInOnce | None:  # fmt: skip
    """A fault with the record and the time in it of an onset in the time that goes on [s]."""
    firsts = ordered.t[ordered.starts[:-1]]
    place = int(np.searchsorted(firsts, onset, "right")) - 1
    if place < 0:
        return None
    own = recording.slices[order[place]]
    begins, ends = float(recording.t[own][0]), float(recording.t[own][-1])
    back = begins - float(firsts[place])
    low, high = (min(max(end + back, begins), ends) for end in within)
    return replace(once, record=order[place], at=(low, high))
