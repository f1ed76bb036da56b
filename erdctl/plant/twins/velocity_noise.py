"""The velocity has a sensor of its own, which is noisy and answers late.

    xdot_rec(t) = xdot(t - tau) + s_v n(t),   n white

s times the top speed is the noise, and a part of a sample the delay. The force is that of the true
motion; the log has the channel's.
"""

from __future__ import annotations

import numpy as np

from erdctl.plant.hooks import Array, Hooks, Values
from erdctl.plant.plant import Plant
from erdctl.plant.twin import Law, Scales, Shape, Twin


def _velocity(v: Array, record: int, p: Values) -> Array:
    random = np.random.default_rng([int(p["draw"]), record])
    late = np.interp(np.arange(len(v)) - p["samples"], np.arange(len(v)), v)
    return np.asarray(late + p["noise"] * random.standard_normal(len(v)))


HOOKS = Hooks("velocity_noise", velocity=_velocity)


def _build(plant: Plant, s: float, q: Shape, by: Scales) -> Plant:
    return plant.with_own(HOOKS, noise=s * by.v, samples=q["samples"], draw=q["draw"])


def _law(plant: Plant) -> Law:
    # The deflection is exact, so that nothing of the velocity's own channel is worth its noise.
    return plant, {"w": 1.0}


# Nobody would log a velocity with more noise: its sign would be lost at every turn.
TWIN = Twin(
    name="velocity_noise",
    family="velocity",
    part="viscous",
    low=1e-5,
    start=0.005,
    high=0.01,
    build=_build,
    law=_law,
    shows={"own.noise": "m/s", "own.samples": "1", "own.draw": "1"},
    shape={"samples": (0.0, 0.5), "draw": (0.0, 1e6)},
)
