"""Inertia of the fluid column and of the moving parts.

    F = m d2x/dt2

d2x/dt2 : (n,) acceleration [m/s^2]
m : mass [kg], m >= 0, off at 0; that of the fluid in a duct counts with the square of the ratio
of piston to duct area
A fit, which has the whole log, takes the slope of xdot within 20 ms each way, or less where noise
lets it (`Signals.xddot`, 99.9 % of the acceleration at 7 Hz at least). What goes on sample by
sample, `simulate` as well as C, has the past alone: there a filter of fourth order with a memory T
of 2.5 ms takes the slope of a cubic through it: with q = T s / (1 + T s) that is (q + q^2 + q^3 - 3
q^4) / T, as s = (q + q^2 ...) / T, without what would follow the last sample at once. Of a sine it
gives 0.2 % too much at 7 Hz, 0.8 at 10 and 9 at 20; noise of xdot of 2 mm/s at 1 kHz becomes 0.9
m/s^2, a third of what the slope of a step has. With steps above 5 ms it becomes that slope, half a
step late.
Behind an elastic mount it is the piston that has a mass (`erdctl.model.series_compliance`).
Valid below about 20 Hz. At one frequency m cannot be distinguished from k_nom, as then
d2x/dt2 = -omega^2 x.
Check: m = 2 kg, xdot = 0.5 t m/s gives 1 N.
>>> (2.0 * fluid_inertia(signals([0.0, 0.05, 0.10, 0.15], step=0.1), {})[0]).round(9).tolist()
[1.0, 1.0, 1.0, 1.0]

Source: D. J. Peel, R. Stanway, W. A. Bullough, Dynamic modelling of an ER vibration damper for
vehicle suspension applications, Smart Mater. Struct. 5 (1996) 591-606.
"""

from __future__ import annotations

from math import factorial

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Causal, Effect, Requirement, Stage, Variable
from erdctl.model.kernels import first_order
from erdctl.model.slots import TermSlot, Values

MEMORY = 2.5e-3  # s
PARTS = (6.0, -14.0, 11.0, -3.0)  # of 1, 2, 3, 4 lags in a row, from the powers of q


def fluid_inertia(s: Signals, p: Values) -> Array:
    """(1, n) force of 1 kg [m/s^2]."""
    return s.xddot[None]


def of_the_past(s: Signals, p: Values) -> Array:
    """(1, n) force of 1 kg by what is known at a sample [m/s^2]; 0 at the first of a record.

    xdot is a straight line between samples, and of the slope of its first step before.
    """
    e = s.step / MEMORY
    slope, change = np.zeros((2, len(s)))
    change[:-1] = s.xdot[1:] - s.xdot[:-1]
    slope[:-1] = change[:-1] / np.where(s.step[:-1] > 0.0, s.step[:-1], 1.0)
    first = s.starts[:-1]
    behind: list[Array] = []
    out = np.zeros(len(s))
    for k, part in enumerate(PARTS, start=1):
        # What k lags in a row leave of a line is behind it by k T times its slope.
        source = _of_change(e, k) * change
        for j, lag in enumerate(behind, start=1):
            source += np.exp(-e) * e ** (k - j) / factorial(k - j) * lag
        behind.append(first_order(e, source, -k * MEMORY * slope[first], s.starts))
        out += part * behind[-1]
    out[first] = 0.0
    return out[None] / MEMORY


def _of_change(e: Array, k: int) -> Array:
    """(n,) how far k lags in a row fall behind a change of 1 in a step of e times their memory."""
    e = np.maximum(e, 1e-9)
    left = np.exp(-e) * sum(e**m / factorial(m) for m in range(k))
    left_of_next = left + np.exp(-e) * e**k / factorial(k)
    return -left - k / e * (1.0 - left_of_next)


EFFECT = Effect(
    name="fluid_inertia",
    stage=Stage.FLUID,
    slot=TermSlot(mass="m"),
    title="inertia of the fluid column and of the moving parts",
    equation="F = m d2x/dt2",
    said="{m} of moving mass",
    source="Peel, Stanway and Bullough, Smart Mater. Struct. 5 (1996) 591-606",
    validity="motion below about 20 Hz",
    requires=(Requirement.FREQUENCIES,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="m", unit="kg", title="effective mass",
            low=0.0, high=1e9, start=0.1, linear=True,
        ),
    ),
    columns=fluid_inertia,
    causal=Causal(columns=of_the_past),
    c=CLaw(
        state=("behind[4]", "going"),
        force="""
        /* The slope of a cubic through the past, by what 1 to 4 lags in a row are behind xdot. */
        const real parts[4] = {K(6.0), K(-14.0), K(11.0), K(-3.0)};
        const real memory = K(2.5e-3);
        real e, kept, change, power, left, old[4], sum = K(0.0);
        int j, k;

        if (s->first)
            return K(0.0);
        e = s->h / memory;
        kept = EXP(-e);
        change = s->xdot - s->xdot0;
        for (k = 0; k < 4; k++)
            old[k] = z->going > K(0.5) ? z->behind[k] : -(real)(k + 1) * memory * change / s->h;
        z->going = K(1.0);
        for (k = 0; k < 4; k++) {
            z->behind[k] = K(0.0);
            power = kept;
            left = K(0.0);
            for (j = k; j >= 0; j--) {
                z->behind[k] += power * old[j];
                left += power;
                power *= e / (real)(k - j + 1);
            }
            z->behind[k] -= (left + (real)(k + 1) / e * (K(1.0) - left - power)) * change;
            sum += parts[k] * z->behind[k];
        }
        return p->m * sum / memory;
        """,
        note="the acceleration is that of the past alone, where a fit looks 20 ms each way",
    ),
)  # fmt: skip
