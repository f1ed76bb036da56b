"""Physics that a model lacks is no fault of the rig: logs of the plant are not accused."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from places import SHARED
from rig import real
from seeded import known_before

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.core.recording import Recording
from erdctl.io.logs import read_logs

LEFT_OUT = {"clipped_channel"}  # a fault of the rig, which the plant also draws


def recorded(case: plant.Case) -> Recording:
    sink = io.BytesIO()
    pq.write_table(plant.log(case), sink)
    held = {"log.parquet": bytearray(sink.getvalue())}
    log = read_logs(["log.parquet"], need_force=True, held=held, report=lambda line: None)
    return log.recording


def every(r: Recording, nth: int) -> Recording:
    """The same motion from a slower recorder, without a filter before it."""
    kept = np.concatenate([np.arange(s.start, s.stop, nth) for s in r.slices])
    counts = [len(range(s.start, s.stop, nth)) for s in r.slices]
    channels = {c: getattr(r, c)[kept] for c in ("t", "x", "xdot", "duty", "force")}
    return replace(r, **channels, starts=np.cumsum([0, *counts]))


@pytest.mark.few(3)
@pytest.mark.parametrize("seed", range(410_000, 410_006))
def test_a_log_of_the_plant(seed: int) -> None:
    """At its own rate nothing is found; at an eighth no record is said to be noisy."""
    case = plant.draw(seed)
    r = recorded(case)
    if {e["name"] for e in plant.key(case)["effects"]} & LEFT_OUT:
        return
    assert look(r).lines() == []
    assert "record_noise" not in {f.code for f in look(every(r, 8)).faults}


@pytest.mark.parametrize("seed", [1_273_010, 1_283_076, 1_284_016, 1_284_094])
def test_a_record_without_field_is_not_accused(seed: int) -> None:
    """Its weak and smooth force was said to be 60 ms early, or to have a zero of its own: what a
    model of the others misses of it is much beside it, and turns its phase."""
    assert look(recorded(plant.draw(seed, kind="null"))).lines() == []


def test_a_weak_record_is_not_held_against_what_a_model_misses_of_the_strong() -> None:
    """Without a field it had half of the force that a model of the others says, which misses as
    much of them: a gain of 0.45 in record 20 of 22 (`input_delay`)."""
    known = known_before("deflection_offset")
    case = plant.draw(1_660_047, kind="single", level=5.0, known=known)
    assert look(recorded(case)).lines() == []


def test_a_friction_that_builds_up_over_its_travel_is_not_late() -> None:
    """Beside records with a field, two without one were said to be 60 and 72 ms late."""
    case = plant.draw(440_087, known=known_before("deflection_offset"))
    assert [e["name"] for e in plant.key(case)["effects"]] == ["presliding_friction"]
    assert look(recorded(case)).lines() == []


def test_what_a_gas_adds_at_both_ends_is_no_zero() -> None:
    """Of the record with the longest stroke it was 36 N in the mean."""
    case = plant.draw(440_099, known=known_before("deflection_offset"))
    assert [e["name"] for e in plant.key(case)["effects"]] == ["gas_polytropic"]
    assert look(recorded(case)).lines() == []


@pytest.mark.parametrize("seed", [1_720_015, 1_740_002])
def test_a_gas_that_warms_is_no_zero(seed: int) -> None:
    """Of the record that warmed most it was 5 and 29 N in the mean, and -1 and -6 N in its first
    quarter: the record was left out, and the load cell to be set to zero."""
    case = plant.draw(seed, known=known_before("deflection_offset"))
    assert [e["name"] for e in plant.key(case)["effects"]] == ["gas_thermal_drift"]
    assert look(recorded(case)).lines() == []


@pytest.mark.few(1)
@pytest.mark.parametrize("counts", [60, 120, 250])
def test_a_count_that_flickers_is_no_spike(counts: int) -> None:
    """A record of a weak force on a coarse channel had 1 to 8 spikes, of one count each."""
    for seed in (1_660_047, *range(1_673_000, 1_673_006)):
        r = recorded(plant.draw(seed, kind="null"))
        step = float(np.ptp(r.force)) / counts
        found = look(replace(r, force=np.round(r.force / step) * step)).faults
        assert "force_spikes" not in {f.code for f in found}


@pytest.mark.long
def test_a_mass_is_no_lag() -> None:
    """Of a linear damper it is, and a record without field was said to be early by m / c."""
    case = plant.draw(1_254_000, kind="pair", effects=("time_skew", "fluid_inertia"))
    assert look(recorded(case)).lines() == []


SPOILED = {
    "record_gain": lambda t, F, span: 2.0 * F,
    "record_offset": lambda t, F, span: F + 0.2 * span,
    "record_lag": lambda t, F, span: np.interp(t - 0.03, t, F),
}


@pytest.mark.few(1)
@pytest.mark.parametrize("code", SPOILED)
def test_among_records_of_any_control(code: str) -> None:
    """One record in eight logs with an error: mostly it is seen, and never another one blamed."""
    seen = 0
    for seed in range(420_000, 420_008):
        r = recorded(plant.draw(seed, kind="null"))
        at = max(range(len(r.names)), key=lambda k: float(np.ptp(r.duty[r.slices[k]])))
        part = r.slices[at]
        force = r.force.copy()
        span = float(np.ptp(np.percentile(force, [0.1, 99.9])))
        force[part] = SPOILED[code](r.t[part], force[part], span)
        found = look(replace(r, force=force)).faults
        faults = [f for f in found if f.code.startswith("record_")]
        assert {(f.code, f.record) for f in faults} <= {(code, at)}, seed
        seen += len(faults)
    assert seen >= 4


@pytest.mark.real_data
@pytest.mark.parametrize("name", ["mr_sine", "mr_raw", "friction_sine", "friction_semiactive"])
def test_a_real_damper_at_any_rate(name: str) -> None:
    """A damper's own chatter, sampled too coarsely, is white: no noisy record, no bursts.

    The friction damper's, as it slides one way, is 30 times as loud as the rest of a stroke. Of
    friction_sine every sixth sample is said to hold a spike; that is not held.
    """
    table = read_logs([str(real(f"{name}.parquet", SHARED))], need_force=True, report=print)
    for nth in (1, 2, 3, 4, 5, 8, 12):
        assert look(every(table.recording, nth)).lines() == []
