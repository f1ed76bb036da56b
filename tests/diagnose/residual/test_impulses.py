"""Sudden jumps in a residual are told from noise of any colour, spikes and coarse channels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign
from scipy.signal import lfilter

from erdctl.diagnose.problem import Study, prepare
from erdctl.diagnose.residual.impulses import jumping


@pytest.fixture(scope="module")
def study() -> Study:
    return prepare(campaign())


def noise(study: Study, correlation: float, seed: int = 5) -> np.ndarray:
    white = np.random.default_rng(seed).normal(size=len(study.block.force))
    return np.asarray(lfilter([np.sqrt(1 - correlation**2)], [1.0, -correlation], white))


@pytest.mark.parametrize("correlation", [0.0, 0.9, 0.99])
def test_noise_has_none(study: Study, correlation: float) -> None:
    assert jumping(study, noise(study, correlation)) == 0.0


@pytest.mark.parametrize("correlation", [0.0, 0.9, 0.99])
def test_a_seal_that_sticks_and_slips_has(study: Study, correlation: float) -> None:
    """Stretched with the deflection, sprung back every 8 mm: a saw-tooth of its own phase."""
    saw = 20.0 * np.mod(study.block.signals.x / 0.008 + 0.3, 1.0)
    share = jumping(study, saw - saw.mean() + noise(study, correlation))
    assert share > 0.5


def test_spikes_are_not_jumps(study: Study) -> None:
    values = noise(study, 0.9)
    values[np.random.default_rng(3).integers(0, len(values), 200)] += 30.0
    assert jumping(study, values) == 0.0


def test_steps_of_a_coarse_channel_are_not_jumps(study: Study) -> None:
    smooth = 3.0 * np.sin(study.block.signals.t)
    force = np.round(study.block.force + smooth)
    coarse = replace(study, block=study.block._replace(force=force))
    assert jumping(coarse, np.round(smooth) - smooth) == 0.0


def test_jumps_where_a_model_jumps_are_its_own(study: Study) -> None:
    """At reversals and steps of the duty a slightly wrong model misses by a jump too."""
    assert jumping(study, 3.0 * study.block.signals.sign + 0.1 * noise(study, 0.0)) == 0.0
