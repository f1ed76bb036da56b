"""The rig before the physics: what in a recording no damper does, one file per kind of fault.

`look` runs every check, `Looking` over a log that is read in stretches. Each gives `RigFault`s;
`Rig.usable` is what a fit may use of the recording.
"""

from __future__ import annotations

from dataclasses import replace

from erdctl.bench.rig import (
    against_model,
    clipping,
    control,
    frozen,
    held,
    inverted,
    losses,
    scale,
    sign,
    spikes,
    twice,
    unlike,
    velocity,
)
from erdctl.bench.rig.fault import Rig, RigFault, sound
from erdctl.bench.rig.holding import hold
from erdctl.bench.rig.looking import Looked
from erdctl.bench.rig.pieces import FEWEST, Piece
from erdctl.core.recording import Array, Index, Recording
from erdctl.core.stretches import Stretch, stretches

__all__ = ["Looking", "Rig", "RigFault", "look"]


def look(recording: Recording, modelled: Array | None = None) -> Rig:
    """Look for faults of the rig in a recording, with force or without; nothing is repaired.

    modelled : (n,) force of a model that is known to be of this damper [N]
    """
    looking = Looking(recording.starts, recording.names)
    for part in stretches(recording):
        end = part.first + len(part)
        looking.add(part, None if modelled is None else modelled[part.first : end])
    return replace(looking.rig(), recording=recording)


class Looking:
    """The same over one stretch of a log after the other.

    starts, names : offsets and names of its records
    """

    def __init__(self, starts: Index, names: tuple[str, ...]) -> None:
        self.names, self.samples = names, int(starts[-1])
        self._looked = Looked(starts, names)
        self._both = against_model.Both(self.samples)

    def add(self, stretch: Stretch, modelled: Array | None = None) -> None:
        """The next stretch, and the modelled force of its samples (n,) [N]."""
        self._looked.add(stretch)
        force = stretch.recording.force
        if modelled is not None and force is not None:
            self._both.add(stretch.first, force[: len(stretch)], modelled)

    def rig(self) -> Rig:
        """What is wrong with it."""
        recording = self._looked.recording()
        faults: list[RigFault] = []
        if recording is not None:
            found = _look(recording, self._looked)
            faults = [self._looked.placed(f, recording) for f in found]
        codes = {f.code for f in faults}
        faults += [f for f in self._both.check() if f.code not in codes]
        return Rig(self.names, tuple(faults), len(self._looked) / max(self.samples, 1))


def _look(recording: Recording, looked: Looked) -> list[RigFault]:
    found = looked.pieces(recording)
    faults = held.check(found, "x")
    guessed = {p.record for p in found if hold(p.x) > 1.0} if faults else set()
    if (between := sound(recording, faults)) is not recording:
        found = looked.pieces(between)
    faults += scale.check(found) + velocity.check(found) + control.check(found)
    # What follows is held against motion and control, so not against what is wrong of these.
    if (sounder := sound(recording, faults)) is not recording:
        found = looked.pieces(sounder)
    clipped = clipping.check(found, "x")
    faults += clipped + frozen.check(found, "x", clipped)
    # Between samples of an x that is held nothing jumps but what the curve through them misses.
    known = [p for p in found if p.record not in guessed]
    faults += losses.gaps(found) + (losses.jumps(known, clipped) if known else [])
    faults += spikes.check(found, "x", clipped)
    wrong = {f.record for f in faults}
    faults += velocity.of_records([p for p in found if p.record not in wrong])
    if recording.force is None:
        return faults
    once = held.check(found, "force")
    if not once:
        return faults + _of_force(found, faults)
    # Of a force that is held each value is looked at once.
    thinner, rows = held.read(sounder)
    found = [p for p in looked.pieces(thinner) if len(p) >= FEWEST]
    more = _of_force(found, faults) if found else []
    placed = [f if f.samples is None else replace(f, samples=rows[f.samples]) for f in more]
    return faults + once + placed


def _of_force(found: list[Piece], faults: list[RigFault]) -> list[RigFault]:
    """What is wrong with the force, beside faults of the motion and the control."""
    out = sign.check(found)
    if not any(f.code == "force_sign" for f in out):
        out += inverted.check(found)
    clipped = clipping.check(found, "force")
    out += clipped + frozen.check(found, "force", clipped)
    out += spikes.check(found, "force", clipped) + spikes.bursts(found, clipped)
    out += twice.check(found)
    wrong = {f.record for f in [*faults, *out] if f.blocks}
    if None not in wrong:
        out += unlike.check([p for p in found if p.record not in wrong])
    return out
