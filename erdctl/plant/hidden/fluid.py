"""In the fluid."""

from __future__ import annotations

from erdctl.plant.hidden.kinds import Scales, Shape, Twin
from erdctl.plant.plant import Plant


def _preyield(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """tanh(xdot/v_y), v_y = s times the top speed."""
    return plant.with_physics(v_y=s * by.v)


def _loop(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """tanh(k_1 x + c_1 xdot); 1/c_1 = s times the top speed, k_1 x = `loop` at the stroke's end."""
    v_y = s * by.v
    return plant.with_physics(v_y=v_y, lead=q["loop"] * v_y / by.x)


def _signed(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """T_d dY/dt + Y = sigma v^beta sign(xdot); T_d = s seconds, its ratio between the directions
    as drawn."""
    up, down = plant.compression, plant.release
    scale = s / (up.T_d * down.T_d) ** 0.5
    return plant._replace(
        compression=up._replace(T_d=up.T_d * scale), release=down._replace(T_d=down.T_d * scale)
    ).with_physics(signed=1.0)


def _thinning(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """c v_ref |xdot/v_ref|^n with n = 1 - s."""
    return plant.with_physics(flow_index=1.0 - s, v_ref=by.v)


def _turbulent(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """s times the damper's force at the top speed."""
    return plant.with_physics(turbulent=s * by.force / by.v**2)


def _inertia(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """s times the damper's force at the highest acceleration; no more than a damper of its size may
    have: 50 kg for 1000 N, with its fixture and the fluid column as felt at the rod."""
    return plant.with_physics(mass=by.force * min(s / by.a, 0.05))


def _compressible(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """The column gives by s times the stroke under the largest force."""
    return plant.with_physics(fluid_spring=s * by.x / by.force)


def _cavitation(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """Compression leaves a void of up to s times the stroke, which release must take up first."""
    return plant.with_physics(void=s * by.x, void_growth=q["growth"], bubbles=q["bubbles"])


def _fade(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    """C dT/dt = power - C T / tau; c and sigma fall as exp(-g T). C is such that the hottest
    record would lose s nepers of yield force without cooling."""
    weaken = q["weaken"]
    return plant.with_physics(
        thin=q["thin"], weaken=weaken, heating=s / (weaken * by.energy),
        cooling=1.0 / (q["cooling"] * by.longest),
    )  # fmt: skip


EFFECTS = (
    Twin(
        "preyield_viscosity", "sign law", "yielding", 1e-6, 0.05, 2.0, _preyield,
        ("physics.v_y",), {},
    ),
    Twin(
        "yield_hysteresis", "sign law", "yielding", 1e-6, 0.03, 2.0, _loop,
        ("physics.v_y", "physics.lead"), {"loop": (1.5, 6.0)},
    ),
    Twin(
        "signed_yield_lag", "sign law", "yielding", 1e-5, 0.03, 0.25, _signed,
        ("compression.T_d", "release.T_d"), {},
    ),
    Twin(
        "shear_thinning", "viscous law", "viscous", 1e-3, 0.3, 0.85, _thinning,
        ("physics.flow_index", "physics.v_ref"), {},
    ),
    Twin(
        "quadratic_damping", "viscous law", "", 1e-4, 0.3, 20.0, _turbulent,
        ("physics.turbulent",), {},
    ),
    Twin("fluid_inertia", "inertia", "", 1e-4, 0.2, 20.0, _inertia, ("physics.mass",), {}),
    Twin(
        "fluid_compressibility", "series", "", 1e-8, 0.005, 0.5, _compressible,
        ("physics.fluid_spring",), {},
    ),
    Twin(
        "cavitation", "void", "", 1e-7, 0.02, 1.0, _cavitation,
        ("physics.void", "physics.void_growth", "physics.bubbles"),
        {"growth": (0.6, 1.0), "bubbles": (0.02, 0.2)},
    ),
    Twin(
        "thermal_fade", "slow loss", "", 1e-3, 0.4, 8.0, _fade,
        ("physics.heating", "physics.cooling", "physics.thin", "physics.weaken"),
        {"thin": (0.008, 0.03), "weaken": (0.004, 0.015), "cooling": (1.0, 10.0)}, hidden=True,
    ),
)  # fmt: skip
