"""What a log excites, and so which parameters of the paper's model it can identify at all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.blocks import SETTLE
from erdctl.recording import DIRECTIONS, Array, Recording
from erdctl.signals import Signals

ENOUGH = 10  # samples of a kind below which there is no telling anything
SAME_LEVEL = 1.05  # duties within this ratio are one level with a noisy record of it
SAME_DUTY = 0.02  # a duty that moves less than this within a record is constant


@dataclass(frozen=True)
class Excitation:
    """What one direction of motion of a log offers.

    moving, null, field : samples that move this way; of those, settled without field; with field
    levels : lowest and highest duty above zero (1st and 99th percentile), 0 if there is none
    steps : whether the duty changes within a record;  stroke, speeds : spread of x [m], and of
    the speed relative to its mean [1]
    """

    moving: int
    null: int
    field: int
    levels: tuple[float, float]
    steps: bool
    stroke: float
    speeds: float

    @property
    def one_level(self) -> bool:
        """Whether all field is of one level."""
        return self.levels[1] <= self.levels[0] * SAME_LEVEL


def null_control(signals: Signals) -> npt.NDArray[np.bool_]:
    """(n,) samples at zero duty with the yield force of an earlier duty gone."""
    return np.asarray((signals.duty == 0.0) & (signals.since_duty_step > SETTLE))


def survey(recording: Recording) -> dict[str, Excitation]:
    """The excitation of each direction."""
    s = Signals.of(recording)
    null = null_control(s)
    stepping = np.zeros(len(s), dtype=bool)
    for part in recording.slices:
        duty = s.duty[part]
        stepping[part] = float(duty.max() - duty.min()) > SAME_DUTY
    out = {}
    for name, moving in zip(DIRECTIONS, (s.xdot > 0, s.xdot < 0), strict=True):
        duty = s.duty[moving]
        above = duty[duty > 0]
        speed = np.abs(s.xdot[moving])
        out[name] = Excitation(
            moving=int(moving.sum()),
            null=int((moving & null).sum()),
            field=len(above),
            levels=_ends(above) if len(above) else (0.0, 0.0),
            steps=bool((moving & stepping).any()),
            stroke=float(np.ptp(s.x[moving])) if moving.any() else 0.0,
            speeds=float(speed.std() / speed.mean()) if moving.any() else 0.0,
        )
    return out


def _ends(values: Array) -> tuple[float, float]:
    low, high = np.percentile(values[:: len(values) // 100_000 + 1], [1, 99])
    return float(low), float(high)


@dataclass(frozen=True)
class Need:
    """What a parameter needs to be seen, and the plain words for a log that does not offer it.

    confounded : the data fix it, but only together with another parameter that is then held
    """

    met: Callable[[Excitation], bool]
    reason: str
    confounded: bool = False


_MOVES = Need(lambda e: e.moving >= ENOUGH, "the log has no motion in this direction")
_FIELD = Need(lambda e: e.field >= ENOUGH, "the log has no sample with a duty above zero")
_STEPS = Need(
    lambda e: e.steps,
    "the duty is constant within every record, so the lag of Eq. 12 cannot be seen;"
    " record steps of the duty while the piston moves",
)
_ONE_LEVEL = (
    "the log has one duty level, which fixes sigma*v^beta at that level but neither of the two;"
    " record at least two levels"
)
_STROKE = Need(lambda e: e.stroke > 0.0, "the deflection is constant")
_SPEEDS = Need(
    lambda e: e.null >= ENOUGH or e.speeds > 0.01 or e.field < ENOUGH,
    "the speed is constant, so viscous and yield force cannot be told apart",
)
NEEDS: dict[str, tuple[Need, ...]] = {
    "k_nom": (_MOVES, _STROKE),
    "c_vis": (_MOVES, _SPEEDS),
    "T_d": (_MOVES, _FIELD, _STEPS),
    "sigma": (_MOVES, _FIELD, Need(lambda e: not e.one_level, _ONE_LEVEL, confounded=True)),
    "beta": (_MOVES, _FIELD, Need(lambda e: not e.one_level, _ONE_LEVEL)),
}


def unmet(recording: Recording) -> dict[str, Need]:
    """Parameters of the paper's model that a log cannot identify, each with the need not met."""
    out = {}
    for direction, excitation in survey(recording).items():
        for symbol, needs in NEEDS.items():
            need = next((n for n in needs if not n.met(excitation)), None)
            if need is not None:
                out[f"{direction}.{symbol}"] = need
    return out
