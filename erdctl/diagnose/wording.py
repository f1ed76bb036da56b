"""A diagnosis in an engineer's words."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, isfinite, log10
from typing import Any

from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import Bench
from erdctl.diagnose import thresholds
from erdctl.diagnose.conditions import one_condition, one_motion, slow_far_out
from erdctl.diagnose.detectable import Detectable
from erdctl.diagnose.diagnosis import Diagnosis, Verdict
from erdctl.diagnose.fault_wording import sets_in_once_text
from erdctl.diagnose.findings import Finding, matters
from erdctl.diagnose.learning.words import law_words, worth_text
from erdctl.diagnose.noise_wording import begins_text, noise_text
from erdctl.diagnose.residual.course_of_records import of_records
from erdctl.diagnose.residual.lack_of_fit import LackOfFit
from erdctl.diagnose.residual.places import MISFIT, WITHOUT_IT
from erdctl.diagnose.unlogged_wording import unlogged_text
from erdctl.diagnose.unseen import Left, Unseen

# Of what the shares of lines and jumps are, which are looked for behind the regressions.
UNPREDICTED = "of the square of what no regression predicts, noise included,"


def finding_text(finding: Finding) -> str:
    """One finding in words."""
    e = finding.effect
    caveat = finding.caveat and f"{finding.caveat}; "
    text = f"{e.title}: {caveat}{worth_text(finding)}"
    if finding.where is not None:
        where = finding.where.text
        own = where.replace(MISFIT, "of the square of its force", 1)
        text += f"; {where if WITHOUT_IT in where else own}"
    if finding.equivalent:
        text += f"; these data cannot tell it from {' or '.join(finding.equivalent)}"
    if finding.test is not None:
        text += finding.test.advice(f"it from {finding.test.against}")
    return text


def unseen_text(u: Unseen) -> str:
    """An error on what was left out, in words that say in which sense."""
    fell = f"NRMSE {u.before:.4f}, corrected {u.after:.4f}"
    match u.left:
        case Left.ASIDE:
            kept = "neither fit nor search has seen"
            kept = "no fit has seen, but which decided what effects stay" if u.decided else kept
            which = f"{len(u.names)} records like others, that {kept}"
            return f"on {which} ({', '.join(u.names)}): {fell}"
        case Left.MOTIONS:
            which = f"each of {u.parts} kinds of motion"
        case Left.DUTIES:
            which = f"each of {u.parts} levels of duty"
        case Left.GROUPS:
            which = f"each of {u.parts} groups, records or parts of them,"
    return f"on {which} left out of the fit in turn, but not of the search: {fell}"


def remaining_text(found: Diagnosis) -> str:
    """What is left, in words, and what of the motion nothing has tested."""
    names = found.problem.recording.names
    return _left(found) + unlogged_text(found.apart, names) + _untested_motion(found)


def _left(found: Diagnosis) -> str:
    left = found.lack_of_fit
    if found.rig.blocking:
        return (
            "nothing was searched, because the recording itself is at fault:"
            f" {'; '.join(f.text for f in found.rig.blocking)}"
        )
    cut = bool(found.cannot_tell and not found.findings and found.rig.cut)
    if found.cannot_tell and not cut:
        bench = Bench.of(Survey.of(found.problem.recording))
        return (
            f"the log has {found.cannot_tell}, at which other effects, and other values of the"
            " paper's parameters, explain the misfit as well: what is named is one answer; to tell"
            f" them apart, record --drive {bench.sweep}, --drive {bench.levels} and --drive"
            f" {bench.steps}{_hum(left)}"
        )
    alone = found.apart and found.learned is None  # what is not logged, and noise
    alone = alone and not matters(found.problem, found.selection, left)
    if cut or alone or found.verdict is not Verdict.UNEXPLAINED:
        rest = noise_text(found) + _hum(left) + _of_records(found, noise=True) + begins_text(found)
        rest += _withdrawn(found)
        if cut:
            limits = "; ".join(f.text for f in found.rig.cut)
            rest += f"; of what lay beyond a limit the log tells nothing: {limits}"
        rest += "; the log has one duty and one speed, and says nothing of others" * one_condition(
            found.problem.recording
        )
        return "; ".join([rest, *undetected_text(found.undetected)])
    if found.learned is not None and not left.significant:
        return f"{_laws(found)}; with that, {noise_text(found)}{_hum(left)}{_withdrawn(found)}"
    if not left.significant and (once := sets_in_once_text(found)):
        return f"what no law in the time of every record says{once}{_hum(left)}{_withdrawn(found)}"
    words = "" if found.learned is None else f"{_laws(found)}; with that, "
    words += f"{left.misfit_rms:.3g} N rms beyond a noise of {left.noise_rms:.3g} N "
    if left.records > 0.0:
        words += (
            f"are explained by {_none_of(found)}; the gains of records differ by"
            f" {100 * left.records:.2g} % (standard deviation), and those of a rig hardly would"
        )
    else:
        words += f"can be predicted from motion and duty, but by {_none_of(found)}"
    if left.spectral_line is not None:
        words += (
            f"; {100 * left.spectral_line.share:.0f} % {UNPREDICTED} swings at"
            f" {left.spectral_line.frequency:.3g} Hz and turns over with the motion, as a ripple of"
            " the yield force does"
        )
    if left.impulses > 0.0:
        words += (
            f"; {100 * left.impulses:.0f} % {UNPREDICTED} comes in sudden jumps, as of a seal that"
            " sticks and slips, a joint that knocks or a valve that opens"
        )
    if left.travel_line is not None:
        words += (
            f"; {100 * left.travel_line.share:.0f} % {UNPREDICTED} comes again with every"
            f" {1e3 * left.travel_line.wavelength:.3g} mm of travel, as teeth of a seal that sticks"
            " and slips or a ripple of the bore do"
        )
    resembles = found.resemblance
    if resembles is not None:
        words += f"; it is most like {resembles.form} (correlation {resembles.correlation:+.2f})"
    words += sets_in_once_text(found) or _of_records(found, noise=False)
    words += _hum(left) + _withdrawn(found) + _derived(found)
    return words if found.apart or not found.mismatch else f"{words}; {found.mismatch[0].text}"


def _derived(found: Diagnosis) -> str:
    """That a velocity that is none of a sensor may be what is missing."""
    if not found.problem.block.signals.derived:
        return ""
    return (
        "; xdot was derived from x, which rounds what turns faster than its window, and a part of"
        " this may be of that: a log with xdot would tell"
    )


def _none_of(found: Diagnosis) -> str:
    """What does not explain something: as many effects as could be tried, of all or of those
    asked for.
    """
    several = f"none of the {found.tried} effects tried"
    return several if found.tried > 1 else "no effect that was tried"


def _of_records(found: Diagnosis, *, noise: bool) -> str:
    """That most of the misfit tells records apart, and nothing of their motion; or, of what is said
    to be noise, that it does so, if only by the order of records."""
    if len(found.problem.recording.names) < 2:
        return ""
    best, left = (found.learned or found).selection.best, found.lack_of_fit
    said = of_records(best)
    share = said.square / max(best.rms**2 if noise else left.misfit_rms**2, 1e-300)
    if share < thresholds.LEVELS_SAID and not (noise and said.course):
        return ""
    of_it = f"{100 * min(share, 1.0):.0f} % of its square"
    words = f"; {of_it} is a gain and a zero of each record's own"
    carry = "(--record-gains --record-offsets carry it)"
    if said.course is None:
        return (
            f"{words}: of a rig whose records scatter, or of what changes from record to record in"
            " the damper, as its warmth or the strokes that it has made; no motion within them"
            f" tells which {carry}"
        )
    first, last = said.course
    change = 100.0 * (last / first - 1.0)
    way = "rises" if change > 0.0 else "falls"
    return (
        f"{words}, and the force {way} in the order of the records, by {abs(change):.2g} % from the"
        " first to the last, beyond what their duty, speed and stroke would say: a damper that"
        " warms up or cools, a supply or a load cell that drifts; log the temperature, and record"
        f" the first motion once more at the end {carry}"
    )


def _untested_motion(found: Diagnosis) -> str:
    """On which motion nothing has tested what is named or learned."""
    corrected = bool(found.findings) or found.learned is not None
    if not corrected or found.cannot_tell:
        return ""
    recording = found.problem.recording
    bench = Bench.of(Survey.of(recording))
    if one_motion(recording):
        return (
            "; all strokes are alike, so that nothing here tests the corrected model on another"
            f" motion: before it is used on one, record --drive {bench.sweep}, and validate it"
            " there"
        )
    slow = slow_far_out(recording)
    if slow is None:
        return ""
    away, there, anywhere = slow
    return (
        f"; beyond {1e3 * away:.3g} mm from the middle of the stroke the log has speeds up to"
        f" {1e3 * there:.3g} mm/s alone, of {1e3 * anywhere:.3g}, so that nothing here tests the"
        f" corrected model at both: before it is used there, record --drive {bench.sine()}, and"
        " validate it with that"
    )


def _laws(found: Diagnosis) -> str:
    """That laws were learned, which are no names."""
    assert found.learned is not None
    said = "; ".join(law_words(law.law, law.tau) for law in found.learned.laws)
    rest = "what those named leave" if found.findings else "the misfit"
    return f"{_none_of(found)} explains {rest}, and the data say: {said}"


def _withdrawn(found: Diagnosis) -> str:
    names = ", ".join(e.name for e in found.withdrawn)
    if found.taken is not None:
        return (
            f"; the search had chosen {names} for {100 * found.taken:.0f} % of the square of what"
            " was missing, less than what stays, and so names nothing"
        )
    return names and (
        f"; the search had chosen {names}, which predict the records kept aside worse than the"
        " model without them, and so are not named"
    )


def _hum(left: LackOfFit) -> str:
    """A line of the force channel, which is no physics, with what to do about it."""
    if left.hum is None:
        return ""
    return (
        f"; {100 * left.hum.share:.0f} % {UNPREDICTED} is a line of {left.hum.frequency:.3g} Hz"
        " in the force channel (hum, or its alias), which no motion makes: look at shields and"
        " earths"
    )


def undetected_text(undetected: Sequence[Detectable]) -> list[str]:
    """What could have been missed: the largest forces that may hide, and what would not show."""
    could = sorted((d for d in undetected if d.size is not None), key=lambda d: -(d.force or 0.0))
    first, out = could[: thresholds.UNDETECTED_SAID], []
    if first:
        sizes = ", ".join(
            f"{d.effect.name} from {d.quantity.symbol} = {_sized(d)} ({d.force:.2g} N rms)"
            for d in first
        )
        many = len(could) - len(first)
        others = "1 other" if many == 1 else f"{many} others"
        more = f", and {others} from less force" if many else ""
        out.append(f"these data would have shown {sizes}{more}")
    never = [d.effect.name for d in undetected if d.size is None]
    if never:
        out.append(f"of no size would they have shown {', '.join(never)}")
    return out


def _sized(d: Detectable) -> str:
    """Its size with two digits of how far it is from off: of a factor of 0.996 that is 0.004."""
    assert d.size is not None
    unit = "" if d.quantity.unit == "1" else f" {d.quantity.unit}"
    apart = abs(d.size - d.quantity.off)
    near = 0.0 < apart < abs(d.size)
    more = floor(log10(abs(d.size))) - floor(log10(apart)) if near else 0
    return f"{d.size:.{2 + more}g}{unit}"


def record_values(found: Diagnosis) -> list[dict[str, Any]]:
    """Gain and offset of each record, as far as they were free; no error where undetermined."""
    free, record_effects = found.problem.free, found.record_effects
    if record_effects is None:
        return []

    def value(number: float, unit: str, error: float) -> dict[str, Any]:
        return {"value": number, "unit": unit, "stderr": error if isfinite(error) else None}

    out = []
    for i, name in enumerate(found.problem.recording.names):
        entry: dict[str, Any] = {"name": name}
        if free.gain:
            entry["gain"] = value(
                float(record_effects.gain[i]), "1", float(record_effects.gain_error[i])
            )
        if free.offset:
            entry["offset"] = value(
                float(record_effects.offset[i]), "N", float(record_effects.offset_error[i])
            )
        out.append(entry)
    return out
