"""Yield stress that levels off at high duty.

    F_ER -> sigma tanh((a v^beta)^n)^(1/n) / a,   a = a_c in compression, a_r in release

v : (n,) duty cycle [1];  a : saturation [1], a >= 0, off at 0;  n : sharpness of the knee [1], 1 as
in the source; in the limit of a large n the yield force stops to grow at a v^beta = 1
1/a is the level, in units of sigma, that the yield force approaches. Where the dipoles of the fluid
saturate at one duty v_s, a = v_s^-beta differs between directions as beta does.
Valid for a yield stress that grows monotonically; beta takes up most of a weak saturation.
Check: a = 2, v^beta = 0.5 gives tanh(1) / 2 = 0.3808 of sigma; 1 gives tanh(2) / 2 = 0.4820;
with n = 2 sqrt(tanh(1)) / 2 = 0.4363 and sqrt(tanh(4)) / 2 = 0.4998.
>>> s, p = signals([0.1, 0.1]), {"a_c": 2.0, "a_r": 0.0, "n": 1.0}
>>> field_saturation(np.array([0.5, 1.0]), s, p, "compression").round(4).tolist()
[0.3808, 0.482]
>>> field_saturation(np.array([0.5, 1.0]), s, p | {"n": 2.0}, "compression").round(4).tolist()
[0.4363, 0.4998]

Source: H. J. Choi et al., A yield stress scaling function for electrorheological fluids, Appl.
Phys. Lett. 78 (2001) 3806-3808 (tanh between the low and the high field's law);
M. R. Jolly, J. W. Bender, J. D. Carlson, Properties and applications of commercial
magnetorheological fluids, J. Intell. Mater. Syst. Struct. 10 (1999) 5-13 (yield stress that ends
with the saturation of the magnetisation, by a sharp knee).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import FieldSlot, Values

FAR = 1e3  # times the level


def field_saturation(field: Array, s: Signals, p: Values, way: str) -> Array:
    """(n,) normalised steady yield force [1]."""
    a = p[f"a_{way[0]}"]
    if a == 0.0:
        return field
    if p["n"] == 1.0:
        level: Array = np.tanh(a * field) / a
        return level
    # x^n overflows where tanh has long been 1.
    knee: Array = np.tanh(np.minimum(a * field, FAR) ** p["n"]) ** (1.0 / p["n"]) / a
    return knee


def alike(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: about the same in both directions."""
    soft = [(a, 1.0) for a in (0.1, 0.3, 1.0, 3.0, 10.0)]
    return [{"a_c": a, "a_r": a, "n": n} for a, n in (*soft, (1.0, 4.0), (2.0, 4.0), (5.0, 4.0))]


EFFECT = Effect(
    name="field_saturation",
    stage=Stage.FIELD,
    slot=FieldSlot(field_saturation),
    title="yield stress levels off at high duty",
    equation="F_ER -> sigma tanh((a v^beta)^n)^(1/n) / a",
    said="saturation of {a_c} in compression and {a_r} in release",
    alters=(("law", "tanh((a {})^n)^(1/n) / a"),),
    source="Choi et al., Appl. Phys. Lett. 78 (2001) 3806-3808",
    validity="a yield stress that grows with the duty; three levels or more to tell it from beta",
    requires=(Requirement.FIELD, Requirement.LEVELS),
    shows=Variable.DUTY,
    quantities=(
        *(
            Quantity(
                symbol=f"a_{way[0]}", unit="1", low=0.0, high=100.0, start=1.0,
                title=f"saturation in {way}, sigma over the highest yield force",
            )
            for way in DIRECTIONS
        ),
        Quantity(
            symbol="n", unit="1", title="sharpness of the knee",
            low=0.5, high=100.0, start=1.0, off=1.0, scale=Scale.LOG,
        ),
    ),
    earlier=(("n", 1.0),),
    guesses=alike,
    c=CLaw(
        code="""
        const real far = K(1e3);  /* times the level: x^n overflows where tanh has long been 1 */
        real a = way == 0 ? p->a_c : p->a_r;

        if (!(a > K(0.0)))
            return field;
        return POW(TANH(POW(FMIN(a * field, far), p->n)), K(1.0) / p->n) / a;
        """,
    ),
)  # fmt: skip
