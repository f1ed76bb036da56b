"""The best that the paper's model can do on a log: least squares over all ten parameters.

    F = k_i x + c_i xdot + S_i sign(xdot),   T_i dS/dt + S = sigma_i v^beta_i,   i by direction

S is linear in sigma_c and sigma_r for given T and beta, so that four parameters are searched and
six are solved for. Written here anew: the strength of an effect must not depend on erdctl's fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.optimize import least_squares

from erdctl.plant.own import velocity
from erdctl.plant.plant import Plant, Side
from erdctl.plant.simulate import Ride

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.int64]

ROWS = 10_000  # of the residual that the search looks at
LOW = np.log([0.05, 0.05, 2e-4, 2e-4])  # beta_c, beta_r, T_c, T_r
HIGH = np.log([6.0, 6.0, 3.0, 3.0])


@dataclass(frozen=True, eq=False)
class Joined:
    """Records joined: motion, duty, and where each begins, (n,) and (r + 1,)."""

    x: Array
    v: Array
    duty: Array
    starts: Index
    dt: float


def joined(over: Sequence[Ride]) -> Joined:
    """The samples of several records."""
    x, v = zip(*(r.sampled()[1:] for r in over), strict=True)
    lengths = [r.record.samples for r in over]
    return Joined(
        np.concatenate(x), np.concatenate(v), np.concatenate([r.duty for r in over]),
        np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64), 1.0 / over[0].record.rate,
    )  # fmt: skip


def shown(samples: Joined, plant: Plant) -> Joined:
    """The samples with the velocity that the plant's own channel shows, of the true direction.

    At a turn a wrong one is an error of twice the yield force, which would be all of the misfit;
    whoever fits leaves such samples out.
    """
    if not any(o.hooks.velocity for o in plant.own):
        return samples
    records = pairwise(samples.starts.tolist())
    v = [velocity(plant.own, samples.v[a:b], k) for k, (a, b) in enumerate(records)]
    return replace(samples, v=np.copysign(np.concatenate(v), samples.v))


@njit(cache=True)
def _columns(
    x: Array, v: Array, duty: Array, starts: Index, dt: float,
    beta_c: float, beta_r: float, T_c: float, T_r: float,
) -> Array:  # fmt: skip
    """(6, n): x, xdot and yield state of either direction."""
    out = np.zeros((6, len(x)))
    fade_c, fade_r = np.exp(-dt / T_c), np.exp(-dt / T_r)
    for r in range(len(starts) - 1):
        way = 1.0
        for i in range(starts[r], starts[r + 1]):
            if v[i] != 0.0:
                way = 1.0 if v[i] > 0.0 else -1.0
                break
        s_c = s_r = 0.0
        last, u_c, u_r = -1.0, 0.0, 0.0
        for i in range(starts[r], starts[r + 1]):
            now = way if v[i] == 0.0 else (1.0 if v[i] > 0.0 else -1.0)
            j = i - 1 if i > starts[r] else i
            if duty[j] != last:
                last = duty[j]
                u_c, u_r = last**beta_c, last**beta_r
            if i == starts[r]:
                s_c, s_r = (u_c, 0.0) if now > 0.0 else (0.0, u_r)
            elif now == way:
                if now > 0.0:
                    s_c, s_r = u_c + (s_c - u_c) * fade_c, s_r * fade_c
                else:
                    s_c, s_r = s_c * fade_r, u_r + (s_r - u_r) * fade_r
            else:  # a turn inside the step: its share before and after
                share = abs(v[j]) / (abs(v[j]) + abs(v[i]))
                for part in range(2):
                    span = share if part == 0 else 1.0 - share
                    if (way if part == 0 else now) > 0.0:
                        fade = fade_c**span
                        s_c, s_r = u_c + (s_c - u_c) * fade, s_r * fade
                    else:
                        fade = fade_r**span
                        s_c, s_r = s_c * fade, u_r + (s_r - u_r) * fade
            way = now
            at = 0 if now > 0.0 else 1
            out[at, i] = x[i]
            out[2 + at, i] = v[i]
            if v[i] != 0.0:
                out[4, i], out[5, i] = s_c * now, s_r * now
    return out


def _solved(columns: Array, force: Array) -> Array:
    """Least-squares amplitudes of the columns; one that is empty gets none."""
    norm = np.sqrt((columns * columns).sum(axis=1))
    use = norm > 0
    scaled = columns[use] / norm[use, None]
    gram = scaled @ scaled.T + 1e-12 * np.eye(int(use.sum()))
    out = np.zeros(len(columns))
    out[use] = np.linalg.solve(gram, scaled @ force) / norm[use]
    return out


@dataclass(frozen=True, eq=False)
class Refit:
    """The paper's model at its best: the damper, its force and what it leaves, (n,) [N]."""

    plant: Plant
    shape: Array  # log of beta_c, beta_r, T_c, T_r
    force: Array
    rest: Array

    @property
    def rms(self) -> float:
        """Of what is left [N]."""
        return float(np.sqrt(np.mean(self.rest**2)))


def shape_of(plant: Plant) -> Array:
    """Where the search may start."""
    up, down = plant.compression, plant.release
    return np.log([up.beta, down.beta, max(up.T_d, 1e-3), max(down.T_d, 1e-3)])


def refit(samples: Joined, force: Array, starts: Sequence[Array]) -> Refit:
    """The plain damper that comes closest to a force, from the best of several starts."""
    every = max(1, len(force) // ROWS)
    scale = float(np.std(force)) or 1.0

    def columns(shape: Array) -> Array:
        beta_c, beta_r, T_c, T_r = np.exp(shape)
        built: Array = _columns(
            samples.x, samples.v, samples.duty, samples.starts, samples.dt,
            beta_c, beta_r, T_c, T_r,
        )  # fmt: skip
        return built

    def residual(shape: Array) -> Array:
        a = columns(shape)[:, ::every]
        left: Array = (_solved(a, force[::every]) @ a - force[::every]) / scale
        return left

    best = None
    for start in starts:
        found = least_squares(
            residual, np.clip(start, LOW + 1e-6, HIGH - 1e-6), bounds=(LOW, HIGH),
            diff_step=1e-4, xtol=1e-4, ftol=1e-6, gtol=1e-8, max_nfev=25,
        )  # fmt: skip
        if best is None or found.cost < best.cost:
            best = found
    assert best is not None
    a = columns(best.x)
    amplitudes = _solved(a, force)
    model = amplitudes @ a
    beta_c, beta_r, T_c, T_r = (float(u) for u in np.exp(best.x))
    k_c, k_r, c_c, c_r, sigma_c, sigma_r = (float(u) for u in amplitudes)
    plant = Plant(Side(k_c, c_c, T_c, sigma_c, beta_c), Side(k_r, c_r, T_r, sigma_r, beta_r))
    return Refit(plant, np.asarray(best.x), model, force - model)


def predicted(samples: Joined, plant: Plant) -> Array:
    """Force of a plain damper on other records [N]."""
    up, down = plant.compression, plant.release
    a = _columns(
        samples.x, samples.v, samples.duty, samples.starts, samples.dt,
        up.beta, down.beta, up.T_d, down.T_d,
    )  # fmt: skip
    amplitudes = np.array([up.k_nom, down.k_nom, up.c_vis, down.c_vis, up.sigma, down.sigma])
    model: Array = amplitudes @ a
    return model
