"""Dead time between duty and yield stress.

    T_d dF_ER/dt + F_ER = sigma v(t - tau)^beta

v : (n,) duty cycle, held from its sample to the next [1];  tau : dead time [s] >= 0, off at 0
The delayed steady force has its mean over each step, which Eq. 12 needs: exact for any sampling
and continuous in tau. (Averaging v itself would err, as v^beta is steep at 0.) Before a record
its first duty holds.
Valid for a constant dead time (control cycle, amplifier).
Check: samples 10 ms apart, v^beta = 0, 1, 1, 1, tau = 4 ms: the step that begins at 10 ms has the
old value for 4 of its 10 ms, so the field is 0, 0.6, 1, 1.
>>> field = np.array([0.0, 1.0, 1.0, 1.0])
>>> input_delay(field, signals(np.ones(4)), {"tau": 4e-3}, "release").round(9).tolist()
[0.0, 0.6, 1.0, 1.0]

Source: J.-H. Koo, F. D. Goncalves, M. Ahmadian, A comprehensive analysis of the response time of MR
dampers, Smart Mater. Struct. 15 (2006) 351-358 (delay before the response sets in).
"""

from __future__ import annotations

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.delayed_field import delayed_field
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import FieldSlot, Values


def input_delay(field: Array, s: Signals, p: Values, way: str) -> Array:
    """(n,) normalised steady yield force [1], its mean over each step; alike both ways."""
    return field if p["tau"] == 0.0 else delayed_field(field, s, p["tau"])


def to_a_sample(p: Values, step: float) -> str:
    """A switch is logged at the next sample: half a step late in the mean, if it comes when it
    likes."""
    if p["tau"] > 5.0 * step:
        return ""
    return f"more by half of a step of {1e3 * step:.3g} ms if the duty switches between samples"


EFFECT = Effect(
    name="input_delay",
    stage=Stage.FIELD,
    slot=FieldSlot(input_delay),
    title="dead time between duty and yield stress",
    equation="T_d dF_ER/dt + F_ER = sigma v(t - tau)^beta",
    said="{tau} of dead time",
    alters=(("v", "v(t - tau)"),),
    source="Koo, Goncalves and Ahmadian, Smart Mater. Struct. 15 (2006) 351-358",
    validity="a constant dead time",
    requires=(Requirement.FIELD, Requirement.STEPS),
    shows=Variable.SINCE_DUTY_STEP,
    quantities=(
        Quantity(
            symbol="tau", unit="s", title="dead time",
            low=0.0, high=1.0, start=5e-3,
        ),
    ),
    caveat=to_a_sample,
    order=10,  # of a constant delay and a memoryless law the order does not matter
    c=CLaw(
        state=("length", "tail", "count", "old_span", "old_value", "new_span", "new_value"),
        past=("span[512]", "value[512]"),
        code="""
        /* The past of length tau as pieces of held field: a step takes its time from the oldest.
         * What is left of the oldest and the newest, which may still grow, stand in the state: the
         * ring has those between, and is written where a new one comes to it and nowhere else. */
        enum { PIECES = 512, KEPT = 502 };
        real want = s->h, skip, taken, area = K(0.0), span, value, newest;
        int tail, count;

        if (!(p->tau > K(0.0))) {
            z->length = K(0.0);
            return field;
        }
        if ((s->first && !s->ahead) || !(z->length > K(0.0))) {
            z->tail = z->count = z->new_span = z->new_value = K(0.0);
            z->old_span = z->length = p->tau;
            z->old_value = field;
        }
        if (s->first)
            return field;
        tail = (int)z->tail;
        count = (int)z->count;
        newest = z->new_span;
        value = z->old_value;
        /* Another tau than before: the oldest value goes on, or the oldest pieces go. */
        skip = z->length - p->tau;
        span = z->old_span - FMIN(skip, K(0.0));
        skip = FMAX(skip, K(0.0));
        while (span > K(0.0) && (skip > K(0.0) || want > K(0.0))) {
            taken = FMIN(span, skip > K(0.0) ? skip : want);
            if (skip > K(0.0)) {
                skip -= taken;
            } else {
                area += value * taken;
                want -= taken;
            }
            span -= taken;
            if (!(span > K(0.0)) && count > 0) {
                span = w->span[tail];
                value = w->value[tail];
                tail = (tail + 1) % PIECES;
                count--;
            } else if (!(span > K(0.0))) {
                span = newest;
                value = z->new_value;
                newest = K(0.0);
            }
        }
        area += FMAX(want, K(0.0)) * field;  /* a step longer than tau */
        if (s->ahead)
            return area / s->h;
        z->length = p->tau;
        z->tail = (real)tail;
        z->old_span = span;
        z->old_value = value;
        z->new_span = newest;
        taken = FMIN(s->h, p->tau);
        /* A held field is one piece; what is finer than a part of tau joins the newest piece. */
        if (newest > K(0.0) && (FABS(z->new_value - field) <= K(0.0) || count >= KEPT
                                || newest < p->tau / (real)KEPT)) {
            z->new_span += taken;
            z->new_value += (field - z->new_value) * (taken / z->new_span);
        } else if (!(newest > K(0.0)) && span > K(0.0) && FABS(value - field) <= K(0.0)) {
            z->old_span += taken;
        } else if (!(span > K(0.0))) {  /* a step of tau, or longer, has left none */
            z->old_span = taken;
            z->old_value = field;
        } else {
            if (newest > K(0.0)) {
                w->span[(tail + count) % PIECES] = newest;
                w->value[(tail + count) % PIECES] = z->new_value;
                count++;
            }
            z->new_span = taken;
            z->new_value = field;
        }
        z->count = (real)count;
        return area / s->h;
        """,
        note="a past of more than 504 pieces is kept with a 504th of tau as its finest step",
    ),
)  # fmt: skip
