"""`erdctl compare`: what it writes, with which exit code, and what it refuses."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from fleets import draw
from places import FIXTURES
from rig import TRUTH, noisy
from rig import campaign as campaign_of
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.io.compared import json_schema
from erdctl.model.composed import Model

APP = build(["compare", "identify"])
TABLE_2 = json.loads((FIXTURES / "table_2.json").read_text())


def run(*words: object, data: bytes | None = None) -> Any:
    return CliRunner().invoke(APP, [str(w) for w in words], input=data)


def damper(path: Path, c_vis: float, **labels: str) -> Path:
    """A parameter file with errors."""
    document = json.loads(json.dumps(TABLE_2))
    for d in ("compression", "release"):
        for symbol, v in document[d].items():
            value = v if isinstance(v, float | int) else v["value"]
            document[d][symbol] = {"value": value, "stderr": 0.01 * value}
    document["compression"]["c_vis"] = {"value": c_vis, "stderr": 0.5}
    document["provenance"] = labels
    path.write_text(json.dumps(document))
    return path


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("campaign") / "results.parquet"
    pq.write_table(draw(3, dampers=4, months=40)[0], path)
    return path


def test_two_parameter_files(tmp_path: Path) -> None:
    a, b = damper(tmp_path / "a.json", 60.0), damper(tmp_path / "b.json", 50.0)
    done = run("compare", a, b, "--json")
    assert done.exit_code == 0, done.stderr
    document = json.loads(done.stdout)
    jsonschema.validate(document, json_schema())
    changed = [
        d for d in document["dampers"][0]["pairs"][0]["differences"] if d["verdict"] == "changed"
    ]
    assert [d["parameter"] for d in changed] == ["compression.c_vis"]
    assert document["dampers"][0]["said"] == ["c_vis in compression fell from 60 to 50 N s/m"]
    assert "by standard errors" in done.stderr


def test_the_order_is_that_of_dates(tmp_path: Path) -> None:
    a = damper(tmp_path / "a.json", 60.0, date="2024-06-01")
    b = damper(tmp_path / "b.json", 50.0, date="2024-01-01")
    assert "c_vis in compression grew from 50 to 60" in run("compare", a, b).stderr


def test_dampers_side_by_side(tmp_path: Path) -> None:
    files = [damper(tmp_path / f"{n}.json", c, damper=n) for n, c in (("fl", 60.0), ("fr", 40.0))]
    assert (
        "c_vis in compression fell from 60 to 40 N s/m (against fl)"
        in run("compare", *files).stderr
    )


def test_what_identify_writes_tells_a_covariance(tmp_path: Path) -> None:
    for name in ("schedule_60s", "healthy_campaign"):
        log = next(FIXTURES.glob(f"{name}.parquet"))
        assert run("identify", log, "-o", tmp_path / f"{name}.json").exit_code == 0
    done = run("compare", *sorted(tmp_path.glob("*.json")))
    assert done.exit_code == 0, done.stderr
    assert "judged together, with their covariance" in done.stderr


@pytest.mark.parametrize(
    ("band", "code", "word"),
    [
        ("{ low = 40 }", 0, "pass"),
        ("{ low = 60.5 }", 0, "cannot tell"),
        ("{ low = 70 }", 1, "fail"),
    ],
)
def test_exit_codes_of_limits(tmp_path: Path, band: str, code: int, word: str) -> None:
    limits = tmp_path / "limits.toml"
    limits.write_text(f'"compression.c_vis" = {band}')
    done = run("compare", damper(tmp_path / "a.json", 60.0), "--limits", limits, "--json")
    assert done.exit_code == code
    document = json.loads(done.stdout)
    assert document["dampers"][0]["limits"][0]["verdict"] == word
    assert sum(document["checks"].values()) == 1
    strict = run("compare", tmp_path / "a.json", "--limits", limits, "--strict")
    assert strict.exit_code == (0 if word == "pass" else 1)


def test_a_campaign_as_document_tables_picture_and_page(tmp_path: Path, campaign: Path) -> None:
    limits = tmp_path / "limits.json"
    limits.write_text('{"c_vis": {"low": 10, "high": 90}}')
    out = [tmp_path / f"c.{s}" for s in ("json", "csv", "md", "tex", "png", "html")]
    done = run(
        "compare", campaign, "--limits", limits, "-o", out[0], "--plot", out[4], "--report", out[5]
    )
    assert done.exit_code == 0, done.stderr
    for path in out[1:4]:
        assert run("compare", campaign, "--limits", limits, "-o", path).exit_code == 0
    document = json.loads(out[0].read_text())
    jsonschema.validate(document, json_schema())
    rows = list(csv.DictReader(out[1].open()))
    trends = [t for d in document["dampers"] for t in d["trends"]]
    assert {(r["parameter"], r["change"]) for r in rows} >= {
        (t["parameter"], t["form"]) for t in trends if not t["appeared"]
    }
    assert {r["verdict"] for r in rows if r["parameter"] == "release.c_vis"} == {"pass"}
    assert out[2].read_text().startswith("| damper | parameter |")
    assert r"\toprule" in out[3].read_text()
    assert out[4].read_bytes()[:4] == b"\x89PNG"
    assert "<h1>" in out[5].read_text()


def test_the_same_again(campaign: Path) -> None:
    assert run("compare", campaign, "--json").stdout == run("compare", campaign, "--json").stdout


def test_a_table_on_stdin(campaign: Path) -> None:
    done = run("compare", "-", "--json", data=campaign.read_bytes())
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["logs"] > 100


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["nothing.json"], 2, "no such file"),
        (["a.json", "a.json"], 2, "twice"),
        (["a.json", "-o", "x.xlsx"], 2, ".csv, .md, .tex"),
        (["a.json", "--plot", "x.gif"], 2, "a picture is one of"),
        (["a.json", "--plot", "x.png"], 3, "every damper has one log"),
        (["a.json", "--limits", "bad.toml"], 3, "nothing is called 'viscosity'"),
        (["bad.toml"], 3, "not a JSON document"),
    ],
)
def test_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], code: int, said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    damper(Path("a.json"), 60.0)
    Path("bad.toml").write_text("viscosity = { low = 1 }")
    done = run("compare", *words)
    assert done.exit_code == code
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.json", "bad.toml"]


def bench_log(play: float, seed: int, force: str) -> pa.Table:
    """Of a damper with so much play [m], whose force is in a column of some name."""
    r = campaign_of(200.0, 4.0)
    model = Model((get("backlash"),))
    r = noisy(replace(r, force=model.force(Signals.of(r), {**TRUTH, "backlash.g": play})), seed)
    columns = {c: getattr(r, c) for c in ("t", "x", "xdot", "duty")}
    return pa.table({**columns, force: r.force, "record": np.repeat(r.names, np.diff(r.starts))})


@pytest.fixture(scope="module")
def old_and_new(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A damper before and after it got a play of 1 mm: identified, and diagnosed."""
    where = tmp_path_factory.mktemp("refit")
    pq.write_table(bench_log(0.0, 1, "force"), where / "before.parquet")
    pq.write_table(bench_log(1e-3, 2, "Kraft"), where / "after.parquet")
    app = build(["diagnose", "identify"])
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(where)
        for words in (
            "identify before.parquet -o a.json",
            "diagnose after.parquet --map force=Kraft[N] --effects backlash -o b.json",
        ):
            done = CliRunner().invoke(app, words.split())
            assert done.exit_code == 0, done.stderr
    return where


