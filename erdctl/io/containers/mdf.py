"""ASAM MDF (3 and 4) through asammdf.

Time is each group's master channel. Units and conversions (an int16 with its scaling) are the
channel's own and are applied; samples that the file marks as invalid are left out, and it is said.
A log goes out as MDF 4.10 with one channel group for each record, `t` as its master.
"""

from __future__ import annotations

import gc
import sys
import traceback
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from io import StringIO
from typing import Any, BinaryIO

import numpy as np

from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.core.messages import counted
from erdctl.io.containers.channels import TIME, Channel, ChannelGroup, Samples
from erdctl.io.containers.formula import WrongFormula, evaluated
from erdctl.io.containers.outgoing import Columns
from erdctl.io.extras import need

_MARK = "erdctl record"  # comment of a group that is a record even if it is the only one
_VERSION = "4.10"
_TIMES = (0, 1)  # master channels: none said, time; then angle, distance, index
_FAILED: list[str] = []  # why a formula of the channel being loaded could not be evaluated


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
        # A master may also be an angle, a distance or a count.
        timed = master is not None and getattr(group.channels[master], "sync_type", 1) in _TIMES
        channels = [
            _channel(mdf, index, i, channel, timed=timed, count=about.cycles_nr, file=name)
            for i, channel in enumerate(group.channels)
            if i != master or not timed
        ]
        label = getattr(about, "acq_name", "") or f"group {index + 1}"
        record = about.comment == _MARK
        groups.append(ChannelGroup(label, tuple(channels), record=record))
    return groups, []


def _opened(file: Any) -> Any:
    asammdf = library()
    _own_formulas()
    hook = sys.unraisablehook
    try:
        # The frames of buses are no channels of a bench, and unpacking them takes long.
        return asammdf.MDF(file, process_bus_logging=False)
    except Exception as error:  # raised again once it is tidied up
        # A half-made MDF complains on stderr when it is collected. Let that happen here, unheard.
        sys.unraisablehook = lambda _: None
        traceback.clear_frames(error.__traceback__)
        gc.collect()
        raise
    finally:
        sys.unraisablehook = hook


def _channel(
    mdf: Any, group: int, index: int, channel: Any, *, timed: bool, count: int, file: str
) -> Channel:
    def load() -> Samples:
        _FAILED.clear()
        try:
            signal = mdf.get(group=group, index=index)
        except WrongFormula:
            signal = None
        if signal is not None and _lost(signal.samples) and channel.conversion is not None:
            raw = mdf.get(group=group, index=index, raw=True).samples
            if raw.shape == signal.samples.shape and not _lost(raw):
                _FAILED.append("it gives no number for some stored values")
        if _FAILED or signal is None:
            raise InputProblem(
                f"its conversion cannot be evaluated: {_FAILED[0]}; without it there are only"
                " the counts of a converter: export physical values",
                file=file,
                column=channel.name,
            )
        there = valid = len(signal.samples)
        if there != count:  # some are marked as invalid, or not there at all
            every = mdf.get(group=group, index=index, raw=True, ignore_invalidation_bits=True)
            there = len(every.samples)
        if there != count:
            raise InputProblem(
                f"its group is said to have {counted(count, 'sample')}, but holds {there}: the"
                " recording"
                " was cut off; write it again, or export it as CSV",
                file=file,
                column=channel.name,
            )
        time = np.asarray(signal.timestamps, np.float64) if timed else None
        said = f"{there - valid} of {counted(there, 'sample')}, marked as invalid, left out"
        return Samples(np.asarray(signal.samples), time, said=said if valid < there else None)

    # MDF 3 keeps the unit with the conversion.
    unit = channel.unit or getattr(channel.conversion, "unit", None)
    return Channel(channel.name, unit or None, load, timed=timed, count=count)


def _lost(values: Any) -> bool:
    return values.dtype.kind == "f" and not bool(np.isfinite(values).all())


def _own_formulas() -> None:
    """Let asammdf evaluate formulas by `formula.evaluated`.

    It gives them to numexpr as they are (code, powers without end, brackets until the interpreter
    crashes), and hands out the counts of the converter, as if they were values, where that fails.
    """
    from asammdf.blocks import v2_v3_blocks, v2_v3_constants, v4_blocks, v4_constants

    for blocks, kind in (
        (v4_blocks, v4_constants.CONVERSION_TYPE_ALG),
        (v2_v3_blocks, v2_v3_constants.CONVERSION_TYPE_FORMULA),
    ):
        theirs = blocks.ChannelConversion.convert
        if not hasattr(theirs, "formula"):
            blocks.ChannelConversion.convert = _with_formula(theirs, kind)


def _with_formula(theirs: Callable[..., Any], kind: int) -> Callable[..., Any]:
    def convert(self: Any, values: Any, *options: Any, **more: Any) -> Any:
        if self.conversion_type != kind:
            return theirs(self, values, *options, **more)
        formula = self.formula.strip("\0 ")
        try:
            found = evaluated(formula, np.atleast_1d(np.asarray(values)))
        except (WrongFormula, TypeError, ValueError) as error:
            # Remembered as well, since asammdf may catch what is raised here.
            _FAILED.append(f"formula '{formula[:80]}': {error}")
            raise WrongFormula(str(error)) from None
        return found if np.ndim(values) else found[0]

    convert.formula = True  # type: ignore[attr-defined]  # a mark that asammdf passes on
    return convert


def write(records: Sequence[tuple[str | None, Columns]], stream: BinaryIO) -> None:
    """Write records, each with its columns, as channel groups of an MDF 4 file.

    Raises UsageProblem if there is no numeric column `t`.
    """
    # It prints what it does not expect, and standard output may be where the file goes.
    with redirect_stdout(StringIO()):
        _write(records, stream)


def _write(records: Sequence[tuple[str | None, Columns]], stream: BinaryIO) -> None:
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
