"""What the others do along the profile of a parameter that the data hardly tell.

    within_j = union over all q with c(q) - min c <= 1.96^2 of
               theta_j(q) +- sigma_j(q) sqrt(1.96^2 - (c(q) - min c))

c(q) : sum of squares over phi that all others leave at a value q, theta_j(q) their values there and
sigma_j(q) their errors with q held. For a parabola that is theta_j +- 1.96 sigma_j, as it should
be; along a bend, or from a bound on, errors at one point say little: a sharpness of a saturation
of 100 that may as well be 1 had a yield force of 292 +- 2.5 N, where it was 368.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.model.parameters import NORMAL_95

POINTS = 4  # of a profile, to either side of the best
WIDE = 0.3  # of a value, an interval up to which the others follow on a straight line
FELT = 0.5  # of an error, by which a parameter goes beyond its own 95 % to have another interval


def is_wide(value: float, low: float, high: float) -> bool:
    """Whether an interval reaches so far that others need not follow on a straight line."""
    return high - low > WIDE * abs(value)


def along(q: Quantity, value: float, low: float, high: float) -> list[float]:
    """Values of a profile between its best and its ends, outwards to either side."""
    out = []
    for end in (low, high):
        if q.scale is Scale.LOG and min(value, end) > 0.0:
            out += np.geomspace(value, end, POINTS + 1)[1:].tolist()
        else:
            out += np.linspace(value, end, POINTS + 1)[1:].tolist()
    return out


def reached(costs: Array, values: Array, errors: Array) -> tuple[Array, Array]:
    """Ends (p,) of the union above; costs (m,), values and errors (m, p) at points of a profile."""
    room = NORMAL_95**2 - (costs - costs.min())
    allowed = room >= 0.0
    reach = errors[allowed] * np.sqrt(room[allowed])[:, None]
    return (values[allowed] - reach).min(axis=0), (values[allowed] + reach).max(axis=0)


def beyond(
    own: Mapping[str, tuple[float, float]], reach: Mapping[str, float],
    centre: Mapping[str, float], quantities: Mapping[str, Quantity],
) -> dict[str, tuple[float, float]]:  # fmt: skip
    """Those of the ends that go beyond what an error holds, with that and within bounds.

    reach : 1.96 errors by name;  centre : values
    """
    out = {}
    for name, (low, high) in own.items():
        usual = centre[name] - reach[name], centre[name] + reach[name]
        by = FELT * reach[name] / NORMAL_95
        if low < usual[0] - by or high > usual[1] + by:
            q = quantities[name]
            out[name] = max(min(low, usual[0]), q.low), min(max(high, usual[1]), q.high)
    return out
