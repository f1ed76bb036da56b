"""The best that could be reached: the true structure, all its parameters fitted to the same log.

It is given what is hidden and where the damper's own parameters lie, so that its search does not
fail where a diagnosis may.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

from erdctl.core.blocks import thinned
from erdctl.core.errors import IncompatibleEffects
from erdctl.core.recording import DIRECTIONS
from erdctl.core.signals import Signals
from erdctl.diagnose.as_taken import told_by_control
from erdctl.diagnose.problem import Problem, prepare
from erdctl.diagnose.screening import starts
from erdctl.estimate.least_squares import Fitted, fit
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.paper import QUANTITIES
from erdctl.model.slots import Values

SEARCH = 6_000  # samples of the search; the best starts are then fitted to all
LOOK = 6  # evaluations that rank a start
SHARPEN = 60  # evaluations for those that are kept
KEPT = 3  # starts that are searched to the end
PLAIN = Model()  # the paper's


def best_fit(
    problem: Problem, effects: Sequence[Effect], damper: Values, diagnosed: Values
) -> Fitted:
    """The true structure on a log.

    damper : the plant's own paper parameters, to start from
    diagnosed : what the diagnosis found, a start for those effects that it holds
    """
    model = Model(tuple(effects))
    rough = prepare(thinned(problem.recording, SEARCH))
    if len(effects) > 2:
        points = _one_by_one(rough, effects, damper, diagnosed)
    else:
        guesses = [_guesses(rough, e, damper, diagnosed, few=len(effects) > 1) for e in effects]
        points = [_joined([damper, *point]) for point in product(*guesses)]
    if all(name in diagnosed for name in model.quantities):
        points.append(dict(diagnosed))
    coarse = _ranked(rough, model, points, LOOK)[:KEPT]
    fine = _ranked(rough, model, [c.values for c in coarse], SHARPEN)[0]
    full = [fine.values]
    if all(name in diagnosed for name in model.quantities):
        full.append({n: diagnosed[n] for n in model.quantities})
    return _ranked(problem, model, full, SHARPEN)[0]


def acts(effects: Sequence[Effect], signals: Signals) -> bool:
    """Whether the model can hold these effects together: the plant knows no such bounds."""
    model = Model(tuple(effects))
    try:
        model.force(signals, _defaults(model))
    except IncompatibleEffects:
        return False
    return True


def damper_values(key: Mapping[str, Any]) -> dict[str, float]:
    """The paper's parameters of the plant in a key, by erdctl's names."""
    return {f"{d}.{s}": float(key["damper"][d][s]) for d in DIRECTIONS for s in QUANTITIES}


def _guesses(
    problem: Problem,
    effect: Effect,
    damper: Values,
    diagnosed: Values,
    *,
    few: bool,
    known: Model = PLAIN,
) -> list[dict[str, float]]:
    """Starts for one effect beyond a known model; of a pair only those that do best alone, or there
    are too many."""
    own = {effect.key(q.symbol) for q in effect.quantities}
    rest = problem.block.force - known.force(problem.block.signals, damper)
    out = [{effect.key(s): v for s, v in g.items()} for g in starts(effect, problem, rest)]
    if few:
        alone = _ranked(problem, Model((effect,)), [_joined([damper, g]) for g in out], LOOK)
        out = [{n: v for n, v in r.values.items() if n in own} for r in alone[:KEPT]]
    if own <= set(diagnosed):
        out.append({n: diagnosed[n] for n in own})
    return out


def _one_by_one(
    problem: Problem, effects: Sequence[Effect], damper: Values, diagnosed: Values
) -> list[dict[str, float]]:
    """Starts for a crowd: each effect is added to the best fit of those before it, as all their
    starts together are too many."""
    points = [dict(damper)]
    for count, effect in enumerate(effects, start=1):
        known = Model(tuple(effects[: count - 1]))
        more = _guesses(problem, effect, points[0], diagnosed, few=False, known=known)
        tried = [_joined([points[0], guess]) for guess in more]
        points = [r.values for r in _ranked(problem, Model(tuple(effects[:count])), tried, LOOK)]
    return points[:KEPT]


def _ranked(
    problem: Problem, model: Model, points: Sequence[Values], evaluations: int
) -> list[Fitted]:
    """Fits from every point, the best first."""
    fits = [_fitted(problem, model, point, evaluations) for point in points]
    return sorted(fits, key=lambda r: r.cost)


def _fitted(problem: Problem, model: Model, point: Values, evaluations: int) -> Fitted:
    problem = told_by_control(problem, model, {**_defaults(model), **point})
    start = {n: v for n, v in {**_defaults(model), **point, **problem.held}.items()
             if n in model.quantities}  # fmt: skip
    return fit(model, problem.block, start=start, fixed=problem.held, max_evaluations=evaluations)


def _defaults(model: Model) -> dict[str, float]:
    return {n: q.start for n, q in model.quantities.items()}


def _joined(parts: Sequence[Values]) -> dict[str, float]:
    return {n: v for part in parts for n, v in part.items()}
