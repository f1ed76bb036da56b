"""Exported C and FMUs against Python and a fine solution, by hand from the project's folder:

    export PYTHONPATH=.:tests:tests/export:tests/export/c:tests/export/emulator:tests/export/fmu
    python tests/export/measure_export.py [force] [steps] [fmu]

All three without names; `force:backlash,input_delay` is of some effects alone. Seeds are fixed.
measure_emulator.py beside it is of the emulator, and of time.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from c_built import FLOAT, block_of, forces, parameters_of
from c_motion import bench, random_motion, record
from measured import show, summed, tables
from places import SHARED
from roads import road
from test_catalogue_in_c import acting
from test_emulator_fidelity import schedule
from test_models_in_c import MODELS, ON_CAR, PAPER, drawn, model

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.io.logs import read_logs
from erdctl.model.composed import Model

NOMINAL, FINE = 1e-3, 16  # s, and parts of it of the fine solution


@cache
def motion() -> Signals:
    """A real motion under a control of leaps, or a drawn one where it is not at hand; and a log."""
    real = SHARED / "mr_raw.parquet"
    if not real.exists():
        return joined(random_motion(), bench())
    log = read_logs([str(real)], need_force=True, report=lambda text: None)
    s, rng = Signals.of(log.recording), np.random.default_rng(16)
    levels = rng.choice([0.0, 0.05, 0.15, 0.3, 0.45], len(s) // 150 + 1)
    return joined(s.with_duty(np.repeat(levels, 150)[: len(s)]), bench())


def joined(a: Signals, b: Signals) -> Signals:
    """The records of both."""
    columns = {
        name: np.concatenate([getattr(a, name), getattr(b, name)])
        for name in ("t", "x", "xdot", "duty", "step")
    }
    return Signals(**columns, starts=np.concatenate([a.starts, b.starts[1:] + len(a)]))


def far(found: Array, expected: Array) -> float:
    """Largest difference over the range of the force."""
    return float(np.abs(found - expected).max() / np.ptp(expected))


def differences(found: Model, values: dict[str, float]) -> list[float]:
    """Double and float against `simulate`; double against what a fit has, and the rms."""
    s = motion()
    block = block_of(found, values, s)
    past = found.past_alone().force(s, values)
    double, single = forces(block, s), forces(block, s, FLOAT)
    whole = found.force(s, values)
    rms = float(np.sqrt(np.mean((double - whole) ** 2)) / np.ptp(whole))
    return [far(double, past), far(single, past), far(double, whole), rms]


def at_random(found: Model, seed: int) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    return PAPER | {e.key(q.symbol): drawn(q, rng) for e in found.effects for q in e.quantities}


def looks_ahead(found: Model) -> bool:
    return found.past_alone() != found


def force(*names: str) -> None:
    s = motion()
    print(
        "Largest difference to Python over the range of the force, same steps, of",
        f"{len(s)} samples in {len(s.starts) - 1} records",
    )
    cases = [("the paper's model", Model(), PAPER)]
    for i, e in enumerate(ON_CAR):
        one = Model((e,))
        cases += [(e.name, one, acting(e)), (f"{e.name}, drawn", one, at_random(one, 7000 + i))]
    for seed in range(MODELS):
        found, values = model(seed)
        cases.append((f"{seed}: " + " + ".join(e.name for e in found.effects), found, values))
    cases = [case for case in cases if not names or {e.name for e in case[1].effects} & {*names}]
    show("", "double", "float", "to a fit", "rms")
    exact, single, ahead = [], [], []
    for name, found, values in cases:
        row = differences(found, values)
        looks = looks_ahead(found)
        show(name[:46], *(f"{v:.1e}" for v in (row if looks else row[:2])))
        exact.append((name, row[0]))
        single.append((name, row[1]))
        if looks:
            ahead.append((name, row[3]))
    summed("double", exact, 1e-9)
    summed("float", single, 1e-5)
    summed("rms to what a fit has", ahead, 0.01)


@cache
def rough() -> Signals:
    """A rough road in fine steps, with leaps of the duty where every grid has a sample."""
    r = road(8000, step=NOMINAL / FINE, duration=8.0)
    rng = np.random.default_rng(8000)
    held = FINE * round(0.2 / NOMINAL)
    duty = np.repeat(rng.choice([0.0, 0.1, 0.2, 0.3, 0.45], len(r.t) // held + 1), held)
    return Signals.of(replace(r, duty=duty[: len(r.t)]))


def every(s: Signals, n: int) -> Signals:
    """Each n-th sample."""
    t, x, xdot, duty = s.t[::n], s.x[::n], s.xdot[::n], s.duty[::n]
    step = np.append(np.diff(t), 0.0)
    return Signals(t=t, x=x, xdot=xdot, duty=duty, step=step, starts=np.array([0, len(t)]))


def steps(*names: str) -> None:
    print(f"Difference to steps of {NOMINAL / FINE * 1e3:g} ms over the range, rough road of 8 s")
    grids = {f"{1e3 * NOMINAL * k:g} ms": round(FINE * k) for k in (0.5, 1.0, 2.0)}
    show("", *(f"{g} {w}" for g in grids for w in ("rms", "max")))
    coarsest = max(grids.values())
    all_rows = []
    for effect in (None, *ON_CAR):
        if names and (effect is None or effect.name not in names):
            continue
        found = Model(() if effect is None else (effect,))
        values = PAPER if effect is None else acting(effect)
        block = block_of(found, values, rough())
        exact = forces(block, rough())[::coarsest]
        row = []
        for n in grids.values():
            off = forces(block, every(rough(), n))[:: coarsest // n] - exact
            row += [float(np.sqrt(np.mean(off**2))), float(np.abs(off).max())]
        row = [v / np.ptp(exact) for v in row]
        name = "the paper's model" if effect is None else effect.name
        all_rows.append((name, row))
        show(name, *(f"{v:.1e}" for v in row))
    for i, grid in enumerate(grids):
        summed(f"rms at {grid}", ((name, r[2 * i]) for name, r in all_rows), 0.01)
        summed(f"largest at {grid}", ((name, r[2 * i + 1]) for name, r in all_rows), 0.1)


def fmu(*names: str) -> None:
    from fmpy.validation import validate_fmu
    from fmu_built import Instance, damper, driven
    from fmu_built import built as built_fmu
    from test_corrected_fmu import begun

    from erdctl.export.c.source import write_c
    from erdctl.export.fmu.damper import damper_block

    def difference(path: Path, s: Signals, expected: Array) -> float:
        instance = Instance(path)
        begin = {k: v for k, v in begun(s).items() if k in instance.at}
        out = driven(instance, {"x": s.x, "xdot": s.xdot, "duty": s.duty}, s.t, **begin)
        instance.close()
        return far(out, expected)

    s = Signals.of(schedule())
    print("FMU by FMPy against `simulate`, over the range; findings of validate_fmu")
    for number in ("2", "3"):
        off = difference(damper(number), s, Model().force(s, PAPER))
        show(
            f"the paper's model, FMI {number}, 60 s",
            f"{off:.1e}",
            len(validate_fmu(str(damper(number)))),
        )
    s = record(motion(), *motion().starts[:2].tolist())
    ranges = {"xdot": [0.0, float(np.abs(s.xdot).max())]}
    cases = [(e.name, Model((e,)), acting(e)) for e in ON_CAR]
    cases += [(f"model {seed}", *model(seed)) for seed in range(MODELS)]
    cases = [case for case in cases if not names or {e.name for e in case[1].effects} & {*names}]
    offs, findings = [], 0
    for i, (name, found, values) in enumerate(cases):
        p = parameters_of(found, values, ranges=ranges)
        number = "23"[i % 2]
        path = built_fmu(damper_block(write_c(p, prefix=f"f{i}"), p), number)
        n = len(validate_fmu(str(path)))
        offs.append((name, difference(path, s, found.past_alone().force(s, values))))
        findings += n
        show(f"{name}, FMI {number}", f"{offs[-1][1]:.1e}", n)
    summed("all", offs, 1e-9)
    print(f"  findings: {findings}")


if __name__ == "__main__":
    tables({"force": force, "steps": steps, "fmu": fmu})
