"""NRMSE and its splits, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.core.recording import Recording
from erdctl.score.nrmse import Normalise, duty_levels, nrmse, validate


@pytest.mark.parametrize(
    ("normalise", "scale"),
    [(Normalise.RANGE, 2.0), (Normalise.STD, 1.0), (Normalise.MEAN, 1.0), (Normalise.RMS, 2**0.5)],
)
def test_the_denominators(normalise: Normalise, scale: float) -> None:
    found = nrmse(np.array([0.0, 2.0]), np.zeros(2), normalise)
    assert found.rms == pytest.approx(2**0.5)
    assert found.nrmse == pytest.approx(2**0.5 / scale)


def test_a_force_without_range() -> None:
    still = np.ones(3)
    assert nrmse(still, still).nrmse == 0.0
    assert nrmse(still, still + 1.0).nrmse == np.inf


def test_levels_are_rounded_or_binned() -> None:
    code, levels = duty_levels(np.array([0.3, 0.0, 0.302]))
    assert (code.tolist(), levels.tolist()) == ([1, 0, 1], [0.0, 0.3])
    _, levels = duty_levels(np.linspace(0.0, 1.0, 1000))
    assert levels[:3].tolist() == [0.0, 0.025, 0.075]


def test_the_splits() -> None:
    """Two records of two samples: errors 1, 1 at duty 0 and 3, 3 at duty 0.2."""
    force = np.array([0.0, 10.0, 0.0, 20.0])
    recording = Recording(
        t=np.array([0.0, 0.1, 0.0, 0.1]), x=np.zeros(4), xdot=np.array([1.0, -1.0, 1.0, -1.0]),
        duty=np.array([0.0, 0.0, 0.2, 0.2]), force=force,
        starts=np.array([0, 2, 4], dtype=np.intp), names=("a", "b"),
    )  # fmt: skip
    found = validate(recording, force + np.array([1.0, -1.0, 3.0, -3.0]))
    assert {d: s.nrmse for d, s in found.by_duty.items()} == {0.0: 0.1, 0.2: 0.15}
    assert {r: s.rms for r, s in found.by_record.items()} == {"a": 1.0, "b": 3.0}
    assert {d: s.samples for d, s in found.by_direction.items()} == {"compression": 2, "release": 2}
    assert found.overall.rms == pytest.approx(5**0.5)
