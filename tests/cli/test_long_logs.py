"""Logs that are read in stretches give what they give as a whole, bit for bit."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli import convert, identify, simulate, validate
from erdctl.cli.app import build
from erdctl.core.errors import ComputationProblem, ErdctlError, InputProblem

EXAMPLES = int(os.environ.get("ERDCTL_LONG_EXAMPLES", "4"))  # of a second or more each
PARAMS = FIXTURES / "table_2.json"
# What runs where: with no state but F_ER; with more; a law of speed alone.
EFFECTS = {
    "": {},
    "coulomb_friction": {"F_c": 3.0},
    "backlash": {"g": 4e-4},
    "signed_yield_lag": {},
    "time_skew": {"tau": 3e-3},
}


@contextmanager
def small(*, long: int, run: int, batch: int, streamed: bool) -> Iterator[None]:
    """Stretches, runs and batches of a few samples; read in stretches or not."""
    sizes = {
        "erdctl.core.stretches.LONG": long, "erdctl.io.long_logs.LONG": long,
        "erdctl.io.convert.LONG": long, "erdctl.io.long_logs.MORE": 16,
        "erdctl.model.simulate.LONGEST": run, "erdctl.io.parquet_in.BATCH": batch,
        "erdctl.io.batches.SMALL": 0, "erdctl.io.batches.STREAMED": 1 if streamed else 1 << 60,
    }  # fmt: skip
    with ExitStack() as stack:
        for name, value in sizes.items():
            stack.enter_context(mock.patch(name, value))
        yield


def log(lengths: list[int], seed: int, *, even: bool = True, xdot: bool = True) -> pa.Table:
    """Records of these lengths with rests, duty steps and noise."""
    rng = np.random.default_rng(seed)
    parts = []
    for n in lengths:
        step = np.full(n, 2e-3) if even else rng.uniform(1e-3, 3e-3, n)
        t = np.cumsum(step) + rng.uniform(0.0, 2.0)
        w = rng.uniform(3.0, 30.0)
        x, v = 0.01 * np.sin(w * t), 0.01 * w * np.cos(w * t)
        for a in rng.integers(0, n, 3).tolist():
            v[a : a + int(rng.integers(1, 40))] = 0.0
        duty = np.array([0.0, 0.1, 0.3])[(t / rng.uniform(0.02, 0.4)).astype(int) % 3]
        force = 220 * x + 66 * v + 14 * duty**0.3 * np.sign(v) + rng.normal(0.0, 0.3, n)
        parts.append({"t": t, "x": x, "xdot": v, "duty": duty, "force": force, "mark": t > 1.0})
    whole = {name: np.concatenate([p[name] for p in parts]) for name in parts[0]}
    if not xdot:
        del whole["xdot"]
    return pa.table({**whole, "record": np.repeat([f"r{k}" for k in range(len(lengths))], lengths)})


def params(folder: Path, effect: str) -> str:
    document = json.loads(PARAMS.read_text())
    if effect:
        from erdctl.effects import get

        values = {q.symbol: EFFECTS[effect].get(q.symbol, q.start) for q in get(effect).quantities}
        units = {q.symbol: q.unit for q in get(effect).quantities}
        document["effects"] = [
            {
                "effect": effect,
                "parameters": {s: {"value": v, "unit": units[s]} for s, v in values.items()},
            }
        ]
    path = folder / "params.json"
    path.write_text(json.dumps(document))
    return str(path)


LOGS = st.fixed_dictionaries({
    "lengths": st.lists(st.integers(2, 600), min_size=1, max_size=5),
    "seed": st.integers(0, 1000), "even": st.booleans(), "xdot": st.booleans(),
})  # fmt: skip
SIZES = st.fixed_dictionaries({
    "long": st.integers(40, 400), "run": st.integers(10, 80), "batch": st.integers(7, 300),
})  # fmt: skip


@settings(
    max_examples=EXAMPLES,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(made=LOGS, sizes=SIZES, effect=st.sampled_from(sorted(EFFECTS)), groups=st.integers(5, 900))
@example(  # a record that is scored in parts, of a model that takes it whole
    made={"lengths": [70], "seed": 2, "even": False, "xdot": True},
    sizes={"long": 40, "run": 10, "batch": 7},
    effect="backlash",
    groups=5,
)
def test_simulate_and_validate_are_those_of_the_whole(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], made: dict, sizes: dict, effect: str,
    groups: int,
) -> None:  # fmt: skip
    path = tmp_path / "log.parquet"
    pq.write_table(log(**made), path, row_group_size=groups)
    found = []
    for streamed in (False, True):
        out = tmp_path / f"{streamed}.parquet"
        with small(**sizes, streamed=streamed):
            simulate.command(
                params(tmp_path, effect), str(path), str(out), fault=["oil=0.5,ramp=1"]
            )
            capsys.readouterr()
            validate.command([params(tmp_path, effect), str(path)], as_json=True)
        found.append((pq.read_table(out), capsys.readouterr().out))
    (whole, scores), (streamed_table, streamed_scores) = found
    assert whole.schema == streamed_table.schema
    assert whole.equals(streamed_table)
    assert scores == streamed_scores


LAB = """[labels]
path = '(?P<damper>D[0-9]+)_(?P<date>[0-9]+)'
date = '%Y%m%d'
[damper.D07.columns]
x = 'Weg (mm)[mm]'
force = 'Kraft[N]'
duty = 'duty'
t = 't'
"""


def test_a_project_file_holds_in_stretches_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Columns and units, rows, and what the log is of; `identify` from a sample of it."""
    made = log([400, 500, 700], 3)
    own = {name: made[name] for name in made.column_names if name not in ("x", "force")}
    own |= {"Weg (mm)": pa.array(1e3 * made["x"].to_numpy()), "Kraft": made["force"]}
    (tmp_path / "erdctl.toml").write_text(LAB)
    path = str(tmp_path / "D07_20240501.parquet")
    pq.write_table(pa.table(own), path, row_group_size=300)
    monkeypatch.chdir(tmp_path)
    found = []
    for streamed in (False, True):
        with small(long=300, run=100, batch=128, streamed=streamed):
            if streamed:
                monkeypatch.setattr("erdctl.io.drawn.MOST", 1000)
                monkeypatch.setattr("erdctl.io.drawn.WINDOW", 200)
            run("simulate", str(PARAMS), path, "-o", f"{streamed}.parquet")
            scores, inspected = (
                run("validate", str(PARAMS), path, "--json"),
                run("inspect", path, "--json"),
            )
            damper = json.loads(run("identify", path))
        table = pq.read_table(f"{streamed}.parquet")
        provenance = json.loads(inspected)["provenance"]
        assert provenance["damper"] == damper["provenance"]["damper"] == "D07"
        assert damper["provenance"]["project"] == provenance["project"]
        assert ("sample" in damper["provenance"]) is streamed
        found.append((table, scores, inspected))
    a, b = found
    assert a[0].equals(b[0])
    assert a[1:] == b[1:]
    assert "SHA-256" in provenance["project"]


