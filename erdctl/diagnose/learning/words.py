"""A learned law in an engineer's words."""

from __future__ import annotations

import numpy as np

from erdctl.diagnose import thresholds
from erdctl.diagnose.learning.stage import LearnedLaw
from erdctl.model.learned.law import Law, LawSlot

OF = {
    LawSlot.FORCE: "a force",
    LawSlot.FRICTION: "a force against the motion",
    LawSlot.YIELD: "the yield force",
    LawSlot.VISCOUS: "the viscous force",
    LawSlot.GAS: "the force of the gas",
    LawSlot.FLUID: "the yield and the viscous force",
}


UNITS = {"m": (1e3, "mm"), "m/s": (1e3, "mm/s"), "1": (1.0, "")}


def law_words(law: Law, tau: float | None = None) -> str:
    """Which law it is; tau : the time constant of its memory [s]."""
    verb = "depends" if law.slot.adds else "change" if law.slot is LawSlot.FLUID else "changes"
    by = "on" if law.slot.adds else "with"
    over = "" if tau is None else f" (over {tau:.3g} s)"
    that = " that" if law.slot.adds else ""
    return f"{OF[law.slot]}{that} {verb} {by} {law.curve.kind.words}{over}"


def law_text(found: LearnedLaw) -> str:
    """A law, how far it goes, and what it is worth."""
    law, f, worth = found.law, found.f, found.finding
    factor, unit = UNITS.get(law.curve.kind.unit, (1.0, law.curve.kind.unit))
    low, high = (f"{v * factor:.3g} {unit}".rstrip() for v in law.curve.range)
    if law.slot.adds:
        how = f", from {f[0]:.3g} N at {low} to {f[-1]:.3g} N at {high}"
        extremes = f", between {f.min():.3g} and {f.max():.3g} N"
    else:
        change = (1.0 + f[-1]) / max(1.0 + f[0], thresholds.LEAST_FACTOR) - 1.0
        how = f", by {100 * change:+.0f} % from {low} to {high}"
        extremes = (
            f", between {100 * f.min():+.0f} and {100 * f.max():+.0f} % of itself at its reference"
        )
    rises = np.diff(f) * np.sign(f[-1] - f[0])
    between = "" if float(rises.min()) >= -thresholds.FLAT * float(np.ptp(f)) else extremes
    text = law_words(law, found.tau) + how + between
    text += (
        f": leaving it out costs {100 * worth.gain.gain:.0f} % of the mean square error on data"
        f" that the fit had not seen (NRMSE {worth.before:.4f} without it, {worth.after:.4f} with"
        " it)"
    )
    if found.alike:
        text += f"; as well would do {' or '.join(law_words(a) for a in found.alike)}"
    if worth.test is not None:
        text += worth.test.advice("them apart")
    return text
