"""Whether a law says much where no sample lies.

A log need not span a coordinate without gaps: between its levels a curve is what the splines make
of it. It need not fill the plane of two coordinates: sines lie on ellipses of deflection and speed,
and what the travel has left of the former direction is nearly a function of the travel itself. The
values of a surface in the corners are then what the splines make of them, and another motion comes
there: beyond the range seen each coordinate of a surface stays at its end by itself.
"""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.learned.surface import Surface
from erdctl.model.slots import Values


def goes_beyond_what_was_seen(found: Hypothesis) -> bool:
    """Whether any law of a hypothesis leaves, in its range, the values that it has at samples.

    By more than a part of their range; 0, which is no correction, is always within it. Or whether
    one moves the piston farther than the rod goes: that is another stiffness, and a velocity which
    is taken from the deflection.
    """
    s, weight = found.problem.block.signals, found.problem.block.weight
    for effect in found.effects:
        if not isinstance(effect, LearnedEffect):
            continue
        curve, p = effect.law.curve, effect.local(found.values)
        sizes = np.array([p[q.symbol] for q in curve.amplitudes(effect.law.unit)])
        seen = (sizes @ curve.rows(s, p))[weight > 0.0]
        if effect.law.unit == "m" and np.std(seen) > np.std(s.x[weight > 0.0]):
            return True
        low, high = min(float(seen.min()), 0.0), max(float(seen.max()), 0.0)
        all_ = sizes @ _everywhere(curve, p)
        margin = thresholds.CORNERS * (high - low)
        if all_.min() < low - margin or all_.max() > high + margin:
            return True
    return False


def _everywhere(curve: Curve, p: Values) -> Array:
    """(k, n) rows of a curve at values of its coordinates over their whole range."""
    z = [np.linspace(*axis.range, thresholds.CURVE_POINTS) for axis in curve.axes]
    if isinstance(curve, Surface):
        return curve.at_both(np.repeat(z[0], len(z[1])), np.tile(z[1], len(z[0])))
    return curve.at(z[0], p)
