"""Many linear models of one series at once, by a loss that outliers and unnamed effects bend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr

from erdctl.compare.history import Flags
from erdctl.core.recording import Array

BEND = 2.0  # spreads from which on the loss grows in proportion (Huber)
ROUNDS = 60
DONE = 1e-4  # of the loss
FAR = 20.0  # beyond the best loss, where a model is out of the question


@dataclass(frozen=True, eq=False, kw_only=True)
class Data:
    """A series as it is fitted.

    t : (n,) [days];  value, spread : (n,), value finite everywhere
    named : (n,); where not, all that is known is that low < value < high
    """

    t: Array
    value: Array
    spread: Array
    named: Flags
    low: Array
    high: Array

    def __len__(self) -> int:
        return len(self.t)


def fit(data: Data, models: Array, fixed: float = 0.0) -> tuple[Array, Array]:
    """Coefficients (c, k) and losses (c,) of models (c, n, k) on top of a fixed value.

        loss = sum of 2 rho(z) over named logs, -2 log P(low < y < high) over the others
        rho(z) = z^2 / 2 up to BEND, BEND |z| - BEND^2 / 2 beyond,   z = (y - f) / spread

    By weighted least squares over and over; a value that is not named is in each round the mean
    that the model of the round before expects of it (expectation, maximisation).
    """
    c, n, k = models.shape
    s, y = data.spread, data.value - fixed
    coefficients = np.zeros((c, k))
    if not k:
        return coefficients, _loss(data, np.zeros((c, n)) + fixed)
    f = np.broadcast_to(np.median(y[data.named]) if data.named.any() else 0.0, (c, n))
    before = np.full(c, np.inf)
    ridge = 1e-12 * np.eye(k)
    for _ in range(ROUNDS):
        target, weight = _expected(data, f + fixed)
        w = weight / s**2
        xw = models * w[:, :, None]
        a = np.einsum("cni,cnj->cij", xw, models)
        b = np.einsum("cni,cn->ci", xw, target - fixed)
        scale = np.sqrt(np.maximum(np.einsum("cii->ci", a), np.finfo(float).tiny))
        a = a / (scale[:, :, None] * scale[:, None, :]) + ridge
        coefficients = np.linalg.solve(a, (b / scale)[:, :, None])[:, :, 0] / scale
        f = np.einsum("cnk,ck->cn", models, coefficients)
        loss = _loss(data, f + fixed)
        # Models that are far from the best need no last digit.
        still = np.abs(before - loss) > DONE * (1.0 + np.abs(loss))
        if not (still & (loss < loss.min() + FAR)).any():
            break
        before = loss
    return coefficients, loss


def _expected(data: Data, f: Array) -> tuple[Array, Array]:
    """What the models f (c, n) make of each log: its value, and its weight by the loss."""
    z = (data.value - f) / data.spread
    weight = np.minimum(1.0, BEND / np.maximum(np.abs(z), 1e-300))
    target = np.broadcast_to(data.value, f.shape)
    if data.named.all():
        return target, weight
    out, unnamed = target.copy(), ~data.named
    f, s, low, high = f[:, unnamed], data.spread[unnamed], data.low[unnamed], data.high[unnamed]
    a, b = (low - f) / s, (high - f) / s
    shift = (_density(a) - _density(b)) / np.maximum(np.exp(_log_mass(a, b)), 1e-300)
    out[:, unnamed] = np.clip(f + s * shift, low, high)
    return out, np.where(data.named, weight, 1.0)


def _loss(data: Data, f: Array) -> Array:
    z = np.abs(data.value - f) / data.spread
    seen = np.where(z < BEND, z**2, 2 * BEND * z - BEND**2)
    if data.named.all():
        return np.asarray(seen.sum(axis=1))
    unnamed = ~data.named
    f, s = f[:, unnamed], data.spread[unnamed]
    a, b = (data.low[unnamed] - f) / s, (data.high[unnamed] - f) / s
    # An outlier counts here as it does there: named where it should not be, or not where it should.
    unseen = np.minimum(-2.0 * _log_mass(a, b), 2 * BEND * np.maximum(np.abs(a), np.abs(b)))
    return np.asarray(seen[:, data.named].sum(axis=1) + unseen.sum(axis=1))


def _log_mass(a: Array, b: Array) -> Array:
    """log(Phi(b) - Phi(a)), a < b, also far out."""
    flip = a > 0
    low, high = np.where(flip, -b, a), np.where(flip, -a, b)
    top, bottom = log_ndtr(high), log_ndtr(low)
    return np.asarray(top + np.log1p(-np.exp(np.minimum(bottom - top, -1e-12))))


def _density(z: Array) -> Array:
    return np.asarray(np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi))
