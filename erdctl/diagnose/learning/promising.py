"""Which laws promise most beside a hypothesis, by the cheap look at each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from erdctl.core.progress import part_of
from erdctl.diagnose import thresholds
from erdctl.diagnose.forward_step import Exploration, key_of
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.learning.law_screen import LawScreen
from erdctl.diagnose.learning.laws import laws, plain_laws, surfaces
from erdctl.diagnose.screening import Candidate
from erdctl.model.effect import Effect
from erdctl.model.learned.coordinates import Memory
from erdctl.model.learned.law import Law, LearnedEffect


@dataclass(frozen=True)
class Promising:
    """Laws over one coordinate, and over two, the most promising first."""

    curves: tuple[Candidate, ...]
    surfaces: tuple[Candidate, ...] = ()

    @property
    def halved_by_two(self) -> bool:
        """Whether one over two promises to leave half of what one over one leaves.

        Then none over one comes first, which would only be looked at to be replaced.
        """
        curve, surface = (
            max((c.gain for c in some), default=0.0) for some in (self.curves, self.surfaces)
        )
        return 1.0 - surface < thresholds.HALVED * (1.0 - curve)

    @property
    def plain(self) -> Promising:
        """Those over one coordinate alone."""
        return Promising(self.curves)


def promising_laws(x: Exploration, parent: Hypothesis, *, wide: bool) -> Promising:
    """The laws that promise most beside a parent; wide : over two coordinates, too."""
    curves = screened(x, parent, laws(x.problem))
    return Promising(tuple(curves), tuple(wider(x, parent, curves)) if wide else ())


def screened(
    x: Exploration, parent: Hypothesis, tried: Iterable[Law], most: int = thresholds.LAWS_FITTED
) -> list[Candidate]:
    """The laws that promise most beside a parent."""
    x.executor.progress("screening", part_of("laws to learn", 1, 1))
    known = key_of(parent.effects)
    taken = {place_of(e.law) for e in learned_in(parent.effects) if not e.law.curve.kind.late}
    new = (law for law in tried if law.name not in known and place_of(law) not in taken)
    return promising(x, parent, (law.effect for law in new), most)


def place_of(law: Law) -> tuple[str, ...]:
    """The slot and the coordinates; a curve over x can be any over its size."""
    return law.slot, *(axis.coordinate.removeprefix("abs_") for axis in law.curve.axes)


def promising(
    x: Exploration, parent: Hypothesis, tried: Iterable[Effect], most: int
) -> list[Candidate]:
    """The effects that promise most beside a parent; of the curves of one coordinate one."""
    every = max(1, len(x.problem.block.force) // thresholds.LAW_SAMPLES)
    screen = LawScreen(x.problem, parent, x.executor.most, every)
    found = [c for c in map(screen.candidate, tried) if c is not None]
    of: dict[object, Candidate] = {}
    for c in found:  # those with fewer knots come first
        kind, late = _kind(c.effect)
        if kind not in of or (1.0 if late else thresholds.AS_FEW) * c.gain > of[kind].gain:
            of[kind] = c
    return sorted(of.values(), key=lambda c: -c.gain)[:most]


def _kind(effect: Effect) -> tuple[object, bool]:
    """What curves of few and of many knots, or over several times, have in common; whether over
    times."""
    if not isinstance(effect, LearnedEffect):
        return effect.name, False
    curve = effect.law.curve
    return (effect.law.slot, *(axis.coordinate for axis in curve.axes)), curve.kind.late


def wider(x: Exploration, parent: Hypothesis, curves: Sequence[Candidate]) -> list[Candidate]:
    """Laws over two coordinates that could take far more than any over one.

    Beside those of promising curves; where none of these could take most, beside any.
    """
    found = [c.effect.law for c in curves if isinstance(c.effect, LearnedEffect)]
    most = max((c.gain for c in curves), default=0.0)
    if most < thresholds.MOST_OF_IT:
        found += plain_laws(x.problem)
    every = (s for law in found for s in surfaces(x.problem, law, Memory(law.curve.tau)))
    tried = {
        (law.slot, frozenset(a.coordinate for a in law.curve.axes)): law for law in every
    }.values()
    least = most + thresholds.WIDER * (1.0 - most)
    wide = screened(x, parent, tried, thresholds.SURFACES_FITTED)
    return [c for c in wide if c.gain > least]


def learned_in(effects: Iterable[Effect]) -> list[LearnedEffect]:
    """Those of some effects that were learned."""
    return [e for e in effects if isinstance(e, LearnedEffect)]
