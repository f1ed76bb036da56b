"""A step of the other parameters is taken only where it is no leap."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from rig import campaign, noisy

from erdctl.diagnose.problem import prepare
from erdctl.effects import get
from erdctl.estimate.last_step import assess
from erdctl.model.composed import Model


def test_others_that_leap_do_not_follow_to_a_better_value() -> None:
    """A lag that was over at once came out as 1.2 s, when a smoothing's window went to zero."""
    r = noisy(campaign(250.0, 6.0), seed=11)
    noise = 0.3 * np.random.default_rng(2).standard_normal(len(r.x))
    yields = 12.0 * np.sqrt(r.duty) * np.tanh(r.xdot / 0.01)
    force = 200.0 * r.x + 80.0 * r.xdot + yields + 1.5 * np.sign(r.xdot) + noise
    names = ("coulomb_friction", "force_smoothing", "preyield_viscosity")
    model = Model(tuple(get(n) for n in names))
    paper = {"k_nom": 200.0, "c_vis": 80.0, "sigma": 12.0, "beta": 0.5, "T_d": 1.4e-5}
    values = {f"{d}.{n}": v for d in ("compression", "release") for n, v in paper.items()}
    values |= {"coulomb_friction.F_c": 1.5, "force_smoothing.w": 0.008}
    values["preyield_viscosity.v_y"] = 0.0098
    found = assess(model, [prepare(replace(r, force=force)).block], values, threads=1)
    assert found.values["force_smoothing.w"] < 1e-3
    assert found.values["compression.T_d"] < 1e-3
    assert found.values["release.T_d"] < 1e-3
    assert abs(found.values["coulomb_friction.F_c"] - 1.5) < 0.03
