"""What a log must satisfy before anything is computed from it.

Every check has a fast form that passes a sound log in a few milliseconds for ten million rows
(no temporaries as long as the log); the row at fault is looked for only when that fails.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Index

LARGEST = 1e12  # in any unit of the contract; more is a bit pattern, not a measurement
_BLOCK = 1 << 16


@dataclass(frozen=True)
class Place:
    """Where samples stand.

    file : name for messages;  row_of : row of a sample counted from 0
    """

    file: str
    row_of: Callable[[int], int]

    def problem(self, message: str, sample: int | None, column: str | None = None) -> InputProblem:
        """The error to raise for a sample."""
        row = None if sample is None else self.row_of(sample)
        return InputProblem(message, file=self.file, row=row, column=column)


@dataclass(frozen=True)
class Limits:
    """Values that a column may have, and what to do about others.

    low, high : inclusive;  hints : (above which magnitude, hint), largest magnitude first
    """

    low: float
    high: float
    expected: str
    hints: tuple[tuple[float, str], ...] = ()


LIMITS = {
    "x": Limits(
        -1.0,
        1.0,
        "a deflection within ±1 m",
        ((1.0, 'for millimetres give --map "x={column}[mm]"'),),
    ),
    "duty": Limits(
        0.0,
        1.0,
        "a fraction 0..1",
        (
            (100.0, "it is no PWM duty cycle"),
            (1.05, 'for percent give --map "duty={column}[percent]"'),
            (0.0, "if this is measurement noise, clip it first"),
        ),
    ),
    "temperature": Limits(
        -100.0,
        200.0,
        "°C between -100 and 200",
        ((200.0, 'for kelvin give --map "temperature={column}[K]", for °F [degF]'),),
    ),
}


def check_values(name: str, values: Array, place: Place, *, source: str) -> None:
    """Raise InputProblem at the first value that is not finite, absurd, or outside LIMITS.

    values : (n,) in SI, n > 0;  source : the log's own name of the column
    """
    # NaN propagates through min and max, so these two passes see everything.
    low, high = float(values.min()), float(values.max())
    limits = LIMITS.get(name, Limits(-LARGEST, LARGEST, "a number below 1e12"))
    if limits.low <= low and high <= limits.high:
        return
    finite = np.isfinite(values)
    if not finite.all():
        at = int(finite.argmin())
        raise place.problem(
            f"found {values[at]:g}, expected a number; remove the rows without a value, or fill"
            " them in",
            at,
            source,
        )
    at = int(((values < limits.low) | (values > limits.high)).argmax())
    worst = max(abs(low), abs(high))
    hint = next((h for above, h in limits.hints if worst > above), None)
    after = "" if hint is None else "; " + hint.format(column=source)
    raise place.problem(f"found {values[at]:g}, expected {limits.expected}{after}", at, source)


def check_time(
    t: Array,
    starts: Index,
    names: Sequence[str] | None,
    place: Place,
    *,
    source: str,
    narrow: bool,
) -> None:
    """Raise InputProblem where t does not grow within a record, or a record has one sample.

    names : of the records, None if the log does not tell records apart
    source : the log's own name of t;  narrow : t was stored as 32-bit floats
    """
    check_lengths(starts, names, place)
    check_growth(t, starts, names, place, source=source, narrow=narrow)


def check_lengths(starts: Index, names: Sequence[str] | None, place: Place) -> None:
    """Raise InputProblem for a record of one sample; see `check_time`."""
    lengths = np.diff(starts)
    if lengths.min() < 2:
        record = int(lengths.argmin())
        of = f" '{names[record]}'" if names else ""
        raise place.problem(
            f"record{of} has a single sample; a record needs at least two", int(starts[record])
        )


def check_growth(
    t: Array,
    starts: Index,
    names: Sequence[str] | None,
    place: Place,
    *,
    source: str,
    narrow: bool,
) -> None:
    """Raise InputProblem where t does not grow within a record; see `check_time`."""
    for begin in range(0, t.size - 1, _BLOCK):
        end = min(begin + _BLOCK, t.size - 1)
        grows = t[begin + 1 : end + 1] > t[begin:end]
        if grows.all():
            continue
        falls = np.flatnonzero(~grows) + begin + 1
        # Not np.isin, which imports masked arrays: as many starts lie up to a fall as before it.
        last, before = (np.searchsorted(starts, falls, side) for side in ("right", "left"))
        falls = falls[last == before]
        if falls.size:
            raise _time_problem(t, int(falls[0]), names, place, source=source, narrow=narrow)


def _time_problem(
    t: Array, at: int, names: Sequence[str] | None, place: Place, *, source: str, narrow: bool
) -> InputProblem:
    before, now = float(t[at - 1]), float(t[at])
    if now == before:
        found, hint = f"{now:.9g} s is there twice", "remove the duplicated row"
        if narrow:
            hint = "t is stored as 32-bit floats, too coarse for this log; store it as float64"
    else:
        found, hint = f"falls from {before:.9g} s to {now:.9g} s", "sort the rows by time"
        if names is None:
            hint = "if a new test begins here, add a column 'record' that names the tests"
    where = "" if names is None else " within a record"
    return place.problem(f"time must grow{where}, but {found}; {hint}", at, source)


def remark_on_time(t: Array, starts: Index) -> str | None:
    """A remark if t is likely not in seconds: fewer than two samples a second."""
    first = slice(int(starts[0]), int(starts[1]))
    step = float(t[first][-1] - t[first][0]) / (int(starts[1]) - 1)
    if step <= 0.5:
        return None
    return f't has a step of {step:.4g} s; if it is in milliseconds, give --map "t=t[ms]"'
