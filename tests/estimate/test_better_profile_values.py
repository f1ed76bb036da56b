"""A value that a profile likes better is taken only where the force itself fits about as well."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from erdctl.core.recording import Array
from erdctl.estimate.profile_cost import ProfileData

MISFIT = np.where(np.arange(1000) % 10 == 0, 5.0, 0.1)  # a tenth of all: a part of the motion


class Steps:
    """A force that is off by `many` where the misfit lies, by `few` elsewhere, by `one` once."""

    def force(self, model: object, values: dict[str, float]) -> Array:
        single = np.where(np.arange(1000) == 1, values.get("one", 0.0), 0.0)
        off = np.where(MISFIT > 1.0, values["many"], values["few"])
        return np.asarray(-off * np.sign(MISFIT) - single)


def data() -> ProfileData:
    found: Any = SimpleNamespace(model=None)
    finer: Any = [Steps()]
    return ProfileData(found, finer, np.zeros(1000), np.ones(1000), 0.3)


def test_a_misfit_may_not_grow_beyond_the_limit() -> None:
    here = {"many": 5.0, "few": 0.1}
    worse = {"many": 20.0, "few": 0.05}  # less up to the limit, ten times as much in all
    assert data().best(here, (worse,)) is here


def test_nor_by_a_little() -> None:
    """A law of the wrong form left 8 % more of all, and predicted other motion worse than none."""
    here = {"many": 5.0, "few": 0.1}
    worse = {"many": 5.1, "few": 0.05}
    assert data().best(here, (worse,)) is here


def test_a_single_sample_may() -> None:
    """A contact that falls to the other side of one sample must not decide."""
    here = {"many": 5.0, "few": 0.1}
    better = {"many": 5.0, "few": 0.05, "one": 3.0}
    assert data().best(here, (better,)) is better


def test_the_least_is_taken() -> None:
    here, less, least = ({"many": 5.0, "few": x} for x in (0.1, 0.08, 0.05))
    assert data().best(here, (less, least)) is least
    assert data().best(here, (least, less)) is least
