"""Whether a law over two coordinates says much where no sample lies.

A log need not fill the plane of two coordinates: sines lie on ellipses of deflection and speed, and
what the travel has left of the former direction is nearly a function of the travel itself. The
values of a surface in the corners are then what the splines make of them, and another motion comes
there: beyond the range seen each coordinate stays at its end by itself.
"""

from __future__ import annotations

import numpy as np

from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.learned.surface import Surface


def goes_beyond_what_was_seen(found: Hypothesis) -> bool:
    """Whether any surface of a hypothesis leaves, in its plane, the values that it has at samples.

    By more than a part of their range; 0, which is no correction, is always within it.
    """
    s, weight = found.problem.block.signals, found.problem.block.weight
    for effect in found.effects:
        if not (isinstance(effect, LearnedEffect) and isinstance(effect.law.curve, Surface)):
            continue
        curve, p = effect.law.curve, effect.local(found.values)
        sizes = np.array([p[q.symbol] for q in curve.amplitudes(effect.law.unit)])
        seen = (sizes @ curve.rows(s, p))[weight > 0.0]
        low, high = min(float(seen.min()), 0.0), max(float(seen.max()), 0.0)
        z, y = (np.linspace(*axis.range, thresholds.CURVE_POINTS) for axis in curve.axes)
        plane = sizes @ curve.at_both(np.repeat(z, len(y)), np.tile(y, len(z)))
        margin = thresholds.CORNERS * (high - low)
        if plane.min() < low - margin or plane.max() > high + margin:
            return True
    return False
