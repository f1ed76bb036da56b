"""Factor and onset, and the groups that it takes."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals

from erdctl.model.faults import effectiveness, parse_fault


def test_check_value() -> None:
    """10 N of gas, 6 N viscous, 4 N of yield force: 20 N at 14 s, 18 N at 16 s."""
    s = signals(np.ones(2001), step=0.01, t=np.arange(2001) * 0.01)
    found = act("electrical_fault", s, {"f": 0.5, "t_0": 15.0, "t_r": 0.0})
    force = {"gas": 10.0, "viscous": 6.0, "yield": 4.0}
    left = sum(part * found.get(group, np.ones(2001)) for group, part in force.items())
    assert left[[1400, 1600]] == pytest.approx([20.0, 18.0], abs=1e-12)


def test_sets_in_over_a_ramp() -> None:
    """Linear from 1 to f, against the factor that mimic and simulate use."""
    s = signals(np.ones(3001), step=0.01, t=np.arange(3001) * 0.01)
    found = act("electrical_fault", s, {"f": 0.2, "t_0": 12.0, "t_r": 4.0})["yield"]
    fault = parse_fault("electrical_fault=0.2@12,ramp=4")
    expected = effectiveness(fault, s.t, s.xdot, s.starts)
    assert found == pytest.approx(expected, abs=0.8 * 0.01 / 8 / 4 + 1e-12)  # its corners are cut
    assert found[1400] == pytest.approx(0.6, abs=1e-12)
