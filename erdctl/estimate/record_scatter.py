"""How much records differ by more than noise, and what that costs the shared parameters.

    F = g_r m + o_r + noise,   g_r ~ (1, s_g^2),   o_r ~ (0, s_o^2)

m : force of the model [N];  g_r, o_r : gain and zero of the force in record r [1], [N]. Tests on
different days, a load cell warmed up, a damper clamped anew scatter so; noise within a record says
nothing of it. The variances come by maximum likelihood from what a fit leaves of gain and zero in
each record, q = B' W r with B the columns m and 1 of each record: free of the parameters, as in
REML, since r is what their fit leaves.

Source: H. D. Patterson, R. Thompson, Biometrika 58 (1971) 545-554 (restricted likelihood);
F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110-114 (degrees of freedom of a sum).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from erdctl.core.recording import Array
from erdctl.model.parameters import NORMAL_95

KINDS = 2  # of columns that scatter: the model's force and one
MOST = 120  # records that the variances are estimated from, evenly chosen
DETERMINED = 1e-6  # part, and relative eigenvalue, below which the parameters leave nothing of it
LEAST = 1e-3  # standard deviation that is looked at, over its error by noise
ROUNDED = 1e-6  # relative eigenvalue of the noise in these sums below which it is rounding
NOTHING = 1e-2  # variance, over that by noise, that is none


class RecordSums(NamedTuple):
    """What one record contributes, with the rows R = (p derivatives, m, 1) times the root weight.

    normal : (p + 2, p + 2) R R';  score : (p + 2,) R u, u the weighted residual
    meat : (p + 2, p + 2) R C R', C the covariance of u
    """

    normal: Array
    score: Array
    meat: Array


def covariance(records: Sequence[RecordSums], inverse: Array, rough: Array) -> Array:
    """(p, p) covariance of the shared parameters, whose 1.96 standard errors hold 95 %.

    inverse : (p, p) of J'WJ of all records;  rough : (p,) factors of the errors by noise alone
    A variance that few records tell makes intervals of Student's t: the errors are larger by the
    ratio of its quantile to that of a normal distribution.
    """
    p = len(inverse)
    meat = np.sum([r.meat for r in records], axis=0)[:p, :p]
    within = np.asarray(inverse @ meat @ inverse * np.outer(rough, rough))
    if len(records) < 2:
        return within
    # What a unit of gain or zero in each record moves the parameters by: (p, 2, r).
    moved = np.stack([inverse @ r.normal[:p, p:] for r in records], axis=-1)
    chosen = np.unique(np.linspace(0, len(records) - 1, min(len(records), MOST)).astype(int))
    variance, uncertain = _variances(
        [records[i] for i in chosen], moved[:, :, chosen], meat, inverse
    )
    between = np.einsum("pkr,qkr->kpq", moved, moved)
    total = within + np.einsum("k,kpq->pq", variance, between)
    parts = np.einsum("kpp->pk", between)
    doubt = np.einsum("pk,kl,pl->p", parts, uncertain, parts)
    return np.asarray(total * stretch(np.diag(total), doubt))


def stretch(variance: Array, doubt: Array) -> Array:
    """(p, p) factors of a covariance whose variances (p,) have a variance (p,) too."""
    from scipy.stats import t

    known = (doubt > 0.0) & (variance > 0.0)
    freedom = np.where(known, 2.0 * variance**2 / np.where(known, doubt, 1.0), np.inf)
    factor = np.where(known, t.ppf(0.975, np.maximum(freedom, 1.0)) / NORMAL_95, 1.0)
    return np.asarray(np.outer(factor, factor))


def _variances(
    records: Sequence[RecordSums], moved: Array, meat: Array, inverse: Array
) -> tuple[Array, Array]:
    """Variances of gain and zero (2,), and the (2, 2) covariance of these estimates."""
    from scipy.optimize import minimize

    p, count = len(meat), len(records)
    kinds = [k for k in range(KINDS) if _left(records, moved, k) > DETERMINED]
    of, many = np.add(p, kinds), len(kinds) * count
    if not kinds:
        return np.zeros(KINDS), np.zeros((KINDS, KINDS))
    # Indices run over kinds first: gains of all records, then zeros.
    q = np.array([[r.score[k] for r in records] for k in of]).ravel()
    to = moved[:, kinds].reshape(p, many)  # N^-1 J' B
    across = np.stack([r.normal[:p, of] for r in records], axis=-1).reshape(p, many)
    noisy = np.stack([r.meat[:p, of] for r in records], axis=-1).reshape(p, many)
    left = -across.T @ to
    noise = to.T @ meat @ to - to.T @ noisy - noisy.T @ to
    at = np.arange(count)
    for k, row in enumerate(of):
        for j, column in enumerate(of):
            here = np.ix_(k * count + at, j * count + at)
            left[here] += np.diag([r.normal[row, column] for r in records])
            noise[here] += np.diag([r.meat[row, column] for r in records])
    # By the whole columns: by what is left of each, one of which only rounding is would count, too.
    scale = np.sqrt([max(r.normal[k, k], 0.0) for k in of for r in records])
    scale = np.where(scale > 0.0, scale, 1.0)
    w, v = np.linalg.eigh(left / np.outer(scale, scale))
    v = (v / scale[:, None])[:, w > DETERMINED * w[-1]]
    q, noise = v.T @ q, v.T @ noise @ v
    if not np.trace(noise) > 0.0:
        return np.zeros(KINDS), np.zeros((KINDS, KINDS))  # a force without noise: no scatter either
    size = np.sqrt(np.maximum(np.diag(noise), 1e-12 * np.trace(noise) / max(len(noise), 1)))
    e, u = np.linalg.eigh(noise / np.outer(size, size))
    u = u * size[:, None]
    noise = (u * np.maximum(e, ROUNDED * e[-1])) @ u.T
    shares = [v.T @ left[:, k * count : (k + 1) * count] for k in range(len(kinds))]
    spread = np.stack([s @ s.T for s in shares])
    # A standard deviation of a record's value by noise alone is the unit of the search.
    unit = np.array([np.trace(noise) / max(np.trace(s), 1e-300) for s in spread])

    def cost(logs: Array) -> float:
        V = noise + np.einsum("k,kij->ij", unit * np.exp(2.0 * logs), spread)
        try:
            root = np.linalg.cholesky(V)
        except np.linalg.LinAlgError:
            return 1e300  # rounding; no variance is looked for where it does that
        z = np.linalg.solve(root, q)
        return float(2.0 * np.log(np.diag(root)).sum() + z @ z)

    # No more than would alone make ten times what was found.
    most = 10.0 * float(q @ q) / np.array([max(np.trace(s), 1e-300) for s in spread]) / unit
    low, highs = np.log(LEAST), np.maximum(0.5 * np.log(np.maximum(most, 1.0)), 1.0)
    grids = [np.linspace(low, high, 9) for high in highs]
    start = min(product(*grids), key=lambda u: cost(np.array(u)))
    found = minimize(cost, start, method="Nelder-Mead", bounds=[(low, h) for h in highs])
    variance = unit * np.exp(2.0 * np.asarray(found.x))
    seen = variance > NOTHING * unit
    certain = np.linalg.inv(noise + np.einsum("k,kij->ij", variance, spread))
    weighed = np.stack([certain @ s for s in spread])
    information = 0.5 * np.einsum("kij,lji->kl", weighed, weighed)
    told = [k for k, is_seen in zip(kinds, seen, strict=True) if is_seen]
    found_of, uncertain = np.zeros(KINDS), np.zeros((KINDS, KINDS))
    found_of[told] = variance[seen]
    uncertain[np.ix_(told, told)] = np.linalg.pinv(information[np.ix_(seen, seen)], hermitian=True)
    return found_of, uncertain


def _left(records: Sequence[RecordSums], moved: Array, kind: int) -> float:
    """Part of the columns of one kind, in all records, that no parameter makes up for.

    Where they make up for all of it, as two directions with a yield force each do for the zeros of
    two records, what is left is rounding, and says nothing of a scatter.
    """
    p = len(moved)
    whole = sum(r.normal[p + kind, p + kind] for r in records)
    made = sum(r.normal[:p, p + kind] @ moved[:, kind, i] for i, r in enumerate(records))
    return float((whole - made) / whole) if whole > 0.0 else 0.0
