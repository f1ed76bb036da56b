"""What effects are behind a spring, where the piston has a speed of its own: laws of that speed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from erdctl.core.errors import IncompatibleEffects
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, in_slot
from erdctl.model.slots import (
    HysteresisSlot,
    ScaleSlot,
    SignSlot,
    TermSlot,
    Values,
    ViscousSlot,
    YieldSlot,
)

if TYPE_CHECKING:  # it is compiled, and to load a compiler costs an export 0.3 s
    from erdctl.model.at_speed import Other

NODES = 256  # of the speed grid: laws between nodes are straight lines
# m/s that the grid is made for at least. One made for a bench would be left on a road, and what a
# log is simulated on would depend on which samples it has.
FASTEST = 1.0


@lru_cache(maxsize=64)
def speed_grid(fastest: float) -> Array:
    """(NODES,) speeds [m/s] on which laws are tabulated, well beyond the fastest recorded one."""
    return np.geomspace(1e-7, 4.0 * max(fastest, FASTEST), NODES)


def level_beyond(law: Array) -> Array:
    """A law (2, m) on a grid of speeds, so that beyond it what falls goes on as it is there.

    A spring lets a piston slip faster than the grid goes. On its last line a friction that falls
    would turn round there, and drive the piston ever faster.
    Check: 3, 2 falls and becomes 3, 3; -1, -2 grows and stays.
    >>> level_beyond(np.array([[3.0, 2.0], [-1.0, -2.0]])).tolist()
    [[3.0, 3.0], [-1.0, -2.0]]
    """
    out = law.copy()
    falls = np.abs(law[:, -1]) < np.abs(law[:, -2])
    out[falls, -1] = law[falls, -2]
    return out


def refuse(effects: Sequence[Effect]) -> None:
    """Raise IncompatibleEffects for what cannot act there: a sign or a viscous force that is no law
    of speed, a yield force that remembers twice, or nobody knows how."""
    for e in effects:
        another = isinstance(e.slot, SignSlot) and e.slot.of_another
        if isinstance(e.slot, SignSlot | ViscousSlot) and not (e.of_speed or another):
            raise IncompatibleEffects(f"{e.name} cannot act behind a spring: no law of speed alone")
    remember = [e for e in effects if isinstance(e.slot, HysteresisSlot | YieldSlot)]
    for number, e in enumerate(remember):
        if number or (isinstance(e.slot, YieldSlot) and not e.slot.time):
            raise IncompatibleEffects(f"{e.name} cannot act behind a spring: a second memory")


def laws(
    effects: Sequence[Effect], values: Values, grid: Array, *, apart: bool
) -> tuple[Array, Array, Array, Array]:
    """Viscous shape, sign law, friction and factor of the yield force on a grid of speeds, (2, m)
    each: up and down.

    apart : whether that factor is apart from the sign law, which may be one of another speed
    """
    zero = np.zeros(2 * len(grid))
    speeds = np.concatenate([grid, -grid])
    # At mid-stroke and full duty, where `SignSlot` has the law that it is one of another speed.
    s = Signals(zero, zero, speeds, zero + 1.0, zero, np.array([0, len(speeds)]))
    viscous, sign, friction = speeds, np.sign(speeds), zero.copy()
    factor = one = np.ones(len(speeds))
    for e in effects:
        p = e.local(values)
        if isinstance(e.slot, SignSlot):
            sign = e.slot(s, p)
        if isinstance(e.slot, ViscousSlot):
            viscous = e.slot(s, p)
        if e.of_speed:
            for q, row in zip(e.amplitudes, e.added(s, p), strict=True):
                friction += values[e.key(q.symbol)] * row
    for e, scale in in_slot(effects, ScaleSlot):
        if e.of_speed:
            factors = scale(s, e.local(values))
            viscous = viscous * factors.get("viscous", one)
            factor = factor * factors.get("yield", one)
    if not apart:
        sign, factor = sign * factor, one
    sign, friction, factor = (level_beyond(law.reshape(2, -1)) for law in (sign, friction, factor))
    return viscous.reshape(2, -1), sign, friction, factor


def beside(
    effects: Iterable[Effect], terms: Iterable[tuple[str, Array]], values: Values, count: int
) -> Array:
    """(count,) forces of the damper that are made from the rod's motion, as no law has them behind.

    A spring in series carries them, as it does all that the damper bears.
    terms : name and (count,) unit response of every amplitude
    """
    slides = sliding(effects)
    here = [e for e in effects if e.carried and not e.of_speed]
    here = [e for e in here if slides is None or e is not slides[0]]
    names = {e.key(q.symbol) for e in here for q in e.amplitudes}
    return sum((values[name] * row for name, row in terms if name in names), np.zeros(count))


def sliding(effects: Iterable[Effect]) -> tuple[Effect, str, str] | None:
    """The friction that follows the direction over a travel, which behind a spring is the piston's,
    with the symbols of its force and of that travel; of several the first."""
    for e, term in in_slot(effects, TermSlot):
        if term.travel:
            return e, e.amplitudes[0].symbol, term.travel
    return None


def masses(effects: Iterable[Effect]) -> list[tuple[Effect, str]]:
    """What goes with the piston, which behind a spring is not accelerated as the rod is: effects,
    and of each the symbol of its mass [kg]."""
    return [(e, term.mass) for e, term in in_slot(effects, TermSlot) if term.mass]


def other(
    effects: Sequence[Effect], values: Values, s: Signals, *, inner: bool
) -> tuple[Array, Other | None]:
    """(n,) divisor of the speed in the sign law, and what no law of the speed alone is.

    inner : whether all of the damper is behind the spring, or its fluid alone
    """
    from erdctl.model.at_speed import Other

    by, lead, time, travel, rubs, over = np.ones(len(s)), 0.0, 0.0, 0.0, 0.0, 0.0
    divided = False
    for e, sign in in_slot(effects, SignSlot):
        if sign.by is not None:
            by, divided = sign.by(s, e.local(values)), True
        lead = values[e.key(sign.lead)] if sign.lead else 0.0
    for e, law in in_slot(effects, YieldSlot):
        time = values[e.key(law.time)] if law.time else 0.0
    for e, stretches in in_slot(effects, HysteresisSlot):
        travel = values[e.key(stretches.travel)]
    slides = sliding(effects) if inner else None
    if slides is not None:
        effect, force, way = slides
        rubs, over = values[effect.key(force)], values[effect.key(way)]
    yields = divided or lead != 0.0 or time > 0.0 or travel > 0.0
    plain = not yields and rubs == 0.0
    return by, None if plain else Other(yields, lead, time, travel, rubs, over)
