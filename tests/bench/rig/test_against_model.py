"""A log in another unit than the model that it is held against."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, recording

from erdctl.bench.rig import against_model, look
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.model.composed import Model


@pytest.fixture(scope="module")
def measured() -> Recording:
    t = np.arange(0.0, 8.0, 0.002)
    x, xdot = 0.01 * np.sin(5 * t), 0.05 * np.cos(5 * t)
    return recording(t, x, xdot, np.where(t < 4.0, 0.1, 0.3))


def modelled(r: Recording) -> np.ndarray:
    return np.asarray(Model().force(Signals.of(r), TRUTH))


@pytest.mark.parametrize(
    ("gain", "code", "remedy"),
    [
        (1 / 4.4482216, "force_unit", "[lbf]"), (1e-3, "force_unit", "[kN]"),
        (-1.0, "force_sign", "-force"),
    ],
)  # fmt: skip
def test_unit_and_sign(measured: Recording, gain: float, code: str, remedy: str) -> None:
    assert measured.force is not None
    spoiled = replace(measured, force=gain * measured.force)
    assert spoiled.force is not None
    (found,) = against_model.check(spoiled.force, modelled(measured))
    assert found.code == code
    assert remedy in found.remedy
    assert code in {f.code for f in look(spoiled, modelled(measured)).faults}


@pytest.mark.parametrize("gain", [0.5, 0.8, 1.0, 1.3, 2.0, 3.0])
def test_another_damper_is_no_other_unit(measured: Recording, gain: float) -> None:
    assert measured.force is not None
    assert against_model.check(gain * measured.force, modelled(measured)) == []
