"""What carries over to kinds of motion that the fit has not seen, by fits without them.

Cross-validation leaves out records that have their like in the fit, and one Gauss-Newton step: it
cannot show that a rich model, however well it predicts these, fails at another stroke or frequency.
Here each kind of motion is left out whole, and the model fitted anew to the others. An effect
without which the kinds left out are predicted better is no physics that carries over.

A parameter that the rest says nothing of stays where all data had it: what only one kind of motion
shows is not held against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from erdctl.core.progress import part_of
from erdctl.core.recording import Array, Index
from erdctl.diagnose import thresholds
from erdctl.diagnose.as_taken import as_taken
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.forward_step import Exploration, key_of
from erdctl.diagnose.hypothesis import Hypothesis, fitted_from, over_records
from erdctl.diagnose.kinds_of_excitation import duties_known, kinds_of_motion
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.thin import thinned
from erdctl.estimate.linearisation import jacobian
from erdctl.model.composed import Model
from erdctl.model.learned.law import LearnedEffect


def to_other_records(x: Exploration, best: Hypothesis) -> Hypothesis:
    """Remove effects without which whole records that the fit leaves out are predicted better.

    Left-out stretches have neighbours of the same motion in the fit, and so may speak for what only
    holds there. A correction that carries over to no other record is none. One Gauss-Newton step
    can go astray where a law is far from straight, as a void is: what it speaks against is judged
    by fits anew. Records with duties that no other holds say nothing: what is missed there is how
    the force goes on beyond the levels of a fit.
    """
    known = duties_known(x.problem.recording)
    if np.count_nonzero(known) < thresholds.LEAST_RECORDS:
        return best
    few = thinned(x.problem, thresholds.CARRY_SAMPLES)
    of_record = _of_record(few)
    says, few_say = (np.repeat(known, np.diff(p.block.signals.starts)) for p in (x.problem, few))
    while x.added(best):
        whole = _counted(over_records(best), says)
        fewer = [h for h in without_each(x, best) if x.executor.possible(h.values)]
        smaller = [*fewer, x.explored[key_of(x.base.effects)]]
        gains = [compare(x.problem, _counted(over_records(h), says), whole).gain for h in smaller]
        worst = min(range(len(gains)), key=lambda i: (gains[i], i))
        if gains[worst] > 0.0:
            break
        x.executor.progress("other records", part_of("fits without some records", 1, 1))
        one, other = (_error(few, of_record, h, few_say) for h in (best, smaller[worst]))
        if one < other:
            break
        best = smaller[worst]
    return best


def _counted(hypothesis: Hypothesis, says: npt.NDArray[np.bool_]) -> Hypothesis:
    """The same fit, of which only some samples (n,) are counted."""
    problem = hypothesis.problem
    block = problem.block._replace(weight=np.where(says, problem.block.weight, 0.0))
    return replace(hypothesis, problem=replace(problem, block=block))


def to_other_motions(x: Exploration, best: Hypothesis, *, or_records: bool = False) -> Hypothesis:
    """A hypothesis without the effects that do not carry over, the worst first.

    or_records : where every record is of a kind of its own, some that are near each other are left
        out together, so that a law has to hold at another stroke or speed than those that it was
        learned at; and where all are of one kind, records
    """
    few = thinned(x.problem, thresholds.CARRY_SAMPLES)
    kinds = kinds_of_motion(few.recording, coarse=or_records)
    if kinds is None and or_records and len(few.recording.names) > 1:
        kinds = _of_record(few)
    if kinds is None:
        return best
    errors: dict[frozenset[str], float] = {}

    def found(hypotheses: Sequence[Hypothesis]) -> list[float]:
        new = [h for h in hypotheses if key_of(h.effects) not in errors]
        errors.update((key_of(h.effects), float("inf")) for h in new)
        new = [h for h in new if x.executor.possible(h.values)]
        missed = x.executor.each(x.problem, partial(_error_without, kinds=kinds), new)
        errors.update(zip((key_of(h.effects) for h in new), missed, strict=True))
        return [errors[key_of(h.effects)] for h in hypotheses]

    # All the way down: of effects that stand in for one another none alone may be the one too many.
    least = best
    while x.added(best):
        x.executor.progress("other motions", part_of("fits without a kind of motion", 1, 1))
        fewer = without_each(x, best)
        of_least, *of_fewer = found([least, *fewer])
        best = fewer[int(np.argmin(of_fewer))]
        dear = best.score > thresholds.DEAR * least.score  # too much for a hair's breadth elsewhere
        if min(of_fewer) * (thresholds.CLEARLY if dear else 1.0) <= of_least:
            least = best
    return least


def to_every_kind(x: Exploration, best: Hypothesis) -> Hypothesis:
    """A hypothesis without the learned laws that may fail at the next kind of motion.

    What an effect of the catalogue says holds wherever it is valid; a curve was seen at some
    strokes and speeds. What it gains on each kind that is left out, as the logarithm of the mean
    square, has a mean and a scatter over the kinds: a law stays where another kind that lies by as
    much from the mean would still gain, and where it gains on the kinds on which it acts: one that
    acts on a single kind, and there says nothing once it is left out, still helps the others, whose
    fit is rid of that kind.
    """
    few = thinned(x.problem, thresholds.CARRY_SAMPLES)
    kinds = kinds_of_motion(few.recording, coarse=True)
    while True:
        fewer = [
            (gone, rest) for rest in without_each(x, best) for gone in best.effects
            if isinstance(gone, LearnedEffect) and gone.name not in key_of(rest.effects)
        ]  # fmt: skip
        if not fewer:
            return best
        if kinds is None:
            gains = [compare(x.problem, rest, best).gain for _, rest in fewer]
            unlikely = [_at_another(np.array([1.0 - g]), np.ones(1), np.ones(1)) for g in gains]
        else:
            of_kind = partial(_by_kind_without, kinds=kinds)
            of_best, *of_rests = x.executor.each(x.problem, of_kind, [best, *(r for _, r in fewer)])
            unlikely = [
                _at_another(of_best, of_rest, _acts(few, kinds, best, gone))
                for (gone, _), of_rest in zip(fewer, of_rests, strict=True)
            ]
        worst = int(np.argmax(unlikely))
        if unlikely[worst] < 0.0:
            return best
        best = fewer[worst][1]


def _acts(problem: Problem, kinds: Index, hypothesis: Hypothesis, law: LearnedEffect) -> Array:
    """(k,) sum of squares of the force of a law in each kind [N^2]."""
    s = problem.block.signals
    force, without = (
        hypothesis.model.force(s, values)
        for values in (hypothesis.values, {**hypothesis.values, **law.off})
    )
    return np.asarray(
        np.bincount(kinds, problem.block.weight * (force - without) ** 2), dtype=float
    )


def _at_another(best: Array, rest: Array, acts: Array) -> float:
    """What the mean square of one kind more may change by, as a logarithm.

    best, rest : (k,) of each kind left out, with the law and without; 0 of one without weight,
        which says nothing
    acts : (k,) how much the law acts in each; the mean over the kinds, each counted by that, must
        be a gain as well, if only by the least scatter
    Check: three kinds of which 0.8 is left say too little of a fourth, ln 0.8 + 0.3 = 0.08; 0.6 is
    enough, -0.51 + 0.3 = -0.21, beside a kind without weight as well. Nor do kinds say anything
    where it does not act.
    >>> left = [0.8, 0.8, 0.8, 0], [0.6, 0.6, 0.6, 0], [0.2, 0.3, 1.0, 0]
    >>> acts = [1, 1, 1, 0], [1, 1, 1, 1], [0, 0, 1, 0]
    >>> rest = np.array([1, 1, 1, 0])
    >>> [round(_at_another(np.array(b), rest, np.array(a)), 2) for b, a in zip(left, acts)]
    [0.08, -0.21, 0.3]
    """
    told = (best > 0.0) & (rest > 0.0)
    if not np.any(told):
        return thresholds.NEW_KIND
    changes, acts = np.log(best[told] / rest[told]), acts[told]
    scatter = float(np.std(changes, ddof=1)) if len(changes) > 1 else 0.0
    another = float(np.mean(changes)) + max(scatter, thresholds.NEW_KIND)
    where = float(np.average(changes, weights=acts)) if np.any(acts) else 0.0
    return max(another, where + thresholds.NEW_KIND)


def _by_kind_without(problem: Problem, hypothesis: Hypothesis, kinds: Index) -> Array:
    """Mean square error of each kind that is left out, on fewer samples [N^2]."""
    missed, weight = _missed(thinned(problem, thresholds.CARRY_SAMPLES), kinds, hypothesis)
    total, count = (np.bincount(kinds, w) for w in (weight * missed**2, weight))
    return np.asarray(total / np.maximum(count, 1e-300))


def carries_over_as_well(x: Exploration, rival: Hypothesis, best: Hypothesis) -> bool:
    """Whether kinds of motion that are left out are predicted no worse by a rival.

    Or else it could bring back, under another name, what `to_other_motions` has left out.
    """
    few = thinned(x.problem, thresholds.CARRY_SAMPLES)
    kinds = kinds_of_motion(few.recording)
    if kinds is None:
        return True
    theirs, own = x.executor.each(x.problem, partial(_error_without, kinds=kinds), [rival, best])
    return theirs <= own


def _of_record(problem: Problem) -> Index:
    """(n,) which records are left out together, one by one where they are few."""
    starts = problem.block.signals.starts
    return np.repeat(np.arange(len(starts) - 1) % thresholds.CARRY_FITS, np.diff(starts))


def left_out_exactly(problem: Problem, kinds: Index, hypothesis: Hypothesis) -> Array:
    """(n,) residual of each kind (n,) of the samples by a fit to all others, from the whole fit."""
    out = np.zeros(len(kinds))
    weight = problem.block.weight
    told = _told_by(problem, kinds, hypothesis)
    for k in range(int(kinds.max()) + 1):
        block = problem.block._replace(weight=np.where(kinds == k, 0.0, weight))
        alone = told.alone(k)
        held = {**problem.held, **{name: hypothesis.values[name] for name in alone}}
        rest = replace(problem, block=block, held=held)
        found = fitted_from(rest, hypothesis, thresholds.STEPS_CARRY, weight)
        found = np.where(np.isfinite(found), found, block.force)  # what diverges predicts nothing
        out[kinds == k] = found[kinds == k]
    return out


@dataclass(frozen=True, eq=False)
class _Told:
    """What each kind of the samples tells of parameters, by the slopes of the force.

    names : (p,);  own : those of the paper's model;  gram : (k, p, p) J' W J of each kind, each
        slope scaled to 1 over all
    """

    names: tuple[str, ...]
    own: frozenset[str]
    gram: Array

    def alone(self, kind: int) -> list[str]:
        """Parameters of which all other kinds tell nothing, or nothing while others are free.

        Each by itself, as a time constant where no other kind has steps; and of the paper's model,
        of which the rest may have one level of duty, also the one that it tells least of beside
        the others (sigma v^beta at one v), until it tells something of each that is left. An effect
        that only one kind needs is to fail without it, and is not held for that.
        """
        whole = self.gram.sum(axis=0)
        rest = whole - self.gram[kind]
        least = thresholds.TOLD
        found = [n for n, part in zip(self.names, np.diag(rest), strict=True) if part < least]
        while True:
            free = [i for i, n in enumerate(self.names) if n not in found]
            some = np.ix_(free, free)
            part = _beside(rest[some]) / _beside(whole[some])
            own = [
                (float(p), i) for p, i in zip(part, free, strict=True) if self.names[i] in self.own
            ]
            if not own or min(own)[0] >= least:
                return found
            found.append(self.names[min(own)[1]])


def _beside(gram: Array) -> Array:
    """(p,) what is told of each parameter while all others are free, 1 / (N^-1)_ii."""
    ridge = thresholds.CV_SINGULAR * np.eye(len(gram))
    return np.asarray(1.0 / np.diag(np.linalg.inv(gram + ridge)))


def _told_by(problem: Problem, kinds: Index, hypothesis: Hypothesis) -> _Told:
    """What each kind tells of the parameters.

    Of what is anchored in any fit, and of learned laws, which have a rule of their own (`told`),
    nothing is said.
    """
    effects = hypothesis.effects
    other = {e.key(q.symbol) for e in effects if e.smooth for q in e.sizes}
    other |= {n for e in effects if isinstance(e, LearnedEffect) for n in e.off}
    names = tuple(n for n in hypothesis.free if n not in other)
    J = jacobian(hypothesis.model, problem.block.signals, hypothesis.values, names)
    J = J * np.sqrt(problem.block.weight)
    J = J / np.maximum(np.linalg.norm(J, axis=1), 1e-300)[:, None]
    count = int(kinds.max()) + 1
    gram = np.array([J[:, kinds == k] @ J[:, kinds == k].T for k in range(count)])
    return _Told(names, frozenset(Model().quantities), gram)


def _error_without(problem: Problem, hypothesis: Hypothesis, kinds: Index) -> float:
    """`_error` on fewer samples of a problem, in whichever process."""
    return _error(thinned(problem, thresholds.CARRY_SAMPLES), kinds, hypothesis)


def _error(
    problem: Problem,
    kinds: Index,
    hypothesis: Hypothesis,
    says: npt.NDArray[np.bool_] | None = None,
) -> float:
    """Mean square of `left_out_exactly` [N^2], of some samples (n,) or of all."""
    missed, weight = _missed(problem, kinds, hypothesis)
    return float(np.average(missed**2, weights=weight if says is None else weight * says))


def _missed(problem: Problem, kinds: Index, hypothesis: Hypothesis) -> tuple[Array, Array]:
    """(n,) of `left_out_exactly` [N], and the weights of its samples."""
    part = as_taken(problem, hypothesis.model, hypothesis.values)
    return left_out_exactly(part, kinds, hypothesis), part.block.weight
