"""Whether a law corrects a term of the paper's model, or takes its place.

Beyond the range seen a curve stays at its end value; the yield force goes on with the duty cycle,
the viscous force with the speed, the gas force with the stroke. A force over the duty of late fits
as well as the yield force with its lag, which then falls to nothing, and misses the first higher
duty.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis

GROUPS = ("gas", "viscous", "yield")


def takes_the_place_of_a_term(parent: Hypothesis, found: Hypothesis) -> bool:
    """Whether next to nothing is left, in one direction, of a term that told beside the parent."""
    before, after = _sizes(parent), _sizes(found)
    telling = before > float(np.sqrt(np.mean(parent.residual**2)))
    return bool((telling & (after < thresholds.TERM_LEFT * before)).any())


def _sizes(hypothesis: Hypothesis) -> Array:
    """(3, 2) rms of each group of the model's forces in compression and in release [N]."""
    s, model = hypothesis.problem.block.signals, hypothesis.model
    parts = model.parts(s, hypothesis.values)
    ways = (s.compressing, ~s.compressing)
    return np.array(
        [[float(np.sqrt(np.mean(parts[g][w] ** 2))) if w.any() else 0.0 for w in ways]
         for g in GROUPS]
    )  # fmt: skip
