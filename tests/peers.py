"""What predicts the force of a real damper beside `diagnose`: an expert's models, black boxes.

The expert has the better, on what is fitted, of two models of the literature, whose coefficients
are of degree two in the duty: the hyperbolic tangent (N. M. Kwok et al., Sens. Actuators A 132
(2006) 441-451), and Bouc-Wen (B. F. Spencer et al., J. Eng. Mech. 123 (1997) 230-238) along the
travel behind a play. Black boxes see deflection, velocity, acceleration and duty, and the first two
10, 30 and 100 ms ago: boosted trees, the mean of three networks of two layers, and trees on what
the paper's model leaves.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.optimize import minimize
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.score.nrmse import Normalise, nrmse

LEARNED = 20_000  # samples that a black box learns from, at most
LAGS = (0.01, 0.03, 0.1)  # s
STARTS = 12  # of the expert's parameters that are not linear

Array = npt.NDArray[np.float64]


def measured(r: Recording) -> Array:
    assert r.force is not None
    return r.force


def error(r: Recording, force: Array) -> float:
    return nrmse(measured(r), force, Normalise.RANGE).nrmse


def of_model(h: Hypothesis, r: Recording) -> Array:
    return np.asarray(h.model.force(Signals.of(r), h.values))


# --- the expert


@njit(cache=False)
def played(x: Array, starts: npt.NDArray[np.intp], gap: float) -> Array:
    """Deflection behind a play of width `gap`, in the middle of it at first."""
    y = np.empty_like(x)
    for i in range(len(starts) - 1):
        y[starts[i]] = x[starts[i]]
        for k in range(starts[i] + 1, starts[i + 1]):
            y[k] = min(max(y[k - 1], x[k] - gap / 2), x[k] + gap / 2)
    return y


@njit(cache=False)
def yielding(y: Array, starts: npt.NDArray[np.intp], travel: float) -> Array:
    """Bouc-Wen of beta = 0, n = 1: dz/d|y| = (sign(dy) - z)/travel, from rest."""
    z = np.zeros_like(y)
    for i in range(len(starts) - 1):
        for k in range(starts[i] + 1, starts[i + 1]):
            step = y[k] - y[k - 1]
            kept = np.exp(-abs(step) / travel)
            z[k] = z[k - 1] * kept + np.sign(step) * (1.0 - kept)
    return z


def slope(r: Recording, y: Array) -> Array:
    out = np.empty_like(y)
    for part in r.slices:
        out[part] = np.gradient(y[part], r.t[part])
    return out


def in_duty(r: Recording, column: Array) -> list[Array]:
    return [column * r.duty**k for k in range(3)]


def tangent(r: Recording, p: Array) -> Array:
    """Columns of F = c v + k x + a tanh(b v + d sign(x)) + f; p = log of b [s/m] and d [1]."""
    loop = np.tanh(np.exp(p[0]) * r.xdot + np.exp(p[1]) * np.sign(r.x))
    columns = [c for part in (r.xdot, r.x, loop) for c in in_duty(r, part)]
    return np.column_stack([*columns, np.ones(len(r))])


def bouc_wen(r: Recording, p: Array) -> Array:
    """Columns of F = c dy + k y + a z + f behind a play; p = log of the travel and play [m]."""
    y = played(r.x, r.starts, float(np.exp(p[1])))
    z = yielding(y, r.starts, float(np.exp(p[0])))
    columns = [*in_duty(r, slope(r, y)), y, *in_duty(r, z)]
    return np.column_stack([*columns, np.ones(len(r))])


def expert(fitted: Recording, held: Recording) -> tuple[str, Array]:
    """Name and force of the hand-written model that fits better."""
    speed, stroke = float(np.std(fitted.xdot)), float(np.ptp(fitted.x))
    random = np.random.default_rng(0)
    tried = []
    for columns, low, high in (
        (tangent, (0.3 / speed, 0.01), (100.0 / speed, 3.0)),
        (bouc_wen, (1e-4 * stroke, 1e-4 * stroke), (0.5 * stroke, 0.3 * stroke)),
    ):

        def left(p: Array, columns=columns, low=low, high=high) -> float:
            if np.any(p < np.log(low)) or np.any(p > np.log(high)):
                return 1e9
            a = columns(fitted, p)
            w = np.linalg.lstsq(a, measured(fitted), rcond=None)[0]
            return float(np.std(measured(fitted) - a @ w))

        begin = random.uniform(np.log(low), np.log(high), (STARTS, 2))
        first = sorted(begin, key=left)[:3]
        best = min((minimize(left, p, method="Nelder-Mead") for p in first), key=lambda m: m.fun)
        w = np.linalg.lstsq(columns(fitted, best.x), measured(fitted), rcond=None)[0]
        tried.append((float(best.fun), columns.__name__, columns(held, best.x) @ w))
    _, name, force = min(tried, key=lambda t: t[0])
    return name, force


# --- black boxes


def seen(r: Recording) -> Array:
    """(n, k) what a black box is given."""
    columns = [r.x, r.xdot, slope(r, r.xdot), r.duty]
    for lag in LAGS:
        for channel in (r.x, r.xdot):
            late = np.empty_like(channel)
            for part in r.slices:
                late[part] = np.interp(r.t[part] - lag, r.t[part], channel[part])
            columns.append(late)
    return np.column_stack(columns)


def black_boxes(fitted: Recording, held: Recording, paper: Hypothesis) -> dict[str, Array]:
    rows = np.arange(0, len(fitted), -(-len(fitted) // LEARNED))
    z, force, new = seen(fitted)[rows], measured(fitted)[rows], seen(held)
    trees = HistGradientBoostingRegressor(early_stopping=True, random_state=0)
    size = float(np.std(force))
    nets = []
    for k in range(3):
        layers = MLPRegressor(hidden_layer_sizes=(64, 64), early_stopping=True, random_state=k)
        net = make_pipeline(StandardScaler(), layers).fit(z, force / size)
        nets.append(size * net.predict(new))
    out = {"trees": trees.fit(z, force).predict(new), "networks": np.mean(nets, axis=0)}
    rest = force - of_model(paper, fitted)[rows]
    out["paper's and trees"] = of_model(paper, held) + trees.fit(z, rest).predict(new)
    return out
