"""Under how many conditions a log was recorded."""

from __future__ import annotations

import numpy as np

from erdctl.bench.strokes import strokes
from erdctl.core.recording import Recording
from erdctl.diagnose import thresholds


def one_condition(recording: Recording) -> bool:
    """Whether a log has one duty and one speed: the same stroke again and again.

    Then the force is known along one loop of deflection and speed, on which laws differ less than
    their parameters can make up for.
    """
    if float(np.ptp(recording.duty)) >= thresholds.ONE_DUTY:
        return False
    found = strokes(recording)
    if not len(found):
        return True
    speed = found.highest(np.abs(recording.xdot))
    return float(np.ptp(speed)) < thresholds.ONE_SPEED * float(speed.max())
