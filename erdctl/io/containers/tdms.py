"""NI TDMS through npTDMS.

Time is the waveform's (`wf_increment`, `wf_start_offset`, `wf_start_time`), else the group's
channel called t or time. Units are `unit_string`; NI's linear, polynomial and table scalings are
applied by the library. A log goes out as one group for each record, with `t` as a channel.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any, BinaryIO

import numpy as np

from erdctl.io.containers.channels import Channel, ChannelGroup, Samples, with_clock
from erdctl.io.containers.outgoing import Columns
from erdctl.io.extras import need

UNIT = "unit_string"
_START = "wf_start_time"
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
    groups = []
    for group in opened.groups():
        members = [_channel(c, origin) for c in group.channels() if len(c)]
        record = _MARK in group.properties
        if members and all(c.timed for c in members):
            groups.append(ChannelGroup(group.name, tuple(members), record=record))
        else:
            groups.append(with_clock(group.name, members, name, record=record))
    status = opened.file_status
    cut = "its last segment is incomplete: the recording was cut off, and what is there is read"
    return groups, [cut] if status.incomplete_final_segment else []


def _channel(channel: Any, origin: Any) -> Channel:
    """origin : the earliest point of time in the file, from which all others are counted"""
    properties = channel.properties
    step = float(properties.get("wf_increment", 0.0))
    stamps = channel.dtype.kind == "M"

    def load() -> Samples:
        values = channel[:]
        if stamps:
            values = (values - origin) / np.timedelta64(1, "ns") * 1e-9
        if not step:
            return Samples(values)
        start = float(properties.get("wf_start_offset", 0.0))
        if _START in properties:
            # Channels that were started one after the other say so here.
            start += (properties[_START] - origin) / np.timedelta64(1, "ns") * 1e-9
        return Samples(values, start + step * np.arange(len(values), dtype=np.float64))

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
