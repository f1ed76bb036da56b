"""Several time bases on one: what is interpolated, held, refused and left empty."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.core.errors import InputProblem
from erdctl.io.containers.align import aligned
from erdctl.io.containers.channels import Channel, ChannelGroup, Samples, arrange
from erdctl.io.roles import Roles

Series = tuple[Any, Any]
Say = Callable[[str], None]


def channel(name: str, time: Any, values: Any, unit: str | None = None) -> Channel:
    samples = Samples(np.asarray(values), None if time is None else np.asarray(time, float))
    return Channel(name, unit, lambda: samples, timed=time is not None)


def table(say: Say = lambda line: None, **series: Series) -> pa.Table:
    """The table of channels, each (time, values); those of the contract are needed as such."""
    channels = tuple(channel(n, *s) for n, s in series.items())
    layout = arrange([ChannelGroup("bench", channels)], "log")
    targets = {n: n for n in series if n in ("x", "duty", "force", "temperature")}
    return aligned(layout, layout.columns, Roles({**targets, "t": "t"}, say=say), "log")


def values(column: Any) -> list[Any]:
    return [None if v is None or v != v else v for v in column.to_pylist()]


def test_by_hand() -> None:
    got = table(
        force=([0.0, 1.0, 2.0, 3.0], [5.0, 6.0, 7.0, 8.0]),
        x=([0.0, 2.0, 4.0], [0.0, 0.2, 0.0]),
        duty=([0.0, 1.5], [0.1, 0.3]),
        p=([1.0, 2.0], [10.0, 20.0]),
        gear=([1.0, 2.0], [3, 4]),
    )
    assert got["t"].to_pylist() == [0.0, 1.0]
    assert got["force"].to_pylist() == [5.0, 6.0]
    assert got["x"].to_pylist() == [0.0, 0.1]
    assert got["duty"].to_pylist() == [0.1, 0.1]
    # Columns that nobody needs do not cut the log: they are empty where they have no samples.
    assert values(got["p"]) == [None, 10.0]
    assert values(got["gear"]) == [None, 3]


def test_the_force_is_never_interpolated_and_x_leads_without_it() -> None:
    fast, slow = np.arange(9) * 0.5, np.arange(5) * 1.0
    with_force = table(force=(slow, slow), x=(fast, fast))
    assert with_force["t"].to_pylist() == slow.tolist()
    without = table(x=(fast, fast), duty=(slow, slow))
    assert without["t"].to_pylist() == fast.tolist()
    assert without["duty"].to_pylist() == np.floor(fast).tolist()


def test_one_base_is_left_as_it_is() -> None:
    said: list[str] = []
    time = [0.0, 1.0, 1.0]  # wrong, which is for the log's own checks to say
    got = table(said.append, force=(time, [1, 2, 3]), x=(list(time), [4.0, 5.0, 6.0]))
    assert got.to_pydict() == {"t": time, "force": [1, 2, 3], "x": [4.0, 5.0, 6.0]}
    assert said == []


def test_clocks_that_differ_by_rounding_lose_no_row() -> None:
    a = np.arange(100) * 0.01
    b = a + 1e-12
    b[-1] -= 2e-12
    got = table(force=(a, a), x=(b, a))
    assert len(got) == 100


def test_a_gap_in_a_needed_channel_is_refused() -> None:
    time = np.arange(100) * 0.01
    holed = np.delete(time, slice(40, 60))
    with pytest.raises(InputProblem, match=r"column 'x': no samples for 0.21 s from t = 0.39 s"):
        table(force=(time + 0.005, time), x=(holed, holed))
    # No row is in the gap: nothing would be invented.
    rows = np.delete(time + 0.001, slice(39, 60))
    got = table(force=(rows, rows), x=(holed, holed))
    assert np.allclose(got["x"], got["t"], rtol=1e-12)


def test_a_gap_in_the_rows_is_said_and_in_a_passenger_stays_empty() -> None:
    time = np.arange(100) * 0.01
    holed = np.delete(time, slice(40, 60))
    said: list[str] = []
    table(said.append, force=(holed, holed), x=(time, time))
    assert said[-1] == "force has a gap of 0.21 s after 0.39 s"
    got = values(table(force=(time, time), x=(time, time), p=(holed, holed))["p"])
    assert got[39] == time[39]
    assert got[40:60] == [None] * 20
    assert got[60] == time[60]


def test_a_duty_that_is_logged_on_change_is_held() -> None:
    time = np.arange(1000) * 0.01
    got = table(
        force=(time, time), x=(time, time), duty=([0.0, 0.02, 5.0, 9.99], [0.1, 0.2, 0.3, 0.3])
    )
    assert got["duty"].to_pylist() == [0.1] * 2 + [0.2] * 498 + [0.3] * 500


@pytest.mark.parametrize("ahead", [-1e-12, 0.0, 1e-12])
def test_the_last_digits_of_a_clock_decide_no_held_value(ahead: float) -> None:
    time, own = np.arange(2000) * 0.002, np.arange(200) * 0.02
    got = table(force=(time, time), x=(time, time), duty=(own + ahead, own))
    assert np.allclose(got["duty"].to_numpy(), 0.02 * (np.arange(1991) // 10), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("series", "words"),
    [
        ({"x": ([5.0, 6.0], [0, 0])}, "do not overlap in time: force 0 to 2 s, x 5 to 6 s"),
        ({"x": ([0.0, 2.0, 1.0], [0, 0, 0])}, "'x': its time must grow .* from 2 s to 1 s"),
        ({"x": ([0.0, np.nan, 1.0], [0, 0, 0])}, "'x': its time must grow"),
        ({"x": ([0.0, 1.0], [0, 0, 0])}, "'x': it has 3 samples, and its time has 2"),
        ({"x": ([], [])}, "'x': it has no samples"),
        ({"x": (None, [0, 0, 0])}, "'x': it has no time"),
        ({"x": ([0.0], [[1.0, 2.0]])}, "'x': neither numbers nor text, one for each sample"),
    ],
)  # fmt: skip
def test_refused(series: dict[str, Series], words: str) -> None:
    with pytest.raises(InputProblem, match=words):
        table(force=([0.0, 1.0, 2.0], [1.0, 2.0, 3.0]), **series)


def test_what_nobody_needs_is_left_out_and_said() -> None:
    said: list[str] = []
    got = table(said.append, x=([0.0, 1.0], [1.0, 2.0]), image=([0.0, 1.0], [[1.0], [2.0]]))
    assert got.column_names == ["t", "x"]
    assert said == ["'image' is left out: neither numbers nor text, one for each sample"]


def test_records_that_lack_a_channel() -> None:
    time = [0.0, 1.0]
    both = ChannelGroup("a", (channel("x", time, time), channel("p", time, time)), record=True)
    one = ChannelGroup("b", (channel("x", time, time),), record=True)
    layout = arrange([both, one], "log")
    assert layout.columns == ("t", "x", "record")
    assert layout.notes == ("not in every record, left out: p",)


def test_what_was_done_is_said_of_the_records_that_it_was_done_to() -> None:
    time = np.arange(100) * 0.01
    holed = np.delete(time, slice(40, 60))
    groups = [
        ChannelGroup(name, (channel("x", time, time), channel("force", rows, rows)))
        for name, rows in [("a", time), ("b", holed), ("c", holed), ("d", time)]
    ]
    layout, said = arrange(groups, "log"), list[str]()
    got = aligned(
        layout, layout.columns, Roles({"x": "x", "force": "force"}, say=said.append), "log"
    )
    assert got["record"].to_pylist() == ["a"] * 100 + ["b"] * 80 + ["c"] * 80 + ["d"] * 100
    assert said == [
        "record 'b': several time bases; the rows are those of force (100 Hz); interpolated"
        " linearly: x (100 Hz); similarly in 1 more record",
        "record 'b': force has a gap of 0.21 s after 0.39 s; similarly in 1 more record",
    ]


@given(
    st.lists(st.floats(1e-3, 0.1), min_size=3, max_size=60),
    st.lists(st.floats(1e-3, 0.1), min_size=3, max_size=60),
    st.floats(-0.5, 0.5),
)
@settings(max_examples=100, deadline=None)
def test_a_straight_line_stays_one(a: list[float], b: list[float], late: float) -> None:
    force, x = np.cumsum(a), np.cumsum(b) + late
    try:
        got = table(force=(force, force), x=(x, 2.0 * x + 1.0))
    except InputProblem as problem:
        assert "overlap" in str(problem) or "no samples for" in str(problem)  # noqa: PT017  # may also pass
        return
    t = got["t"].to_numpy()
    assert np.isin(t, force).all()
    assert t[0] >= x[0] - 1e-6
    assert t[-1] <= x[-1] + 1e-6
    assert np.allclose(got["x"], 2.0 * t + 1.0, rtol=0.0, atol=1e-6)
