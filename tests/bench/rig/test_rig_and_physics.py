"""Physics that a model lacks is no fault of the rig: logs of the plant are not accused."""

from __future__ import annotations

import io

import pyarrow.parquet as pq
import pytest

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.io.logs import read_logs

LEFT_OUT = {"clipped_channel"}  # a fault of the rig, which the plant also draws


@pytest.mark.parametrize("seed", range(410_000, 410_006))
def test_a_log_of_the_plant(seed: int) -> None:
    case = plant.draw(seed)
    sink = io.BytesIO()
    pq.write_table(plant.log(case), sink)
    held = {"log.parquet": bytearray(sink.getvalue())}
    log = read_logs(["log.parquet"], need_force=True, held=held, report=lambda line: None)
    names = {e["name"] for e in plant.key(case)["effects"]}
    if not names & LEFT_OUT:
        assert look(log.recording).lines() == []
