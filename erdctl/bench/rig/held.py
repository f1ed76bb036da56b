"""A channel that is read at a slower rate than the log, and held in between."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from erdctl.bench.deflection_noise import HIGH_ORDER, NOISE_ORDER, variance
from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.holding import derives, hold, read_at
from erdctl.bench.rig.pieces import Piece
from erdctl.core.recording import Index, Recording

NAMED = 3  # records that are named
NOISY = 0.05  # of the effective stroke, that x is off from what its neighbours tell
REMEDIES = {
    "x": "fits take the curve through the samples at which it is read, and its slope where xdot was"
    " derived; log x at the rate of the force, or a measured xdot beside it",
    "force": "fits take the first sample of each only; log the force at the rate of x, or all"
    " channels at the rate of the force",
}


def check(found: Sequence[Piece], channel: str) -> list[RigFault]:
    """Records in which a channel goes on in steps of some samples each, as read over a slow bus."""
    held = [(p, h) for p in found if (h := hold(p.of(channel))) > 1.0]
    if not held:
        return []
    samples = None
    if channel == "force":
        left = [np.delete(np.arange(p.first, p.end), read_at(p.force, h)) for p, h in held]
        samples = np.concatenate(left)
    own = list(dict.fromkeys(p.record for p, _ in held))
    over = _span([h for _, h in held], "samples")
    rate = _span([1.0 / (h * p.step) for p, h in held], "Hz")
    logged = _span([1.0 / p.step for p, _ in held], "Hz")
    fault = [
        RigFault(
            f"{channel}_held",
            own[0] if len(own) == 1 else None,
            f"{channel} is held over {over}: it is read at {rate} in a log of {logged}"
            + _where(found, held, own),
            REMEDIES[channel],
            samples=samples,
        )
    ]
    return fault + (_too_fast(held) if channel == "x" else [])


def _too_fast(held: Sequence[tuple[Piece, float]]) -> list[RigFault]:
    """Records whose motion changes as fast as x is read, where no xdot tells what it did between.

    From one of its samples to the next it then looks like noise, of more of the stroke than a
    sensor has: with 5 % of it a velocity that is derived is off by a third of itself or more.
    """
    out: dict[int, RigFault] = {}
    for p, h in held:
        if not derives(p.recording.xdot_note, p.xdot):
            continue
        x = p.x[read_at(p.x, h)]
        noise = min(variance(x[None], order) for order in (NOISE_ORDER, HIGH_ORDER)) ** 0.5
        if noise > NOISY * float(np.std(x)):
            out[p.record] = RigFault(
                "x_held",
                p.record,
                f"it moves faster than an x that is read at {1.0 / (h * p.step):.3g} Hz tells",
                "it is left out of fits; log x faster there, or a measured xdot beside it",
                blocks=True,
            )
    return list(out.values())


def read(recording: Recording) -> tuple[Recording, Index]:
    """The recording at the samples (k,) at which its force is read, and these.

    As a log at that rate it is looked at: what is held, or joined, has not the noise of a force.
    """
    force, rows = recording.force, []
    if force is None:
        return recording, np.arange(len(recording))
    for part in recording.slices:
        values = force[part]
        held = hold(values)
        at = read_at(values, held) if held > 1.0 else np.arange(len(values))
        rows.append(at + part.start)
    own = np.concatenate(rows)
    starts = np.searchsorted(own, recording.starts)
    return recording.take(own, starts, recording.names), own


def _where(found: Sequence[Piece], held: Sequence[tuple[Piece, float]], own: Sequence[int]) -> str:
    if len(own) == 1:
        return ""
    if len(own) == len({p.record for p in found}):
        return ", in all records"
    names = list(dict.fromkeys(f"'{p.name}'" for p, _ in held))
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f", in the records {', '.join(names[:NAMED])}{more}"


def _span(values: Sequence[float], unit: str) -> str:
    low, high = f"{min(values):.3g}", f"{max(values):.3g}"
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"
