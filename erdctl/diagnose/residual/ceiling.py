"""A force channel whose range ends, with noise behind the end: no two samples there are the same.

What stops at a limit within a recorder shows as samples of one value (`erdctl.bench.rig.clipping`).
An amplifier that stops, and is recorded with noise, shows as samples that stay about one level
where the model goes on beyond it, whatever motion and control ask for. Friction, yield or a valve
that flattens the force leaves a part of either. The relief valve of a damper alone does the same;
either way no model of the fluid is to be fitted to what is there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from erdctl.bench.rig.fault import Rig, RigFault
from erdctl.bench.rig.pieces import widened
from erdctl.core.recording import Array
from erdctl.diagnose import thresholds
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.residual.lack_of_fit import LackOfFit

Flags = npt.NDArray[np.bool_]


def ceilings(
    rig: Rig, problem: Problem, tried: tuple[Hypothesis, ...], left: LackOfFit
) -> tuple[RigFault, ...]:
    """The ends of the range of the force, upper and lower, by the first hypothesis that tells one.

    rig : checks of the recording whose usable part the problem is of
    """
    known = {*rig.accepted, *(f.code for f in rig.faults)}
    if rig.blocking or "force_clipped" in known:
        return ()
    for hypothesis in tried:
        found = _told(rig, problem, hypothesis, left, (1.0, -1.0))
        if len(found) == 1:
            # What stops on one side has drawn the model on the other one with it.
            ((side, fault),) = found.items()
            out = () if fault.samples is None else fault.samples
            there = np.isin(_logged(rig, problem), out)
            weight = np.where(there, 0.0, problem.block.weight)
            rest = replace(problem, block=problem.block._replace(weight=weight))
            again = fit_hypothesis(
                rest, hypothesis.effects, [hypothesis.values], thresholds.STEPS_AGAIN,
                hypothesis.record_effects,
            )  # fmt: skip
            found |= _told(rig, rest, again, left, (-side,))
        if found:
            return tuple(found.values())
    return ()


def _told(
    rig: Rig, problem: Problem, h: Hypothesis, left: LackOfFit, sides: tuple[float, ...]
) -> dict[float, RigFault]:
    """What a hypothesis tells of some sides."""
    model = h.model.force(problem.block.signals, h.values)
    found = {side: _Side(problem, h, model, left, side).fault(rig) for side in sides}
    return {side: fault for side, fault in found.items() if fault is not None}


class _Side:
    """Force and model of a problem, upwards on one side (n,) [N]; what is left beside noise."""

    def __init__(
        self, problem: Problem, h: Hypothesis, model: Array, left: LackOfFit, side: float
    ) -> None:
        r, v = problem.recording, h.values
        viscosity = np.where(r.xdot > 0.0, v["compression.c_vis"], v["release.c_vis"])
        self.problem, self.side, self.noise = problem, side, left.noise_rms
        self.force, self.model = side * problem.block.force, side * model
        self.viscous = side * viscosity * r.xdot
        self.least = thresholds.CEILING_SHARE * left.misfit_rms**2 * len(model)

    def fault(self, rig: Rig) -> RigFault | None:
        """The end of the range on this side, if there is one."""
        level, zone = self._level()
        if not zone.any() or not self._is_flat(zone, level):
            return None
        r = self.problem.recording
        rows, t = np.flatnonzero(self._at(zone, level)), r.t
        first = int(np.flatnonzero(zone)[0])
        record = r.names[int(np.searchsorted(r.starts, first, "right")) - 1]
        limit = float(f"{self.side * level:.4g}")
        return RigFault(
            "force_clipped",
            None,
            f"force stops at {limit:g} N, give or take its noise, whatever motion and duty ask for:"
            f" the model goes beyond at {np.count_nonzero(zone)} samples, first at"
            f" t = {t[first]:.6g} s of record '{record}'",
            "what is near that is left out of fits; widen the range of the amplifier or recorder"
            " (only a relief valve would do the same)",
            samples=_logged(rig, self.problem)[rows],
            when=(float(t[rows[0]]), float(t[rows[-1]])),
        )

    def _level(self) -> tuple[float, Flags]:
        """Where the force stops, and the samples (n,) for which the model has more.

        The mean of the force where the model has most, over as many samples as gain most by it.
        """
        weighed = np.flatnonzero(self.problem.block.weight > 0.0)
        order = weighed[np.argsort(-self.model[weighed], kind="stable")]
        force, model = self.force[order], self.model[order]
        count = np.arange(1, len(order) + 1)
        mean = np.cumsum(force) / count
        gain = np.cumsum((force - model) ** 2) - (np.cumsum(force**2) - mean**2 * count)
        most = thresholds.CEILING_PART * len(order)
        gain = np.where((model >= mean) & (count < most), gain, -np.inf)
        zone = np.zeros(len(self.model), np.bool_)
        best = int(np.argmax(gain)) if len(order) else 0
        if not len(order) or gain[best] < max(thresholds.CEILING_GAIN * self.noise**2, self.least):
            return 0.0, zone
        zone[order[: best + 1]] = True
        return float(mean[best]), zone

    def _is_flat(self, zone: Flags, level: float) -> bool:
        """Whether neither what is viscous nor the rest of the model shows in what is measured,
        though both change by enough to be seen, and noise is all that does."""
        z = self.force[zone] - level
        visits = np.count_nonzero(np.diff(zone.astype(np.int8), prepend=0) > 0)
        if visits < thresholds.CEILING_VISITS or np.std(z) > thresholds.CEILING_NOISE * self.noise:
            return False
        rest = self.model - self.viscous
        parts = np.column_stack([p[zone] - np.mean(p[zone]) for p in (self.viscous, rest)])
        square = parts.T @ parts
        if np.linalg.cond(square) > thresholds.CEILING_COND:
            return False  # motion and control changed together, or not at all
        slope = np.linalg.solve(square, parts.T @ z)
        # A visit counts once: noise may have a memory as long.
        spread = np.var(z - parts @ slope) * np.count_nonzero(zone) / visits
        error = np.sqrt(np.diag(np.linalg.inv(square)) * spread)
        return bool(np.all(np.abs(slope) + 2.0 * error < thresholds.CEILING_SLOPE))

    def _at(self, zone: Flags, level: float) -> Flags:
        """(n,) samples at the end of the range: those for which the model has more, and stays about
        the level, some of which a model that was fitted to them has below it."""
        near = self.force > level - thresholds.CEILING_NEAR * self.noise
        starts = np.flatnonzero(np.diff(near.astype(np.int8), prepend=0) > 0)
        run = np.cumsum(np.isin(np.arange(len(near)), starts)) * near
        length = np.bincount(run)
        length[0] = 0
        return widened(zone | (length[run] >= thresholds.CEILING_RUN), 1)


def _logged(rig: Rig, problem: Problem) -> npt.NDArray[np.intp]:
    """(n,) rows of the recording as it was logged."""
    whole = rig.recording
    if whole is None or len(whole) == len(problem.recording):
        return np.arange(len(problem.recording))
    kept = {*problem.recording.names}
    parts = [p for p, name in zip(whole.slices, whole.names, strict=True) if name in kept]
    return np.concatenate([np.arange(p.start, p.stop) for p in parts])
