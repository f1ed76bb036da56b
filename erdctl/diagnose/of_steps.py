"""What a fit owes to the steps in which it was simulated, where its piston sticks and slips.

Behind a spring, under friction that falls with speed, the piston slips between the samples of a
log; simulated from sample to sample it goes on as no damper does, and a fit finds the parameters at
which that suits. On a friction damper such a model left 2.1 kN^2 in the steps of the search, 7.2 in
finer ones and 6.4 on all samples, to which the search's names were then held.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.estimate.finer import Finer
from erdctl.model.slots import SeriesSlot


def as_it_slips(hypothesis: Hypothesis) -> Hypothesis:
    """A hypothesis that is judged by finer steps, where those of its fit hide that it slips.

    Its parameters and residual are those of the fit.
    """
    model, values, block = hypothesis.model, hypothesis.values, hypothesis.problem.block
    if not model.of(SeriesSlot):
        return hypothesis
    finer = Finer.of(block.signals)
    change = finer.force(model, values) - model.force(block.signals, values)
    if hypothesis.record_effects is not None:
        change *= hypothesis.record_effects.along(block.signals.starts)[0]
    missed = float(np.average((hypothesis.residual - change) ** 2, weights=block.weight))
    if not (missed > thresholds.OF_STEPS * hypothesis.rms**2 and hypothesis.slips):
        return hypothesis
    return replace(hypothesis, cross_validated=hypothesis.cross_validated - change)
