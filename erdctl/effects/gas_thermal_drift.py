"""Gas preload that drifts as the gas warms; its temperature is not logged.

    F_gas -> F_gas + g h,   dh/dt = P - h / tau_g,   P = (F_viscous + F_yield) xdot

h : (n,) heat held by the damper [J], >= 0, and 0 as a record begins;  P : (n,) power that the fluid
dissipates [W];  g : static force gained per heat [N/J], g >= 0, off at 0, that is P_0 A_s / (T_0 C)
of Gay-Lussac's law with the heat capacity C;  tau_g : time constant of cooling [s], not below 1 s,
as that of `thermal_fade`
The force of the gas itself, which comes back, heats nothing, so that nothing is fed back.
Valid for gas and fluid at one temperature, a small part of T_0 warmer than at first; its stiffness,
which rises by the same part, changes far less than the static force.
Check: P = 10 W for 0.2 s, long tau_g, g = 0.5 N/J: h = 0, 1, 2 J and 0, 0.5, 1 N.
>>> parts, s = {"viscous": np.full(3, 10.0), "yield": np.zeros(3)}, signals(np.ones(3), step=0.1)
>>> gas_thermal_drift(parts, s, {"g": 0.5, "tau_g": 1e6}).round(4).tolist()
[0.0, 0.5, 1.0]

Source: the ER damper paper, Eq. 3 (P_0 A_s); J. C. Dixon, The Shock Absorber Handbook, 2nd ed.
(2007), gas pressure over temperature; Gordaninejad and Breese, J. Intell. Mater. Syst. Struct. 10
(1999) 634-645 (balance of heat).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from erdctl.core.quantity import Quantity, Scale
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.c_law import CLaw
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.kernels import first_order
from erdctl.model.slots import DrivenSlot, Values


def gas_thermal_drift(parts: Mapping[str, Array], s: Signals, p: Values) -> Array:
    """(n,) force of the warmed gas beyond that of the cold one [N]."""
    if p["g"] == 0.0:
        return np.zeros(len(s))
    power = np.maximum((parts["viscous"] + parts["yield"]) * s.xdot, 0.0)
    step = s.step if s.common_step is None else s.common_step
    decay = step / p["tau_g"]
    cold = np.zeros(len(s.starts) - 1)
    # Mean power of a step: the power of a damper that oscillates swings from 0 to its peak.
    mean = 0.5 * (power + np.append(power[1:], 0.0))
    return p["g"] * first_order(decay, -np.expm1(-decay) * p["tau_g"] * mean, cold, s.starts)


def warming(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: a tenth of the mean force, gained over the longest way, or settling."""
    ends = s.starts[1:] - 1
    first = s.starts[:-1]
    way = np.add.reduceat(s.path[0], first)
    g = 0.1 / max(float(way.max()), 1e-9)
    longest = max(float((s.t[ends] - s.t[first]).max()), 1.0)
    return [{"g": g, "tau_g": min(part * longest, 1e6)} for part in (0.2, 1.0, 30.0)]


EFFECT = Effect(
    name="gas_thermal_drift",
    stage=Stage.GAS,
    slot=DrivenSlot(gas_thermal_drift),
    title="gas preload drifts as the gas warms; temperature not logged",
    equation="k_nom x -> k_nom x + g h, dh/dt = (F_viscous + F_yield) xdot - h / tau_g",
    said="{g} of static force gained per heat",
    alters=(("gas", "{} + g h"),),
    source="the ER damper paper, Eq. 3; Dixon, The Shock Absorber Handbook (2007)",
    validity="one temperature of gas and fluid, cold as a record begins",
    requires=(Requirement.TIME,),
    shows=Variable.ENERGY,
    quantities=(
        Quantity(
            symbol="g", unit="N/J", title="static force gained per heat",
            low=0.0, high=1e3, start=0.01,
        ),
        Quantity(
            symbol="tau_g", unit="s", title="time constant of cooling",
            low=1.0, high=1e6, start=100.0, off=100.0, scale=Scale.LOG, read_low=0.1,
        ),
    ),
    guesses=warming,
    c=CLaw(
        state=("power", "heat", "low"),
        code="""
        real power = FMAX((force->viscous + force->yield) * s->xdot, K(0.0));
        real mean = K(0.5) * (z->power + power), gone = -EXPM1(-s->h / p->tau_g);

        z->power = power;
        if (s->first || !(p->g > K(0.0)))
            return K(0.0);
        add_to(&z->heat, &z->low, (p->tau_g * mean - z->heat) * gone);
        return p->g * z->heat;
        """,
    ),
)  # fmt: skip
