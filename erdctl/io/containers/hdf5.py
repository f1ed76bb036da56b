"""HDF5 of any program through h5py: vectors in groups, tables, matrices whose columns have names.

    /run1/t, /run1/force, ...        a group with vectors of its own: a record, or a part of one
    /force/data with /force/time     a group that is one channel
    compound datasets                a channel for each field
    (n, k) with an attribute of k names

Units are attributes `unit` or `units`. Time is a vector t or time of the group, of one around it,
or the only one of the file; else an attribute says the interval or the rate. Nothing outside of the
file is opened: links to others, virtual and external datasets are left out, and it is said.
A log goes out as a group for each record.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, BinaryIO

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.io.containers.channels import CLOCKS, Channel, ChannelGroup, Samples, with_clock
from erdctl.io.containers.hdf5_walk import Hdf5Group, attribute, attributes, walked
from erdctl.io.containers.outgoing import Columns
from erdctl.io.extras import need
from erdctl.io.units import name_and_unit

_UNITS = ("unit", "units", "unit_string")
_HEADS = (
    "names", "columns", "channels", "colheaders", "labels", "column_names", "channel_names",
    "fields", "header",
)  # fmt: skip
_FACTORS = ("scale_factor", "scale", "gain", "factor", "slope")
_OFFSETS = ("add_offset", "offset", "bias")
_STEPS = ("dt", "sampling_interval", "sample_interval", "increment", "wf_increment")  # [s]
_RATES = ("fs", "sample_rate", "samplerate", "sampling_rate", "sampling_frequency")  # [Hz]
_DATA = ("data", "values", "value", "samples", "signal")
_MARK = "erdctl_record"  # attribute of a group that is a record even if it is the only one


def library() -> Any:
    """h5py. Raises ComputationProblem if it is not installed."""
    return need("h5py", extra="hdf5", purpose="HDF5 files")


def read(file: Any, name: str) -> tuple[list[ChannelGroup], list[str]]:
    """The groups with vectors in them; file : path or stream."""
    opened = library().File(file, "r", locking=False)
    found, notes = walked(opened)
    parts = [_Part(f, *_channels(f, notes, name)) for f in found]
    parts = _absorbed(parts)
    clocks = [p.clock for p in parts if p.clock is not None]
    only = clocks[0] if len(clocks) == 1 else None
    titles = [p.found.title for p in parts]
    groups = []
    for part in parts:
        title = part.found.title
        label = title if titles.count(title) == 1 else part.found.path
        channels = list(part.channels)
        if part.clock is None and channels:
            channels = _timed(part, parts, only, notes)
        record = attribute(part.found.attributes, (_MARK,)) is not None
        groups.append(with_clock(label, channels, name, record=record))
    return groups, notes


@dataclass(frozen=True, eq=False)
class _Part:
    """A group with the channels that were made of its datasets."""

    found: Hdf5Group
    channels: tuple[Channel, ...]
    of_data: bool  # its only vector beside the time is called like `data`

    @property
    def clock(self) -> Channel | None:
        return next((c for c in self.channels if _is_clock(c)), None)


def _is_clock(channel: Channel) -> bool:
    return name_and_unit(channel.name)[0].casefold() in CLOCKS


def _channels(found: Hdf5Group, notes: list[str], file: str) -> tuple[tuple[Channel, ...], bool]:
    out: list[Channel] = []
    for key, data in found.datasets:
        about = attributes(data)
        unit = _unit(attribute(about, _UNITS))
        if data.dtype.names:
            units = _texts(attribute(about, _UNITS))
            for i, column in enumerate(data.dtype.names):
                if data.dtype[column].shape or data.ndim != 1:
                    notes.append(f"'{found.path}{key}.{column}' is no series of values, left out")
                    continue
                own = _unit(attribute(about, (f"{column}_unit", f"{column}_units")))
                own = own or (units[i] if len(units) == len(data.dtype.names) else None)
                out.append(_channel(column, own, data, about, file, field=column))
            continue
        lengths = [n for n in data.shape if n > 1]
        if not lengths:
            continue  # a single value says something about the test
        if len(lengths) == 1:
            out.append(_channel(key, unit, data, about, file))
            continue
        heads = _texts(attribute(about, _HEADS)) or _beside(found, key)
        if data.ndim != 2 or len(heads) not in data.shape:
            size = " x ".join(map(str, data.shape))
            notes.append(f"'{found.path}{key}' ({size}) has no names for its columns, left out")
            continue
        units, across = _texts(attribute(about, _UNITS)), data.shape[1] == len(heads)
        for i, head in enumerate(heads):
            own = units[i] if len(units) == len(heads) else unit
            where = (slice(None), i) if across else (i, slice(None))
            out.append(_channel(head, own, data, about, file, where=where))
    series = [c for c in out if not _is_clock(c)]
    return tuple(out), len(series) == 1 and series[0].name.casefold() in _DATA


def _beside(found: Hdf5Group, key: str) -> list[str]:
    """Names of columns in a dataset of texts next to theirs."""
    wanted = (*_HEADS, key.removesuffix("_values") + "_items")
    return next((_texts(d[...]) for k, d in found.datasets if k.casefold() in wanted), [])


def _channel(
    name: str,
    unit: str | None,
    data: Any,
    about: dict[str, Any],
    file: str,
    *,
    field: str | None = None,
    where: Any = ...,
) -> Channel:
    count = data.shape[0] if field else max(data.shape)
    factor, offset = (_scale(about, kinds, name, file) for kinds in (_FACTORS, _OFFSETS))

    def load() -> Samples:
        if data.dtype.kind == "O":
            values = np.array(data.asstr()[where], object)
        else:
            values = data.fields(field)[...] if field else data[where]
        values = np.squeeze(values)
        if factor is not None or offset is not None:
            values = values * (1.0 if factor is None else factor) + (offset or 0.0)
        return Samples(values)

    return Channel(name, unit, load, count=int(count))


def _scale(about: dict[str, Any], kinds: Sequence[str], name: str, file: str) -> float | None:
    found = {k: about[k] for k in about if k.casefold() in kinds and np.size(about[k]) == 1}
    if len(found) > 1:
        raise InputProblem(
            f"has the attributes {' and '.join(found)}; which of them scales it is not clear:"
            " keep one",
            file=file,
            column=name,
        )
    value = next(iter(found.values()), None)
    number = value is not None and np.asarray(value).dtype.kind in "iuf"
    return float(np.asarray(value).ravel()[0]) if number else None


def _absorbed(parts: Sequence[_Part]) -> list[_Part]:
    """With groups that are one channel made channels of the group around them."""
    whole = {p.found.path: p for p in parts}
    out: dict[str, _Part] = dict(whole)
    for path, part in whole.items():
        outer = out.get(part.found.around)
        if not part.of_data or outer is None or part.found.path == "/":
            continue
        group = with_clock("", part.channels, "")
        unit = _unit(attribute(part.found.attributes, _UNITS))
        own = group.channels[0]
        named = replace(own, name=part.found.title, unit=own.unit or unit)
        out[part.found.around] = replace(outer, channels=(*outer.channels, named))
        del out[path]
    return list(out.values())


def _timed(
    part: _Part, parts: Sequence[_Part], only: Channel | None, notes: list[str]
) -> list[Channel]:
    """The channels of a group without a time, with that of a group around it, or a rate."""
    around = [p for p in parts if part.found.path.startswith(p.found.path) and p.clock is not None]
    nearest = max(around, key=lambda p: len(p.found.path)).clock if around else only
    count = max(c.count or 0 for c in part.channels)
    if nearest is not None and nearest.count == count:
        return [nearest, *part.channels]
    if any(c.timed for c in part.channels):
        return list(part.channels)
    for about in (part.found.attributes, *(attributes(d) for _, d in part.found.datasets)):
        step, rate = _number(about, _STEPS), _number(about, _RATES)
        if step is None and rate is not None:
            step = 1.0 / rate
        if step is not None:
            said = f"dt = {step:g} s" if rate is None else f"a rate of {rate:g} Hz"
            notes.append(f"the time of '{part.found.title}' is made of its attribute, {said}")
            return [_clocked(c, step) for c in part.channels]
    return list(part.channels)


def _clocked(channel: Channel, step: float) -> Channel:
    def load() -> Samples:
        own = channel.load()
        return Samples(own.values, step * np.arange(len(own.values), dtype=np.float64))

    return replace(channel, load=load, timed=True)


def _number(about: dict[str, Any], kinds: Sequence[str]) -> float | None:
    value = attribute(about, kinds)
    if value is None or np.size(value) != 1 or np.asarray(value).dtype.kind not in "iuf":
        return None
    number = float(np.asarray(value).ravel()[0])
    return number if np.isfinite(number) and number > 0.0 else None


def _unit(value: Any) -> str | None:
    """A unit as text; of `ms since 2024-05-01` the first word."""
    texts = _texts(value)
    return texts[0].partition(" since ")[0] if len(texts) == 1 else None


def _texts(value: Any) -> list[str]:
    if value is None or np.asarray(value).dtype.kind not in "OSU":
        return []
    values = np.asarray(value).ravel().tolist()
    texts = [v.decode(errors="replace") if isinstance(v, bytes) else v for v in values]
    if not all(isinstance(t, str) for t in texts):
        return []
    parted = [t.strip() for t in texts[0].split(",")] if len(texts) == 1 else []
    return parted if len(parted) > 1 else texts


def write(records: Sequence[tuple[str | None, Columns]], stream: BinaryIO) -> None:
    """Write records, each with its columns, as groups; `units` are attributes."""
    h5py = library()
    with h5py.File(stream, "w") as file:
        for name, columns in records:
            group = file.create_group("log" if name is None else name.replace("/", "∕"))
            if name is not None:
                group.attrs[_MARK] = name
            for column in columns:
                text = column.values.dtype.kind == "O"
                kind = h5py.string_dtype() if text else None
                made = group.create_dataset(
                    column.name.replace("/", "∕"), data=column.values, dtype=kind
                )
                if column.unit is not None:
                    made.attrs["units"] = column.unit
