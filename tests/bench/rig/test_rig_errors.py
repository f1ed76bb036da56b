"""Every error of a rig that is put into a good log is seen, with its place and a remedy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from places import FIXTURES, SHARED
from rig import real
from rig_errors import ERRORS, RigError, chosen
from scipy.signal import savgol_filter

from erdctl.bench.differentiation import derive_xdot
from erdctl.bench.rig import Rig, look
from erdctl.bench.rig.fault import CODES, RigFault, sound
from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.recording import Recording
from erdctl.io.logs import read_logs

# What real logs cannot show: a constant setting has no duty; 15 kN in kilonewtons is 15 N, which a
# small damper has; 76 mm a thousand times too small is a stroke of 76 um, which a test may have;
# and of six records of a damper with play the lags differ anyway.
UNSEEN = {
    "friction_sine": {
        "duty in per cent within 0..1", "force in kN taken for N", "x in m taken for mm",
        "one record late", "duty inverted", "one record with the duty of another",
    },
}  # fmt: skip


def read(path: object) -> Recording:
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording


@pytest.fixture(scope="module")
def good() -> Recording:
    return read(FIXTURES / "healthy_campaign.parquet")


def seen(error: RigError, spoiled: Recording, rig: Rig) -> bool:
    """Whether what was found is the error that was put in, where it was put in."""
    at = chosen(spoiled)
    part = spoiled.slices[at]
    for f in rig.faults:
        if f.code not in error.codes or not f.remedy:
            continue
        if error.place == "log" or f.record == at:
            return True
        if f.record is None and f.samples is not None:
            return bool(((f.samples >= part.start) & (f.samples < part.stop)).any())
    return False


def test_a_good_log_has_no_fault(good: Recording) -> None:
    assert look(good).lines() == []


@pytest.mark.parametrize("name", ERRORS)
def test_error_is_seen(good: Recording, name: str) -> None:
    for seed in range(1):
        spoiled = ERRORS[name].spoil(good, np.random.default_rng(seed))
        rig = look(spoiled)
        assert seen(ERRORS[name], spoiled, rig), rig.lines()
        assert {f.code for f in rig.faults} <= ERRORS[name].codes, rig.lines()


@pytest.mark.real_data
@pytest.mark.parametrize("log", ["mr_sine", "friction_sine"])
def test_errors_in_real_recordings(log: str) -> None:
    recording = read(real(f"{log}.parquet", SHARED))
    assert look(recording).lines() == []
    missed = set()
    for name, error in ERRORS.items():
        spoiled = error.spoil(recording, np.random.default_rng(5))
        if not seen(error, spoiled, look(spoiled)):
            missed.add(name)
    assert missed == UNSEEN.get(log, set())


def test_codes_are_known(good: Recording) -> None:
    assert {code for e in ERRORS.values() for code in e.codes} <= set(CODES)
    with pytest.raises(UsageProblem, match="no rig check 'nonsense'"):
        look(good).accept(["nonsense"])


def test_what_is_accepted_is_used(good: Recording) -> None:
    spoiled = ERRORS["force in kN taken for N"].spoil(good, np.random.default_rng(0))
    with pytest.raises(InputProblem, match="kilonewtons"):
        look(spoiled).refuse()
    rig = look(spoiled).accept(["force_unit"])
    rig.refuse()
    assert rig.usable() is spoiled


def test_a_spoiled_record_is_left_out(good: Recording) -> None:
    spoiled = ERRORS["one record with a gain"].spoil(good, np.random.default_rng(0))
    kept = look(spoiled).usable()
    assert set(good.names) - set(kept.names) == {good.names[chosen(good)]}


def test_spoiled_samples_have_no_weight(good: Recording) -> None:
    from erdctl.core.blocks import pieces, whole

    spoiled = ERRORS["force frozen"].spoil(good, np.random.default_rng(0))
    kept = look(spoiled).usable()
    assert kept.excluded is not None
    frozen = kept.excluded
    assert 0 < np.count_nonzero(frozen) < 0.05 * len(kept)
    assert not whole(kept).weight[frozen].any()
    total = sum(float(b.weight.sum()) for b in pieces(kept, longest=500))
    plain = sum(float(b.weight.sum()) for b in pieces(good, longest=500))
    assert plain - 1.1 * np.count_nonzero(frozen) <= total < plain


def test_a_deflection_that_stood_at_a_limit_over_one_turn(good: Recording) -> None:
    """It went as far beyond as it came back, so that nothing seemed to move; once is no range."""
    part = good.slices[chosen(good)]
    x = good.x.copy()
    top = part.start + int(np.argmax(x[part]))
    limit = float(x[part].max()) - 0.2 * float(np.ptp(x))
    first, last = top, top
    while x[first - 1] > limit:
        first -= 1
    while x[last + 1] > limit:
        last += 1
    x[first : last + 1] = limit
    rig = look(replace(good, x=x, xdot_note="measured"))
    assert [(f.code, f.record) for f in rig.faults] == [("x_frozen", chosen(good))]
    assert rig.faults[0].samples is not None
    assert set(range(first, last + 1)) <= set(rig.faults[0].samples.tolist())


@pytest.mark.parametrize("frequency", [0.5, 2.0, 6.0])
def test_a_noisy_velocity_is_replaced_by_one_that_a_force_has_no_need_to_smooth(
    frequency: float,
) -> None:
    """A deflection in steps of 6 um at 200 Hz."""
    random, omega = np.random.default_rng(3), 2.0 * np.pi * frequency
    t = np.arange(4000) * 5e-3
    true = 0.15 * np.cos(omega * t) + 0.05 * np.cos(1.7 * omega * t + 1.0)
    x = 0.15 / omega * np.sin(omega * t) + 0.05 / (1.7 * omega) * np.sin(1.7 * omega * t + 1.0)
    log = Recording(
        t=t, x=np.round((x + 5e-6 * random.standard_normal(4000)) / 6e-6) * 6e-6,
        xdot=true + 5e-3 * random.standard_normal(4000), duty=np.full(4000, 0.3), force=1e3 * true,
        starts=np.array([0, 4000]), names=("a",),
    )  # fmt: skip
    found = sound(log, [RigFault("velocity_noise", None, "", "")]).xdot
    narrow = savgol_filter(log.x, 5, 2, deriv=1, delta=5e-3)  # which a force had to be smoothed for
    off, before = (float(np.std((xdot - true)[50:-50])) for xdot in (found, narrow))
    print(off, before)
    assert off < 0.4 * before


@pytest.mark.parametrize("zero", [0.01, -0.05])
def test_the_zero_of_a_velocity_is_taken_off(good: Recording, zero: float) -> None:
    """`velocity_noise` was named for it, where nothing else was hidden, and called `explained`."""
    v_0 = zero * float(np.std(good.xdot))
    rig = look(replace(good, xdot=good.xdot + v_0, xdot_note="measured"))
    (fault,) = rig.faults
    assert fault.code == "velocity_offset"
    assert fault.zero == pytest.approx(v_0, rel=0.1)
    np.testing.assert_allclose(rig.usable().xdot, good.xdot, atol=0.1 * abs(v_0))
    accepted = rig.accept(["velocity_offset"]).usable()
    np.testing.assert_array_equal(accepted.xdot, good.xdot + v_0)


@pytest.mark.parametrize("measured", [True, False])
def test_a_limit_is_told_from_a_rest_with_and_without_a_velocity(
    good: Recording, measured: bool
) -> None:
    """By the velocity, which goes on at a limit, or else by the force, which does."""
    r = ERRORS["x clipped"].spoil(good, np.random.default_rng(0))
    r = replace(r, xdot_note="measured")
    if not measured:
        xdot, note = derive_xdot(r.t, r.x, r.starts)
        r = replace(r, xdot=xdot, xdot_note=note)
    assert "x_clipped" in {f.code for f in look(r).faults}


def test_a_rod_at_rest_has_no_frozen_deflection(
    good: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The zero of its velocity, too little to be told as one, went on for long: "x stands still
    while the damper works"."""
    monkeypatch.setattr("erdctl.bench.rig.velocity.ZERO", np.inf)
    part = good.slices[chosen(good)]
    rests = slice(part.start, part.start + 2 * round(1.0 / (good.t[1] - good.t[0])))
    x, xdot, force = good.x.copy(), good.xdot.copy(), good.force
    assert force is not None
    x[rests], xdot[rests] = x[rests.stop], 0.0
    force = np.where(np.isin(np.arange(len(good)), np.r_[rests]), 0.0, force)
    v_0 = 0.03 * float(np.std(good.xdot))
    for zero in (0.0, v_0):
        rig = look(replace(good, x=x, xdot=xdot + zero, force=force, xdot_note="measured"))
        assert "x_frozen" not in {f.code for f in rig.faults}


def test_a_velocity_at_fault_is_left_out(good: Recording) -> None:
    spoiled = ERRORS["noise of the velocity channel"].spoil(good, np.random.default_rng(0))
    kept = look(spoiled).usable()
    assert "the column xdot being left out" in kept.xdot_note
    assert np.std(kept.xdot - good.xdot) < 0.3 * np.std(spoiled.xdot - good.xdot)
