"""Lines in the spectrum of a residual: a ripple of the yield force, and a hum of the force channel.

A yield force that swings at a frequency of its own (a supply that ripples, say) is predicted by no
motion, and where the duty never changes it is as loud everywhere. But it turns over with the
motion: taken with the sign of the velocity it is one line, which noise is not, and which a hum of
the force channel is without that sign. A hum is noise and no physics, but one that the bench can
be rid of, so it is named: a line at a frequency that the motion does not reach.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.bench.direction_of_motion import motion_edge
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem


@dataclass(frozen=True)
class SpectralLine:
    """Frequency [Hz], and share of the residual's square."""

    frequency: float
    share: float


def spectral_lines(
    problem: Problem, residual: Array
) -> tuple[SpectralLine | None, SpectralLine | None]:
    """The line that turns over with the motion in a residual (n,) [N], and that which does not.

    A hum must lie beyond the frequencies of the motion in most of the records: below, a line may be
    a harmonic of what the model misses.
    """
    s = problem.block.signals
    turned, height = _line(problem, residual * s.sign)
    plain, plain_height = _line(problem, residual)
    if _stands_out(turned, height, plain):
        return turned, None
    if not _stands_out(plain, plain_height, turned):
        return None, None
    ends = [_end_of_motion(s.xdot[a:b]) for a, b in pairwise(s.starts.tolist())]
    beyond = [plain.frequency * s.typical_step > end for end in ends]
    return None, plain if sum(beyond) > len(beyond) / 2 else None


def _stands_out(line: SpectralLine, height: float, other: SpectralLine) -> bool:
    """Whether a line is one, with (or without) the sign of the motion rather than the other way."""
    strong = line.share >= thresholds.LINE_SHARE and height >= thresholds.LINE_HEIGHT
    return strong and line.share >= thresholds.LINE_OVER_PLAIN * other.share


def _end_of_motion(xdot: Array) -> float:
    """The frequency of one record beyond which there is no motion, in cycles per sample."""
    edge = motion_edge(np.abs(np.fft.rfft((xdot - xdot.mean()) * np.hanning(len(xdot)))) ** 2)
    return edge / len(xdot)


def _line(problem: Problem, values: Array) -> tuple[SpectralLine, float]:
    """The highest line in the mean spectrum of all records, and its height over what is around."""
    from scipy.ndimage import median_filter
    from scipy.signal import periodogram

    s = problem.block.signals
    weighted = values * problem.block.weight
    longest = int(np.diff(s.starts).max())
    bins = 1 << (4 * longest - 1).bit_length()
    spectrum = np.zeros(bins // 2 + 1)
    for a, b in pairwise(s.starts.tolist()):
        spectrum += periodogram(weighted[a:b], nfft=bins)[1]
    size, lowest = 2 * thresholds.LINE_AROUND, thresholds.LINE_LOWEST
    if len(spectrum) <= lowest:  # records of some ten samples have no spectrum to speak of
        return SpectralLine(0.0, 0.0), 0.0
    # A spectrum is even about its ends: a line at the last of it, as the mains are at twice their
    # frequency, is not what is around.
    around = np.maximum(median_filter(spectrum, size=size, mode="mirror"), 1e-300)
    at = lowest + int(np.argmax(spectrum[lowest:]))
    frequency = at / (bins * s.typical_step) if s.typical_step else 0.0
    line = SpectralLine(frequency, _share(problem, values, at / bins))
    return line, float(spectrum[at] / around[at])


def _share(problem: Problem, values: Array, frequency: float) -> float:
    """What a sine of each record takes of the square of (n,) values; frequency per sample.

    Fitted, as sine and cosine are one near half the samples' rate, where a spectrum counts both.
    """
    s, root = problem.block.signals, np.sqrt(problem.block.weight)
    weighted, taken = root * values, 0.0
    for a, b in pairwise(s.starts.tolist()):
        angle = 2.0 * np.pi * frequency * np.arange(b - a)
        sines = root[a:b, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        found = sines @ np.linalg.lstsq(sines, weighted[a:b], rcond=1e-6)[0]
        taken += float(np.dot(found, found))
    return taken / max(float(np.dot(weighted, weighted)), 1e-300)
