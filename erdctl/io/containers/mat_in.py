"""MATLAB files as channels, in the shapes in which labs save them.

A channel is
    a vector together with others, and a vector `t` or `time` as their clock;
    a struct or object with data and time: timeseries, `Structure with time`, an element of a
    Simulink Dataset; counts with `scale` (`gain`, `factor`, `slope`) and `offset` (`bias`);
    a column of a table, or of a matrix `data` with `colheaders`.
Elements of a struct array are records. Units are a field `unit` or `units` next to the data, or a
struct or variable `units` with the names of the fields.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from erdctl.core.recording import Array
from erdctl.io.containers.channels import TIME, Channel, ChannelGroup, Samples
from erdctl.io.containers.clocks import CLOCKS, clock_of, with_clock
from erdctl.io.containers.mat_file import Node, variables
from erdctl.io.containers.scaling import scaling
from erdctl.io.named import is_called
from erdctl.io.stored import from_stored, stored_unit
from erdctl.io.units import RECORD, UNITS

_DATA = ("data", "values", "value", "samples", "raw")
_UNITS = ("units", "unit")
_NAMES = ("name", "label", "signalname")
_HEADS = ("colheaders", "names", "labels", "varnames", "channels")
_TITLES = ("record", "name", "test", "title", "label")


def read(file: Any, name: str) -> tuple[list[ChannelGroup], list[str]]:
    """The groups of channels in a file, and remarks; file : path or stream."""
    found, notes = variables(file)
    return _Reader(name, notes).groups("variables", found, _Said()), notes


@dataclass(frozen=True)
class _Said:
    """Units, and names that are no MATLAB names, by the field that they are said of."""

    units: dict[str, str] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)

    def and_of(self, node: Mapping[str, Node]) -> _Said:
        """With what a struct says of its own fields: as structs, units also as a cell array."""
        units = next((v for k, v in node.items() if _low(k) in _UNITS), None)
        fields = [k for k, v in node.items() if _is_vector(v) and _low(k) not in _UNITS]
        if isinstance(units, list) and len(units) == len(fields):
            units = dict(zip(fields, units, strict=True))
        return _Said(self.units | _texts(units), self.names | _texts(node.get("names")))

    def about(self, channel: Channel) -> Channel:
        return replace(
            channel,
            name=self.names.get(channel.name, channel.name),
            unit=channel.unit or self.units.get(channel.name),
        )


class _Reader:
    """Walks through a file; notes : where remarks on what has no place go."""

    def __init__(self, file: str, notes: list[str]) -> None:
        self.file, self.notes = file, notes

    def groups(
        self, name: str, node: Mapping[str, Node], outer: _Said, *, record: bool = False
    ) -> list[ChannelGroup]:
        """The groups in a struct: its own vectors and series together, then what is inside it.

        outer : what the structs around it say of fields of these names
        """
        said, low = outer.and_of(node), _lowered(node)
        heads = [h for v in node.values() if (h := _heads(low, v)) is not None]
        own: list[Channel] = []
        inside: list[ChannelGroup] = []
        for key, value in node.items():
            if (_low(key) in _UNITS and not _is_numeric(value)) or any(value is h for h in heads):
                continue
            if isinstance(value, dict) and _title(value.get(RECORD)):  # one that has a name
                inside += self.records(key, [value], said)
            elif (series := self.series(key, value)) is not None:
                own += series
            elif isinstance(value, dict):
                inside += self.groups(key, value, said)
            elif _structs(value) and any(_title(v.get(RECORD)) for v in value):
                inside += self.records(key, value, said)
            elif _structs(value):
                parts = [self.series(f"{key}({i + 1})", v) for i, v in enumerate(value)]
                if all(p is not None for p in parts):
                    own += [c for p in parts if p is not None for c in p]
                else:
                    inside += self.records(key, value, said)
            elif (names := _heads(low, value)) is not None:
                own += [_channel(str(h), _of(low, i), value[:, i]) for i, h in enumerate(names)]
            elif _is_vector(value):
                own.append(_channel(key, None, value))
            elif isinstance(value, np.ndarray) and value.ndim > 1 and value.size:
                self.left_out(key, value, "has no names for its columns")
        own = [said.about(c) for c in own]
        group = with_clock(name, own, self.file, record=record)
        if not record:
            return [group, *inside]
        channels = (*group.channels, *(c for g in inside for c in g.channels))
        return [replace(group, channels=channels)]

    def left_out(self, name: str, value: Any, why: str) -> None:
        size = " x ".join(map(str, np.shape(value)))
        self.notes.append(f"'{name}' ({size}) {why}, left out")

    def records(
        self, name: str, elements: Sequence[Mapping[str, Node]], outer: _Said
    ) -> list[ChannelGroup]:
        """The elements of a struct array."""
        out = []
        for i, element in enumerate(elements):
            low = {_low(k): v for k, v in element.items()}
            title = next((t for k in _TITLES if (t := _title(low.get(k)))), f"{name}({i + 1})")
            out += self.groups(title, element, outer, record=True)
        return out

    def series(self, name: str, node: Node) -> list[Channel] | None:
        """The channels of data that state their time or scaling themselves; None if it is other."""
        if not isinstance(node, dict):
            return None
        low = _lowered(node)
        title = next((t for k in _NAMES if (t := _title(low.get(k)))), name)
        if "storage" in low and isinstance(low["storage"], dict):  # a Dataset object
            return self.series(title, low["storage"])
        if _structs(low.get("elements")):
            parts = [self.series(f"{name}{{{i + 1}}}", e) for i, e in enumerate(low["elements"])]
            return [c for p in parts for c in p or []]
        if isinstance(low.get("values"), dict):  # an element of a Dataset: a name and its values
            found = self.series(title, low["values"]) or self.bus(title, low["values"])
            # The name of the signal, whatever the series in it is called.
            return [replace(found[0], name=title)] if len(found) == 1 else found
        if "signals" in low:
            return self.signals(name, node, low)
        key = next((k for k in _DATA if _is_numeric(low.get(k))), None)
        if key is None:
            return None
        data = low[key]
        if (heads := _heads(low, data)) is not None:
            columns = [_channel(str(h), _of(low, i), data[:, i]) for i, h in enumerate(heads)]
            return list(with_clock(name, columns, self.file).channels)
        clock = _clock(node, low)
        rest = [
            k
            for k, v in node.items()
            if _is_vector(v) and _low(k) not in (*_UNITS, *_NAMES, *_HEADS)
            if v is not data and v is not clock
        ]
        if rest and not self.described(low, rest):
            return None  # a group in which one vector happens to be called so
        for other in rest:
            self.left_out(f"{name}.{other}", node[other], f"stands beside '{name}.{key}'")
        time = self.time(name, low, clock)
        return self.columns(title, data, time, _unit(low), low, counts=key == "raw")

    @staticmethod
    def described(low: Mapping[str, Node], rest: Sequence[str]) -> bool:
        """Whether a struct says of itself that it is one series, whatever else is in it."""
        if "datainfo" in low or "timeinfo" in low:
            return True
        log = any(is_called(k, target) for k in rest for target in UNITS if target != TIME)
        return not log and any(k in low for k in (*CLOCKS, "scale", "gain", "factor", "slope"))

    def bus(self, name: str, node: Mapping[str, Node]) -> list[Channel]:
        parts = [self.series(key, value) for key, value in node.items()]
        if not any(parts):
            self.notes.append(f"'{name}' holds no time series, left out")
        return [replace(c, name=f"{name}.{c.name}") for p in parts for c in p or []]

    def signals(
        self, name: str, node: Mapping[str, Node], low: Mapping[str, Node]
    ) -> list[Channel]:
        """`Structure with time` as To Workspace and scopes save it."""
        signals = low["signals"] if isinstance(low["signals"], list) else [low["signals"]]
        time = self.time(name, low, _clock(node, low))
        out: list[Channel] = []
        for i, signal in enumerate(signals):
            if not isinstance(signal, dict) or not _is_numeric(signal.get("values")):
                self.notes.append(f"'{name}.signals({i + 1})' has no values, left out")
                continue
            block = str(signal.get("blockName") or "").rpartition("/")[2]
            own = signal.get("label") or signal.get("title") or block
            title = own if isinstance(own, str) and own else f"{name}({i + 1})"
            lower = _lowered(signal)
            out += self.columns(title, signal["values"], time, _unit(lower), lower)
        return out

    def columns(
        self,
        name: str,
        data: Any,
        time: Array | None,
        unit: str | None,
        low: Mapping[str, Node],
        *,
        counts: bool = False,
    ) -> list[Channel]:
        """counts : the file says that these are counts, whatever they are stored as"""
        data = np.asarray(data)
        scale = scaling(low, name, self.file, counts=counts or data.dtype.kind in "iub")
        if scale.said is not None:
            self.notes.append(scale.said)
        data = scale(data)
        if data.ndim == 1:
            return [_channel(name, unit, data, time)]
        if data.ndim == 2 and time is not None and len(time) in data.shape:
            data = data if data.shape[0] == len(time) else data.T
            return [_channel(f"{name}({i + 1})", unit, c, time) for i, c in enumerate(data.T)]
        self.left_out(name, data, "is no series of numbers")
        return []

    def time(self, name: str, low: Mapping[str, Node], clock: Node) -> Array | None:
        """(n,) [s], also where a timeseries keeps it as start, increment and length."""
        about = low.get("timeinfo")
        info = _lowered(about) if isinstance(about, dict) else {}
        unit = _text(info.get("units")) or "s"
        convert = from_stored(stored_unit(unit) or "s", "t", name, self.file)
        for time in (clock, info.get("time")):
            if _is_vector(time) and _is_numeric(time):
                return convert(np.asarray(time, np.float64))
        start, step, length = (_scalar(info.get(k)) for k in ("start", "increment", "length"))
        if step is not None and length is not None and np.isfinite(step):
            return convert(np.float64(start or 0.0) + step * np.arange(length, dtype=np.float64))
        return None


def _lowered(node: Mapping[str, Node]) -> dict[str, Node]:
    """The fields by their names in small letters; of two the one that is spelt so."""
    order = sorted(node, key=lambda key: key == _low(key))
    return {_low(key): node[key] for key in order}


def _clock(node: Mapping[str, Node], low: Mapping[str, Node]) -> Node:
    """The field of a struct that is its time; None if there is none."""
    info = low.get("timeinfo")
    unit = _text(_lowered(info).get("units")) if isinstance(info, dict) else None
    called = [k for k, v in node.items() if _low(k) in CLOCKS and _is_vector(v) and _is_numeric(v)]
    clock = clock_of([_channel(k.rstrip("_"), unit, node[k]) for k in called]).clock
    return None if clock is None else clock.load().values


def _low(key: str) -> str:
    return key.rstrip("_").casefold()


def _channel(name: str, unit: str | None, values: Any, time: Array | None = None) -> Channel:
    array = np.array(values, object) if isinstance(values, list) else values
    return Channel(name, unit, lambda: Samples(array, time), timed=time is not None)


def _title(value: Node) -> str:
    return value if isinstance(value, str) and value != "unnamed" else ""  # timeseries' default


def _texts(node: Node) -> dict[str, str]:
    return {k: v for k, v in node.items() if isinstance(v, str)} if isinstance(node, dict) else {}


def _unit(low: Mapping[str, Node]) -> str | None:
    own = next((_text(low[k]) for k in _UNITS if k in low), None)
    about = low.get("datainfo")
    if own or not isinstance(about, dict):
        return own
    return _text(next((v for k, v in about.items() if _low(k) in _UNITS), None))


def _heads(low: Mapping[str, Node], matrix: Node) -> list[Any] | None:
    """The names of the columns of a matrix that stand beside it."""
    if not _is_numeric(matrix) or matrix.ndim != 2:
        return None
    lists = [low[h] for h in _HEADS if isinstance(low.get(h), list)]
    return next((h for h in lists if len(h) == matrix.shape[1]), None)


def _of(low: Mapping[str, Node], index: int) -> str | None:
    units = next((low[k] for k in _UNITS if isinstance(low.get(k), list)), None)
    return _text(units[index]) if units is not None and index < len(units) else None


def _text(value: Node) -> str | None:
    if isinstance(value, dict):  # Simulink keeps units as objects with a name
        value = next((v for k, v in value.items() if _low(k) == "name"), None)
    return value if isinstance(value, str) else None


def _structs(value: Node) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def _is_numeric(value: Node) -> bool:
    return isinstance(value, np.ndarray) and value.dtype.kind in "iufb" and value.ndim > 0


def _is_vector(value: Node) -> bool:
    if isinstance(value, list):
        return len(value) > 1 and all(isinstance(v, str) for v in value)
    return isinstance(value, np.ndarray) and value.ndim == 1 and value.size > 1


def _scalar(value: Node) -> float | None:
    number = isinstance(value, (int, float, np.ndarray)) and np.size(value) == 1
    return float(value) if number and np.asarray(value).dtype.kind in "iuf" else None
