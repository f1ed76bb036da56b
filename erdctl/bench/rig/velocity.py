"""A velocity channel with a noise, a delay, a gain or a zero of its own, held against x."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.differentiation import derive_xdot
from erdctl.bench.rig import record_velocity
from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import Piece
from erdctl.core.messages import duration
from erdctl.core.quantiles import median

NOISE = 0.03  # of the effective speed
MOSTLY_NOISE = 0.5  # of the effective speed, in a record that hardly moves: its gain is not told
QUIETER = 3.0  # times less noise than xdot, so that the derivative of x serves better
LATE = 2e-3  # s
LATE_STEPS = 1.0
LATE_CYCLE = 0.004  # of a cycle: it then moves the speed by 2.5 % of its amplitude
GAIN = 0.05
# Of the effective speed: within it a direction is wrong, so that it makes an error of some
# 2 (2/pi 0.005)^(1/2), a tenth, of the yield force.
ZERO = 0.005
TAPS, LEAST_TAP = 4, 1e-12  # samples on either side; part of the largest direction of them
SCATTER = 4.0  # standard errors between records
REMEDY = "fits take the derivative of x in its place; leave the column out, or repair it"


def check(found: Sequence[Piece]) -> list[RigFault]:
    """Noise, lag, gain and zero of a measured xdot.

        x_{i+k} - x_i = (W + tau (xdot_{i+k} - xdot_i) - v_0 (t_{i+k} - t_i)) / g

    with W the integral of xdot in between, by least squares, with k about a sixth of a cycle: x and
    xdot are each taken as they are, and neither is filtered.
    """
    if not found or found[0].recording.xdot_note != "measured":
        return []
    rows = [row for p in found if (row := _against_x(p)) is not None]
    if not rows:
        return []
    columns = (np.array(c) for c in zip(*rows, strict=True))
    gain, late, zero, noise, derived, cycle, step, speed = columns
    out = []
    part, better = median(noise), median(derived)
    if part > NOISE and part > QUIETER * better:
        part, better = _confirmed(found, better)
    if part > NOISE and part > QUIETER * better:
        out.append(
            RigFault(
                "velocity_noise",
                None,
                f"xdot has noise of {100 * part:.2g} % of the effective speed, and the derivative"
                f" of x only {100 * better:.2g} %",
                REMEDY,
            )
        )
    tau, error = _middle(late)
    least = max(LATE, LATE_STEPS * median(step), LATE_CYCLE * median(cycle))
    if abs(tau) > least and abs(tau) > SCATTER * error:
        way = "later" if tau > 0 else "earlier"
        out.append(
            RigFault("velocity_lag", None, f"xdot is {duration(abs(tau))} {way} than x", REMEDY)
        )
    g, error = _middle(gain)
    if abs(g - 1.0) > GAIN and abs(g - 1.0) > SCATTER * error:
        out.append(
            RigFault("velocity_gain", None, f"xdot is {g:.3f} times the derivative of x", REMEDY)
        )
    v_0, error = _middle(zero)
    if not out and abs(v_0) > max(ZERO * median(speed), SCATTER * error):
        out.append(
            RigFault(
                "velocity_offset", None,
                f"xdot has a zero of {1e3 * v_0:+.3g} mm/s: by so much it is faster than x moves",
                "fits take it off; set the velocity channel to zero at rest", zero=v_0,
            )
        )  # fmt: skip
    return out


def of_records(found: Sequence[Piece]) -> list[RigFault]:
    """Records in which a measured xdot goes otherwise with x; of those of which x is sound."""
    if not found or found[0].recording.xdot_note != "measured":
        return []
    seen = [(p, row) for p in found if (row := _against_x(p)) is not None]
    moving = [(p, row[0], row[1]) for p, row in seen if row[3] < MOSTLY_NOISE]
    return record_velocity.check(moving)


def _confirmed(found: Sequence[Piece], better: float) -> tuple[float, float]:
    """Noise of xdot that nothing in x confirms, and the error of the derivative of x, over speed.

        xdot_i = sum_k b_k x_{i+k} + e_i,   |k| <= TAPS,   by least squares

    A motion of few samples a cycle, of a wheel say, changes as fast as noise. But x has it, too,
    and any filter of x shows it; so e is the noise, and what the derivative is further off than
    that is what it lacks of the motion.
    better : the error of the derivative for the noise of x alone
    """
    noise, lacking = [], []
    for p in found:
        if p.speed == 0.0 or len(p) < 20 * TAPS:
            continue
        x, v = p.x - p.x.mean(), p.xdot[TAPS:-TAPS]
        A = np.lib.stride_tricks.sliding_window_view(x, 2 * TAPS + 1)
        b = np.linalg.lstsq(A.T @ A, A.T @ v, rcond=LEAST_TAP)[0]
        square = float(np.mean((v - A @ b) ** 2))
        derived = derive_xdot(p.t, p.x, np.array([0, len(p)]))[0][TAPS:-TAPS]
        noise.append(square**0.5 / p.speed)
        lacking.append(max(float(np.mean((v - derived) ** 2)) - square, 0.0) ** 0.5 / p.speed)
    return (median(noise), max(better, median(lacking))) if noise else (0.0, better)


def _middle(values: np.ndarray) -> tuple[float, float]:
    middle = median(values)
    scatter = 1.4826 * median(np.abs(values - middle))
    return middle, 1.25 * scatter / len(values) ** 0.5


def _against_x(p: Piece) -> tuple[float, ...] | None:
    """Gain, lag [s], zero [m/s], noise of xdot and of the derivative of x over speed, cycle [s],
    step [s], speed [m/s].
    """
    speed, swing = float(np.std(p.xdot)), float(np.std(p.x))
    if speed == 0.0 or swing == 0.0 or p.step <= 0.0:
        return None
    cycle = 2.0 * np.pi * swing / speed
    k = max(1, round(cycle / 6.0 / p.step))
    if len(p) < 6 * k:
        return None
    travelled = p.x - np.concatenate([[0.0], np.cumsum(p.beyond)])
    every = max(1, k // 20)
    index = np.arange(0, len(p) - k, every)
    whole = p.t[index + k] - p.t[index] < 1.2 * k * p.step
    index = index[whole]
    if len(index) < 50:
        return None
    u = p.x[index + k] - p.x[index]
    columns = np.column_stack([
        travelled[index + k] - travelled[index], p.xdot[index + k] - p.xdot[index],
        p.t[index + k] - p.t[index],
    ])  # fmt: skip
    size = np.abs(columns).max(axis=0)
    if not (size > 0).all():
        return None
    first, second, third = np.linalg.lstsq(columns / size, u, rcond=None)[0] / size
    if first <= 0.0:
        return None
    half = max(2, round(0.01 / p.step))
    noise, white = p.noise("xdot")
    x_noise = p.noise("x")[0]
    derived = x_noise / p.step / (np.sum(np.arange(1, half + 1) ** 2) * 2.0) ** 0.5
    noise = noise if white > 1.2 else 0.0
    error = noise / speed, derived / speed
    return 1.0 / first, second / first, -third / first, *error, cycle, p.step, speed
