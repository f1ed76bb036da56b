"""What a rig would get out of a written sequence, judged by the CSV and its manifest alone.

Plain loops over plain numbers, on purpose: this shares neither code nor method with erdctl.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

CHANNELS = ("fl", "fr", "rl", "rr")


@dataclass(frozen=True)
class Run:
    """One record of a written sequence: times, duties by channel, and its first row."""

    first: int
    t: list[float]
    xdot: list[float]
    given: list[float]
    duties: dict[str, list[float]]


def replay(path: Path) -> tuple[list[Run], dict[str, Any]]:
    """The records of a written CSV, and its manifest."""
    manifest = json.loads(Path(f"{path}.manifest.json").read_text())
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    runs: list[Run] = []
    name: str | None = None
    for number, row in enumerate(rows):
        if not runs or row.get("record") != name:
            name = row.get("record")
            runs.append(Run(number, [], [], [], {c: [] for c in CHANNELS}))
        run = runs[-1]
        run.t.append(float(row["t"]))
        run.xdot.append(float(row["xdot"]))
        run.given.append(float(row["duty_healthy"]))
        for c in CHANNELS:
            run.duties[c].append(float(row[f"duty_{c}"]))
    return runs, manifest


def faults_of(t: list[float], duty: list[float], limits: dict[str, Any]) -> list[tuple[int, str]]:
    """Samples of one record that break a declared limit, and which."""
    slew = limits["slew"]["value"] if limits["slew"] else None
    rate = limits["update_rate"]["value"] if limits["update_rate"] else None
    step = limits["resolution"]
    out: list[tuple[int, str]] = []
    changed = t[0]
    for i, v in enumerate(duty):
        if not 0.0 <= v <= 1.0:
            out.append((i, "range"))
        if v > limits["duty_max"] + 1e-12:
            out.append((i, "ceiling"))
        if step and abs(v / step - round(v / step)) > 1.01e-6:
            out.append((i, "resolution"))
        if i == 0 or v == duty[i - 1]:
            continue
        waited, size = t[i] - changed, abs(v - duty[i - 1])
        rounding = 4e-16 * abs(t[i])
        if rate is not None and waited < (1.0 - 1e-8) / rate - rounding:
            out.append((i, "update rate"))
        if slew is not None and size > slew * (waited + rounding) * (1.0 + 1e-8) + 1e-12:
            out.append((i, "slew"))
        if slew is not None and not (step and size <= step * (1.0 + 1e-5)):
            # No leap after a rest: the latest update before this one.
            p = i - 1
            while rate is not None and p > 0 and t[i] - t[p] < (1.0 - 1e-8) / rate - rounding:
                p -= 1
            if size > slew * (t[i] - t[p] + rounding) * (1.0 + 1e-8) + 1e-12:
                out.append((i, "leap"))
        changed = t[i]
    return out


def back_after(
    run: Run, channel: str, acts: Callable[[float, float, float], bool]
) -> tuple[list[int], list[int]]:
    """Samples on the way back to the given duty after a fault, and others that leave it.

    acts : whether a fault acts on the channel, of time, speed and the record's first time
    """
    back: list[int] = []
    strange: list[int] = []
    away = False
    for i, (t, v) in enumerate(zip(run.t, run.duties[channel], strict=True)):
        if acts(t, run.xdot[i], run.t[0]):
            away = True
        elif v == run.given[i]:
            away = False
        else:
            (back if away else strange).append(i)
    return back, strange
