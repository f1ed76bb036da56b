"""What is left beside all that was missing is not called noise where motion still predicts it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import Verdict, diagnose
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
