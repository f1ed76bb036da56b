"""Zero error, noise of the velocity, stops at one end, sharp knees: named, and all of it removed.

The force is the fixtures' own solution of the paper's equations; what is hidden is written here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy, recording

from erdctl.core.recording import Recording, concatenate
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.effects import get

NOISE = 0.2  # N


def log() -> Recording:
    return campaign(100.0, 8.0)


def examined(clean: Recording, names: Sequence[str], seed: int) -> Diagnosis:
    return diagnose(noisy(clean, seed, rms=NOISE), [get(n) for n in names], limits=False)


def named(found: Diagnosis) -> list[str]:
    return [f.effect.name for f in found.findings]


def removed(found: Diagnosis, clean: Recording) -> float:
    """Part of the paper's model's error against the force without noise that is gone."""
    assert clean.force is not None
    signals, true = Signals.of(clean), clean.force

    def error(fitted: Hypothesis) -> float:
        missed = fitted.model.force(signals, fitted.values) - true
        return float(np.sqrt(np.mean(missed**2)))

    return 1.0 - error(found.selection.best) / error(found.selection.base)


@pytest.mark.parametrize("zero", [-0.5, 0.5])
def test_a_zero_error_below_zero_is_no_gas(zero: float) -> None:
    clean = log()
    assert clean.force is not None
    shifted = replace(clean, force=clean.force + zero)
    found = examined(shifted, ["coulomb_friction", "force_offset", "gas_preload"], 3)
    assert found.verdict.value == "explained"
    if zero < 0.0:
        assert [(f.effect.name, f.equivalent) for f in found.findings] == [("force_offset", ())]
    else:  # where nothing can decide the convention does, and the other is said
        assert [(f.effect.name, f.equivalent) for f in found.findings] == [
            ("gas_preload", ("force_offset",))
        ]


def test_noise_of_the_velocity_is_no_physics() -> None:
    clean = log()
    random = np.random.default_rng(11)
    seen = replace(clean, xdot=clean.xdot + 2e-3 * random.standard_normal(len(clean)))
    names = ["force_smoothing", "preyield_viscosity", "time_skew", "velocity_noise"]
    found = examined(seen, names, 4)
    assert set(named(found)) <= {"velocity_noise"}


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("low", "dashpot"),
    [
        (False, False),
        (True, True),
        *(pytest.param(*of, marks=pytest.mark.long) for of in ((False, True), (True, False))),
    ],
)
def test_a_damped_stop_at_one_end(low: bool, dashpot: bool) -> None:
    clean = log()
    assert clean.force is not None
    way = -1.0 if low else 1.0
    depth = np.maximum(way * clean.x - 0.014, 0.0)
    loss = 0.02 * way * clean.xdot * (1.0 if dashpot else depth / 0.003)
    contact = np.where(depth > 0, np.maximum(depth + loss, 0.0), 0.0)
    stopped = replace(clean, force=clean.force + way * 3000.0 * contact)
    found = examined(stopped, ["end_stop", "gas_polytropic", "position_dependent_damping"], 5)
    assert named(found) == ["end_stop"]
    assert removed(found, stopped) >= 0.95


@pytest.mark.long
def test_a_knee_as_sharp_as_a_corner() -> None:
    clean = log()
    parts = []
    for name, part in zip(clean.names, clean.slices, strict=True):
        t, x, xdot, duty = clean.t[part], clean.x[part], clean.xdot[part], clean.duty[part]
        held = recording(t, x, xdot, np.minimum(duty, 0.2), name)
        parts.append(replace(held, duty=duty))
    limited = concatenate(parts)
    found = examined(limited, ["field_saturation", "field_threshold", "power_law_yield"], 6)
    assert named(found) == ["field_saturation"]
    assert removed(found, limited) >= 0.95
