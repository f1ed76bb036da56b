"""What a table costs: its misfit to the whole model on a motion that is not steady."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from erdctl.bench.drive import Drive, Duty, record
from erdctl.bench.waveforms import Sweep
from erdctl.core.recording import Array, Recording, concatenate
from erdctl.export.tables.peak_map import SAMPLES, PeakMap
from erdctl.model.parameters import Parameters
from erdctl.model.simulate import simulate
from erdctl.score.nrmse import nrmse

CYCLES = 30
SLOWEST = 0.1  # of the highest frequency, where the sweep begins
HOLD = 0.5  # s at each duty


@dataclass(frozen=True)
class Cost:
    """NRMSE of a table to the whole model, over the range of the model's force [1].

    sweep : the motion, in words
    held, stepping : at a duty that is held at each level in turn, record by record, and at one that
        steps between the levels (None for a table of one)
    spring : stiffness that takes most of the rest when it is put beside the table [N/m]
    beside : NRMSE, duty held, with that spring
    """

    sweep: str
    held: float
    stepping: float | None
    spring: float
    beside: float


def static_cost(parameters: Parameters, table: PeakMap) -> Cost:
    """The cost on a sine sweep up to the highest speed of the table; it holds no random number."""
    grid = table.grid
    top = float(min(-grid.speed[0], grid.speed[-1]))
    f1 = top / (2.0 * np.pi * grid.amplitude)
    f0 = SLOWEST * f1
    duration = CYCLES / (0.5 * (f0 + f1))
    motion = Sweep(f0=f0, f1=f1, amp=grid.amplitude)

    def drive(*levels: float) -> Recording:
        described = Drive(
            motion=motion, duty=Duty(levels), hold=HOLD, duration=duration, fs=SAMPLES * f1,
            offset=grid.centre,
        )  # fmt: skip
        r = record(described)
        if grid.temperature is None:
            return r
        return replace(r, temperature=np.full(len(r), grid.temperature))

    levels = grid.duty.tolist()
    held = concatenate([drive(u) for u in levels])
    force, rest, spring = _rest(parameters, table, held)
    stepping = None
    if len(levels) > 1:
        r = drive(*_there_and_back(levels))
        stepping = nrmse(*_pair(parameters, table, r)).nrmse
    x = held.x - grid.centre
    return Cost(
        sweep=f"a sine sweep of {1e3 * grid.amplitude:.3g} mm, {f0:.3g} to {f1:.3g} Hz in"
        f" {duration:.3g} s, up to {1e3 * top:.3g} mm/s",
        held=nrmse(force, force - rest).nrmse,
        stepping=stepping,
        spring=spring,
        beside=nrmse(force, force - rest + spring * x).nrmse,
    )


def _pair(parameters: Parameters, table: PeakMap, r: Recording) -> tuple[Array, Array]:
    return simulate(parameters, r), table.at(r.xdot, r.duty)


def _rest(parameters: Parameters, table: PeakMap, r: Recording) -> tuple[Array, Array, float]:
    """Force of the model, what the table misses of it, and the spring that this is most like."""
    force, looked_up = _pair(parameters, table, r)
    rest = force - looked_up
    x = r.x - table.grid.centre
    return force, rest, float(x @ rest / (x @ x))


def _there_and_back(levels: list[float]) -> list[float]:
    """Every level, and large steps between them: lowest, highest, second, ..."""
    low, high = levels[: (len(levels) + 1) // 2], levels[: (len(levels) - 1) // 2 : -1]
    return [u for pair in zip(low, [*high, low[-1]], strict=False) for u in pair]
