"""The past of a dead time in C: any number of pieces in it, and none."""

from __future__ import annotations

import numpy as np
import pytest
from c_built import block_of, forces
from c_motion import random_motion
from places import FIXTURES

from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values
STEP = 0.005


def even() -> Signals:
    s = random_motion(n=2000, step=STEP)
    step = np.full(2000, STEP)
    step[s.starts[1:] - 1] = 0.0
    return Signals(t=STEP * np.arange(2000), x=s.x, xdot=s.xdot, duty=s.duty, step=step,
                   starts=s.starts)  # fmt: skip


@pytest.mark.parametrize("s", [even(), random_motion(n=2000, step=STEP)], ids=["even", "uneven"])
@pytest.mark.parametrize("wild", [False, True], ids=["held", "another each sample"])
def test_it_equals_python(s: Signals, wild: bool) -> None:
    """Shorter than a step, as long as one or two, and with some hundred pieces."""
    model = Model((get("input_delay"),))
    if wild:
        s = s.with_duty(np.random.default_rng(7).choice([0.0, 0.1, 0.2, 0.45], len(s)))
    for tau in (1e-4, 0.0043, STEP, 0.0051, 2.0 * STEP, 0.0173, 0.9):
        values = PAPER | {"input_delay.tau": tau}
        off = forces(block_of(model, values, s), s) - model.force(s, values)
        assert np.abs(off).max() <= 1e-9 * np.ptp(model.force(s, values)), tau
