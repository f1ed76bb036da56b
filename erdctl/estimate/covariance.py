"""What a fit is worth: its estimates, and errors that hold for coloured, uneven residuals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from erdctl.core.recording import Array
from erdctl.estimate.autoregressive import ColouredNoise
from erdctl.model.composed import Model
from erdctl.model.parameters import NORMAL_95, Estimate


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """Parameter estimates and what is known about them.

    values : every parameter of the model;  free : names of the estimated ones
    covariance : (p, p) of the free ones, valid under correlated residuals
    rms : weighted residual [N];  samples : number of samples with weight
    alone : standard error of each free one while all others are held, in white noise
    flat : groups of free parameters along which the data do not change the cost at all
    intervals : 95 %, of parameters that the cost is no parabola of, or that lie at a bound
    level_errors : (k, r) of what each record has of its own, where a fit has that
    jumps : why none of the free parameters is told, where the force jumps with them
    """

    model: Model
    values: dict[str, float]
    free: tuple[str, ...]
    covariance: Array
    rms: float
    noise: ColouredNoise
    samples: int
    evaluations: int
    converged: bool
    alone: Mapping[str, float] = field(default_factory=dict)
    flat: tuple[tuple[str, ...], ...] = ()
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    level_errors: Array | None = None
    jumps: str | None = None

    @property
    def stderr(self) -> dict[str, float]:
        """Standard error of every free parameter."""
        errors = np.sqrt(np.maximum(np.diag(self.covariance), 0.0))
        return dict(zip(self.free, errors.tolist(), strict=True))

    def correlation(self) -> Array:
        """(p, p) correlation of the free parameters."""
        scale = np.sqrt(np.diag(self.covariance))
        scale = np.where(scale > 0, scale, 1.0)
        return np.asarray(self.covariance / np.outer(scale, scale))


def lower_correlation(found: Fit, estimates: Mapping[str, Estimate]) -> dict[str, Any]:
    """How the errors go together, as a parameter file has it: of those with a standard error.

    parameters : their names;  lower : row i the correlations of parameter i with those before it
    """
    at = [i for i, name in enumerate(found.free) if estimates[name].stderr is not None]
    whole = found.correlation()[np.ix_(at, at)]
    return {
        "parameters": [found.free[i] for i in at],
        "lower": [np.round(whole[i, :i], 6).tolist() for i in range(len(at))],
    }


def together(found: Fit) -> dict[str, str]:
    """Why the data tell some parameters from no value of others, by name."""
    out = {}
    for group in found.flat:
        for name in group:
            others = ", ".join(n for n in group if n != name)
            out[name] = (
                f"the data change with it only together with {others}"
                if others
                else "the data do not change with it"
            )
    return out


def estimates(found: Fit, reasons: Mapping[str, str]) -> dict[str, Estimate]:
    """Every parameter with its error; those that the data do not identify have a reason instead.

    reasons : why, by name
    """
    errors, out = found.stderr, {}
    jump = {} if found.jumps is None else dict.fromkeys(found.free, found.jumps)
    reasons = {**together(found), **jump, **reasons}
    for name, q in found.model.quantities.items():
        value, reason, error = found.values[name], reasons.get(name), errors.get(name)
        within, alone = found.intervals.get(name), found.alone.get(name, np.inf)
        known = error is not None or within is not None
        bound = q.bound_at(value, error, alone) if known else None
        if reason is not None:
            out[name] = Estimate(value=None, unit=q.unit, assumed=value, reason=reason)
        elif bound is not None:
            # A fit that presses against a bound is no bell curve around it: it holds on one side.
            reach = min(NORMAL_95 * (error or 0.0), q.high - q.low)
            sides = (bound, bound + reach) if bound == q.low else (bound - reach, bound)
            out[name] = Estimate(value=bound, unit=q.unit, at_bound=True, within=within or sides)
        elif within is not None:
            half = 0.5 * (within[1] - within[0]) / NORMAL_95
            out[name] = Estimate(value=value, unit=q.unit, stderr=half, within=within)
        else:
            out[name] = Estimate(value=value, unit=q.unit, stderr=error)
    return out
