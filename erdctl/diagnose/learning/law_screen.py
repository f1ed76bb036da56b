"""A cheap look at many laws: what each could take of the rest, from a few slopes of the force.

A factor 1 + f of a force changes it by f times that force. What acts before the lag of Eq. 12 goes
through it: with u for the steady yield force and F for its state, to first order in f

    duty  v -> (1 + f) v        T dD/dt + D = f v du/dv
    lag   T -> (1 + f) T        T dD/dt + D = f (F - u)

So the model is evaluated a few times, whatever the number of curves and knots.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.screening import Screen
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.law import Law, LawSlot, LearnedEffect
from erdctl.model.paper import pair
from erdctl.model.response import Prepared


class LawScreen(Screen):
    """Looks at laws to add to one hypothesis."""

    def _slopes(self, effect: Effect, start: dict[str, float]) -> list[Array]:
        if not isinstance(effect, LearnedEffect) or effect.law.slot is LawSlot.DEFLECTION:
            return super()._slopes(effect, start)
        law = effect.law
        if law.slot.adds:
            return []  # all its sizes are amplitudes
        rows = law.curve.rows(self.problem.block.signals, start)
        if law.slot in self._before_lag:
            of_c, of_r = self._before_lag[law.slot]
            return [self._behind_lag(row * of_c, row * of_r) for row in rows]
        if law.slot not in self._factors:
            self._factors[law.slot] = self._of_a_factor(law.slot)
        return list(rows * self._factors[law.slot])

    @cached_property
    def _factors(self) -> dict[LawSlot, Array]:
        return {}

    def _of_a_factor(self, slot: LawSlot) -> Array:
        """(n,) slope of the force by a factor that is the same throughout."""
        effect = Law(slot, Curve("t", (0.0, 1.0))).effect  # a line of two values, changed alike
        model, step = Model((*self.parent.effects, effect)), thresholds.SMOOTH_STEP
        alike = {effect.key(q.symbol): step for q in effect.sizes}
        moved = model.force(self.problem.block.signals, {**self.parent.values, **alike})
        return (moved - self.force) / step

    @cached_property
    def _prepared(self) -> Prepared:
        return self.parent.model.prepare(self.problem.block.signals, self.parent.values)

    @cached_property
    def _before_lag(self) -> dict[LawSlot, tuple[Array, Array]]:
        """(n,) of either direction: what goes into the lag for f = 1 [N]."""
        model, values, step = self.parent.model, self.parent.values, thresholds.SMOOTH_STEP
        now, sigma = self._prepared, pair(values, "sigma")
        less = model.fields(now.signals.with_duty((1.0 - step) * now.signals.duty), values)
        steady = [s * field for s, field in zip(sigma, now.fields, strict=True)]
        below = [s * field for s, field in zip(sigma, less, strict=True)]
        state = now.yield_state(*steady)
        by_duty = [(u - v) / step for u, v in zip(steady, below, strict=True)]
        by_lag = [state - u for u in steady]
        return {
            LawSlot.DUTY: (by_duty[0], by_duty[1]), LawSlot.LAG: (by_lag[0], by_lag[1]),
        }  # fmt: skip

    def _behind_lag(self, compression: Array, release: Array) -> Array:
        now = self._prepared
        state = now.yield_state(compression, release) * now.sign
        return np.asarray(state * now.scale["yield"] if "yield" in now.scale else state)
