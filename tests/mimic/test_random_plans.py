"""No value that goes to an amplifier is beyond a declared limit, and healthy is as given.

ERDCTL_PLANS=3000 ERDCTL_PLANS_FROM=10000 looks at other and more plans than the 160.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from random_plans import RandomPlan, random_plan
from replayed import CHANNELS, Run, back_after, faults_of, replay

import erdctl

FIRST = int(os.environ.get("ERDCTL_PLANS_FROM", "0"))
COUNT = int(os.environ.get("ERDCTL_PLANS", "160"))
BATCH = 20


def written(plan: RandomPlan, folder: Path) -> Path:
    path = folder / "pwm.csv"
    faults = [str(f) for f in plan.faults]
    erdctl.mimic(plan.parameters, plan.log, faults, **plan.options).write(path)
    return path


def judge(plan: RandomPlan, path: Path) -> None:
    runs, manifest = replay(path)
    assert sum(len(r.t) for r in runs) == len(plan.log)
    given = plan.log["duty"] if plan.options["duty"] is None else plan.options["duty"]
    assert np.array_equal(np.concatenate([r.given for r in runs]), np.zeros(len(plan.log)) + given)
    limits = manifest["limits"]
    assert manifest["check"]["held"]
    assert limits["duty_max"] == plan.options["duty_max"]
    assert limits["resolution"] == plan.options["resolution"]
    for name in ("slew", "update_rate"):
        assert (limits[name] or {"value": None})["value"] == plan.options[name]
    sound = True
    backs = dict.fromkeys(CHANNELS, 0)
    for run in runs:
        broken = faults_of(run.t, run.given, limits)
        sound = sound and not broken
        for channel in CHANNELS:
            duty = run.duties[channel]
            assert faults_of(run.t, duty, limits) == []
            backs[channel] += judge_healthy(plan, run, channel, broken[0][0] if broken else None)
    assert sound == (manifest["healthy"]["breaks"] == [])
    if sound:
        assert manifest["healthy"]["samples_changed"] == 0
        for entry in manifest["way_back"]:
            assert backs[entry["channel"]] == entry["samples"]


def judge_healthy(plan: RandomPlan, run: Run, channel: str, breaks: int | None) -> int:
    """The given duty, bit for bit, up to the first sample at which it breaks a limit itself.

    Returns samples on the way back after a fault.
    """
    mine = [f for f in plan.faults if f.channel == channel]
    back, strange = back_after(
        run, channel, lambda t, v, first: any(f.acts(t, v, first) for f in mine)
    )
    until = len(run.t) if breaks is None else breaks
    assert [i for i in strange if i < until] == []
    if breaks is None and back:
        # A way back takes the update that is due, and what the slew limit asks for.
        o = plan.options
        assert o["slew"] is not None or o["update_rate"] is not None
    return len(back)


@pytest.mark.few(3)
@pytest.mark.parametrize("batch", range((COUNT + BATCH - 1) // BATCH))
def test_random_plans_keep_every_limit(batch: int, tmp_path: Path) -> None:
    first = FIRST + batch * BATCH
    for seed in range(first, min(first + BATCH, FIRST + COUNT)):
        plan = random_plan(seed)
        try:
            judge(plan, written(plan, tmp_path))
        except Exception as error:  # whatever it is, raised again with the plan that shows it
            error.add_note(f"seed {seed}: {plan.options}, {[str(f) for f in plan.faults]}")
            raise
