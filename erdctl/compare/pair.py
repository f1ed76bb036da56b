"""Two states of a damper: which parameters differ by more than their errors, alone or together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from math import isfinite, sqrt

import numpy as np
from scipy import stats

from erdctl.compare.history import Covariance, History
from erdctl.core.recording import Array

SURE = 0.05  # chance that a pair tells any change of its parameters where there is none
NORMAL_95 = 1.96


class Change(Enum):
    """What became of one parameter."""

    CHANGED = "changed"
    SAME = "within its error"
    UNKNOWN = "cannot tell"
    APPEARED = "appeared"
    VANISHED = "vanished"


@dataclass(frozen=True, kw_only=True)
class ToldValue:
    """One parameter by one log; value, stderr, low, high are NaN where there is none.

    off, limit : of an effect, the value at which it is absent, and the size from which it would
    have been named;  looked : whether somebody looked for it
    """

    unit: str
    value: float
    stderr: float
    low: float
    high: float
    off: float | None = None
    limit: float = float("nan")
    looked: bool = True

    @property
    def named(self) -> bool:
        """Whether there is a value."""
        return isfinite(self.value)

    def error(self, upwards: bool) -> float:
        """Standard error to one side; NaN where none is known."""
        end = self.high if upwards else self.low
        if isfinite(self.low) and isfinite(self.high) and self.low < self.high:
            half = abs(end - self.value) / NORMAL_95
            return half or (self.high - self.low) / (2 * NORMAL_95)
        return self.stderr

    @property
    def interval(self) -> tuple[float, float]:
        """95 %, NaN where no error is known; of an effect that is not named, off to its limit."""
        if not self.named and self.off is not None:
            return self.off, self.limit if self.looked else float("nan")
        if isfinite(self.low) and isfinite(self.high):
            return self.low, self.high
        return self.value - NORMAL_95 * self.stderr, self.value + NORMAL_95 * self.stderr


@dataclass(frozen=True, kw_only=True)
class Difference:
    """One parameter in both states.

    change, error : after less before, and its standard error, NaN where not known
    p : that it is chance, all parameters of the pair counted (Holm)
    """

    name: str
    unit: str
    before: ToldValue
    after: ToldValue
    change: float
    error: float
    p: float
    verdict: Change


@dataclass(frozen=True, kw_only=True)
class Joint:
    """All shared parameters together.

    statistic : d' S^-1 d with the covariance S of the difference d, chi2 of `dof`;  p : of chance
    told_by : the fewest parameters whose change alone explains all differences within their errors
    """

    statistic: float
    dof: int
    p: float
    told_by: tuple[str, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class Pair:
    """Two logs, of one damper or of two.

    joint : None where the files tell no covariance, or too little is shared
    other_effects : effects that only one of both models has
    """

    before: tuple[History, int]
    after: tuple[History, int]
    differences: tuple[Difference, ...]
    joint: Joint | None
    other_effects: tuple[str, ...]

    @property
    def told(self) -> bool:
        """Whether an error of any difference is known, against which it can be held."""
        return any(d.error > 0.0 for d in self.differences)

    @property
    def changes(self) -> list[Difference]:
        """What is beyond its error, the surest first."""
        told = (Change.CHANGED, Change.APPEARED, Change.VANISHED)
        return sorted((d for d in self.differences if d.verdict in told), key=lambda d: d.p)

    @property
    def together(self) -> bool:
        """Whether the parameters differ only if they are judged together."""
        alone = any(d.verdict is Change.CHANGED for d in self.differences)
        return self.joint is not None and self.joint.p <= SURE and not alone


def told_by(history: History, log: int) -> dict[str, ToldValue]:
    """All that one log of a damper says."""
    out = {}
    for name, s in history.series.items():
        found = np.flatnonzero(s.at == log)
        if not len(found):
            continue
        i = int(found[0])
        limit = float(s.limit[i]) if len(s.limit) else float("nan")
        looked = not history.searched or history.searched[log]
        out[name] = ToldValue(
            unit=s.unit, value=float(s.value[i]), stderr=float(s.stderr[i]), low=float(s.low[i]),
            high=float(s.high[i]), off=s.off, limit=limit, looked=looked,
        )  # fmt: skip
    return out


def pair(before: tuple[History, int], after: tuple[History, int]) -> Pair:
    """The differences between two logs."""
    a, b = told_by(*before), told_by(*after)
    names = [n for n in {**a, **b} if n in a or n in b]
    raw = {n: _difference(n, *_both(a.get(n), b.get(n), before, after)) for n in names}
    raw = {n: d for n, d in raw.items() if d.before.named or d.after.named}
    holm = _holm({n: d.p for n, d in raw.items() if isfinite(d.p)})
    found = tuple(_judged(d, holm.get(n)) for n, d in raw.items())
    first, second = _effects(before), _effects(after)
    return Pair(
        before=before, after=after, differences=found, joint=_joint(found, before, after),
        other_effects=tuple(sorted(first ^ second)),
    )  # fmt: skip


def _effects(state: tuple[History, int]) -> frozenset[str]:
    history, log = state
    return history.effects[log] if history.effects else frozenset()


def _both(
    a: ToldValue | None,
    b: ToldValue | None,
    before: tuple[History, int],
    after: tuple[History, int],
) -> tuple[ToldValue, ToldValue]:
    """Either state's word; of a state that says nothing of it, that there is no value."""
    some = a or b
    assert some is not None

    def absent(state: tuple[History, int]) -> ToldValue:
        history, log = state
        nan = float("nan")
        looked = bool(history.searched[log]) if history.searched else False
        return ToldValue(
            unit=some.unit, value=nan, stderr=nan, low=nan, high=nan, off=some.off, looked=looked
        )

    return a or absent(before), b or absent(after)


