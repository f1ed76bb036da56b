"""Drives described in a line instead of a log: `sine:freq=1,amp=0.01,duty=0.1|0.3,hold=2`.

    KIND:key=value,key=value,...

A drive is the input of a simulation: deflection, its velocity in closed form (a differentiated
deflection has the wrong sign at some reversals) and duty cycle, one record for each drive.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import Field, dataclass, field, fields
from enum import Enum
from typing import Any, Protocol

import numpy as np

from erdctl.errors import UsageProblem
from erdctl.recording import Array, Recording, concatenate

EXAMPLE = "write for instance sine:freq=1,amp=0.01,duty=0.1|0.3,hold=2,duration=10"
# Samples of one drive; more would hardly fit into the memory of a desktop.
MOST_SAMPLES = 50_000_000
TONES = 64


class Progress(Enum):
    """How the frequency of a sweep grows with time."""

    LINEAR = "linear"
    LOG = "log"


class Motion(Protocol):
    """A motion about x = 0: a frozen dataclass whose fields are the keys of its kind."""

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        """x [m] and xdot [m/s] at t [s], each (n,)."""

    @property
    def fastest(self) -> float:
        """Highest frequency that the sampling must resolve [Hz]."""


def _key(default: Any, unit: str, low: float, high: float, title: str) -> Any:
    """A key of a drive: default, unit, inclusive range and meaning."""
    return field(default=default, metadata={"unit": unit, "range": (low, high), "title": title})


@dataclass(frozen=True, kw_only=True)
class Sine:
    """x = amp sin(2 pi freq t).  Check: 1 Hz, 10 mm begins with 2 pi 0.01 = 0.0628 m/s."""

    freq: float = _key(1.0, "Hz", 1e-4, 1e4, "frequency")
    amp: float = _key(0.01, "m", 0.0, 1.0, "amplitude")

    @property
    def fastest(self) -> float:
        return self.freq

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        w = 2 * math.pi * self.freq
        return self.amp * np.sin(w * t), self.amp * w * np.cos(w * t)


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """x = amp sin(phi), dphi/dt = 2 pi f, f from f0 at the start to f1 at the end of the drive.

    linear:  f = f0 + (f1 - f0) t / T,  phi = 2 pi (f0 t + (f1 - f0) t^2 / (2 T))
    log:     f = f0 r^(t/T),  r = f1 / f0,  phi = 2 pi f0 T (r^(t/T) - 1) / ln r
    Check: linear, 1 to 3 Hz in T = 2 s: f = 2 Hz and phi = 2 pi 1.5 at t = 1 s.
    """

    f0: float = _key(0.1, "Hz", 1e-4, 1e4, "first frequency")
    f1: float = _key(10.0, "Hz", 1e-4, 1e4, "last frequency")
    amp: float = _key(0.002, "m", 0.0, 1.0, "amplitude")
    scale: Progress = field(
        default=Progress.LINEAR, metadata={"unit": "1", "title": "linear or log"}
    )

    @property
    def fastest(self) -> float:
        return max(self.f0, self.f1)

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        part = t / duration
        log_ratio = math.log(self.f1 / self.f0)
        if self.scale is Progress.LOG and log_ratio != 0.0:
            # Not exp() - 1, which loses all digits as f1 approaches f0.
            cycles = self.f0 * duration * np.expm1(log_ratio * part) / log_ratio
            f = self.f0 * np.exp(log_ratio * part)
        else:
            cycles = (self.f0 + (self.f1 - self.f0) * part / 2) * t
            f = self.f0 + (self.f1 - self.f0) * part
        phase = 2 * math.pi * cycles
        return self.amp * np.sin(phase), self.amp * 2 * math.pi * f * np.cos(phase)


@dataclass(frozen=True, kw_only=True)
class Triangle:
    """Constant speed between -amp and amp, from x = 0 in compression; period 4 amp / speed.

    Check: 0.1 m/s, 10 mm: x = 10 mm at 0.1 s, 0 at 0.2 s, -10 mm at 0.3 s.
    """

    speed: float = _key(0.05, "m/s", 1e-6, 10.0, "speed")
    amp: float = _key(0.01, "m", 1e-6, 1.0, "amplitude")

    @property
    def fastest(self) -> float:
        return self.speed / (4 * self.amp)

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        path = np.mod(self.speed * t / self.amp + 1.0, 4.0)
        return self.amp * (1.0 - np.abs(path - 2.0)), np.where(path < 2.0, self.speed, -self.speed)


@dataclass(frozen=True, kw_only=True)
class Bumps:
    """A sequence of sinusoidal bumps in compression, at rest between them (Fig. 19).

        x = amp sin^2(pi u / width),  u = t mod every < width, else 0

    Check: 10 mm, 0.5 s: x = 10 mm at 0.25 s; fastest pi 0.01 / 0.5 = 0.0628 m/s at 0.125 s.
    """

    amp: float = _key(0.01, "m", 0.0, 1.0, "height")
    width: float = _key(0.5, "s", 1e-4, 1e4, "time over one bump")
    every: float = _key(1.0, "s", 1e-4, 1e4, "time from bump to bump, at least width")

    def __post_init__(self) -> None:
        if self.every < self.width:
            raise ValueError(f"every={self.every:g} s is shorter than width={self.width:g} s")

    @property
    def fastest(self) -> float:
        return 1.0 / self.width

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        u = np.mod(t, self.every)
        w = math.pi / self.width
        on = u < self.width
        x = np.where(on, self.amp * np.sin(w * u) ** 2, 0.0)
        return x, np.where(on, self.amp * w * np.sin(2 * w * u), 0.0)


@dataclass(frozen=True, kw_only=True)
class Hold:
    """The piston stands still at `offset`: x = 0, xdot = 0."""

    @property
    def fastest(self) -> float:
        return 0.0

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        return np.zeros_like(t), np.zeros_like(t)


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Random motion with a flat spectrum up to f_max: 64 tones, one at random in each equal band.

        x = rms sqrt(2 / N) sum_k sin(2 pi f_k t + p_k),  N = 64, f_k = f_max (k + u_k) / N

    u_k, p_k uniform from `seed`; |x| <= rms sqrt(2 N) = 11.3 rms; xdot about 2 pi f_max rms /
    sqrt(3) rms.  Check: rms 1 mm, 10 Hz gives about 36 mm/s rms.
    """

    rms: float = _key(0.002, "m", 0.0, 1.0, "effective value of x over a long time")
    f_max: float = _key(5.0, "Hz", 1e-4, 1e4, "highest frequency")
    seed: int = _key(0, "1", 0, 2**31 - 1, "seed of the random tones")

    @property
    def fastest(self) -> float:
        return self.f_max

    def __call__(self, t: Array, duration: float) -> tuple[Array, Array]:
        random = np.random.default_rng(self.seed)
        w = 2 * math.pi * self.f_max * (np.arange(TONES) + random.random(TONES)) / TONES
        phase = 2 * math.pi * random.random(TONES)
        amp = self.rms * math.sqrt(2 / TONES)
        x, xdot = np.zeros_like(t), np.zeros_like(t)
        for w_k, p_k in zip(w.tolist(), phase.tolist(), strict=True):
            x += amp * np.sin(w_k * t + p_k)
            xdot += amp * w_k * np.cos(w_k * t + p_k)
        return x, xdot