def test_a_log_is_refitted_with_what_another_model_has(
    old_and_new: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(old_and_new)
    plain = run("compare", "a.json", "b.json", "--json")
    assert "the models differ by backlash" in plain.stderr
    assert "--refit" in plain.stderr
    g = differences(plain.stdout)["backlash.g"]
    assert g["verdict"] == "cannot tell"  # nobody looked for it before
    done = run("compare", "a.json", "b.json", "--refit", "--json")
    assert done.exit_code == 0, done.stderr
    assert "a.json: refitted to its log with backlash" in done.stderr
    assert "the models differ" not in done.stderr
    found = differences(done.stdout)
    g = found["backlash.g"]
    assert g["verdict"] == "changed"
    assert g["change"]["value"] == pytest.approx(1e-3, rel=0.1)
    assert [n for n, d in found.items() if d["verdict"] == "changed"] == ["backlash.g"]


def differences(document: str) -> dict[str, Any]:
    (pair,) = json.loads(document)["dampers"][0]["pairs"]
    return {d["parameter"]: d for d in pair["differences"]}


def test_what_cannot_be_refitted_is_said(
    old_and_new: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("a.json", "b.json"):
        (tmp_path / name).write_bytes((old_and_new / name).read_bytes())
    refit = ("compare", "a.json", "b.json", "--refit")
    gone = run(*refit)
    assert (gone.exit_code, "before.parquet" in gone.stderr) == (2, True)
    pq.write_table(bench_log(0.0, 3, "force"), tmp_path / "before.parquet")
    other = run(*refit)
    assert (other.exit_code, "has changed since a.json" in other.stderr) == (3, True)
    nowhere = damper(tmp_path / "c.json", 60.0)
    said = run("compare", nowhere, "b.json", "--refit")
    assert (said.exit_code, "names no log" in said.stderr) == (3, True)
    same = run("compare", nowhere, damper(tmp_path / "d.json", 50.0), "--refit")
    assert (same.exit_code, "nothing to refit" in same.stderr) == (0, True)
    assert run("compare", nowhere, "b.json", "--map", "x=y").exit_code == 2


def test_campaign_tables_are_not_refitted(campaign: Path) -> None:
    done = run("compare", campaign, "--refit")
    assert (done.exit_code, "--refit takes" in done.stderr) == (2, True)


def test_the_order_given_holds_where_not_all_have_a_date(tmp_path: Path) -> None:
    """The file with a date came first, whatever was given, and the change had the other sign."""
    a = damper(tmp_path / "old.json", 60.0)
    b = damper(tmp_path / "new.json", 40.0, date="2024-05-01")
    said = run("compare", a, b).stderr
    assert "fell from 60 to 40" in said
    assert "not all logs have a date" in said
    c = damper(tmp_path / "older.json", 80.0, date="2020-05-01")
    said = run("compare", b, c).stderr  # dates decide where all have one
    assert "fell from 80 to 40" in said
    assert "not all logs" not in said


def test_what_cannot_be_told_or_was_not_compared_is_not_unchanged(tmp_path: Path) -> None:
    """Ten times the viscosity and no error, or a single file: both were "unchanged"."""
    paths = [damper(tmp_path / f"{c}.json", c) for c in (60.0, 600.0)]
    for path in paths:
        document = json.loads(path.read_text())
        for d in ("compression", "release"):
            document[d] = {symbol: {"value": v["value"]} for symbol, v in document[d].items()}
        path.write_text(json.dumps(document))
    done = run("compare", *paths, "--json")
    assert json.loads(done.stdout)["dampers"][0]["attention"] == "cannot tell"
    assert "2 logs, no change can be told" in done.stderr
    assert "unchanged" not in done.stderr
    page = tmp_path / "one.html"
    done = run("compare", paths[0], "--json", "--report", page)
    assert json.loads(done.stdout)["dampers"][0]["attention"] == "no earlier log"
    assert "1 log, no damper with an earlier one" in done.stderr
    assert "unchanged" not in done.stderr
    assert "no parameter changed" not in page.read_text()
    assert "no log has an earlier one" in page.read_text()


def test_a_sentence_says_nothing_that_its_numbers_do_not(tmp_path: Path) -> None:
    """0.02 of 60 is a change where the errors are 0.001: it was said to grow from 60 to 60, what
    is the same to fall to itself, and a band to end at 70.1 where 70.123 was set."""
    a, b = damper(tmp_path / "a.json", 60.0), damper(tmp_path / "b.json", 60.02)
    for path in (a, b):
        document = json.loads(path.read_text())
        document["compression"]["c_vis"]["stderr"] = 0.001
        path.write_text(json.dumps(document))
    done = run("compare", a, b, "--json")
    texts = {
        d["parameter"]: d["text"]
        for d in json.loads(done.stdout)["dampers"][0]["pairs"][0]["differences"]
    }
    assert texts["compression.c_vis"] == "c_vis in compression grew from 60 to 60.02 N s/m"
    assert texts["compression.T_d"] == "T_d in compression is the same, 43 ms"
    limits = tmp_path / "limits.toml"
    limits.write_text("c_vis = { low = 70.123, high = 1234.5 }")
    assert "band 70.123 to 1234.5 N s/m: fail" in run("compare", a, "--limits", limits).stderr


def test_the_nrmse_of_a_diagnosis_is_said_to_be_its_baselines(tmp_path: Path) -> None:
    """Its parameters are those of the corrected model, which fits better than the score says."""
    params = json.loads(damper(tmp_path / "a.json", 60.0).read_text())
    path, limits = tmp_path / "diagnosis.json", tmp_path / "limits.toml"
    document = {
        "schema": "erdctl.diagnosis/1", "verdict": "explained", "noise_rms": 0.3,
        "baseline": {"nrmse": 0.11}, "corrected": {"nrmse": 0.04, "params": params},
    }  # fmt: skip
    path.write_text(json.dumps(document))
    limits.write_text("nrmse = { high = 0.05 }")
    done = run("compare", path, "--limits", limits)
    assert done.exit_code == 1
    assert "the baseline's NRMSE 0.11, at most 0.05: fail" in done.stderr
    del document["baseline"]
    path.write_text(json.dumps(document))
    done = run("compare", path)
    assert (done.exit_code, done.exception) == (0, None)
