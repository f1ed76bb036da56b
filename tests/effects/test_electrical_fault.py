"""Factor and onset, and the groups that it takes."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    """10 N of gas, 6 N viscous, 4 N of yield force: 20 N at 14 s, 18 N at 16 s."""
    s = signals(np.ones(2001), step=0.01, t=np.arange(2001) * 0.01)
    found = act("electrical_fault", s, {"f": 0.5, "t_0": 15.0})
    healthy, faulty = ({g: f[i] for g, f in found.items()} for i in (1400, 1600))
    assert healthy == {"gas": 1.0, "viscous": 1.0, "yield": 1.0}
    assert list(faulty.values()) == [1, 1, 0.5]
    assert 10 * faulty["gas"] + 6 * faulty["viscous"] + 4 * faulty["yield"] == pytest.approx(18)


def test_sets_in_over_four_samples() -> None:
    s = signals(np.ones(9), step=0.01)
    found = act("electrical_fault", s, {"f": 0.0, "t_0": 0.04})["yield"]
    assert found == pytest.approx([1, 1, 1, 0.75, 0.5, 0.25, 0, 0, 0], abs=1e-9)
