"""Whether a simulated force can be meant: finite, and no more than the damper could ever give."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from typing import NamedTuple

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


class Watch:
    """The same over one part of a recording after the other.

    What a force may reach is known at the end only, when all of the motion was seen.
    """

    def __init__(self, model: Model, values: Mapping[str, float]) -> None:
        self.model, self.values = model, values
        self.most = 0.0
        self._suspects: list[_Suspect] = []

    def add(self, force: Array, recording: Recording) -> None:
        """A force (n,) [N] over the next part of the recording."""
        self.most = max(self.most, reach(self.model, self.values, recording))
        top = max(float(force.max()), -float(force.min()))  # NaN if any is
        if isfinite(top) and top <= max(CALM, ABSURD * self.most):
            return
        last = self._suspects[-1].top if self._suspects else 0.0
        if top <= last:
            return  # where that one is no divergence, neither is this
        wild = ~np.isfinite(force) | (np.abs(force) > ABSURD * self.most)
        i = int(np.flatnonzero(wild)[0])
        record = int(np.searchsorted(recording.starts, i, side="right")) - 1
        size = float(np.abs(force[np.isfinite(force)]).max(initial=0.0))
        finite = isfinite(top)
        name, t = recording.names[record], float(recording.t[i])
        self._suspects.append(_Suspect(top if finite else inf, size, finite, name, t))

    def refuse(self) -> None:
        """Raise ComputationProblem, with the place, if the force `diverged`."""
        limit = max(CALM, ABSURD * self.most)
        first = next((s for s in self._suspects if s.top > limit), None)
        if first is None:
            return
        finite = all(s.finite for s in self._suspects)
        size = max(s.size for s in self._suspects)
        top = f"{size:.3g} N" if finite else "no finite number"
        effects = ", ".join(e.name for e in self.model.effects)
        culprit = f"the effects {effects} and their values" if effects else "the parameters' values"
        raise ComputationProblem(
            f"the modelled force reaches {top}, first in record '{first.record}' at"
            f" t = {first.t:.6g} s, where the motion, the paper's terms and the log account for"
            f" at most {self.most:.3g} N: the simulation diverged, and nothing is said"
            f" from it; check {culprit}, and that the motion lies within the ranges that they were"
            " identified on (provenance.ranges of the parameter file)"
        )


class _Suspect(NamedTuple):
    """A part with more than had been accounted for: highest, finite or not [N]; where it began."""

    top: float
    size: float
    finite: bool
    record: str
    t: float


def refuse_diverged(
    force: Array, model: Model, values: Mapping[str, float], recording: Recording
) -> None:
    """Raise ComputationProblem, with the place, for a force that `diverged`."""
    watch = Watch(model, values)
    watch.add(force, recording)
    watch.refuse()
