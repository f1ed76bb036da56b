"""What a plan holds: the sequence, what it reaches, what the effects are worth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.core.recording import Array
from erdctl.model.faults import Fault

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Reach:
    """How well one fault can be mimicked while it is active.

    compensated, paper : NRMSE of the expected force to the ideal faulty force, over its range
    plain : the same of the sequence of the paper's parameters alone; None if there are no others
    out_of_reach : part of the time in which no duty gives the ideal force
    missing_rms, missing_max : force that is missing then [N]
    """

    fault: Fault
    samples: int
    compensated: float
    paper: float
    out_of_reach: float
    missing_rms: float
    missing_max: float
    plain: float | None = None

    def figures(self, *, static: bool) -> list[str]:
        """NRMSE of what is sent, and of what else there is to compare it with; in words.

        static : the paper's inverse is sent; that of sequences that are not sent would mislead
        """
        others = [] if static else [self.compensated, *([] if self.plain is None else [self.plain])]
        return [f"{v:.4f}" if v < 1e3 else f"{v:.3g}" for v in (*others, self.paper)]


@dataclass(frozen=True)
class Correction:
    """What a corrected model is worth: two sequences, both replayed through it.

    effects : those that took part;  left_out : those of the force channel
    nrmse, plain : of the plan and of the sequence of the paper's parameters alone, while any fault
        acts;  steps : of the iteration;  fell_back : nothing beat the plain sequence
    """

    effects: tuple[str, ...]
    left_out: tuple[str, ...]
    nrmse: float
    plain: float
    steps: int
    fell_back: bool

    @property
    def removed(self) -> float:
        """Part of the plain sequence's error that the corrected one does not have."""
        return 1.0 - self.nrmse / self.plain if self.plain > 0.0 else 0.0


@dataclass(frozen=True, eq=False)
class Plan:
    """A PWM sequence for one damper.

    duty, duty_paper : (n,) compensated sequence, and the paper's static inverse
    ideal, expected, expected_paper : (n,) ideal faulty force and what the sequences will give, as
        the force channel records them [N]
    out_of_reach : (n,) no duty gives the ideal force;  acting : (n,) some fault acts
    limited, limited_paper : part of the samples at which either sequence is at the highest duty
        while a fault acts, and the force is too small
    idle : faults that do nothing in this log
    correction : what the effects of a corrected model are worth; None if there are none
    """

    duty: Array
    duty_paper: Array
    ideal: Array
    expected: Array
    expected_paper: Array
    out_of_reach: Flags
    acting: Flags
    limited: float
    limited_paper: float
    idle: tuple[Fault, ...]
    reaches: tuple[Reach, ...]
    correction: Correction | None = None
