"""The load cell rings: a second-order response of the force channel."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # s: natural period as a part of the time that the motion needs for x/v.
    rate = by.v / (6.28 * by.x * s)
    return plant.with_channel(ring_rate=rate, ring_damping=q["damping"])


TWIN = Twin(
    name="load_cell_ringing",
    family="channel",
    low=1e-3,
    start=0.02,
    high=0.2,
    build=_build,
    shows={"channel.ring_rate": "Hz", "channel.ring_damping": "1"},
    shape={"damping": (0.05, 0.25)},
)
