"""What is about to be written, held against the limits that go with it.

The duties are judged as whoever replays the file sees them: by their values and times alone. This
shares no code with what computes them, so that a mistake there cannot hide here.

    0 <= v <= duty_max,   v = k resolution,   t_j - t_i >= 1 / update_rate
    |v_j - v_i| <= slew (t_j - t_i)
    |v_j - v_i| <= slew (t_j - t_p)   unless it is one step of the resolution

i and j are samples of one change and the next (the start of a record counts as one). p is the last
sample at least 1 / update_rate before j, without a rate the one before j: after a long rest a value
may not leap either.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from erdctl.core.errors import ComputationProblem
from erdctl.core.recording import Array, Index, Recording
from erdctl.model.amplifier import Amplifier

ROUNDING = 1e-9  # of a duty, and part of a time
OFF_GRID = 1e-6  # of a step of the resolution


@dataclass(frozen=True)
class Breach:
    """The first duty beyond a limit.

    limit : which;  sample : from 0;  found, allowed : the value and its limit, in `unit`
    count : samples beyond this limit
    """

    limit: str
    sample: int
    found: float
    allowed: float
    unit: str
    count: int

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.limit}: {self.found:.9g}{unit}, where {self.allowed:.9g}{unit} is allowed"


@dataclass(frozen=True)
class Extremes:
    """How near a sequence comes to the limits.

    highest : duty [1];  changes : number of them
    closest : time between one change and the next [s];  steepest : change over the time since the
        previous one [1/s];  None without any change
    """

    highest: float
    changes: int
    closest: float | None
    steepest: float | None


def breaches(duty: Array, t: Array, starts: Index, amplifier: Amplifier) -> list[Breach]:
    """The first breach of each limit by a duty (n,).

    t, starts : (n,) [s], (r + 1,) offsets of the records
    Check: at 0, 1, 2 s the duties 0, 0.3, 0.3 change by 0.3 / s: more than a slew of 0.2 / s.
    >>> duty, t = np.array([0.0, 0.3, 0.3]), np.array([0.0, 1.0, 2.0])
    >>> [b.limit for b in breaches(duty, t, np.array([0, 3]), Amplifier(slew=0.2))]
    ['slew']
    """
    out: list[Breach] = []

    def broken(
        limit: str, at: Index, found: Array, allowed: Array, bad: npt.NDArray[np.bool_], unit: str
    ) -> None:
        where = np.flatnonzero(bad)
        if where.size:
            k = int(where[0])
            out.append(
                Breach(limit, int(at[k]), float(found[k]), float(allowed[k]), unit, where.size)
            )

    every = np.arange(len(duty))
    zero, top = np.zeros(len(duty)), np.full(len(duty), amplifier.duty_max)
    broken("duty", every, duty, zero, ~(duty >= 0.0), "")
    broken("highest duty", every, duty, top, ~(duty <= amplifier.duty_max + ROUNDING), "")
    step = amplifier.resolution
    if step:
        nearest = np.round(duty / step) * step
        bad = ~(np.abs(duty - nearest) <= OFF_GRID * step + ROUNDING * duty)
        broken("resolution", every, duty, nearest, bad, "")
    at, size, waited = changes(duty, t, starts)
    rounded = 4.0 * np.spacing(np.abs(t[at]))
    period = 0.0 if amplifier.update_rate is None else 1.0 / amplifier.update_rate
    bad = waited < period * (1.0 - ROUNDING) - rounded
    broken("time between updates", at, waited, np.full(len(at), period), bad, "s")
    slew = amplifier.slew
    if np.isfinite(slew):
        slack = ROUNDING + slew * rounded
        bad = size > slew * waited * (1.0 + ROUNDING) + slack
        broken("slew", at, size / waited, np.full(len(at), slew), bad, "1/s")
        if not bad.any():
            since = _since_possible(at, t, starts, period)
            bad = size > np.maximum(
                slew * since * (1.0 + ROUNDING) + slack, step * (1 + 3 * OFF_GRID)
            )
            broken("slew", at, size / since, np.full(len(at), slew), bad, "1/s")
    return out


def changes(duty: Array, t: Array, starts: Index) -> tuple[Index, Array, Array]:
    """Samples (k,) at which a duty changes within a record, by how much (k,), and after what time.

    The time (k,) [s] is that since the change before, or since the start of the record.
    """
    changed = np.concatenate([[False], duty[1:] != duty[:-1]])
    changed[starts[:-1]] = False
    event = changed.copy()
    event[starts[:-1]] = True
    at = np.flatnonzero(changed)
    events = np.flatnonzero(event)
    previous = events[np.cumsum(event)[at] - 2]
    return at, np.abs(duty[at] - duty[at - 1]), t[at] - t[previous]


def _since_possible(at: Index, t: Array, starts: Index, period: float) -> Array:
    """(k,) time since the last sample at least a period before each of `at` (k,) [s]."""
    if not period:
        return np.asarray(t[at] - t[at - 1])
    out = np.empty(len(at))
    for a, b in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True):
        low, high = np.searchsorted(at, [a, b])
        mine, part = at[low:high], t[a:b]
        slack = ROUNDING * period + 4.0 * np.spacing(np.abs(t[mine]))
        p = np.searchsorted(part, t[mine] - period + slack, side="right") - 1
        out[low:high] = t[mine] - part[np.minimum(np.maximum(p, 0), mine - a - 1)]
    return out


def extremes(duty: Array, t: Array, starts: Index) -> Extremes:
    """How near a duty (n,) at times t (n,) [s] comes to any limit; starts : (r + 1,)."""
    at, size, waited = changes(duty, t, starts)
    return Extremes(
        highest=float(duty.max()),
        changes=len(at),
        closest=float(waited.min()) if at.size else None,
        steepest=float((size / waited).max()) if at.size else None,
    )


def check_limits(
    duties: Mapping[str, Array], recording: Recording, amplifier: Amplifier
) -> dict[str, Extremes]:
    """How near the duties (n,) of each channel come to the limits, once all of them keep them.

    Raises ComputationProblem with channel, row, time, value and limit where one does not.
    """
    r, out = recording, {}
    seen: dict[int, Extremes] = {}
    for channel, duty in duties.items():
        if id(duty) in seen:  # healthy channels share one sequence
            out[channel] = seen[id(duty)]
            continue
        found = breaches(duty, r.t, r.starts, amplifier)
        if found:
            raise ComputationProblem(
                f"channel {channel}, {place(found[0], recording)}: {found[0]}; the sequence was not"
                " written, since the amplifier would not carry it out. This is an error of erdctl:"
                " please report it with the log and the options"
            )
        out[channel] = seen[id(duty)] = extremes(duty, r.t, r.starts)
    return out


def place(breach: Breach, recording: Recording) -> str:
    """Where a breach is, in words."""
    r = recording
    name = r.names[int(np.searchsorted(r.starts, breach.sample, side="right")) - 1]
    of = f" of record '{name}'" if len(r.names) > 1 else ""
    return f"data row {breach.sample + 1}{of} (t = {r.t[breach.sample]:.9g} s)"
