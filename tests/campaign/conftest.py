"""A small fleet, and the table of its campaign when nothing disturbs it."""

from __future__ import annotations

from pathlib import Path

import fleet
import pytest
from campaigns import DAMPERS, MONTHS, run


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with lab/, 24 logs, and results.parquet."""
    where = tmp_path_factory.mktemp("campaign")
    fleet.write(where / "lab", DAMPERS, MONTHS, {"leak": 1, "play": 2, "preload": 3})
    run(where, "results.parquet", "--jobs", "2")
    return where
