"""GroupSums that scores are made of, over one stretch of a log after the other."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array, Index

Codes = npt.NDArray[np.integer[Any]]


class GroupSums(NamedTuple):
    """What is kept of a measured force F and an error e in each of k groups of samples.

    samples, squares : (k,) number, sum of e^2 [N^2]
    low, high : (k,) of F [N], inf and -inf of none;  size : (k,) sum of |F| [N]
    mean, spread : (k,) mean of F [N], sum of its squared distances from that [N^2]
    """

    samples: Array
    squares: Array
    low: Array
    high: Array
    mean: Array
    spread: Array
    size: Array

    def at(self, codes: Codes | Index, groups: int) -> GroupSums:
        """The same with each group counted to another, of so many.

        codes : (k,) which.  The spread of groups together is that within each and that of their
        means, so that no large sums cancel.
        Check: F = 1 and 3 in two groups: together mean 2, spread 2.
        >>> one = over(np.array([0, 1]), np.array([1.0, 3.0]), np.zeros(2)).at(np.zeros(2, int), 1)
        >>> one.mean.tolist(), one.spread.tolist(), one.high.tolist()
        ([2.0], [2.0], [3.0])
        """

        def summed(values: Array) -> Array:
            return np.bincount(codes, values, groups).astype(np.float64, copy=False)

        low, high = np.full(groups, np.inf), np.full(groups, -np.inf)
        np.minimum.at(low, codes, self.low)
        np.maximum.at(high, codes, self.high)
        samples = summed(self.samples)
        mean = summed(self.samples * self.mean) / np.maximum(samples, 1.0)
        away = self.mean - mean[codes]
        spread = summed(self.spread + self.samples * away * away)
        return GroupSums(samples, summed(self.squares), low, high, mean, spread, summed(self.size))

    def behind(self, first: GroupSums) -> GroupSums:
        """Groups of two kinds, the others first."""
        return GroupSums(*(np.concatenate(pair) for pair in zip(first, self, strict=True)))

    def added(self, codes: Codes | Index, more: GroupSums) -> GroupSums:
        """With those of other samples, which are counted to the groups that `codes` says."""
        groups = len(self.samples)
        return more.behind(self).at(np.concatenate([np.arange(groups), codes]), groups)


def none(groups: int) -> GroupSums:
    """Of no samples."""
    zero = np.zeros(groups)
    return GroupSums(zero, zero, zero + np.inf, zero - np.inf, zero, zero, zero)


def over(first: Index, force: Array, error: Array) -> GroupSums:
    """Of runs of samples that begin at `first` (k,), up to the next one or to the end.

    force, error : (n,) [N]
    """
    length = np.diff(first, append=len(force)).astype(np.float64)
    mean = np.add.reduceat(force, first) / length
    away = force - np.repeat(mean, length.astype(np.intp))
    return GroupSums(
        length,
        np.add.reduceat(error * error, first),
        np.minimum.reduceat(force, first),
        np.maximum.reduceat(force, first),
        mean,
        np.add.reduceat(away * away, first),
        np.add.reduceat(np.abs(force), first),
    )


def by(code: Codes, force: Array, error: Array) -> tuple[Codes, GroupSums]:
    """Of samples that have the same code (n,) next to each other; and that of each (k,)."""
    first = _changes(code)
    if 4 * len(first) > len(code):
        # Whole numbers of 16 bits are sorted in one go over the digits.
        order = np.argsort(code, kind="stable")
        code, force, error = code[order], force[order], error[order]
        first = _changes(code)
    return code[first], over(first, force, error)


def _changes(code: Codes) -> Index:
    return np.concatenate([[0], np.flatnonzero(code[1:] != code[:-1]) + 1]).astype(np.intp)
