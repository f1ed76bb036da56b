"""Random mimic plans: a log, faults, limits and options, all out of one seed."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from places import FIXTURES

KINDS = ("oil", "electrical", "deformation")
CHANNELS = ("fl", "fr", "rl", "rr")
STARTS = (0.0, 0.0, 12.5, 4321.0, 1e6)  # s, of a record's clock
# Of every kind that stands between duty and force, with values that are felt in a short log.
EFFECTS: tuple[dict[str, Any], ...] = (
    {"effect": "input_delay", "parameters": {"tau": {"value": 0.02, "unit": "s"}}},
    {"effect": "supply_slew", "parameters": {"T_full": {"value": 0.3, "unit": "s"}}},
    {"effect": "signed_yield_lag", "parameters": {"T_s": {"value": 0.03, "unit": "s"}}},
    {"effect": "preyield_viscosity", "parameters": {"v_y": {"value": 0.03, "unit": "m/s"}}},
    {"effect": "coulomb_friction", "parameters": {"F_c": {"value": 2.0, "unit": "N"}}},
)


@dataclass(frozen=True)
class RandomFault:
    """One fault as the generator knows it; `flow` [m/s] in place of a factor."""

    kind: str
    channel: str
    factor: float
    start: float | None
    end: float | None
    ramp: float
    flow: float | None

    def __str__(self) -> str:
        size = f"{self.factor!r}" if self.flow is None else f"flow:{self.flow!r}"
        text = f"{self.kind}={size}"
        if self.start is not None:
            text += f"@{self.start!r}" + ("" if self.end is None else f":{self.end!r}")
        return text + (f",ramp={self.ramp!r}" if self.ramp else "") + f",channel={self.channel}"

    def acts(self, t: float, xdot: float, first: float) -> bool:
        """Whether it changes anything at a moment; `first` is the first time of the record."""
        since = t - (first if self.start is None else self.start)
        if since < 0.0 or (self.ramp > 0.0 and since == 0.0):
            return False
        if self.end is not None and t >= self.end:
            return False
        return self.factor < 1.0 if self.flow is None else abs(xdot) > self.flow


@dataclass(frozen=True)
class RandomPlan:
    """What one call of mimic is given."""

    log: pd.DataFrame
    parameters: dict[str, Any]
    faults: tuple[RandomFault, ...]
    options: dict[str, Any] = field(default_factory=dict)


def random_plan(seed: int) -> RandomPlan:
    """The plan of a seed."""
    r = np.random.default_rng(seed)
    parts = []
    for number in range(int(r.choice([1, 1, 2, 3]))):
        t = _times(r, int(r.integers(40, 400)))
        x, xdot = _motion(r, t - t[0])
        duty = _healthy(r, t - t[0])
        parts.append(
            pd.DataFrame({"t": t, "x": x, "xdot": xdot, "duty": duty, "record": f"r{number}"})
        )
    log = pd.concat(parts, ignore_index=True)
    if len(parts) == 1 and r.random() < 0.5:
        log = log.drop(columns="record")
    parameters = json.loads((FIXTURES / "table_2.json").read_text())
    if r.random() < 0.2:
        count = int(r.choice([1, 1, 2]))
        parameters["effects"] = [EFFECTS[i] for i in r.choice(len(EFFECTS), count, replace=False)]
    options = {
        "duty_max": float(r.choice([0.45, 0.45, 0.3, 0.2, 1.0, r.uniform(0.05, 1.0)])),
        "slew": _or_none(r, 0.7, [0.2, 1.0, 5.0, 20.0, float(10 ** r.uniform(-2, 3))]),
        "update_rate": _or_none(r, 0.7, [50.0, 100.0, 200.0, 333.0, float(r.uniform(5, 900))]),
        "resolution": float(
            r.choice([0.0, 0.0, 0.001, 0.005, 0.02, 1 / 1024, r.uniform(1e-4, 0.03)])
        ),
        "uncompensated": bool(r.random() < 0.15),
        "duty": _or_none(r, 0.2, [0.0, 0.1, 0.3, 0.3]),
    }
    faults = tuple(_fault(r, log) for _ in range(int(r.choice([1, 1, 2, 3, 4]))))
    return RandomPlan(log, parameters, faults, options)


def _or_none(r: np.random.Generator, part: float, values: list[float]) -> float | None:
    return float(r.choice(values)) if r.random() < part else None


def _times(r: np.random.Generator, n: int) -> np.ndarray:
    step = float(r.choice([0.001, 0.002, 0.003, 0.005, 0.005, 0.007, 0.01, r.uniform(5e-4, 0.02)]))
    kind = r.choice(["uniform", "uniform", "jittered", "rounded", "wild", "gaps"])
    t = np.arange(n) * step
    if kind == "jittered":
        t = np.cumsum(step * r.uniform(0.7, 1.3, n))
    elif kind == "rounded":  # as a recorder that keeps whole units writes it
        t = np.cumsum(np.rint(r.uniform(0.3, 1.7, n) * step / 2e-4).clip(1)) * 2e-4
    elif kind == "wild":
        t = np.cumsum(step * 10.0 ** r.uniform(-1.5, 0.7, n))
    elif kind == "gaps":
        gaps = np.zeros(n)
        gaps[r.integers(1, n, 4)] = r.uniform(0.05, 1.5, 4)
        t = t + np.cumsum(gaps)
    t = t - t[0] + float(r.choice(STARTS))
    return t[np.concatenate([[True], np.diff(t) > 0.0])]


def _motion(r: np.random.Generator, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    w = 2 * np.pi * r.uniform(0.3, 5.0, 3)
    speed, phase = r.uniform(0.01, 0.1, 3), r.uniform(0, 2 * np.pi, 3)
    x = np.sum(speed / w * np.sin(np.outer(t, w) + phase), axis=1)
    xdot = np.sum(speed * np.cos(np.outer(t, w) + phase), axis=1)
    if r.random() < 0.2:  # a rig that rests for a while
        still = (t > 0.4 * t[-1]) & (t < 0.6 * t[-1])
        if still.any():
            x[still] = x[np.argmax(still)]
            xdot[still] = 0.0
    return x, xdot


def _healthy(r: np.random.Generator, t: np.ndarray) -> np.ndarray:
    kind = r.choice(["held", "held", "steps", "slow", "rare", "waves", "single precision"])
    if kind in ("held", "single precision"):
        duty = np.full(len(t), r.choice([0.0, 0.1, 0.3, 0.45, r.uniform(0, 0.5)]))
        return duty.astype(np.float32).astype(float) if kind == "single precision" else duty
    levels = r.choice([0.0, 0.1, 0.2, 0.3, 0.45, 0.6], 50)
    if kind == "steps":
        return levels[(t / r.uniform(0.02, 0.5)).astype(int) % 50]
    if kind == "rare":  # steps that a slow amplifier can take
        return 0.3 + 0.001 * ((t / 0.11).astype(int) % 5)
    if kind == "slow":
        return np.round(0.2 + 0.1 * np.sin(0.7 * t), int(r.choice([2, 3, 12])))
    return np.clip(0.2 + 0.2 * np.sin(2 * np.pi * r.uniform(0.5, 20) * t), 0, 1)


def _fault(r: np.random.Generator, log: pd.DataFrame) -> RandomFault:
    kind = str(r.choice(KINDS))
    low, high = float(log["t"].min()), float(log["t"].max())
    if high - low > 100.0:  # records on clocks of their own: in the time of one of them
        t = log["t"].to_numpy()
        near = t[np.abs(t - t[int(r.integers(len(t)))]) < 50.0]
        low, high = float(near.min()), float(near.max())
    start = float(r.uniform(low, high)) if r.random() < 0.8 else None
    if start is not None and r.random() < 0.5:
        start = float(r.choice(log["t"].to_numpy()))  # at a sample itself
    end = None
    if start is not None and r.random() < 0.6:
        end = start + float(r.choice([0.004, 0.05, 0.3, r.uniform(0.001, high - low)]))
    return RandomFault(
        kind=kind,
        channel=str(r.choice(CHANNELS)),
        factor=float(r.choice([0.0, 0.3, 0.5, 0.8, 0.99, 1.0, r.random()])),
        start=start,
        end=end,
        ramp=float(r.choice([0.0, 0.0, 0.2, r.uniform(0.001, 3.0)])),
        flow=float(r.uniform(0.01, 0.1)) if kind == "oil" and r.random() < 0.2 else None,
    )
