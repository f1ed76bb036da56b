"""The last step of a fit, in finer steps than those of the log, goes down however far it is."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from erdctl.core.recording import DIRECTIONS
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.slight_lag import without_lags_held
from erdctl.effects import catalogue
from erdctl.estimate.last_step import SHORTER
from erdctl.prove.case import Wish, seal
from erdctl.prove.judge import _read

SOFT_MOUNT = 1542020  # one sine at one duty and 200 Hz, where a lag and a stiffness look alike


def test_a_step_that_goes_too_far_is_made_shorter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the log's own steps the mount has another lag; all of a step from there leaves more."""
    case = seal(Wish(kind="sparse"), SOFT_MOUNT, 1, tmp_path)
    key = json.loads(next(tmp_path.glob("keys/*.json")).read_text())
    (mount,) = (e for e in catalogue() if e.name == "mount_compliance")
    problem = without_lags_held(prepare(_read(case.log)))
    start = {f"{d}.{q}": v for d in DIRECTIONS for q, v in key["damper"][d].items()}
    start[mount.key("s_m")] = key["law"]["s_m"]
    coarse = fit_hypothesis(problem, [mount], [start | dict(problem.held)])

    def off() -> float:
        """The largest error of a stiffness or a damping over its standard error."""
        fit, _ = fit_errors(problem, coarse)
        told = [f"{d}.{q}" for d in DIRECTIONS for q in ("k_nom", "c_vis")]
        return max(abs(fit.values[n] - start[n]) / fit.stderr[n] for n in told)

    assert np.sqrt(np.mean(coarse.residual**2)) > 1.02 * key["force_noise"]["rms"]
    assert off() < 3.0
    monkeypatch.setattr("erdctl.estimate.last_step.SHORTER", SHORTER[:1])
    assert off() > 5.0
