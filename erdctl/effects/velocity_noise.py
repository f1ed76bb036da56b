"""Velocity channel that is noisy, or late, by itself.

    xdot -> xdot_s = (1 - w) xdot + w V[x]
    V[x]_i = sum over k of a_k (x_{i+k} - x_{i-k}) / (t_{i+k} - t_{i-k})

x, xdot : (n,) logged deflection [m] and velocity [m/s]
V[x] : (n,) what the deflection says of the velocity, without phase: slopes over 1 to 40 samples
each way, weighted by a_k such that V[x] comes as near as it can to what is no noise of xdot, in
each record by itself
w : part of the velocity that is taken from the deflection [1], 0..1, off at 0; by the theory of
errors s_v^2 / (s_v^2 + s_x^2) with the noise of xdot and that of V[x], and 1 where xdot is late
Valid for a velocity with a sensor of its own. Of an xdot that was derived from x by any filter that
is not late V[x] is the same, whatever its noise: then nothing changes. Towards the ends of a record
it rests on fewer slopes, and so it does in records of few samples.
Check: x = 0.1 t m, xdot = 0.1 m/s with an error of +-0.02 m/s from sample to sample, w = 0.5: half
of the error is left.
>>> way = np.where(np.arange(900) % 2, 1.0, -1.0)
>>> s = signals(0.1 + 0.02 * way, x=0.001 * np.arange(900), step=0.01)
>>> half = velocity_noise(s, {"w": 0.5}).xdot[400:402] - 0.1
>>> half.round(4).tolist()
[-0.01, 0.01]

Source: A. Savitzky, M. J. E. Golay, Analytical Chemistry 36 (1964) 1627-1639 (derivative as
weighted differences); W. A. Fuller, Measurement Error Models (1987), ch. 1 (noise in what a model
is given).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np

from erdctl.core.quantity import Quantity
from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.effect import Effect, Requirement, Stage, Variable
from erdctl.model.slots import MotionSlot, Values

REACHES = (*range(1, 17), 20, 25, 32, 40)  # samples each way
ENDS = (40, 20, 10, 5, 2, 1)  # the most that are used, the nearer to an end of a record the fewer
FEWEST = 20  # samples of a record for each weight
SHORTEST = FEWEST + 2  # samples of a record that has any
DETERMINED = 1e-5  # of the largest singular value
BEND = 4  # of as many slopes one has the bend of the deflection over its reach beside it
CERTAIN = 4.0  # times its standard error, from which on a part of xdot is none of its noise


def velocity_noise(s: Signals, p: Values) -> Signals:
    """Motion with a better velocity."""
    if p["w"] == 0.0:
        return s
    return s.with_motion(s.x, s.xdot + p["w"] * (_of_deflection(s) - s.xdot))


@lru_cache(maxsize=4)
def _of_deflection(s: Signals) -> Array:
    """(n,) V[x]; xdot where there is none. The same for all values of w."""
    if s.sampled is not None:  # farther apart than a slope may reach
        whole, rows = s.sampled
        return np.asarray(_of_deflection(whole)[rows])
    out = s.xdot.copy()
    for a, b in pairwise(s.starts.tolist()):
        reaches = [k for i, k in enumerate(REACHES, start=1) if 2 * k + FEWEST * i <= b - a]
        if reaches:
            out[a:b] = _of_record(s.x[a:b], s.t[a:b], s.xdot[a:b], reaches)
    return out


def _of_record(x: Array, t: Array, xdot: Array, reaches: Sequence[int]) -> Array:
    """(n,) V[x] of a record; towards its ends from the slopes that there are, where these are
    nearer to it than xdot is."""
    out, done, far = xdot.copy(), len(x) // 2, reaches[-1]
    whole = slice(far, len(x) - far)
    best = _slopes(x, t, xdot, reaches)
    apart = np.sqrt(np.mean((xdot[whole] - best[whole]) ** 2))
    for most in (far, *(k for k in ENDS if k < far)):
        found = _slopes(x, t, xdot, [k for k in reaches if k <= most])
        if np.sqrt(np.mean((found[whole] - best[whole]) ** 2)) <= apart:
            for part in (slice(most, done), slice(len(x) - done, len(x) - most)):
                out[part] = found[part]
            done = most
    if done == 1:  # beyond the last slope, as fast as the next two say
        for end, near, far in ((0, 1, 2), (-1, -2, -3)):
            ahead = (t[end] - t[near]) / (t[near] - t[far])
            out[end] = out[near] + ahead * (out[near] - out[far])
    return out


def _slopes(x: Array, t: Array, xdot: Array, reaches: Sequence[int]) -> Array:
    """(n,) slopes weighted to come near to xdot; xdot where a slope would leave the record."""
    far, out = reaches[-1], xdot.copy()
    n = len(x) - 2 * far
    inner, rows = slice(far, far + n), np.empty((len(reaches), n))
    bends = np.empty((len(reaches[::BEND]), n))
    for i, k in enumerate(reaches):
        on, back = slice(far + k, far + k + n), slice(far - k, far - k + n)
        span = t[on] - t[back]
        rows[i] = (x[on] - x[back]) / span
        if i % BEND == 0:
            bends[i // BEND] = (x[on] - 2.0 * x[inner] + x[back]) / span**2
    out[inner] = _weights(rows, bends, xdot[inner]) @ rows
    return out


def _weights(rows: Array, bends: Array, values: Array) -> Array:
    """(k,) of rows (k, n) that come near to values (n,), along directions that are no noise in it.

    Slopes of a smooth motion are nearly alike: with weights of thousands their differences would
    follow what the values have beyond it. What is late in them goes with the bends (m, n).
    """
    late, size, _ = np.linalg.svd(bends.T, full_matrices=False)
    late = late[:, size > DETERMINED * size[:1]]
    rest = values - late @ (late.T @ values)
    u, size, v = np.linalg.svd(rows.T - late @ (late.T @ rows.T), full_matrices=False)
    sure = size > DETERMINED * size[:1]
    u, size, v = u[:, sure], size[sure], v[sure]
    part = u.T @ rest
    left = rest - u @ part
    noise = np.sqrt(left @ left / max(len(values) - len(part) - late.shape[1], 1))
    part[np.abs(part) < CERTAIN * noise] = 0.0
    return np.asarray((part / size) @ v)


def replaced(s: Signals, rest: Array) -> list[dict[str, float]]:
    """Starts of a search: the deflection almost alone. A late velocity left in by a hundredth moves
    turns across samples, each an error of twice the yield force."""
    return [{"w": w} for w in (0.9, 0.999)]


EFFECT = Effect(
    name="velocity_noise",
    stage=Stage.SENSOR,
    slot=MotionSlot(velocity_noise, of_samples=True),
    title="the velocity channel is noisy or late by itself",
    equation="xdot_s = (1 - w) xdot + w V[x], V[x] the velocity from slopes of the deflection",
    said="{w:%} of the velocity better taken from the deflection",
    alters=(("xdot", "xdot_s"),),
    source="Savitzky and Golay, Analytical Chemistry 36 (1964) 1627-1639; Fuller (1987)",
    validity="a velocity with a sensor of its own, not derived from the deflection",
    requires=(Requirement.SPEEDS,),
    shows=Variable.XDOT,
    quantities=(
        Quantity(
            symbol="w", unit="1", title="part of the velocity taken from the deflection",
            low=0.0, high=1.0, start=0.5,
        ),
    ),
    guesses=replaced,
    order=-10,  # the measuring chain comes before what moves behind the rod
)  # fmt: skip
