"""What `identify` is worth on logs that `prove --keep` left, of the paper's damper alone.

    erdctl prove --kind sparse --cases 60 --seed 1471000 --keep sparse
    PYTHONPATH=. python tests/prove/measure_identify.py sparse ...

Of each way to a velocity: logs, 95 % intervals that hold the plant's value, and the largest
residual over the noise that the plant has added.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from erdctl.estimate.identify import identify
from erdctl.io.logs import read_logs


@dataclass
class Count:
    """Of one way to a velocity."""

    logs: int = 0
    told: int = 0
    held: int = 0
    largest: float = 0.0


def measure(folders: list[Path]) -> dict[str, Count]:
    """By how the velocity was had."""
    out: dict[str, Count] = defaultdict(Count)
    for key in sorted(p for f in folders for p in f.glob("keys/case-*.json")):
        truth = json.loads(key.read_text())
        if truth["effects"]:
            continue
        log = key.parent.parent / "logs" / f"{key.stem}.parquet"
        recording = read_logs([str(log)], need_force=True, report=lambda _: None).recording
        found, count = identify(recording), out[truth["motion_noise"]["kind"]]
        count.logs += 1
        count.largest = max(count.largest, found.fit.rms / truth["force_noise"]["rms"])
        for name, estimate in found.joint.items():
            if estimate.value is None or estimate.interval is None:
                continue
            direction, symbol = name.split(".")
            low, high = estimate.interval
            count.told += 1
            count.held += low <= truth["damper"][direction][symbol] <= high
    return out


def line(kind: str, c: Count) -> str:
    """One line of the table."""
    part = c.held / max(c.told, 1)
    return f"{kind:12}{c.logs:4} logs {c.held:5} of {c.told:5} {part:6.1%}  {c.largest:.2f} x noise"


if __name__ == "__main__":
    counts = measure([Path(a) for a in sys.argv[1:]])
    for kind in sorted(counts):
        print(line(kind, counts[kind]))
    each = counts.values()
    logs, told, held = (sum(getattr(c, n) for c in each) for n in ("logs", "told", "held"))
    print(line("all", Count(logs, told, held, max((c.largest for c in each), default=0.0))))
