"""Conversions of MDF channels: evaluated right, or refused with the channel and the formula."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from shapes import T, X

from erdctl.core.errors import InputProblem

COUNTS = (np.arange(1000) - 500).astype(np.int16)
Write = Callable[..., Path]
Read = Callable[..., pa.Table]


def scaled(mdf: Write, conversion: dict[str, Any], version: str = "4.10") -> Path:
    if version < "4" and "formula" in conversion:
        conversion = {"formula": conversion["formula"].replace("X1", "X")}  # it becomes X1 there
    force = {"samples": COUNTS, "unit": "N", "conversion": conversion}
    return mdf([("bench", T, {"x": {"samples": X, "unit": "m"}, "force": force})], version)


@pytest.mark.parametrize("version", ["4.10", "3.30"])
@pytest.mark.parametrize(
    ("conversion", "expected"),
    [
        ({"formula": "X1*0.25+3"}, COUNTS * 0.25 + 3.0),
        ({"formula": "100*exp(X1/1000)"}, 100.0 * np.exp(COUNTS / 1000.0)),
        ({"P1": 0, "P2": 2, "P3": 6, "P4": 0, "P5": 0, "P6": 4}, (2.0 * COUNTS + 6.0) / 4.0),
        (
            {"raw_0": -1000.0, "phys_0": -10.0, "raw_1": 1000.0, "phys_1": 10.0,
             "conversion_type": 4, "val_param_nr": 4},
            None,
        ),
    ],
    ids=["formula", "exp", "rational", "table"],
)  # fmt: skip
def test_evaluated(
    mdf: Write, converted: Read, version: str, conversion: dict[str, Any], expected: Any
) -> None:
    found = np.asarray(converted(scaled(mdf, dict(conversion), version))["force"], np.float64)
    if expected is None:  # a table, which asammdf writes without interpolation
        assert set(found) <= {-10.0, 10.0}
    else:
        assert np.allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("version", ["4.10", "3.30"])
@pytest.mark.parametrize(
    "formula", ["X1^2", "unheard_of(X1)", "1/X1", "X1*9**9**9**9", "__import__('os')", "X1 + Y"]
)
def test_what_cannot_be_evaluated_is_refused(
    mdf: Write, converted: Read, version: str, formula: str
) -> None:
    path = scaled(mdf, {"formula": formula}, version)
    with pytest.raises(InputProblem, match="its conversion cannot be evaluated") as caught:
        converted(path)
    assert f"column 'force': its conversion cannot be evaluated: formula '{formula}'" in str(
        caught.value
    )


def test_a_group_that_is_shorter_than_it_says(mdf: Write, converted: Read) -> None:
    path = mdf([("bench", T, {"x": {"samples": X, "unit": "m"}})])
    data = bytearray(path.read_bytes())
    at = data.find((1000).to_bytes(8, "little"), data.find(b"##CG"))
    data[at : at + 8] = (1200).to_bytes(8, "little")
    path.write_bytes(data)
    with pytest.raises(InputProblem, match="said to have 1200 samples, but holds 1000"):
        converted(path)
