"""Whether a law corrects a term of the paper's model, or a name, or takes its place.

Beyond the range seen a curve stays at its end value; the yield force goes on with the duty cycle,
the viscous force with the speed, the gas force with the stroke. A force over the duty of late fits
as well as the yield force with its lag, which then falls to nothing, and misses the first higher
duty.

A curve fits better than an effect whose form is a little off, and does the same. The effect is what
is there, and has a name; the rest of its form is what is to be learned.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.model.effect import Effect
from erdctl.model.learned.law import LearnedEffect

GROUPS = ("gas", "viscous", "yield")


def takes_the_place_of_a_term(parent: Hypothesis, found: Hypothesis) -> bool:
    """Whether next to nothing is left, in one direction, of a term that told beside the parent."""
    before, after = _sizes(parent), _sizes(found)
    telling = before > float(np.sqrt(np.mean(parent.residual**2)))
    return bool((telling & (after < thresholds.TERM_LEFT * before)).any())


def said_again(named: Hypothesis, found: Hypothesis) -> tuple[Effect, ...]:
    """The names that a hypothesis lacks, and whose part of the force its laws make again."""
    known = {e.name for e in found.effects}
    laws = [e for e in found.effects if isinstance(e, LearnedEffect)]
    instead, weight = _done_by(found, laws), found.problem.block.weight
    most = thresholds.NAME_LEFT * float(np.dot(weight, instead**2))
    return tuple(
        e for e in named.effects
        if e.name not in known
        and float(np.dot(weight, (_done_by(named, [e]) - instead) ** 2)) <= most
    )  # fmt: skip


def still_act(names: Iterable[Effect], alone: Hypothesis, beside: Hypothesis) -> bool:
    """Whether beside laws more is left of each name than of a term whose place is taken."""
    return all(
        float(np.linalg.norm(_done_by(beside, [e])))
        > thresholds.TERM_LEFT * float(np.linalg.norm(_done_by(alone, [e])))
        for e in names
    )


def _done_by(hypothesis: Hypothesis, effects: Sequence[Effect]) -> Array:
    """(n,) what some of its effects do to the force [N]."""
    s, model, values = hypothesis.problem.block.signals, hypothesis.model, hypothesis.values
    off = {name: value for e in effects for name, value in e.off.items()}
    return model.force(s, values) - model.force(s, {**values, **off})


def _sizes(hypothesis: Hypothesis) -> Array:
    """(3, 2) rms of each group of the model's forces in compression and in release [N]."""
    s, model = hypothesis.problem.block.signals, hypothesis.model
    parts = model.parts(s, hypothesis.values)
    ways = (s.compressing, ~s.compressing)
    return np.array(
        [[float(np.sqrt(np.mean(parts[g][w] ** 2))) if w.any() else 0.0 for w in ways]
         for g in GROUPS]
    )  # fmt: skip
