"""Identification of a composed model: the paper's procedure, then all parameters together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from erdctl.bench.direction_of_motion import certain
from erdctl.bench.identifiability import held_values, unmet
from erdctl.core.blocks import SETTLE, Block, pieces, sample
from erdctl.core.errors import InputProblem
from erdctl.core.messages import duration
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import DIRECTIONS, Recording
from erdctl.estimate.covariance import Fit, estimates, together
from erdctl.estimate.held_lags import LACKING, LAGS, tell_the_lags, with_held_lags
from erdctl.estimate.last_step import assess
from erdctl.estimate.least_squares import Fitted, fit
from erdctl.estimate.measurement_noise import measurement_noise
from erdctl.estimate.starts import fresh_start
from erdctl.estimate.two_step import two_step
from erdctl.model.composed import Model, off_values
from erdctl.model.parameters import Estimate
from erdctl.model.slots import Values

SEARCH = 40_000  # samples for the search; the last step and the errors use all
CORRELATED = 0.95
DISAGREE_ERRORS, DISAGREE_PART = 8.0, 0.3  # standard errors, and part of the value
FRESH = ((0.05, 0.3), (0.01, 1.0))  # T_d [s] and beta [1] of two guesses: slow and fast


@dataclass(frozen=True, kw_only=True)
class Identification:
    """Both fits, and what to tell the user.

    joint : estimates of all parameters together;  two_step : the paper's procedure, by name
    noise_rms : measurement noise [N], which the residual exceeds where the model lacks something
    """

    model: Model
    joint: Mapping[str, Estimate]
    two_step: Mapping[str, float]
    fit: Fit
    two_step_rms: float | None
    noise_rms: float
    warnings: tuple[str, ...]


def identify(
    recording: Recording,
    model: Model | None = None,
    *,
    robust: bool = False,
    progress: Progress = lambda stage, what: None,
) -> Identification:
    """Identify the paper's model, or one with effects, from a recording.

    robust : weigh outliers down (Huber);  progress : called with what is being done
    Both directions are fitted together, since they share the state F_ER.
    """
    model = model or Model()
    needs = unmet(recording)
    reasons = {name: need.reason for name, need in needs.items()}
    if set(needs) >= set(Model().quantities):
        first = next(iter(reasons.values()))
        raise InputProblem(f"the logs identify no parameter at all; for one, {first}")
    if recording.excluded is not None and recording.excluded.all():
        raise InputProblem(
            "every sample is left out of the fit, for what is wrong with the recording; see"
            " erdctl inspect, and --accept for what is right as it is"
        )
    search = certain(sample(recording, SEARCH))
    held = held_values(needs)
    starts = len(FRESH) + 1  # at most: the two steps give one more
    progress("fitting", part_of("the paper's two steps", 1, starts + 2))
    steps = two_step(search, held)
    best, evaluations = _search(model, search, held, steps, robust, progress)
    what = f"last step and errors, {len(recording)} samples"
    progress("fitting", part_of(what, starts + 2, starts + 2))
    blocks = [certain(block) for block in pieces(recording)]
    last = assess(
        model, blocks, best.values,
        fixed=held, evaluations=evaluations, converged=best.converged, robust=robust,
    )  # fmt: skip
    slight = [n for n in held if needs[n].slight]
    found, lagging = with_held_lags(last, search, slight)
    if lagging is not None:
        others = {n: v for n, v in held.items() if n not in LAGS}
        with_lags = fit(model, search, start=lagging, fixed=others, robust=robust)
        evaluations += with_lags.evaluations
        lagging = lagging if tell_the_lags(last, with_lags, search) else None
    if lagging is not None:
        best, held = with_lags, others
        last = found = assess(
            model, blocks, best.values,
            fixed=held, evaluations=evaluations, converged=best.converged, robust=robust,
        )  # fmt: skip
    moved = [n for n in found.intervals if n not in {*last.intervals, *reasons}]
    reasons |= together(found)
    reasons |= _uncertain(found, reasons)
    complete = {**held, **steps}
    rms = None
    if set(Model().quantities) <= set(complete):
        rms = _rms(Model(), blocks, complete)
    residual = search.force - model.force(search.signals, found.values)
    noise = measurement_noise(search, residual)
    return Identification(
        model=model,
        joint=estimates(found, reasons),
        two_step=steps,
        fit=found,
        two_step_rms=rms,
        noise_rms=noise,
        warnings=(
            *_of_misfit(found.rms, noise),
            *_warnings(found, steps, reasons),
            *_of_lags(moved, None if lagging is None else found.values),
        ),
    )


def _search(
    model: Model,
    block: Block,
    held: Mapping[str, float],
    steps: Mapping[str, float],
    robust: bool,
    progress: Progress,
) -> tuple[Fitted, int]:
    """The best of several starts (the paper's procedure, two guesses), evaluations of all."""
    default = {n: q.start for n, q in model.quantities.items()} | off_values(model)
    starts = [default | dict(steps) | dict(held)] if steps else []
    for T_d, beta in FRESH:
        starts.append(default | fresh_start(T_d, beta) | dict(held))
    results = []
    for number, start in enumerate(starts, start=1):
        what = f"all parameters, start {number}"
        progress("fitting", part_of(what, number + 1, len(FRESH) + 3))
        results.append(fit(model, block, start=start, fixed=held, robust=robust))

    def cost(found: Fitted) -> float:
        if not robust:
            return found.cost
        return float(np.dot(np.sqrt(block.weight), np.abs(found.residual)))

    return min(results, key=cost), sum(found.evaluations for found in results)


def _of_misfit(rms: float, noise: float) -> list[str]:
    """What to say where the model leaves far more than noise."""
    if not rms > LACKING * noise > 0.0:
        return []
    return [
        f"the residual, {rms:.3g} N rms, is {rms / noise:.2g} times the noise of the force: the"
        " model lacks something, and no error here says how far that has moved a parameter; see"
        " erdctl diagnose"
    ]


def _of_lags(names: Sequence[str], taken: Values | None) -> list[str]:
    """What to say where no step of the duty shows the lags.

    names : of parameters that lags held at 0 may have moved;  taken : all values, if with lags
    """
    if taken is not None:
        lags = " and ".join(f"{duration(taken[n])} in {n.split('.')[0]}" for n in LAGS)
        return [
            f"lags of {lags} are taken, as with them nothing but noise is left: reversals alone"
            " show them, where other physics may look alike, so no interval is given"
        ]
    if not names:
        return []
    return [
        f"the intervals of {', '.join(names)} hold for any lag of Eq. 12 that the data allow; a"
        " step of the duty while the piston moves would tell the lag, and these closer"
    ]


def _disagreements(found: Fit, steps: Mapping[str, float], reasons: Mapping[str, str]) -> list[str]:
    """Parameters that the paper's steps and the joint fit give far beyond the errors of either.

    The two weigh the same data otherwise; where the model holds they agree.
    """
    out = []
    for name, error in found.stderr.items():
        if name not in steps or name in reasons:
            continue
        value, other = found.values[name], steps[name]
        unit = f" {found.model.quantities[name].unit}".removesuffix(" 1")
        away = abs(value - other)
        if away > DISAGREE_ERRORS * error and away > DISAGREE_PART * max(abs(value), abs(other)):
            out.append(
                f"{name}: {value:.4g} +- {error:.2g}{unit} by the joint fit and {other:.4g} by"
                " the paper's steps, far beyond the error: the model lacks something or the"
                " recording is at fault, so trust neither before erdctl diagnose"
            )
    return out


def _uncertain(found: Fit, reasons: Mapping[str, str]) -> dict[str, str]:
    """Shape parameters whose error exceeds them."""
    out = {}
    for name, error in found.stderr.items():
        q, value = found.model.quantities[name], found.values[name]
        if name not in reasons and not q.linear and error > abs(value):
            said = f"{error:.2g} {q.unit}".removesuffix(" 1")
            out[name] = f"its standard error ({said}) is larger than the estimate"
    return out


def _rms(model: Model, blocks: list[Block], values: Mapping[str, float]) -> float:
    square, weight = 0.0, 0.0
    for block in blocks:
        error = block.force - model.force(block.signals, values)
        square += float(np.dot(block.weight, error * error))
        weight += float(block.weight.sum())
    return float(np.sqrt(square / weight))


def _warnings(found: Fit, steps: Mapping[str, float], reasons: Mapping[str, str]) -> list[str]:
    out = []
    missing = [
        d for d in DIRECTIONS
        if f"{d}.c_vis" not in steps and f"{d}.c_vis" not in reasons
    ]  # fmt: skip
    if missing:
        out.append(
            f"too little null-control data in {' and '.join(missing)} (at duty 0 for {SETTLE:g} s):"
            " the paper's first step (Eq. 16) could not be done; k_nom and c_vis come from the"
            " joint fit alone"
        )
    correlation = found.correlation()
    for i, j in zip(*np.nonzero(np.triu(np.abs(correlation) > CORRELATED, 1)), strict=True):
        a, b = found.free[int(i)], found.free[int(j)]
        if a not in reasons and b not in reasons:
            out.append(
                f"{a} and {b} are correlated ({correlation[i, j]:+.2f}):"
                " the data fix their combination better than either"
            )
    out += _disagreements(found, steps, reasons)
    if not found.converged:
        out.append("the search stopped before it converged")
    return out
