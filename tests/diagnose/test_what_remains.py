"""What is left beside all that was missing is not called noise where motion still predicts it."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Verdict, diagnose
from erdctl.diagnose.problem import prepare
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get


@pytest.mark.parametrize("ripple", [0.0, 0.3])
def test_a_small_rest_that_motion_predicts_is_not_called_noise(ripple: float) -> None:
    """Of LuGre's damper 4.1 N were left beside a noise of 4.7 N, and all of it was said to be noise
    "as far as these data tell"."""
    r = campaign()
    assert r.force is not None
    force = r.force + 6.0 * np.sign(r.xdot) + ripple * np.sin(2.0 * np.pi * r.x / 0.004)
    found = diagnose(
        noisy(replace(r, force=force), seed=4), [get("coulomb_friction")], limits=False,
        learning=False,
    )  # fmt: skip
    assert found.verdict is Verdict.EXPLAINED
    said = remaining_text(found)
    assert ("is noise as far as these data tell" in said) == (ripple == 0.0)
    assert ("that motion and duty still predict" in said) == (ripple > 0.0)


@pytest.mark.long
def test_that_xdot_was_derived_is_said_of_what_is_not_explained() -> None:
    """What its window rounds was "explained by none" of triangles with corners of 2 ms."""
    r = campaign()
    assert r.force is not None
    force = r.force + 3.0 * np.sign(np.sin(2.0 * np.pi * r.x / 0.004))
    found = diagnose(
        noisy(replace(r, force=force), seed=4), [get("coulomb_friction")], limits=False,
        learning=False,
    )  # fmt: skip
    assert found.verdict is Verdict.UNEXPLAINED
    said = "a log with xdot would tell"
    assert said not in remaining_text(found)
    log = replace(found.problem.recording, xdot_note="derived from x by a filter")
    block = found.problem.block._replace(signals=Signals.of(log))
    of_derived = replace(found, problem=replace(found.problem, recording=log, block=block))
    assert said in remaining_text(of_derived)


@pytest.mark.parametrize("over", [1.0, 1.5])
def test_what_no_fit_weighs_is_not_called_noise(over: float) -> None:
    """1.59 N were said to be noise beside a noise of 0.218 N, of samples next to turns."""
    r = noisy(campaign(100.0, 8.0), 4)
    unsure = prepare(r).unsure
    assert r.force is not None
    assert 0.0 < np.mean(unsure) < 0.2
    more = 0.3 * np.sqrt((over**2 - 1.0) / np.mean(unsure))
    force = r.force + more * unsure * np.where(np.arange(len(r)) % 2, 1.0, -1.0)
    found = diagnose(
        replace(r, force=force), [get("coulomb_friction")], limits=False, learning=False
    )
    assert found.verdict is Verdict.ADEQUATE
    said = remaining_text(found)
    assert re.search(r"what remains, 0\.(29|30)\d* N rms, is noise as far as these data tell", said)
    assert ("of all samples, with those next to turns" in said) == (over > 1.0)
    assert ("which no fit weighs, it is 0.4" in said) == (over > 1.0)
