"""What a diagnosis says of what is left where that is noise: how much, and where it is not."""

from __future__ import annotations

import numpy as np

from erdctl.bench.unknown_direction import shares
from erdctl.core.blocks import SETTLE
from erdctl.diagnose import thresholds
from erdctl.diagnose.diagnosis import Diagnosis


def noise_text(found: Diagnosis) -> str:
    """That what is left is noise, or nearly so beside all that was missing."""
    left, rms = found.lack_of_fit, found.carried.overall.rms
    best = (found.learned or found).selection.best
    unsure = shares(best.problem.unsure, best.residual**2)
    of_unsure = "" if unsure is None else unsure.beside(rms)
    weighed = rms if unsure is None else rms * unsure.others
    if unsure is None and rms > thresholds.ALL_OVER_WEIGHED * best.rms:
        weighed = best.rms
        of_unsure = (
            "; of all samples, with those next to turns and where records begin, which no fit"
            f" weighs, it is {rms:.3g} N"
        )
    told = f"{weighed:.3g} N rms"
    noise, misfit = left.noise_rms, left.misfit_rms
    if not left.significant or misfit <= thresholds.MISFIT_OVER_NOISE * noise:
        return f"what remains, {told}, is noise as far as these data tell{of_unsure}"
    share = misfit**2 / max(found.selection.base.score - noise**2, 1e-300)
    return (
        f"what remains, {told}, is a noise of {noise:.3g} N and {misfit:.3g} N that motion and duty"
        f" still predict, {100 * share:.2g} % of the square of what was missing: too little beside"
        f" that for a name{of_unsure}"
    )


def begins_text(found: Diagnosis) -> str:
    """That records begin with a misfit, where nothing weighs it."""
    best = found.selection.best
    s, weight = best.problem.block.signals, best.problem.block.weight
    begun = np.repeat(s.t[s.starts[:-1]], np.diff(s.starts))
    first = (weight == 0.0) & (s.t - begun <= SETTLE) & ~best.problem.unsure
    if not first.any():
        return ""
    there, behind = (
        float(np.sqrt(np.mean(best.residual[part] ** 2))) for part in (first, weight > 0.0)
    )
    if there < thresholds.BEGINS * behind:
        return ""
    return (
        f"; in the first {SETTLE:g} s of records, which no fit weighs since states settle there, it"
        f" is {there:.3g} N rms, and {behind:.3g} N behind that: with which state a"
        " record begins is not told, and what acts there alone is not looked for"
    )
