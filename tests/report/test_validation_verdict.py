"""A validation page says that a model holds only where its error is measurement noise."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import FIXTURES, SHARED
from rig import real
from typer.testing import CliRunner

from erdctl.cli.app import build


def verdict(log: Path, folder: Path) -> str:
    """The head of the page of a model that was fitted to the very same log."""
    params, page = folder / "p.json", folder / "page.html"
    for words in (
        ["identify", str(log), "-o", str(params)],
        ["validate", str(params), str(log), "--json", "--report", str(page)],
    ):
        result = CliRunner().invoke(build([words[0]]), words)
        assert result.exit_code == 0, result.output
    text = page.read_text()
    return text[text.index("<h1>") + 4 : text.index("</h1>")]


@pytest.mark.parametrize("log", ["worn_joint.parquet", "late_amplifier.parquet"])
def test_a_model_that_misses_something_does_not_hold(log: str, tmp_path: Path) -> None:
    assert "does not hold" in verdict(FIXTURES / log, tmp_path)


def test_a_model_at_the_noise_holds(tmp_path: Path) -> None:
    assert "The model holds" in verdict(FIXTURES / "healthy_campaign.parquet", tmp_path)


@pytest.mark.real_data
@pytest.mark.parametrize("log", ["mr_sine.parquet", "friction_sine.parquet"])
def test_the_papers_model_does_not_hold_for_real_dampers(log: str, tmp_path: Path) -> None:
    assert "does not hold" in verdict(real(log, SHARED), tmp_path)
