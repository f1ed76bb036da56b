"""Sound logs with a clock that jitters, a velocity with a zero, a loop, or an inverted duty: what
is said of the rig.

PYTHONPATH=.:tests:fixtures python tests/bench/rig/measure_clock_and_velocity.py
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
from rig_errors import ERRORS, chosen
from test_rig_and_physics import recorded

from erdctl import plant
from erdctl.bench.rig import look
from erdctl.bench.rig.fault import RigFault
from erdctl.core.recording import Recording
from erdctl.effects import catalogue

KNOWN = frozenset(e.name for e in catalogue())
LOOPS = ("yield_hysteresis", "presliding_friction", "preyield_elasticity")


def said(r: Recording, code: str) -> list[RigFault]:
    return [f for f in look(r).faults if f.code.startswith(code)]


def clocks(seeds: range) -> Counter[str]:
    """Records said to have lost samples, by jitter alone and where one of each log has."""
    count: Counter[str] = Counter()
    for seed in seeds:
        r, random = recorded(plant.draw(seed, kind="null")), np.random.default_rng(seed)
        most = random.uniform(0.2, 0.45)  # of a step

        def jittering(r: Recording, random=random, most=most) -> Recording:
            t = r.t.copy()
            for part in r.slices:
                step = np.median(np.diff(t[part]))
                t[part] += random.uniform(-most, most, part.stop - part.start) * step
            return replace(r, t=t)

        count["records"] += len(r.names)
        count["accused"] += len(said(jittering(r), "samples_missing"))
        cut = ERRORS["samples dropped"].spoil(r, random)
        found = [f for f in said(jittering(cut), "samples_missing") if f.record == chosen(r)]
        count["losses"] += 1
        count["found"] += bool(found)
        count["counted right"] += any(f.text.startswith(f"{len(r) - len(cut)} ") for f in found)
    return count


def zeros(seeds: range) -> Counter[str]:
    """Logs said to have a zero of the velocity, without and with one, and within a tenth of it."""
    count: Counter[str] = Counter()
    for seed in seeds:
        r = recorded(plant.draw(seed, known=KNOWN))
        speed = float(np.sqrt(np.mean(r.xdot**2)))
        for part in (0.0, 0.01, 0.02, 0.05):
            v_0 = part * speed
            found = said(replace(r, xdot=r.xdot + v_0), "velocity_offset")
            count[f"{part} said"] += bool(found)
            count[f"{part} right"] += any(abs(f.zero - v_0) < 0.1 * v_0 for f in found)
    return count


def loops(seeds: range) -> Counter[str]:
    """Logs of strong loops in which a sound record is said to be unlike the others."""
    count: Counter[str] = Counter()
    for seed in seeds:
        for name in LOOPS:
            case = plant.draw(seed, kind="single", known=KNOWN, level=6.0, effects=(name,))
            count["logs"] += 1
            count["accused"] += bool(said(recorded(case), "record"))
    return count


def inverted(seeds: range) -> Counter[str]:
    """Logs said to have an inverted duty, as they are and with 1 - duty in its place."""
    count: Counter[str] = Counter()
    for seed in seeds:
        r = recorded(plant.draw(seed, known=KNOWN))
        count["logs"] += 1
        count["accused"] += bool(said(r, "duty_inverted"))
        count["found"] += bool(said(replace(r, duty=1.0 - r.duty), "duty_inverted"))
    return count


if __name__ == "__main__":
    print("clocks", dict(clocks(range(1_670_000, 1_670_060))))
    print("zeros", dict(zeros(range(1_677_000, 1_677_080))))
    print("inverted", dict(inverted(range(1_799_000, 1_799_150))))
    print("loops", dict(loops(range(1_681_000, 1_681_030))))
