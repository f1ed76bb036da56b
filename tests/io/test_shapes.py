"""Every document that erdctl writes is what its published JSON Schema says, and nothing else."""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from places import FIXTURES
from prove.results import result
from rig import campaign, noisy
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.record_effects import Varying
from erdctl.effects import get
from erdctl.io import documents
from erdctl.io.diagnosis import to_json
from erdctl.io.parameters import read_parameters
from erdctl.io.shapes import SCHEMAS
from erdctl.prove import document as proof
from erdctl.prove import on_log_document as proof_on
from erdctl.prove.case import Wish
from erdctl.prove.judge import Failed

APP = build()
ALL = {**SCHEMAS, "proof": proof.json_schema, "proof-on": proof_on.json_schema}
TABLE_2, SCHEDULE = str(FIXTURES / "table_2.json"), str(FIXTURES / "schedule_60s.csv")


def closed(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema with every object closed, so that an undocumented key is an error."""
    out = deepcopy(schema)
    for shape in out["$defs"].values():
        if "properties" in shape:
            shape["additionalProperties"] = False
    return out


def check(name: str, document: object) -> None:
    plain = json.loads(documents.encode(document))
    jsonschema.validate(plain, closed(ALL[name]()), cls=jsonschema.Draft202012Validator)


def run(*words: str) -> str:
    found = CliRunner().invoke(APP, list(words), catch_exceptions=False)
    assert found.exit_code == 0, found.stderr
    return found.stdout


@pytest.mark.parametrize("name", ALL)
def test_schemas_are_schemas_and_are_printed(name: str) -> None:
    schema = json.loads(run("schema", name))
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema == json.loads(documents.encode(ALL[name]()))
    with pytest.raises(jsonschema.ValidationError):
        check(name, {"schema": "something else"})


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("parameters", ["identify", SCHEDULE]),
        ("parameters", ["derive", str(FIXTURES / "geometry_inove.json")]),
        ("inspection", ["inspect", SCHEDULE, "--json"]),
        ("inspection", ["inspect", str(FIXTURES / "healthy_noisy_motion.csv"), "--json"]),
        ("validation", ["validate", TABLE_2, SCHEDULE, "--json"]),
    ],
    ids=lambda v: v if isinstance(v, str) else v[0],
)
def test_what_commands_print(name: str, words: list[str]) -> None:
    check(name, json.loads(run(*words)))


@pytest.mark.parametrize("name", ALL)
def test_a_document_of_another_kind_or_version_is_none(name: str) -> None:
    schema = ALL[name]()
    whole = schema["$defs"][schema["$ref"].rpartition("/")[2]]
    assert whole["properties"]["schema"]["enum"] == [f"erdctl.{name}/1"]


@pytest.mark.parametrize("file", ["table_2.json", "geometry_inove.json"])
def test_fixtures(file: str) -> None:
    name = "geometry" if "geometry" in file else "parameters"
    check(name, json.loads((FIXTURES / file).read_text()))


@pytest.mark.parametrize("late", [False, True])
def test_the_manifest_of_a_sequence(late: bool, tmp_path: Path) -> None:
    params = json.loads(Path(TABLE_2).read_text())
    if late:
        params["effects"] = [{"effect": "input_delay", "parameters": {"tau": 0.02}}]
    (tmp_path / "p.json").write_text(json.dumps(params))
    check("parameters", params)
    out, drive = str(tmp_path / "pwm.csv"), tmp_path / "drive.csv"
    drive.write_text("".join(Path(SCHEDULE).read_text().splitlines(keepends=True)[:1500]))
    run("mimic", str(tmp_path / "p.json"), str(drive), "--fault", "oil=0.5@2:5", "-o", out,
        "--update-rate", "200", "--slew", "100")  # fmt: skip
    check("pwm", json.loads(Path(f"{out}.manifest.json").read_text()))


def test_diagnoses(tmp_path: Path) -> None:
    r = noisy(campaign(50.0, 4.0), seed=4)
    assert r.force is not None
    rubbing = r.force + 2.0 * (r.xdot > 0) - 2.0 * (r.xdot < 0)
    r = type(r)(t=r.t, x=r.x, xdot=r.xdot, duty=r.duty, force=rubbing, starts=r.starts,
                names=r.names)  # fmt: skip
    few = [get(name) for name in ("coulomb_friction", "stribeck_friction")]
    plain = to_json(diagnose(r, few, most=1))
    assert plain["findings"]
    check("diagnosis", plain)
    check("parameters", plain["corrected"]["params"])
    given = diagnose(
        r, few[:1], most=1, given=read_parameters(TABLE_2), free=Varying(gain=True), limits=False
    )
    document = to_json(given, {"name": "p.json", "sha256": "ab" * 32})
    assert {"refitted", "records", "with_records"} <= set(document)
    check("diagnosis", document)


def test_a_proof() -> None:
    failed = Failed(number=2, seed=8, message="no convergence")
    seeds, wish = [7, 8], Wish(effects=("backlash",))
    check("proof", proof.to_json(proof.proof_of(wish, seeds, [result(), failed])))
