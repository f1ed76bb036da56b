"""A name is earned by taking more of a misfit than it leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.diagnose.wording import remaining_text
from erdctl.effects import get
from erdctl.io.diagnosis import to_json

NOISE = 0.3


def found(part: float, *, learning: bool = True) -> Diagnosis:
    """A groove that no candidate knows, and a quadratic damping that is this part of the square.

    A short log where a law is learned, which takes a minute of a long one.
    """
    r = campaign(100.0, 6.0) if learning else campaign()
    assert r.force is not None
    up = r.xdot > 0
    own = np.column_stack([v * side for v in (r.x, r.xdot, r.xdot != 0) for side in (up, ~up)])
    effects = np.column_stack([np.sin(2 * np.pi * r.x / 0.006), r.xdot * np.abs(r.xdot)])
    left = effects - own @ np.linalg.lstsq(own, effects)[0]  # what the paper's model leaves of them
    unit = (effects / np.sqrt(np.mean(left**2, axis=0))).T
    force = 10.0 * NOISE * (np.sqrt(1.0 - part) * unit[0] + np.sqrt(part) * unit[1])
    log = noisy(replace(r, force=r.force + force), seed=4, rms=NOISE)
    candidates = [get("quadratic_damping"), get("coulomb_friction")]
    return diagnose(log, candidates, learning=learning)


def test_what_leaves_more_than_it_takes_is_not_named() -> None:
    it = found(0.15, learning=False)  # or the groove would be learned
    assert it.verdict is Verdict.UNEXPLAINED
    assert it.findings == ()
    names = [e.name for e in it.withdrawn]
    assert names[0] == "quadratic_damping"
    assert it.taken == pytest.approx(0.15, abs=0.1)
    assert f"the search had chosen {', '.join(names)} for" in remaining_text(it)
    assert it.corrected == it.carried
    assert to_json(it)["withdrawn"] == names


@pytest.mark.long
def test_once_a_law_takes_the_rest_the_effect_has_its_name() -> None:
    it = found(0.15)
    assert it.verdict is Verdict.UNEXPLAINED
    assert [f.effect.name for f in it.findings] == ["quadratic_damping"]
    assert (it.withdrawn, it.taken) == ((), None)
    assert it.learned is not None
    assert "the search had chosen" not in remaining_text(it)
    assert it.corrected.overall.rms < 1.05 * NOISE


@pytest.mark.long
def test_what_takes_more_is_named_beside_what_stays() -> None:
    it = found(0.85, learning=False)
    assert it.verdict is Verdict.UNEXPLAINED
    assert [f.effect.name for f in it.findings] == ["quadratic_damping"]
    assert it.withdrawn == ()
    assert it.taken is None
