"""Between the duty and the yield stress."""

from __future__ import annotations

import math

from erdctl.plant.hidden.kinds import Scales, Shape, Twin
from erdctl.plant.plant import Plant


def _threshold(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """tau_y = alpha (E - E_c)^beta above E_c = s times the highest field."""
    return plant.with_physics(threshold=s * by.duty)


def _saturation(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """tau_y = alpha E_s^beta tanh((E/E_s)^beta); E_s = the highest field / s."""
    return plant.with_physics(screening=s / by.duty)


def _asymmetry(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """T_d e^s while chains form and T_d e^-s while they dissolve, or the other way round."""
    slow = s if q["slow_rise"] > 0.4 else -s
    return plant.with_physics(rise=math.exp(slow), decay=math.exp(-slow))


def _delay(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Dead time of s seconds."""
    return plant.with_physics(dead_time=s)


def _slew(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """The supply needs s seconds from 0 to the highest duty."""
    return plant.with_physics(slew=s / by.duty)


EFFECTS = (
    Twin(
        "field_threshold", "onset of field", "yielding", 1e-3, 0.2, 0.9, _threshold,
        ("physics.threshold",), {},
    ),
    Twin(
        "field_saturation", "top of field", "yielding", 0.02, 1.5, 12.0, _saturation,
        ("physics.screening",), {},
    ),
    Twin(
        "rise_decay_asymmetry", "field in time", "yielding", 1e-3, 0.6, 2.0, _asymmetry,
        ("physics.rise", "physics.decay"), {"slow_rise": (0.0, 1.0)},
    ),
    Twin(
        "input_delay", "field in time", "yielding", 1e-5, 0.02, 0.25, _delay,
        ("physics.dead_time",), {},
    ),
    Twin(
        "supply_slew", "field in time", "yielding", 1e-4, 0.1, 3.0, _slew, ("physics.slew",), {},
    ),
)  # fmt: skip
