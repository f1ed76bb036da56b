"""The table of a campaign, schema `erdctl.campaign/1`: a row per log, command and parameter.

What belongs to the log (verdict, findings, scores, hashes) is repeated in each of its rows, so that
the table is read with one filter; a log that could not be read has one row with its error and no
parameter.
"""

from __future__ import annotations

import pyarrow as pa

NAME = "erdctl.campaign/1"

_TEXTS = pa.list_(pa.string())
SCHEMA = pa.schema(
    [
        pa.field("log", pa.string(), nullable=False),  # path or URL as it was found
        pa.field("hash", pa.string()),  # SHA-256 of the log, or of the logs of a group in order
        pa.field("version", pa.string(), nullable=False),  # of erdctl
        pa.field("damper", pa.string()),
        pa.field("corner", pa.string()),  # fl, fr, rl, rr
        pa.field("date", pa.timestamp("us")),
        pa.field("conditions", pa.map_(pa.string(), pa.string())),
        pa.field("command", pa.string()),  # identify or diagnose: whose parameter it is
        pa.field("parameter", pa.string()),  # as in parameter files: backlash.g
        pa.field("unit", pa.string()),
        pa.field("value", pa.float64()),
        pa.field("stderr", pa.float64()),
        pa.field("low", pa.float64()),  # of the 95 % interval
        pa.field("high", pa.float64()),
        pa.field("identified", pa.bool_()),
        pa.field("verdict", pa.string()),  # of diagnose; null where it was not asked
        pa.field("findings", _TEXTS),  # effects named, the largest first
        pa.field("rig", _TEXTS),  # faults of the recording
        pa.field("nrmse", pa.float64()),  # of the identified model
        pa.field("nrmse_worst", pa.float64()),  # of the worst level of duty
        pa.field("noise_rms", pa.float64()),  # N
        pa.field("documents", pa.map_(pa.string(), pa.string())),  # command -> its JSON, relative
        pa.field("exit_code", pa.int8(), nullable=False),  # as the commands alone would have ended
        pa.field("error", pa.string()),  # one line
        pa.field("logs", _TEXTS),  # that were taken together, of a group; else the log alone
        pa.field("remarks", _TEXTS),  # what was assumed, converted or derived of the log
    ],
    metadata={"schema": NAME},
)
