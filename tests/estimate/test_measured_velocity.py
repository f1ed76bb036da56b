"""Velocities as labs have them: differences of a noisy, quantised deflection."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import TRUTH, campaign, noisy

from erdctl.core.recording import Recording
from erdctl.estimate.identify import LACKING, Identification, identify

NOISE = 0.3  # N


def differenced(clean: Recording, seed: int, noise: float = 3e-6) -> Recording:
    """The recording with the velocity as the difference of its deflection and a noise of it [m]."""
    random, out = np.random.default_rng(seed), clean.xdot.copy()
    for part in clean.slices:
        x = clean.x[part] + noise * random.standard_normal(part.stop - part.start)
        out[part] = np.gradient(np.round(x / 5e-6) * 5e-6, clean.t[part])
    return replace(clean, xdot=out)


def of(seed: int) -> tuple[Identification, Identification]:
    """Of the exact velocity, and of one that was made from the deflection."""
    exact = noisy(campaign(), seed, NOISE)
    return identify(exact), identify(differenced(exact, seed))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_next_to_turns_is_told_by_nothing_is_no_residual(seed: int) -> None:
    """A wrong sign there is an error of twice the yield force."""
    exact, measured = of(seed)
    assert measured.fit.rms < 1.25 * exact.fit.rms
    for name in ("compression.c_vis", "release.sigma"):
        a, b = exact.joint[name].stderr, measured.joint[name].stderr
        assert a is not None
        assert b is not None
        assert b < 1.5 * a
        value = measured.joint[name].value
        assert value is not None
        assert value == pytest.approx(TRUTH[name], abs=4.0 * b)


def test_a_residual_that_is_no_noise_is_said() -> None:
    plain = noisy(campaign(), 4, NOISE)
    assert plain.force is not None
    bent = replace(plain, force=plain.force + 5.0 * NOISE * np.sign(plain.xdot))
    assert not any("lacks something" in line for line in identify(plain).warnings)
    said = [line for line in identify(bent).warnings if "the noise of the force" in line]
    assert said
    assert identify(bent).fit.rms > LACKING * NOISE
