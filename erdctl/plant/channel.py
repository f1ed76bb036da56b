"""What the force channel makes of the force: delay, ringing load cell, drift, range.

F'' + 2 d w F' + w^2 F = w^2 F_true     a load cell that rings
F(t - skew) + drift t, then clipped and quantised
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.signal import lfilter, lfilter_zi

from erdctl.plant.plant import FOREVER, ForceChannel

Array = npt.NDArray[np.float64]


def recorded(
    force: Array, h: float, lead_in: int, substeps: int, count: int, channel: ForceChannel
) -> Array:
    """(count,) samples of the force at fine nodes [N], `substeps` apart from node `lead_in` on."""
    if channel.ring_rate > 0.0:
        force = _rung(force, h, channel)
    at = lead_in + substeps * np.arange(count)
    if channel.skew != 0.0:
        nodes = np.arange(len(force), dtype=float)
        out = np.interp(at - channel.skew / h, nodes, force)
    else:
        out = force[at]
    if channel.drift != 0.0:
        out = out + channel.drift * substeps * h * np.arange(count)
    if channel.clip_high < FOREVER or channel.clip_low > -FOREVER:
        out = np.clip(out, channel.clip_low, channel.clip_high)
    if channel.step > 0.0:
        out = np.round(out / channel.step) * channel.step
    return np.asarray(out, dtype=float)


def _rung(force: Array, h: float, channel: ForceChannel) -> Array:
    """Second-order response by the trapezoidal rule."""
    w, d = 2 * np.pi * channel.ring_rate * h, channel.ring_damping
    b = np.array([1.0, 2.0, 1.0]) * w * w
    a = np.array([4 + 4 * d * w + w * w, 2 * w * w - 8, 4 - 4 * d * w + w * w])
    start = lfilter_zi(b, a) * force[0]
    rung, _ = lfilter(b, a, force, zi=start)
    return np.asarray(rung, dtype=float)
