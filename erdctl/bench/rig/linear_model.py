"""A model that is linear in its parameters and has the paper's terms, to hold records against."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from erdctl.bench.rig.pieces import Piece
from erdctl.core.blocks import SETTLE
from erdctl.core.quantiles import median
from erdctl.core.recording import Array, Index

LEAST_RECORDS = 4
LEAST_SMOOTH = 80  # samples of a record away from reversals and duty steps, ten a parameter
STEADY = 0.02  # of the duty in a record, below which it is a level
SAMPLES, TRIED = 60_000, 8_000  # that the model is fitted to, and tried on
STEPS = 2_000  # of the duty; a control that never rests shows no lag of its own
LAGS, EXPONENTS = (0.01, 0.0, 0.03, 0.1), (0.5, 0.35, 0.7, 1.0, 1.4)  # T_d [s] and beta [1]


@dataclass(frozen=True, eq=False)
class Rows:
    """Columns (n, 8) of a stretch, its force (n,), and which samples (n,) to look at.

    settled : with a settled yield force;  smooth : of these, where the paper's force has no jump
    """

    piece: Piece
    columns: Array
    force: Array
    settled: npt.NDArray[np.bool_]
    smooth: npt.NDArray[np.bool_]

    @cached_property
    def normal(self) -> tuple[Array, Array]:
        """A' A / n (p, p) and A' F / n (p,) over the smooth samples."""
        # At reversals and after duty steps the paper's law says little of gains and zeros.
        weighted = self.columns.T * (self.smooth / max(int(np.count_nonzero(self.smooth)), 1))
        return weighted @ self.columns, weighted @ self.force

    def square_left(self, theta: Array) -> float:
        """Mean square that parameters (p,) leave of the force over the smooth samples [N^2]."""
        AA, AF = self.normal
        power = np.dot(self.force * self.smooth, self.force) / max(np.count_nonzero(self.smooth), 1)
        return max(float(power - theta @ (2.0 * AF - AA @ theta)), 0.0)


def first_of_each(found: Sequence[Piece]) -> list[Piece]:
    """One stretch of every record, all together of so many samples as the model needs."""
    first: dict[int, Piece] = {}
    for p in found:
        first.setdefault(p.record, p)
    keep = min(1.0, SAMPLES / sum(len(p) for p in first.values()))
    return [
        replace(p, end=p.first + max(int(keep * len(p)), min(len(p), 400))) for p in first.values()
    ]


@dataclass(frozen=True, eq=False)
class _Held:
    """The duty of stretches, one after the other, as levels that are held.

    level : (k,) duties [1];  first : (k,) whether a stretch begins with it, settled;  lasts : (k,)
        [s];  of, since : (n,) the level of each sample, and the time since it was set [s]
    """

    level: Array
    first: npt.NDArray[np.bool_]
    lasts: Array
    of: Index
    since: Array

    @classmethod
    def within(cls, found: Sequence[Piece], every: int) -> _Held:
        parts, count = [], 0
        for p in found:
            duty, steps = p.of("duty"), p.duty_steps
            if len(steps) > STEPS:
                # As if settled, every sample for itself.
                level = duty[::every]
                k = np.arange(len(level))
                part = (level, k >= 0, np.zeros(len(k)), count + k, np.zeros(len(k)))
            else:
                set_at = np.concatenate([[0], steps])
                samples = np.diff(set_at, append=len(duty))
                k = np.repeat(np.arange(len(set_at)), samples)[::every]
                since = p.step * (np.arange(1, len(duty) + 1, every) - set_at[k])
                part = (duty[set_at], set_at == 0, p.step * samples, count + k, since)
            parts.append(part)
            count += len(part[0])
        return cls(*(np.concatenate(c) for c in zip(*parts, strict=True)))

    def yield_force(self, T_d: float, beta: float) -> Array:
        """(n,) yield force of Eqs. 12 and 18 for sigma = 1."""
        held = self.level**beta
        if T_d == 0.0 or self.first.all():
            return np.asarray(held[self.of])
        # Step by step, without a filter of SciPy, whose import takes longer than all checks.
        kept = np.exp(-self.lasts / T_d)
        away = np.zeros(len(held))  # of the force from what it tends to, where a step is made
        for k in np.flatnonzero(~self.first).tolist():
            away[k] = away[k - 1] * kept[k - 1] + held[k - 1] - held[k]
        return np.asarray(held[self.of] + away[self.of] * np.exp(-self.since / T_d))


def _rows(p: Piece, T_d: float, beta: float, every: int = 1) -> Rows:
    """Columns of a stretch: a constant; x, xdot and yield force in either direction; friction."""
    x, xdot, t = p.x[::every], p.xdot[::every], p.t[::every]
    up = xdot > 0
    field = _Held.within([p], every).yield_force(T_d, beta)
    # Column by column in memory: sums of products and products with parameters run along them.
    columns = np.empty((8, len(x)))
    columns[0] = 1.0
    for k, values in ((1, x), (3, xdot), (5, field)):
        np.multiply(values, up, out=columns[k])
        np.subtract(values, columns[k], out=columns[k + 1])
    np.negative(columns[6], out=columns[6])
    columns[7] = 2.0 * up - 1.0
    settled = t - t[0] > min(SETTLE, 0.1 * float(t[-1] - t[0]))
    return Rows(p, columns.T, p.force[::every], settled, settled & ~p.near[::every])


def best_rows(found: Sequence[Piece]) -> list[Rows]:
    """Rows for the lag and the exponent that suit most records best.

    By the sum of the logarithms of their misfits, so that a single record does not decide. Without
    records that are hardly ever away from a reversal or a step of the duty, as in a closed loop:
    they tell the parameters by chance, of all records or of none.
    """
    if len(found) < LEAST_RECORDS:
        return []
    every = -(-sum(len(p) for p in found) // TRIED)
    control = any(np.ptp(p.of("duty")) > 0 for p in found)
    field = any(p.of("duty").any() for p in found)
    if control or field:
        trial = _Trial.of(found, every)
    # One after the other: the lag shows after duty steps, the exponent between the levels.
    beta = min(EXPONENTS, key=lambda b: trial.cost(LAGS[0], b)) if field else EXPONENTS[0]
    T_d = min(LAGS, key=lambda T: trial.cost(T, beta)) if control else LAGS[0]
    rows = [_rows(p, T_d, beta) for p in found]
    return [r for r in rows if np.count_nonzero(r.smooth) >= LEAST_SMOOTH]


@dataclass(frozen=True, eq=False)
class _Trial:
    """Some samples of all records in one array, on which lags and exponents are tried.

    columns (n, p), force (n,), duty : of all records, one after the other; the columns of the
        yield force are those of the last trial
    weights : (n,) with which every record counts alike;  starts : (k,) where each begins
    """

    columns: Array
    force: Array
    duty: _Held
    weights: Array
    starts: Index

    @classmethod
    def of(cls, found: Sequence[Piece], every: int) -> _Trial:
        rows = [_rows(p, 0.0, 1.0, every) for p in found]
        weights = [r.smooth / max(int(np.count_nonzero(r.smooth)), 1) for r in rows]
        sizes = [len(r.force) for r in rows]
        return cls(
            np.concatenate([r.columns.T for r in rows], axis=1).T,
            np.concatenate([r.force for r in rows]), _Held.within(found, every),
            np.concatenate(weights), np.cumsum([0, *sizes[:-1]]),
        )  # fmt: skip

    def cost(self, T_d: float, beta: float) -> float:
        """Sum of the logarithms of the records' misfits."""
        field = self.duty.yield_force(T_d, beta)
        A = self.columns
        A[:, 5] = field * (A[:, 7] > 0)
        A[:, 6] = -field * (A[:, 7] < 0)
        weighted = A.T * self.weights
        rest = self.force - A @ _solved(weighted @ A, weighted @ self.force)
        sizes = np.diff(self.starts, append=len(rest))
        mean = np.add.reduceat(rest, self.starts) / sizes
        square = np.add.reduceat((rest - np.repeat(mean, sizes)) ** 2, self.starts) / sizes
        return float(np.sum(np.log(np.maximum(np.sqrt(square), 1e-12))))


