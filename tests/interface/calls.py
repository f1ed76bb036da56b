"""Commands run in this process, to hold calls against them."""

from __future__ import annotations

import json
from typing import Any

from places import FIXTURES
from typer.testing import CliRunner

from erdctl.cli.app import build

CAMPAIGN = str(FIXTURES / "healthy_campaign.parquet")
SCHEDULE = str(FIXTURES / "schedule_60s.csv")
FOREIGN = str(FIXTURES / "foreign.csv")
LATE = str(FIXTURES / "late_amplifier.parquet")
TABLE_2 = str(FIXTURES / "table_2.json")
LAB = {"t": "Time[ms]", "x": "Defl FL[mm]", "force": "F_fl[N]", "duty": "PWM[%]"}
MAPS = [word for k, v in LAB.items() for word in ("--map", f"{k}={v}")]


def command(*words: str) -> Any:
    """What a command prints on stdout, as JSON, or None if it prints nothing."""
    done = CliRunner().invoke(build([words[0]]), [*words], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout) if done.stdout else None


def refusal(*words: str) -> str:
    """The line with which a command refuses."""
    done = CliRunner().invoke(build([words[0]]), [*words], catch_exceptions=False)
    assert done.exit_code in (2, 3)
    return str(done.stderr).splitlines()[-1].removeprefix("erdctl: error: ")
