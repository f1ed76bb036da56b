"""Half the step gives the same force, for everything that a plant can hide."""

from __future__ import annotations

import numpy as np
import pytest
from plant_rig import ACTING, DAMPER, effect, hidden, over, plain, rms

from erdctl.plant.simulate import LEAST_SUBSTEPS, LONGEST_STEP, forces

# A force that jumps does so within a step; of a sample that falls into this step no more is known.
JUMPS = 0.01


@pytest.mark.parametrize("name", ACTING)
def test_half_the_step_changes_nothing(name: str) -> None:
    plant = hidden(name, effect(name).start)
    force, finer = forces(plant, over()), forces(plant, over(2))
    spread = np.ptp(plain())
    assert rms(force - plain()) > 1e-3 * spread or name == "gas_polytropic"  # it is not off
    apart = np.abs(force - finer) / spread
    assert np.quantile(apart, 1 - JUMPS) < (0.01 if name == "load_cell_ringing" else 1e-3)
    assert rms(apart) < 4e-3


def test_the_plain_damper_converges_faster() -> None:
    apart = np.abs(forces(DAMPER, over()) - forces(DAMPER, over(2)))
    assert apart.max() < 1e-6 * np.ptp(plain())


def test_the_step_is_fine() -> None:
    for ride in over():
        assert ride.substeps >= LEAST_SUBSTEPS >= 10
        assert ride.h <= LONGEST_STEP


def test_stiff_springs_are_stable() -> None:
    """Far stiffer than the step can follow, and far softer than any mount."""
    for name in ("mount_compliance", "fluid_compressibility"):
        for s in (1e-9, 1e-6, 1e-3, 1.0, 10.0):
            force = forces(hidden(name, s), over())
            assert np.isfinite(force).all()
            assert np.abs(force).max() < 2 * np.abs(plain()).max()
