"""Sequences from corrected models: every effect of the catalogue, replayed through itself."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import trajectories
from rig import TRUTH, recording

from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.effects import catalogue, get
from erdctl.mimic import Plan, mimic
from erdctl.model.amplifier import Amplifier
from erdctl.model.composed import Model
from erdctl.model.effect import Effect, Stage
from erdctl.model.faults import parse_fault
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.slots import ChannelSlot, MotionSlot

CATALOGUE = catalogue()
every = pytest.mark.parametrize("effect", CATALOGUE, ids=lambda e: e.name)

# Strong enough to be felt in a record of 4 s; the catalogue's starts for all others.
TYPICAL = {
    "backlash.g": 2e-3, "deformation_fault.t_0": 2.0, "electrical_fault.t_0": 2.0,
    "oil_leakage.t_0": 2.0, "end_stop.x_stop": 8e-3, "end_stop.k_c": 2e3, "end_stop.k_r": 2e3,
    "field_saturation.a_c": 3.0, "field_saturation.a_r": 3.0,
    "fluid_compressibility.s_f": 1e-4, "mount_compliance.s_m": 1e-4,
    "gas_polytropic.a": 10.0, "input_delay.tau": 0.02, "time_skew.tau": 0.02,
    "position_dependent_damping.b_1": 20.0, "position_dependent_damping.e_1": 20.0,
    "preyield_viscosity.v_y": 0.03, "yield_hysteresis.v_y": 0.03, "yield_hysteresis.kappa": 5.0,
    "signed_yield_lag.T_s": 0.03, "supply_slew.T_full": 0.5, "thermal_fade.a_v": 0.05,
    "thermal_fade.a_y": 0.05,
}  # fmt: skip

# Part of the plain sequence's error that at least goes; all others may be worth nothing, since what
# they add is the same in the faulty damper and in the one that plays it.
WORTH = {
    "backlash": 0.05, "deformation_fault": 0.25, "electrical_fault": 0.3, "field_saturation": 0.5,
    "field_threshold": 0.8, "fluid_compressibility": 0.5, "gas_polytropic": 0.15,
    "input_delay": 0.55, "mount_compliance": 0.7, "position_dependent_damping": 0.3,
    "preyield_viscosity": 0.12, "rise_decay_asymmetry": 0.3, "shear_thinning": 0.3,
    "signed_yield_lag": 0.5, "supply_slew": 0.3, "yield_hysteresis": 0.6,
}  # fmt: skip


@cache
def drive() -> Recording:
    t = np.arange(800) * 0.005
    tones = trajectories.mixed(np.random.default_rng(3), 0.02, 0.15, 4.0)
    duty = trajectories.random_hold(np.random.default_rng(4), t, (0.1, 0.2, 0.3))
    return recording(t, tones.x(t), tones.velocity(t), duty)


def parameters(*chosen: Effect) -> Parameters:
    model = Model(chosen)
    start = {e.key(q.symbol): q.start for e in chosen for q in e.quantities}
    values = TRUTH | {name: TYPICAL.get(name, value) for name, value in start.items()}
    units = {name: q.unit for name, q in model.quantities.items()}
    return Parameters(
        model=model,
        estimates={name: Estimate(value=values[name], unit=unit) for name, unit in units.items()},
    )


# From the start of the record: an onset within it may not be anticipated while the damper is still
# healthy, and the error of the first lags after it is the same for any sequence.
def plan(*chosen: Effect, fault: str = "oil=0.5", amplifier: Amplifier | None = None) -> Plan:
    faults = [parse_fault(f) for f in fault.split()]
    return mimic(parameters(*chosen), drive(), faults, amplifier or Amplifier())


@pytest.mark.few(20)
@every
def test_never_worse_than_the_plain_sequence(effect: Effect) -> None:
    found = plan(effect)
    c = found.correction
    assert c is not None
    print(f"{effect.name:28} plain {c.plain:.4f} corrected {c.nrmse:.4f} removed {c.removed:.0%}")
    assert c.nrmse <= c.plain
    assert c.removed >= WORTH.get(effect.name, 0.0)
    assert found.duty.min() >= 0.0
    assert found.duty.max() <= Amplifier().duty_max
    # The plain sequence is what the same file without its effects gives, or better.
    alone = plan().duty
    made = parameters(effect).model.force(_signals(alone), parameters(effect).values)
    if not c.left_out:
        miss = np.sqrt(np.mean((found.ideal - made) ** 2)) / np.ptp(found.ideal)
        assert c.plain <= miss + 1e-12


def _signals(duty: Array) -> Signals:
    return Signals.of(drive()).with_duty(duty)


PAIRS = [
    ("input_delay", "supply_slew"), ("signed_yield_lag", "field_saturation"),
    ("preyield_viscosity", "mount_compliance"), ("backlash", "mount_compliance"),
    ("field_threshold", "input_delay"), ("thermal_fade", "fluid_compressibility"),
    ("rise_decay_asymmetry", "coulomb_friction"), ("force_drift", "signed_yield_lag"),
]  # fmt: skip


@pytest.mark.parametrize("names", PAIRS, ids="+".join)
def test_pairs(names: tuple[str, str]) -> None:
    c = plan(*(get(n) for n in names)).correction
    assert c is not None
    print(f"{'+'.join(names):40} plain {c.plain:.4f} corrected {c.nrmse:.4f} {c.removed:.0%}")
    assert c.removed > 0.15
    assert not c.fell_back


def test_several_faults_and_a_real_amplifier() -> None:
    """Steps of the duty, a slow update and a slew limit hold for the iterated sequence too."""
    amplifier = Amplifier(resolution=0.005, slew=20.0, update_rate=100.0)
    found = plan(
        get("input_delay"), get("signed_yield_lag"),
        fault="oil=0.5@0:2 electrical=0.6@2:3 deformation=0.7@3", amplifier=amplifier,
    )  # fmt: skip
    assert found.correction is not None
    assert found.correction.removed > 0.2
    assert found.duty / 0.005 == pytest.approx(np.round(found.duty / 0.005), abs=1e-6)
    assert (np.diff(found.duty)[::2] == 0.0).all()
    assert np.abs(np.diff(found.duty)).max() <= 20.0 * 0.01 + 1e-9
    for reach in found.reaches:
        assert reach.plain is not None
        assert reach.compensated <= reach.plain + 2e-3


def test_the_channel_of_the_force_is_not_made_up_for() -> None:
    """What only the recording knows leaves the sequence alone, and shows in what is recorded."""
    channel = [e for e in CATALOGUE if isinstance(e.slot, ChannelSlot) or e.stage is Stage.SENSOR]
    assert channel
    for effect in channel:
        alone, found = plan(), plan(effect)
        assert np.array_equal(found.duty, alone.duty)
        assert [r.compensated for r in found.reaches] == [r.compensated for r in alone.reaches]
        # The velocity of a drive is without noise, so nothing of its channel is left to be seen.
        seen = not (isinstance(effect.slot, MotionSlot) and effect.slot.of_samples)
        assert seen != np.allclose(found.expected, alone.expected)
        whole = parameters(effect)
        assert np.array_equal(found.expected, whole.model.force(_signals(found.duty), whole.values))


def test_a_force_that_outlasts_a_reversal_is_in_reach() -> None:
    """Healthy control gives the healthy force, although no steady yield force would."""
    found = plan(get("signed_yield_lag"), fault="electrical=0.999@1")
    assert found.reaches[0].out_of_reach < 0.01
    assert found.reaches[0].compensated < 0.005


def test_a_plain_file_has_nothing_to_correct() -> None:
    found = plan()
    assert found.correction is None
    assert all(r.plain is None for r in found.reaches)
