"""PWM sequences for the amplifiers: tables, MATLAB files for Simulink, and their manifest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np

from erdctl import __version__
from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array, Recording
from erdctl.io.atomic import output
from erdctl.mimic import Plan
from erdctl.model.amplifier import Amplifier

SCHEMA = "erdctl.pwm/1"
CHANNELS = ("fl", "fr", "rl", "rr")


@dataclass(frozen=True, eq=False)
class Sequence:
    """What goes to the four amplifiers, and the plans of the dampers that mimic a fault.

    duties : (n,) for each of CHANNELS;  plans : for the channels with a fault, at least one
    static : the paper's inverse was chosen in place of the compensated sequence
    """

    recording: Recording
    duties: Mapping[str, Array]
    plans: Mapping[str, Plan]
    static: bool

    def columns(self) -> dict[str, Array]:
        """Columns that join the log's motion; `duty` and forces are the first faulty damper's."""
        channel, plan = next(iter(self.plans.items()))
        return {
            "duty": self.duties[channel],
            **{f"duty_{channel}": self.duties[channel] for channel in CHANNELS},
            "duty_healthy": self.recording.duty,
            "out_of_reach": plan.out_of_reach.astype(np.float64),
            "force_ideal": plan.ideal,
            "force_expected": plan.expected_paper if self.static else plan.expected,
        }


def write_mat(sequence: Sequence, path: str) -> None:
    """Write the four duty sequences as MATLAB 5 variables for Simulink.

    `pwm` is (5, n): time and fl, fr, rl, rr, as From File reads the first variable of a file;
    `pwm_ws` is (n, 5), as From Workspace takes it.
    """
    recording = sequence.recording
    if len(recording.names) != 1:
        raise UsageProblem(
            "a MAT file for Simulink holds one record, and the log has"
            f" {len(recording.names)}: give them one at a time"
        )
    from scipy.io import savemat

    rows = np.array([recording.t, *(sequence.duties[c] for c in CHANNELS)])
    data = BytesIO()
    savemat(data, {"pwm": rows, "pwm_ws": np.ascontiguousarray(rows.T)})
    with output(path) as stream:
        stream.write(data.getbuffer())


def manifest(
    sequence: Sequence, *, amplifier: Amplifier, parameters_sha256: str, faults: list[str]
) -> dict[str, Any]:
    """What whoever pushes the sequence must know: scale, limits, origin, schedule, reach."""
    return {
        "schema": SCHEMA,
        "erdctl": __version__,
        "carrier": {"value": amplifier.carrier, "unit": "Hz"},
        "full_scale": {"value": amplifier.full_scale, "unit": "V"},
        "channels": list(CHANNELS),
        "limits": {
            "duty_max": amplifier.duty_max,
            "resolution": amplifier.resolution,
            "slew": None if np.isinf(amplifier.slew) else {"value": amplifier.slew, "unit": "1/s"},
            "update_rate": None
            if amplifier.update_rate is None
            else {"value": amplifier.update_rate, "unit": "Hz"},
        },
        "parameters": {"sha256": parameters_sha256},
        "logs": [
            {"name": s.name, "sha256": s.sha256, "rows": s.rows} for s in sequence.recording.sources
        ],
        "samples": len(sequence.recording),
        "sequence": _kind(sequence),
        "schedule": faults,
        "emulation": [
            {
                "channel": channel,
                "fault": str(r.fault),
                "nrmse_compensated": r.compensated,
                "nrmse_paper": r.paper,
                **({} if r.plain is None else {"nrmse_plain": r.plain}),
                "out_of_reach": r.out_of_reach,
                "missing_rms": {"value": r.missing_rms, "unit": "N"},
                "missing_max": {"value": r.missing_max, "unit": "N"},
            }
            for channel, plan in sequence.plans.items()
            for r in plan.reaches
        ],
        "correction": [
            {
                "channel": channel,
                "effects": list(c.effects),
                "effects_of_the_force_channel": list(c.left_out),
                "nrmse": c.nrmse,
                "nrmse_plain": c.plain,
                "error_removed": c.removed,
                "fell_back": c.fell_back,
            }
            for channel, c in ((k, p.correction) for k, p in sequence.plans.items())
            if c is not None
        ],
    }


def _kind(sequence: Sequence) -> str:
    if sequence.static:
        return "static inverse (Eqs. 27, 31, 35)"
    if any(p.correction and not p.correction.fell_back for p in sequence.plans.values()):
        return "iterated with the corrected model"
    return "lag compensated"