def run(*words: str) -> str:
    done = CliRunner().invoke(build([words[0]]), [*words], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return done.stdout


def test_a_cut_changes_the_force_by_rounding_alone(tmp_path: Path) -> None:
    path = tmp_path / "log.parquet"
    pq.write_table(log([5000], 3), path)
    forces = []
    for long in (100, 1 << 20):
        out = tmp_path / f"{long}.parquet"
        with small(long=long, run=50, batch=1000, streamed=False):
            simulate.command(str(PARAMS), str(path), str(out), fault=["oil=0.5,ramp=1"])
        forces.append(pq.read_table(out)["force_model"].to_numpy())
    np.testing.assert_allclose(forces[0], forces[1], rtol=0, atol=1e-11)


@pytest.mark.parametrize("suffix", ["parquet", "arrow", "feather", "csv"])
@pytest.mark.parametrize("source", ["parquet", "arrow", "feather"])
def test_convert_is_that_of_the_whole(tmp_path: Path, source: str, suffix: str) -> None:
    table = log([300, 20, 700], 5)
    kinds = table["record"].combine_chunks().dictionary_encode()
    table = table.append_column("kind", kinds).append_column("p [bar]", table["x"])
    path = tmp_path / f"log.{source}"
    if source == "parquet":
        pq.write_table(table, path, row_group_size=111)
    else:
        new = pa.ipc.new_stream if source == "arrow" else pa.ipc.new_file
        with new(path, table.schema) as writer:
            writer.write_table(table, max_chunksize=77)
    found = []
    for streamed in (False, True):
        out = tmp_path / f"{streamed}.{suffix}"
        with small(long=150, run=50, batch=64, streamed=streamed):
            convert.command(str(path), str(out), maps=["x=x[mm]"])
        found.append(out)
    if suffix == "csv":
        assert found[0].read_bytes() == found[1].read_bytes()
        return
    read = {"parquet": pq.read_table, "arrow": _stream, "feather": _file}[suffix]
    whole, parts = (read(path) for path in found)
    assert whole.column_names == parts.column_names
    for name in whole.column_names:
        assert whole[name].to_pylist() == parts[name].to_pylist()
        assert whole.schema.field(name).metadata == parts.schema.field(name).metadata


def _stream(path: Path) -> pa.Table:
    return pa.ipc.open_stream(path).read_all()


def _file(path: Path) -> pa.Table:
    return pa.ipc.open_file(path).read_all()


def _nan(t: np.ndarray, x: np.ndarray, record: np.ndarray) -> None:
    x[777] = np.nan


def _falls(t: np.ndarray, x: np.ndarray, record: np.ndarray) -> None:
    t[801] = t[799]


def _again(t: np.ndarray, x: np.ndarray, record: np.ndarray) -> None:
    record[900:] = "r0"


def _reversed(t: np.ndarray, x: np.ndarray, record: np.ndarray) -> None:
    x *= -1.0


@pytest.mark.parametrize("spoil", [_nan, _falls, _again, _reversed])
def test_what_is_wrong_is_said_with_its_place(
    tmp_path: Path, spoil: Callable[[np.ndarray, np.ndarray, np.ndarray], None]
) -> None:
    table = log([400, 700], 6)
    columns = {n: table[n].to_numpy(zero_copy_only=False).copy() for n in table.column_names}
    spoil(columns["t"], columns["x"], columns["record"])
    path, out = tmp_path / "log.parquet", tmp_path / "out.parquet"
    pq.write_table(pa.table(columns), path)
    said = []
    for streamed in (False, True):
        with (
            small(long=150, run=50, batch=64, streamed=streamed),
            pytest.raises(InputProblem) as caught,
        ):
            simulate.command(str(PARAMS), str(path), str(out))
        said.append(str(caught.value))
        assert not out.exists()
    assert said[0] == said[1]
    assert str(path) in said[0]


def test_a_divergence_is_told_where_it_began(tmp_path: Path) -> None:
    path, out = tmp_path / "log.parquet", tmp_path / "out.parquet"
    pq.write_table(log([400, 700], 6), path)
    said = []
    for streamed in (False, True):
        with (
            small(long=150, run=50, batch=64, streamed=streamed),
            mock.patch("erdctl.model.divergence.ABSURD", 1e-3),
            mock.patch("erdctl.model.divergence.CALM", 1e-3),
            pytest.raises(ComputationProblem) as caught,
        ):
            simulate.command(str(PARAMS), str(path), str(out))
        said.append(str(caught.value))
        assert not out.exists()
    assert said[0] == said[1]


@pytest.mark.parametrize(
    ("where", "message"),
    [([], "holds 2 dampers"), (["damper=XX"], "there is no such value"), (["damper=*"], "")],
)
def test_several_dampers_are_never_taken_together(
    tmp_path: Path, where: list[str], message: str
) -> None:
    table = log([400, 700], 6)
    path, out = tmp_path / "log.parquet", tmp_path / "out.parquet"
    pq.write_table(table.append_column("damper", pa.array(["a"] * 400 + ["b"] * 700)), path)
    with small(long=150, run=50, batch=64, streamed=True):
        if not message:
            simulate.command(str(PARAMS), str(path), str(out), where=where)
            assert pq.read_table(out).num_rows == 1100
            return
        with pytest.raises(ErdctlError, match=message):
            simulate.command(str(PARAMS), str(path), str(out), where=where)


def test_one_damper_of_several(tmp_path: Path) -> None:
    table = log([400, 700], 6)
    path, out = tmp_path / "log.parquet", tmp_path / "out.parquet"
    pq.write_table(table.append_column("damper", pa.array(["a"] * 400 + ["b"] * 700)), path)
    with small(long=150, run=50, batch=64, streamed=True):
        simulate.command(str(PARAMS), str(path), str(out), where=["damper=a"])
    assert pq.read_table(out).num_rows == 400


def test_runs_whose_time_begins_anew(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = log([400, 700], 6).drop_columns(["record"])
    t = np.concatenate([np.arange(400), np.arange(700)]) * 2e-3
    table = table.set_column(0, "t", pa.array(t))
    path = tmp_path / "log.parquet"
    pq.write_table(table, path)
    said = []
    for streamed in (False, True):
        with small(long=150, run=50, batch=64, streamed=streamed):
            validate.command([str(PARAMS), str(path)], as_json=True)
        said.append(capsys.readouterr())
    assert "taken as 2 records" in said[1].err
    assert said[0].out == said[1].out


def test_identify_draws_a_sample_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """And leaves a record out that has the force the wrong way round, as it does of a whole log."""
    path, out = tmp_path / "log.parquet", tmp_path / "out.json"
    found = []
    table = log([6000] * 12 + [20_000], 8)
    spoiled = table["force"].to_numpy().copy()
    spoiled[6000 * 3 : 6000 * 4] *= -1.0
    pq.write_table(table.set_column(4, "force", pa.array(spoiled)), path)
    for _ in range(2):
        with (
            small(long=7000, run=5000, batch=1000, streamed=True),
            mock.patch("erdctl.io.drawn.MOST", 40_000),
            mock.patch("erdctl.io.drawn.WINDOW", 5000),
        ):
            identify.command([str(path)], str(out))
        found.append(out.read_bytes())
    assert found[0] == found[1]
    document = json.loads(found[0])
    sample = document["provenance"]["sample"]
    assert sample["of_samples"] == 92_000
    assert sample["of_parts"] == 16
    assert 0.7 * 40_000 < sample["samples"] < 1.2 * 40_000
    assert sample["samples"] - document["provenance"]["samples"] in (0, 6000)
    wrong = [f["record"] for f in document["provenance"]["rig"] if f["code"] == "force_sign"]
    assert wrong == ["r3"]
    assert document["provenance"]["logs"][0]["rows"] == 92_000
    assert len(document["provenance"]["logs"][0]["sha256"]) == 64
    assert "fitted to a sample" in capsys.readouterr().err
    # The log is that of a damper with c_vis = 66 N s/m either way.
    c_vis = document["compression"]["c_vis"]
    assert abs(c_vis["value"] - 66.0) < 5.0 * c_vis["stderr"] + 0.5
