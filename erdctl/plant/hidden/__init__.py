"""Everything that a plant can hide, by the contract's names, and what lies outside its table."""

from __future__ import annotations

from erdctl.plant.hidden import fault, field, fluid, friction, outside
from erdctl.plant.hidden import linkage as motion
from erdctl.plant.hidden.kinds import Scales, Twin

CATALOGUE: dict[str, Twin] = {
    e.name: e for module in (motion, field, fluid, friction, fault) for e in module.EFFECTS
}
OUTSIDE: dict[str, Twin] = {e.name: e for e in outside.EFFECTS}

# Beyond one family: pairs that are one effect to a force channel at the rod, or undo each other.
EQUIVALENT = {
    "mount_compliance": ("fluid_compressibility",),
    "fluid_compressibility": ("mount_compliance",),
    "gas_preload": ("force_offset",),
}
UNITS = {
    "gap": "m", "mount": "m/N", "stop_high": "m", "stop_low": "m", "stop_rate": "N/m", "skew": "s",
    "threshold": "1", "screening": "1", "rise": "1", "decay": "1", "dead_time": "s", "slew": "s",
    "v_y": "m/s", "lead": "1/s", "T_d": "s", "flow_index": "1", "v_ref": "m/s",
    "turbulent": "N s2/m2", "mass": "kg", "fluid_spring": "m/N", "void": "m", "void_growth": "1",
    "bubbles": "1", "heating": "K/J", "cooling": "1/s", "thin": "1/K", "weaken": "1/K", "F_c": "N",
    "F_s": "N", "F_k": "N", "v_s": "m/s", "F_p": "N", "x_p": "m", "preload": "N", "closing": "1/m",
    "polytropic": "1", "taper": "1/m", "groove": "1/m2", "oil": "1", "electrical": "1",
    "deformation": "1", "onset": "s", "drift": "N/s", "bumps": "N", "bump_pitch": "m",
    "bump_phase": "rad", "swing": "1", "swings": "1", "settled": "1", "stirring": "m",
    "leakage": "1", "leakage_time": "s", "ring_rate": "Hz", "ring_damping": "1", "ripple": "1",
    "ripple_rate": "Hz", "memory": "N", "memory_short": "s", "memory_long": "s",
    "memory_speed": "m/s", "bleed": "1", "bleed_opens": "N", "bleed_closes": "N", "chatter": "N/m",
    "chatter_break": "m", "chatter_slip": "m", "clip_high": "N", "clip_low": "N", "step": "N",
    "wear": "N", "wear_travel": "m", "wear_span": "m", "gas_heat": "N/m", "gas_heat_time": "s",
}  # fmt: skip

__all__ = ["CATALOGUE", "EQUIVALENT", "OUTSIDE", "UNITS", "Scales", "Twin"]
