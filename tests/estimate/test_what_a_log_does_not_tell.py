"""Why a parameter has no value: the reason is true of the log, and nothing is fitted to nothing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from places import FIXTURES
from rig import campaign
from typer.testing import CliRunner

from erdctl.cli.app import build
from erdctl.core.errors import InputProblem
from erdctl.core.recording import Recording
from erdctl.estimate.covariance import Fit, together
from erdctl.estimate.identify import identify


def reasons(r: Recording) -> dict[str, str]:
    return {name: e.reason for name, e in identify(r).joint.items() if e.reason is not None}


def test_a_reason_is_of_one_direction_alone() -> None:
    r = campaign()
    found = reasons(replace(r, duty=np.where(r.xdot > 0, 0.0, r.duty)))
    assert "no sample with a duty above zero in this direction" in found["compression.sigma"]
    found = reasons(replace(r, duty=np.where(r.xdot > 0, 0.2 * (r.duty > 0), r.duty)))
    assert "one duty level above zero in this direction" in found["compression.sigma"]


def test_nothing_is_fitted_where_every_sample_is_left_out() -> None:
    r = campaign()
    with pytest.raises(InputProblem, match="every sample is left out of the fit"):
        identify(replace(r, excluded=np.ones(len(r), dtype=np.bool_)))


def test_what_changes_nothing_is_told_to() -> None:
    class Flat(Fit):
        def __init__(self) -> None: ...

    found = Flat()
    object.__setattr__(found, "flat", (("release.k_nom",), ("a", "b")))
    assert together(found) == {
        "release.k_nom": "the data do not change with it",
        "a": "the data change with it only together with b",
        "b": "the data change with it only together with a",
    }


def run(*words: str, log: Path = FIXTURES / "schedule_60s.csv") -> tuple[int, str]:
    table_2 = FIXTURES / "table_2.json"
    done = CliRunner().invoke(build(), ["validate", str(table_2), str(log), *words])
    return done.exit_code, " ".join(done.stderr.split())  # a title is broken where lines are short


@pytest.mark.parametrize("limit", ["nan", "-0.1"])
def test_a_limit_that_tells_nothing_is_refused(limit: str) -> None:
    code, said = run("--fail-above", limit)
    assert code == 2
    assert "--fail-above takes a number of 0 or more" in said


def test_the_mean_is_that_of_the_size() -> None:
    _, said = run("--normalise", "mean")
    assert said.startswith("NRMSE over the mean size of the measured force, per PWM level")
    _, said = run("--normalise", "rms")
    assert said.startswith("NRMSE over the rms of the measured force")


def test_bins_of_a_continuous_control_are_said_to_be(tmp_path: Path) -> None:
    held = FIXTURES / "schedule_60s.csv"
    log, path = pd.read_csv(held), tmp_path / "continuous.csv"
    log.assign(duty=0.3 + 0.2 * np.sin(log.t)).to_csv(path, index=False)
    middle = "per PWM level, the middle of a bin of 5 %"
    assert middle in run(log=path)[1]
    assert middle not in run(log=held)[1]
