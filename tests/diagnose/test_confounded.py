"""What a short log fixes only together with something else has no value in a diagnosis."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pyarrow.parquet as pq

from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.fit_errors import fit_errors
from erdctl.diagnose.hypothesis import fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.effects import get, names
from erdctl.io.logs import read_logs
from erdctl.plant import draw, log
from erdctl.plant.plan import draw_plan
from erdctl.prove.best import damper_values

FRICTION = "stribeck_friction"


def test_kinetic_friction_and_yield_force_at_one_duty(tmp_path: Path) -> None:
    """Both are constant forces against the motion: three numbers for the two that are seen, so
    none of them is told, while the peak and the speed of the static friction are."""
    wish: dict[str, Any] = {"kind": "sparse", "effects": [FRICTION], "known": names()}
    seed = next(s for s in range(60) if len(draw_plan(s, **wish).campaign.levels) == 1)
    case = draw(seed, level=5.0, motion="exact", colour="white", **wish)
    pq.write_table(log(case), tmp_path / "log.parquet")
    recording = read_logs([str(tmp_path / "log.parquet")], need_force=True, report=print).recording
    problem = prepare(recording)
    law = case.truth[0].law
    assert law is not None
    sides = {"compression": case.plant.compression, "release": case.plant.release}
    truth = damper_values({"damper": {d: s._asdict() for d, s in sides.items()}})
    start = truth | {f"{FRICTION}.{s}": v for s, v in law.items()}
    best = fit_hypothesis(problem, [get(FRICTION)], [start])
    fit, _ = fit_errors(problem, best)
    found: Any = SimpleNamespace(
        fit=fit,
        problem=problem,
        noise_rms=1.0,
        rig=SimpleNamespace(to_json=list),
        cannot_tell="",
        learned=None,
        selection=SimpleNamespace(best=best),
    )
    told = parameters(found).estimates
    assert told[f"{FRICTION}.F_k"].value is None
    assert "only together with" in str(told[f"{FRICTION}.F_k"].reason)
    assert told["compression.sigma"].value is None
    peak = told[f"{FRICTION}.F_sk"].interval
    assert peak is not None
    assert peak[0] < 1.1 * law["F_sk"]
    assert peak[1] > 0.9 * law["F_sk"]
