"""Under how many conditions a log was recorded."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.strokes import strokes
from erdctl.core.recording import Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.kinds_of_excitation import motions
from erdctl.model.effect import Effect, Requirement, Stage


def cannot_tell(recording: Recording, named: Sequence[Effect]) -> str:
    """Under which conditions a log was recorded that cannot tell what is named, or nothing."""
    if not named:
        return ""
    if one_condition(recording):
        return "one duty and one speed"
    of_speed = any(Requirement.SPEEDS in effect.requires for effect in named)
    return "one speed but for turns" if of_speed and one_speed_but_turns(recording) else ""


def cannot_tell_several(recording: Recording, named: Sequence[Effect]) -> str:
    """Under which conditions a log was recorded that cannot tell several effects, or nothing.

    Of one kind of motion place and speed go along one loop, so that damping by place, beside other
    laws, is as well one by speed. Under one sine at five duties a damper with a physics that the
    catalogue does not have was explained by four laws, one of them by place, which at other strokes
    missed 40 times as much as the paper's model.
    """
    if few_conditions(recording):
        return "two duties and two kinds of motion at most"
    by_place = any(effect.stage is Stage.POSITION for effect in named)
    return "one kind of motion, all strokes alike" if by_place and one_motion(recording) else ""


def most_told(recording: Recording, most: int) -> int:
    """Effects in one model at most: of a log of one loop the data end no search before its noise
    has names (nine of them, in four minutes, around a fault of 2.5 % in AR(1) noise)."""
    return min(most, thresholds.MOST_OF_ONE_LOOP) if one_condition(recording) else most


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


def one_speed_but_turns(recording: Recording) -> bool:
    """Whether the rod has one speed, as of a triangle, but for the samples next to its turns.

    How it goes round there is what a filter in the channel of the deflection, or of the velocity,
    makes of it: a yield force that passes to its other side a sample apart from the measured speed
    looks like a law of the speed. Of two dampers that had nothing hidden, under a triangle behind a
    filter of 20 Hz at 100 Hz, a shear thinning took 4 % of the noise, most of it in three samples.
    """
    v = recording.xdot
    near = np.zeros(len(v), dtype=np.bool_)
    turn = np.flatnonzero(np.diff(np.sign(v)) != 0.0)
    for reach in range(-thresholds.TURNING, thresholds.TURNING):
        near[np.clip(turn + 1 + reach, 0, len(v) - 1)] = True
    if near.mean() > 0.5:  # too few samples in a stroke to tell
        return False
    low, middle, high = np.quantile(np.abs(v[~near]), [0.05, 0.5, 0.95])
    return bool(high - low < thresholds.ONE_SPEED_BUT_TURNS * middle)


def one_motion(recording: Recording) -> bool:
    """Whether all records are of one kind of motion, and half of the strokes or more alike.

    Then no law of the motion is tested on another one. What a real damper's log of 5 mm at
    3 Hz names predicts 25 mm at 0.5 Hz worse (0.21 of the range) than the paper's model (0.14).
    """
    found = strokes(recording)
    if motions(recording) > 1 or not len(found):
        return not len(found)
    low, high = np.quantile(found.highest(np.abs(recording.xdot)), [0.25, 0.75])
    return bool(high < thresholds.KIND_FACTOR * low)


def slow_far_out(recording: Recording) -> tuple[float, float, float] | None:
    """Where a log has large deflections at low speeds alone.

    Returns (distance from the middle of the stroke [m], highest speed beyond it, and of all [m/s]),
    the distance being half of the farthest; None where the speeds there are not far lower. Of 25 mm
    at 0.1 Hz and 5 mm at 3 Hz of a real damper a damping by place was found that leaves 0.078 of
    the range at 25 mm and 0.5 Hz, where the paper's model leaves 0.062 and the rest of what was
    found 0.028.
    """
    low, high = float(recording.x.min()), float(recording.x.max())
    away, speed = np.abs(recording.x - 0.5 * (low + high)), np.abs(recording.xdot)
    beyond = thresholds.FAR_OUT * (high - low)
    far = away > beyond
    if not far.any():
        return None
    most = thresholds.ALMOST_ALL
    there, anywhere = (float(np.quantile(v, most)) for v in (speed[far], speed))
    return (beyond, there, anywhere) if there < thresholds.SLOW * anywhere else None


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
