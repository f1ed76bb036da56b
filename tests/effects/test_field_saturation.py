"""Yield stress that levels off."""

from __future__ import annotations

import numpy as np
import pytest
from made import act, signals


def test_check_value() -> None:
    p = {"a_c": 2.0, "a_r": 0.0, "n": 1.0}
    field = act("field_saturation", np.array([0.5, 1.0]), signals(np.ones(2)), p, "compression")
    assert field == pytest.approx([0.38079708, 0.48201379])
    other = act("field_saturation", np.array([0.5, 1.0]), signals(np.ones(2)), p, "release")
    assert other == pytest.approx([0.5, 1.0])


def test_weak_saturation_is_the_third_order_term() -> None:
    p = {"a_c": 1e-2, "n": 1.0}
    field = act("field_saturation", np.array([0.5]), signals(np.ones(1)), p, "compression")
    assert field == pytest.approx(0.5 - 1e-4 * 0.5**3 / 3, rel=1e-9)


def test_the_sharper_the_knee_the_nearer_to_a_corner() -> None:
    v = np.linspace(0.0, 1.0, 201)
    corner = np.minimum(v, 0.5)
    off = []
    for n in (1.0, 3.0, 10.0, 20.0):
        p = {"a_c": 2.0, "n": n}
        field = act("field_saturation", v, signals(np.ones(201)), p, "compression")
        assert np.all(np.diff(field) >= 0)
        off.append(float(np.abs(field - corner).max()))
    assert off == sorted(off, reverse=True)
    assert off[-1] < 0.01
