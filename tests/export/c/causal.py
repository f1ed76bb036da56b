"""Effects in Python as C can have them: knowing the past alone.

Where an effect looks ahead in Python, C is compared with these to the last digits, and with the
effect itself to see what that costs.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.model.effect import Effect
from erdctl.model.faults import FaultKind
from erdctl.model.kernels import follow
from erdctl.model.onset import AMOUNT, RAMP, START
from erdctl.model.slots import MotionSlot, ScaleSlot, Values


def steps_before(s: Signals) -> Array:
    """(n,) step before each sample, 0 at the first of a record."""
    before = np.concatenate([[0.0], s.step[:-1]])
    before[s.starts[:-1]] = 0.0
    return before


def acceleration(s: Signals, p: Values) -> Array:
    h = steps_before(s)
    change = np.diff(s.xdot, prepend=s.xdot[:1])
    return np.where(h > 0.0, change / np.where(h > 0.0, h, 1.0), 0.0)[None]


def joint(s: Signals, p: Values) -> Signals:
    slot = get("backlash").slot
    assert isinstance(slot, MotionSlot)
    moved = slot(s, p)
    if moved.engaged is None:
        return s
    # Below a half: contact behind the sample, which only the next one shows.
    engaged = np.where(moved.engaged < 0.5, 0.0, moved.engaged)
    return s.with_motion(moved.x, s.xdot * engaged, engaged)


def slid(s: Signals, p: Values) -> Array:
    path, after = (distance / p["x_d"] for distance in s.path)
    i, _ = s.turns
    before = np.maximum(path[i] - after, 0.0)
    way = np.where(s.compressing, 1.0, -1.0)
    return follow(way, path, i, before, after, np.sign(s.xdot[s.starts[:-1]]), s.starts)[None]


def void(s: Signals, p: Values) -> dict[str, Array]:
    from erdctl.effects.cavitation import NEGLIGIBLE, _area, _void

    if p["x_v"] == 0.0:
        return {}
    hollow, gone = _void(s, p["x_v"], p["g"])
    edge, to_go = p["e"] * p["x_v"], hollow - gone
    way = np.abs(s.xdot) * steps_before(s)
    sample = np.minimum(np.maximum(way - edge, 0.0), 2.0 * hollow)
    travels = sample > NEGLIGIBLE
    over = _area(to_go + 0.5 * sample, edge) - _area(to_go - 0.5 * sample, edge)
    here = to_go / max(edge, NEGLIGIBLE)
    lost = np.clip(np.where(travels, over / np.where(travels, sample, 1.0), here), 0.0, 1.0)
    left = np.where(s.compressing, 1.0, 1.0 - p["lambda"] * lost)
    return {"viscous": left, "yield": left}


def onset(kind: FaultKind, s: Signals, p: Values) -> dict[str, Array]:
    since, h = s.t - p[START], steps_before(s)
    low, high = (np.clip(since + way * h, 0.0, p[RAMP]) for way in (-0.5, 0.5))
    area = 0.5 * (high**2 - low**2) / (p[RAMP] or 1.0) + np.clip(since + 0.5 * h - p[RAMP], 0.0, h)
    at_once = np.where(since >= p[RAMP], 1.0, np.clip(since, 0.0, p[RAMP]) / (p[RAMP] or 1.0))
    weight = np.where(h > 0.0, np.clip(area / np.where(h > 0.0, h, 1.0), 0.0, 1.0), at_once)
    return dict.fromkeys(kind.groups, 1.0 - (1.0 - p[AMOUNT]) * weight)


STAND_INS = {
    "fluid_inertia": replace(get("fluid_inertia"), columns=acceleration),
    "backlash": replace(get("backlash"), slot=MotionSlot(joint, free_play=lambda p: p["g"])),
    "presliding_friction": replace(get("presliding_friction"), columns=slid),
    "cavitation": replace(get("cavitation"), slot=ScaleSlot(void)),
    **{k.value: replace(get(k.value), slot=ScaleSlot(partial(onset, k))) for k in FaultKind},
}


def causal(effect: Effect) -> Effect:
    """The effect, or what stands in for it."""
    return STAND_INS.get(effect.name, effect)
