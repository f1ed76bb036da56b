"""Do x, xdot and t belong together? Finds a wrong unit or sign of one of them, or says nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from erdctl.core.recording import Array, Index
from erdctl.io.checks import Place

# Whatever independent noise does, at this correlation it changes the slope by less than 10 %.
CERTAIN = 0.95
LOW, HIGH = 0.2, 5.0
SPANS = (1, 8, 64)  # samples that a mean velocity is taken over: long ones drown quantisation
FEWEST = 24  # mean velocities
_BLOCK, _BLOCKS, _RECORDS = 4096, 4, 64  # a million samples at most, 40 ms

# dx/dt over xdot when one of them is in another unit.
_UNITS = {
    1e3: 'x seems to be in millimetres: --map "x={x}[mm]"',
    1e2: 'x seems to be in centimetres: --map "x={x}[cm]"',
    39.37: 'x seems to be in inches: --map "x={x}[in]"',
    60.0: 't seems to be in minutes: --map "t={t}[min]"',
    1e-2: 'xdot seems to be in cm/s: --map "xdot={xdot}[cm/s]"',
    0.0254: 'xdot seems to be in inches per second: --map "xdot={xdot}[in/s]"',
    1e-3: 'xdot seems to be in mm/s: --map "xdot={xdot}[mm/s]"',
}
_MILLISECONDS = 't seems to be in milliseconds: --map "t={t}[ms]"'


def check_consistency(
    t: Array,
    x: Array,
    xdot: Array,
    starts: Index,
    place: Place,
    *,
    sources: dict[str, str],
) -> None:
    """Raise InputProblem if x clearly moves at another rate, or another way, than xdot says.

        slope = sum u v / sum v^2,   u_i = (x_{i+k} - x_i) / T,   v_i = mean of xdot over T

    with T = t_{i+k} - t_i, and both about their means; over at most 64 records and 16384 samples
    of each. A verdict needs a correlation above 0.95: noise, quantisation, an offset, drift, a
    filter or a standstill give none.

    sources : the log's own names of t, x and xdot
    """
    for first, blocks in consistency_blocks(starts):
        check_blocks(
            [(t[a:b], x[a:b], xdot[a:b]) for a, b in blocks], first, place, sources=sources
        )


def consistency_blocks(starts: Index) -> list[tuple[int, list[tuple[int, int]]]]:
    """First sample of each record that is looked at, and the samples of it that are."""
    bounds = [(int(starts[r]), int(starts[r + 1])) for r in _chosen(len(starts) - 1, _RECORDS)]
    return [(first, list(_blocks(first, end))) for first, end in bounds]


def check_blocks(
    blocks: Sequence[tuple[Array, Array, Array]],
    first: int,
    place: Place,
    *,
    sources: dict[str, str],
) -> None:
    """The check on one record that begins with sample `first`, by t, x and xdot of its blocks."""
    slope, correlation = _slope(blocks)
    if LOW <= slope <= HIGH:
        return
    t = blocks[0][0]
    step = float(t[-1] - t[0]) / (len(t) - 1)
    raise place.problem(
        f"dx/dt is {slope:.3g} times xdot (correlation {correlation:.2f}); "
        + _advice(slope, step, sources),
        first,
        sources["xdot"],
    )


def _advice(slope: float, step: float, sources: dict[str, str]) -> str:
    if slope < 0.0:
        return (
            "x and xdot must both be positive in compression: change the sign of one, e.g."
            ' --map "xdot=-{xdot}"'.format(**sources)
        )
    for ratio, text in _UNITS.items():
        if 0.85 < slope / ratio < 1.15:
            # Nobody samples a damper once a second.
            late = ratio == 1e-3 and step > 0.05
            return (_MILLISECONDS if late else text).format(**sources)
    return (
        "one of t, x and xdot is in another unit (map it, e.g."
        ' --map "x={x}[mm]"), or xdot was filtered too strongly (leave it out to have it derived)'
    ).format(**sources)


def _slope(blocks: Sequence[tuple[Array, Array, Array]]) -> tuple[float, float]:
    """Slope and correlation at the shortest span that makes them certain; else correlation 0."""
    travelled = [_integral(t, xdot) for t, _, xdot in blocks]
    for span in SPANS:
        times = np.concatenate([np.diff(t[::span]) for t, _, _ in blocks])
        if times.size < FEWEST:
            break
        u = np.concatenate([np.diff(x[::span]) for _, x, _ in blocks]) / times
        v = np.concatenate([np.diff(y[::span]) for y in travelled]) / times
        u, v = u - u.mean(), v - v.mean()
        # Not u @ v: waking the threads of BLAS takes longer than these sums.
        uu, vv, uv = (float(np.sum(a * b)) for a, b in ((u, u), (v, v), (u, v)))
        # Products, not powers: those of Python's floats raise where these become infinite.
        if not 0.0 < uu * vv < np.inf or uv * uv < CERTAIN**2 * uu * vv:
            continue
        # How many velocities share the motion: one glitch in x and xdot alike proves nothing.
        if vv * vv >= FEWEST * float(np.sum(np.square(v * v))):
            return uv / vv, uv / (uu * vv) ** 0.5
    return 1.0, 0.0


def _integral(t: Array, xdot: Array) -> Array:
    out = np.zeros_like(t)
    np.cumsum(0.5 * (xdot[1:] + xdot[:-1]) * np.diff(t), out=out[1:])
    return out


def _blocks(first: int, end: int) -> Iterator[tuple[int, int]]:
    if end - first <= _BLOCK * _BLOCKS:
        yield first, end
        return
    for begin in np.linspace(first, end - _BLOCK, _BLOCKS).astype(int).tolist():
        yield begin, begin + _BLOCK


def _chosen(count: int, most: int) -> list[int]:
    return sorted(set(np.linspace(0, count - 1, min(count, most)).astype(int).tolist()))
