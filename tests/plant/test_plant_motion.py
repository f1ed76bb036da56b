"""Motions and campaigns."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.plant import Trajectory
from erdctl.plant.campaign import draw_campaign, draw_other
from erdctl.plant.simulate import rides

MOTIONS = [
    Trajectory("tones", (0.01, 0.003), (0.7, 2.1), (0.2, 1.0), 0.002),
    Trajectory("tones", (0.01,), (0.7,), (0.2,), ramp=0.3),
    Trajectory("sweep", (0.01,), (0.3, 2.5), (0.5,), span=5.0),
    Trajectory("sweep", (0.01,), (2.5, 0.3), (0.5,), -0.001, 5.0, 0.2),
    Trajectory("triangle", (0.01,), (1.1,), (2.0,)),
]


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: f"{m.kind}-{m.ramp}")
def test_velocity_and_acceleration_are_derivatives(motion: Trajectory) -> None:
    h = 1e-5
    x, v, a = motion.at(0.4, h, 20_000)
    np.testing.assert_allclose(np.gradient(x, h)[2:-2], v[2:-2], atol=1e-5 * np.abs(v).max())
    np.testing.assert_allclose(np.gradient(v, h)[2:-2], a[2:-2], atol=2e-3 * np.abs(a).max())


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: f"{m.kind}-{m.ramp}")
def test_any_piece_is_cut_from_one_motion(motion: Trajectory) -> None:
    whole = motion.at(-0.5, 1e-3, 3000)
    part = motion.at(1.0, 1e-3, 300)
    for long, short in zip(whole, part, strict=True):
        np.testing.assert_allclose(long[1500:1800], short, rtol=1e-9, atol=1e-12)


def test_a_ramp_starts_from_rest() -> None:
    x, v, _ = MOTIONS[1].at(-0.5, 1e-3, 502)
    assert (v[:500] == 0).all()
    assert (x[:500] == x[0]).all()
    assert abs(v[501]) < 1e-3


def test_campaigns_are_what_a_laboratory_drives() -> None:
    drawn = [draw_campaign(np.random.default_rng(seed)) for seed in range(60)]
    for c in drawn:
        n = [r.samples for r in c.records]
        assert 6 <= len(n) <= 24
        assert 12_000 <= sum(n) <= 75_000
        assert 100 <= c.rate <= 1000
        assert all(2.0 <= k / c.rate <= 61 for k in n)
        assert [r.name for r in c.records] == [f"r{i + 1:02d}" for i in range(len(n))]
        duties = [r.duty.at(r.samples) for r in c.records]
        assert any((d == 0).all() for d in duties)
        assert sum(len(np.unique(d)) > 2 for d in duties) >= 2
        assert all(d.min() >= 0 and d.max() <= 1 for d in duties)
    moving = []
    for c in drawn[:10]:
        for ride in rides(c):
            _, x, v = ride.sampled()
            assert np.abs(x).max() <= 1.1 * c.rating.stroke + 1e-12
            assert np.abs(v).max() <= 1.6 * c.rating.speed  # a ramp overshoots
            assert np.sum(np.diff(np.sign(v)) != 0) >= 1
            moving.append(v[0] != 0.0)
    assert 0.5 < np.mean(moving) < 0.95
    kinds = {r.motion.kind for c in drawn for r in c.records}
    assert kinds == {"tones", "sweep", "triangle"}


def test_other_records_are_not_those_of_the_log() -> None:
    for seed in range(20):
        c = draw_campaign(np.random.default_rng(seed))
        other = draw_other(np.random.default_rng(seed), c)
        assert other.rating == c.rating
        assert not {r.motion for r in other.records} & {r.motion for r in c.records}
