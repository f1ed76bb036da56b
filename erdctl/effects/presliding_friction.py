"""Seal friction with an elastic pre-sliding at every reversal (Dahl).

    F = F_c z,   dz/dx = (1 - z sign(xdot)) / x_d

x, xdot : stroke and speed of the piston [m], [m/s];  z : (n,) state, -1..1 [1]
F_c : friction [N], F_c >= 0, off at 0;  x_d : pre-sliding distance [m], > 0
Solved exactly along |x|, each side of a reversal for itself. A record that begins in motion has
the z with which it comes by that place again in that direction, about as fast, after two reversals
at least, as if that had gone on before; where it never does, it has slid long (z = sign(xdot)). One
that begins at rest has no force in its seal (z = 0).
Valid for rate-independent seals; LuGre adds a fall of friction with speed.
In `simulate` and C, which know the past alone, a motion that goes on begins as one that has slid
long; a fit looks where it comes by its first place again.
Check: x_d = 0.1 mm, z = 1; 0.1 mm after the reversal z = -1 + 2 exp(-1) = -0.2642.
>>> s = signals([0.1, 0.0, -0.1], step=2e-3)  # the reversal at the second sample
>>> presliding_friction(s, {"x_d": 1e-4})[0].round(4).tolist()
[1.0, 1.0, -0.2642]

Source: P. R. Dahl, Solid friction damping of mechanical vibrations, AIAA Journal 14 (1976)
1675-1682; C. Canudas de Wit et al., IEEE Trans. Automatic Control 40 (1995) 419-425 (LuGre).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.beginnings import as_before
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Causal, Effect, Requirement, Stage, Variable
from erdctl.model.kernels import follow
from erdctl.model.slots import TermSlot, Values


def presliding_friction(s: Signals, p: Values) -> Array:
    """(1, n) state z, the force for F_c = 1 N [1]."""
    x_d = p["x_d"]
    return as_before(lambda first: _states(s, x_d, first), _slid(s), s, x_d)[None]


def slid_before(s: Signals, p: Values) -> Array:
    """(1, n) state z of records that begin in motion as ones that have slid long [1]."""
    return _states(s, p["x_d"], _slid(s))[None]


def _slid(s: Signals) -> Array:
    """(r,) z after a long slide in the direction of a record's first sample."""
    return np.sign(s.xdot[s.starts[:-1]])


def _states(s: Signals, x_d: float, first: Array) -> Array:
    """(n,) z of records that begin with first (r,)."""
    path, after = (distance / x_d for distance in s.path)
    way = np.where(s.compressing, 1.0, -1.0)
    i, _ = s.turns
    return follow(way, path, i, np.maximum(path[i] - after, 0.0), after, first, s.starts)


EFFECT = Effect(
    name="presliding_friction",
    stage=Stage.FRICTION,
    slot=TermSlot(travel="x_d"),
    title="elastic pre-sliding loop at reversal (Dahl, LuGre)",
    equation="F = F_c z, dz/dx = (1 - z sign(xdot)) / x_d",
    said="{F_c} of friction that builds up over {x_d}",
    source="Dahl, AIAA Journal 14 (1976) 1675-1682; Canudas de Wit et al. (1995)",
    validity="seals whose friction does not depend on speed",
    requires=(Requirement.REVERSALS,),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="F_c", unit="N", title="friction force",
            low=0.0, high=1e9, start=1.0, linear=True,
        ),
        Quantity(
            symbol="x_d", unit="m", title="pre-sliding distance",
            low=1e-7, high=0.1, start=1e-4, off=1e-4, scale=Scale.LOG,
        ),
    ),
    columns=presliding_friction,
    causal=Causal(columns=slid_before),
    c=CLaw(
        state=("z",),
        force="""
        /* At the first sample it has slid for long, or, at rest, not at all: where the motion comes
         * by its first place again lies ahead. Who knows better sets z after the first step; behind
         * a mount that of each `spring` of the state, where the piston's travel counts. */
        real way = s->up ? K(1.0) : K(-1.0), past = s->up0 ? K(1.0) : K(-1.0);

        if (s->first)
            z->z = s->xdot > K(0.0) ? K(1.0) : s->xdot < K(0.0) ? K(-1.0) : K(0.0);
        else
            z->z = follow(z->z, past, way, s->path / p->x_d, s->turned,
                          FMAX(s->path - s->after, K(0.0)) / p->x_d, s->after / p->x_d);
        return p->F_c * z->z;
        """,
        note="begins as slid for long, or with no force from rest; whether it comes by that place "
        "again it cannot know",
    ),
)  # fmt: skip
