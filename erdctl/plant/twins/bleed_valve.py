"""A valve opens above a force in compression and closes at a lower one, with a snap."""

from __future__ import annotations

from erdctl.plant.plant import Plant
from erdctl.plant.twin import Scales, Shape, Twin


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # s: how far below the highest force the valve opens.
    opens = by.force * (1.0 - s)
    return plant.with_outside(bleed=q["left"], bleed_opens=opens, bleed_closes=opens * q["closes"])


TWIN = Twin(
    name="bleed_valve",
    family="valve",
    low=1e-3,
    start=0.4,
    high=0.95,
    build=_build,
    shows={"outside.bleed": "1", "outside.bleed_opens": "N", "outside.bleed_closes": "N"},
    shape={"left": (0.1, 0.5), "closes": (0.4, 0.7)},
    rigid=True,
)
