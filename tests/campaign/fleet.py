"""A fleet's logs over months, some of its dampers wearing: made with NumPy, without erdctl.

    F = k x + c v + F_ER sign(v) + F_0,   T_d dF_ER/dt + F_ER = sigma duty^beta,   v of the piston

`python tests/campaign/fleet.py FOLDER DAMPERS MONTHS` writes FOLDER/D01/2020-01.parquet and so on.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pyarrow as pa
import pyarrow.parquet as pq

Array = npt.NDArray[np.float64]

RATE, FINE = 200, 10  # Hz; steps of the solution for each sample
SECONDS = 1.5  # of a record
# Their duty; None for one that is stepped at random.
RECORDS = {
    "null-1": 0.0, "null-2": 0.0, "low": 0.1, "held": 0.3, "steps-1": None, "steps-2": None,
}  # fmt: skip
NOISE = 0.15  # N rms
BEGIN = 0.3  # of the months, from which wear grows
LABEL = r"(?P<damper>D[0-9]+)/(?P<date>[0-9]+-[0-9]+)"
WEARING = {"leak": 3, "play": 7, "preload": 11}  # which damper has it


@dataclass(frozen=True)
class Health:
    """leak : part of the viscous and yield force that is lost [1];  play : [m];  preload : [N]"""

    leak: float = 0.0
    play: float = 0.0
    preload: float = 0.0


def health(damper: int, month: int, months: int, wearing: dict[str, int] = WEARING) -> Health:
    """How a damper is in a month: nothing before wear begins, then growing evenly."""
    part = max(0.0, (month / max(months - 1, 1) - BEGIN) / (1.0 - BEGIN))
    sizes = {"leak": 0.4, "play": 2e-3, "preload": 6.0}
    return replace(Health(), **{k: sizes[k] * part for k, who in wearing.items() if who == damper})


def log(damper: int, month: int, state: Health, noise: float = NOISE) -> pa.Table:
    """One log of six records: no control, held duties, duty steps; 9 s at 200 Hz."""
    own = np.random.default_rng([20, damper])
    draw = np.random.default_rng([damper, month])
    k, c, sigma, beta, T_d = (
        mean * (1.0 + 0.1 * own.uniform(-1.0, 1.0)) for mean in (220.0, 66.0, 15.0, 0.3, 0.043)
    )
    kept = 1.0 - state.leak
    parts = []
    for name, level in RECORDS.items():
        fine = np.arange(int(SECONDS * RATE * FINE)) / (RATE * FINE)
        tones = [(a, f * draw.uniform(0.9, 1.1), draw.uniform(0, 2 * np.pi))
                 for a, f in ((0.008, 1.1), (0.004, 2.9), (0.002, 5.3))]  # fmt: skip
        x = sum(a * np.sin(2 * np.pi * f * fine + p) for a, f, p in tones)
        v = sum(2 * np.pi * f * a * np.cos(2 * np.pi * f * fine + p) for a, f, p in tones)
        duty = np.zeros_like(fine)
        if level is not None:
            duty[:] = level
        else:
            duty = np.repeat(draw.choice([0.0, 0.1, 0.2, 0.4], 10), len(fine) // 10)
        piston, speed = _behind(x, v, state.play)
        yielding = _lagged(kept * sigma * duty**beta, 1.0 / (RATE * FINE * T_d))
        force = k * piston + kept * c * speed + yielding * np.sign(speed) - state.preload
        at = slice(None, None, FINE)
        measured = force[at] + noise * draw.standard_normal(len(fine[at]))
        parts.append(
            pa.table({
                "t": fine[at], "x": x[at], "xdot": v[at], "duty": duty[at], "force": measured,
                "record": [name] * len(measured),
            })
        )  # fmt: skip
    return pa.concat_tables(parts)


def write(folder: Path, dampers: int, months: int, wearing: dict[str, int] = WEARING) -> list[Path]:
    """The logs of a fleet."""
    out = []
    for damper in range(1, dampers + 1):
        place = folder / f"D{damper:02d}"
        place.mkdir(parents=True, exist_ok=True)
        for month in range(months):
            path = place / f"{2020 + month // 12}-{month % 12 + 1:02d}.parquet"
            pq.write_table(log(damper, month, health(damper, month, months, wearing)), path)
            out.append(path)
    return out


def _lagged(target: Array, step: float) -> Array:
    out, last, gone = np.empty_like(target), float(target[0]), float(np.exp(-step))
    for i, aim in enumerate(target.tolist()):
        out[i] = last
        last = aim + (last - aim) * gone
    return out


def _behind(x: Array, v: Array, gap: float) -> tuple[Array, Array]:
    """Piston behind a joint with free play, and its velocity: none inside the play."""
    if gap == 0.0:
        return x, v
    piston = np.empty_like(x)
    last = x[0] - gap / 2 if v[0] > 0 else x[0] + gap / 2
    for i, rod in enumerate(x.tolist()):
        piston[i] = last = min(max(last, rod - gap / 2), rod + gap / 2)
    moving = np.append(np.diff(piston), 0.0) != 0.0
    return piston, np.where(moving, v, 0.0)


if __name__ == "__main__":
    write(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
