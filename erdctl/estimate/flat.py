"""Parameters that the data tell only together: directions in which the cost does not change.

The friction of a slow piston and the yield force of two levels of duty, say: five sizes and
exponents for four forces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from erdctl.core.recording import Array
from erdctl.estimate.normal_equations import Normal
from erdctl.model.composed import Model
from erdctl.model.slots import Values

PART = 0.1  # of a direction, from which on a parameter belongs to it
NOTHING = 1e-6  # of a direction, below which it is rounding


def flat_groups(
    model: Model,
    normal: Normal,
    names: Sequence[str],
    values: Values,
    errors: Mapping[str, float],
) -> tuple[tuple[str, ...], ...]:
    """The parameters along each direction that takes some with an error along.

    normal : of the columns of `names`;  errors : standard ones of those that are not at a bound
    Little of a direction may be much of a parameter that is well told otherwise: it belongs to the
    direction if that, followed to where the first of its parameters comes to a bound, takes it
    farther than its error. (beta was told as 0.471 +- 0.011 where a friction at its bound of 0, as
    good as any, was 7 N and beta 0.616.)
    """
    out = []
    for along in normal.lost.T:
        size, unit = np.abs(along), along / normal.scale
        moved = np.abs(unit) * _room(model, names, values, np.where(size > PART, unit, 0.0))
        far = [moved[i] > errors.get(n, np.inf) for i, n in enumerate(names)]
        group = tuple(np.array(names)[(size > PART) | (far & (size > NOTHING))].tolist())
        if any(n in errors for n in group):
            out.append(group)
    return tuple(out)


def _room(model: Model, names: Sequence[str], values: Values, unit: Array) -> float:
    """How far one may go along a direction of parameters (p,), the one way or the other."""
    ends = []
    for way in (unit, -unit):
        room = [
            ((q.high if w > 0.0 else q.low) - values[n]) / w
            for n, w in zip(names, way.tolist(), strict=True)
            if w != 0.0
            for q in (model.quantities[n],)
        ]
        ends.append(min(room, default=0.0))
    return max(ends)
