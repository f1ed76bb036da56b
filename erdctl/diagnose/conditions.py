"""Under how many conditions a log was recorded."""

from __future__ import annotations

import numpy as np

from erdctl.bench.strokes import strokes
from erdctl.core.recording import Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.kinds_of_excitation import motions


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


def few_conditions(recording: Recording) -> bool:
    """Whether a log has no more duties and no more kinds of motion than a law has parameters.

    Two levels of duty test no law of the duty and two motions none of the motion: what one effect
    leaves because its form differs a little from the true one, a second then takes, beyond any
    scatter.
    """
    apart = np.diff(np.sort(recording.duty)) >= thresholds.ONE_DUTY
    return bool(
        apart.sum() < thresholds.FEW_DUTIES and motions(recording) <= thresholds.FEW_MOTIONS
    )
