"""Effects that the contract's table does not have."""

from __future__ import annotations

from erdctl.plant.hidden.kinds import Scales, Shape, Twin
from erdctl.plant.plant import Plant


def _bumps(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(
        bumps=s * by.force, bump_pitch=q["pitch"] * by.x, bump_phase=q["phase"]
    )


def _swing(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(swing=s, swings=q["swings"] / by.duty)


def _sediment(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # Stirred up again by a part of the travel of a typical record.
    return plant.with_outside(settled=s, stirring=q["stirring"] * by.v * by.shortest * 0.3)


def _leakage(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(leakage=s / by.duty, leakage_time=q["time"] * by.shortest)


def _ringing(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # s: natural period as a part of the time that the motion needs for x/v.
    rate = by.v / (6.28 * by.x * s)
    return plant.with_channel(ring_rate=rate, ring_damping=q["damping"])


def _ripple(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(ripple=s, ripple_rate=q["rate"])


def _memory(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    time = by.x / by.v
    return plant.with_outside(
        memory=s * by.force, memory_short=q["short"] * time, memory_long=q["long"] * time,
        memory_speed=0.5 * by.v,
    )  # fmt: skip


def _bleed(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # s: how far below the highest force the valve opens.
    opens = by.force * (1.0 - s)
    return plant.with_outside(bleed=q["left"], bleed_opens=opens, bleed_closes=opens * q["closes"])


def _chatter(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    stretch = q["stretch"] * by.x
    return plant.with_outside(
        chatter=s * by.force / stretch, chatter_break=stretch, chatter_slip=q["slip"] * stretch
    )


def _clipped(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    # The range ends s below the largest force, more on one side than on the other.
    high, low = by.force * (1.0 - s), -by.force * (1.0 - q["other"] * s)
    return plant.with_channel(clip_high=high, clip_low=low, step=0.01 * s * by.force)


def _wear(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(
        wear=s * by.force, wear_travel=q["passes"] * 2 * by.x / 64, wear_span=1.2 * by.stroke
    )


def _gas_heat(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_outside(gas_heat=s * by.force / by.x, gas_heat_time=q["time"] * by.x / by.v)


def _o(*names: str) -> tuple[str, ...]:
    return tuple(f"outside.{n}" for n in names)


EFFECTS = (
    Twin(
        "uneven_bore", "", "", 1e-5, 0.1, 5.0, _bumps, _o("bumps", "bump_pitch", "bump_phase"),
        {"pitch": (0.5, 1.5), "phase": (0.0, 6.28)},
    ),
    Twin(
        "duty_viscosity", "", "viscous", 1e-3, 0.3, 0.95, _swing, _o("swing", "swings"),
        {"swings": (1.2, 2.6)},
    ),
    Twin(
        "sedimentation", "", "yielding", 1e-3, 0.3, 0.95, _sediment, _o("settled", "stirring"),
        {"stirring": (0.2, 1.0)},
    ),
    Twin(
        "electrode_leakage", "", "yielding", 1e-3, 0.3, 0.95, _leakage,
        _o("leakage", "leakage_time"), {"time": (0.1, 0.5)},
    ),
    Twin(
        "load_cell_ringing", "", "", 1e-3, 0.02, 0.2, _ringing,
        ("channel.ring_rate", "channel.ring_damping"), {"damping": (0.05, 0.25)},
    ),
    Twin(
        "field_ripple", "", "yielding", 1e-4, 0.1, 0.95, _ripple, _o("ripple", "ripple_rate"),
        {"rate": (11.0, 47.0)},
    ),
    Twin(
        "fading_memory", "", "", 1e-4, 0.2, 20.0, _memory,
        _o("memory", "memory_short", "memory_long", "memory_speed"),
        {"short": (0.2, 0.6), "long": (2.0, 6.0)},
    ),
    Twin(
        "bleed_valve", "", "", 1e-3, 0.4, 0.95, _bleed,
        _o("bleed", "bleed_opens", "bleed_closes"), {"left": (0.1, 0.5), "closes": (0.4, 0.7)},
    ),
    Twin(
        "stick_slip", "", "", 1e-5, 0.1, 5.0, _chatter,
        _o("chatter", "chatter_break", "chatter_slip"),
        {"stretch": (0.05, 0.25), "slip": (0.5, 1.2)},
    ),
    Twin(
        "clipped_channel", "", "", 1e-3, 0.3, 0.6, _clipped,
        ("channel.clip_high", "channel.clip_low", "channel.step"), {"other": (0.2, 0.9)},
    ),
    Twin(
        "bore_wear", "", "", 1e-5, 0.2, 10.0, _wear, _o("wear", "wear_travel", "wear_span"),
        {"passes": (1.0, 4.0)},
    ),
    Twin(
        "gas_heat_exchange", "", "", 1e-4, 0.2, 10.0, _gas_heat,
        _o("gas_heat", "gas_heat_time"), {"time": (0.3, 3.0)},
    ),
)  # fmt: skip
