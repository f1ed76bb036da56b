"""Runs that were appended, dampers side by side, several logs: never taken as one in silence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.io.joins import FEWEST, restarts
from erdctl.io.logs import Log

Columns = dict[str, Any]
Write = Callable[..., str]
Read = Callable[..., Log]
NAMES = ["log.csv", "log.parquet"]


def joined(columns: Columns) -> Columns:
    return {name: column for name, column in columns.items() if name != "record"}


@pytest.mark.parametrize("name", NAMES)
def test_runs_are_told_apart_by_their_times(
    columns: Columns, write: Write, read: Read, said: list[str], name: str
) -> None:
    path = write(joined(columns), name)
    recording = read(path).recording
    assert recording.starts.tolist() == [0, 100, 200]
    assert recording.names == ("log:1", "log:2")
    row = 102 if name == "log.csv" else 101
    assert f"{path}: time begins anew in row {row}; taken as 2 records, log:1 to log:2" in said[-1]


@pytest.mark.parametrize("seed", range(40))
def test_any_runs_are_found(seed: int) -> None:
    """Lengths, rates, offsets and jitter at random; each begins at its own first time or 0."""
    rng = np.random.default_rng(seed)
    step = 10.0 ** rng.uniform(-4, -1)
    lengths = rng.integers(FEWEST, 400, rng.integers(2, 7))
    offset = rng.choice([0.0, 3.0, 1000.0])
    runs = [
        offset + np.cumsum(step * rng.uniform(0.5, 1.5, n)) - step * rng.uniform(0, 1)
        for n in lengths
    ]
    found = restarts(np.concatenate(runs))
    assert found is not None
    assert found.tolist() == [0, *np.cumsum(lengths).tolist()]


@pytest.mark.parametrize("seed", range(40))
def test_a_row_out_of_order_is_no_run(seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.arange(200) * 1e-3
    a = int(rng.integers(0, 195))
    b = a + int(rng.integers(1, 5))
    t[[a, b]] = t[[b, a]]
    assert restarts(t) is None


def test_a_row_out_of_order_stays_an_error(columns: Columns, write: Write, read: Read) -> None:
    t = np.arange(200) * 1e-3
    t[[50, 51]] = t[[51, 50]]
    with pytest.raises(InputProblem, match="row 53, column 't': time must grow"):
        read(write(joined(columns) | {"t": t}))


def test_a_jump_of_x_is_said(columns: Columns, write: Write, read: Read, said: list[str]) -> None:
    t = np.arange(200) * 1e-3
    x = 0.01 * np.sin(40.0 * t)
    x[120:] += 0.05
    path = write({"t": t, "x": x, "force": columns["force"]})
    assert len(read(path).recording.names) == 1
    assert any("row 122: x jumps by 5" in line and "two runs were joined" in line for line in said)


def test_spikes_steps_and_coarse_motion_are_no_joins(
    columns: Columns, write: Write, read: Read, said: list[str]
) -> None:
    t = np.arange(200) * 1e-3
    for x in (
        np.where(np.arange(200) == 100, 0.05, 0.0) + 0.01 * np.sin(40.0 * t),
        np.round(0.01 * np.sin(4.0 * t), 3),
        np.sign(np.sin(60.0 * t)) * 0.01,
    ):
        read(write({"t": t, "x": x, "force": columns["force"]}))
    assert not any("jumps" in line for line in said)


def test_several_logs_are_said(columns: Columns, write: Write, read: Read, said: list[str]) -> None:
    one, two = write(columns, "one.csv"), write(joined(columns), "two.csv")
    recording = read(one, two).recording
    assert recording.names == ("one:a", "one:b", "two:1", "two:2")
    assert f"2 logs are taken together as one damper: {one}, {two}" in said


# --- several dampers in one log


@pytest.fixture
def two_dampers(columns: Columns) -> Columns:
    return joined(columns) | {"damper": ["FL"] * 100 + ["FR"] * 100}


@pytest.mark.parametrize("name", NAMES)
def test_several_dampers_are_refused_until_one_is_chosen(
    two_dampers: Columns, write: Write, read: Read, name: str
) -> None:
    path = write(two_dampers, name)
    with pytest.raises(InputProblem, match=r'choose: --where "damper=FL" or --where "damper=FR"'):
        read(path)
    recording = read(path, where=["damper=FR"]).recording
    assert np.array_equal(recording.force, two_dampers["force"][100:])
    assert recording.names == ("log",)
    assert len(read(path, where=["damper=*"]).recording) == 200


def test_rows_of_a_chosen_damper_keep_their_places(
    two_dampers: Columns, write: Write, read: Read
) -> None:
    two_dampers["damper"] = ["FL", "FR"] * 100
    two_dampers["t"] = np.repeat(np.arange(100) * 1e-3, 2)
    two_dampers["duty"] = np.where(np.arange(200) == 121, 7.0, 0.1)
    path = write(two_dampers)
    with pytest.raises(InputProblem, match="row 123, column 'duty'"):
        read(path, where=["damper=FR"])
    assert len(read(path, where=["damper=FL"]).recording) == 100


def test_wrong_choices(two_dampers: Columns, write: Write, read: Read) -> None:
    path = write(two_dampers)
    with pytest.raises(InputProblem, match="there is no such value; there are FL, FR"):
        read(path, where=["damper=RL"])
    with pytest.raises(InputProblem, match="no column 'part'; it has t, x"):
        read(path, where=["part=FL"])
    with pytest.raises(UsageProblem, match="write COLUMN=VALUE"):
        read(path, where=["damper"])


def test_columns_of_several_dampers_are_listed(columns: Columns, write: Write, read: Read) -> None:
    columns["force_fl [N]"] = columns.pop("force")
    columns["force_fr [N]"] = columns["force_fl [N]"]
    with pytest.raises(InputProblem) as caught:
        read(write(columns))
    assert "'force' may be 'force_fl [N]', 'force_fr [N]'" in str(caught.value)
    assert "as of several dampers" in str(caught.value)
    assert '--map "force=force_fl [N]"' in str(caught.value)
