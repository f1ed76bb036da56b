"""A small fleet, and the table of its campaign when nothing disturbs it."""

from __future__ import annotations

from pathlib import Path

import fleet
import pytest
from campaigns import DAMPERS, MONTHS, AtOnce, words
from typer.testing import CliRunner

from erdctl.campaign import run as room
from erdctl.cli.app import build


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with lab/, 24 logs, and results.parquet.

    Done in this process; the tests that disturb a campaign have processes of their own.
    """
    where = tmp_path_factory.mktemp("campaign")
    fleet.write(where / "lab", DAMPERS, MONTHS, {"leak": 1, "play": 2, "preload": 3})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "here", lambda jobs: room.Crew(AtOnce, lambda: 1))
        patch.chdir(where)
        _, _, _, *given = words(where, "results.parquet")
        done = CliRunner().invoke(build(["campaign"]), given, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return where
