"""HDF5 of any program through h5py: vectors in groups, tables, matrices whose columns have names.

    /run1/t, /run1/force, ...        a group with vectors of its own: a record, or a part of one
    /force/data with /force/time     a group that is one channel
    compound datasets                a channel for each field
    (n, k) with an attribute of k names

Units are attributes `unit` or `units`. Time is a vector t or time of the group, of one around it,
or the only one of the file; else an attribute of each dataset, or of the group, says the interval
or the rate. Nothing outside of the file is opened: links to others, virtual and external datasets
are left out, and it is said. A log goes out as a group for each record, in their order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, BinaryIO

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.io.containers.channels import Channel, ChannelGroup, Samples
from erdctl.io.containers.clocks import Choice, clock_of, is_called_clock, with_clock
from erdctl.io.containers.hdf5_walk import Hdf5Group, attribute, attributes, walked
from erdctl.io.containers.outgoing import Columns
from erdctl.io.containers.scaling import scaling
from erdctl.io.extras import need
from erdctl.io.units import factor_between

_UNITS = ("unit", "units", "unit_string")
_HEADS = (
    "names", "columns", "channels", "colheaders", "labels", "column_names", "channel_names",
    "fields", "header",
)  # fmt: skip
_FILL = ("_fillvalue", "missing_value")  # what stands for no sample, by netCDF
_STEPS = ("dt", "sampling_interval", "sample_interval", "increment", "wf_increment")  # [s]
_RATES = ("fs", "sample_rate", "samplerate", "sampling_rate", "sampling_frequency")  # [Hz]
_ALIKE = 1e-3  # of an interval: the same, written twice
_DATA = ("data", "values", "value", "samples", "signal")
_MARK = "erdctl_record"  # attribute of a group that is a record even if it is the only one
_NAME = "erdctl_name"  # attribute of a dataset: a column's name, which may be none of a dataset


def library() -> Any:
    """h5py. Raises ComputationProblem if it is not installed."""
    return need("h5py", extra="hdf5", purpose="HDF5 files")


def read(file: Any, name: str) -> tuple[list[ChannelGroup], list[str]]:
    """The groups with vectors in them; file : path or stream."""
    opened = library().File(file, "r", locking=False)
    found, notes = walked(opened)
    parts = _absorbed([_part(f, notes, name) for f in found], notes, name)
    choices = [p.choice for p in parts if p.choice.clock is not None]
    only = choices[0] if len(choices) == 1 else Choice()
    timed = [_timed(p, parts, only, notes) for p in parts]
    titles = [p.found.title for p in parts]
    groups = []
    for part, channels in zip(parts, timed, strict=True):
        if len(channels) == 1 and any(channels[0] in c for c in timed if c is not channels):
            continue  # the time of other groups, and nothing else
        title = part.found.title
        label = title if titles.count(title) == 1 else part.found.path
        mark = attribute(part.found.attributes, (_MARK,))
        label = mark if isinstance(mark, str) else label
        groups.append(with_clock(label, channels, name, record=mark is not None))
    return groups, notes


@dataclass(frozen=True, eq=False)
class _Series:
    """A channel, and the interval that is stated for it alone [s]."""

    channel: Channel
    step: float | None = None


@dataclass(frozen=True, eq=False)
class _Part:
    """A group with what was made of its datasets; step : the interval that is stated for all."""

    found: Hdf5Group
    series: tuple[_Series, ...]
    step: float | None

    @cached_property
    def choice(self) -> Choice:
        return clock_of([s.channel for s in self.series])

    @property
    def of_data(self) -> bool:
        """Whether its only vector beside the time is called like `data`."""
        named = [s.channel.name for s in self.series if not is_called_clock(s.channel)]
        return len(named) == 1 and named[0].casefold() in _DATA


def _part(found: Hdf5Group, notes: list[str], file: str) -> _Part:
    out: list[_Series] = []
    for key, data in found.datasets:
        about = attributes(data)
        own = about.get(_NAME)
        key = own if isinstance(own, str) else key
        step = _step(about, found.path + key, file)
        out += [_Series(c, step) for c in _channels(found, key, data, about, notes, file)]
    return _Part(found, tuple(out), _step(found.attributes, found.path, file))


def _channels(
    found: Hdf5Group, key: str, data: Any, about: dict[str, Any], notes: list[str], file: str
) -> list[Channel]:
    """What a dataset holds."""
    out: list[Channel] = []
    unit = _unit(attribute(about, _UNITS))
    units = _texts(attribute(about, _UNITS))
    if data.dtype.names:
        for i, column in enumerate(data.dtype.names):
            if data.dtype[column].shape or data.ndim != 1:
                notes.append(f"'{found.path}{key}.{column}' is no series of values, left out")
                continue
            own = _unit(attribute(about, (f"{column}_unit", f"{column}_units")))
            own = own or (units[i] if len(units) == len(data.dtype.names) else None)
            out.append(_channel(column, own, data, about, notes, file, field=column))
        return out
    lengths = [n for n in data.shape if n > 1]
    if not lengths:
        return out  # a single value says something about the test
    if len(lengths) == 1:
        return [_channel(key, unit, data, about, notes, file)]
    heads = _texts(attribute(about, _HEADS)) or _beside(found, key)
    if data.ndim != 2 or len(heads) not in data.shape:
        size = " x ".join(map(str, data.shape))
        notes.append(f"'{found.path}{key}' ({size}) has no names for its columns, left out")
        return out
    across = data.shape[1] == len(heads)
    for i, head in enumerate(heads):
        own = units[i] if len(units) == len(heads) else unit
        where = (slice(None), i) if across else (i, slice(None))
        out.append(_channel(head, own, data, about, notes, file, where=where))
    return out


def _beside(found: Hdf5Group, key: str) -> list[str]:
    """Names of columns in a dataset of texts next to theirs."""
    wanted = (*_HEADS, key.removesuffix("_values") + "_items")
    return next((_texts(d[...]) for k, d in found.datasets if k.casefold() in wanted), [])


def _channel(
    name: str,
    unit: str | None,
    data: Any,
    about: dict[str, Any],
    notes: list[str],
    file: str,
    *,
    field: str | None = None,
    where: Any = ...,
) -> Channel:
    count = data.shape[0] if field else max(data.shape)
    kind = data.dtype[field].kind if field else data.dtype.kind
    scale = scaling(about, name, file, counts=kind in "iu")
    if scale.said is not None and scale.said not in notes and kind in "iuf":
        notes.append(scale.said)
    fills = [v for k, v in about.items() if k.casefold() in _FILL and kind in "iuf"]

    def load() -> Samples:
        if data.dtype.kind == "O":
            return Samples(np.squeeze(np.array(data.asstr()[where], object)))
        values = np.squeeze(data.fields(field)[...] if field else data[where])
        if kind not in "iuf":
            return Samples(values)
        missing = np.zeros(values.shape, bool)
        for fill in fills:
            missing |= np.isin(values, np.asarray(fill))
        values = scale(values)
        return Samples(np.where(missing, np.nan, values) if missing.any() else values)

    return Channel(name, unit, load, count=int(count))


def _absorbed(parts: Sequence[_Part], notes: list[str], file: str) -> list[_Part]:
    """With groups that are one channel made channels of the group around them."""
    whole = {p.found.path: p for p in parts}
    out: dict[str, _Part] = dict(whole)
    for path, part in whole.items():
        outer = out.get(part.found.around)
        if not part.of_data or outer is None or part.found.path == "/":
            continue
        group = with_clock("", [s.channel for s in part.series], file)
        if len(group.channels) > 1:
            continue  # what is called like a time is none, but a second channel
        notes += group.notes
        unit = _unit(attribute(part.found.attributes, _UNITS))
        own = group.channels[0]
        named = replace(own, name=part.found.title, unit=own.unit or unit)
        step = next((s.step for s in part.series if s.step is not None), part.step)
        one = _Series(named, None if own.timed else step)
        out[part.found.around] = replace(outer, series=(*outer.series, one))
        del out[path]
    return list(out.values())


def _timed(part: _Part, parts: Sequence[_Part], only: Choice, notes: list[str]) -> list[Channel]:
    """The channels of a group; where none of them is surely their time, with that of a group
    around it, or with what attributes say of them or of a group around them."""
    channels = [s.channel for s in part.series]
    if not channels or part.choice.sure:
        return channels
    around = [p for p in parts if part.found.path.startswith(p.found.path)]
    around.sort(key=lambda p: len(p.found.path), reverse=True)
    nearest = next((p.choice for p in around if p.choice.clock is not None), only)
    counts = {c.count for c in channels}
    if nearest.clock is None or nearest.clock in channels or nearest.clock.count not in counts:
        nearest = Choice()
    outer = [] if nearest.clock is None else [nearest.clock]
    if nearest.sure or (outer and any(c.timed for c in channels)):
        return [*outer, *channels]
    steps = {s.step for s in part.series if s.step is not None}
    shared = next((p.step for p in around if p.step is not None), None)
    if shared is None and len(steps) == 1 and len(counts) == 1:
        shared = next(iter(steps))  # stated once, for vectors of one length
    every = [s.step or shared for s in part.series]
    if not any(every):
        return [*outer, *channels]
    open_ = [(c, step) for c, step in zip(channels, every, strict=True) if not c.timed and step]
    said = {c.name: f"dt = {step:g} s" for c, step in open_}
    if len(set(said.values())) == 1:
        said = {part.found.title: next(iter(said.values()))}
    notes += [f"the time of '{n}' is made of its attribute, {text}" for n, text in said.items()]
    made = {c: _clocked(c, step) for c, step in open_}
    return [made.get(c, c) for c in channels]


def _clocked(channel: Channel, step: float) -> Channel:
    def load() -> Samples:
        own = channel.load()
        return Samples(own.values, step * np.arange(len(own.values), dtype=np.float64))

    return replace(channel, load=load, timed=True)


def _step(about: dict[str, Any], place: str, file: str) -> float | None:
    """The interval between samples that attributes state, in any unit of time or of rate [s].

    Raises InputProblem if they state two.
    """
    steps = [v for k in _STEPS if (v := _number(about, k, "s", place)) is not None]
    steps += [1.0 / v for k in _RATES if (v := _number(about, k, "Hz", place)) is not None]
    if steps and max(steps) > min(steps) * (1.0 + _ALIKE):
        said = " and ".join(f"{s:g} s" for s in steps)
        raise InputProblem(
            f"the attributes of '{place}' state intervals of {said}; keep one", file=file
        )
    return steps[0] if steps else None


def _number(about: dict[str, Any], kind: str, wanted: str, place: str) -> float | None:
    value = attribute(about, (kind,))
    if value is None or np.size(value) != 1 or np.asarray(value).dtype.kind not in "iuf":
        return None
    number = float(np.asarray(value).ravel()[0])
    unit = _unit(attribute(about, (f"{kind}_unit", f"{kind}_units")))
    if unit is not None:
        number *= factor_between(unit, wanted, f"the attribute {kind} of '{place}'")
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
    with h5py.File(stream, "w", track_order=True) as file:
        for name, columns in records:
            group = file.create_group(
                "log" if name is None else _free(file, name), track_order=True
            )
            if name is not None:
                group.attrs[_MARK] = name
            for column in columns:
                text = column.values.dtype.kind == "O"
                kind = h5py.string_dtype() if text else None
                key = _free(group, column.name)
                made = group.create_dataset(key, data=column.values, dtype=kind)
                if key != column.name:
                    made.attrs[_NAME] = column.name
                if column.unit is not None:
                    made.attrs["units"] = column.unit


def _free(group: Any, name: str) -> str:
    """A name that HDF5 allows, where a stroke leads into a group, and nothing in the group has."""
    key = whole = "∕".join(name.split("/"))
    copy = 2
    while key in group or key == ".":
        key, copy = f"{whole} ({copy})", copy + 1
    return key
