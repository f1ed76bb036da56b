"""A learned law in an engineer's words."""

from __future__ import annotations

from erdctl.diagnose import thresholds
from erdctl.diagnose.findings import Finding
from erdctl.diagnose.learning.stage import LearnedLaw
from erdctl.model.learned.law import Law, LawSlot

OF = {
    LawSlot.FORCE: "a force",
    LawSlot.FRICTION: "a force against the motion",
    LawSlot.YIELD: "the yield force",
    LawSlot.VISCOUS: "the viscous force",
    LawSlot.GAS: "the force of the gas",
    LawSlot.FLUID: "the yield and the viscous force",
    LawSlot.LAG: "the time constant of the yield force",
    LawSlot.DUTY: "the duty that acts",
    LawSlot.DEFLECTION: "a deflection",
}


UNITS = {"m": (1e3, "mm"), "m/s": (1e3, "mm/s"), "1": (1.0, "")}


def law_words(law: Law, tau: float | None = None) -> str:
    """Which law it is; tau : the time constant of its memory [s], or its travel [m]."""
    beside = law.unit != "1"
    verb = "depends" if beside else "change" if law.slot is LawSlot.FLUID else "changes"
    by = "on" if beside else "with"
    factor, unit = UNITS.get(law.curve.kind.forgets, (1.0, law.curve.kind.forgets))
    over = "" if tau is None else f" (over {factor * tau:.3g} {unit})"
    that = " that" if beside else ""
    others = "".join(f" and {axis.kind.words}" for axis in law.curve.axes[1:])
    return f"{OF[law.slot]}{that} {verb} {by} {law.curve.kind.words}{over}{others}"


def law_text(found: LearnedLaw) -> str:
    """A law, how far it goes, and what it is worth."""
    law, worth = found.law, found.finding
    text = law_words(law, found.tau) + _course(found)
    text += f": {worth_text(worth)}"
    if found.alike:
        text += f"; as well would do {' or '.join(law_words(a) for a in found.alike)}"
    if worth.test is not None:
        text += worth.test.advice("them apart")
    return text


def worth_text(worth: Finding) -> str:
    """How much less a model misses with an effect or a law than without.

    The gain is a part of what is missed without it, so what leaving it out adds, as a part of what
    is missed with it, may be several times that.
    """
    return (
        "with it the mean square error on data that the fit had not seen is"
        f" {100 * worth.gain.gain:.0f} % lower (NRMSE {worth.before:.4f} without it,"
        f" {worth.after:.4f} with it)"
    )


def _course(found: LearnedLaw) -> str:
    """How far a law goes, over which range; and where it turns, if it goes beyond its ends."""
    law, f = found.law, found.f
    size, unit = UNITS.get(law.unit, (1.0, law.unit))
    ends = []
    for axis in law.curve.axes:
        factor, of = UNITS.get(axis.kind.unit, (1.0, axis.kind.unit))
        ends.append([f"{v * factor:.3g} {of}".rstrip() for v in axis.range])
    low, high = (" and ".join(of) for of in zip(*ends, strict=True))
    first, last = float(f.flat[0]), float(f.flat[-1])
    turns = found.turns or ((0.0, float(f.min())), (0.0, float(f.max())))
    least, most = (value for _, value in turns)
    none = thresholds.NONE_OF_IT * max(-least, most)

    def said(value: float) -> str:
        return f"{size * value if abs(value) > none else 0.0:.3g}"

    if law.unit != "1":
        how = f", from {said(first)} {unit} at {low} to {said(last)} {unit} at {high}"
        extremes = f", between {said(least)} and {said(most)} {unit}"
    else:
        change = (1.0 + last) / max(1.0 + first, thresholds.LEAST_FACTOR) - 1.0
        how = f", by {_percent(change)} from {low} to {high}"
        extremes = (
            f", between {_percent(least).removesuffix(' %')} and {_percent(most)} of itself"
            " at its reference"
        )
    if f.ndim > 1:
        return how + extremes
    # Its ends say nothing of a bump or a dip, and least of all where they are alike.
    beyond = min(first, last) - least, most - max(first, last)
    factor, of = UNITS.get(law.curve.kind.unit, (1.0, law.curve.kind.unit))
    places = [
        f"the {word} at {factor * z:.3g} {of}".rstrip()
        for word, far, (z, _) in zip(("smallest", "largest"), beyond, turns, strict=True)
        if far > thresholds.FLAT * (most - least)
    ]
    return how + (f"{extremes}, {' and '.join(places)}" if places else "")


def _percent(part: float) -> str:
    return f"{round(100 * part):+d} %"
