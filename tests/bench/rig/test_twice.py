"""The same samples twice in a log, and what only looks like it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from places import FIXTURES, SHARED
from rig import real

from erdctl.bench.rig import look
from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.twice import _windows
from erdctl.core.recording import Array, Recording, concatenate
from erdctl.io.logs import read_logs

SINE = np.sin(2 * np.pi * np.arange(250) / 250.0)


@pytest.fixture(scope="module")
def good() -> Recording:
    path = str(FIXTURES / "healthy_campaign.parquet")
    return read_logs([path], need_force=True, report=lambda line: None).recording


def said(r: Recording) -> list[RigFault]:
    return [f for f in look(r).faults if f.code == "record_twice"]


def force_of(r: Recording) -> Array:
    assert r.force is not None
    return r.force


def beside(r: Recording, *more: Recording) -> Recording:
    """A log with more records behind its own."""
    parts = [r, *more]
    names = tuple(f"r{i}" for i in range(sum(len(p.names) for p in parts)))
    return replace(concatenate(parts), names=names)


def cut(r: Recording, record: int, first: int, end: int) -> Recording:
    """A part of a record as a record of its own."""
    rows = np.arange(*r.starts[[record, record + 1]].tolist())[first:end]
    return r.take(rows, np.array([0, len(rows)]), (r.names[record],))


def test_a_record_that_was_copied_is_left_out(good: Recording) -> None:
    count = len(good.names)
    log = beside(good, good.select([3]), good.select([3]))
    first, second = said(log)
    assert (first.record, second.record) == (count, count + 1)
    assert first.blocks
    assert second.blocks
    assert "that of record 'r3', sample for sample" in first.text
    assert len(look(log).usable().names) == count


def test_under_two_duties_neither_is_used(good: Recording) -> None:
    copy = good.select([3])
    log = beside(good, replace(copy, duty=np.full(len(copy), 0.42)))
    own, other = said(log)
    assert {own.record, other.record} == {3, len(good.names)}
    assert own.blocks
    assert other.blocks
    assert "for 42 % in the median" in own.text
    assert "(42 for" in other.text


def test_of_two_motions_neither_is_used(good: Recording) -> None:
    """As where the force of one run was written beside the deflection of the next."""
    log = beside(good, replace(good.select([3]), x=-good.select([3]).x))
    assert [(f.record, f.blocks) for f in said(log)] == [(3, True), (len(good.names), True)]
    assert all("and its motion is not" in f.text for f in said(log))


def test_cuts_that_overlap_count_once(good: Recording) -> None:
    log = beside(cut(good, 2, 0, 400), cut(good, 2, 200, len(good)), good.select([5]))
    (fault,) = said(log)
    assert not fault.blocks
    assert fault.record == 1
    assert fault.samples is not None
    assert fault.samples.tolist() == list(range(400, 600))
    excluded = look(log).usable().excluded
    assert excluded is not None
    assert np.flatnonzero(excluded).tolist() == list(range(400, 600))


def test_a_log_that_was_put_together_of_the_same_stretch_twice(good: Recording) -> None:
    """Under a time that goes on, as where a logger writes a buffer again."""
    part = cut(good, 2, 0, 800)
    rows = np.concatenate([np.arange(300), np.arange(100, 800)])
    again = part.take(rows, np.array([0, len(rows)]), part.names)
    step = part.t[1] - part.t[0]
    (fault,) = said(replace(again, t=step * np.arange(len(rows))))
    assert fault.samples is not None
    assert fault.samples.tolist() == list(range(300, 500))
    assert "in the same record" in fault.text


def test_records_of_one_motion_and_one_duty_are_two(good: Recording) -> None:
    part = good.select([3])
    random = np.random.default_rng(5)
    noise = 0.3 * random.standard_normal((2, len(part)))
    assert said(beside(good, *(replace(part, force=force_of(part) + n) for n in noise))) == []


def test_without_noise_a_force_may_be_the_same_of_two_duties(good: Recording) -> None:
    """As a simulation gives it from cycle to cycle, and below the threshold of a field."""
    part = good.select([3])
    plain = replace(part, force=np.tile(np.round(60.0 * SINE, 3), 10)[: len(part)])
    assert said(beside(good, plain, replace(plain, duty=np.full(len(part), 0.42)))) == []
    assert len(said(beside(good, plain, plain))) == 1


@pytest.mark.parametrize("digit", [0.1, 0.3])
def test_coarse_digits_are_the_same_now_and_then(good: Recording, digit: float) -> None:
    """Of a load cell whose noise is two digits and one; a copy is found all the same."""
    rounded = replace(good, force=np.round(force_of(good) / digit) * digit)
    assert said(rounded) == []
    assert len(said(beside(rounded, rounded.select([4])))) == 1


def test_a_force_that_stands_is_no_copy(good: Recording) -> None:
    """At a limit, for longer than what is compared, in many records; or for a whole one."""
    limits = np.arange(30.0, 60.0, 0.1)  # of which one in 32 is a value that begins a window
    limit = next(F for F in limits if len(_windows(np.repeat([F, 0.0], 20))[1]))
    force = force_of(good).copy()
    for a, b in pairwise(good.starts.tolist()):
        force[a + 50 : min(a + 250, b)] = limit
    assert said(replace(good, force=force)) == []
    idle = replace(good.select([3]), force=np.zeros(len(good.select([3]))))
    assert said(beside(good, idle, idle)) == []


@pytest.mark.real_data
@pytest.mark.parametrize("name", ["mr_raw", "mr_sine", "friction_sine"])
def test_no_real_recording_holds_anything_twice(name: str) -> None:
    r = read_logs([str(real(f"{name}.parquet", SHARED))], need_force=True, report=print).recording
    assert said(r) == []
    copy = said(beside(r, r.select([1])))
    assert [f.record for f in copy] == [len(r.names)]
