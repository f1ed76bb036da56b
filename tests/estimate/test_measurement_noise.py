"""The noise that `identify` states is the rig's, not what its model misses."""

from __future__ import annotations

import io

import numpy as np
import pyarrow.parquet as pq
import pytest

from erdctl import plant
from erdctl.core.blocks import whole
from erdctl.core.recording import Recording
from erdctl.estimate.identify import identify
from erdctl.estimate.measurement_noise import measurement_noise, of_recording
from erdctl.io.logs import read_logs


def drawn(seed: int) -> tuple[Recording, float]:
    """A log of the plant, and the effective value of its noise [N]."""
    case = plant.draw(seed)
    sink = io.BytesIO()
    pq.write_table(plant.log(case), sink)
    held = {"log.parquet": bytearray(sink.getvalue())}
    log = read_logs(["log.parquet"], need_force=True, held=held, report=lambda line: None)
    return log.recording, float(plant.key(case)["force_noise"]["rms"])


@pytest.mark.few(4)
@pytest.mark.parametrize("seed", range(420_000, 420_010))
def test_noise_beside_hidden_physics(seed: int) -> None:
    recording, noise = drawn(seed)
    assert identify(recording).noise_rms == pytest.approx(noise, rel=0.5)


def test_white_noise_alone() -> None:
    t = np.arange(20_000) / 500
    x, xdot = 0.01 * np.sin(3 * t), 0.03 * np.cos(3 * t)
    noise = np.random.default_rng(4).normal(0.0, 0.3, len(t))
    starts = np.array([0, len(t)])
    r = Recording(t=t, x=x, xdot=xdot, duty=0 * t, force=noise, starts=starts, names=("r",))
    assert measurement_noise(whole(r), noise) == pytest.approx(0.3, rel=0.05)
    # A misfit that comes back with the motion is none of it.
    model = 2.0 * np.sign(xdot) + 300.0 * x**2 / 0.01
    r = Recording(t=t, x=x, xdot=xdot, duty=0 * t, force=noise + model, starts=starts, names=("r",))
    assert of_recording(r, np.zeros(len(t))) == pytest.approx(0.3, rel=0.1)
