"""Between the measured rod and the piston."""

from __future__ import annotations

import math

from erdctl.plant.hidden.kinds import Scales, Shape, Twin
from erdctl.plant.plant import Plant


def _backlash(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Piston within x -+ gap/2; gap = s times the stroke."""
    return plant.with_physics(gap=s * by.x)


def _mount(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Deflects by s times the stroke under the largest force."""
    return plant.with_physics(mount=s * by.x / by.force)


def _end_stop(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Touched over the last part of the stroke; s times the damper's force at its end."""
    depth = q["depth"] * by.x
    high = by.x - depth
    low = -high * q["rebound"]
    return plant.with_physics(stop_high=high, stop_low=low, stop_rate=s * by.force / depth)


def _time_skew(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Force later (in three of four cases) or earlier by s periods of the motion, 2 pi x/v each;
    0.1 s at most. Whole steps of the simulation: no interpolation finds the jump at a reversal."""
    late = 1.0 if q["early"] < 0.75 else -1.0
    skew = min(s * 2 * math.pi * by.x / by.v, 0.1)
    return plant.with_channel(skew=late * round(skew / by.tick) * by.tick)


EFFECTS = (
    Twin("backlash", "play", "", 1e-7, 0.01, 0.5, _backlash, ("physics.gap",), {}),
    Twin("mount_compliance", "series", "", 1e-8, 0.005, 0.5, _mount, ("physics.mount",), {}),
    Twin(
        "end_stop", "stop", "", 1e-4, 0.3, 60.0, _end_stop,
        ("physics.stop_high", "physics.stop_low", "physics.stop_rate"),
        {"depth": (0.15, 0.45), "rebound": (0.9, 1.3)},
    ),
    Twin(
        "time_skew", "time", "", 1e-7, 0.003, 0.3, _time_skew, ("channel.skew",),
        {"early": (0.0, 1.0)},
    ),
)  # fmt: skip
