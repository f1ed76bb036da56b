"""A problem as a model takes it: which samples count, and what of the paper's model they tell.

Both depend on what the model says of the rig: of the force channel, and of the duty that acts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from erdctl.bench.direction_of_motion import uncertain
from erdctl.bench.identifiability import unmet
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem
from erdctl.model.composed import Model
from erdctl.model.slots import ChannelSlot, ControlSlot, MotionSlot, Values


def as_taken(problem: Problem, model: Model, values: Values) -> Problem:
    """The problem without samples of uncertain direction, and with each beta free that it tells."""
    problem = _of_mended_velocity(told_by_control(problem, model, values), model, values)
    return _without_doubtful(problem, model, values)


def told_by_control(problem: Problem, model: Model, values: Values) -> Problem:
    """The problem with each beta free that the duty tells which acts, though not the one commanded.

    One level that is commanded fixes sigma v^beta there and neither of the two, so beta is held.
    Where an amplifier takes its time, every level between acts as well: held at 1, the yield force
    of these would be a misfit that gets the name of another effect.
    """
    betas = [n for n in problem.held if n.endswith(".beta")]
    if not betas or not model.of(ControlSlot):
        return problem
    acts = model.prepare(problem.block.signals, values).signals.duty
    lacking = unmet(replace(problem.recording, duty=acts))
    return problem.with_free(n for n in betas if n not in lacking)


def _of_mended_velocity(problem: Problem, model: Model, values: Values) -> Problem:
    """Without the samples of which a velocity that is mended does not tell the direction.

    They are others than those of the logged one: a single turn that falls on a sample is an error
    of twice the yield force, and had 87 % of what the right model left.
    """
    if not any(slot.of_samples for _, slot in model.of(MotionSlot)):
        return problem
    s = problem.block.signals
    whole, rows = (s, slice(None)) if s.sampled is None else s.sampled
    unsure = uncertain(model.prepare(whole, values).signals)[rows]
    weight = np.where(unsure, 0.0, problem.block.weight)
    return replace(problem, block=problem.block._replace(weight=weight))


def _without_doubtful(problem: Problem, model: Model, values: Values) -> Problem:
    """Without the samples that a force channel fills from ones of uncertain direction.

    A channel that is late shows the turn of a record late, too: with its uncertain direction, and
    drawn out over the samples between which the force jumps. One that averages dilutes both.
    """
    channel = model.of(ChannelSlot)
    if not channel:
        return problem
    s = problem.block.signals
    unsure = problem.unsure.copy()
    unsure[1:] |= unsure[:-1]  # and the samples that share a step with them
    unsure[:-1] |= unsure[1:]
    turned = s.turns[0]
    unsure[turned] = unsure[turned + 1] = True
    doubt = unsure.astype(np.float64)
    for effect, slot in channel:
        doubt = slot(doubt, s, effect.local(values))
    weight = np.where(doubt > thresholds.DOUBTFUL_PART, 0.0, problem.block.weight)
    return replace(problem, block=problem.block._replace(weight=weight))
