"""Identification of a composed model: the paper's procedure, then all parameters together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from erdctl.bench.identifiability import Lack, unmet
from erdctl.core.blocks import Block, pieces, sample
from erdctl.core.errors import InputProblem
from erdctl.core.recording import DIRECTIONS, Recording
from erdctl.estimate.covariance import Fit, assess
from erdctl.estimate.least_squares import fit
from erdctl.estimate.two_step import two_step
from erdctl.model.composed import Model, off_values
from erdctl.model.parameters import Estimate

SEARCH = 40_000  # samples for the search; the last step and the errors use all
CORRELATED = 0.95
Progress = Callable[[str, str], None]


@dataclass(frozen=True, kw_only=True)
class Identification:
    """Both fits, and what to tell the user.

    joint : estimates of all parameters together;  two_step : the paper's procedure, by name
    """

    model: Model
    joint: Mapping[str, Estimate]
    two_step: Mapping[str, float]
    fit: Fit
    two_step_rms: float | None
    warnings: tuple[str, ...]


def identify(
    recording: Recording,
    model: Model | None = None,
    *,
    robust: bool = False,
    progress: Progress = lambda stage, what: None,
) -> Identification:
    """Identify the paper's model, or one with effects, from a recording.

    robust : weigh outliers down (Huber);  progress : told what is being done
    Both directions are fitted together, since they share the state F_ER.
    """
    model = model or Model()
    needs = unmet(recording)
    reasons = {name: need.reason for name, need in needs.items()}
    if set(needs) >= set(Model().quantities):
        first = next(iter(reasons.values()))
        raise InputProblem(f"the logs identify no parameter at all; for one, {first}")
    search = sample(recording, SEARCH)
    held = _held(needs)
    progress("fitting", "the paper's two steps")
    steps = two_step(search, held)
    values, evaluations, converged = _search(model, search, held, steps, robust, progress)
    progress("fitting", f"last step and errors, {len(recording)} samples")
    blocks = pieces(recording)
    found = assess(
        model, blocks, values,
        fixed=held, evaluations=evaluations, converged=converged, robust=robust,
    )  # fmt: skip
    reasons |= _flat(found)
    estimates = _estimates(found, reasons)
    complete = {**held, **steps}
    rms = None
    if set(Model().quantities) <= set(complete):
        rms = _rms(Model(), blocks, complete)
    return Identification(
        model=model,
        joint=estimates,
        two_step=steps,
        fit=found,
        two_step_rms=rms,
        warnings=tuple(_warnings(found, steps, reasons)),
    )


def _held(needs: Mapping[str, Lack]) -> dict[str, float]:
    """Values for parameters that the data cannot identify, chosen so that the rest can be fitted.

    With one level of duty any beta will do, since sigma takes up the difference; without a field
    there is no yield force; without control steps there is no lag to see.
    """
    return {
        name: 1.0 if name.endswith(".beta") else 0.0
        for name, need in needs.items()
        if not need.confounded
    }


def _search(
    model: Model,
    block: Block,
    held: Mapping[str, float],
    steps: Mapping[str, float],
    robust: bool,
    progress: Progress,
) -> tuple[dict[str, float], int, bool]:
    """The best of several starts: the paper's procedure, a slow and a fast guess."""
    default = {n: q.start for n, q in model.quantities.items()} | off_values(model)
    starts = [default | dict(steps) | dict(held)] if steps else []
    for beta, T_d in ((0.3, 0.05), (1.0, 0.01)):
        guess = {f"{d}.beta": beta for d in DIRECTIONS} | {f"{d}.T_d": T_d for d in DIRECTIONS}
        starts.append(default | guess | dict(held))
    results = []
    for number, start in enumerate(starts, start=1):
        progress("fitting", f"all parameters, start {number} of {len(starts)}")
        values, count, done = fit(model, block, start=start, fixed=held, robust=robust)
        error = (block.force - model.force(block.signals, values)) * np.sqrt(block.weight)
        cost = float(np.dot(error, error) if not robust else np.abs(error).sum())
        results.append((cost, values, count, done))
    cost, values, _, done = min(results, key=lambda r: r[0])
    return values, sum(r[2] for r in results), done


def _flat(found: Fit) -> dict[str, str]:
    out = {}
    for group in found.flat:
        for name in group:
            others = ", ".join(n for n in group if n != name) or "nothing"
            out[name] = f"the data change with it only together with {others}"
    return out


def _estimates(found: Fit, reasons: Mapping[str, str]) -> dict[str, Estimate]:
    errors = found.stderr
    out = {}
    for name, q in found.model.quantities.items():
        value, error = found.values[name], errors.get(name)
        reason = reasons.get(name)
        if reason is None and error is not None and not q.linear and error > abs(value):
            reason = f"its standard error ({error:.2g} {q.unit}) is larger than the estimate"
        if reason is None:
            out[name] = Estimate(value=value, unit=q.unit, stderr=error)
        else:
            out[name] = Estimate(value=None, unit=q.unit, assumed=value, reason=reason)
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
            f"no null-control data in {' and '.join(missing)}: the paper's first step (Eq. 16)"
            " could not be done; k_nom and c_vis come from the joint fit alone"
        )
    correlation = found.correlation()
    for i, j in zip(*np.nonzero(np.triu(np.abs(correlation) > CORRELATED, 1)), strict=True):
        a, b = found.free[int(i)], found.free[int(j)]
        if a not in reasons and b not in reasons:
            out.append(
                f"{a} and {b} are correlated ({correlation[i, j]:+.2f}):"
                " the data fix their combination better than either"
            )
    if not found.converged:
        out.append("the search stopped before it converged")
    return out
