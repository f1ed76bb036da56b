"""A force channel whose clock jitters is late and early alike: that is no time skew."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import get
from erdctl.io.logs import read_logs
from erdctl.plant.nulls import draw_null


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", [1120102, 1120138, 1120354])
def test_is_no_skew(seed: int, tmp_path: Path) -> None:
    """These had been named: the skew leaves doubtful samples without weight, those next to turns,
    where a jitter shows most, and each rule must hold it against a model that is spared them."""
    null = draw_null(seed, "jitter")
    path = tmp_path / "log.parquet"
    pq.write_table(null.table, path)
    log = read_logs([str(path)], need_force=True, report=lambda line: None)
    assert not diagnose(log.recording, [get("time_skew")], limits=False, learning=False).findings
