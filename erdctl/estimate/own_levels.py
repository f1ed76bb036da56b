"""Errors where each record has a gain and a zero of its own, estimated beside what is shared.

    F = g_r m + o_r + noise,   of all known records the mean g_r is 1 and the mean o_r is 0

What the records scatter by is taken out of the shared parameters' noise; but that these records'
mean is the damper's is no more than their number makes it: s^2 / r of each kind stays with what
moves as all gains, or all zeros, together.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array
from erdctl.estimate.normal_equations import Normal
from erdctl.estimate.record_scatter import RecordSums, stretch

ROUNDS = 50  # of the iteration for a variance, which settles within a few


class OwnLevels(NamedTuple):
    """What records have of their own, of each kind (gain, zero) that is free: (k,) its column.

    value, error : (k, r) deviation from the mean, shrunk by its error, and that by noise; the error
        is infinite where a record does not determine the value. Gains are over the mean gain.
    """

    kinds: tuple[int, ...]
    value: Array
    error: Array

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """(k, r) which are determined."""
        return np.isfinite(self.error)

    def variance(self, k: int) -> float:
        """Of the records' values of one kind, beyond what noise makes of them.

            s^2 = sum d^2 / (r - 1) + mean of s^2 e^2 / (s^2 + e^2)

        d : values shrunk to the mean by s^2 / (s^2 + e^2), which leaves these variances.
        """
        d, e2 = self.value[k][self.known[k]], self.error[k][self.known[k]] ** 2
        if len(d) < 2 or not d.any():
            return 0.0
        seen = float(d @ d) / (len(d) - 1)
        s2 = seen
        for _ in range(ROUNDS):
            s2 = seen + float(np.mean(s2 * e2 / (s2 + e2)))
        return s2


def covariance(
    records: Sequence[RecordSums], levels: OwnLevels, rough: Array
) -> tuple[Array, Array]:
    """(p, p) covariance of the shared parameters, and (k, r) errors of the records' own values.

    rough : (p,) factors of the errors by noise, see `erdctl.estimate.sandwich`
    """
    p, count, many = len(rough), len(records), len(levels.kinds)
    normal = _bordered([r.normal for r in records], levels, p)
    meat = _bordered([r.meat for r in records], levels, p)
    into = _contrasts(p, levels.known)
    inverse = into @ Normal.of(into.T @ normal @ into).pseudo_inverse() @ into.T
    all_ = inverse @ meat @ inverse
    error = np.sqrt(np.maximum(np.diag(all_)[p:], 0.0)).reshape(many, count)
    within = all_[:p, :p] * np.outer(rough, rough)
    total, doubt = within, np.zeros(p)
    for k in range(many):
        known = int(np.count_nonzero(levels.known[k]))
        if known < 2:
            continue
        together = np.zeros(len(normal))
        together[p + k * count : p + (k + 1) * count] = 1.0
        moved = (inverse @ normal @ together)[:p]
        variance = levels.variance(k) / known
        total = total + variance * np.outer(moved, moved)
        doubt += 2.0 / (known - 1) * (variance * moved**2) ** 2
    return np.asarray(total * stretch(np.diag(total), doubt)), np.where(levels.known, error, np.inf)


def _bordered(sums: Sequence[Array], levels: OwnLevels, p: int) -> Array:
    """Products of rows of all parameters; those of one record are 0 in the others."""
    count, many = len(sums), len(levels.kinds)
    out = np.zeros((p + many * count, p + many * count))
    out[:p, :p] = np.sum([s[:p, :p] for s in sums], axis=0)
    at = np.arange(count)
    for k, a in enumerate(levels.kinds):
        here = p + k * count
        border = np.stack([s[:p, p + a] for s in sums], axis=1)
        out[:p, here : here + count], out[here : here + count, :p] = border, border.T
        for j, b in enumerate(levels.kinds):
            out[here + at, p + j * count + at] = [s[p + a, p + b] for s in sums]
    return out


def _contrasts(shared: int, known: npt.NDArray[np.bool_]) -> Array:
    """All parameters from free ones: of each kind those of known records, which add up to 0."""
    kinds, records = known.shape
    columns = [np.eye(shared + kinds * records)[:, :shared]]
    for k in range(kinds):
        at = shared + k * records + np.flatnonzero(known[k])
        centred = np.eye(len(at)) - 1.0 / max(len(at), 1)
        basis = np.zeros((shared + kinds * records, max(len(at) - 1, 0)))
        basis[at] = np.linalg.svd(centred)[0][:, : basis.shape[1]]
        columns.append(basis)
    return np.concatenate(columns, axis=1)
