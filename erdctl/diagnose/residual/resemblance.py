"""What an unexplained misfit looks like: the simple form of motion and control nearest to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem


@dataclass(frozen=True)
class Resemblance:
    """A form in words, and the correlation of the misfit with it."""

    form: str
    correlation: float


def resemblance(problem: Problem, misfit: Array) -> Resemblance | None:
    """The form most like a misfit (n,) [N], if any is."""
    weight = problem.block.weight
    found = []
    for form, values in forms(problem.block.signals).items():
        a, b = (v - np.average(v, weights=weight) for v in (misfit, values))
        scale = float(np.sqrt(np.dot(weight, a * a) * np.dot(weight, b * b)))
        if scale > 0.0:
            found.append(Resemblance(form, float(np.dot(weight, a * b)) / scale))
    best = max(found, key=lambda f: abs(f.correlation), default=None)
    return best if best is not None and abs(best.correlation) > thresholds.RESEMBLANCE else None


def forms(s: Signals) -> dict[str, Array]:
    """(n,) values of simple forms of motion and control, by what an engineer calls them."""
    start = np.repeat(s.starts[:-1], np.diff(s.starts))
    plain = {
        "the deflection": s.x,
        "the velocity": s.xdot,
        "the direction of motion": s.sign,
        "the square of the velocity, with its sign": s.xdot * np.abs(s.xdot),
        "the acceleration": s.xddot,
        "the square of the deflection": s.x**2,
    }
    fading = thresholds.RESEMBLANCE_FADING
    turning = np.exp(-np.minimum(s.since_reversal, 1e3) / fading)
    more = {
        f"the direction of motion, fading within {1e3 * fading:g} ms of a reversal": s.sign
        * turning,
        "the duty": s.duty,
        "the time in a record": s.t - s.t[start],
    }
    in_compression = {
        f"{name}, in compression only": np.where(s.compressing, values, 0.0)
        for name, values in plain.items()
    }
    with_duty = {f"{name}, times the duty": values * s.duty for name, values in plain.items()}
    return plain | more | in_compression | with_duty
