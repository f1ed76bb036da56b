"""Whether a simulated force can be meant: finite, and no more than the damper could ever give."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

import numpy as np

from erdctl.core.errors import ComputationProblem
from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.model.composed import Model

ABSURD = 1e3  # times what the paper's terms give on the same motion, or what was measured there
CALM = 1e4  # N, below which no force is looked at: small dampers behind stiff stops reach it


def reach(model: Model, values: Mapping[str, float], recording: Recording) -> float:
    """The highest force that the paper's terms can give on a motion, or that was measured [N].

        max(k_nom |x| + c_vis |xdot| + sigma over both directions, |force|, forces among the values)

    Check: 100 N/m, 50 N s/m and 20 N up to 0.01 m and 0.2 m/s give 1 + 10 + 20 = 31 N.
    >>> one = {"k_nom": 100.0, "c_vis": 50.0, "sigma": 20.0, "T_d": 0.0, "beta": 1.0}
    >>> values = {f"{d}.{s}": v for d in DIRECTIONS for s, v in one.items()}
    >>> x, xdot, duty = np.array([0.0, 0.01]), np.array([0.2, -0.1]), np.zeros(2)
    >>> r = Recording(x, x, xdot, duty, np.array([0, 2]), ("",))
    >>> reach(Model(), values, r)
    31.0
    """

    def most(channel: Array) -> float:
        return max(float(channel.max()), -float(channel.min()))

    x, xdot = most(recording.x), most(recording.xdot)
    terms = [
        abs(values[f"{d}.k_nom"]) * x + abs(values[f"{d}.c_vis"]) * xdot + abs(values[f"{d}.sigma"])
        for d in DIRECTIONS
    ]
    given = [abs(values[name]) for name, q in model.quantities.items() if q.unit == "N"]
    return max(*terms, *given, 0.0 if recording.force is None else most(recording.force))


def diverged(force: Array, model: Model, values: Mapping[str, float], recording: Recording) -> bool:
    """Whether a force (n,) [N] is not finite, or beyond all that motion and parameters explain."""
    top = max(float(force.max()), -float(force.min()))  # NaN if any is
    if isfinite(top) and top <= CALM:
        return False
    return not (isfinite(top) and top <= ABSURD * reach(model, values, recording))


def refuse_diverged(
    force: Array, model: Model, values: Mapping[str, float], recording: Recording
) -> None:
    """Raise ComputationProblem, with the place, for a force that `diverged`."""
    if not diverged(force, model, values, recording):
        return
    most = reach(model, values, recording)
    wild = ~np.isfinite(force) | (np.abs(force) > ABSURD * most)
    i = int(np.flatnonzero(wild)[0])
    record = int(np.searchsorted(recording.starts, i, side="right")) - 1
    size = np.abs(force[np.isfinite(force)]).max(initial=0.0)
    top = f"{size:.3g} N" if np.isfinite(force).all() else "no finite number"
    effects = ", ".join(e.name for e in model.effects)
    culprit = f"the effects {effects} and their values" if effects else "the parameters' values"
    raise ComputationProblem(
        f"the modelled force reaches {top}, first in record '{recording.names[record]}' at"
        f" t = {recording.t[i]:.6g} s, where the motion, the paper's terms and the log account for"
        f" at most {most:.3g} N: the simulation diverged, and nothing is said"
        f" from it; check {culprit}, and that the motion lies within the ranges that they were"
        " identified on (provenance.ranges of the parameter file)"
    )
