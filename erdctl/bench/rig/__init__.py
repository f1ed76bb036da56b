"""The rig before the physics: what in a recording no damper does, one file per kind of fault.

`look` runs every check. Each gives `RigFault`s; `Rig.usable` is what a fit may
use of the recording.
"""

from __future__ import annotations

from dataclasses import replace

from erdctl.bench.rig import (
    against_model,
    clipping,
    frozen,
    losses,
    scale,
    sign,
    spikes,
    unlike,
    velocity,
)
from erdctl.bench.rig.fault import Rig, RigFault, sound
from erdctl.bench.rig.pieces import pieces
from erdctl.core.recording import Array, Recording

__all__ = ["Rig", "RigFault", "look"]


def look(recording: Recording, modelled: Array | None = None) -> Rig:
    """Look for faults of the rig in a recording, with force or without; nothing is repaired.

    modelled : (n,) force of a model that is known to be of this damper [N]
    """
    found = _look(recording)
    if modelled is None:
        return found
    codes = {f.code for f in found.faults}
    more = [f for f in against_model.check(recording, modelled) if f.code not in codes]
    return replace(found, faults=(*found.faults, *more))


def _look(recording: Recording) -> Rig:
    found = pieces(recording)
    looked = sum(len(p) for p in found) / max(len(recording), 1)
    if not found:
        return Rig(recording, (), looked)
    faults = scale.check(found) + velocity.check(found)
    # What follows is held against the motion, so not against a velocity that is wrong itself.
    if (sounder := sound(recording, faults)) is not recording:
        found = pieces(sounder)
    clipped = clipping.check(found, "x")
    faults += clipped + frozen.check(found, "x", clipped)
    faults += losses.gaps(found) + losses.jumps(found, clipped) + spikes.check(found, "x", clipped)
    if recording.force is None:
        return Rig(recording, tuple(faults), looked)
    faults += sign.check(found)
    clipped = clipping.check(found, "force")
    faults += clipped + frozen.check(found, "force", clipped)
    faults += spikes.check(found, "force", clipped) + spikes.bursts(found, clipped)
    wrong = {f.record for f in faults if f.blocks}
    if None not in wrong:
        faults += unlike.check([p for p in found if p.record not in wrong])
    return Rig(recording, tuple(faults), looked)
