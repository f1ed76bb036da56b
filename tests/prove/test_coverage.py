"""Intervals hold the truth of another simulator: few draws here, many by `measure_coverage`."""

from __future__ import annotations

import numpy as np
import pytest

from erdctl.effects import get
from erdctl.plant.noise import DISTURBANCES, disturbed
from erdctl.plant.twins import every
from erdctl.prove.coverage import draw


@pytest.mark.parametrize("kind", DISTURBANCES)
def test_most_intervals_hold_the_paper_s_parameters(kind: str) -> None:
    held = [h for seed in range(4) for h in draw("", kind, 7000 + seed)]
    inside = [h.inside for h in held if h.inside is not None]
    assert len(inside) >= 30
    # 0.95 less three standard deviations of forty that are half of them alike.
    assert np.mean(inside) >= 0.80


@pytest.mark.parametrize("effect", ["mount_compliance", "input_delay", "time_skew"])
def test_a_bias_of_the_step_is_gone(effect: str) -> None:
    """These were off by several errors in the log's own steps."""
    own = [h for seed in range(3) for h in draw(effect, "white", 7100 + seed)]
    off = [abs(h.off) for h in own if h.parameter.startswith(effect) and h.off is not None]
    assert len(off) == 3
    assert np.median(off) < 2.0


def test_laws_name_parameters_of_the_catalogue() -> None:
    from erdctl.plant.plant import Plant, Side
    from erdctl.plant.twin import Scales

    side = Side(1000.0, 500.0, 0.03, 100.0, 0.8)
    by = Scales(0.02, 0.2, 3.0, 0.03, 200.0, 0.5, 5.0, 10.0, 100.0, 5e-4)
    checked = 0
    for name, twin in every().items():
        if twin.law is None:
            continue
        random = np.random.default_rng(1)
        _, truth = twin.law(twin.build(Plant(side, side), twin.start, twin.drawn(random), by))
        assert {q.symbol for q in get(name).quantities} <= set(truth), name
        checked += 1
    assert checked >= 25


def test_records_scatter_as_said() -> None:
    force = np.tile([10.0, -10.0], 50_000)
    read = disturbed(np.random.default_rng(1), force, [1000] * 100, 0.5, "scatter")
    parts = read.reshape(100, 1000)
    zero = parts.mean(axis=1)
    gain = (parts[:, ::2].mean(axis=1) - parts[:, 1::2].mean(axis=1)) / 20.0
    assert zero.std() == pytest.approx(0.5, rel=0.2)
    assert gain.std() == pytest.approx(0.01, rel=0.2)
