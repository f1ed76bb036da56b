"""High-voltage amplifier with a limited slew rate.

    dv_a/dt = sign(v - v_a) / T_full until v_a = v

v : (n,) duty cycle, held from its sample to the next [1];  v_a : that of the electrodes [1]
T_full : time from zero to full scale [s], T_full >= 0, off at 0
v_a is handed on as its mean over each step. A record begins with v_a = v.
Valid for an amplifier with the same limit up and down.
Check: samples 10 ms apart, v = 0, 0.3, 0.3, 0.3, T_full = 50 ms (0.2 in 10 ms): v_a goes from 0 to
0.2, then in 5 ms to 0.3: means 0, 0.1, (0.25 + 0.3) / 2 = 0.275, 0.3.
>>> s = signals(np.ones(4), duty=[0.0, 0.3, 0.3, 0.3], step=0.01)
>>> supply_slew(s, {"T_full": 0.05}).round(9).tolist()
[0.0, 0.1, 0.275, 0.3]

Source: P. Horowitz, W. Hill, The Art of Electronics, 3rd ed. (2015), Sec. 4.4 (slew rate).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ControlSlot, Values


def supply_slew(s: Signals, p: Values) -> Array:
    """(n,) duty that reaches the electrodes [1], its mean over each step."""
    if p["T_full"] == 0.0:
        return s.duty
    from erdctl.model.recurrences import rate_limited

    duty: Array = rate_limited(s.duty, s.step, s.starts, 1.0 / p["T_full"])
    return duty


EFFECT = Effect(
    name="supply_slew",
    stage=Stage.FIELD,
    slot=ControlSlot(supply_slew),
    title="the high-voltage amplifier is slew-rate limited",
    equation="dv_a/dt = sign(v - v_a) / T_full until v_a = v",
    said="{T_full} from zero to full scale",
    alters=(("v", "v_a"),),
    source="Horowitz and Hill, The Art of Electronics (2015), Sec. 4.4",
    validity="the same limit up and down",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.SINCE_DUTY_STEP,
    quantities=(
        Quantity(
            symbol="T_full", unit="s", title="time from zero to full scale",
            low=1e-4, high=100.0, start=0.05, scale=Scale.LOG,
        ),
    ),
    order=10,  # the amplifier comes before the fluid
    c=CLaw(
        state=("reached", "low"),
        code="""
        /* What a float's rounding leaves of the way is none: v^beta is steep where the duty ends
         * at 0. A double has the digits, and then those of Python are wanted. */
        const int coarse = sizeof(real) < sizeof(double);
        const real none = coarse ? K(2.0) * K(FLT_EPSILON) : K(0.0);
        real reach = s->h / p->T_full, off, mean;

        if (!(p->T_full > K(0.0)))
            return duty;
        if (s->first && !s->ahead) {
            z->reached = duty;
            z->low = K(0.0);
        }
        off = (duty - z->reached) + z->low;
        if (FABS(off) <= reach + none) {
            mean = reach > K(0.0) ? FMIN(FABS(off) / reach, K(1.0)) : K(0.0);
            mean = duty - K(0.5) * off * mean;
        } else {
            off = off > K(0.0) ? reach : -reach;
            mean = z->reached + K(0.5) * off;
        }
        if (!s->ahead && coarse)
            add_to(&z->reached, &z->low, off);
        else if (!s->ahead)
            z->reached += off;
        return mean;
        """,
    ),
)  # fmt: skip
