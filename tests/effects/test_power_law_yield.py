"""A yield force that rises with speed."""

from __future__ import annotations

import numpy as np
import pytest
from made import PLAIN, act, force, signals, sine

from erdctl.effects import get
from erdctl.model.composed import Model


def test_check_value() -> None:
    found = act("power_law_yield", signals([0.1, -0.025, 0.0]), {"n": 0.5})
    assert found["yield"] == pytest.approx([1.0, 0.5, 0.0])
    assert found.keys() == {"yield"}


def test_force_is_the_power_law() -> None:
    s = sine(1.0, 0.02, 2.0, 500.0, duty=0.25)
    found = force("power_law_yield", s, {"n": 0.3}, k_nom=0.0, c_vis=0.0)
    Y = 20.0 * 0.25**0.5
    assert found == pytest.approx(Y * np.sign(s.xdot) * (np.abs(s.xdot) / 0.1) ** 0.3, abs=1e-9)


def test_behind_a_spring_it_follows_the_piston() -> None:
    """As the compliance goes to 0 the force goes to that with no spring."""
    s = sine(1.0, 0.02, 2.0, 1000.0, duty=0.25)
    power, mount = get("power_law_yield"), get("mount_compliance")
    values = PLAIN | {"power_law_yield.n": 0.3}
    rigid = Model((power,)).force(s, values)
    off = []
    for compliance in (1e-5, 1e-6):
        soft = Model((power, mount)).force(s, values | {"mount_compliance.s_m": compliance})
        off.append(np.sqrt(np.mean((soft - rigid) ** 2)) / np.ptp(rigid))
    assert off[0] < 0.03
    assert off[1] < 0.4 * off[0]
