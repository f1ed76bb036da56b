"""Simulation of identified parameters over a recording, healthy or with faults."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from erdctl.core.blocks import neighbours
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.core.signals import Signals
from erdctl.model.divergence import refuse_diverged
from erdctl.model.learned.law import LearnedEffect
from erdctl.model.parameters import Parameters

UNITS = {"x": "m", "xdot": "m/s", "duty": ""}
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
    States restart with each record, so a long log is computed in runs of records that fit into a
    processor's cache, which is twice as fast as all at once.
    """
    runs = neighbours(recording)
    if len(runs) == 1:
        progress("simulating", part_of(f"{len(recording)} samples", 1, 1))
        out = _force(parameters, recording, faults)
        refuse_diverged(out, parameters.model, parameters.values, recording)
        return out
    out = np.empty(len(recording))
    ends = np.cumsum([len(run) for run in runs]).tolist()
    for number, (run, end) in enumerate(zip(runs, ends, strict=True), start=1):
        progress("simulating", part_of(f"{len(recording)} samples", number, len(runs)))
        out[end - len(run) : end] = _force(parameters, run, faults)
    refuse_diverged(out, parameters.model, parameters.values, recording)
    return out


def _force(parameters: Parameters, recording: Recording, faults: Sequence[str]) -> Array:
    signals = Signals.of(recording)
    prepared = parameters.model.prepare(signals, parameters.values)
    if not faults:
        return prepared.force(parameters.values)
    from erdctl.model.faults import factors, parse_fault

    found = factors([parse_fault(f) for f in faults], signals.t, signals.xdot, signals.starts)
    groups = {"gas": found.gas, "viscous": found.viscous, "yield": found.yield_}
    return prepared.force(parameters.values, groups)


def without_lag(parameters: Parameters) -> Parameters:
    """The static model of Eq. 9: the same parameters with T_d = 0."""
    lags = [f"{d}.T_d" for d in DIRECTIONS]
    still = {name: replace(parameters.estimates[name], value=0.0) for name in lags}
    return replace(parameters, estimates={**parameters.estimates, **still})


def remarks(parameters: Parameters, recording: Recording) -> list[str]:
    """What a user should know before trusting a simulation: unknown parameters, extrapolation."""
    out = [f"{c}; simulated with the assumed value" for c in parameters.caveats()]
    for name, ends in dict(parameters.provenance.get("ranges", {})).items():
        if name not in UNITS:
            continue
        low, high = (float(e) for e in ends)
        values = getattr(recording, name)
        margin = BEYOND * (high - low)
        seen_low, seen_high = float(values.min()), float(values.max())
        if seen_low < low - margin or seen_high > high + margin:
            out.append(
                f"{name} spans {seen_low:.3g}..{seen_high:.3g} {UNITS[name]}, but the parameters"
                f" were identified on {low:.3g}..{high:.3g}"
            )
    return [*out, *_beyond_laws(parameters, recording)]


def _beyond_laws(parameters: Parameters, recording: Recording) -> list[str]:
    """Where learned laws are asked for more than they were learned on."""
    out = []
    for effect in parameters.model.effects:
        if isinstance(effect, LearnedEffect):
            p, s = effect.local(parameters.values), Signals.of(recording)
            for curve in effect.law.curve.axes:
                least, most, part = curve.beyond(s, p)
                if part == 0.0:
                    continue
                low, high = curve.range
                unit = f" {curve.kind.unit}".removesuffix(" 1")
                out.append(
                    f"{curve.kind.words} spans {least:.3g}..{most:.3g}{unit}, but a law of it was"
                    f" learned on {low:.3g}..{high:.3g}; beyond, for {100 * part:.2g} % of the"
                    " samples, it stays at its end value"
                )
    return out
