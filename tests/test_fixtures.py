"""The fixtures: independent of erdctl, reproducible, small, described; and the oracle itself."""

from __future__ import annotations

import ast
import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd
import pytest

from erdctl.geometry import Geometry, derive

FIXTURES = Path(__file__).parents[1] / "fixtures"
BAD = FIXTURES / "bad"
LOGS = (
    "healthy_campaign.parquet",
    "healthy_noisy_motion.csv",
    "schedule_60s.csv",
    "schedule_60s.parquet",
    "schedule_hot.csv",
    "foreign.csv",
    "late_amplifier.parquet",
    "worn_joint.parquet",
)
# In each column's own unit; 1e-6 where not listed.
LAST_DIGIT = {"force": 1e-3, "F_fl": 1e-3, "temperature": 1e-2, "Defl FL": 1e-4}


def load_oracle() -> ModuleType:
    spec = importlib.util.spec_from_file_location("fixtures_oracle", FIXTURES / "oracle.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def read(path: Path) -> pd.DataFrame:
    return pd.read_parquet(path) if path.suffix == ".parquet" else pd.read_csv(path)


@pytest.fixture(scope="module")
def oracle() -> Any:
    return load_oracle()


@pytest.fixture(scope="module")
def remade(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fixtures")
    command = [sys.executable, str(FIXTURES / "make.py"), str(folder)]
    subprocess.run(command, check=True, cwd=folder)
    return folder


@pytest.mark.parametrize("path", sorted(FIXTURES.glob("*.py")), ids=lambda p: p.name)
def test_nothing_here_uses_erdctl(path: Path) -> None:
    names = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names.append(node.module or "")
        elif isinstance(node, ast.Name):
            names.append(node.id)
    assert not [n for n in names if n.split(".")[0] in ("erdctl", "importlib", "__import__")]


def test_a_step_of_duty_is_an_exponential(oracle: Any) -> None:
    """Steady compression, duty 0 until t = 0.1 s: F_ER = sigma v^beta (1 - exp(-(t - 0.1) / T))."""
    t = np.arange(600) / 1000
    x, xdot = 0.05 * t, np.full_like(t, 0.05)
    duty = np.where(np.arange(600) < 100, 0.0, 0.2)
    found = oracle.respond(t, x, xdot, duty)
    steady = 12.8157 * 0.2**0.2373
    expected = steady * -np.expm1(-np.maximum(t - 0.1, 0) / 0.043)
    assert np.abs(found.F_ER - expected).max() < 1e-9
    assert np.abs(found.force - (263.1168 * x + 64.6433 * 0.05 + expected)).max() < 1e-9


def test_a_reversal_between_samples_is_an_exponential_from_there(oracle: Any) -> None:
    """xdot falls through 0 at t = 0.3004 s; F_ER then moves to the steady value of release."""
    t = np.arange(600) / 1000
    xdot = 0.3 * (0.3004 - t)
    found = oracle.respond(t, 0 * t, xdot, np.full_like(t, 0.3))
    up, down = 12.8157 * 0.3**0.2373, 17.0442 * 0.3**0.3948
    expected = down + (up - down) * np.exp(-np.maximum(t - 0.3004, 0) / 0.043)
    assert np.abs(found.F_ER - expected).max() < 1e-9
    assert found.yield_[300] == pytest.approx(up)
    assert found.yield_[301] == pytest.approx(-expected[301])
    assert found.viscous[599] == pytest.approx(68.8289 * xdot[599])


def test_every_direction_has_its_own_time_constant(oracle: Any) -> None:
    fast = oracle.Branch(k_nom=0, c_vis=0, T_d=0.02, sigma=10, beta=1)
    slow = oracle.Branch(k_nom=0, c_vis=0, T_d=0.08, sigma=20, beta=1)
    t = np.arange(200) / 1000
    xdot = np.where(np.arange(200) < 100, 1.0, -1.0)
    found = oracle.respond(t, 0 * t, xdot, np.full_like(t, 0.5), oracle.Damper(fast, slow))
    turn = 0.0995  # the straight line from +1 at 99 ms to -1 at 100 ms
    expected = 10 - 5 * np.exp(-np.maximum(t - turn, 0) / 0.08)
    assert np.abs(found.F_ER - expected).max() < 1e-9


def test_standing_still_keeps_the_last_direction(oracle: Any) -> None:
    t = np.arange(6) / 100
    xdot = np.array([0.0, 0.0, -0.1, 0.0, 0.0, 0.1])
    found = oracle.respond(t, np.full(6, 0.01), xdot, np.full(6, 0.3))
    k = np.array([170.4045] * 5 + [263.1168])
    assert found.gas == pytest.approx(0.01 * k)
    assert found.yield_[[0, 1, 3, 4]].tolist() == [0, 0, 0, 0]
    assert found.F_ER[:5] == pytest.approx(17.0442 * 0.3**0.3948)
    still = oracle.respond(t, np.full(6, 0.01), np.zeros(6), np.full(6, 0.3))
    assert still.force == pytest.approx(2.631168)


@pytest.mark.parametrize("name", LOGS)
def test_make_writes_these_logs_again(name: str, remade: Path) -> None:
    """Equal to one unit of the last digit: a sine may differ there from machine to machine."""
    kept, made = read(FIXTURES / name), read(remade / name)
    assert list(kept.columns) == list(made.columns)
    assert len(kept) == len(made)
    for column in kept.columns:
        if pd.api.types.is_numeric_dtype(kept[column]):
            digit = LAST_DIGIT.get(column, 1e-6)
            assert np.allclose(kept[column], made[column], rtol=0, atol=1.01 * digit), column
        else:
            assert kept[column].equals(made[column])


def test_make_writes_the_same_documents_and_bad_inputs(remade: Path) -> None:
    names = {p.relative_to(remade) for p in remade.rglob("*") if p.is_file()}
    for name in sorted(names - {Path(log) for log in LOGS}):
        # The bytes of these two depend on the version of pyarrow.
        if name.suffix not in (".parquet", ".arrow") or name.name == "csv_inside.parquet":
            assert (FIXTURES / name).read_bytes() == (remade / name).read_bytes(), name
    kept = {p.relative_to(FIXTURES) for p in FIXTURES.rglob("*.*") if p.is_file()}
    assert {n for n in kept if n.suffix not in (".py", ".pyc", ".md", ".png")} == names


def test_files_are_small_and_described() -> None:
    text = (FIXTURES / "README.md").read_text(encoding="utf-8")
    files = [p for p in FIXTURES.rglob("*") if p.is_file() and p.suffix != ".pyc"]
    assert max(p.stat().st_size for p in files) < 2**20
    assert sum(p.stat().st_size for p in files) < 4 * 2**20
    for path in FIXTURES.iterdir():
        if path.suffix in (".csv", ".parquet", ".json") or path == BAD:
            assert f"\n## `{path.name}`\n" in text


def test_the_campaign_is_what_the_readme_says() -> None:
    log = read(FIXTURES / "healthy_campaign.parquet")
    assert len(log) == 60_000
    assert log["record"].nunique() == 24
    assert log["x"].abs().max() <= 0.0201
    assert log["xdot"].abs().max() <= 0.15
    assert set(log["duty"].unique()) >= {0.0, 0.10, 0.15, 0.20, 0.25, 0.30}
    for _, record in log.groupby("record", sort=False):
        assert record["t"].iloc[0] == 0.0
        assert np.all(np.diff(record["t"]) > 0)


@pytest.mark.parametrize("name", ["healthy_campaign.parquet", "schedule_60s.csv"])
def test_the_noise_is_what_the_readme_says(name: str, oracle: Any) -> None:
    log = read(FIXTURES / name)
    rest = []
    for _, record in log.groupby(log.get("record", pd.Series("", index=log.index)), sort=False):
        signals = [record[c].to_numpy() for c in ("t", "x", "xdot", "duty")]
        rest.append(record["force"].to_numpy() - oracle.respond(*signals).force)
    residual = np.concatenate(rest)
    assert np.std(residual) == pytest.approx(0.3, rel=0.02)
    assert abs(np.mean(residual)) < 0.01


def test_the_hidden_dead_time_is_what_the_readme_says(oracle: Any) -> None:
    log = read(FIXTURES / "late_amplifier.parquet")
    plain, late = [], []
    for _, record in log.groupby("record", sort=False):
        t, x, xdot, duty = (record[c].to_numpy() for c in ("t", "x", "xdot", "duty"))
        for shift, rest in ((0, plain), (4, late)):
            acting = np.concatenate([np.full(shift, duty[0]), duty[: len(duty) - shift]])
            rest.append(record["force"].to_numpy() - oracle.respond(t, x, xdot, acting).force)
    assert np.std(np.concatenate(late)) == pytest.approx(0.3, rel=0.04)
    assert np.std(np.concatenate(plain)) > 0.6


def test_temperatures() -> None:
    assert read(FIXTURES / "schedule_60s.csv")["temperature"].between(24, 31).all()
    hot = read(FIXTURES / "schedule_hot.csv")
    assert hot["temperature"].iloc[0] < 60 < hot["temperature"].iloc[-1]
    passed = hot["t"][hot["temperature"] > 60].iloc[0]
    assert passed == pytest.approx(30, abs=3)


def test_the_geometry_leads_to_table_2() -> None:
    """By construction, within the rounding of the three back-computed values."""
    scale = {
        "cm^2": 1e-4, "mm": 1e-3, "bar": 1e5, "cm^3": 1e-6, "1": 1.0, "mPa*s": 1e-3, "kV": 1e3,
    }  # fmt: skip
    document = json.loads((FIXTURES / "geometry_inove.json").read_text(encoding="utf-8"))
    assert document.pop("schema") == "erdctl.geometry/1"
    values = {
        name: given["value"] * scale[given["unit"]] if isinstance(given, dict) else given
        for name, given in document.items()
    }
    found = derive(Geometry(**values))
    assert found.k_nom == pytest.approx(263.1168, rel=0.003)
    assert found.c_vis == pytest.approx(64.6433, rel=0.003)
    assert found.sigma == pytest.approx(12.8157, rel=0.003)
    assert found.beta == 0.2373


def test_the_index_of_bad_inputs_is_complete() -> None:
    index = json.loads((BAD / "index.json").read_text(encoding="utf-8"))
    listed = {case["file"] for case in index["cases"]}
    assert len(listed) == len(index["cases"])
    assert listed | {index["good"], "index.json"} == {p.name for p in BAD.iterdir()}
    for case in index["cases"]:
        assert case["exit_code"] == 3
        assert case["file"] in case["arguments"]
        assert case["mentions"][0] == case["file"]
        # What stands in the file's name would be mentioned in any case.
        assert not [m for m in case["mentions"][1:] if m in case["file"]]
