"""A duty that is logged inverted, and what looks like one and is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from by_hand import recording
from rig import campaign, noisy

from erdctl.bench.rig import look
from erdctl.core.recording import Recording


def accused(r: Recording) -> bool:
    return "duty_inverted" in {f.code for f in look(r).faults}


def fading(records: int, lost: float) -> Recording:
    """A control that rises twice in each record while the damper loses a part of its force."""
    t = np.arange(2400) / 100.0
    v = 0.1 * np.cos(2 * np.pi * 0.8 * t)
    duty = 0.1 + 0.05 * np.floor(t % 12.0 / 2.0)
    force = 400.0 * np.sin(2 * np.pi * 0.8 * t) * 0.1 / (1.6 * np.pi) + 60.0 * v
    force += 12.0 * duty**0.1 * (1.0 - lost * t / 24.0) * np.sign(v)
    force += 0.1 * np.random.default_rng(3).standard_normal(len(t))
    x = 0.1 / (1.6 * np.pi) * np.sin(2 * np.pi * 0.8 * t)
    one = (v, x, duty, force)
    v, x, duty, force = (np.tile(c, records) for c in one)
    starts = [2400 * k for k in range(records + 1)]
    t = np.tile(t, records)
    return recording(v, x=x, duty=duty, force=force, t=t, starts=starts)


@pytest.mark.parametrize("top", [0.45, 1.0])
def test_found_in_steps_and_between_levels(top: float) -> None:
    r = noisy(campaign(100.0, 8.0), 1, rms=0.2)
    held = r.select([k for k, part in enumerate(r.slices) if np.ptp(r.duty[part]) == 0.0])
    for log in (r, held):
        assert not accused(log)
        assert accused(replace(log, duty=top - log.duty))


@pytest.mark.parametrize("records", [1, 4])
def test_a_damper_that_fades_while_the_control_rises_is_none(records: int) -> None:
    assert not accused(fading(records, 0.9))


def test_a_record_that_lost_its_force_is_none() -> None:
    """The one with the most duty has nothing of its yield force left, the others hold one level."""
    random, w = np.random.default_rng(4), 2 * np.pi * 0.8
    t = np.tile(np.arange(800) / 100.0, 6)
    x, v = 0.02 * np.sin(w * t), 0.02 * w * np.cos(w * t)
    lost = np.repeat(np.arange(6) == 3, 800)
    force = 400.0 * x + 60.0 * v + np.where(lost, 0.0, 10.0) * np.sign(v)
    force += 0.1 * random.standard_normal(len(t))
    starts = [800 * k for k in range(7)]
    duty = np.where(lost, 0.3, 0.2)
    assert not accused(recording(v, x=x, duty=duty, force=force, t=t, starts=starts))
