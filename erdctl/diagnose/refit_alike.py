"""Several logs fitted with one model, so that their parameters can be compared.

What one diagnosis names and the other does not, another parameter has taken there in part: a play
lowers the stiffness of a model without it. With all that any of the models has in each of them,
what differs is the damper.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import Recording
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.diagnosis import diagnose
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters


def common_model(found: Sequence[Parameters]) -> Model:
    """The effects that any of several models has; the first one's, of a law that was learned."""
    effects: dict[str, Effect] = {}
    for p in found:
        for effect in p.model.effects:
            effects.setdefault(effect.name, effect)
    return Model(tuple(effects.values()))


def refit_alike(
    found: Sequence[Parameters], logs: Sequence[Recording | None], progress: Progress
) -> list[Parameters]:
    """Each log's parameters by a fit of the common model.

    logs : what each was fitted to; None where its model is the common one, which stays as it is
    A parameter that a model lacks starts where the first other one has it.
    Raises IncompatibleEffects where effects of several models exclude one another.
    """
    model = common_model(found)
    known = [p.estimates for p in found]
    out = []
    for i, (p, log) in enumerate(zip(found, logs, strict=True)):
        progress("refitting", part_of("logs with one model", i + 1, len(found)))
        if log is None:
            out.append(p)
            continue
        start = {
            name: next(e[name] for e in (p.estimates, *known) if name in e)
            for name in model.quantities
        }
        given = Parameters(model=model, estimates=start)
        again = parameters(diagnose(log, [], given=given, limits=False, learning=False))
        out.append(replace(again, provenance=p.provenance))
    return out
