"""Physics that a model lacks is no fault of the rig: logs of the plant are not accused."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from places import SHARED
from rig import real

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


@pytest.mark.parametrize("seed", range(410_000, 410_006))
def test_a_log_of_the_plant(seed: int) -> None:
    """At its own rate nothing is found; at an eighth no record is said to be noisy."""
    case = plant.draw(seed)
    r = recorded(case)
    if {e["name"] for e in plant.key(case)["effects"]} & LEFT_OUT:
        return
    assert look(r).lines() == []
    assert "record_noise" not in {f.code for f in look(every(r, 8)).faults}


@pytest.mark.real_data
@pytest.mark.parametrize("name", ["mr_sine", "mr_raw", "friction_sine"])
def test_a_real_damper_at_any_rate(name: str) -> None:
    """A damper's own chatter, sampled too coarsely, is white: no noisy record, no bursts.

    Of friction_sine every fourth sample is said to hold a burst (of stick-slip, once in the log),
    and every sixth a spike; that is not held.
    """
    table = read_logs([str(real(f"{name}.parquet", SHARED))], need_force=True, report=print)
    for nth in (1, 2, 3, 8, 12):
        assert look(every(table.recording, nth)).lines() == []
