"""What of a residual only tells records apart: a gain and a zero of the force of each.

No motion within a record predicts that, so that to regressions it is noise, and yet it is the rig's
or the damper's. Of a rig the gains are alike within what its calibration holds; where they are not,
that is a misfit, whether it is the rig's or of what changes from record to record in the damper.
"""

from __future__ import annotations

import numpy as np

from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis, with_columns
from erdctl.diagnose.record_effects import RecordEffects, Varying, estimate


def with_levels(hypothesis: Hypothesis, of: Hypothesis | None = None) -> Hypothesis:
    """A hypothesis with a gain and a zero of each record beside its own parameters.

    of : whose force the gains are of, if not its own
    """
    own = of or hypothesis
    s = own.problem.block.signals
    modelled = own.model.force(s, own.values)
    records = np.repeat(np.eye(len(s.starts) - 1), np.diff(s.starts), axis=1)
    return with_columns(hypothesis, np.vstack([records * modelled, records]))


def records_apart(best: Hypothesis) -> tuple[float, Hypothesis] | None:
    """Standard deviation [1] of the gains of records beyond their errors, and the model with these.

    None where they are those of a rig, or where most of the residual is something else.
    """
    block = best.problem.block
    count = len(block.signals.starts) - 1
    if count < 2:
        return None
    begun = best.record_effects or RecordEffects.none(count)
    modelled = best.model.force(block.signals, best.values)
    both = Varying(gain=True, offset=True)
    found = estimate(both, begun.shared(block), modelled, RecordEffects.none(count))
    apart = float(np.std(found.gain, ddof=1))
    if apart < thresholds.RIG_GAIN:
        return None
    own = with_levels(best)
    return (apart, own) if _taken(best, own) >= thresholds.LEVELS_SAID else None


def _taken(best: Hypothesis, own: Hypothesis) -> float:
    weight = best.problem.block.weight
    before, after = (float(np.dot(weight, h.residual**2)) for h in (best, own))
    return 1.0 - after / before if before > 0.0 else 0.0
