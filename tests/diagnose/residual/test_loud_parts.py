"""What a record or a place alone holds is no noise, where it is slow; a burst of noise is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trajectories
from hypothesis import given
from hypothesis import strategies as st
from rig import noisy, recording
from scipy.signal import lfilter

from erdctl.core.recording import Array, Recording, concatenate
from erdctl.diagnose import thresholds
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.residual.loud_parts import loud_parts
from erdctl.effects import get

AT = 4  # the record that is unlike the others


def campaign(records: int) -> Recording:
    t = np.arange(600) / 100.0
    random, out = np.random.default_rng(8), []
    for i in range(records):
        tones = trajectories.sine(0.5 + 0.2 * (i % 5), 0.012, 0.4 * i)
        duty = trajectories.random_hold(random, t, (0.0, 0.1, 0.2, 0.3))
        out.append(recording(t, tones.x(t), tones.velocity(t), duty, f"{i}", tones.velocity_at))
    return concatenate(out)


def found(r: Recording, added: Array) -> Verdict:
    """The verdict with a force added to one record alone."""
    assert r.force is not None
    force = r.force.copy()
    force[r.slices[AT]] += added
    log = noisy(replace(r, force=force), seed=5)
    return diagnose(log, [get("quadratic_damping")], limits=False, learning=False).verdict


@pytest.mark.long
def test_a_misfit_in_one_record_of_eight_is_one() -> None:
    """Eight times the noise, a swing that no motion has: no regression learns it elsewhere."""
    r = campaign(8)
    t = r.t[r.slices[AT]]
    assert found(r, 2.4 * np.sqrt(2.0) * np.sin(2.0 * np.pi * 0.37 * t)) is Verdict.UNEXPLAINED
    assert found(r, 0.0 * t) is Verdict.ADEQUATE


def test_what_happens_once_is_a_misfit() -> None:
    """A bump of a third of a second in one record, 20 times the noise: a stop that is touched once,
    say. In mean square of the record it is less than nine times the noise."""
    r = campaign(8)
    t = r.t[r.slices[AT]] - r.t[r.slices[AT]][0]
    bump = 20.0 * 0.3 * np.exp(-(((t - 3.0) / 0.1) ** 2))
    assert np.mean(bump**2) < 9.0 * 0.3**2
    assert found(r, bump) is Verdict.UNEXPLAINED
    burst = bump * np.random.default_rng(3).standard_normal(len(t))
    assert found(r, burst) is Verdict.ADEQUATE


def test_noise_of_one_record_is_noise() -> None:
    r = campaign(8)
    t = r.t[r.slices[AT]]
    assert found(r, 2.4 * np.random.default_rng(2).standard_normal(len(t))) is Verdict.ADEQUATE


def test_what_is_right_for_the_other_records_keeps_its_name() -> None:
    """Ten times what it takes stays, in one record: that says nothing of the others."""
    r = campaign(8)
    assert r.force is not None
    force = r.force + 900.0 * r.xdot * np.abs(r.xdot)
    t = r.t[r.slices[AT]]
    force[r.slices[AT]] += 9.0 * np.sqrt(2.0) * np.sin(2.0 * np.pi * 0.37 * t)
    log = noisy(replace(r, force=force), seed=5)
    it = diagnose(log, [get("quadratic_damping")], limits=False, learning=False)
    assert it.verdict is Verdict.UNEXPLAINED
    assert [f.effect.name for f in it.findings] == ["quadratic_damping"]


@given(
    seed=st.integers(0, 10_000), rho=st.floats(0.0, 0.95), records=st.integers(1, 12),
    length=st.integers(300, 1200),
)  # fmt: skip
def test_coloured_noise_is_never_loud(seed: int, rho: float, records: int, length: int) -> None:
    """Also where its size grows threefold from record to record."""
    random, parts = np.random.default_rng(seed), []
    for size in random.uniform(1.0, 3.0, records):
        e = random.standard_normal(length + 100)
        for k in range(1, len(e)):
            e[k] += rho * e[k - 1]
        parts.append(size * e[100:])
    rest = np.concatenate(parts)
    quick = np.full(len(rest), np.nan)
    quick[1:-2] = np.diff(rest, 3) ** 2
    starts = np.arange(0, len(rest) + 1, length)
    beyond, noise = loud_parts(rest, quick, np.ones(len(rest)), starts, thresholds.LOUD)
    assert not beyond.any()
    assert noise == pytest.approx(float(np.mean(rest**2)))


@given(
    seed=st.integers(0, 10_000), rho=st.floats(0.0, 0.95), stretches=st.integers(5, 300),
    length=st.integers(80, 400),
)  # fmt: skip
def test_nor_is_it_in_a_stretch(seed: int, rho: float, stretches: int, length: int) -> None:
    e = np.random.default_rng(seed).standard_normal(stretches * length + 100)
    rest = lfilter([1.0], [1.0, -rho], e)[100:]
    quick = np.full(len(rest), np.nan)
    quick[1:-2] = np.diff(rest, 3) ** 2
    starts = np.arange(0, len(rest) + 1, length)
    beyond, _ = loud_parts(rest, quick, np.ones(len(rest)), starts, thresholds.LOUD_STRETCH)
    assert not beyond.any()
