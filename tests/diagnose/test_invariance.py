"""A finding belongs to the damper: not to the log's order, rate, unit of force or repetitions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from erdctl import plant
from erdctl.core.recording import Recording, concatenate
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.effects import catalogue

SEED, EFFECT, LEVEL = 28, "quadratic_damping", 3.0  # a short campaign; misfit over noise
ERRORS = 4.0  # standard errors within which parameters agree
TIMES = 10.0  # on the force


@cache
def original() -> Recording:
    table = plant.log(plant.draw(SEED, effects=[EFFECT], level=LEVEL, motion="exact"))
    names = table["record"].to_pylist()
    at = [i for i in range(len(names)) if i == 0 or names[i] != names[i - 1]]
    columns = {c: table[c].to_numpy() for c in ("t", "x", "xdot", "duty", "force")}
    return Recording(
        **columns, starts=np.array([*at, len(names)], dtype=np.intp),
        names=tuple(names[i] for i in at),
    )  # fmt: skip


@cache
def reference() -> Diagnosis:
    return diagnose(original(), catalogue(), limits=False)


def shuffled(r: Recording) -> Recording:
    return r.select(np.random.default_rng(5).permutation(len(r.names)).tolist())


def half_the_rate(r: Recording) -> Recording:
    rows = np.concatenate([np.arange(p.start, p.stop, 2) for p in r.slices])
    return r.take(rows, np.searchsorted(rows, r.starts), r.names)


def larger_force(r: Recording) -> Recording:
    assert r.force is not None
    return replace(r, force=TIMES * r.force)


def with_a_copy(r: Recording) -> Recording:
    return concatenate([r, replace(r.select([2]), names=("copy",))])


# Two changes at a time: each costs a whole diagnosis.
def shuffled_and_larger(r: Recording) -> Recording:
    return larger_force(shuffled(r))


def half_the_rate_and_a_copy(r: Recording) -> Recording:
    return with_a_copy(half_the_rate(r))


@pytest.mark.long
@pytest.mark.parametrize("change", [shuffled_and_larger, half_the_rate_and_a_copy])
def test_the_finding_is_the_same(change: Callable[[Recording], Recording]) -> None:
    before, after = reference(), diagnose(change(original()), catalogue(), limits=False)
    assert [f.effect.name for f in before.findings] == [EFFECT]
    assert [f.effect.name for f in after.findings] == [EFFECT]
    assert after.verdict is before.verdict
    for name, q in before.fit.model.quantities.items():
        if change is half_the_rate_and_a_copy and name.endswith(".T_d"):
            continue  # a duty step is then logged up to a sample late, which the lag takes up
        scale = TIMES if change is shuffled_and_larger and q.linear else 1.0
        errors = [f.fit.stderr.get(name, 0.0) / s for f, s in ((before, 1.0), (after, scale))]
        was, now = before.fit.values[name], after.fit.values[name] / scale
        print(f"{name}: {was:.5g} +- {errors[0]:.2g}, then {now:.5g} +- {errors[1]:.2g}")
        assert now == pytest.approx(was, abs=ERRORS * max(errors), rel=1e-6), name
