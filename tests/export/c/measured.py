"""Figures of the exported C, printed: what the causal forms cost, step sizes, time for a step.

PYTHONPATH=tests:tests/export/c python tests/export/c/measured.py
"""

from __future__ import annotations

from time import process_time

import numpy as np
from c_built import block_of, forces, rows_of, run
from c_motion import bench, random_motion, record
from causal import STAND_INS, causal
from places import FIXTURES

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.effects import get
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values
SPRING = ("mount_compliance", "backlash", "thermal_fade", "stribeck_friction", "shear_thinning")


def at_start(model: Model) -> dict[str, float]:
    seen = {"t_0": 2.0, "x_stop": 0.008, "x_r": 0.008}
    values = dict(PAPER)
    for e in model.effects:
        values |= {e.key(q.symbol): seen.get(q.symbol, q.start) for q in e.quantities}
    return values


def sampled(step: float, end: float = 4.0) -> Signals:
    t = step * np.arange(round(end / step) + 1)
    x = 0.01 * np.sin(9.0 * t) + 0.003 * np.sin(31.0 * t + 1.0)
    xdot = 0.09 * np.cos(9.0 * t) + 0.093 * np.cos(31.0 * t + 1.0)
    duty = np.where(np.floor(t / 0.4 + 1e-6) % 2 > 0, 0.45, 0.1)
    dt = np.append(np.diff(t), 0.0)
    return Signals(t=t, x=x, xdot=xdot, duty=duty, step=dt, starts=np.array([0, len(t)]))


def off(found: Array, expected: Array) -> str:
    rest, span = found - expected, np.ptp(expected)
    rms, most = np.sqrt(np.mean(rest**2)) / span, np.abs(rest).max() / span
    return f"rms {rms:.2e}, largest {most:.2e} of range"


def main() -> None:
    print("causal form against Python")
    for name in STAND_INS:
        model = Model((get(name),))
        for what, s in (("random", random_motion()), ("bench", bench())):
            values = at_start(model)
            found = forces(block_of(model, values, s), s)
            print(f"  {name:24} {what:7} {off(found, model.force(s, values))}")
            last = off(found, Model((causal(get(name)),)).force(s, values))
            print(f"  {'':24} {'':7} {last} (against the causal form in Python)")
    print("steps, against the same at 0.05 ms")
    for names in ((), SPRING):
        model = Model(tuple(get(n) for n in names))
        values = at_start(model)
        fine = sampled(5e-5)
        exact = forces(block_of(model, values, fine), fine)
        for step in (1e-3, 2e-3, 4e-3):
            s = sampled(step)
            found = forces(block_of(model, values, s), s)
            there = exact[:: round(step / 5e-5)]
            print(f"  {len(names)} effects, {1e3 * step:g} ms: {off(found, there)}")
    print("time for a step, -O2")
    s = record(bench(), 0, int(bench().starts[1]))
    rows = np.tile(rows_of(s), (60, 1))
    rows[rows[:, 0] == 0.0, 0] = 0.002
    numbers = np.linspace(-1.0, 0.0, 1_000_000)
    begin = process_time()
    np.exp(numbers)
    one = (process_time() - begin) / len(numbers)
    for names in ((), ("preyield_viscosity", "gas_polytropic", "stribeck_friction"), SPRING):
        model = Model(tuple(get(n) for n in names))
        block = block_of(model, at_start(model), s)
        run(block, rows[:10], "-O2")
        begin = process_time()
        run(block, rows, "-O2")
        each = (process_time() - begin) / len(rows)
        print(
            f"  {len(names)} effects: {1e9 * each:.0f} ns, {each / one:.0f} times an exp of NumPy"
        )


if __name__ == "__main__":
    main()