KINDS: dict[str, type[Motion]] = {
    shape.__name__.lower(): shape for shape in (Sine, Sweep, Triangle, Bumps, Hold, Noise)
}


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

    motion: Motion
    duty: Duty = field(default=Duty())
    hold: float = _key(0.5, "s", 1e-4, 1e6, "time at each level of duty")
    duration: float = _key(10.0, "s", 1e-4, 1e6, "length of the record")
    fs: float = _key(1000.0, "Hz", 0.1, 1e6, "sampling rate")
    offset: float = _key(0.0, "m", -1.0, 1.0, "deflection about which the piston moves")

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
    """
    name, _, body = (part.strip() for part in spec.partition(":"))
    if name not in KINDS:
        raise _bad(spec, f"unknown kind '{name}', known are {', '.join(KINDS)}")
    own = {f.name: f for f in _keys(KINDS[name])}
    common = {f.name: f for f in _keys(Drive)}
    values: dict[str, Any] = {}
    for part in body.split(",") if body else []:
        key, equals, text = (piece.strip() for piece in part.partition("="))
        if not equals:
            raise _bad(spec, f"'{part.strip()}' is not key=value")
        if key in values:
            raise _bad(spec, f"'{key}' is given twice")
        if key == "duty":
            values[key] = _duty(spec, text)
        elif key in own or key in common:
            values[key] = _value(spec, own.get(key) or common[key], text)
        else:
            allowed = ", ".join([*own, *common, "duty"])
            raise _bad(spec, f"unknown key '{key}', allowed with {name} are {allowed}")
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


def _value(spec: str, key: Field[Any], text: str) -> Any:
    """One value, of the type of its default and inside its range."""
    default: Any = key.default
    unit, span = key.metadata["unit"], key.metadata.get("range")
    expected = key.metadata["title"]
    if span:
        expected += f", {span[0]:g}..{span[1]:g} {unit}".removesuffix(" 1")
    try:
        value = type(default)(text)
    except ValueError:
        raise _bad(spec, f"{key.name}='{text}' cannot be read; expected {expected}") from None
    if span and not span[0] <= value <= span[1]:
        raise _bad(spec, f"{key.name}={text} is out of range; expected {expected}")
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
