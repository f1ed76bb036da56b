"""Two states of a damper: parameters alone and together, effects that come and go."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from erdctl.compare.history import Covariance, History, Series
from erdctl.compare.pair import Change, pair, wald

NAMES = ("compression.sigma", "compression.beta", "release.sigma", "release.beta")
NONE = float("nan")


def history(
    rows: dict[str, list[tuple[float, float]]],
    correlation: np.ndarray | None = None,
    offs: dict[str, tuple[float, float]] | None = None,
    settled: bool = True,
) -> History:
    """value and error of each log by parameter; off value and limit of effects."""
    n = len(next(iter(rows.values())))
    none = np.full(n, NONE)
    series = {}
    for name, values in rows.items():
        off, limit = (offs or {}).get(name, (None, NONE))
        value, error = (np.array(v, dtype=float) for v in zip(*values, strict=True))
        series[name] = Series(
            name=name, unit="1", at=np.arange(n), t=none, value=value, stderr=error, low=none,
            high=none, off=off, limit=np.where(np.isnan(value), limit, NONE),
        )  # fmt: skip
    covariances = {}
    if correlation is not None:
        covariances = {i: Covariance(tuple(rows), correlation) for i in range(n)}
    named = [
        frozenset(k for k in rows if np.isfinite(rows[k][i][0]) and k in (offs or {}))
        for i in range(n)
    ]
    return History(
        damper="D1", logs=tuple(f"{i}.json" for i in range(n)), t=none, series=series,
        effects=tuple(named), searched=(True,) * n, settled=(settled,) * n, covariances=covariances,
    )  # fmt: skip


def verdicts(h: History) -> dict[str, Change]:
    return {d.name: d.verdict for d in pair((h, 0), (h, 1)).differences}


def test_beyond_its_error_or_within() -> None:
    h = history({"a.x": [(10.0, 1.0), (16.0, 1.0)], "a.y": [(10.0, 1.0), (11.0, 1.0)]})
    assert verdicts(h) == {"a.x": Change.CHANGED, "a.y": Change.SAME}


def test_many_parameters_are_counted() -> None:
    """One at 2.5 errors is a change if it is asked for alone, and none among forty."""
    one = {"a.x": [(0.0, 1.0), (2.5 * np.sqrt(2), 1.0)]}
    assert verdicts(history(one))["a.x"] is Change.CHANGED
    more = {f"b.{i}": [(0.0, 1.0), (0.5, 1.0)] for i in range(39)}
    assert verdicts(history(one | more))["a.x"] is Change.SAME


def test_without_errors_it_cannot_be_told() -> None:
    h = history({"a.x": [(1.0, NONE), (2.0, NONE)], "a.y": [(1.0, NONE), (1.0, NONE)]})
    assert verdicts(h) == {"a.x": Change.UNKNOWN, "a.y": Change.SAME}


def test_correlated_parameters_together() -> None:
    """sigma and beta within their errors each, but moved against how their errors go together."""
    r = np.eye(4)
    r[0, 1] = r[1, 0] = r[2, 3] = r[3, 2] = 0.98
    change = (1.5, -1.5, 0.2, 0.2)
    h = history({n: [(5.0, 1.0), (5.0 + c, 1.0)] for n, c in zip(NAMES, change, strict=True)}, r)
    p = pair((h, 0), (h, 1))
    assert {d.verdict for d in p.differences} == {Change.SAME}
    assert p.together
    assert p.joint is not None
    assert set(p.joint.told_by) < set(NAMES[:2])
    blind = pair(
        *[
            (
                history(
                    {n: [(5.0, 1.0), (5.0 + c, 1.0)] for n, c in zip(NAMES, change, strict=True)}
                ),
                i,
            )
            for i in (0, 1)
        ]
    )
    assert blind.joint is None
    assert not blind.together


def test_wald_has_its_level() -> None:
    """Chance of a false word by counting, with a covariance that is nearly singular."""
    r = np.random.default_rng(0)
    a = r.standard_normal((5, 5))
    a[4] = a[3] + 0.01 * a[4]
    cov = a @ a.T
    root = np.linalg.cholesky(cov)
    p = [wald("abcde", root @ r.standard_normal(5), cov).p for _ in range(400)]
    assert stats.kstest(p, "uniform").pvalue > 1e-3


def test_wald_names_the_one_that_moved() -> None:
    r = np.random.default_rng(1)
    cov = 0.8 * np.ones((4, 4)) + 0.2 * np.eye(4)
    root = np.linalg.cholesky(cov)
    hits = sum(
        wald("abcd", root @ r.standard_normal(4) + [0, 0, 5.0, 0], cov).told_by[:1] == ("c",)
        for _ in range(50)
    )
    assert hits >= 45


@pytest.mark.parametrize(
    ("limit", "expected"), [(0.3, Change.APPEARED), (3.0, Change.UNKNOWN), (NONE, Change.APPEARED)]
)
def test_an_effect_appears_only_if_it_would_have_been_seen(limit: float, expected: Change) -> None:
    rows = {"backlash.g": [(NONE, NONE), (2.0, 0.1)]}
    h = history(rows, offs={"backlash.g": (0.0, limit)})
    p = pair((h, 0), (h, 1))
    assert p.differences[0].verdict is expected
    assert p.differences[0].change == 2.0
    assert p.other_effects == ("backlash.g",)


def test_an_effect_vanishes() -> None:
    h = history({"backlash.g": [(2.0, 0.1), (NONE, NONE)]}, offs={"backlash.g": (0.0, 0.3)})
    assert verdicts(h) == {"backlash.g": Change.VANISHED}


def test_an_effect_that_nobody_looked_for() -> None:
    h = history({"backlash.g": [(NONE, NONE), (2.0, 0.1)]}, offs={"backlash.g": (0.0, NONE)})
    blind = History(**{**vars(h), "searched": (False, True)})
    assert verdicts(blind) == {"backlash.g": Change.UNKNOWN}
