"""Faults of the damper (Eqs. 20, 22, 23) and of the force channel's zero."""

from __future__ import annotations

from erdctl.plant.hidden.kinds import Scales, Shape, Twin
from erdctl.plant.plant import Plant

ONSET = {"onset": (0.2, 0.75)}  # of the shortest record


def _oil(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """All of the force times 1 - s."""
    return plant.with_physics(oil=1.0 - s, onset=q["onset"] * by.shortest)


def _electrical(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """The yield force times 1 - s."""
    return plant.with_physics(electrical=1.0 - s, onset=q["onset"] * by.shortest)


def _deformation(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Yield and viscous force times 1 - s."""
    return plant.with_physics(deformation=1.0 - s, onset=q["onset"] * by.shortest)


def _drift(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """s times the damper's force over the longest record."""
    up = 1.0 if q["up"] > 0.5 else -1.0
    return plant.with_channel(drift=up * s * by.force / by.longest)


EFFECTS = (
    Twin(
        "oil_leakage", "slow loss", "", 1e-3, 0.2, 0.98, _oil,
        ("physics.oil", "physics.onset"), ONSET, hidden=True,
    ),
    Twin(
        "electrical_fault", "slow loss", "yielding", 1e-3, 0.2, 0.98, _electrical,
        ("physics.electrical", "physics.onset"), ONSET, hidden=True,
    ),
    Twin(
        "deformation_fault", "slow loss", "", 1e-3, 0.2, 0.98, _deformation,
        ("physics.deformation", "physics.onset"), ONSET, hidden=True,
    ),
    Twin(
        "force_drift", "zero", "", 1e-5, 0.1, 5.0, _drift, ("channel.drift",), {"up": (0.0, 1.0)},
    ),
)  # fmt: skip
