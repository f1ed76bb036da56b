"""PWM sequences for the amplifiers: tables, MATLAB files for Simulink, and their manifest."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
import pyarrow as pa

from erdctl.core.errors import UsageProblem
from erdctl.core.version import __version__
from erdctl.io.atomic import output
from erdctl.io.formats import Format
from erdctl.io.tables import append_column, output_format, write_table
from erdctl.mimic.sequence import CHANNELS, PwmSequence
from erdctl.model.amplifier import Amplifier

SCHEMA = "erdctl.pwm/1"


def write(sequence: PwmSequence, log: pa.Table, path: str, format: str | None = None) -> None:
    """Write a sequence: to .mat as Simulink takes it, else as `table`; `log` is the log's table.

    Raises UsageProblem for an unknown suffix, and for a MAT file of several records.
    """
    if output_format(path, format) is Format.MAT:
        write_mat(sequence, path)
    else:
        write_table(table(sequence, log), path, format)


def table(sequence: PwmSequence, log: pa.Table) -> pa.Table:
    """The log's table under the new duty; its measured force was that of the healthy damper."""
    names = log.column_names
    before = {"force": "force_healthy"}
    if "force" in names:  # the log of a run that an earlier sequence drove has such a column
        before["force_healthy"] = "force_healthy (original)"
    renamed = [before.get(name, name) for name in names]
    out = log.rename_columns(renamed)
    new = sequence.columns()
    out = out.drop_columns([name for name in new if name in renamed])
    for name, values in new.items():
        out = append_column(out, name, values)
    return out


def write_mat(sequence: PwmSequence, path: str) -> None:
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
    sequence: PwmSequence,
    *,
    amplifier: Amplifier,
    parameters_sha256: str,
    faults: list[str],
    temperature: dict[str, Any],
) -> dict[str, Any]:
    """What whoever pushes the sequence must know: scale, limits, origin, schedule, reach.

    temperature : what held the limit on it, a `TemperatureGuard.document`
    """
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
        "check": _check(sequence),
        "healthy": _healthy(sequence),
        "temperature": temperature,
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
        "way_back": [
            {"channel": channel, "samples": int(np.count_nonzero(at))}
            for channel, at in sequence.returning.items()
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
            if c is not None and not sequence.static  # which nothing corrected
        ],
        **({"provenance": dict(labels)} if (labels := sequence.recording.labels) else {}),
    }


def _check(sequence: PwmSequence) -> dict[str, Any]:
    """That every duty keeps the limits, checked after the computation, and how near it comes."""
    return {
        "held": True,  # else nothing is written
        "channels": [
            {
                "channel": channel,
                "highest": e.highest,
                "changes": e.changes,
                "closest": None if e.closest is None else {"value": e.closest, "unit": "s"},
                "steepest": None if e.steepest is None else {"value": e.steepest, "unit": "1/s"},
            }
            for channel, e in sequence.extremes.items()
        ],
    }


def _healthy(sequence: PwmSequence) -> dict[str, Any]:
    """Whether the healthy duty goes out as given, and which limits it breaks where it does not."""
    given = sequence.recording
    return {
        "samples_changed": int(np.count_nonzero(sequence.healthy != given.duty)),
        "breaks": [
            {
                "limit": b.limit,
                "samples": b.count,
                "row": b.sample + 1,
                "time": {"value": float(given.t[b.sample]), "unit": "s"},
                "value": b.found,
                "allowed": b.allowed,
            }
            for b in sequence.strained
        ],
    }


def _kind(sequence: PwmSequence) -> str:
    if sequence.static:
        return "static inverse (Eqs. 27, 31, 35)"
    if any(p.correction and not p.correction.fell_back for p in sequence.plans.values()):
        return "iterated with the corrected model"
    return "lag compensated"
