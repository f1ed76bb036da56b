"""Fleets drawn at the level of parameters, with what wears in them; shares no code with what is
tested."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
import pyarrow as pa

from erdctl.io.campaign_table import SCHEMA

MONTH = 365.25 / 12
FIRST = datetime(2018, 1, 10)
PAPER = {  # unit, value, standard error of one fit, both relative to it
    "k_nom": ("N/m", 265.0, 0.004),
    "c_vis": ("N s/m", 51.0, 0.006),
    "T_d": ("s", 0.028, 0.01),
    "sigma": ("N", 12.8, 0.005),
    "beta": ("1", 0.48, 0.008),
}
LOWEST = 0.4e-3  # m of play from which a diagnosis names it, about
PRELOAD = 18.0  # N


@dataclass(frozen=True)
class Wear:
    """What one damper does: parameter, form (ramp or step), since [months], rate a year or step."""

    damper: str
    what: str
    parameters: tuple[str, ...]
    form: str
    since: float
    rate: float


def draw(
    seed: int, *, dampers: int = 20, months: int = 100, healthy: bool = False
) -> tuple[pa.Table, list[Wear]]:
    """A campaign table, and what wears.

    Each log has errors that are correlated and differ by log, a scatter of its own beyond them
    (weather, mounting), now and then an outlier, and some months are missing. Play is named only
    where it is large enough; from which size on is told where the seed is even. Now and then an
    effect is named that is not there.
    """
    r = np.random.default_rng(seed)
    names = [f"D{i:02d}" for i in range(1, dampers + 1)]
    worn = [] if healthy else _wear(r, names, months)
    rows: list[dict[str, object]] = []
    for name in names:
        mine = [w for w in worn if w.damper == name]
        rows += _damper(r, name, months, mine, told=seed % 2 == 0)
    columns = {f.name: [row.get(f.name) for row in rows] for f in SCHEMA}
    return pa.table(columns, schema=SCHEMA), worn


def _wear(r: np.random.Generator, names: list[str], months: int) -> list[Wear]:
    chosen = r.choice(names, 3, replace=len(names) < 3).tolist()
    since = r.uniform(0.25, 0.75, 3) * months
    both = tuple(f"{d}.{s}" for d in ("compression", "release") for s in ("c_vis", "sigma"))
    form = "step" if r.random() < 0.3 else "ramp"
    left = (months - since[0]) / 12
    leak = -r.uniform(0.3, 0.5) / (left if form == "ramp" else 1.0)
    play = r.uniform(1.0, 2.5) * 1e-3 / ((months - since[1]) / 12)
    preload = -r.uniform(0.5, 0.8) * PRELOAD / ((months - since[2]) / 12)
    return [
        Wear(chosen[0], "leak", both, form, float(since[0]), float(leak)),
        Wear(chosen[1], "play", ("backlash.g",), "ramp", float(since[1]), float(play)),
        Wear(chosen[2], "preload", ("gas_preload.F_0",), "ramp", float(since[2]), float(preload)),
    ]


def _amount(w: Wear, month: float) -> float:
    if w.form == "step":
        return w.rate if month > w.since else 0.0
    return w.rate * max(month - w.since, 0.0) / 12


def _damper(
    r: np.random.Generator, name: str, months: int, wear: list[Wear], told: bool
) -> list[dict[str, object]]:
    own = {s: 1.0 + 0.05 * r.standard_normal() for s in PAPER}
    side = {d: 1.0 + 0.03 * r.standard_normal() for d in ("compression", "release")}
    preload = PRELOAD * (1.0 + 0.1 * r.standard_normal())
    out = []
    for month in range(months):
        if r.random() < 0.07:
            continue  # nobody tested
        at = month + r.uniform(-0.2, 0.2)
        quality = r.choice(
            [1.0, 2.0, 4.0], p=[0.6, 0.3, 0.1]
        )  # a long log, a short one, a poor one
        weather = r.standard_normal()  # moves viscosity and yield together
        outlier = r.random() < 0.02
        common = {
            "log": f"{name}/{month:03d}.parquet", "hash": f"{name}{month}", "version": "0",
            "damper": name, "date": FIRST + timedelta(days=at * MONTH), "exit_code": 0,
            "noise_rms": 0.3, "nrmse": float(0.008 * (1 + 0.05 * r.standard_normal())),
            "nrmse_worst": float(0.012 * (1 + 0.08 * r.standard_normal())),
            "identified": True, "rig": [], "verdict": "explained",
        }  # fmt: skip
        rows = []
        for d in ("compression", "release"):
            shared = r.standard_normal()
            for s, (unit, value, rel) in PAPER.items():
                true = value * own[s] * side[d]
                for w in wear:
                    if w.what == "leak" and f"{d}.{s}" in w.parameters:
                        true *= 1.0 + _amount(w, at)
                error = rel * value * quality
                # sigma and beta go together in a fit, against each other
                sign = {"sigma": 1.0, "beta": -1.0}.get(s, 0.0)
                noise = 0.8 * sign * shared + (0.6 if sign else 1.0) * r.standard_normal()
                wide = {"c_vis": 0.008, "sigma": 0.006}.get(s, 0.003) * value
                seen = (
                    true
                    + error * noise
                    + wide * (weather if s in ("c_vis", "sigma") else r.standard_normal())
                )
                if outlier:
                    seen += r.choice([-1, 1]) * r.uniform(5, 15) * error
                rows.append(_row(common, "identify", f"{d}.{s}", unit, seen, error))
        findings = []
        g = sum(_amount(w, at) for w in wear if w.what == "play")
        error = 2e-5 * quality
        seen = g + error * r.standard_normal() + 3e-5 * r.standard_normal() * (g > 0)
        limit = LOWEST * quality**0.5
        if g > 0 and seen > limit:
            findings.append("backlash")
            rows.append(_row(common, "diagnose", "backlash.g", "m", seen, error))
        elif told:
            unseen = _row(common, "diagnose", "backlash.g", "m", np.nan, np.nan)
            rows.append(
                {**unseen, "value": None, "stderr": None, "high": limit, "identified": False}
            )
        f0 = preload + sum(_amount(w, at) for w in wear if w.what == "preload")
        error = 0.25 * quality
        findings.append("gas_preload")
        seen = f0 + error * r.standard_normal() + 0.3 * r.standard_normal()
        rows.append(_row(common, "diagnose", "gas_preload.F_0", "N", seen, error))
        if r.random() < 0.01:  # named by chance
            findings.append("coulomb_friction")
            rows.append(
                _row(common, "diagnose", "coulomb_friction.F_c", "N", r.uniform(0.2, 0.5), 0.05)
            )
        for row in rows:
            row["findings"] = findings
        out += rows
    return out


def _row(
    common: dict[str, object], command: str, name: str, unit: str, value: float, error: float
) -> dict[str, object]:
    return {
        **common, "command": command, "parameter": name, "unit": unit, "value": float(value),
        "stderr": float(error),
    }  # fmt: skip
