"""What a diagnosis works on: weighted samples, and the groups of them that are left out in turn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from erdctl.bench.direction_of_motion import uncertain
from erdctl.bench.identifiability import Lack, held_values, unmet
from erdctl.core.blocks import Block, whole
from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array, Index, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.record_effects import NONE_VARY, Varying
from erdctl.model.parameters import Parameters


@dataclass(frozen=True, eq=False)
class Problem:
    """A recording prepared for fits.

    block : signals, force, weights (0 where a record settles or the direction is uncertain)
    group : (n,) which left-out part a sample belongs to
    stretch : (n,) which piece of that, of about STRETCH, by which hypotheses are compared
    unsure : (n,) whether the direction of motion is uncertain
    held : paper parameters that the log cannot identify, and their values
    free : what of the force may differ from record to record
    """

    recording: Recording
    block: Block
    group: Index
    stretch: Index
    unsure: npt.NDArray[np.bool_]
    held: dict[str, float]
    needs: dict[str, Lack]
    free: Varying = NONE_VARY

    @cached_property
    def count(self) -> int:
        """Number of groups."""
        return int(self.group.max()) + 1

    @cached_property
    def weight_of(self) -> Array:
        """(g,) total weight of each group."""
        return np.bincount(self.group, self.block.weight, self.count).astype(np.float64)

    def of(self, records: Sequence[int]) -> Problem:
        """The problem of some of the records; what is held of all stays held."""
        if len(records) == len(self.recording.names):
            return self
        part = prepare(self.recording.select(records), self.free)
        return replace(part, held=self.held, needs=self.needs)

    def holding(self, values: Mapping[str, float], names: Iterable[str]) -> Problem:
        """The problem with some parameters held where given values have them."""
        return replace(self, held={n: values[n] for n in names if n in values} | {**self.held})

    def with_free(self, betas: Iterable[str]) -> Problem:
        """The problem with each beta free that is told after all, and with it the sigma beside."""
        told = {*betas}
        told |= {n.removesuffix("beta") + "sigma" for n in told}
        held = {n: v for n, v in self.held.items() if n not in told}
        return replace(
            self, held=held, needs={n: v for n, v in self.needs.items() if n not in told}
        )

    def per_group(self, values: Array) -> Array:
        """(g,) weighted sum of (n,) values in each group."""
        sums = np.bincount(self.group, values * self.block.weight, self.count)
        return sums.astype(np.float64)

    def per_stretch(self, values: Array) -> tuple[Array, Array]:
        """(k,) weighted mean of (n,) values in each stretch, and (k,) weight of that."""
        weight = np.bincount(self.stretch, self.block.weight).astype(np.float64)
        sums = np.bincount(self.stretch, values * self.block.weight)
        return sums / np.maximum(weight, 1e-300), weight

    def t_statistics(self, worse: Array, better: Array) -> tuple[float, float]:
        """Two t statistics of one residual (n,) [N] against a smaller one.

        Of the logarithm of the ratio of their mean squares: over stretches, and over groups. What
        acts in few places has a large one over the many stretches there, and a large one over
        groups only if these lie in several of them.
        """
        (before, weight), (after, _) = (self.per_stretch(r**2) for r in (worse, better))
        use = (before > 0) & (after > 0) & (weight > 0)
        ratio = np.log(before[use] / after[use])
        group = self.group_of[use]
        count = np.bincount(group)
        by_group = (np.bincount(group, ratio) / np.maximum(count, 1))[count > 0]
        return t_statistic(ratio), t_statistic(by_group)

    @cached_property
    def group_of(self) -> Index:
        """(k,) group of each stretch."""
        first = np.flatnonzero(np.diff(self.stretch, prepend=-1))
        return self.group[first]


def t_statistic(values: Array) -> float:
    """Mean of independent values over its standard error."""
    n = len(values)
    error = float(values.std(ddof=1)) / np.sqrt(n) if n > 1 else np.inf
    mean = float(values.mean()) if n else 0.0
    if mean == 0.0:
        return 0.0
    return float(mean / error) if error > 0 else float(np.copysign(np.inf, mean))


def prepare(recording: Recording, free: Varying = NONE_VARY) -> Problem:
    """The problem of a recording with a measured force."""
    needs = unmet(recording)
    # Levels that differ by little do not tell a beta; but with another than theirs the force misses
    # them by more than noise, and that gets the name of an effect. Of lags see `slight_lag`.
    free_beta = {n for n, need in needs.items() if need.slight and n.endswith(".beta")}
    held = {n: v for n, v in held_values(needs).items() if n not in free_beta}
    block = whole(recording)
    unsure = uncertain(block.signals)
    block.weight[unsure] = 0.0
    group = groups(recording)
    if len(recording.names) == 1:
        free = NONE_VARY  # one record has nothing to differ from
    return Problem(recording, block, group, stretches(recording, group), unsure, held, needs, free)


def with_given(problem: Problem, given: Parameters, untestable: Mapping[str, str]) -> Problem:
    """The problem with given values for what the log cannot identify.

    untestable : effects of the given model that the log cannot show, each with what is missing
    """
    needs = dict(problem.needs)
    held = {name: given.values[name] for name, need in needs.items() if not need.confounded}
    for effect in given.model.effects:
        if effect.name in untestable:
            keys = [effect.key(q.symbol) for q in effect.quantities]
            held |= {key: given.values[key] for key in keys}
            needs |= dict.fromkeys(keys, Lack(untestable[effect.name]))
    return replace(problem, held=held, needs=needs)


def groups(recording: Recording) -> Index:
    """(n,) left-out stretches: records, each cut evenly where there are few of them."""
    slices = recording.slices
    lengths = np.array([recording.t[s][-1] - recording.t[s][0] for s in slices])
    total = max(float(lengths.sum()), 1e-9)
    out = np.empty(len(recording), dtype=np.intp)
    first, most = 0, thresholds.CV_GROUPS
    for part, length in zip(slices, lengths.tolist(), strict=True):
        share = round(most * length / total) if len(slices) < most else 1
        n = part.stop - part.start
        pieces = max(1, min(share, int(length / thresholds.STRETCH), n))
        out[part] = first + np.arange(n) * pieces // n
        first += pieces
    return out


def stretches(recording: Recording, group: Index) -> Index:
    """(n,) stretches of about `thresholds.STRETCH` seconds, each within one group."""
    out = np.empty(len(recording), dtype=np.intp)
    first = 0
    ends = np.flatnonzero(np.diff(group)) + 1
    for a, b in pairwise([0, *ends.tolist(), len(recording)]):
        span = float(recording.t[b - 1] - recording.t[a])
        # Of a log with few samples a second each is a stretch: none may be empty.
        pieces = max(1, min(int(span / thresholds.STRETCH), b - a))
        out[a:b] = first + np.arange(b - a) * pieces // (b - a)
        first += pieces
    return out


def check_enough(problem: Problem) -> None:
    """Refuse a recording that can show nothing."""
    weight, moving = problem.block.weight, problem.block.signals.xdot != 0.0
    if np.ptp(problem.block.force) == 0.0:
        raise InputProblem("the force never changes: there is nothing to diagnose")
    if not (moving & (weight > 0)).any():
        raise InputProblem("the damper never moves: there is nothing to diagnose")
    count, least = int(np.count_nonzero(problem.weight_of)), thresholds.LEAST_GROUPS
    if count < least:
        raise InputProblem(
            f"too short to diagnose: {least} parts of {thresholds.STRETCH:g} s or more are left"
            f" out in turn, and this log has {count}; record at least"
            f" {2 * least * thresholds.STRETCH:g} s"
        )
