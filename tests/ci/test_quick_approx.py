"""Quick or one by one, `pytest.approx` says the same of arrays."""

from __future__ import annotations

from math import isfinite
from typing import Any

import numpy as np
import pytest
from quick_approx import all_near


@pytest.mark.parametrize(
    "within", [{}, {"abs": 1e-4}, {"rel": 1e-3}, {"rel": 1e-9, "abs": 1e-6}, {"abs": 0.0}]
)
def test_it_says_the_same_as_for_single_numbers(within: dict[str, Any]) -> None:
    expected = np.array([0.0, 1e-13, 1.0, -2.5, 1e6, np.inf, np.nan])
    for part in (0.0, 1e-10, 1e-7, 5e-4, 1e-2):
        for off in (0.0, 1e-13, 1e-7, 5e-5, 1.0):
            found = expected * (1.0 + part) + off
            for one, other in zip(found.tolist(), expected.tolist(), strict=True):
                same = one == pytest.approx(other, **within)
                array, near = np.array([one]), pytest.approx(np.array([other]), **within)
                assert (array == near) is same, (one, other)
                # What is not finite is left to pytest.
                assert all_near(near, array) is (same and isfinite(other)), (one, other)


def test_another_shape_is_not_near() -> None:
    assert np.zeros(3) != pytest.approx(np.zeros(4))
    assert not all_near(pytest.approx(np.zeros(1)), np.array(["a"]))
