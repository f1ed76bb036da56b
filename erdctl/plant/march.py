"""The one ODE plant: from the rod's motion and the duty to the damper's force, in fine steps.

Chain: rod -> play -> mount -> piston -> gas, seals, stops and the fluid column beside each other.
Laws of a twin's own file come as arrays, worked out beforehand (`OwnLaws`).
At a record's start the states of the paper and the slow ones restart (Eq. 12 at the steady value of
the first sample, no heat, no wear); play, springs and seals are as the motion before it left them.

Compiled code is cached beside each file and notices a change of that file only: after an edit in
field, law, inside or outside, delete __pycache__.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from erdctl.plant import outside as out
from erdctl.plant.field import commanded, fades, slewed, target
from erdctl.plant.inside import (
    COLUMN,
    MOUNT,
    Instant,
    balanced,
    beside,
    fluid,
    stretch,
    yield_state,
)
from erdctl.plant.law import bent
from erdctl.plant.plant import Outside, Physics, Side

Array = npt.NDArray[np.float64]


class OwnLaws(NamedTuple):
    """What twins' own files say of each fine node, (m,) or (0,) where they say nothing.

    command : duty that the supply is told;  on_viscous, on_yield : factors;  sign : for sign(xdot)
    """

    command: Array
    on_viscous: Array
    on_yield: Array
    sign: Array


@njit(cache=True)
def march(
    x: Array, v: Array, a: Array, duty: Array, substeps: int, lead_in: int, h: float,
    up: Side, down: Side, p: Physics, o: Outside, g: OwnLaws,
) -> Array:  # fmt: skip
    """(m,) force at the fine nodes [N].

    x, v, a : (m,) deflection, velocity and acceleration of the rod at the fine nodes
    duty : (n,) at the samples, `substeps` nodes apart, the first at node `lead_in`;  h : step [s]
    """
    m = len(x)
    F = np.empty(m)
    fade = fades(h, up, down, p)
    states = np.empty(out.STATES)
    out.restart(states, x[0], o)
    way = 1.0
    for k in range(m):  # before it moves, the damper has the direction in which it will
        if v[k] != 0.0:
            way = math.copysign(1.0, v[k])
            break
    # What moves already has taken up its play and bent its seal.
    moving = way if v[0] != 0.0 else 0.0
    z = x[0] - 0.5 * p.gap * moving
    bend = p.F_p * moving
    xp = z
    if p.mount > 0.0:
        xp = z / (1.0 + (up.k_nom if way > 0.0 else down.k_nom) * p.mount)
    vp, vf, way_f = v[0], v[0], way
    column = 0.0  # deflection of the fluid column [m]
    void, hot = 0.0, 0.0
    voltage = g.command[0] if len(g.command) > 0 else duty[0]
    told, sign = len(g.sign) > 0, 0.0
    last = -1.0
    goal_c = goal_r = yielding = 0.0
    for k in range(m):
        # The first node of all is a step of no length.
        step = h if k > 0 else 0.0
        before = k - 1 if k > 0 else 0
        t = (k - lead_in) * h
        if len(g.command) > 0:
            command = g.command[k]
        else:
            command = commanded(duty, before, substeps, lead_in, h, p.dead_time)
        next_voltage = slewed(voltage, command, step, p.slew)
        mean = command if p.slew == 0.0 else 0.5 * (voltage + next_voltage)
        voltage = next_voltage
        at_plates = out.field_left(states, mean, step, o)
        if at_plates != last:
            goal_c, goal_r = target(at_plates, up, p), target(at_plates, down, p)
            last = at_plates
        if k == 0 or k == lead_in:
            # Behind a spring the fluid still goes on as before when the rod turns.
            facing = way_f
            if v[k] != 0.0 and p.mount == 0.0 and p.fluid_spring == 0.0:
                facing = math.copysign(1.0, v[k])
            yielding = goal_c if facing > 0.0 else goal_r
            if p.signed != 0.0:
                yielding *= facing if v[k] != 0.0 else 0.0
            hot = 0.0
            out.restart(states, xp, o)
            if k > 0:
                step = 0.0  # the state stands at its start
        come = 1.0 if t >= p.onset else 0.0
        if p.ramp > 0.0:
            come = min(max((t - p.onset) / p.ramp, 0.0), 1.0)
        oil = 1.0 + come * (p.oil - 1.0)
        whole = oil * (1.0 + come * (p.deformation - 1.0))
        on_viscous = whole * math.exp(-p.thin * hot) * out.viscous_factor(at_plates, o)
        on_yield = (
            whole * (1.0 + come * (p.electrical - 1.0))
            * math.exp(-p.weaken * hot) * out.yield_factor(states, t, o)
        )  # fmt: skip
        if len(g.on_viscous) > 0:
            on_viscous *= g.on_viscous[k]
        if len(g.on_yield) > 0:
            on_yield *= g.on_yield[k]
        if told:
            sign = g.sign[k]
        # The rod takes the piston along at either end of the play; in between the piston rests.
        z0 = z
        z = min(max(z, x[k] - 0.5 * p.gap), x[k] + 0.5 * p.gap)
        free = p.gap > 0.0 and not ((z > z0 and v[k] > 0.0) or (z < z0 and v[k] < 0.0))
        zv = 0.0 if free else v[k]
        za = 0.0 if free else a[k]
        if p.mount > 0.0 and k > 0:
            i = Instant(
                h, xp, vp, way, x[k], v[k], 0.0, fade, yielding, goal_c, goal_r, bend, void,
                oil, on_viscous, on_yield, told, sign,
            )  # fmt: skip
            vp1, now = balanced(MOUNT, i, up, down, p)
            if step > 0.0:
                yielding = yield_state(vp1, now, i, up, down, p)
            xp1 = xp + h * vp1
            F[k] = stretch(x[k] - xp1, p) / p.mount + p.film * (v[k] - vp1)
            power = 0.0
            if p.heating != 0.0:
                power = fluid(xp1, vp1, now, i, up, down, p) * vp1
            way = way if now == 0.0 else now
            way_f = way
        else:
            xp1, vp1 = (z, zv) if p.mount == 0.0 else (xp, vp)
            now = 0.0 if vp1 == 0.0 else math.copysign(1.0, vp1)
            if p.signed != 0.0 and now == 0.0:
                goal_c = goal_r = 0.0  # sign(0) = 0
                last = -1.0
            i = Instant(
                step, xp, vp, way, 0.0, 0.0, 0.0, fade, yielding, goal_c, goal_r, bend, void,
                oil, on_viscous, on_yield, told, sign,
            )  # fmt: skip
            held = beside(xp1, vp1, now, i, up, down, p)
            if p.fluid_spring > 0.0 and k > 0:
                c = Instant(
                    h, xp, vf, way_f, column + (xp1 - xp), 0.0, xp1, fade, yielding, goal_c,
                    goal_r, bend, void, oil, on_viscous, on_yield, told, sign,
                )  # fmt: skip
                vf, now_f = balanced(COLUMN, c, up, down, p)
                if step > 0.0:
                    yielding = yield_state(vf, now_f, c, up, down, p)
                column += xp1 - xp - h * vf
                flow = column / p.fluid_spring
                way_f = way_f if now_f == 0.0 else now_f
                power = flow * vf
            else:
                flow = fluid(xp1, vp1, now, i, up, down, p)
                yielding = yield_state(vp1, now, i, up, down, p)
                way_f = way if now == 0.0 else now
                vf = vp1
                power = flow * vp1
            out.advance(states, xp, xp1, vp, vp1, step, o)
            flow = out.bled(states, flow, o)
            F[k] = held + flow + p.mass * za + out.force(states, xp1, now, o)
            way = way if now == 0.0 else now
        bend = bent(bend, xp1 - xp, p)
        travel = xp1 - xp
        if p.void > 0.0:
            # The larger the void, the more of what compression leaves the base valve refills.
            if travel > 0.0:
                void = p.void - (p.void - void) * math.exp(-p.void_growth * travel / p.void)
            else:
                void = max(void + travel, 0.0)
        hot += step * (p.heating * max(power, 0.0) - p.cooling * hot)
        xp, vp = xp1, vp1
    return F
