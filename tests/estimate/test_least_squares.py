"""A search whose best lies on a bound ends there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign

from erdctl.core.blocks import whole
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.estimate import least_squares as fit
from erdctl.model.composed import Model


def left(steps: int) -> float:
    """What a search leaves of a void that takes all of the force, over the plain force."""
    r = campaign(100.0, 6.0)
    model = Model((get("cavitation"),))
    start = {n: q.start for n, q in model.quantities.items()}
    for d in ("compression", "release"):
        start |= {f"{d}.k_nom": 150.0, f"{d}.c_vis": 60.0, f"{d}.sigma": 30.0, f"{d}.T_d": 0.04}
    void = {"cavitation.x_v": 2e-3, "cavitation.lambda": 1.0, "cavitation.g": 10.0}
    truth = {**start, **void, "cavitation.e": 0.1}
    force = model.force(Signals.of(r), truth)
    block = whole(replace(r, force=force))
    found = fit.fit(
        model, block, start={**truth, "cavitation.x_v": 3e-3, "cavitation.e": 0.5},
        max_evaluations=steps,
    )  # fmt: skip
    return float(np.sqrt(np.average(found.residual**2, weights=block.weight)) / np.std(force))


def test_the_best_on_a_bound_is_reached(monkeypatch: pytest.MonkeyPatch) -> None:
    finished = left(12)
    monkeypatch.setattr(fit, "FINISH", 10**6)
    assert finished < 1e-8
    assert finished < 0.01 * left(16)  # with as many steps, but kept off the bounds
