"""Effects that a few records cannot tell from the error of another one's form.

No damper follows the law of a catalogue to the last per cent. What a strong effect leaves because
its form is another one by a little is no noise, and some other effect always takes a part of it,
or a richer form in its own place does: friction that falls with speed that of constant friction.
Many records that differ show that this does not carry over, see `carry_over`; a few do not. Nor
does a piston that sticks and slips behind a spring, as friction that falls with speed makes it:
such a model finds itself some place for its jumps in any log, and no parameter of it is told.
"""

from __future__ import annotations

from collections.abc import Sequence

from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.comparison import compare_alike, ranked
from erdctl.diagnose.executor import Task
from erdctl.diagnose.forward_step import Exploration, key_of, with_effect
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.residual.predictability import misfit_is_left
from erdctl.diagnose.screening import Screen
from erdctl.model.effect import Effect


def beyond_form_error(
    x: Exploration, best: Hypothesis, candidates: Sequence[Effect] = ()
) -> Hypothesis:
    """A hypothesis without the effects that take next to nothing of what all take, and of noise.

    In a log of few records; the one that takes the least goes first, and then what only bends the
    form of another one. In any log the latter, where the piston slips by it.
    candidates : effects that may stand in the place of a richer one, beside those that were fitted
    """
    few, last = _has_few_records(x), None
    while best is not last and (few or best.slips):
        # A plainer form may leave another effect nothing to do.
        last, best = best, _plainest(x, _without_the_faint(x, best) if few else best, candidates)
    return best


def _has_few_records(x: Exploration) -> bool:
    return len(x.problem.recording.names) < thresholds.MANY_RECORDS


def _without_the_faint(x: Exploration, best: Hypothesis) -> Hypothesis:
    """A hypothesis without the effects that take no more than the error of a form, but one."""
    while len(x.added(best)) > 1:
        taken = [(compare_alike(x.problem, h, best), h) for h in without_each(x, best)]
        least = _form_error(x, best)
        faint = [(c.before - c.after, i) for i, (c, _) in enumerate(taken) if c.gain < 0.5]
        if not faint or min(faint)[0] > least:
            break
        best = taken[min(faint)[1]][1]
    return best


def is_only_form(x: Exploration, plain: Hypothesis, rich: Hypothesis) -> bool:
    """Whether a hypothesis is better than one of fewer parameters by the error of a form alone.

    Where noise is all that is left the richer form is the right one, however little it takes.
    """
    if len(plain.model.quantities) >= len(rich.model.quantities) or not misfit_is_left(rich):
        return False
    gain = compare_alike(x.problem, plain, rich)
    if gain.before - gain.after > _form_error(x, rich):
        return False
    return _has_few_records(x) or (rich.slips and not plain.slips)


def _plainest(x: Exploration, best: Hypothesis, candidates: Sequence[Effect]) -> Hypothesis:
    """A hypothesis with a plainer effect in the place of one, where that is as good but for form.

    Of as many effects: the best of those with the fewest parameters.
    """
    key = key_of(best.effects)
    if candidates and misfit_is_left(best):
        for hypothesis in x.executor.fit(x.problem, _plainer(x, best, candidates)):
            if hypothesis is not None:
                x.explored.keep(hypothesis)
    swapped = [
        h for k, h in x.explored.items()
        if len(k) == len(key) and len(k - key) == 1 and is_only_form(x, h, best)
    ]  # fmt: skip
    return min(ranked(swapped), key=lambda h: len(h.model.quantities), default=best)


def _plainer(x: Exploration, best: Hypothesis, candidates: Sequence[Effect]) -> list[Task]:
    """Fits with the most promising plainer effects of the same kind in the place of each effect.

    Seen from the values of the whole model, not from a fit without the effect: that bends the rest.
    """
    tasks = list[Task]()
    for effect in x.added(best):
        plainer = [
            c for c in candidates
            if type(c.slot) is type(effect.slot) and len(c.quantities) < len(effect.quantities)
            and c not in best.effects
        ]  # fmt: skip
        if not plainer:
            continue
        others = tuple(e for e in best.effects if e is not effect)
        rest = fit_hypothesis(x.problem, others, [best.values], 1, best.record_effects)
        screen = Screen(x.problem, rest, x.executor.most)
        seen = [c for c in map(screen.candidate, plainer) if c is not None and c.gain > 0.0]
        seen.sort(key=lambda c: -c.gain)
        likely = seen[: thresholds.SCREENED_LEAST]
        tasks += [with_effect("plainer forms", rest, c) for c in likely]
    return [t for t in tasks if key_of(t.effects) not in x.explored]


def _form_error(x: Exploration, best: Hypothesis) -> float:
    """What the error of a form may take of the mean square that all effects take [N^2]."""
    all_ = compare_alike(x.problem, x.base, best)
    return thresholds.FORM_PART * (all_.before - all_.after)
