"""What changed, in words: "free play grew from 1.2 to 2 mm since 2023-05"."""

from __future__ import annotations

import re
from math import copysign, isfinite

import numpy as np

from erdctl.compare.comparison import Compared, Damper, iso
from erdctl.compare.pair import Change, Difference, Pair
from erdctl.compare.shape import Course
from erdctl.compare.tolerance import Holds, Judged
from erdctl.compare.trend import Trend
from erdctl.core.messages import counted
from erdctl.report.readable import number, scaled, with_unit

SCORES = {
    # Of a diagnosis, too: the parameters beside it are those of its corrected model.
    "nrmse": "the baseline's NRMSE",
    "nrmse_worst": "the baseline's NRMSE at the worst level",
    "noise_rms": "the noise",
}
SET = 9  # digits of what somebody has set, so that it stands as it was set
_OF = re.compile(r"\{(\w+)(?::%)?\} of (.+)")


def noun(parameter: str) -> str:
    """What a parameter is called in a sentence.

    >>> noun("compression.c_vis"), noun("backlash.g"), noun("nrmse")
    ('c_vis in compression', 'free play', "the baseline's NRMSE")
    """
    from erdctl.effects import get, names

    head, _, symbol = parameter.partition(".")
    if not symbol:
        return SCORES.get(parameter, parameter)
    if head not in names():
        return f"{symbol} in {head}"
    effect = get(head)
    said = _OF.fullmatch(effect.said)
    if said is not None and said[1] == symbol and "{" not in said[2]:
        return said[2]
    return f"{symbol} of {head.replace('_', ' ')}"


def _numbers(unit: str, *values: float, digits: int = 3) -> tuple[list[str], str]:
    """Values in one unit that people read, and that unit as it stands behind them."""
    factor, shown = scaled(unit, max((abs(v) for v in values if isfinite(v)), default=0.0))
    return [number(v * factor, digits) for v in values], f" {shown.removeprefix('1')}".rstrip()


def _moved(name: str, unit: str, before: float, after: float) -> str:
    """A change with as many digits as show it.

    >>> _moved("compression.c_vis", "N s/m", 60.0, 60.02), _moved("nrmse", "1", 0.01, 0.01)
    ('c_vis in compression grew from 60 to 60.02 N s/m', "the baseline's NRMSE is the same, 0.01")
    """
    if before == after:
        return f"{noun(name)} is the same, {with_unit(before, unit, 3)}"
    for digits in range(3, 18):
        (a, b), shown = _numbers(unit, before, after, digits=digits)
        if a != b:
            break
    return f"{noun(name)} {'grew' if after > before else 'fell'} from {a} to {b}{shown}"


def month(days: float) -> str:
    """A date as sentences have it."""
    return (iso(days) or "?")[:7]


def trend_text(t: Trend) -> str:
    """A trend in one sentence, without a full stop; empty for a constant."""
    if not t.changed:
        return ""
    s = t.series
    text = _moved(s.name, s.unit, t.start[0], t.now[0])
    if t.absent_before:
        text = f"{noun(s.name)} appeared, now {with_unit(t.now[0], s.unit, 3)}"
    elif t.absent_after:
        text = f"{noun(s.name)} vanished, before {with_unit(t.start[0], s.unit, 3)}"
    if t.since is not None:
        at, first, last = (month(d) for d in t.since)
        word = "in" if t.form is Course.STEP else "since"
        text += f" {word} {at}" + (f" ({first} to {last})" if first != last else "")
    else:
        text += f" from {month(float(s.t[0]))} to {month(float(s.t[-1]))}"
    if t.rate is not None:
        rate, error = t.rate
        if not (t.absent_before or t.absent_after):
            rate = abs(rate)  # "fell" has said the sign
        (rate_text, error_text), unit = _numbers(s.unit, rate, error)
        text += f", by {rate_text} +- {error_text}{unit} a year"
    return text


def relative(t: Trend) -> float:
    """Change from the first to the last date, over the value at the first; 1 or -1 where that is
    0, or the effect was not there."""
    change = t.now[0] - t.start[0]
    if t.absent_before or t.absent_after or not abs(t.start[0]) > 0.0:
        return copysign(1.0, change)
    return change / abs(t.start[0])


