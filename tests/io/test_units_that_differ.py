"""A unit in a column's name and one in a field of its own: where they differ, people decide."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from erdctl.core.errors import InputProblem
from erdctl.io.logs import Log, read_logs

N = 60


def read(folder: Path, name: str, field: str, *maps: str) -> Log:
    t = 0.005 * np.arange(N)
    x = pa.field(name, pa.float64(), metadata={"unit": field})
    schema = pa.schema([pa.field("t", pa.float64()), x, pa.field("force", pa.float64())])
    rows = [pa.array(t), pa.array(1.0 + np.sin(9.0 * t)), pa.array(np.cos(9.0 * t))]
    file = folder / "log.parquet"
    pq.write_table(pa.Table.from_arrays(rows, schema=schema), file)
    return read_logs([str(file)], maps=maps, need_force=True, report=lambda line: None)


@pytest.mark.parametrize(
    ("name", "field", "way"),
    [("x [mm]", "m", "[m] or [mm]"), ("Stroke (in)", "mm", "[mm] or [in]")],
)
def test_they_differ(tmp_path: Path, name: str, field: str, way: str) -> None:
    with pytest.raises(InputProblem, match=f"in {field} by its own field") as caught:
        read(tmp_path, name, field)
    assert f'--map "x={name}{way.replace(" or ", chr(34) + " or ")}' in str(caught.value)
    assert read(tmp_path, name, field, f"x={name}[cm]").recording.x[0] == pytest.approx(0.01)


@pytest.mark.parametrize("field", ["mm", "millimeter"])
def test_they_are_the_same(tmp_path: Path, field: str) -> None:
    assert read(tmp_path, "x [mm]", field).recording.x[0] == pytest.approx(1e-3)
