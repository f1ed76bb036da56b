"""The diagnosis of a log in which a fault seems to set in once: again, as one record after another.

In a time that goes on from record to record the law of a fault says what happened once. So the log
is diagnosed in that time as well, the record of a fault that is in no other put last, and what the
second diagnosis names says what the first could not. A few seconds of one record are a single place
to a search, where anything may have happened; a fault that takes what is missing there is fitted
beside what was named before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from erdctl.core.recording import Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, Verdict
from erdctl.diagnose.fault_beside import fault_beside
from erdctl.diagnose.findings import earned, part_taken
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.records_with_a_fault import is_no_law, is_no_scatter, telling
from erdctl.diagnose.residual.localisation import Region, said
from erdctl.diagnose.residual.unlogged import unlogged
from erdctl.diagnose.sets_in_once import Confirmed, SetsInOnce
from erdctl.estimate.onsets import profile_within
from erdctl.model.effect import Variable
from erdctl.model.onset import AMOUNT, RAMP, START


def with_a_fault_once(run: Callable[..., Diagnosis], recording: Recording) -> Diagnosis:
    """The diagnosis of a recording by `run`: `diagnose` with all its options but those set here."""
    found = run(recording)
    if found.once is None:
        return found
    ordered = found.once.in_order(found.problem.recording)  # without what the rig has spoilt
    again = run(ordered, limits=False, learning=False, once=False)
    once = _named(found, found.once, again, ordered) or _beside(found, found.once, ordered)
    if once is None or once.confirmed is None:
        # Where more is left there are laws to learn; and what a fault would have been may be what
        # is not logged.
        left = found.verdict is Verdict.UNEXPLAINED
        apart = found.apart or (() if found.rig.blocking else unlogged(found.selection.best))
        if left or apart:
            sought = not found.searched.selection.ended and apart == found.apart
            known = found.searched if sought else None
            return run(recording, once=False, apart=apart, known=known)
        return replace(found, once=None)
    if _only_without_its_records(found, again):
        found = run(
            recording, once=False, learning=False, apart=found.apart, known=found.searched
        )  # fmt: skip
    first = _place(found.problem.recording, once, once.confirmed.share)
    # A fit that is bent by the fault misses in other records, too, and another part in these.
    others = (r for r in found.mismatch if r.variable is not Variable.RECORD)
    return replace(found, verdict=Verdict.UNEXPLAINED, once=once, mismatch=(first, *others))


def _only_without_its_records(found: Diagnosis, again: Diagnosis) -> bool:
    """Whether names take most but for the records with the fault, and a search with it lacks one:
    it bent a little like the fault, which spoilt the search without.
    """
    if not found.findings or earned(part_taken(found.selection, found.lack_of_fit)):
        return False
    said = {f.effect.name for f in again.findings}
    return any(said.isdisjoint((f.effect.name, *f.equivalent)) for f in found.findings)


def _place(recording: Recording, once: SetsInOnce, share: float) -> Region:
    """Where to look first: in the records that have the fault, from the onset on."""
    lengths = np.diff(recording.starts)[list(once.odd)]
    own = recording.t[recording.slices[once.record]]
    before = 0 if once.whole else int(np.searchsorted(own, float(np.mean(once.at))))
    time = float(lengths.sum() - before) / len(recording)
    where = f"after the onset of a fault at {once.when} of record {recording.names[once.record]!r}"
    if once.whole:
        where = f"in {once.named(recording.names)}, as of a fault all along"
    if once.odd != once.records:
        where = f"in {once.named(recording.names)}, as if all others had a fault"
    low, high = min(once.odd) + 1.0, max(once.odd) + 1.0
    return Region(Variable.RECORD, low, high, share, time, said(share, time, where))


def _named(
    found: Diagnosis, once: SetsInOnce, again: Diagnosis, ordered: Recording
) -> SetsInOnce | None:
    """What the second diagnosis says of the fault, in its record's time; None if it has none."""
    finding = next((f for f in again.findings if f.effect.sets_in), None)
    before, after = (d.carried.overall.rms**2 for d in (found, again))
    misfit = before - again.noise_rms**2
    share = min((before - after) / misfit, 1.0) if misfit > 0.0 else 0.0
    if finding is None or share < thresholds.SETS_IN_ONCE:
        return None
    best, fault = again.selection.best, finding.effect
    block, held = best.problem.block, best.problem.held
    at = profile_within(best.model, fault, block, best.values, held)
    onset = at.least(*(best.values[fault.key(symbol)] for symbol in (START, RAMP, AMOUNT)))
    confirmed = Confirmed(
        share=share,
        alike=finding.equivalent,
        beside=tuple(f.effect.name for f in again.findings if f is not finding),
        explained=again.verdict is not Verdict.UNEXPLAINED,
        rms=again.selection.best.rms,
    )
    left = parameters(again).estimates[fault.key(AMOUNT)].value
    named = replace(once, effect=fault, f=onset.f if left is None else left, confirmed=confirmed)
    named_in = named.set_in(found.problem.recording, ordered.t, at, onset)
    explained = again.lack_of_fit.records == 0.0
    return if_sure(named_in, once.order, best, found.problem.recording, explained)


def _beside(found: Diagnosis, once: SetsInOnce, ordered: Recording) -> SetsInOnce | None:
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
        rms=fault.hypothesis.rms,
    )
    named = replace(once, effect=fault.effect, f=fault.onset.f, confirmed=confirmed)
    named_in = named.set_in(found.problem.recording, ordered.t, fault.at, fault.onset)
    recording = found.problem.recording
    return if_sure(named_in, once.order, fault.hypothesis, recording, fault.explained)


def if_sure(
    once: SetsInOnce | None,
    order: Sequence[int],
    best: Hypothesis,
    recording: Recording,
    explained: bool,
) -> SetsInOnce | None:
    """A fault, unless it is all along records that may only scatter, or be driven otherwise.

    best : with the fault, of records in an order;  explained : whether none differ beyond it
    """
    if once is None:
        return None
    # Of a record that shows nothing of its force, one without a duty, nobody knows.
    told = [order[k] for k in telling(best, once.effect)]
    of_those = once.of_those(told, recording.t[recording.starts[:-1]])
    of_those = replace(of_those, silent=frozenset({*order} - {*told}))
    own = best, once.effect, once.f, range(once.first, len(order))
    sure = not of_those.whole or (
        explained and is_no_scatter(*own, may_be_a_gain=once.may_be_a_gain) and is_no_law(*own)
    )
    return of_those if sure else None
