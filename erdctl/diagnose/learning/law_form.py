"""The form of a law: how many coordinates and knots it is worth, and a closed form of the field."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.comparison import compare
from erdctl.diagnose.forward_step import Exploration
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.learning.closed_forms import closed_forms
from erdctl.diagnose.learning.law_fits import fitted, law_of, taken
from erdctl.diagnose.learning.laws import finer
from erdctl.diagnose.learning.promising import screened
from erdctl.diagnose.learning.unseen_corners import goes_beyond_what_was_seen
from erdctl.diagnose.look_alikes import is_preferred
from erdctl.diagnose.screening import Candidate
from erdctl.estimate.least_squares import at_bound
from erdctl.model.learned.coordinates import Memory, along
from erdctl.model.learned.forms import FORMS


def of_fewest(
    x: Exploration, parent: Hypothesis, better: Sequence[Hypothesis], stage: str
) -> Hypothesis:
    """The best of some laws over one coordinate, unless one over two is worth its parameters."""
    plain = [h for h in better if len(law_of(h)[0].curve.axes) == 1]
    wide = [h for h in better if h not in plain]
    if not plain:
        return wide[0]
    if wide:
        parts = [taken(x.problem, parent, h) for h in (plain[0], wide[0])]
        if parts[0] < thresholds.MOST_OF_IT * parts[1]:
            return wide[0]  # to sharpen the other one would not make up for it
    found = _sharpened(x, parent, plain[0], stage)
    return wide[0] if wide and is_preferred(x.problem, wide[0], found) else found


def _sharpened(x: Exploration, parent: Hypothesis, found: Hypothesis, stage: str) -> Hypothesis:
    """A law with more knots where these pay, and in a closed form where one does as well."""
    law, values = law_of(found)
    if law.curve.form is not None:
        return found
    while (more := finer(x.problem, law, Memory.of(values))) is not None:
        better = fitted(x, parent, screened(x, parent, [more]), stage)
        better = [h for h in better if not goes_beyond_what_was_seen(h)]
        if not (better and is_preferred(x.problem, better[0], found)):
            break
        found = better[0]
        law, values = law_of(found)
    s, weight = x.problem.block.signals, x.problem.block.weight
    z = along(law.curve.coordinate, s, Memory.of(values))
    z = z[(weight > 0.0) & np.isfinite(z)]
    forms = [
        Candidate(new.effect, 0.0, ({new.effect.key(symbol): v for symbol, v in own.items()},))
        for new, own in closed_forms(law, values, z)
    ]
    fits = [
        h
        for h in fitted(x, parent, forms, stage)
        if not (_at_an_end(h) or _untold(h, z) or goes_beyond_what_was_seen(h))
    ]
    alike = [h for h in fits if compare(x.problem, h, found).tied]
    # A power of 0.99 is a line.
    return min(alike, key=lambda h: len(h.model.quantities), default=found)


def _at_an_end(hypothesis: Hypothesis) -> bool:
    """Whether a parameter of the last law is as large as can be: then it is of another form."""
    effect = hypothesis.effects[-1]
    return any(at_bound(q, hypothesis.values[effect.key(q.symbol)]) for q in effect.quantities)


def _untold(hypothesis: Hypothesis, z: Array) -> bool:
    """Whether the form of the last law swings or bulges between samples (n,) of its coordinate."""
    law, own = law_of(hypothesis)
    assert law.curve.form is not None
    return own.get("w", np.inf) < FORMS[law.curve.form].narrowest(z)
