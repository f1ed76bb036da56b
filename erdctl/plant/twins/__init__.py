"""Everything that a plant can hide: one file each, found by its file name.

To hide a new effect add one file, `erdctl/plant/twins/NAME.py`, and nothing else; another package
adds twins through the entry-point group `erdctl.twins` (the twin's name, and its object). The file
imports nothing of erdctl but `erdctl.plant`, and shares neither formula nor constants with what
diagnoses the effect. It holds

1. a docstring with the law, and where it is from;
2. the law as pure functions of a record on the fine grid (`erdctl.plant.hooks`), as many as needed:

       voltage (U, grid, p)  -> (m,) duty that the supply follows
       viscous, yielding (grid, p) -> (m,) factors of viscous and yield force
       sign (grid, p)        -> (m,) in -1..1, in place of sign(xdot)
       force (F, grid, p)    -> (m,) force with what acts beside gas and fluid [N]
       recorded (F, grid, p) -> (m,) what the force channel shows [N]
       velocity (v, record, p) -> (n,) what the velocity channel shows [m/s]

   grid has t, x, v, a of the piston and the duty U, (m,) each, and the step h; p the parameters by
   symbol. A state is a loop over the nodes (`numba.njit`), one of a record from `grid.start` on;
3. HOOKS = Hooks("NAME", yielding=_yielding);
4. _build(plant, s, q, by), which makes a strength s parameters: s near 0 is all but nothing, `by`
   has the sizes of the campaign, q what is drawn by `shape`:

       return plant.with_own(HOOKS, depth=s, rate=q["rate"])

5. TWIN = Twin(name="NAME", family=..., low=..., start=..., high=..., build=_build,
   shows={"own.depth": "1", "own.rate": "Hz"}, shape={"rate": (11.0, 47.0)}, ...), see
   `erdctl.plant.twin`. A law by the motion of the piston is `rigid=True`.

Physics that feeds back within a step (a spring in series, heat, an oscillating supply) needs the
compiled simulation: a field of `Physics` with a value at which it is off, bit for bit, and a term
in `law`, `field`, `inside` or `march`; the twin then says `plant.with_physics(...)`.

The plant does not know what can be diagnosed: who draws a case says so (`draw(known=...)`).
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from pkgutil import iter_modules

from erdctl.plant.twin import Twin

GROUP = "erdctl.twins"

# A seed picks by place. These were there when the first proofs were published, in this order, so
# that their seeds still hide what they hid; all that came later follows by name, unlisted.
FIRST = (
    "backlash", "mount_compliance", "end_stop", "time_skew", "field_threshold", "field_saturation",
    "rise_decay_asymmetry", "input_delay", "supply_slew", "preyield_viscosity", "yield_hysteresis",
    "signed_yield_lag", "shear_thinning", "quadratic_damping", "fluid_inertia",
    "fluid_compressibility", "cavitation", "thermal_fade", "coulomb_friction", "stribeck_friction",
    "presliding_friction", "gas_preload", "gas_polytropic", "position_dependent_damping",
    "oil_leakage", "electrical_fault", "deformation_fault", "force_drift", "uneven_bore",
    "duty_viscosity", "sedimentation", "electrode_leakage", "load_cell_ringing", "field_ripple",
    "fading_memory", "bleed_valve", "stick_slip", "clipped_channel", "bore_wear",
    "gas_heat_exchange",
)  # fmt: skip


@cache
def names() -> tuple[str, ...]:
    """Names of all twins, in the order in which seeds pick them."""
    own = {m.name for m in iter_modules(__path__)}
    found = own | {e.name for e in entry_points(group=GROUP)}
    return (*(n for n in FIRST if n in found), *sorted(found - set(FIRST)))


@cache
def get(name: str) -> Twin:
    """The twin of that name; KeyError if there is none, TypeError if its file declares no such."""
    if name in {m.name for m in iter_modules(__path__)}:
        found = import_module(f"{__name__}.{name}").TWIN
    else:
        matches = entry_points(group=GROUP, name=name)
        if not matches:
            raise KeyError(name)
        found = next(iter(matches)).load()
    if not isinstance(found, Twin) or found.name != name:
        raise TypeError(f"twin '{name}' does not declare itself under that name")
    return found


def every() -> dict[str, Twin]:
    """Every twin by its name."""
    return {name: get(name) for name in names()}
