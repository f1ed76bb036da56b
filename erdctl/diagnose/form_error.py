"""Effects that a few records cannot tell from the error of another one's form.

No damper follows the law of a catalogue to the last per cent. What a strong effect leaves because
its form is another one by a little is no noise, and some other effect always takes a part of it.
Many records that differ show that this does not carry over, see `carry_over`; a few do not.
"""

from __future__ import annotations

from erdctl.diagnose import thresholds
from erdctl.diagnose.backward_step import without_each
from erdctl.diagnose.comparison import compare_alike
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis


def beyond_form_error(x: Exploration, best: Hypothesis) -> Hypothesis:
    """A hypothesis without the effects that take next to nothing of what all take, and of noise.

    In a log of few records only; the one that takes the least goes first.
    """
    if len(x.problem.recording.names) >= thresholds.MANY_RECORDS:
        return best
    while len(x.added(best)) > 1:
        all_ = compare_alike(x.problem, x.base, best)
        least = thresholds.FORM_PART * (all_.before - all_.after)
        taken = [(compare_alike(x.problem, h, best), h) for h in without_each(x, best)]
        faint = [(c.before - c.after, i) for i, (c, _) in enumerate(taken) if c.gain < 0.5]
        if not faint or min(faint)[0] > least:
            break
        best = taken[min(faint)[1]][1]
    return best
