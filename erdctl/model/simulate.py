"""Simulation of identified parameters over a recording, healthy or with faults."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from erdctl.core.blocks import LONGEST, neighbours
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.core.signals import Signals
from erdctl.core.stretches import Stretch, cut_at, stretches
from erdctl.model.composed import Model
from erdctl.model.divergence import Watch
from erdctl.model.faults import Fault, effectiveness, factors, parse_fault, without_effect
from erdctl.model.parameters import Parameters
from erdctl.model.slots import ScaleSlot, TermSlot, ViscousSlot

if TYPE_CHECKING:
    from erdctl.model.learned.curve import Curve

UNITS = {"x": " m", "xdot": " m/s", "duty": ""}
BEYOND = 0.05  # of a range: how far a drive may leave it before that is worth a remark


def simulate(
    parameters: Parameters,
    recording: Recording,
    faults: Sequence[str] = (),
    *,
    progress: Progress = lambda stage, what: None,
) -> Array:
    """(n,) modelled force [N]; `faults` as on the command line (Eqs. 20-23).

    Raises ComputationProblem where it diverged: nobody is to take such numbers for advice.
    """
    simulation = Simulation(parameters, faults)
    out = np.empty(len(recording))
    parts = stretches(recording, cut=simulation.cuts)
    for number, part in enumerate(parts, start=1):
        progress("simulating", part_of(f"{len(recording)} samples", number, len(parts)))
        out[part.first : part.first + len(part)] = simulation.force(part)
    simulation.finish()
    return out


class Simulation:
    """The modelled force over one stretch of a log after the other, as over all of it at once.

    States restart with each record, so a long log is computed in runs of records that fit into a
    processor's cache, which is twice as fast as all at once. A record longer than a stretch is
    computed in parts, if the only state is F_ER, which is carried from one to the next.
    What is known at a sample is of the past alone, as on a vehicle and in an exported block.
    """

    def __init__(self, parameters: Parameters, faults: Sequence[str] = ()) -> None:
        self.parameters = parameters
        self.faults = [parse_fault(f) for f in faults]
        self._model = parameters.model.past_alone()
        self.cuts = one_state(self._model)
        self._watch = Watch(self._model, parameters.values)
        self._state = 0.0
        self._since = 0.0  # s, at which the record began

    def force(self, stretch: Stretch) -> Array:
        """(n,) [N] of the samples of the next stretch."""
        if stretch.begun or stretch.ahead:
            if not self.cuts:
                raise ValueError("a part of a record has no force of its own in this model")
            out = self._of_part(stretch)
        else:
            runs = neighbours(stretch.recording)
            forces = [self._of_records(run) for run in runs]
            out = forces[0] if len(runs) == 1 else np.concatenate(forces)
        self._watch.add(out, stretch.own)
        return out

    def finish(self) -> None:
        """Raise ComputationProblem if the force diverged anywhere."""
        self._watch.refuse()

    def _of_records(self, recording: Recording) -> Array:
        signals = Signals.of(recording)
        prepared = self._model.prepare(signals, self.parameters.values)
        return prepared.force(self.parameters.values, self._factors(signals, self.faults))

    def _of_part(self, stretch: Stretch) -> Array:
        """The same for a part of a record, from the state that the part before has left."""
        r, values = stretch.recording, self.parameters.values
        if not stretch.begun:
            self._since = float(r.t[0])
        faults = [f if f.start is not None else replace(f, start=self._since) for f in self.faults]
        out = np.empty(len(stretch))
        a, begun = 0, stretch.begun
        while a < len(out):
            left = len(r) - a
            length = cut_at(r.xdot[a:], left, LONGEST)
            assert length is not None
            ahead = length < left
            part = r.window(slice(a, a + length + ahead), names=r.names)
            signals = Signals.of(part)
            if begun:
                signals = replace(signals, begun=np.array([self._state]))
            prepared = self._model.prepare(signals, values)
            bare = prepared.bare(values)
            force = prepared.total(bare, values, self._factors(signals, faults))
            # The piston moves at a cut, so that the sign that F_ER was given is 1 or -1.
            self._state = float(bare["yield"][-1] * signals.sign[-1])
            out[a : a + length] = force[: min(length, len(out) - a)]
            a, begun = a + length, True
        return out

    @staticmethod
    def _factors(signals: Signals, faults: Sequence[Fault]) -> dict[str, Array] | None:
        if not faults:
            return None
        found = factors(faults, signals.t, signals.xdot, signals.starts)
        return {"gas": found.gas, "viscous": found.viscous, "yield": found.yield_}


def one_state(model: Model) -> bool:
    """Whether F_ER is all that a model remembers of the samples before.

    Every effect then depends on the speed of a sample alone, and leaves Eq. 12 as it is.
    """
    kinds = (ViscousSlot, ScaleSlot, TermSlot)
    return all(e.of_speed and isinstance(e.slot, kinds) for e in model.effects)


def without_lag(parameters: Parameters) -> Parameters:
    """The static model of Eq. 9: the same parameters with T_d = 0."""
    lags = [f"{d}.T_d" for d in DIRECTIONS]
    still = {name: replace(parameters.estimates[name], value=0.0) for name in lags}
    return replace(parameters, estimates={**parameters.estimates, **still})


def remarks(parameters: Parameters, recording: Recording) -> list[str]:
    """What a user should know before trusting a simulation: unknown parameters, extrapolation."""
    found = Remarks(parameters)
    found.add(recording)
    return found.lines()


class Remarks:
    """The same of one part of a log after the other; and of faults, which nobody will see in it."""

    def __init__(self, parameters: Parameters, faults: Sequence[str] = ()) -> None:
        self.parameters = parameters
        self._acts = dict.fromkeys(map(parse_fault, faults), False)
        self._field, self._time = False, (inf, -inf)
        ranges = dict(parameters.provenance.get("ranges", {}))
        self._ranges = {n: (float(a), float(b)) for n, (a, b) in ranges.items() if n in UNITS}
        self._seen = dict.fromkeys(self._ranges, (inf, -inf))
        self._laws: dict[tuple[int, int], tuple[float, float, float]] = {}
        self._samples = 0

    def add(self, recording: Recording) -> None:
        """The next part of the log."""
        self._samples += len(recording)
        t, xdot, starts = recording.t, recording.xdot, recording.starts
        self._time = min(self._time[0], float(t.min())), max(self._time[1], float(t.max()))
        self._field |= bool(recording.duty.any())
        for fault, acts in self._acts.items():
            self._acts[fault] = acts or bool((effectiveness(fault, t, xdot, starts) != 1.0).any())
        for name, (low, high) in self._seen.items():
            values = getattr(recording, name)
            self._seen[name] = min(low, float(values.min())), max(high, float(values.max()))
        signals = Signals.of(recording)
        for key, curve, p in self._curves():
            least, most, part = curve.beyond(signals, p)
            low, high, count = self._laws.get(key, (inf, -inf, 0.0))
            self._laws[key] = min(low, least), max(high, most), count + part * len(recording)

    def _curves(self) -> Iterator[tuple[tuple[int, int], Curve, dict[str, float]]]:
        for i, effect in enumerate(self.parameters.model.effects):
            from erdctl.model.learned.law import LearnedEffect  # only where there are effects

            if isinstance(effect, LearnedEffect):
                for k, curve in enumerate(effect.law.curve.axes):
                    yield (i, k), curve, effect.local(self.parameters.values)

    def lines(self) -> list[str]:
        """One line for each remark."""
        out = [f"{c}; simulated with the assumed value" for c in self.parameters.caveats()]
        for name, (low, high) in self._ranges.items():
            least, most = self._seen[name]
            margin = BEYOND * (high - low)
            if least < low - margin or most > high + margin:
                out.append(
                    f"{name} spans {least:.3g}..{most:.3g}{UNITS[name]}, but the parameters"
                    f" were identified on {low:.3g}..{high:.3g}"
                )
        return [*out, *self._beyond_laws()]

    def of_faults(self) -> list[str]:
        """One line for each fault that does nothing in the log, and one where they are of several
        dampers, which `mimic` has."""
        corners = sorted({fault.channel.value for fault in self._acts})
        several = f"faults of channels {' and '.join(corners)} act together on the one damper here"
        return [several] * (len(corners) > 1) + [
            f"{without_effect(fault, *self._time)}: force_model is as without it"
            for fault, acts in self._acts.items()
            if not acts or (fault.of_field and not self._field)
        ]

    def _beyond_laws(self) -> Iterator[str]:
        """Where learned laws are asked for more than they were learned on."""
        for key, curve, _ in self._curves():
            least, most, count = self._laws[key]
            if count == 0.0:
                continue
            low, high = curve.range
            unit = f" {curve.kind.unit}".removesuffix(" 1")
            yield (
                f"{curve.kind.words} spans {least:.3g}..{most:.3g}{unit}, but a law of it was"
                f" learned on {low:.3g}..{high:.3g}; beyond, for"
                f" {100 * count / self._samples:.2g} % of the samples, {curve.ends}"
            )
