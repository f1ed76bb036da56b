"""The damper without what belongs to the bench that recorded it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from erdctl.model.composed import Model
from erdctl.model.effect import Effect, Stage
from erdctl.model.onset import RAMP, START
from erdctl.model.parameters import Estimate, Parameters
from erdctl.model.slots import ChannelSlot

LONG_AGO = -1e6  # s, the earliest onset that a parameter file may name


def of_the_bench(effect: Effect) -> bool:
    """Whether an effect is in the recording only: of a sensor, or of the force channel."""
    return effect.stage is Stage.SENSOR or isinstance(effect.slot, ChannelSlot)


def damper_alone(parameters: Parameters) -> tuple[Parameters, tuple[Effect, ...]]:
    """The parameters without the effects of the bench, and these effects."""
    left_out = tuple(e for e in parameters.model.effects if of_the_bench(e))
    if not left_out:
        return parameters, ()
    model = Model(tuple(e for e in parameters.model.effects if not of_the_bench(e)))
    kept = {name: parameters.estimates[name] for name in model.quantities}
    return replace(parameters, model=model, estimates=kept), left_out


def without(left_out: Sequence[Effect]) -> list[str]:
    """What was left out, in words."""
    if not left_out:
        return []
    names = ", ".join(e.name for e in left_out)
    return [f"left out, since they belong to the bench and not to the damper: {names}"]


def set_in(parameters: Parameters) -> Parameters:
    """The damper after all that sets in at some time has done so: a table knows no time."""
    estimates = dict(parameters.estimates)
    for effect in parameters.model.effects:
        if effect.sets_in:
            for symbol, value in ((START, LONG_AGO), (RAMP, 0.0)):
                key = effect.key(symbol)
                estimates[key] = Estimate(value=value, unit=estimates[key].unit)
    return replace(parameters, estimates=estimates)
