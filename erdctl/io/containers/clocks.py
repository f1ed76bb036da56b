"""Which channel of a group is its time.

One called t or time, in any case of letters, may be it, and a temperature is called T as well. A
unit of something else says that it is none, a unit of time and the spellings `t` and `time` that it
is. Without either it is the time only if its values grow. What is then still open is not guessed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.io.containers.channels import TIME, Channel, ChannelGroup, Samples
from erdctl.io.named import suits
from erdctl.io.spelling import stated
from erdctl.io.stored import from_stored, stored_unit

CLOCKS = (TIME, "time")
_GROWING = 0.9  # of the steps of a time, which begins anew with each record


@dataclass(frozen=True, eq=False)
class Choice:
    """The time of some channels.

    sure : its name or unit says that it is one, not its values alone
    others : names of those that could be it just as well;  doubt : of all, where none is chosen
    """

    clock: Channel | None = None
    sure: bool = False
    others: tuple[str, ...] = ()
    doubt: tuple[str, ...] = ()


def is_called_clock(channel: Channel) -> bool:
    """Whether its name, without a unit, is t or time in any case of letters."""
    return _name(channel).casefold() in CLOCKS


def clock_of(channels: Sequence[Channel]) -> Choice:
    """The channel that is the time of the others. Samples are read only where names do not tell."""
    named = [c for c in channels if is_called_clock(c)]
    able = [c for c in named if (unit := _unit(c)) is None or suits(unit, TIME)]
    # With a wrong unit on the only time there is, the unit is what has to be said.
    able = able or [c for c in named if _name(c) in CLOCKS]
    sure = [c for c in able if _name(c) in CLOCKS or _unit(c) is not None]
    if len(sure) == 1:
        return Choice(sure[0], sure=True)
    grown = [c for c in sure or able if _grows(c.load().values)]
    if not grown:
        return Choice(min(sure, key=_rank), sure=True) if sure else Choice()
    first = min(map(_rank, grown))
    best = [c for c in grown if _rank(c) == first]
    if len(best) > 1:
        return Choice(doubt=tuple(c.name for c in best))
    return Choice(best[0], bool(sure), tuple(c.name for c in grown if c is not best[0]))


def with_clock(
    name: str, channels: Sequence[Channel], file: str, *, record: bool = False
) -> ChannelGroup:
    """A group whose channels take their time from the one that is their clock, if there is one.

    Channels that have a time of their own keep it.
    """
    choice = clock_of(channels)
    clock = choice.clock
    if clock is None or not (choice.sure or any(not c.timed for c in channels if c is not clock)):
        untimed = [_doubted(c, choice.doubt) if choice.doubt else c for c in channels]
        return ChannelGroup(name, tuple(untimed), record=record)
    unit = _unit(clock)

    @cache
    def seconds() -> Array:
        values = clock.load().values
        if values.dtype.kind == "m":
            return np.asarray(values / np.timedelta64(1, "ns") * 1e-9, np.float64)
        if values.dtype.kind not in "iuf":
            raise InputProblem(
                "expected numbers to be the time; points of time must be exported as seconds from"
                " the first one",
                file=file,
                column=clock.name,
            )
        convert = from_stored(unit or "s", TIME, clock.name, file)
        return convert(np.asarray(values, np.float64))

    def under(channel: Channel) -> Channel:
        def load() -> Samples:
            own = channel.load()
            return own if own.time is not None else replace(own, time=seconds())

        return replace(channel, load=load, timed=True)

    note = f"the time is taken from '{clock.name}', and not from {' or '.join(choice.others)}"
    return ChannelGroup(
        name,
        tuple(under(c) for c in channels if c is not clock),
        clock=clock.name,
        clock_unit=unit,
        record=record,
        notes=(note,) if choice.others else (),
    )


def _doubted(channel: Channel, names: Sequence[str]) -> Channel:
    """The channel with the reason why it has no time."""
    both = " and ".join(f"'{n}'" for n in names)
    why = f'{both} may each be its time; say which: --map "t={names[0]}[s]"'

    def load() -> Samples:
        own = channel.load()
        return own if own.time is not None else replace(own, why=why)

    return replace(channel, load=load)


def _name(channel: Channel) -> str:
    return stated(channel.name)[0].strip()


def _unit(channel: Channel) -> str | None:
    return stored_unit(channel.unit) or stored_unit(stated(channel.name)[1])


def _rank(channel: Channel) -> int:
    """The contract's own name before others, as in text files; then what states its unit."""
    name = _name(channel)
    return CLOCKS.index(name) if name in CLOCKS else 2 if _unit(channel) is not None else 3


def _grows(values: npt.NDArray[Any]) -> bool:
    values = np.asarray(values)
    if values.ndim != 1 or values.dtype.kind not in "iufmM":
        return False
    if values.dtype.kind in "iuf":
        values = values.astype(np.float64)
    steps = np.diff(values)
    return not steps.size or float(np.mean(steps > np.zeros((), steps.dtype))) >= _GROWING
