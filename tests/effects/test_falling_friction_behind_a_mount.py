"""Friction that falls with speed behind a spring: the piston slips, and stays a damper."""

from __future__ import annotations

import numpy as np
import pytest
from made import PLAIN, sine

from erdctl.effects import get
from erdctl.model.composed import Model

FRICTION = get("stribeck_friction")


@pytest.mark.parametrize("seed", range(60))
def test_it_never_drives_the_damper(seed: int) -> None:
    """Beyond the table of speeds friction that still falls went on falling, turned round and drove
    the piston: 1e18 N within ten samples of a friction damper's log in steps of 0.6 ms."""
    rng = np.random.default_rng(seed)
    frequency, amplitude = rng.uniform(0.3, 3.0), 10 ** rng.uniform(-3.0, -1.5)
    fastest = 2 * np.pi * frequency * amplitude
    rate = 10 ** rng.uniform(2.3, 3.6)
    s = sine(frequency, amplitude, 2.0 / frequency, rate, duty=0.0)
    kinetic, more = rng.uniform(0.0, 100.0), rng.uniform(0.0, 100.0)
    c_vis = rng.uniform(0.0, 20.0)
    own = {"F_k": kinetic, "F_sk": more, "v_s": fastest * 10 ** rng.uniform(-1.0, 0.7)}
    values = PLAIN | {f"stribeck_friction.{symbol}": v for symbol, v in own.items()}
    values |= {f"{way}.c_vis": c_vis for way in ("compression", "release")}
    values |= {"backlash.g": amplitude * rng.uniform(0.0, 0.5)}
    values |= {"mount_compliance.s_m": amplitude / 100.0 * 10 ** rng.uniform(-3.0, 0.3)}
    model = Model((get("backlash"), get("mount_compliance"), FRICTION))
    most = PLAIN["compression.k_nom"] * 3.0 * amplitude + kinetic + more + 8.0 * c_vis * fastest
    assert np.abs(model.force(s, values)).max() <= most
