"""Viscous force that grows with the field.

    F_viscous -> (1 + r u) F_viscous,   T_v du/dt + u = v^m

v : (n,) duty cycle, held from its sample to the next [1];  u : (n,) field that the chains have
followed [1], v^m as a record begins;  r : growth of the viscosity up to full duty [1], r >= 0, off
at 0;  m : exponent [1], 1 in the source;  T_v : time constant of the chains [s], 0 at once
A log tells no time far below its step, but whether the force of a sample is from before or after
the step of the duty there. From T_v = 0, after it, to half a step, before it, the one becomes the
other, so that a fit may come from either side.
Valid where chains thicken the flowing fluid too, so that the slope of force over speed rises with
the field.
Check: r = 3, m = 1, T_v = 10 ms, duty 0 and then 0.4: 1, and 10 ms after the step 1 + 3 * 0.4 *
(1 - exp(-1)) = 1.7585 of the viscous force.
>>> s = signals(np.ones(3), duty=[0.0, 0.4, 0.4], step=0.01)
>>> field_viscosity(s, {"r": 3.0, "m": 1.0, "T_v": 0.01})["viscous"].round(4).tolist()
[1.0, 1.0, 1.7585]

Source: B. F. Spencer, S. J. Dyke, M. K. Sain, J. D. Carlson, Phenomenological model for
magnetorheological dampers, J. Engineering Mechanics 123 (1997) 230-238 (Eqs. 11 to 14: damping
linear in a filtered field).
"""

from __future__ import annotations

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.kernels import first_order
from erdctl.model.slots import ScaleSlot, Values

AT_ONCE = 1e-12  # s
SIDE = 0.05  # of a step: time constants well below that are none


def field_viscosity(s: Signals, p: Values) -> dict[str, Array]:
    """Factor of the viscous force, (n,) [1]."""
    if p["r"] == 0.0:
        return {}
    field = s.duty ** p["m"]
    T = max(p["T_v"], AT_ONCE)
    step = s.step if s.common_step is None else s.common_step
    decay = step / T
    followed = first_order(decay, -np.expm1(-decay) * field, field[s.starts[:-1]], s.starts)
    with np.errstate(divide="ignore"):
        followed += np.exp(-T / (SIDE * s.step_before)) * (field - followed)
    return {"viscous": 1.0 + p["r"] * followed}


def doubled(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: the highest duty doubles the viscosity, in several ways."""
    top = max(float(s.duty.max()), 1e-3)
    ways = ((1.0, 0.0), (0.5, 0.0), (2.0, 0.0), (1.0, 0.03))
    return [{"r": min(top**-m, 1e3), "m": m, "T_v": T_v} for m, T_v in ways]


EFFECT = Effect(
    name="field_viscosity",
    stage=Stage.FIELD,
    slot=ScaleSlot(field_viscosity),
    title="viscous force grows with the field",
    equation="F_viscous -> (1 + r u) F_viscous, T_v du/dt + u = v^m",
    said="viscosity growing by {r} times v^{m}",
    alters=(("viscous", "(1 + r u) {}"),),
    source="Spencer, Dyke, Sain and Carlson, J. Engineering Mechanics 123 (1997) 230-238",
    validity="speeds and duty levels that vary apart from each other",
    requires=(Requirement.FIELD, Requirement.LEVELS, Requirement.SPEEDS),
    shows=Variable.DUTY,
    quantities=(
        Quantity(
            symbol="r", unit="1", title="growth of the viscosity up to full duty",
            low=0.0, high=1e4, start=1.0,
        ),
        Quantity(
            symbol="m", unit="1", title="exponent of the duty",
            low=0.1, high=4.0, start=1.0, off=1.0,
        ),
        Quantity(
            symbol="T_v", unit="s", title="time constant with which it follows the field",
            low=0.0, high=1.0, start=0.02,
        ),
    ),
    guesses=doubled,
    # What yields and what flows each have a part without the field, beside the one that grows.
    companions=("coulomb_friction",),
    c=CLaw(
        state=("field",),
        code="""
        real target = s->duty0 > K(0.0) ? POW(s->duty0, p->m) : K(0.0);
        real next = s->duty > K(0.0) ? POW(s->duty, p->m) : K(0.0);
        real T = FMAX(p->T_v, K(1e-12));

        if (!(p->r > K(0.0)))
            return;
        if (s->first)
            z->field = target;
        else
            z->field += (target - z->field) * -EXPM1(-s->h / T);
        /* After a step of the duty or before it, where T_v is far below that of the samples. */
        next = z->field + (next - z->field) * (s->h > K(0.0) ? EXP(-T / (K(0.05) * s->h)) : K(0.0));
        f->viscous *= K(1.0) + p->r * next;
        """,
    ),
)  # fmt: skip
