"""The range of the force channel ends before the damper's force does."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # The range ends s below the largest force, more on one side than on the other.
    high, low = by.force * (1.0 - s), -by.force * (1.0 - q["other"] * s)
    return plant.with_channel(clip_high=high, clip_low=low, step=0.01 * s * by.force)


TWIN = Twin(
    name="clipped_channel",
    family="range",
    low=1e-3,
    start=0.3,
    high=0.6,
    build=_build,
    shows={"channel.clip_high": "N", "channel.clip_low": "N", "channel.step": "N"},
    shape={"other": (0.2, 0.9)},
)
