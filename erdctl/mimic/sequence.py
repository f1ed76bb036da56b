"""What goes to the four amplifiers: the plan of each damper with a fault, healthy control else."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from erdctl.core.errors import UsageProblem
from erdctl.core.messages import counted
from erdctl.core.progress import part_of
from erdctl.core.recording import Array, Recording
from erdctl.core.signals import Signals
from erdctl.mimic.check import Breach, Extremes, breaches, check_limits, place
from erdctl.mimic.hold import follow
from erdctl.mimic.outcome import Flags, Plan
from erdctl.mimic.plan import mimic
from erdctl.model.amplifier import Amplifier
from erdctl.model.divergence import refuse_diverged
from erdctl.model.faults import Corner, Fault, on_channel, without_effect
from erdctl.model.parameters import Parameters

CHANNELS = tuple(c.value for c in Corner)


@dataclass(frozen=True, eq=False)
class PwmSequence:
    """What goes to the four amplifiers, and the plans of the dampers that mimic a fault.

    healthy : (n,) healthy duty as the amplifiers carry it out;  duties : (n,) for each of CHANNELS
    plans : for the channels with a fault, at least one
    static : the paper's inverse was chosen in place of the compensated sequence
    strained : where the healthy duty as given breaks the amplifier's limits
    extremes : how near each channel comes to the limits, all of which have been checked
    """

    recording: Recording
    healthy: Array
    duties: Mapping[str, Array]
    plans: Mapping[str, Plan]
    static: bool
    strained: tuple[Breach, ...]
    extremes: Mapping[str, Extremes]

    @property
    def returning(self) -> dict[str, Flags]:
        """(n,) samples of each faulty channel at which it is on its way back to the healthy duty.

        No fault acts there any more, but the amplifier is not yet where it was.
        """
        return {c: ~p.acting & (self.duties[c] != self.healthy) for c, p in self.plans.items()}

    @property
    def limited(self) -> dict[str, float]:
        """Part of the samples at which what is sent is held back by the highest duty."""
        return {c: p.limited_paper if self.static else p.limited for c, p in self.plans.items()}

    def columns(self) -> dict[str, Array]:
        """Columns for the log's own motion; `duty` and forces are the first faulty damper's."""
        channel, plan = next(iter(self.plans.items()))
        return {
            "duty": self.duties[channel],
            **{f"duty_{channel}": self.duties[channel] for channel in CHANNELS},
            "duty_healthy": self.recording.duty,
            "out_of_reach": plan.out_of_reach.astype(np.float64),
            "force_ideal": plan.ideal,
            "force_expected": plan.expected_paper if self.static else plan.expected,
        }


def sequence(
    parameters: Parameters,
    recording: Recording,
    faults: Sequence[Fault],
    amplifier: Amplifier,
    *,
    static: bool = False,
    progress: Callable[[str, str], None] = lambda stage, what: None,
) -> PwmSequence:
    """The sequences of all dampers over a recording's motion; its duty is the healthy control.

    static : send the paper's static inverse, Eqs. 27, 31, 35

    Where no fault acts, a channel has the healthy duty as the amplifier carries it out: as given,
    where that keeps the limits. Raises ComputationProblem if any duty did not.
    """
    by_channel = {c.value: on_channel(faults, c) for c in Corner}
    plans = {}
    faulty = [channel for channel, chosen in by_channel.items() if chosen]
    for channel, chosen in by_channel.items():
        if chosen:
            number = faulty.index(channel) + 1
            progress("computing", part_of(f"the sequence of {channel}", number, len(faulty)))
            plan = plans[channel] = mimic(parameters, recording, chosen, amplifier)
            for force in (plan.ideal, plan.expected_paper if static else plan.expected):
                refuse_diverged(force, parameters.model, parameters.values, recording)
    healthy = follow(recording.duty, Signals.of(recording), amplifier)
    duties = dict.fromkeys(by_channel, healthy)
    duties |= {c: p.duty_paper if static else p.duty for c, p in plans.items()}
    given = breaches(recording.duty, recording.t, recording.starts, amplifier)
    extremes = check_limits(duties, recording, amplifier)
    return PwmSequence(recording, healthy, duties, plans, static, tuple(given), extremes)


def at_duty(recording: Recording, duty: float | None, name: str = "the healthy duty") -> Recording:
    """The recording with one healthy duty in place of its own; as it is for None.

    Raises UsageProblem for what is no fraction; `name` is what the user calls it.
    """
    if duty is None:
        return recording
    if not 0.0 <= duty <= 1.0:
        raise UsageProblem(f"{name} is a fraction from 0 to 1, not {duty:g}")
    return replace(recording, duty=recording.duty * 0.0 + duty)


def too_hot(recording: Recording, limit: float) -> str | None:
    """What to say of a log in which the damper got hotter than `limit` [degC] (Sec. 5.4)."""
    if recording.temperature is None:
        return None
    hottest = float(recording.temperature.max())
    if hottest <= limit:
        return None
    return f"the damper reached {hottest:.1f} degC in this log, above the limit of {limit:g} degC"


def worth(sequence: PwmSequence) -> list[str]:
    """What the effects of a corrected model are worth for each damper, in words."""
    out = []
    for channel, plan in sequence.plans.items():
        c = plan.correction
        if c is None:
            continue
        figures = f"NRMSE {c.nrmse:.4f}, with the paper's parameters alone {c.plain:.4f}"
        if c.effects and sequence.static:
            out.append(
                f"{channel}: {', '.join(c.effects)} act in the expected force; the static inverse"
                " is sent as it is, without the iteration by the corrected model"
            )
        elif c.effects and c.fell_back:
            out.append(
                f"{channel}: no sequence from {', '.join(c.effects)} comes nearer to the faulty"
                " force than that of the paper's parameters alone, which is written:"
                f" {figures}"
            )
        elif c.effects:
            out.append(
                f"{channel}: computed with {', '.join(c.effects)}, all faults: {figures}, both"
                f" replayed through the corrected model: {100 * c.removed:.0f} % of the error"
                " removed"
            )
        if c.left_out:
            out.append(
                f"{channel}: {', '.join(c.left_out)}: of the force channel, not of the damper, so"
                " no part of the sequence and its figures; force_ideal and force_expected carry it"
                " as a log would"
            )
    return out


def strain(sequence: PwmSequence) -> list[str]:
    """What of the healthy duty as given the amplifier cannot carry out, in words."""
    changed = int(np.count_nonzero(sequence.healthy != sequence.recording.duty))
    if not changed:
        return []
    broken = "; ".join(
        f"{b} ({counted(b.count, 'time')}, first at {place(b, sequence.recording)})"
        for b in sequence.strained
    )
    return [
        f"the healthy duty breaks the amplifier's limits: {broken or 'by rounding'}; what is sent"
        f" keeps them, and differs from it in {changed} of"
        f" {counted(len(sequence.healthy), 'sample')}"
    ]


def way_back(sequence: PwmSequence) -> list[str]:
    """How long channels take to come back to the healthy duty, in words."""
    counts = {c: int(np.count_nonzero(at)) for c, at in sequence.returning.items()}
    return [
        f"{c}: in {counted(n, 'sample')} after a fault's end the amplifier is on its way back to"
        " the healthy duty"
        for c, n in counts.items()
        if n
    ]


def held_back(sequence: PwmSequence) -> list[str]:
    """Where the amplifier, not the physics, limits a sequence, in words."""
    return [
        f"{channel}: at {100 * part:.2g} % of the samples the highest duty gives too small a force"
        for channel, part in sequence.limited.items()
        if part
    ]


def idle(sequence: PwmSequence) -> list[str]:
    """Faults that nobody will see in what is sent, in words."""
    t = sequence.recording.t
    first, last = float(t.min()), float(t.max())
    return [
        f"{channel}: {without_effect(fault, first, last)}: the sequence is as without it"
        for channel, plan in sequence.plans.items()
        for fault in plan.idle
    ]
