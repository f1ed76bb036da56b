"""In seals, gas and bore."""

from __future__ import annotations

import math

from erdctl.plant.hidden.kinds import Scales, Shape, Twin
from erdctl.plant.plant import Plant


def _coulomb(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """F_c = s times the damper's force."""
    return plant.with_physics(F_c=s * by.force)


def _stribeck(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Static friction s times the damper's force, kinetic a part of it."""
    return plant.with_physics(
        F_s=s * by.force, F_k=q["kinetic"] * s * by.force, v_s=q["v_s"] * by.v
    )


def _presliding(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Dahl's friction: s times the damper's force, after bending by a part of the stroke."""
    return plant.with_physics(F_p=s * by.force, x_p=q["x_p"] * by.x)


def _preload(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """s times the damper's force, mostly outward as a gas pushes."""
    return plant.with_physics(preload=s * by.force * (1.0 if q["inward"] < 0.7 else -1.0))


def _polytropic(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Eq. 3, its static part tared away: the gas volume vanishes at the rated stroke / s."""
    return plant.with_physics(closing=s / (1.1 * by.stroke), polytropic=q["exponent"])


def _position(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Damping times 1 + a x + b x^2: taper and groove, at most s at the end of the rated stroke;
    nowhere does it fall below a twentieth."""
    a, b = math.cos(q["form"]), math.sin(q["form"])
    middle = -a * a / (4 * b) if abs(a) < abs(2 * b) and b > 0 else 0.0
    fall = -min(a + b, b - a, middle)
    most = min(s / (abs(a) + abs(b)), 0.95 / max(fall, 1e-6))
    return plant.with_physics(
        taper=most * a / (1.1 * by.stroke), groove=most * b / (1.1 * by.stroke) ** 2
    )


EFFECTS = (
    Twin("coulomb_friction", "seal", "", 1e-5, 0.1, 5.0, _coulomb, ("physics.F_c",), {}),
    Twin(
        "stribeck_friction", "seal", "", 1e-5, 0.1, 5.0, _stribeck,
        ("physics.F_s", "physics.F_k", "physics.v_s"),
        {"kinetic": (0.1, 0.45), "v_s": (0.05, 0.3)},
    ),
    Twin(
        "presliding_friction", "seal", "", 1e-5, 0.1, 5.0, _presliding,
        ("physics.F_p", "physics.x_p"), {"x_p": (0.03, 0.25)},
    ),
    Twin(
        "gas_preload", "static", "", 1e-5, 0.1, 5.0, _preload, ("physics.preload",),
        {"inward": (0.0, 1.0)},
    ),
    Twin(
        "gas_polytropic", "gas", "gas", 1e-3, 0.3, 0.85, _polytropic,
        ("physics.closing", "physics.polytropic"), {"exponent": (1.0, 1.4)},
    ),
    Twin(
        "position_dependent_damping", "bore", "viscous", 1e-3, 0.3, 5.0, _position,
        ("physics.taper", "physics.groove"), {"form": (0.0, 2 * math.pi)},
    ),
)  # fmt: skip
