"""Date, damper and operator go into every document and onto every page and picture."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from places import FIXTURES
from typer.testing import CliRunner

import erdctl
from erdctl.cli.app import build

LOG, TABLE_2 = str(FIXTURES / "healthy_noisy_motion.csv"), str(FIXTURES / "table_2.json")
SCHEDULE = str(FIXTURES / "schedule_60s.csv")
LABELS = {"date": "2024-05-01", "damper": "FL 3 <b>", "operator": "A. Tester"}
SAID = [word for name, value in LABELS.items() for word in (f"--{name}", value)]
FEW = ["--effects", "coulomb_friction", "--jobs", "1"]


def erdctl_(*words: str, code: int = 0) -> str:
    done = CliRunner().invoke(build([words[0]]), list(words))
    assert done.exit_code == code, done.output
    return done.stdout


def held_by_the_schema(document: object, name: str) -> None:
    jsonschema.validate(document, json.loads(erdctl_("schema", name)))


@pytest.mark.parametrize(
    ("schema", "words"),
    [
        ("parameters", ["identify", LOG]),
        ("diagnosis", ["diagnose", LOG, *FEW]),
        ("validation", ["validate", TABLE_2, LOG, "--json"]),
        ("inspection", ["inspect", LOG, "--json"]),
        ("parameters", ["derive", str(FIXTURES / "geometry_inove.json")]),
    ],
    ids=lambda v: v[0] if isinstance(v, list) else v,
)
def test_documents(schema: str, words: list[str]) -> None:
    plain, labelled = json.loads(erdctl_(*words)), json.loads(erdctl_(*words, *SAID))
    held_by_the_schema(labelled, schema)
    assert {k: labelled["provenance"][k] for k in LABELS} == LABELS
    assert not set(LABELS) & set(plain.get("provenance", {}))
    if schema == "diagnosis":
        assert labelled["corrected"]["params"]["provenance"]["damper"] == LABELS["damper"]
    # Nothing else changes.
    for name in LABELS:
        labelled["provenance"].pop(name)
        if schema == "diagnosis":
            labelled["corrected"]["params"]["provenance"].pop(name)
    if not labelled["provenance"]:
        labelled.pop("provenance")
    assert labelled == plain


def test_a_sequence_and_its_manifest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    erdctl_("mimic", TABLE_2, SCHEDULE, "--fault", "oil=0.5@15:31", "-o", "pwm.csv", *SAID)
    manifest = json.loads((tmp_path / "pwm.csv.manifest.json").read_text())
    assert manifest["provenance"] == LABELS
    held_by_the_schema(manifest, "pwm")


@pytest.mark.parametrize(
    "words",
    [
        ["validate", TABLE_2, LOG],
        pytest.param(["diagnose", LOG, *FEW, "-o", "d.json"], marks=pytest.mark.long),
        ["mimic", TABLE_2, SCHEDULE, "--fault", "oil=0.5", "-o", "p.csv"],
    ],
    ids=lambda words: words[0],
)
def test_pages_and_pictures(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    erdctl_(*words, *SAID, "--report", "page.html", "--plot", "a.svg")
    page, picture = (tmp_path / "page.html").read_text(), (tmp_path / "a.svg").read_text()
    assert "FL 3 <b>" not in page.partition("<script")[0].replace("FL 3 &lt;b&gt;", "")
    kicker = page[page.index('class="kicker"') :].partition("</p>")[0]
    for value in ("2024-05-01", "FL 3 &lt;b&gt;", "A. Tester"):
        assert value in kicker
    assert "A. Tester" in picture


def test_wrong_labels_are_refused_before_the_work() -> None:
    for command in (["identify", LOG], ["diagnose", LOG], ["validate", TABLE_2, LOG]):
        erdctl_(*command, "--date", "1.5.24", code=2)


def test_the_same_in_python() -> None:
    log = erdctl.read(LOG)
    damper = erdctl.identify(log, **LABELS)
    assert {k: damper.to_dict()["provenance"][k] for k in LABELS} == LABELS
    assert erdctl.validate(damper, LOG, **LABELS).to_dict()["provenance"] == LABELS
    assert erdctl.inspect(log, **LABELS).to_dict()["provenance"] == LABELS
    assert "provenance" not in erdctl.validate(damper, LOG).to_dict()
    pwm = erdctl.mimic(damper, SCHEDULE, "oil=0.5", **LABELS)
    assert pwm.to_dict()["provenance"] == LABELS
    found = erdctl.diagnose(log, effects="coulomb_friction", jobs=1, **LABELS)
    assert {k: found.to_dict()["provenance"][k] for k in LABELS} == LABELS
    assert not log.recording.labels
