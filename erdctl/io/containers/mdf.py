"""ASAM MDF (3 and 4) through asammdf.

Time is each group's master channel. Units and conversions (an int16 with its scaling) are the
channel's own and are applied; samples that the file marks as invalid are left out. A log goes out
as MDF 4.10 with one channel group for each record, `t` as its master.
"""

from __future__ import annotations

import gc
import sys
import traceback
from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np

from erdctl.core.errors import UsageProblem
from erdctl.io.containers.channels import TIME, Channel, ChannelGroup, Samples
from erdctl.io.containers.outgoing import Columns
from erdctl.io.extras import need

_MARK = "erdctl record"  # comment of a group that is a record even if it is the only one
_VERSION = "4.10"


def library() -> Any:
    """asammdf. Raises ComputationProblem if it is not installed."""
    return need("asammdf", extra="mdf", purpose="ASAM MDF files")


def read(file: Any, name: str) -> tuple[list[ChannelGroup], list[str]]:
    """The channel groups of a file; file : path or stream."""
    mdf = _opened(file)
    groups = []
    for index, group in enumerate(mdf.groups):
        master = mdf.masters_db.get(index)
        about = group.channel_group
        if not about.cycles_nr:
            continue
        channels = [
            _channel(mdf, index, i, channel, timed=master is not None)
            for i, channel in enumerate(group.channels)
            if i != master
        ]
        label = getattr(about, "acq_name", "") or f"group {index + 1}"
        record = about.comment == _MARK
        groups.append(ChannelGroup(label, tuple(channels), record=record))
    return groups, []


def _opened(file: Any) -> Any:
    hook = sys.unraisablehook
    try:
        return library().MDF(file)
    except Exception as error:  # raised again once it is tidied up
        # A half-made MDF complains on stderr when it is collected. Let that happen here, unheard.
        sys.unraisablehook = lambda _: None
        traceback.clear_frames(error.__traceback__)
        gc.collect()
        raise
    finally:
        sys.unraisablehook = hook


def _channel(mdf: Any, group: int, index: int, channel: Any, *, timed: bool) -> Channel:
    def load() -> Samples:
        signal = mdf.get(group=group, index=index)
        time = np.asarray(signal.timestamps, np.float64) if timed else None
        return Samples(np.asarray(signal.samples), time)

    # MDF 3 keeps the unit with the conversion.
    unit = channel.unit or getattr(channel.conversion, "unit", None)
    return Channel(channel.name, unit or None, load, timed=timed)


def write(records: Sequence[tuple[str | None, Columns]], stream: BinaryIO) -> None:
    """Write records, each with its columns, as channel groups of an MDF 4 file.

    Raises UsageProblem if there is no numeric column `t`.
    """
    asammdf = library()
    mdf = asammdf.MDF(version=_VERSION)
    for name, columns in records:
        time = next((c for c in columns if c.name == TIME and c.values.dtype.kind in "iuf"), None)
        if time is None:
            raise UsageProblem(
                'MDF4 needs a time for its samples: a column t, or e.g. --map "t=Zeit[ms]"'
            )
        seconds = time.values.astype(np.float64)
        signals = []
        for column in columns:
            if column is time:
                continue
            values, extra = column.values, {}
            if values.dtype.kind == "O":
                values, extra = np.char.encode(values.astype(str), "utf-8"), {"encoding": "utf-8"}
            elif values.dtype.kind == "b":
                values = values.astype(np.uint8)  # MDF knows no logical values
            signals.append(
                asammdf.Signal(values, seconds, name=column.name, unit=column.unit or "", **extra)
            )
        comment = "" if name is None else _MARK
        mdf.append(signals, acq_name=name or "log", comment=comment, common_timebase=True)
    mdf.save(stream)
    mdf.close()
