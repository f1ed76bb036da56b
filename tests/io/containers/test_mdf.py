"""MDF files as asammdf writes them."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from shapes import F, T, X

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.extras import MissingLibrary
from erdctl.io.stored import units_of
from erdctl.io.tables import write_table

Write = Callable[..., Path]
Read = Callable[..., pa.Table]


@pytest.mark.parametrize("version", ["4.10", "3.30"])
def test_channels_with_units(mdf: Write, converted: Read, said: list[str], version: str) -> None:
    channels = {
        "x": {"samples": X * 1e3, "unit": "mm"},
        "force": {"samples": F * 1e-3, "unit": "kN"},
        "p": {"samples": F, "unit": "bar"},
    }
    path = mdf([("bench", T, channels)], version)
    table = converted(path)
    assert np.array_equal(table["t"], T)
    assert np.allclose(table["x"], X, rtol=1e-15)
    assert np.allclose(table["force"], F, rtol=1e-15)
    assert units_of(table.schema) == {"t": "s", "x": "m", "force": "N", "p": "bar"}
    assert said == [f"{path}: converted x from mm to m, force from kN to N"]


def test_int16_with_a_scaling(mdf: Write, converted: Read) -> None:
    counts = (np.arange(1000) - 500).astype(np.int16)
    force = {"samples": counts, "unit": "N", "conversion": {"a": 0.25, "b": 3.0}}
    table = converted(mdf([("bench", T, {"x": {"samples": X, "unit": "m"}, "force": force})]))
    assert np.array_equal(table["force"], counts * 0.25 + 3.0)


def test_int16_without_a_scaling_is_refused(mdf: Write, converted: Read) -> None:
    path = mdf([("bench", T, {"x": X, "force": np.arange(1000, dtype=np.int16)})])
    with pytest.raises(InputProblem, match=r"whole numbers \(int16\) without a unit or a scaling"):
        converted(path)


def test_missing_units_are_said(mdf: Write, converted: Read, said: list[str]) -> None:
    path = mdf([("bench", T, {"x": X, "force": F})])
    converted(path)
    assert said == [
        f"{path}: no unit is stored with some channels; taken x as m, force as N; --map says"
        " otherwise"
    ]


def test_groups_of_several_rates(mdf: Write, converted: Read, said: list[str]) -> None:
    steps = {"samples": np.array([10.0, 30.0]), "unit": "%"}
    path = mdf(
        [
            ("fast", T, {"F_fl": {"samples": F, "unit": "N"}}),
            ("slow", T[::4], {"Defl": {"samples": X[::4] * 1e3, "unit": "mm"}}),
            ("on change", np.array([0.0, 0.5]), {"PWM": steps}),
        ]
    )
    maps = ["force=F_fl", "x=Defl", "duty=PWM"]
    table = converted(path, *maps)
    assert table["t"].to_pylist() == T[:501].tolist()
    assert np.allclose(table["x"], X[:501], rtol=0.0, atol=4e-5)
    assert table["duty"].to_pylist() == [0.1] * 500 + [0.3]
    assert "interpolated linearly: Defl (250 Hz); held from the sample before: PWM" in said[-1]


def test_groups_of_the_same_channels_are_records(mdf: Write, converted: Read) -> None:
    groups = [(f"run {i}", T, {"x": X, "force": F * i}) for i in (1, 2)]
    table = converted(mdf(groups))
    assert table["record"].to_pylist() == ["run 1"] * 1000 + ["run 2"] * 1000
    assert np.array_equal(table["force"], np.concatenate([F, 2.0 * F]))


def test_a_name_in_two_groups(mdf: Write, converted: Read) -> None:
    groups = [("fl", T, {"x": X, "force": F}), ("fr", T, {"x": -X, "other": F})]
    path = mdf(groups)
    assert converted(path).column_names == ["t", "fl/x", "force", "fr/x", "other"]
    assert np.array_equal(converted(path, "x=fr/x")["x"], -X)


def test_text_and_logicals(mdf: Write, tmp_path: Path, converted: Read) -> None:
    table = pa.table({"t": [0.0, 1.0], "who": ["ä", ""], "on": [True, False]})
    path = tmp_path / "log.mf4"
    write_table(table, str(path))
    assert converted(path).to_pydict() == {"t": [0.0, 1.0], "who": ["ä", ""], "on": [1, 0]}


def test_no_time_no_mdf(tmp_path: Path) -> None:
    with pytest.raises(UsageProblem, match="MDF4 needs a time"):
        write_table(pa.table({"x": [1.0]}), str(tmp_path / "log.mf4"))
    assert list(tmp_path.iterdir()) == []


def test_without_the_library(mdf: Write, converted: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    path = mdf([("bench", T, {"x": X})])
    monkeypatch.setitem(sys.modules, "asammdf", None)
    with pytest.raises(MissingLibrary, match=r"MDF files need .* pip install 'erdctl\[mdf\]'"):
        converted(path)


def test_a_damaged_file_is_one_line(mdf: Write) -> None:
    path = mdf([("bench", T, {"x": X, "force": F})])
    data = path.read_bytes()
    for spoilt in (data[:16], data[:200], data[:-500], data[:64] + b"\xff" * 64 + data[128:]):
        path.write_bytes(spoilt)
        run = subprocess.run(
            [sys.executable, "-m", "erdctl", "identify", str(path)], capture_output=True, text=True
        )
        errors = [line for line in run.stderr.splitlines() if "erdctl: note" not in line]
        assert run.returncode == 3, run.stderr
        assert len(errors) == 1, run.stderr
        assert errors[0].startswith(f"erdctl: error: {path}")


def test_a_plain_identify(mdf: Write, read: Any) -> None:
    recording = read(str(mdf([("bench", T, {"x": X, "force": F})])), want_hash=True).recording
    assert np.array_equal(recording.x, X)
    assert len(recording.sources[0].sha256) == 64


def test_samples_marked_as_invalid_are_left_out(
    mdf: Write, converted: Read, said: list[str]
) -> None:
    invalid = np.zeros(len(T), bool)
    invalid[50:53] = True
    spoilt = {"samples": np.where(invalid, 9999.0, F), "unit": "N", "invalidation_bits": invalid}
    path = mdf([("bench", T, {"force": spoilt, "x": {"samples": X, "unit": "m"}})])
    table = converted(path)
    assert np.array_equal(table["t"], T[~invalid])
    assert np.array_equal(table["force"], F[~invalid])
    assert np.array_equal(table["x"], X[~invalid])
    assert f"{path}: 'force': 3 of 1000 samples, marked as invalid, left out" in said
