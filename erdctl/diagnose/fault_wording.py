"""What a diagnosis says of faults that are no finding, in an engineer's words."""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.diagnose.diagnosis import Diagnosis
from erdctl.diagnose.sets_in_once import SetsInOnce

RIG, LABEL = " or a gain of the rig", " or a duty other than logged"


def as_fault_text(found: Diagnosis) -> str:
    """What has become of the damper that has the given parameters; "" where no fault says it."""
    fault = found.as_fault
    if fault is None:
        return ""
    alike = " or ".join(fault.alike)
    alike = alike and f" (or {alike}, from which these data do not tell it)"
    return (
        f"of the damper with the given parameters {fault.effect.name}{alike} all along, with"
        f" f = {fault.f:.3g} +- {fault.stderr:.1g} beside their own errors, leaves"
        f" {fault.rms:.3g} N rms for {found.baseline.overall.rms:.3g} N,"
        f" {100 * fault.share:.0f} % of what a new fit takes; what else has changed since, as the"
        f" damper's warmth{RIG * fault.may_be_a_gain}, may look like it"
    )


def sets_in_once_text(found: Diagnosis) -> str:
    """That some records have a fault, which no law in their own time says, and how to have it."""
    once = found.once
    if once is None or once.confirmed is None:
        return ""
    names = found.problem.recording.names
    also = "".join(f" and {other}" for other in once.confirmed.beside)
    alike = " or ".join(once.confirmed.alike)
    fault = once.effect.name
    fault += alike and f" (or {alike}, from which these data do not tell it)"
    rest = (
        "is noise as far as these data tell" if once.confirmed.explained else "is more than noise"
    )
    if once.whole:
        may_be = f"{RIG * once.may_be_a_gain}{LABEL * once.may_be_a_duty}"
        there = once.named(names)
        if once.odd == once.records:
            said = (
                f"{fault} all along {there} leaves f = {once.f:.3g} there of what the others have"
            )
        else:
            forces = " and ".join(once.effect.sets_in)
            said = f"in {there} the {forces} force is {1.0 / max(once.f, 1e-3):.3g} times that of"
            said += f" all others, as if these had {fault} all along (f = {once.f:.3g})"
        said += (
            "; what else changes from one record to another, as the damper's"
            f" warmth{may_be}, may look like it"
        )
    else:
        said = f"{fault} that sets in once, at {once.when} of record {names[once.record]!r}, leaves"
        said += f" f = {once.f:.3g} from then on and in {_later(once, names)}"
    if once.stays:
        one_log = len(found.problem.recording.sources) == 1
        said += "; its law is found where their time goes on"
        said += ": erdctl convert --running-time" if one_log else " in one log"
    elif not once.whole and once.records == (once.record,):
        said += f"; for a law from that record alone: --where record={names[once.record]}"
    return (
        f"; {said}; with it{also}, of {found.selection.best.rms:.3g} N rms"
        f" {once.confirmed.rms:.3g} remain, and that {rest}"
    )


def _later(once: SetsInOnce, names: Sequence[str]) -> str:
    if once.stays:
        return "all records after it"
    others = ", ".join(repr(names[r]) for r in once.records[1:])
    return others or "no other"