def difference_text(d: Difference) -> str:
    """One parameter of two logs, in one sentence without a full stop."""
    if d.verdict is Change.APPEARED:
        text = f"{noun(d.name)} appeared: {with_unit(d.after.value, d.unit, 3)}"
        return text + _unseen(d, d.before.limit, "before")
    if d.verdict is Change.VANISHED:
        text = f"{noun(d.name)} vanished: it was {with_unit(d.before.value, d.unit, 3)}"
        return text + _unseen(d, d.after.limit, "now")
    if d.before.named and d.after.named:
        return _moved(d.name, d.unit, d.before.value, d.after.value)
    there = d.before if d.before.named else d.after
    return f"{noun(d.name)} is {with_unit(there.value, d.unit, 3)} in one of them" + _unseen(
        d, (d.after if d.before.named else d.before).limit, "in the other"
    )


def _unseen(d: Difference, limit: float, when: str) -> str:
    if not isfinite(limit):
        return ""
    return f"; {when} it would have been named from {with_unit(limit, d.unit, 2)} on"


def pair_texts(p: Pair) -> list[str]:
    """What two logs differ in, and how that was judged."""
    out = [difference_text(d) for d in p.changes]
    if not p.told:
        out.append("no error of any parameter is known, so no change can be told from none")
    if p.together and p.joint is not None:
        out.append(
            "no parameter by itself, but all together differ by more than their errors; the change"
            f" of {', '.join(noun(n) for n in p.joint.told_by)} alone would be enough"
        )
    return out


def pair_remarks(p: Pair) -> list[str]:
    """What to know of a pair's judgement."""
    out = []
    if p.joint is None and p.told:
        out.append("judged by standard errors, parameter by parameter: not both tell a covariance")
    elif p.joint is not None:
        j = p.joint
        out.append(
            f"{counted(j.dof, 'parameter')} judged together, with their covariance: chi2"
            f" {number(j.statistic, 3)}, p {j.p:.1g}"
        )
    if p.other_effects:
        out.append(
            f"the models differ by {', '.join(p.other_effects)}: other parameters take a part of"
            " what one model lacks; of files (not of tables) --refit fits both logs with all of it"
        )
    if p.before[0] is p.after[0]:
        dated = np.isfinite(p.before[0].t)
        if dated.any() and not dated.all():
            out.append("not all logs have a date: they are taken in the order given")
        out.append("two logs do not tell how far logs scatter beyond the errors of their fits")
    return out


def judged_text(j: Judged) -> str:
    """One band of one damper."""
    value = with_unit(j.value, j.unit, 4) if isfinite(j.value) else "unknown"
    interval = ""
    if isfinite(j.low) and isfinite(j.high) and j.low < j.high:
        (low, high), unit = _numbers(j.unit, j.low, j.high, digits=4)
        interval = f" ({low} to {high}{unit})"
    text = f"{noun(j.name)} {value}{interval}, {band_text(j)}: {j.holds.value}"
    if j.why:
        text += f", {j.why}"
    if j.reached is not None:
        at, first, last = (month(d) if isfinite(d) else "later than ten years" for d in j.reached)
        text += f"; as it goes on, out of it in {at} ({first} to {last})"
    return text


def band_text(j: Judged) -> str:
    """A band as people say it."""
    low, high = j.band.low, j.band.high
    if isfinite(low) and isfinite(high):
        (a, b), unit = _numbers(j.unit, low, high, digits=SET)
        return f"band {a} to {b}{unit}"
    word, end = ("at least", low) if isfinite(low) else ("at most", high)
    return f"{word} {with_unit(end, j.unit, SET)}"


def damper_texts(d: Damper) -> list[str]:
    """All that is to be said of a damper, the most urgent first."""
    out = [judged_text(j) for j in d.judged if j.holds is not Holds.PASS or j.reached is not None]
    out += [trend_text(t) for t in d.changes]
    for p in d.pairs:
        against = f" (against {p.before[0].damper})" if p.before[0] is not p.after[0] else ""
        out += [text + against for text in pair_texts(p)]
    if d.history.failed:
        log, error = d.history.failed[0]
        many = len(d.history.failed)
        out.append(f"{counted(many, 'log')} could not be used, e.g. {log}: {error}")
    return out


def head(found: Compared) -> str:
    """The whole in one sentence."""
    changed = [
        d for d in found.dampers if d.changes or any(p.changes or p.together for p in d.pairs)
    ]
    many, alone = len(found.dampers), sum(not d.compared for d in found.dampers)
    logs = counted(found.logs, "log")
    if alone == many:
        return f"{logs}, no damper with an earlier one"
    if many > 1:
        text = f"{len(changed) or 'none'} of {many} dampers changed"
        return f"{logs}, {text}" + (f", {alone} without an earlier log" if alone else "")
    pairs = found.dampers[0].pairs
    if pairs and not any(p.told for p in pairs):
        return f"{logs}, no change can be told"
    return f"{logs}, {'changed' if changed else 'nothing changed'} beyond the errors"
