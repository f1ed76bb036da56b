"""The paper's model of an ER damper, Eqs. 12, 13, 14 and 18, on sampled signals.

    F = k_nom x + c_vis xdot + F_ER sign(xdot)                                   (13, 14)
    T_d dF_ER/dt + F_ER = sigma v^beta                                               (12)

Every parameter has a value for compression (xdot > 0) and one for release (xdot < 0), Sec. 4;
F_ER is one state that both share. sign(0) = 0 (Eq. 18). Units are those of the equations: c_vis in
N s/m and sigma in N, where Table 2 prints N s/m^2 and a dash.

Source: the ER damper paper, Secs. 3.2 and 4 (Modelling of Electro-Rheological Dampers for
Automotive Suspensions: Healthy and Faulty Cases).
"""

from __future__ import annotations

import sys
from collections.abc import Mapping

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.kernels import first_order

# As the docstring has them, for people.
EQUATIONS = (
    "F = k_nom x + c_vis xdot + F_ER sign(xdot)",
    "T_d dF_ER/dt + F_ER = sigma v^beta",
)

# Bounds are what a damper between a model car's and a building's can have. Damping that gave energy
# away would be no damper, and behind a compliance it could not even be simulated; gas that is
# squeezed pushes back (Eq. 3), and a negative stiffness only hides inertia or a loop.
QUANTITIES: dict[str, Quantity] = {
    q.symbol: q
    for q in (
        Quantity(
            symbol="k_nom", unit="N/m", title="effective stiffness of the gas", linear=True,
            low=0.0, high=1e9, start=0.0,
        ),
        Quantity(
            symbol="c_vis", unit="N s/m", title="viscosity with no field", linear=True,
            low=0.0, high=1e9, start=0.0,
        ),
        Quantity(
            symbol="T_d", unit="s", title="time constant of the yield force",
            low=0.0, high=5.0, start=0.03,
        ),
        Quantity(
            symbol="sigma", unit="N", title="yield force at full duty", linear=True,
            low=0.0, high=1e9, start=0.0,
        ),
        Quantity(
            symbol="beta", unit="1", title="exponent of the yield law",
            low=0.02, high=4.0, start=0.5, off=1.0,
        ),
    )
}  # fmt: skip


def pair(values: Mapping[str, float], symbol: str) -> tuple[float, float]:
    """A parameter for compression and for release, out of those of a whole model."""
    return values[f"compression.{symbol}"], values[f"release.{symbol}"]


def field_law(duty: Array, beta: float) -> Array:
    """Normalised yield force of a steady field, Eq. 11 without sigma.

        v^beta, and 0 at v = 0

    duty : (n,) v [1];  beta : [1] > 0.  Returns (n,) [1].
    Check: v = 0.25, beta = 0.5 gives 0.5.
    >>> field_law(np.array([0.25, 0.0]), 0.5).tolist()
    [0.5, 0.0]

    Duty is usually held over long stretches, and a power costs far more than a comparison: each
    stretch is computed once.
    """
    if beta == 1.0 or len(duty) == 0:
        return duty
    changes = np.flatnonzero(duty[1:] != duty[:-1]) + 1
    if len(changes) * 4 > len(duty):
        return np.power(duty, beta)
    first = np.concatenate(([0], changes))
    lengths = np.diff(np.concatenate((first, [len(duty)])))
    return np.repeat(np.power(duty[first], beta), lengths)


def yield_force(
    signals: Signals,
    compression: Array,
    release: Array,
    T_c: float,
    T_r: float,
    *,
    lags: tuple[Array, Array] | None = None,
) -> Array:
    """The state F_ER of Eq. 12, solved exactly for a control held from sample to sample.

        T_d dF/dt + F = u,   u = compression or release, whichever way the piston moves

    compression, release : (n,) steady value u for either direction [N];  T_c, T_r : time constants
    for either direction [s], 0 for none;  lags : (n,) factors of both while the force rises and
    while it falls, with which the solution is no longer linear in u
    Returns (n,) F_ER [N].

    A step in which the piston turns is solved in two parts, before and after the turn, so the
    error of a sampled solution is of second order in the step. Each record starts at the steady
    value of its first sample, or where it goes on from elsewhere (`Signals.begun`) as it was there.

    Check: u = 0 then 1, T_d = 43 ms: F = 1 - exp(-1) = 0.6321 at 43 ms after the step.
    >>> u, s = np.array([0.0, 1.0, 1.0]), signals(np.ones(3), step=0.043)
    >>> yield_force(s, u, u, 0.043, 0.043).round(4).tolist()
    [0.0, 0.0, 0.6321]
    """
    up = signals.compressing
    target = compression if release is compression else np.where(up, compression, release)
    if T_c == 0.0 and T_r == 0.0:
        return target
    turn, before = signals.turns
    floor = 1e-12  # s; with one time constant 0 that direction follows within any real step
    step = signals.common_step
    # A compiler costs 0.3 s to load. Where that is done, its loop is several times as fast.
    if lags is not None or ("numba" in sys.modules and signals.begun is None):
        from erdctl.model.recurrences import forming

        part = np.zeros(len(up))
        part[turn] = before
        even = signals.step if step is None else np.where(signals.step > 0, step, 0.0)
        rises, falls = (np.ones(len(up)),) * 2 if lags is None else lags
        return forming(
            compression, release, up, part, even, signals.starts,
            max(T_c, floor), max(T_r, floor), rises, falls,
        )  # fmt: skip
    exponent: Array | float
    if step is not None and T_c == T_r:
        exponent = step / T_c
        source = target * -np.expm1(-exponent)
    else:
        step_all = signals.step if step is None else np.where(signals.step > 0, step, 0.0)
        exponent = step_all / signals.per_direction(max(T_c, floor), max(T_r, floor))
        source = target * -np.expm1(-exponent)
    if turn.size:
        forward = up[turn]
        T_before = np.maximum(np.where(forward, T_c, T_r), floor)
        T_after = np.maximum(np.where(forward, T_r, T_c), floor)
        dt = signals.step[turn]
        e_before, e_after = before * dt / T_before, (1.0 - before) * dt / T_after
        u_before = np.where(forward, compression[turn], release[turn])
        u_after = np.where(forward, release[turn], compression[turn])
        source[turn] = (
            -np.expm1(-e_before) * np.exp(-e_after) * u_before - np.expm1(-e_after) * u_after
        )
        if not isinstance(exponent, float):
            exponent[turn] = e_before + e_after
    initial = target[signals.starts[:-1]] if signals.begun is None else signals.begun
    return first_order(exponent, source, initial, signals.starts)
