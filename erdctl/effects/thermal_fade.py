"""Viscosity and yield stress that fall as dissipated power heats the fluid.

    F_viscous -> exp(-a_v h) F_viscous,   F_yield -> exp(-a_y h) F_yield
    dh/dt = P - h / tau,   P = (F_viscous + F_yield) xdot

h : (n,) heat held by the fluid [J], >= 0, and 0 as a record begins: the rise of the unlogged
temperature times the heat capacity;  P : (n,) power that the fluid dissipates [W]
a_v, a_y : loss of viscosity and of yield stress per heat [1/J], >= 0, off at 0
tau : time constant of cooling [s]; on records much shorter it does not matter. Not below 1 s: heat
leaves the oil (alpha = 1e-7 m^2/s) of a gap of 1 mm in d_e^2 / (pi^2 alpha) = 1 s, the rest later
The force of the gas, which comes back, heats nothing. Marched in time with the force that the
model itself makes. In temperature, a theta = a h with theta = h / tau would need tau to be known.
Valid for one lumped temperature, and falls of up to a few tenths, where exp is as good as others.
Check: 10 N of viscous force at 1 m/s, a_v = ln 2 / J, a_y = 0, long tau, sampled at 0.1 s: 10 N,
then 5 N at h = 1 J, then 10 * 2^-1.5 = 3.5355 N at 1.5 J.
>>> parts, s = {"viscous": np.full(3, 10.0), "yield": np.zeros(3)}, signals(np.ones(3), step=0.1)
>>> left = thermal_fade(parts, s, {"a_v": np.log(2.0), "a_y": 0.0, "tau": 1e9})
>>> (10.0 * left["viscous"]).round(4).tolist()
[10.0, 5.0, 3.5355]

Source: F. Gordaninejad, D. G. Breese, Heating of magnetorheological fluid dampers, J. Intell.
Mater. Syst. Struct. 10 (1999) 634-645.
"""

from __future__ import annotations

from collections.abc import Mapping

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import FeedbackSlot, Values


def thermal_fade(parts: Mapping[str, Array], s: Signals, p: Values) -> dict[str, Array]:
    """Factors of the viscous and the yield force, (n,) each [1]."""
    if p["a_v"] == 0.0 and p["a_y"] == 0.0:
        return {}
    from erdctl.model.recurrences import fading

    viscous, yielding = fading(
        parts["viscous"], parts["yield"], s.xdot, s.step, s.starts, p["a_v"], p["a_y"], p["tau"]
    )
    return {"viscous": viscous, "yield": yielding}


EFFECT = Effect(
    name="thermal_fade",
    stage=Stage.FLUID,
    slot=FeedbackSlot(thermal_fade),
    title="viscosity and yield stress fall as dissipated power heats the fluid",
    equation=(
        "F_viscous -> exp(-a_v h) F_viscous, F_yield -> exp(-a_y h) F_yield,"
        " dh/dt = (F_viscous + F_yield) xdot - h / tau"
    ),
    said="loss of {a_y} of yield stress and {a_v} of viscosity",
    alters=(("viscous", "exp(-a_v h) {}"), ("yield", "exp(-a_y h) {}")),
    source="Gordaninejad and Breese, J. Intell. Mater. Syst. Struct. 10 (1999) 634-645",
    validity="one lumped temperature, falls of up to a few tenths",
    requires=(Requirement.TIME,),
    shows=Variable.ENERGY,
    quantities=(
        Quantity(
            symbol="a_v", unit="1/J", title="loss of viscosity per heat",
            low=1e-12, high=1e3, start=1e-4, scale=Scale.LOG,
        ),
        Quantity(
            symbol="a_y", unit="1/J", title="loss of yield stress per heat",
            low=1e-12, high=1e3, start=1e-4, scale=Scale.LOG,
        ),
        Quantity(
            symbol="tau", unit="s", title="time constant of cooling",
            low=1.0, high=1e6, start=100.0, off=100.0, scale=Scale.LOG, read_low=0.1,
        ),
    ),
    c=CLaw(
        state=("power", "heat", "low"),
        code="""
        real gone = -EXPM1(-s->h / p->tau), viscous, yield;

        if (!(p->a_v > K(0.0)) && !(p->a_y > K(0.0)))
            return;
        if (!s->first)
            add_to(&z->heat, &z->low, (z->power * p->tau - z->heat) * gone);
        z->heat = FMAX(z->heat, K(0.0));
        viscous = EXP(-p->a_v * z->heat);
        yield = EXP(-p->a_y * z->heat);
        z->power = (viscous * force->viscous + yield * force->yield) * s->xdot;
        f->viscous *= viscous;
        f->yield *= yield;
        """,
    ),
)  # fmt: skip
