"""What carries over to kinds of motion that the fit has not seen, by fits without them.

Cross-validation leaves out records that have their like in the fit, and one Gauss-Newton step: it
cannot show that a rich model, however well it predicts these, fails at another stroke or frequency.
Here each kind of motion is left out whole, and the model fitted anew to the others. An effect
without which the kinds left out are predicted better is no physics that carries over.

A parameter that the rest says nothing of stays where all data had it: what only one kind of motion
shows is not held against it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from erdctl.core.progress import part_of
from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis, fitted_from
from erdctl.diagnose.kinds_of_excitation import kinds_of_motion
from erdctl.diagnose.problem import Problem, mask_doubtful
from erdctl.diagnose.thin import thinned


def to_other_motions(x: Exploration, best: Hypothesis) -> Hypothesis:
    """A hypothesis without the effects that do not carry over, the worst first."""
    few = thinned(x.problem, thresholds.CARRY_SAMPLES)
    kinds = kinds_of_motion(few.recording)
    if kinds is None:
        return best
    errors: dict[frozenset[str], float] = {}

    def error(h: Hypothesis) -> float:
        key = frozenset(e.name for e in h.effects)
        if key not in errors:
            errors[key] = _error(few, kinds, h)
        return errors[key]

    while x.added(best):
        x.executor.progress("other motions", part_of("fits without a kind of motion", 1, 1))
        smaller = without_each(x, best)
        least = min(smaller, key=error)
        if error(best) < error(least):
            break
        best = least
    return best


def left_out_exactly(problem: Problem, kinds: Index, hypothesis: Hypothesis) -> Array:
    """(n,) residual of each kind (n,) of the samples by a fit to all others, from the whole fit."""
    out = np.zeros(len(kinds))
    weight = problem.block.weight
    for k in range(int(kinds.max()) + 1):
        block = problem.block._replace(weight=np.where(kinds == k, 0.0, weight))
        rest = replace(problem, block=block)
        found = fitted_from(rest, hypothesis, thresholds.STEPS_CARRY)
        found = np.where(np.isfinite(found), found, block.force)  # what diverges predicts nothing
        out[kinds == k] = found[kinds == k]
    return out


def _error(problem: Problem, kinds: Index, hypothesis: Hypothesis) -> float:
    """Mean square of `left_out_exactly` [N^2]."""
    part = mask_doubtful(problem, hypothesis.model, hypothesis.values)
    missed = left_out_exactly(part, kinds, hypothesis)
    return float(np.average(missed**2, weights=part.block.weight))
