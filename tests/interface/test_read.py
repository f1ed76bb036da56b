"""Logs out of files and frames, and what is said of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from interface.calls import CAMPAIGN, FOREIGN, LAB, SCHEDULE, TABLE_2
from places import FIXTURES

import erdctl


def frame() -> pd.DataFrame:
    return pd.read_csv(SCHEDULE)


def test_a_frame_is_the_log_that_it_came_from() -> None:
    from_file, from_frame = erdctl.read(SCHEDULE), erdctl.read(frame())
    for channel in ("t", "x", "xdot", "duty", "force", "temperature"):
        a, b = (getattr(log.recording, channel) for log in (from_file, from_frame))
        np.testing.assert_array_equal(a, b)
    assert from_frame.recording.names == ("DataFrame",)
    source = from_frame.recording.sources[0]
    assert (source.rows, len(source.sha256)) == (12_000, 64)
    assert erdctl.validate(TABLE_2, frame()).nrmse == erdctl.validate(TABLE_2, SCHEDULE).nrmse


def test_several_logs_of_either_kind() -> None:
    log = erdctl.read([SCHEDULE, frame(), frame()])
    assert log.recording.names == ("schedule_60s", "DataFrame 1", "DataFrame 2")
    assert len(log.table()) == 36_000
    assert set(log.table()["record"]) == set(log.recording.names)


def test_a_frame_with_named_index_units_and_records() -> None:
    log = frame().assign(record=["a"] * 6000 + ["b"] * 6000, F=lambda f: 1e-3 * f["force"])
    log = log.drop(columns="force").set_index("t")
    read = erdctl.read(log, map=["force=F[kN]"])
    assert read.recording.names == ("a", "b")
    np.testing.assert_allclose(read.recording.force, frame()["force"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: f.assign(x=f["x"].where(f["t"] != 0.01)), r"DataFrame: row 3, column 'x'"),
        (lambda f: f.drop(columns="t"), r"DataFrame: .*no column 't'"),
        (lambda f: f.assign(x="a"), r"found 'a', expected a number"),
        (lambda f: f.iloc[:0], r"no samples"),
        (lambda f: pd.concat([f, f["x"]], axis=1), r"[Dd]uplicate"),
        (lambda f: f.assign(odd=[{}, 1] * 6000), r"not a table"),
    ],
)
def test_bad_frames_are_refused_in_one_line(change: object, message: str) -> None:
    with pytest.raises(erdctl.ErdctlError, match=message) as refused:
        erdctl.read(change(frame()))  # type: ignore[operator]  # a lambda
    assert "\n" not in str(refused.value)


def test_remarks_are_kept_and_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    log = erdctl.read(FOREIGN, map=LAB)
    assert len(log.remarks) == 1
    assert "no column xdot; derived from x" in log.remarks[0]
    damper = erdctl.identify(log)
    for shown in (log, damper, erdctl.inspect(log), erdctl.validate(damper, log)):
        assert log.remarks[0] in shown.remarks
        assert log.remarks[0] in repr(shown)
    assert any("too little null-control data" in line for line in damper.remarks)
    beyond = erdctl.simulate(damper, drive="sine:freq=1,amp=0.02,duty=0.2")
    assert any("were identified on" in line for line in beyond.remarks)
    assert capfd.readouterr() == ("", "")


def test_tables_of_samples_are_si_and_go_back_in() -> None:
    log = erdctl.read(FOREIGN, map=LAB)
    table = log.table()
    assert table.attrs["units"] == {"t": "s", "x": "m", "force": "N", "duty": "1", "xdot": "m/s"}
    assert list(table.columns) == ["t", "x", "force", "duty", "Oil [degC]", "xdot"]
    assert table["x"].abs().max() == pytest.approx(0.012)
    again = erdctl.read(table).recording
    np.testing.assert_array_equal(again.xdot, log.recording.xdot)
    np.testing.assert_array_equal(again.force, log.recording.force)


def test_write_in_another_format(tmp_path: Path) -> None:
    log = erdctl.read(FIXTURES / "bad" / "good.csv")
    log.write(tmp_path / "log.parquet")
    np.testing.assert_array_equal(
        erdctl.read(tmp_path / "log.parquet").recording.x, log.recording.x
    )


def test_paths_of_any_kind_and_maps_of_any_kind() -> None:
    reads = [
        erdctl.read(FIXTURES / "foreign.csv", map=LAB),
        erdctl.read([FOREIGN], map=[f"{k}={v}" for k, v in LAB.items()]),
    ]
    assert reads[0].recording.sources == reads[1].recording.sources
    assert len(erdctl.read(CAMPAIGN)) == 60_000
