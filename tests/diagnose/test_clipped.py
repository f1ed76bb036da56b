"""A channel that stops at a limit: the model may hold within it, and that is all that is said."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from places import FIXTURES
from rig_errors import ERRORS

from erdctl.core.recording import Recording
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import Diagnosis, Verdict, diagnose
from erdctl.effects import get
from erdctl.io.diagnosis import to_json
from erdctl.io.logs import read_logs
from erdctl.report.page.diagnosis import _answers

CANDIDATES = ("gas_preload", "coulomb_friction", "field_saturation", "shear_thinning")


@cache
def sound() -> Recording:
    path = str(FIXTURES / "healthy_campaign.parquet")
    return read_logs([path], need_force=True, report=lambda line: None).recording


def diagnosed(r: Recording) -> Diagnosis:
    return diagnose(r, [get(name) for name in CANDIDATES], limits=False)


@pytest.mark.few(1)
@pytest.mark.parametrize("error", ["force clipped", "x clipped"])
def test_it_is_never_adequate(error: str) -> None:
    """At 8 % of the samples the force is what the amplifier gives, or the stroke what it shows."""
    found = diagnosed(ERRORS[error].spoil(sound(), np.random.default_rng(0)))
    document = to_json(found)
    assert (document["verdict"], document["cannot_tell"]) == ("unexplained", True)
    assert document["findings"] == []
    said = document["remaining"]["text"]
    assert "is noise as far as these data tell" in said
    assert "of what lay beyond a limit the log tells nothing" in said
    assert "is clipped" in said
    answers = _answers(document, "the model", 80.0)
    assert answers["head"].startswith("The model holds within the limits of the channels")
    assert answers["holds"].startswith("As far as was recorded.")
    # What was recorded tells the parameters as before.
    told = parameters(found).estimates
    assert told["compression.c_vis"].stderr is not None


def test_the_same_log_unclipped_is() -> None:
    assert diagnosed(sound()).verdict is Verdict.ADEQUATE
