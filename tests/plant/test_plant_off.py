"""Without its effect a plant is the paper's, and an effect that fades goes over into it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from plant_rig import ACTING, DAMPER, effect, hidden, over, plain, rms

from erdctl.plant import ForceChannel, Outside, Physics, Plant
from erdctl.plant.simulate import forces

# Where the yield force jumps at a reversal, a vanishing effect still moves the jump by a sample:
# the misfit fades with a root of the strength only.
SLOW = {
    "backlash", "mount_compliance", "fluid_compressibility", "cavitation", "load_cell_ringing",
    "signed_yield_lag", "field_saturation", "clipped_channel", "damped_backlash",
}  # fmt: skip


def test_defaults_are_off_bit_for_bit() -> None:
    spelt = Plant(*DAMPER[:2], Physics(), Outside(), ForceChannel())
    assert spelt == DAMPER
    assert np.array_equal(forces(spelt, over()), plain())
    assert hidden("backlash", 0.1).plain() == DAMPER


def test_switches_that_change_nothing() -> None:
    """Parameters beside the one that is off do not matter."""
    idle = DAMPER.with_physics(
        stop_high=0.001, thin=0.02, weaken=0.01, polytropic=1.2, v_ref=0.3, v_s=0.2, x_p=1e-3,
        onset=1.0, F_k=3.0, lead=4.0, void_growth=0.3, bubbles=0.3, cooling=0.1, film=50.0,
    ).with_outside(bump_pitch=0.01, swings=2.0, memory_short=0.1, wear_travel=0.1)  # fmt: skip
    assert np.array_equal(forces(idle, over()), plain())


@pytest.mark.parametrize("name", ACTING)
def test_a_fading_effect_goes_over_into_the_plain_damper(name: str) -> None:
    e = effect(name)
    weak, strong = hidden(name, e.low), hidden(name, e.start)
    left = rms(forces(weak, over()) - forces(weak.plain(), over()))
    full = rms(forces(strong, over()) - forces(strong.plain(), over()))
    assert left < (0.35 if name in SLOW else 0.05) * full
    assert left < 0.03 * np.ptp(plain())


@pytest.mark.parametrize("name", ACTING)
def test_strength_is_what_it_says(name: str) -> None:
    """More of it changes the force more, over the part of its range that logs are drawn from."""
    e = effect(name)
    steps = np.geomspace(e.start / 4, min(e.start * 4, e.high), 4)
    plants = [hidden(name, float(s)) for s in steps]
    gone = [rms(forces(p, over()) - forces(p.plain(), over())) for p in plants]
    # a mass has a largest plausible size, which this slow campaign soon reaches
    assert gone[0] < gone[-1] or (name == "fluid_inertia" and gone[0] == gone[-1])
    assert all(b > 0.8 * a for a, b in pairwise(gone))
