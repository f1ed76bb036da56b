"""Physics that comes and goes with the speed is no heat, however well a fast enough heat fits."""

from __future__ import annotations

import io

import numpy as np
import pyarrow.parquet as pq
import pytest

from erdctl import plant
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.effects import get, names
from erdctl.io.logs import read_logs


@pytest.mark.long
def test_a_charge_that_flow_carries_away_is_no_heat() -> None:
    """Of this yield force heat with a time constant of 0.11 s explained all but the noise."""
    case = plant.draw(1_280_014, kind="unknown", known=names())
    assert [e["name"] for e in plant.key(case)["effects"]] == ["flow_discharge"]
    sink = io.BytesIO()
    pq.write_table(plant.log(case), sink)
    held = {"log.parquet": bytearray(sink.getvalue())}
    log = read_logs(["log.parquet"], need_force=True, held=held, report=lambda line: None)
    found = diagnose(log.recording, [get("thermal_fade")], learning=False, limits=False)
    assert found.verdict is Verdict.UNEXPLAINED


def test_heat_leaves_a_gap_of_a_millimetre_in_a_second() -> None:
    """d^2 / (pi^2 alpha), of the slowest mode across it."""
    [tau] = [q for q in get("thermal_fade").quantities if q.symbol == "tau"]
    assert abs(tau.low - 1e-3**2 / (np.pi**2 * 1e-7)) < 0.05
