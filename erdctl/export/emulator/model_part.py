"""What of the emulator's C depends on the damper: the paper's model, or one with effects.

The paper's model is inverted by formula. For a damper with effects its own exported C is asked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.recording import DIRECTIONS, Array
from erdctl.core.signals import Signals
from erdctl.export.c.layout import CMember, paper_members
from erdctl.export.c.source import CBlock, on_the_vehicle, write_c
from erdctl.model.composed import Model
from erdctl.model.parameters import Parameters
from erdctl.model.slots import ControlSlot, SeriesSlot

REAL = """#ifdef ERDCTL_FLOAT
typedef float PREFIX_real;
#else
typedef double PREFIX_real;
#endif"""
SPEEDS, WRONG = (0.005, 0.02, 0.1), 0.02  # m/s; part of the answer that is none
FELT = 0.05  # of a step in force: so much of it is there when it begins to be felt
SWEPT = 2.0  # s: a slower supply cannot be told how to follow a road
FINE, LONG = 2e-4, 0.5  # s, of the steps by which that is looked for, and for how long


@dataclass(frozen=True)
class ModelPart:
    """The part of the C that knows the damper.

    before : text of the header before the emulator's own;  real : declares PREFIX_real
    members : of PREFIX_params;  declared : lines that declare them
    state : file with members of PREFIX_state;  types : of the source;  code : file
    wanted : file with what is left open in `code`, how a duty is found
    yielding : where the damper's state has F_ER of Eq. 12
    copied : bytes of the damper's state that a look ahead copies
    """

    before: str
    real: str
    members: tuple[CMember, ...]
    declared: tuple[str, ...]
    state: str
    types: str
    code: str
    wanted: str = ""
    yielding: str = ""
    copied: str = ""
    left_out: tuple[str, ...] = ()


def model_part(parameters: Parameters, prefix: str) -> ModelPart:
    """The one for a damper; effects of its bench take no part in it."""
    if on_the_vehicle(parameters.model.effects)[0]:
        return _observer(parameters, prefix)
    found = paper_members(parameters)
    return ModelPart(
        before="", real=REAL, members=found, declared=tuple(declared(m) for m in found),
        state="paper_state.h", types="", code="paper.c",
        left_out=on_the_vehicle(parameters.model.effects)[1],
    )  # fmt: skip


def _observer(parameters: Parameters, prefix: str) -> ModelPart:
    damper: CBlock = write_c(parameters, prefix=f"{prefix}_damper")
    sprung = any(isinstance(e.slot, SeriesSlot) for e in parameters.model.effects)
    include = f'#include "{damper.prefix}.h"'
    assert damper.source.count(include) == 1
    late = CMember(
        "dead_time", dead_time(parameters), "s",
        "before a duty begins to be felt, beyond what T_d alone makes of it",
    )  # fmt: skip
    sweep = CMember(
        "sweep_time", sweep_time(parameters), "s",
        "from a duty of 0 to 1 behind a supply that slews, 0 where it follows at once",
    )  # fmt: skip
    return ModelPart(
        before=damper.header + "\n",
        real="typedef PREFIX_damper_real PREFIX_real;",
        members=(*(m._replace(path=f"damper.{m.path}") for m in damper.parameters), late, sweep),
        declared=(
            "    PREFIX_damper_params damper; /* see there */",
            *map(declared, (late, sweep)),
        ),
        state="observer_state.h",
        types=damper.source.replace(include, '#include "PREFIX.h"'),
        code="observer.c",
        wanted="told.c" if sprung or turns_first(parameters) else "asked.c",
        yielding="spring[0].yielding" if sprung else "yielding",
        copied=(
            f"offsetof({damper.prefix}_state, {damper.memory})" if damper.memory else "sizeof *copy"
        ),
        left_out=damper.left_out,
    )


def declared(member: CMember) -> str:
    """The line that declares a member."""
    return f"    PREFIX_real {member.path}; /* [{member.unit}] {member.title} */"


def dead_time(parameters: Parameters) -> float:
    """Time [s] by which a damper feels a duty later than by its T_d alone.

    From a step of the duty at constant speed, to where FELT of its force is there; the mean of both
    directions. Found for any effect that stands between them, without asking which it is.
    """
    kept = on_the_vehicle(parameters.model.effects)[0]
    own = replace(parameters, model=Model(kept))
    plain = replace(parameters, model=Model())
    late = [_felt(own, way) - _felt(plain, way) for way in range(len(DIRECTIONS))]
    found = float(np.mean(late))
    return round(found, 4) if found > 2.0 * FINE else 0.0


def sweep_time(parameters: Parameters) -> float:
    """Time [s] in which the duty at the electrodes follows a leap from 0 to 1, SWEPT at most.

    Twice that to its half, of all that stands in between; less than a step is at once.
    """
    n = round(SWEPT / FINE)
    held = Signals(
        t=FINE * np.arange(float(n)), x=np.zeros(n), xdot=np.full(n, 0.1),
        duty=np.append(0.0, np.ones(n - 1)), step=np.append(np.full(n - 1, FINE), 0.0),
        starts=np.array([0, n]),
    )  # fmt: skip
    for effect, control in Model(on_the_vehicle(parameters.model.effects)[0]).of(ControlSlot):
        held = held.with_duty(control(held, effect.local(parameters.values)))
    half = float(np.argmax(held.duty >= 0.5 * held.duty[-1]) - 1) * FINE
    return round(2.0 * half, 4) if half > FINE else 0.0


def turns_first(parameters: Parameters) -> bool:
    """Whether the force answers a rise of the duty by a fall first.

    What is to be reached in one step would take a leap of the duty, and the next step one back.
    """
    kept = on_the_vehicle(parameters.model.effects)[0]
    own = replace(parameters, model=Model(kept))
    for speed in (*SPEEDS, *(-v for v in SPEEDS)):
        rise = _rise(own, speed) * np.sign(speed)
        if rise.min() < -WRONG * rise.max():
            return True
    return False


def _felt(parameters: Parameters, way: int) -> float:
    rise = np.abs(_rise(parameters, 0.1 if way == 0 else -0.1))
    if not rise[-1] > 0.0:
        return 0.0
    return float(np.argmax(rise >= FELT * rise[-1])) * FINE


def _rise(parameters: Parameters, speed: float) -> Array:
    """(n,) what a step of the duty adds to the force at a steady speed [N], from its time on."""
    n = round(LONG / FINE)
    t: Array = FINE * np.arange(2.0 * n)
    signals = Signals(
        t=t, x=np.zeros(2 * n), xdot=np.full(2 * n, speed), duty=np.where(t < LONG, 0.05, 0.3),
        step=np.append(np.full(2 * n - 1, FINE), 0.0), starts=np.array([0, 2 * n]),
    )  # fmt: skip
    force = parameters.model.force(signals, parameters.values)
    rest = parameters.model.force(signals.with_duty(np.full(2 * n, 0.05)), parameters.values)
    out: Array = (force - rest)[n:]
    return out
