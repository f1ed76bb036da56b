"""What remains of physics speaks for one of two effects by chance, and settles no name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rig import campaign, noisy

from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.effects import get

PAIR = ("gas_preload", "gas_polytropic")


def found(ripple: float) -> Diagnosis:
    """A preload, a curve of the gas that is small beside it, and a ripple of the bore."""
    r = noisy(campaign(100.0, 8.0), seed=12)
    assert r.force is not None
    gas = 6.0 + 3e3 * r.x**2
    log = replace(r, force=r.force + gas + ripple * np.sin(2 * np.pi * r.x / 3e-3))
    return diagnose(log, [get(n) for n in PAIR], limits=False, learning=False)


@pytest.mark.parametrize(("ripple", "alike"), [(0.0, ()), (3.0, ("gas_preload",))])
def test_a_richer_form_settles_nothing_where_more_than_it_says_is_left(
    ripple: float, alike: tuple[str, ...]
) -> None:
    (finding,) = found(ripple).findings
    assert finding.effect.name == "gas_polytropic"
    assert finding.equivalent == alike
