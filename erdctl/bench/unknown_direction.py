"""What of an error lies where a log does not tell the direction of motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from erdctl.bench.direction_of_motion import uncertain
from erdctl.core.recording import Array
from erdctl.core.signals import Signals

SLOW = 0.05  # of the highest speed, below which a rod at rest has its noise
MOST = 0.5  # of the squared error, from which it is said
HALF = 0.5  # of the rms error of all samples, that all others have at most


class UnknownDirection(NamedTuple):
    """Samples at which the direction is not told, and their squared error, as shares of all [1]."""

    samples: float
    squares: float

    @property
    def others(self) -> float:
        """The rms error of all other samples, in terms of that of all [1]."""
        return float(np.sqrt((1.0 - self.squares) / (1.0 - self.samples)))

    def text(self, nrmse: float) -> str:
        """In words; nrmse : of all samples."""
        return (
            f"{100 * self.squares:.0f} % of the squared error lies in the"
            f" {100 * self.samples:.2g} % of the samples at which the rod rests or turns: xdot is"
            " noise there, and the yield force has its direction; the NRMSE of all others is"
            f" {nrmse * self.others:.4f}"
        )

    def beside(self, rms: float) -> str:
        """In words, beside the rms error of all others; rms : of all samples [N]."""
        return (
            f"; that of all samples, {rms:.3g} N, is mostly of the {100 * self.samples:.2g} % at"
            " which the rod rests or turns, where xdot is noise, and the yield force has its"
            " direction: no fit weighs these"
        )


def unknown_direction(signals: Signals, error: Array) -> UnknownDirection | None:
    """The shares of a log and of a model's error (n,) [N]; None if most of the error is elsewhere.

    At rest a measured velocity is noise about 0, of which a sign law makes a force that changes its
    direction from sample to sample: the right model of a log that begins with a rest has an error
    as large as its force.
    """
    speed = np.abs(signals.xdot)
    squares = error * error
    total = float(np.sum(squares))
    slow = speed < SLOW * float(np.max(speed, initial=0.0))
    # Before the spectrum of every record is asked for its noise.
    if total == 0.0 or float(np.sum(squares[slow])) < MOST * total:
        return None
    return shares(uncertain(signals), squares)


def shares(unsure: npt.NDArray[np.bool_], squares: Array) -> UnknownDirection | None:
    """Of samples (n,) that are unsure and the squared errors (n,) of all.

    Check: of two of eight samples with 54 of 60, 0.25 and 0.9: all others have sqrt(0.1 / 0.75) of
    the rms, 0.3651.
    >>> found = shares(np.arange(8) < 2, np.array([27.0, 27.0, 1, 1, 1, 1, 1, 1]))
    >>> found.samples, found.squares, round(found.others, 4)
    (0.25, 0.9, 0.3651)
    """
    total, there = float(np.sum(squares)), float(np.sum(squares[unsure]))
    if there < MOST * total or total == 0.0 or unsure.all():
        return None
    found = UnknownDirection(float(np.mean(unsure)), there / total)
    return found if found.others < HALF else None
