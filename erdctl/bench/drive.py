"""Drives described in a line instead of a log: `sine:freq=1,amp=0.01,duty=0.1|0.3,hold=2`.

    KIND:key=value,key=value,...

A drive is the input of a simulation: deflection, its velocity in closed form (a differentiated
deflection has the wrong sign at some reversals) and duty cycle, one record for each drive.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, dataclass, field, fields
from enum import Enum
from typing import Any

import numpy as np

from erdctl.bench.waveforms import KINDS, Waveform, key
from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array, Recording, concatenate

EXAMPLE = "write for instance sine:freq=1,amp=0.01,duty=0.1|0.3,hold=2,duration=10"
# Samples of one drive; more would hardly fit into the memory of a desktop.
MOST_SAMPLES = 50_000_000


@dataclass(frozen=True)
class Duty:
    """Duty cycle over a drive: levels held in turn, again and again, or a ramp between two.

    levels : [1] in 0..1;  ramp : the two levels are the ends of a straight line over the drive
    """

    levels: tuple[float, ...] = (0.0,)
    ramp: bool = False

    def __str__(self) -> str:
        return (".." if self.ramp else "|").join(map(repr, self.levels))

    def __call__(self, t: Array, hold: float, duration: float) -> Array:
        """Duty at t [s], each level for `hold` [s].

        Check: 0.1|0.3 with hold 0.5 gives 0.3 at 0.5 s, 0.1 at 1 s; 0..0.4 in 10 s gives 0.1 at
        2.5 s.
        >>> Duty((0.1, 0.3))(np.array([0.5, 1.0]), hold=0.5, duration=10.0).tolist()
        [0.3, 0.1]
        >>> Duty((0.0, 0.4), ramp=True)(np.array([2.5]), hold=0.5, duration=10.0).tolist()
        [0.1]
        """
        levels = np.array(self.levels)
        if self.ramp:
            along: Array = levels[0] + (levels[1] - levels[0]) * (t / duration)
            return along
        # A step that falls on a sample belongs to it, also where t / hold rounds just below.
        turn = np.floor(t / hold + 1e-9).astype(np.intp)
        held: Array = levels[turn % len(levels)]
        return held


@dataclass(frozen=True, kw_only=True)
class Drive:
    """One described record: a motion, the duty over it and the keys that all kinds share.

    Raises ValueError for keys that do not go together.
    """

    motion: Waveform
    duty: Duty = field(default=Duty())
    hold: float = key(0.5, "s", 1e-4, 1e6, "time at each level of duty")
    duration: float = key(10.0, "s", 1e-4, 1e6, "length of the record")
    fs: float = key(1000.0, "Hz", 0.1, 1e6, "sampling rate")
    offset: float = key(0.0, "m", -1.0, 1.0, "deflection about which the piston moves")

    def __post_init__(self) -> None:
        samples = self.samples
        if not 2 <= samples <= MOST_SAMPLES:
            raise ValueError(
                f"duration={self.duration:g} s at fs={self.fs:g} Hz is {samples} samples; "
                f"expected 2 to {MOST_SAMPLES}"
            )
        if 2 * self.motion.fastest >= self.fs:
            raise ValueError(
                f"fs={self.fs:g} Hz cannot resolve {self.motion.fastest:g} Hz; "
                f"raise fs above {2 * self.motion.fastest:g} Hz"
            )

    @property
    def kind(self) -> str:
        """The name of the motion on the command line."""
        return type(self.motion).__name__.lower()

    @property
    def samples(self) -> int:
        """Number of samples; the last is one step before `duration`."""
        return round(self.duration * self.fs)

    def __str__(self) -> str:
        """Every key, so that `parse_drive` reads back an equal drive."""
        keys = [(f, getattr(self.motion, f.name)) for f in _keys(type(self.motion))]
        keys += [(f, getattr(self, f.name)) for f in _keys(Drive)]
        values = [(f.name, v.value if isinstance(v, Enum) else repr(v)) for f, v in keys]
        return f"{self.kind}:" + ",".join(f"{k}={v}" for k, v in [*values, ("duty", self.duty)])


def parse_drive(spec: str) -> Drive:
    """The drive that one `--drive` describes; a key that is not given has its default.

    KIND:key=value,...  Kinds: sine, sweep, triangle, bumps, hold, noise. Every kind takes
    duration, fs, offset, duty (a number, levels 0.1|0.3 or a ramp 0..0.4) and hold.

    Raises UsageProblem that names the key or value and what is allowed.
    Check: "sine:freq=2,duty=0.2" is Sine(freq=2, amp=0.01), duty 0.2 for 10 s at 1000 Hz.
    >>> d = parse_drive("sine:freq=2,duty=0.2")
    >>> d.motion, d.duty.levels, d.duration, d.fs
    (Sine(freq=2.0, amp=0.01), (0.2,), 10.0, 1000.0)
    """
    name, _, body = (part.strip() for part in spec.partition(":"))
    if name not in KINDS:
        raise _bad(spec, f"unknown kind '{name}', known are {', '.join(KINDS)}")
    own = {f.name: f for f in _keys(KINDS[name])}
    common = {f.name: f for f in _keys(Drive)}
    values: dict[str, Any] = {}
    for part in body.split(",") if body else []:
        word, equals, text = (piece.strip() for piece in part.partition("="))
        if not equals:
            raise _bad(spec, f"'{part.strip()}' is not key=value")
        if word in values:
            raise _bad(spec, f"'{word}' is given twice")
        if word == "duty":
            values[word] = _duty(spec, text)
        elif word in own or word in common:
            values[word] = _value(spec, own.get(word) or common[word], text)
        else:
            allowed = ", ".join([*own, *common, "duty"])
            raise _bad(spec, f"unknown key '{word}', allowed with {name} are {allowed}")
    try:
        motion = KINDS[name](**{k: v for k, v in values.items() if k in own})
        return Drive(motion=motion, **{k: v for k, v in values.items() if k not in own})
    except ValueError as problem:
        raise _bad(spec, str(problem)) from None


def record(drive: Drive, name: str = "") -> Recording:
    """The samples of a drive: one record from t = 0 without force; `name` defaults to the kind."""
    t = np.arange(drive.samples) / drive.fs
    x, xdot = drive.motion(t, drive.duration)
    return Recording(
        t=t,
        x=x + drive.offset,
        xdot=xdot,
        duty=drive.duty(t, drive.hold, drive.duration),
        starts=np.array([0, drive.samples], dtype=np.intp),
        names=(name or drive.kind,),
        xdot_note="closed form of the drive",
    )


def drives(specs: Sequence[str]) -> Recording:
    """Several described drives, one record each, named sine-1, hold-2, ... in the order given."""
    if not specs:
        raise UsageProblem(f"no drive is given; {EXAMPLE}")
    described = [parse_drive(spec) for spec in specs]
    return concatenate([record(d, f"{d.kind}-{i}") for i, d in enumerate(described, start=1)])


def _keys(described: Any) -> list[Field[Any]]:
    """The fields of a dataclass that are written key=value."""
    return [f for f in fields(described) if "unit" in f.metadata]


def _bad(spec: str, why: str) -> UsageProblem:
    return UsageProblem(f"drive '{spec}': {why}; {EXAMPLE}")


def _value(spec: str, of: Field[Any], text: str) -> Any:
    """One value, of the type of its default and inside its range."""
    default: Any = of.default
    unit, span = of.metadata["unit"], of.metadata.get("range")
    expected = of.metadata["title"]
    if span:
        expected += f", {span[0]:g}..{span[1]:g} {unit}".removesuffix(" 1")
    try:
        value = type(default)(text)
    except ValueError:
        raise _bad(spec, f"{of.name}='{text}' cannot be read; expected {expected}") from None
    if span and not span[0] <= value <= span[1]:
        raise _bad(spec, f"{of.name}={text} is out of range; expected {expected}")
    return value


def _duty(spec: str, text: str) -> Duty:
    ramp = ".." in text
    try:
        levels = tuple(float(part) for part in text.split(".." if ramp else "|"))
    except ValueError:
        raise _bad(
            spec, f"duty='{text}' is neither a number, nor levels 0.1|0.3, nor a ramp 0..0.4"
        ) from None
    for level in levels:
        if not 0 <= level <= 1:
            raise _bad(spec, f"duty {level:g} is outside 0..1 (a fraction: 30 % is 0.3)")
    if ramp and len(levels) != 2:
        raise _bad(spec, f"duty='{text}': a ramp has two ends, as in 0..0.4")
    return Duty(levels, ramp)
