"""What inspect says of a log whose facts are known."""

from __future__ import annotations

from cProfile import Profile
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rig import campaign, noisy

from erdctl.bench.inspection import force_noise, inspect
from erdctl.core.recording import Recording, concatenate
from erdctl.effects import catalogue


def without(r: Recording, *rows: int) -> Recording:
    keep = np.delete(np.arange(len(r)), rows)
    return r.take(keep, np.array([0, len(keep)], dtype=np.intp), r.names)


def one(rate: float = 200.0) -> Recording:
    return campaign(rate, 12.0).select([0])


@pytest.mark.parametrize("samples", [2, 3, 4])
def test_records_of_a_few_samples(samples: int) -> None:
    r = one()
    short = r.window(slice(0, samples))
    found = inspect(short, catalogue())
    assert found.records[0].samples == samples
    assert found.records[0].rate == pytest.approx(200.0)
    assert (found.noise is None) == (samples < 4)


def test_every_record_is_what_it_is_alone() -> None:
    """Spans are taken of all records at once."""
    r = campaign(200.0, 12.0)
    together = inspect(r, []).records
    alone = [inspect(r.select([i]), []).records[0] for i in range(len(r.names))]
    assert list(together) == alone


def test_work_grows_with_the_records_and_no_faster() -> None:
    """Counted in calls, not seconds: a look at all records for each would be a thousand times."""
    counts = []
    for times in (20, 40):
        r = concatenate([one().window(slice(i, i + 5)) for i in range(times)])
        with Profile() as profile:
            inspect(r, [])
        counts.append(sum(e.callcount for e in profile.getstats()))
    assert counts[1] < 2.2 * counts[0]


def test_an_even_record() -> None:
    (record,) = inspect(one(), []).records
    assert record.rate == pytest.approx(200.0, rel=1e-12)
    assert (record.gaps, record.missing, record.gap_at) == (0, 0, None)
    assert record.jitter < 1e-9
    assert record.x.high - record.x.low == pytest.approx(0.04, rel=1e-3)
    assert record.speed == pytest.approx(0.02 * 2 * np.pi * 0.7, rel=1e-3)


@settings(deadline=None, max_examples=20)
@given(st.sets(st.integers(5, 2300), min_size=1, max_size=20))
def test_missing_samples_are_counted(lost: set[int]) -> None:
    whole = one()
    (record,) = inspect(without(whole, *lost), []).records
    ordered = np.sort(list(lost))
    runs = np.split(ordered, np.flatnonzero(np.diff(ordered) > 1) + 1)
    assert record.missing == len(lost)
    assert record.gaps == len(runs)
    longest = max(runs, key=len)
    assert record.longest_gap == pytest.approx((len(longest) + 1) / 200.0)
    assert record.gap_at is not None
    assert record.gap_at in [pytest.approx(whole.t[r[0] - 1]) for r in runs]


@pytest.mark.parametrize("steps", [0.2, 0.3, 0.45])
def test_jitter_is_no_gap(steps: float) -> None:
    r = one()
    t = r.t + 5e-3 * np.random.default_rng(2).uniform(-steps, steps, len(r))
    (record,) = inspect(replace(r, t=t), []).records
    assert record.gaps == 0
    assert 1.5 * steps < record.jitter <= 2.01 * steps


@pytest.mark.parametrize("rms", [0.05, 0.3, 2.0])
def test_white_noise_is_guessed(rms: float) -> None:
    found = force_noise(noisy(campaign(), seed=5, rms=rms))
    assert found.rms == pytest.approx(rms, rel=0.1)


def test_a_coarse_force_has_at_least_its_rounding() -> None:
    r = campaign()
    assert r.force is not None
    found = force_noise(replace(r, force=np.round(r.force / 0.5) * 0.5))
    assert found.resolution == pytest.approx(0.5)
    assert found.rms >= 0.5 / np.sqrt(12.0)


def test_time_at_each_level() -> None:
    r = campaign()
    found = inspect(r, []).seconds_at
    assert sum(found.values()) == pytest.approx(float(r.step.sum()))
    assert found[0.45] == pytest.approx(float(r.step[r.duty == 0.45].sum()))


def test_a_log_without_force() -> None:
    r = replace(concatenate([one(), one()]), force=None)
    found = inspect(r, [])
    assert found.noise is None
    assert found.mass is None
    assert all(record.force is None for record in found.records)
