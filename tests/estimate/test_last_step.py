"""The last step of a fit, in finer steps than those of the log, goes down however far it is."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from erdctl.core.recording import DIRECTIONS
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.slight_lag import without_lags_held
from erdctl.effects import get
from erdctl.estimate.last_step import SHORTER
from erdctl.prove.case import Wish, seal
from erdctl.prove.judge import _read

SOFT_MOUNT = 1544028  # at one duty, where a lag, a stiffness and the mount look alike


def test_a_step_that_goes_too_far_is_made_shorter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Dropped as a whole, all values stay those of the log's own steps: of another such log k_nom
    was 3725 to 5549 N/m for 13304, and is 12994 to 14335."""
    case = seal(Wish(effects=("mount_compliance",), kind="sparse"), SOFT_MOUNT, 1, tmp_path)
    key = json.loads(next(tmp_path.glob("keys/*.json")).read_text())
    mount = get("mount_compliance")
    problem = without_lags_held(prepare(_read(case.log)))
    start = {f"{d}.{q}": v for d in DIRECTIONS for q, v in key["damper"][d].items()}
    start[mount.key("s_m")] = key["law"]["s_m"]
    coarse = fit_hypothesis(problem, [mount], [start | dict(problem.held)])

    def over_noise() -> float:
        return fit_errors(problem, coarse)[0].rms / float(key["force_noise"]["rms"])

    assert over_noise() < 1.003
    monkeypatch.setattr("erdctl.estimate.last_step.SHORTER", SHORTER[:1])
    assert over_noise() > 1.006
