"""Errors of a rig, put into a good recording: what `erdctl.bench.rig` has to see, and where.

Written without a look at the checks: each is what goes wrong on a bench.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from erdctl.core.recording import Array, Index, Recording

Random = np.random.Generator
Spoil = Callable[[Recording, Random], Recording]


@dataclass(frozen=True)
class RigError:
    """One kind of error.

    spoil : puts it into a recording;  codes : any of which says what it is
    place : "log", "record" (the one that `chosen` gives) or "samples" (of it)
    """

    spoil: Spoil
    codes: frozenset[str]
    place: str


def chosen(r: Recording) -> int:
    """The record that is spoiled: the middle one."""
    return len(r.names) // 2


def _part(r: Recording) -> slice:
    return r.slices[chosen(r)]


def _with(r: Recording, **channels: Array) -> Recording:
    return replace(r, **channels)


def _step(r: Recording) -> float:
    part = _part(r)
    return float(np.median(np.diff(r.t[part])))


def _force(r: Recording) -> Array:
    assert r.force is not None
    return r.force.copy()


def _in_record(change: Callable[[Array, Recording, Random], Array]) -> Spoil:
    """Change the force of the chosen record."""

    def spoil(r: Recording, random: Random) -> Recording:
        force = _force(r)
        force[_part(r)] = change(force[_part(r)], r, random)
        return _with(r, force=force)

    return spoil


def _noise_of(force: Array) -> float:
    return float(np.std(np.diff(force, 3))) / 20.0**0.5


def _clipped(r: Recording, random: Random) -> Recording:
    force = _force(r)
    low, high = np.quantile(force, [0.04, 0.96])
    return _with(r, force=np.clip(force, low, high))


def _x_clipped(r: Recording, random: Random) -> Recording:
    high = 0.8 * float(r.x.max())
    return _with(r, x=np.minimum(r.x, high))


def _window(r: Recording, seconds: float) -> slice:
    """So long a stretch from the middle of the chosen record."""
    part = _part(r)
    middle = (part.start + part.stop) // 2
    half = max(10, round(0.5 * seconds / _step(r)))
    return slice(max(middle - half, part.start), min(middle + half, part.stop))


def _cycle(r: Recording) -> float:
    part = _part(r)
    return 2 * np.pi * float(np.std(r.x[part]) / np.std(r.xdot[part]))


def _force_frozen(r: Recording, random: Random) -> Recording:
    force, at = _force(r), _window(r, 0.8 * _cycle(r))
    force[at] = force[at.start]
    return _with(r, force=force)


def _x_frozen(r: Recording, random: Random) -> Recording:
    x, at = r.x.copy(), _window(r, 0.4 * _cycle(r))
    x[at] = x[at.start]
    return _with(r, x=x)


def _spikes(r: Recording, random: Random) -> Recording:
    force, part = _force(r), _part(r)
    fast = np.flatnonzero(np.abs(r.xdot[part]) > 0.5 * np.abs(r.xdot[part]).max()) + part.start
    at = random.choice(fast, 6, replace=False)
    force[at] += np.ptp(force) * random.choice([-1, 1], 6) * random.uniform(0.3, 0.8, 6)
    return _with(r, force=force)


def _x_spikes(r: Recording, random: Random) -> Recording:
    x, part = r.x.copy(), _part(r)
    at = random.integers(part.start + 30, part.stop - 30, 5)
    x[at] += np.ptp(r.x) * random.choice([-1, 1], 5) * random.uniform(0.1, 0.3, 5)
    return _with(r, x=x)


def _burst(r: Recording, random: Random) -> Recording:
    force = _force(r)
    at = _window(r, max(0.4, 200 * _step(r)))
    level = max(10.0 * _noise_of(force[_part(r)]), 0.05 * float(np.ptp(force)))
    force[at] += random.normal(0.0, level, at.stop - at.start)
    return _with(r, force=force)


def _without(r: Recording, first: int, count: int, *, retimed: bool) -> Recording:
    keep = np.ones(len(r), dtype=bool)
    keep[first : first + count] = False
    part = _part(r)
    t = r.t.copy()
    if retimed:
        t[first + count : part.stop] -= t[first + count] - t[first]
    rows = np.flatnonzero(keep)
    cut = replace(r, t=t)
    return cut.take(rows, np.searchsorted(rows, r.starts), r.names)


def _fastest(r: Recording) -> int:
    """A sample of the chosen record at high speed, away from its ends."""
    part = _part(r)
    inner = slice(
        part.start + (part.stop - part.start) // 4, part.stop - (part.stop - part.start) // 4
    )
    return inner.start + int(np.argmax(np.abs(r.xdot[inner])))


def _gap(r: Recording, random: Random) -> Recording:
    return _without(r, _fastest(r) - 3, max(8, round(0.01 / _step(r))), retimed=False)


def _lost(r: Recording, random: Random) -> Recording:
    count = max(8, round(0.03 * _cycle(r) / _step(r)))
    return _without(r, _fastest(r) - count // 2, count, retimed=True)


def _lag(r: Recording, random: Random) -> Recording:
    force, part = _force(r), _part(r)
    k = max(4, round(max(0.012, 0.03 * _cycle(r)) / _step(r)))
    late = np.concatenate([np.full(k, force[part.start]), force[part][:-k]])
    force[part] = late
    return _with(r, force=force)


def _noisier(force: Array, r: Recording, random: Random) -> Array:
    level = max(_noise_of(force), 1e-3 * float(np.ptp(force)))
    return force + random.normal(0.0, 5.0 * level, len(force))


def _velocity_noise(r: Recording, random: Random) -> Recording:
    speed = float(np.std(r.xdot))
    return replace(r, xdot=r.xdot + random.normal(0.0, 0.15 * speed, len(r)), xdot_note="measured")


def _velocity_lag(r: Recording, random: Random) -> Recording:
    xdot = r.xdot.copy()
    for part in r.slices:
        step = float(np.median(np.diff(r.t[part])))
        k = max(2, round(0.012 / step))
        xdot[part] = np.concatenate([np.full(k, xdot[part.start]), xdot[part][:-k]])
    return replace(r, xdot=xdot, xdot_note="measured")


def _velocity_zero(r: Recording, random: Random) -> Recording:
    return replace(r, xdot=r.xdot + 0.02 * float(np.std(r.xdot)), xdot_note="measured")


def _everywhere(**factors: float) -> Spoil:
    def spoil(r: Recording, random: Random) -> Recording:
        return _with(r, **{name: f * getattr(r, name) for name, f in factors.items()})

    return spoil


def _slow(r: Recording, random: Random) -> Recording:
    return _with(r, t=1e3 * r.t, xdot=r.xdot / 1e3)


def _inverted(r: Recording, random: Random) -> Recording:
    return _with(r, duty=r.duty.max() - r.duty)


def _mislabelled(r: Recording, random: Random) -> Recording:
    """With the least duty that is held in another record."""
    duty, part = r.duty.copy(), _part(r)
    duty[part] = min(duty[other].max() for other in r.slices if np.ptp(duty[other]) == 0.0)
    return _with(r, duty=duty)


def held(values: Array, over: float, starts: Index | None = None) -> Array:
    """Values (n,) that are read once in so many samples, from the first of each record on."""
    out = values.copy()
    for a, b in pairwise([0, len(values)] if starts is None else starts.tolist()):
        read = np.ceil(np.arange(np.ceil((b - a) / over)) * over - 1e-9).astype(int)
        out[a:b] = values[a:b][read[np.searchsorted(read, np.arange(b - a), side="right") - 1]]
    return out


def _x_held(r: Recording, random: Random) -> Recording:
    return _with(r, x=held(r.x, 5.0, r.starts))


def _force_held(r: Recording, random: Random) -> Recording:
    return _with(r, force=held(_force(r), 5.0, r.starts))


def _error(spoil: Spoil, codes: str, place: str) -> RigError:
    return RigError(spoil, frozenset(codes.split()), place)


ERRORS = {
    "force reversed": _error(_everywhere(force=-1.0), "force_sign", "log"),
    "force reversed in one record": _error(_in_record(lambda f, r, _: -f), "force_sign", "record"),
    "x and xdot reversed": _error(_everywhere(x=-1.0, xdot=-1.0), "force_sign", "log"),
    "speed a hundred times too high": _error(_everywhere(x=100.0, xdot=100.0), "speed_unit", "log"),
    "x in m taken for mm": _error(_everywhere(x=1e-3, xdot=1e-3), "stroke_unit", "log"),
    "t in ms taken for s": _error(_slow, "time_unit", "log"),
    "force in kN taken for N": _error(_everywhere(force=1e-3), "force_unit", "log"),
    "one record in kN": _error(_in_record(lambda f, r, _: 1e-3 * f), "record_gain", "record"),
    "one record in lbf": _error(_in_record(lambda f, r, _: f / 4.4482216), "record_gain", "record"),
    "duty in per cent within 0..1": _error(_everywhere(duty=0.01), "duty_unit", "log"),
    "force clipped": _error(_clipped, "force_clipped", "log"),
    "x clipped": _error(_x_clipped, "x_clipped", "log"),
    "force frozen": _error(_force_frozen, "force_frozen", "samples"),
    "x frozen": _error(_x_frozen, "x_frozen", "samples"),
    "spikes of force": _error(_spikes, "force_spikes", "samples"),
    "spikes of x": _error(_x_spikes, "x_spikes", "samples"),
    "a burst of noise": _error(_burst, "force_burst", "samples"),
    "samples dropped": _error(_gap, "samples_missing", "samples"),
    "samples dropped, time rewritten": _error(_lost, "x_jumps", "samples"),
    "one record with a gain": _error(_in_record(lambda f, r, _: 0.7 * f), "record_gain", "record"),
    "one record with an offset": _error(
        _in_record(lambda f, r, _: f + 0.2 * np.ptp(_force(r))), "record_offset", "record"
    ),
    "one record late": _error(_lag, "record_lag", "record"),
    "one record with five times the noise": _error(
        _in_record(_noisier),
        "record_noise", "record",
    ),
    "noise of the velocity channel": _error(_velocity_noise, "velocity_noise", "log"),
    "delay of the velocity channel": _error(_velocity_lag, "velocity_lag", "log"),
    "duty inverted": _error(_inverted, "duty_inverted", "log"),
    "one record with the duty of another": _error(
        _mislabelled, "record_duty record_gain", "record"
    ),
    "x held": _error(_x_held, "x_held", "log"),
    "force held": _error(_force_held, "force_held", "log"),
    "zero of the velocity channel": _error(_velocity_zero, "velocity_offset", "log"),
}  # fmt: skip
