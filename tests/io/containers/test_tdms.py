"""TDMS files as npTDMS writes them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from shapes import F, T, X

from erdctl.core.errors import InputProblem
from erdctl.io.extras import MissingLibrary
from erdctl.io.stored import units_of

Write = Callable[..., Path]
Read = Callable[..., pa.Table]

LINEAR = {
    "NI_Scaling_Status": "unscaled",
    "NI_Number_Of_Scales": 1,
    "NI_Scale[0]_Scale_Type": "Linear",
    "NI_Scale[0]_Linear_Slope": 0.25,
    "NI_Scale[0]_Linear_Y_Intercept": 3.0,
    "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
}


def wave(step: float, unit: str | None = None, **more: object) -> dict[str, object]:
    return {"wf_increment": step, **({"unit_string": unit} if unit else {}), **more}


def test_waveforms(tdms: Write, converted: Read, said: list[str]) -> None:
    path = tdms({"bench": {"x": (X * 1e3, wave(1e-3, "mm")), "force": (F, wave(1e-3, "N"))}})
    table = converted(path)
    assert np.allclose(table["t"], T, rtol=1e-15)
    assert np.allclose(table["x"], X, rtol=1e-15)
    assert units_of(table.schema) == {"t": "s", "x": "m", "force": "N"}
    assert said == [f"{path}: converted x from mm to m"]


def test_time_as_a_channel(tdms: Write, converted: Read) -> None:
    path = tdms({"bench": {"Time": (T * 1e3, {"unit_string": "ms"}), "x": X, "force": F}})
    assert np.allclose(converted(path)["t"], T, rtol=1e-15)
    assert np.allclose(converted(path, "t=Time[ms]")["t"], T, rtol=1e-15)
    assert np.allclose(converted(path, "t=Time[s]")["t"], T * 1e3, rtol=1e-14)


def test_time_as_timestamps(tdms: Write, converted: Read) -> None:
    stamps = np.datetime64("2026-11-21T10:00:00") + (T * 1e6).round().astype("timedelta64[us]")
    table = converted(tdms({"bench": {"Time": stamps, "x": X, "force": F}}))
    assert np.allclose(table["t"], T, rtol=0.0, atol=1e-9)
    # A group that began later is counted from the same moment.
    late = {"Time": stamps[100::2], "x": X[100::2]}
    table = converted(tdms({"force": {"Time": stamps, "force": F}, "motion": late}))
    assert np.allclose(table["t"], T[100:999], rtol=0.0, atol=1e-9)
    assert np.array_equal(table["force"], F[100:999])
    assert np.allclose(table["x"], X[100:999], rtol=0.0, atol=1e-5)


def test_int16_with_a_scaling(tdms: Write, converted: Read) -> None:
    counts = (np.arange(1000) - 500).astype(np.int16)
    path = tdms({"bench": {"x": (X, wave(1e-3)), "force": (counts, wave(1e-3, "N", **LINEAR))}})
    assert np.array_equal(converted(path)["force"], counts * 0.25 + 3.0)


def test_int16_without_a_scaling_is_refused(tdms: Write, converted: Read) -> None:
    counts = np.arange(1000, dtype=np.int16)
    path = tdms({"bench": {"x": (X, wave(1e-3)), "force": (counts, wave(1e-3))}})
    with pytest.raises(InputProblem, match=r"whole numbers \(int16\) without a unit or a scaling"):
        converted(path)


def test_several_rates_that_start_at_different_times(tdms: Write, converted: Read) -> None:
    start = np.datetime64("2026-11-21T10:00:00")
    late = start + np.timedelta64(100, "ms")
    path = tdms(
        {
            "force": {"force": (F, wave(1e-3, "N", wf_start_time=start))},
            "motion": {"x": (X[100::2], wave(2e-3, "m", wf_start_time=late))},
        }
    )
    table = converted(path)
    assert np.allclose(table["t"], T[100:999], rtol=0.0, atol=1e-12)
    assert np.array_equal(table["force"], F[100:999])
    assert np.allclose(table["x"], X[100:999], rtol=0.0, atol=1e-5)


def test_groups_of_the_same_channels_are_records(tdms: Write, converted: Read) -> None:
    groups = {f"run {i}": {"x": (X, wave(1e-3)), "force": (F * i, wave(1e-3))} for i in (1, 2)}
    table = converted(tdms(groups))
    assert table["record"].to_pylist() == ["run 1"] * 1000 + ["run 2"] * 1000


def test_units_that_differ_from_record_to_record(tdms: Write, converted: Read) -> None:
    path = tdms({u: {"x": (X, wave(1e-3, u)), "force": (F, wave(1e-3))} for u in ("mm", "m")})
    with pytest.raises(InputProblem, match="its unit differs from record to record: m in"):
        converted(path)


def test_channels_without_time_are_refused(tdms: Write, converted: Read) -> None:
    path = tdms({"bench": {"x": X, "force": F}})
    with pytest.raises(InputProblem, match=r"column 'x': it has no time; .* --map \"t=NAME\[s\]\""):
        converted(path)


def test_a_cut_file_is_said(tdms: Write, converted: Read, said: list[str]) -> None:
    path = tdms({"bench": {"x": (X, wave(1e-3)), "force": (F, wave(1e-3))}})
    path.write_bytes(path.read_bytes()[:-4000])
    table = converted(path)  # the force is the second half of the file
    assert np.array_equal(table["force"], F[:500])
    assert np.array_equal(table["x"], X[:500])
    assert "its last segment is incomplete: the recording was cut off" in said[1]
    assert said[-1].endswith("interpolated linearly: x (1000 Hz)")


def test_without_the_library(tdms: Write, converted: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tdms({"bench": {"x": (X, wave(1e-3))}})
    monkeypatch.setitem(sys.modules, "nptdms", None)
    with pytest.raises(MissingLibrary, match=r"TDMS files need .* pip install 'erdctl\[tdms\]'"):
        converted(path)


def test_an_increment_in_another_unit(tdms: Write, converted: Read) -> None:
    step = wave(1.0, wf_xunit_string="ms", wf_start_offset=5.0)
    assert np.allclose(
        converted(tdms({"bench": {"x": (X, step), "force": (F, step)}}))["t"], T + 5e-3
    )
    step = wave(1.0, wf_xunit_string="mm")
    with pytest.raises(InputProblem, match="column 'x': stored with unit 'mm', which is a length"):
        converted(tdms({"bench": {"x": (X, step)}}))


def test_an_increment_that_nobody_set(tdms: Write, converted: Read, said: list[str]) -> None:
    bench = {"Time": (T, wave(1.0, "s")), "x": (X, wave(1.0, "m")), "force": (F, wave(1.0, "N"))}
    assert np.array_equal(converted(tdms({"bench": bench}))["t"], T)
    assert any("the time of 'bench' is its channel 'Time'" in line for line in said)