def _difference(name: str, a: ToldValue, b: ToldValue) -> Difference:
    nan = float("nan")
    change = error = p = nan
    if a.named and b.named:
        change = b.value - a.value
        error = sqrt(a.error(change > 0) ** 2 + b.error(change < 0) ** 2)
        if change == 0.0 and not error > 0.0:
            p = 1.0
        elif error > 0.0:
            p = float(2.0 * stats.norm.sf(abs(change) / error))
    elif a.off is not None:
        # The absent one has its off value; how large it may be all the same is its limit's matter.
        there = b if b.named else a
        change = (there.value - a.off) * (1.0 if b.named else -1.0)
        error = there.error(there.value < a.off)
        gone = a if b.named else b
        within = isfinite(gone.limit) and abs(there.value - a.off) <= abs(gone.limit - a.off)
        if error > 0.0 and not within and gone.looked:
            margin = abs(gone.limit - a.off) if isfinite(gone.limit) else 0.0
            p = float(stats.norm.sf((abs(there.value - a.off) - margin) / error))
    return Difference(
        name=name, unit=a.unit, before=a, after=b, change=change, error=error, p=p,
        verdict=Change.UNKNOWN,
    )  # fmt: skip


def _judged(d: Difference, p: float | None) -> Difference:
    from dataclasses import replace

    if p is None:
        return d
    verdict = Change.SAME
    if p <= SURE:
        verdict = Change.CHANGED
        if not d.before.named:
            verdict = Change.APPEARED
        elif not d.after.named:
            verdict = Change.VANISHED
    elif not (d.before.named and d.after.named):
        verdict = Change.UNKNOWN
    return replace(d, p=p, verdict=verdict)


def _holm(p: Mapping[str, float]) -> dict[str, float]:
    """Each p for the whole family: the smallest counts as many times as there are, and so on.

    Check: 0.01, 0.04 and 0.5 become 0.03, 0.08 and 0.5.
    >>> {k: round(v, 2) for k, v in _holm({"a": 0.04, "b": 0.01, "c": 0.5}).items()}
    {'b': 0.03, 'a': 0.08, 'c': 0.5}
    """
    out: dict[str, float] = {}
    top = 0.0
    for i, (name, value) in enumerate(sorted(p.items(), key=lambda item: item[1])):
        top = max(top, min(1.0, (len(p) - i) * value))
        out[name] = top
    return out


def _joint(
    found: Sequence[Difference], before: tuple[History, int], after: tuple[History, int]
) -> Joint | None:
    """The test of Wald; None unless both files tell how their errors go together."""
    a, b = (h.covariances.get(i) for h, i in (before, after))
    if a is None or b is None:
        return None
    shared = {*a.names} & {*b.names}
    some = [
        d for d in found if d.name in shared and d.before.stderr > 0.0 and d.after.stderr > 0.0
        and d.before.named and d.after.named
    ]  # fmt: skip
    if len(some) < 2:
        return None
    names = [d.name for d in some]
    s = _scaled(a, names, [d.before.stderr for d in some])
    s = s + _scaled(b, names, [d.after.stderr for d in some])
    return wald(names, np.array([d.change for d in some]), s)


def _scaled(found: Covariance, names: list[str], errors: list[float]) -> Array:
    at = [found.names.index(n) for n in names]
    return np.asarray(found.correlation[np.ix_(at, at)] * np.outer(errors, errors))


def wald(names: Sequence[str], change: Array, covariance: Array) -> Joint:
    """Whether a vector of differences is chance.

        W = d' S^-1 d,   chi2 with as many degrees of freedom as there are differences

    change : (p,);  covariance : (p, p)
    Then the fewest of them: one by one the parameter whose own change takes most of W, until what
    is left is chance.
    Check: 2 and -2 with unit variances and a correlation of 0.5 have W = 16, where without it
    W would be 8; both are needed.
    >>> j = wald(["a", "b"], np.array([2.0, -2.0]), np.array([[1.0, 0.5], [0.5, 1.0]]))
    >>> round(j.statistic, 6), j.told_by
    (16.0, ('a', 'b'))
    """
    scale = np.sqrt(np.diag(covariance))
    inverse = np.linalg.pinv(covariance / np.outer(scale, scale), rcond=1e-10, hermitian=True)
    d = change / scale
    whole = rest = float(d @ inverse @ d)
    p = float(stats.chi2.sf(whole, len(d)))
    chosen: list[int] = []
    while p <= SURE and len(chosen) < len(d):
        if stats.chi2.sf(rest, len(d) - len(chosen)) > SURE:
            break
        left = {i: _rest(d, inverse, [*chosen, i]) for i in range(len(d)) if i not in chosen}
        best = min(left, key=lambda i: left[i])
        chosen.append(best)
        rest = left[best]
    return Joint(statistic=whole, dof=len(d), p=p, told_by=tuple(names[i] for i in sorted(chosen)))


def _rest(d: Array, inverse: Array, free: list[int]) -> float:
    """W when the changes of some parameters are whatever suits the others best."""
    g = inverse @ d
    block = inverse[np.ix_(free, free)]
    return float(d @ g - g[free] @ np.linalg.pinv(block, hermitian=True) @ g[free])
