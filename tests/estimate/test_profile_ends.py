"""A profile is followed to an end whatever the parameter: no interval is looked for for ever."""

from __future__ import annotations

from hypothesis import example, given, settings
from hypothesis import strategies as st

from erdctl.core.quantity import Quantity
from erdctl.estimate.profile import interval, widened

SIZES = st.sampled_from([0.0, 1e-12, 1e-3, 1.0, 1e9])


@settings(max_examples=300, deadline=None)
@given(start=SIZES, value=SIZES, error=SIZES, curvature=SIZES, lies=SIZES)
@example(start=0.0, value=0.0, error=0.0, curvature=0.0, lies=0.0)
def test_every_profile_ends(
    start: float, value: float, error: float, curvature: float, lies: float
) -> None:
    q = Quantity(symbol="k", unit="N/m", title="", low=0.0, high=1e9, start=start)
    asked: list[float] = []

    def cost(at: float) -> float:
        asked.append(at)
        return curvature * (at - lies) ** 2

    best, low, high = interval(cost, q, value, error)
    low, high = widened(cost, q, best, low, high)
    assert all(q.low <= end <= q.high for end in (low, high))
    assert low <= high or lies != value or error == 0.0
    assert len(asked) < 300
