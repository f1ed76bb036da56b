"""Where a log tells the direction of motion, and what of its velocity is noise."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from erdctl.core.blocks import Block
from erdctl.core.recording import Array
from erdctl.core.signals import Signals

# Standard deviations of the velocity noise within which the direction of motion is uncertain: 0.3 %
# of the samples of a normal noise lie beyond.
DIRECTION_SIGMAS = 3.0
# Share of the velocity's spectral energy that is motion, the multiple of its frequency beyond which
# the spectrum is noise, and the bins added to it.
MOTION_ENERGY, NOISE_BEYOND, NOISE_BINS = 0.99, 3, 8
# A step of the speed through 0 is a corner if it is as many times those beside it; and the share of
# it by which x turns inside of the step.
CORNER, INSIDE = 3.0, 0.3
LEAST_SPECTRUM = 32  # samples of a record whose velocity noise can be estimated


def certain(block: Block) -> Block:
    """The block without the weight of samples whose direction is uncertain, if any weight is left.

    An error of twice the yield force in a few samples next to reversals made the residual of an
    identification up to 6.6 times the noise.
    """
    weight = np.where(uncertain(block.signals), 0.0, block.weight)
    return block._replace(weight=weight) if weight.any() else block


def uncertain(signals: Signals) -> npt.NDArray[np.bool_]:
    """(n,) whether the direction of motion cannot be trusted.

    A differentiated, noisy deflection has the wrong sign at some samples next to reversals, and a
    sign law turns each into an error of twice the yield force. These samples say nothing about the
    physics; the noise of xdot is what it holds above the frequencies of its motion. Where a
    triangle turns, no speed is small, and what is derived may have the turn a sample off.
    """
    out = np.zeros(len(signals), dtype=np.bool_)
    for a, b in zip(signals.starts[:-1].tolist(), signals.starts[1:].tolist(), strict=True):
        xdot = signals.xdot[a:b]
        if b - a < LEAST_SPECTRUM:
            continue
        out[a:b] = np.abs(xdot) < DIRECTION_SIGMAS * velocity_noise(xdot)
        if signals.derived:
            out[a:b] |= _beside_corners(signals.x[a:b], xdot, signals.step[a:b])
    return out


def _beside_corners(x: Array, xdot: Array, step: Array) -> npt.NDArray[np.bool_]:
    """(n,) of the two samples between which the direction jumps those that x may have on one side.

    Check: of a turn from 1 to -1 after sample 4, for which x turns in the middle to 5, near 4, and
    near 5.
    >>> v, t, at = np.repeat([1.0, -1.0], 5), np.arange(10.0), (4.5, 4.1, 4.9)
    >>> turns = [_beside_corners(-np.abs(t - turn), v, np.ones(10)) for turn in at]
    >>> [np.flatnonzero(turn).tolist() for turn in turns]
    [[], [4], [5]]
    """
    out = np.zeros(len(xdot), dtype=np.bool_)
    change = np.abs(np.diff(xdot))
    way = np.sign(xdot)
    i = np.flatnonzero(way[1:] != way[:-1])
    i = i[(i > 2) & (i < len(change) - 3)]
    beside = np.maximum(change[i - 3] + change[i - 2], change[i + 2] + change[i + 3]) / 2.0
    i = i[change[i] > CORNER * beside]
    after = ((x[i + 1] - x[i]) / step[i] - xdot[i]) / (xdot[i + 1] - xdot[i])  # of the turn
    out[i[after > 1.0 - INSIDE]] = True
    out[i[after < INSIDE] + 1] = True
    return out


def velocity_noise(xdot: Array) -> float:
    """Standard deviation of the noise in the velocity of one record (n,) [m/s].

    The spectrum of a test's motion ends somewhere; what lies beyond three times the frequency that
    holds 99 % of the energy is noise, and noise goes on below it at about the same density.
    """
    window = np.hanning(len(xdot))
    power = np.abs(np.fft.rfft((xdot - xdot.mean()) * window)) ** 2
    total = np.cumsum(power)
    edge = motion_edge(power)
    if total[-1] == 0.0 or edge >= len(power):
        return 0.0
    beyond = float(total[-1] - total[edge])
    share = 2.0 * beyond / (np.sum(window**2) * len(xdot))
    return float(np.sqrt(share))


def motion_edge(power: Array) -> int:
    """The bin of a velocity's power spectrum (k,) beyond which there is no motion."""
    total = np.cumsum(power)
    motion = int(np.searchsorted(total, MOTION_ENERGY * total[-1]))
    return NOISE_BEYOND * motion + NOISE_BINS
