"""A ripple of the yield force in a residual: a line in the spectrum of residual x direction.

A yield force that swings at a frequency of its own (a supply that ripples, say) is predicted by no
motion, and where the duty never changes it is as loud everywhere. But it turns over with the
motion: taken with the sign of the velocity it is one line, which noise is not, and which a hum of
the force channel is without that sign.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.problem import Problem


@dataclass(frozen=True)
class SpectralLine:
    """Frequency [Hz], and share of the residual's square."""

    frequency: float
    share: float


def spectral_line(problem: Problem, residual: Array) -> SpectralLine | None:
    """The line that turns over with the motion in a residual (n,) [N], if there is one."""
    s = problem.block.signals
    turned, height = _line(problem, residual * s.sign)
    plain, _ = _line(problem, residual)
    if turned.share < thresholds.LINE_SHARE or height < thresholds.LINE_HEIGHT:
        return None
    return turned if turned.share >= thresholds.LINE_OVER_PLAIN * plain.share else None


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
    around = np.maximum(median_filter(spectrum, size=size, mode="nearest"), 1e-300)
    at = lowest + int(np.argmax(spectrum[lowest:]))
    total = max(float(np.dot(weighted, values)), 1e-300)
    frequency = at / (bins * s.typical_step) if s.typical_step else 0.0
    return SpectralLine(frequency, float(spectrum[at]) / total), float(spectrum[at] / around[at])
