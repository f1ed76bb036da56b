"""What acts where a record begins, which no fit weighs, is said and not called noise."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.core.recording import Array, Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.wording import remaining_text


def said(r: Recording, force: Array) -> str:
    log = noisy(replace(r, force=force), seed=4)
    return remaining_text(diagnose(log, [], limits=False, learning=False))


def test_a_drag_that_is_gone_within_the_first_moments_is_said() -> None:
    r = campaign()
    assert r.force is not None
    begun = np.repeat(r.t[r.starts[:-1]], np.diff(r.starts))
    drag = 4.0 * np.sign(r.xdot) * np.exp(-(r.t - begun) / 0.04)
    text = said(r, r.force + drag)
    assert "in the first 0.3 s of records" in text
    found = re.search(r"it is (\S+) N rms, and (\S+) N behind", text)
    assert found is not None
    assert float(found[2]) == pytest.approx(0.3, rel=0.1)  # the noise
    assert float(found[1]) > 2.0 * float(found[2])


def test_a_record_that_begins_as_it_goes_on_says_nothing_of_it() -> None:
    r = campaign()
    assert r.force is not None
    assert "in the first" not in said(r, r.force)
