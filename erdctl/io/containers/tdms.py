"""NI TDMS through npTDMS.

Time is the waveform's (`wf_increment` in `wf_xunit_string`, `wf_start_offset`, `wf_start_time`),
else the group's channel called t or time; the 1 s that LabVIEW writes where nobody set an increment
is none beside such a channel. Units are `unit_string`; NI's linear, polynomial and table scalings
are applied by the library. A log goes out as one group for each record, with `t` as a channel.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np

from erdctl.io.containers.channels import TIME, Channel, ChannelGroup, Samples
from erdctl.io.containers.clocks import Choice, clock_of, with_clock
from erdctl.io.containers.outgoing import Columns
from erdctl.io.extras import need
from erdctl.io.stored import from_stored, stored_unit
from erdctl.io.units import Conversion

UNIT = "unit_string"
_START = "wf_start_time"
_UNSET = 1.0  # [s] LabVIEW's increment of a waveform that was given none
_MARK = "erdctl_record"  # a group that is a record even if it is the only one


def library() -> Any:
    """npTDMS. Raises ComputationProblem if it is not installed."""
    found = need("nptdms", extra="tdms", purpose="NI TDMS files")
    found.log.log_manager.set_level(logging.ERROR)  # what it warns of is said in a note
    return found


def read(file: Any, name: str) -> tuple[list[ChannelGroup], list[str]]:
    """The groups of a file; file : path or stream."""
    opened = library().TdmsFile.open(file)
    channels = [c for g in opened.groups() for c in g.channels() if len(c)]
    starts = [c.properties[_START] for c in channels if _START in c.properties]
    starts += [c[0] for c in channels if c.dtype.kind == "M"]
    origin = min(starts, default=None)
    groups, notes = [], []
    for group in opened.groups():
        inside = [c for c in group.channels() if len(c)]
        members = [_channel(c, origin, name) for c in inside]
        clock = clock_of(members) if all(_increment(c) == _UNSET for c in inside) else Choice()
        if clock.clock is not None and clock.sure:
            members = [_channel(c, origin, name, wave=False) for c in inside]
            notes.append(
                f"the time of '{group.name}' is its channel '{clock.clock.name}'; wf_increment is"
                f" {_UNSET:g} s, as if not set"
            )
        record = _MARK in group.properties
        if members and all(c.timed for c in members):
            groups.append(ChannelGroup(group.name, tuple(members), record=record))
        else:
            groups.append(with_clock(group.name, members, name, record=record))
    status = opened.file_status
    cut = "its last segment is incomplete: the recording was cut off, and what is there is read"
    return groups, [*notes, cut] if status.incomplete_final_segment else notes


def _increment(channel: Any) -> float:
    return float(channel.properties.get("wf_increment", 0.0))


def _channel(channel: Any, origin: Any, file: str, *, wave: bool = True) -> Channel:
    """origin : the earliest point of time in the file, from which all others are counted

    wave : the time of its waveform holds
    """
    properties = channel.properties
    unit = stored_unit(properties.get("wf_xunit_string")) or "s"
    step = _increment(channel) if wave else 0.0
    seconds = from_stored(unit, TIME, channel.name, file) if step else Conversion()
    stamps = channel.dtype.kind == "M"

    def load() -> Samples:
        values = channel[:]
        if stamps:
            values = (values - origin) / np.timedelta64(1, "ns") * 1e-9
        if not step:
            return Samples(values)
        start = float(properties.get("wf_start_offset", 0.0))
        time = seconds(start + step * np.arange(len(values), dtype=np.float64))
        if _START in properties:
            # Channels that were started one after the other say so here.
            time += float((properties[_START] - origin) / np.timedelta64(1, "ns") * 1e-9)
        return Samples(values, time)

    return Channel(channel.name, "s" if stamps else properties.get(UNIT), load, timed=bool(step))


def write(records: Sequence[tuple[str | None, Columns]], stream: BinaryIO) -> None:
    """Write records, each with its columns, as groups of a TDMS file."""
    tdms = library()
    objects: list[Any] = [tdms.RootObject({"name": "erdctl log"})]
    for name, columns in records:
        group = "log" if name is None else name
        objects.append(tdms.GroupObject(group, {} if name is None else {_MARK: name}))
        for column in columns:
            properties = {} if column.unit is None else {UNIT: column.unit}
            values = column.values
            if values.dtype == np.float16:  # which the format does not know
                values = values.astype(np.float32)
            objects.append(tdms.ChannelObject(group, column.name, values, properties))
    with tdms.TdmsWriter(stream) as writer:
        writer.write_segment(objects)
