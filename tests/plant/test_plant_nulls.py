"""Null logs: a plain damper, one kind of noise or rig error each, nothing hidden."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.plant.nulls import draw_null
from erdctl.plant.rig_errors import KINDS, RigLog

SEED = 31


def test_there_are_enough_kinds() -> None:
    assert len(KINDS) >= 15
    assert {draw_null(seed).name for seed in range(2)} == set(list(KINDS)[:2])


@pytest.mark.parametrize("name", KINDS)
def test_a_null_is_a_short_log_and_the_same_again(name: str) -> None:
    null = draw_null(SEED, name)
    channels = [c for c in ("t", "x", "xdot", "force") if c != "xdot" or name != "no_velocity"]
    assert null.table.column_names == [*channels[:-1], "duty", "force", "record"]
    assert 6000 < len(null.table) < 11000
    assert len(set(null.table["record"].to_pylist())) == 6
    assert np.isfinite(np.asarray(null.table["force"])).all()
    assert null.table.equals(draw_null(SEED, name).table)
    for column in channels:
        assert np.ptp(np.asarray(null.table[column])) > 0


@pytest.mark.parametrize(
    "name", ["white", "ar1", "pink", "heavy_tails", "growing", "quantised", "dropped"]
)
def test_pure_noise_has_its_size(name: str) -> None:
    n = 6000
    t = np.tile(np.arange(2000) / 200.0, 3)
    x, xdot = 0.01 * np.sin(2 * np.pi * t), 0.02 * np.pi * np.cos(2 * np.pi * t)
    force = 100.0 * np.sin(2 * np.pi * t + 0.5)
    clean = RigLog(t, x, xdot, np.zeros(n), force, (0, 2000, 4000, n), 200.0, 1.0, 200.0)
    sizes = []
    for seed in range(20):
        logged = KINDS[name].apply(clean, np.random.default_rng(seed))
        true = np.interp(logged.t, t[:2000], force[:2000])
        sizes.append(np.std(logged.force - true))
    assert KINDS[name].only_noise
    # A channel's steps of up to three times the noise add up to a third.
    assert 0.85 < np.median(sizes) < 1.35


def test_an_unknown_kind_is_refused() -> None:
    with pytest.raises(ValueError, match="no such kind of noise"):
        draw_null(SEED, "thunder")
