"""Release force lost until the void that compression left is taken up.

    V grows by g dx in compression, up to x_v, and shrinks by |dx| in release, down to 0
    F_viscous, F_yield -> (1 - lambda min(1, V / (e x_v))) of them in release

dx : travel of the piston [m];  V : what of the void release has yet to take up [m], 0 as a record
begins;  x_v : the largest void [m], x_v >= 0, off at 0
g : void left by a metre of compression [1];  lambda : part of the force that is lost [1], 0..1
e : part of x_v over which the force returns [1], 0..1; all of it as the mean over the travel of one
sample (its speed times the step before it), so that it is continuous in x_v also at e = 0
Valid for a void that forms and is taken up whatever the speed.
Check: x_v = 2 mm, g = 100, lambda = 0.8, e = 0: 1 mm and 3 mm after full compression 0.2 and 1 of
both forces; g = 0.5, after 2 mm of compression: 0.5 mm and 1.5 mm into release 0.2 and 1.
>>> xdot = np.array([0.0, 1.0, 1.0, 0.0, -1.0, -1.0])  # 2 mm up, 0.5 and 1.5 mm down
>>> p = {"x_v": 2e-3, "g": 0.5, "lambda": 0.8, "e": 0.0}
>>> cavitation(signals(xdot, step=1e-3), p)["yield"][4:].round(4).tolist()
[0.2, 1.0]
>>> cavitation(signals(2.0 * xdot, step=1e-3), p | {"g": 100.0})["viscous"][4:].round(4).tolist()
[0.2, 1.0]

Source: S. Duym, R. Stiens, K. Reybrouck, Evaluation of shock absorber models, Vehicle System
Dynamics 27 (1997) 109-127 (vapour that must be taken up before the pressure builds up).
"""

from __future__ import annotations

from itertools import product

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import ScaleSlot, Values

NEGLIGIBLE = 1e-12  # m


def cavitation(s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the viscous and the yield force, (n,) each [1]."""
    x_v = p["x_v"]
    if x_v == 0.0:
        return {}
    void, gone = _void(s, x_v, p["g"])
    edge, to_go = p["e"] * x_v, void - gone
    travel = np.abs(s.xdot) * s.step_before  # a sample stands for half of it each way
    sample = np.minimum(np.maximum(travel - edge, 0.0), 2.0 * void)
    over = _area(to_go + 0.5 * sample, edge) - _area(to_go - 0.5 * sample, edge)
    here = np.clip(to_go / max(edge, NEGLIGIBLE), 0.0, 1.0)  # of a sample that does not travel
    travels = sample > NEGLIGIBLE
    lost = np.where(travels, np.clip(over / np.where(travels, sample, 1.0), 0.0, 1.0), here)
    left = np.where(s.compressing, 1.0, 1.0 - p["lambda"] * lost)
    return {"viscous": left, "yield": left}


def _area(void: Array, edge: float) -> Array:
    """(n,) integral of min(1, V / edge) from no void to these [m]."""
    ramp = np.clip(void, 0.0, edge)
    return ramp**2 / (2.0 * edge or 1.0) + np.maximum(void - edge, 0.0)


def _void(s: Signals, x_v: float, growth: float) -> tuple[Array, Array]:
    """(n,) void as each sample's stroke began, and distance travelled in that stroke [m]."""
    path, after = s.path
    total = np.concatenate([[0.0], np.cumsum(path[:-1])])
    turns = s.turns[0]
    first = np.concatenate([s.starts[:-1], turns + 1])  # sample with which each stroke begins
    began = np.concatenate([total[s.starts[:-1]], total[turns + 1] - after])
    order = np.argsort(first, kind="stable")
    first, began = first[order], began[order]
    travel = np.diff(began, append=total[-1]).tolist()
    fresh = (order < len(s.starts) - 1).tolist()
    void, now = np.zeros(len(first)), 0.0
    for k, up in enumerate(s.compressing[first].tolist()):
        void[k] = now = 0.0 if fresh[k] else now
        now = min(now + growth * travel[k], x_v) if up else max(now - travel[k], 0.0)
    stroke = np.repeat(np.arange(len(first)), np.diff(first, append=len(s)))
    return void[stroke], total - began[stroke]


def guesses(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: voids that every compression fills, and such as only long ones do."""
    stroke = float(np.ptp(s.x)) / 2
    sizes = [part * stroke for part in (0.003, 0.01, 0.03, 0.1, 0.3)]
    return [
        {"x_v": max(size, 1e-6), "g": g, "lambda": 1.0, "e": 0.5}
        for size, g in product(sizes, (10.0, 1.0))
    ]


EFFECT = Effect(
    name="cavitation",
    stage=Stage.FLUID,
    slot=ScaleSlot(cavitation),
    title="release force lost until the void is taken up",
    equation="F_viscous -> s F_viscous, F_yield -> s F_yield, s = 1 - lambda min(1, V / (e x_v)) in"
    " release; dV = g dx up to x_v in compression, dV = dx down to 0 in release",
    said="{lambda:%} of the release force lost until {x_v} of void are taken up",
    alters=(("viscous", "s {}"), ("yield", "s {}")),
    source="Duym, Stiens and Reybrouck, Vehicle System Dynamics 27 (1997) 109-127",
    validity="a void that forms and is taken up whatever the speed",
    requires=(Requirement.REVERSALS,),
    shows=Variable.SINCE_REVERSAL,
    quantities=(
        Quantity(
            symbol="x_v", unit="m", title="largest void, as travel that takes it up",
            low=1e-6, high=0.5, start=2e-3, scale=Scale.LOG,
        ),
        Quantity(
            symbol="lambda", unit="1", title="part of the force that is lost",
            low=0.0, high=1.0, start=1.0, off=1.0,
        ),
        Quantity(
            symbol="g", unit="1", title="void left by a metre of compression",
            low=0.05, high=100.0, start=10.0, off=10.0, scale=Scale.LOG,
        ),
        Quantity(
            symbol="e", unit="1", title="part of x_v over which the force returns",
            low=0.0, high=1.0, start=0.5,
        ),
    ),
    guesses=guesses,
    c=CLaw(
        state=("hollow", "gone"),
        code="""
        /* hollow: the void as this stroke began; gone: travelled in it since. */
        real edge = p->e * p->x_v, to_go, sample, lost, travel;

        if (!(p->x_v > K(0.0)))
            return;
        if (s->turned) {
            travel = z->gone + (s->path - s->after);
            z->hollow = s->up0 ? FMIN(z->hollow + p->g * travel, p->x_v)
                              : FMAX(z->hollow - travel, K(0.0));
            z->gone = s->after;
        } else {
            z->gone += s->path;
        }
        if (s->up)
            return;
        to_go = z->hollow - z->gone;
        sample = FMIN(FMAX(FABS(s->xdot) * s->h - edge, K(0.0)), K(2.0) * z->hollow);
        lost = to_go / FMAX(edge, K(1e-12));
        if (sample > K(1e-12)) {
            lost = ramp_area(to_go + K(0.5) * sample, edge);
            lost = (lost - ramp_area(to_go - K(0.5) * sample, edge)) / sample;
        }
        lost = K(1.0) - p->lambda * clipped(lost, K(0.0), K(1.0));
        f->viscous *= lost;
        f->yield *= lost;
        """,
    ),
)  # fmt: skip
