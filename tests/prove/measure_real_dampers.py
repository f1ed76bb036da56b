"""Real dampers, fitted on some records and tested on others: what `diagnose` finds, what an expert
would write by hand, and what black boxes learn. By hand:

    PYTHONPATH=. python tests/prove/measure_real_dampers.py ../shared/data LOG:TEXT ...

LOG:TEXT holds out the records with TEXT in their names, LOG: alone the last fifth of each record.
NRMSE over the range of the held-out force. The expert has the better, on what is fitted, of two
models of the literature, whose coefficients are of degree two in the duty: the hyperbolic tangent
(Kwok 2006), and Bouc-Wen (Spencer 1997) along the travel behind a play. Black boxes see deflection,
velocity, acceleration and duty, and the first two 10, 30 and 100 ms ago: boosted trees, the mean
of three networks of two layers, and trees on what the paper's model leaves.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.optimize import minimize
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from erdctl.core.blocks import thinned
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs
from erdctl.score.nrmse import Normalise, nrmse

MOST = 20_000  # samples of a diagnosis, and of what a black box learns from
FIFTH = 0.2
LAGS = (0.01, 0.03, 0.1)  # s
STARTS = 12  # of the expert's parameters that are not linear

Array = npt.NDArray[np.float64]


def load(path: Path) -> Recording:
    return read_logs([str(path)], need_force=True, report=lambda line: None).recording


def split(r: Recording, text: str) -> tuple[Recording, Recording]:
    """What is fitted and what is held out."""
    if text:
        held = [i for i, name in enumerate(r.names) if text in name]
        assert 0 < len(held) < len(r.names), f"{text!r} is in {len(held)} of {r.names}"
        return r.select([i for i in range(len(r.names)) if i not in held]), r.select(held)
    last = np.zeros(len(r), dtype=bool)
    for part in r.slices:
        last[part.stop - round(FIFTH * (part.stop - part.start)) : part.stop] = True
    rows = (np.flatnonzero(~last), np.flatnonzero(last))
    first, second = (r.take(k, np.searchsorted(k, r.starts), r.names) for k in rows)
    return first, second


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
    rows = np.arange(0, len(fitted), -(-len(fitted) // MOST))
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


def row(folder: Path, log: str, text: str) -> str:
    fitted, held = split(load(folder / f"{log}.parquet"), text)
    found = diagnose(thinned(fitted, MOST), catalogue(), limits=False)
    end = found.selection if found.learned is None else found.learned.selection
    ours = error(held, of_model(end.best, held))
    name, by_hand = expert(fitted, held)
    boxes = {n: error(held, f) for n, f in black_boxes(fitted, held, found.selection.base).items()}
    paper = error(held, of_model(found.selection.base, held))
    names = ", ".join(f.effect.name for f in found.findings)
    laws = found.learned.laws if found.learned is not None else ()
    said = "; ".join([names, *(law.law.name for law in laws)])
    others = "  ".join(f"{n} {e:.4f}" for n, e in boxes.items())
    return (
        f"{log} without {text or 'the last fifth of each record'}: paper's {paper:.4f}  "
        f"diagnose {ours:.4f} [{said}; {found.verdict.value}]  expert {error(held, by_hand):.4f} "
        f"({name})  {others}"
    )


def main(arguments: Sequence[str]) -> None:
    folder = Path(arguments[0])
    for given in arguments[1:]:
        log, _, text = given.partition(":")
        print(row(folder, log, text), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