def model(rows: Sequence[Rows]) -> Array:
    """Parameters (p,) by least squares, every record counting alike; 0 where nothing tells."""
    AA, AF = (sum(part) for part in zip(*(r.normal for r in rows), strict=True))
    return _solved(np.asarray(AA), np.asarray(AF))


def of_others(rows: Sequence[Rows], index: int) -> Array:
    """The same of all records but one."""
    return model([r for i, r in enumerate(rows) if i != index])


def _solved(AA: Array, AF: Array) -> Array:
    scale = np.sqrt(np.diag(AA))
    unit = np.where(scale > 0, 1.0 / np.where(scale > 0, scale, 1.0), 0.0)
    inverse = np.linalg.pinv(AA * np.outer(unit, unit), rcond=1e-9, hermitian=True)
    return np.asarray(unit * (inverse @ (unit * AF)))


def steady(rows: Sequence[Rows]) -> bool:
    """Whether the duty is held in every record."""
    return all(np.ptp(r.piece.of("duty")) < STEADY for r in rows)


def levels_and_motion(rows: Sequence[Rows]) -> Array | None:
    """(k, p) level of the duty, log speed and log stroke of records in which it is held.

    None if there are too many levels for a trend.
    """
    at = np.array([round(median(r.piece.of("duty")), 2) for r in rows])
    levels = np.array(sorted(set(at.tolist())))
    if len(levels) > len(rows) // 2:
        return None
    motion = np.log([
        [max(float(np.std(v)), 1e-12) for v in (r.piece.xdot, r.piece.x)] for r in rows
    ])  # fmt: skip
    return np.column_stack([at[:, None] == levels, motion]).astype(np.float64)
