"""Samples that stand for a long recording."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.core.blocks import sample
from erdctl.core.recording import Recording


@pytest.mark.parametrize("length", [2, 20, 900, 1100, 5000, 9500])
def test_a_sample_of_records_of_any_length(length: int) -> None:
    records = 60_000 // length
    n = records * length
    zeros = np.zeros(n)
    r = Recording(
        t=np.tile(np.arange(length) * 1e-2, records), x=zeros, xdot=zeros.copy(),
        duty=zeros.copy(), force=np.arange(n, dtype=float),
        starts=np.arange(0, n + 1, length, dtype=np.intp),
        names=tuple(str(i) for i in range(records)),
    )  # fmt: skip
    found = sample(r, 20_000)
    assert 10_000 <= len(found.force) <= 30_000
    assert len(np.unique(found.force)) == len(found.force)
