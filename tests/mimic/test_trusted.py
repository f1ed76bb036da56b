"""Parameters of a recording that was wrong as a whole drive no amplifier."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from places import FIXTURES
from typer.testing import CliRunner

import erdctl
from erdctl.cli.app import build
from erdctl.core.errors import InputProblem

WRONG = {"code": "force_sign", "record": None, "text": "reversed", "remedy": "", "blocks": True}


@pytest.mark.parametrize(("record", "refused"), [(None, True), ("r03", False)])
def test_mimic_with_them(record: str | None, refused: bool, tmp_path: Path) -> None:
    document = json.loads((FIXTURES / "table_2.json").read_text())
    document.setdefault("provenance", {})["rig"] = [{**WRONG, "record": record}]
    params, out = tmp_path / "p.json", tmp_path / "pwm.csv"
    params.write_text(json.dumps(document))
    log = FIXTURES / "schedule_60s.csv"
    words = ["mimic", str(params), str(log), "--fault", "oil=0.5@15:31", "-o", str(out)]
    result = CliRunner().invoke(build([words[0]]), words)
    assert (result.exit_code == 3) is refused, result.output
    assert out.exists() is not refused
    if refused:
        with pytest.raises(InputProblem, match="reversed"):
            erdctl.mimic(str(params), str(log), faults=["oil=0.5@15:31"])
