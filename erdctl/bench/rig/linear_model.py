"""A model that is linear in its parameters and has the paper's terms, to hold records against."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.bench.rig.pieces import Piece
from erdctl.core.blocks import SETTLE
from erdctl.core.recording import Array

LEAST_RECORDS = 4
SAMPLES, TRIED = 60_000, 8_000  # that the model is fitted to, and tried on
STEPS = 2_000  # of the duty; a control that never rests shows no lag of its own
LAGS, EXPONENTS = (0.01, 0.0, 0.03, 0.1), (0.5, 0.35, 0.7, 1.0, 1.4)  # T_d [s] and beta [1]


@dataclass(frozen=True, eq=False)
class Rows:
    """Columns (n, p) of a stretch, its force (n,), and which samples (n,) to look at.

    settled : with a settled yield force;  smooth : of these, where the paper's force has no jump
    """

    piece: Piece
    columns: Array
    force: Array
    settled: npt.NDArray[np.bool_]
    smooth: npt.NDArray[np.bool_]


def first_of_each(found: Sequence[Piece]) -> list[Piece]:
    """One stretch of every record, all together of so many samples as the model needs."""
    first: dict[int, Piece] = {}
    for p in found:
        first.setdefault(p.record, p)
    keep = min(1.0, SAMPLES / sum(len(p) for p in first.values()))
    return [
        Piece(p.recording, p.record, p.first, p.first + max(int(keep * len(p)), min(len(p), 400)))
        for p in first.values()
    ]


def _yield_force(p: Piece, T_d: float, beta: float) -> Array:
    """(n,) yield force of Eqs. 12 and 18 for sigma = 1, settled where the stretch begins."""
    field = p.of("duty") ** beta
    steps = np.flatnonzero(np.diff(field)) + 1
    if T_d == 0.0 or not len(steps) or len(steps) > STEPS:
        return field
    # Step by step, without a filter of SciPy, whose import takes longer than all checks together.
    keep = float(np.exp(-p.step / T_d))
    out, now = field.copy(), float(field[0])
    for first, end in zip(steps.tolist(), [*steps[1:].tolist(), len(field)], strict=True):
        held = float(field[first])
        out[first:end] = held + (now - held) * keep ** np.arange(1, end - first + 1)
        now = float(out[end - 1])
    return out


def _rows(p: Piece, T_d: float, beta: float, every: int = 1) -> Rows:
    """Columns of a stretch: a constant; x, xdot and yield force in either direction; friction."""
    x, xdot, t = p.x[::every], p.xdot[::every], p.t[::every]
    up = (xdot > 0).astype(np.float64)
    down = 1.0 - up
    field = _yield_force(p, T_d, beta)[::every]
    columns = np.column_stack([
        np.ones(len(x)), x * up, x * down, xdot * up, xdot * down,
        field * up, -field * down, up - down,
    ])  # fmt: skip
    settled = t - t[0] > min(SETTLE, 0.1 * float(t[-1] - t[0]))
    return Rows(p, columns, p.force[::every], settled, settled & ~p.near[::every])


def best_rows(found: Sequence[Piece]) -> list[Rows]:
    """Rows for the lag and the exponent that suit most records best.

    By the sum of the logarithms of their misfits, so that a single record does not decide.
    """
    if len(found) < LEAST_RECORDS:
        return []
    every = -(-sum(len(p) for p in found) // TRIED)
    control = any(np.ptp(p.of("duty")) > 0 for p in found)
    field = any(p.of("duty").any() for p in found)

    def cost(T_d: float, beta: float) -> float:
        rows = [_rows(p, T_d, beta, every) for p in found]
        theta = model(rows)
        misfits = [np.std(r.force - r.columns @ theta) for r in rows]
        return float(np.sum(np.log(np.maximum(misfits, 1e-12))))

    # One after the other: the lag shows after duty steps, the exponent between the levels.
    beta = min(EXPONENTS, key=lambda b: cost(LAGS[0], b)) if field else EXPONENTS[0]
    T_d = min(LAGS, key=lambda T: cost(T, beta)) if control else LAGS[0]
    return [_rows(p, T_d, beta) for p in found]


def model(rows: Sequence[Rows]) -> Array:
    """Parameters (p,) by least squares, every record counting alike; 0 where nothing tells."""
    p = rows[0].columns.shape[1]
    AA, AF = np.zeros((p, p)), np.zeros(p)
    for r in rows:
        # At reversals and after duty steps the paper's law says little of gains and zeros.
        A, F = r.columns[r.smooth], r.force[r.smooth]
        if len(F):
            AA += A.T @ A / len(F)
            AF += A.T @ F / len(F)
    scale = np.sqrt(np.diag(AA))
    unit = np.where(scale > 0, 1.0 / np.where(scale > 0, scale, 1.0), 0.0)
    inverse = np.linalg.pinv(AA * np.outer(unit, unit), rcond=1e-9, hermitian=True)
    return np.asarray(unit * (inverse @ (unit * AF)))
