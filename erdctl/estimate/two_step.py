"""The paper's own identification, Sec. 4: step by step, each on the data made for it.

1. k_nom, c_vis by linear least squares on null-control data, per direction (Eqs. 15, 16);
2. sigma, beta by nonlinear least squares on the remaining yield force (Eqs. 17-19);
3. T_d from what follows the control steps (Eq. 12), one value for both directions as in Table 2.
"""

from __future__ import annotations

import numpy as np

from erdctl.bench.excitation import ENOUGH, null_control
from erdctl.core.blocks import SETTLE, Block
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.model import paper
from erdctl.model.composed import Model

BETA = paper.QUANTITIES["beta"]
AFTER_STEP = 0.5  # s after a duty step in which its lag is looked for


def two_step(block: Block, held: dict[str, float]) -> dict[str, float]:
    """Estimates by the paper's procedure.

    held : values of parameters that the data cannot identify, used as they are
    Returns every parameter that could be estimated; those whose data are missing are absent.
    """
    s, force = block.signals, block.force
    from scipy.optimize import lsq_linear

    out: dict[str, float] = {}
    null = null_control(s) & (block.weight > 0)
    settled = (s.duty > 0) & (s.since_duty_step > SETTLE) & (block.weight > 0)
    for direction, moving in zip(DIRECTIONS, (s.xdot > 0, s.xdot < 0), strict=True):
        at_rest = null & moving
        if np.count_nonzero(at_rest) < ENOUGH:
            continue
        # Least squares as in Eq. 16, but no negative viscosity where other physics mimics one.
        k, c = lsq_linear(
            np.column_stack([s.x[at_rest], s.xdot[at_rest]]),
            force[at_rest],
            bounds=([-np.inf, 0.0], np.inf),
        ).x.tolist()
        out |= {f"{direction}.k_nom": k, f"{direction}.c_vis": c}
        active = settled & moving
        if f"{direction}.sigma" in held or np.count_nonzero(active) < ENOUGH:
            continue
        # Eq. 17, times the sign so that both directions give a positive yield force.
        F_ys = (force[active] - k * s.x[active] - c * s.xdot[active]) * np.sign(s.xdot[active])
        sigma, beta = yield_law(s.duty[active], F_ys)
        out |= {f"{direction}.sigma": sigma, f"{direction}.beta": beta}
    return out | _time_constant(block, {**held, **out})


def yield_law(duty: Array, F_ys: Array) -> tuple[float, float]:
    """sigma [N] and beta [1] of Eq. 18 by nonlinear least squares, Eq. 19.

    duty, F_ys : (n,) v [1] > 0 and unsigned yield force [N]

    A duty level enters by its mean and count: the sum of squares is the same but for a constant.
    Check: v = 0.1, 0.4 and F = 2, 4 gives sigma = 6.3246, beta = 0.5.
    >>> sigma, beta = yield_law(np.array([0.1, 0.4]), np.array([2.0, 4.0]))
    >>> round(sigma, 4), round(beta, 4)
    (6.3246, 0.5)
    """
    from scipy.optimize import least_squares

    levels, which, count = np.unique(np.round(duty, 4), return_inverse=True, return_counts=True)
    mean = np.bincount(which, weights=F_ys) / count
    root = np.sqrt(count)

    def sigma_of(beta: float) -> float:
        field = levels**beta
        return max(float(np.dot(count * field, mean) / np.dot(count * field, field)), 0.0)

    def error(p: Array) -> Array:
        return np.asarray(root * (sigma_of(float(p[0])) * levels ** p[0] - mean))

    found = least_squares(error, [BETA.start], bounds=([BETA.low], [BETA.high]), xtol=1e-12)
    beta = float(found.x[0])
    return sigma_of(beta), beta


def _time_constant(block: Block, known: dict[str, float]) -> dict[str, float]:
    names = [f"{d}.T_d" for d in DIRECTIONS]
    model = Model()
    if any(n in known for n in names) or not set(model.quantities) <= {*known, *names}:
        return {}
    from scipy.optimize import minimize_scalar

    near = (block.signals.since_duty_step < AFTER_STEP) & (block.weight > 0)
    if not near.any():
        return {}

    def cost(log_T: float) -> float:
        values = {**known, **dict.fromkeys(names, float(np.exp(log_T)))}
        error = (block.force - model.force(block.signals, values))[near]
        return float(np.dot(error, error))

    grid = np.log(np.geomspace(1e-3, 1.0, 13))
    best = int(np.argmin([cost(g) for g in grid]))
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    found = minimize_scalar(cost, bounds=(low, high), method="bounded")
    return dict.fromkeys(names, float(np.exp(found.x)))
