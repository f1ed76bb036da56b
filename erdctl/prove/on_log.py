"""Effects of the catalogue hidden in a user's own recording, and what its diagnosis says.

First the recording is diagnosed as it is. What that names is there anyway, and is part of the model
that everything after it must answer for. Then each effect is hidden in several sizes: an
independent simulation (`erdctl.plant`) says what it would add to the force on the recording's own
motion and duty, which is added to what was measured, noise, misfit and all. An effect of the force
channel, as an average or a delay, is applied to what was measured itself.

    size = rms of what the model, refitted, does not absorb of the added force / local noise
    local noise^2 = mean of (what the diagnosis left)^2, weighted by the square of that force

The strength for a size is sought with a model that absorbs to first order, and then with refits:
a large friction bends a shear thinning until most of what the first order leaves is absorbed.

Against it stand nulls: the recording with nothing added but what was left of it turned over, group
by group at random, so that a name is chance. What is asked is which effects are named, so no
diagnosis learns laws.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import exp, log
from zlib import crc32

import numpy as np

from erdctl.core.blocks import thinned
from erdctl.core.errors import ErdctlError, UsageProblem
from erdctl.core.progress import Progress
from erdctl.core.recording import DIRECTIONS, Array, Recording
from erdctl.diagnose import thresholds
from erdctl.diagnose.corrected import parameters
from erdctl.diagnose.detectable import Injection
from erdctl.diagnose.diagnosis import Diagnosis, diagnose
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.diagnose.search import base_starts
from erdctl.diagnose.thin import thinned as samples_of_search
from erdctl.effects import catalogue
from erdctl.model.paper import QUANTITIES
from erdctl.model.parameters import Parameters
from erdctl.plant.on_log import Logged, OnLog, stage
from erdctl.plant.twin import Twin
from erdctl.plant.twins import every
from erdctl.prove.catalogued import nameable, no_model_has, right_names
from erdctl.prove.score import Found, HiddenEffect, matches

MOST = 6  # effects in one diagnosis
CLOSE = 0.03  # of the logarithm of a size
STEPS = 16  # of the search for a strength
REFIT_CLOSE, REFITS = 0.05, 6  # the same where each step is a fit
FAR = 0.15  # of the logarithm of a size, from which on an effect is not of that size


@dataclass(frozen=True)
class Trial:
    """One diagnosis of the recording with something hidden in it, or with nothing.

    effect : hidden, None for a null;  size : see the module, as reached
    parameters : what was hidden, value and SI unit by symbol;  force, beyond : rms of the force
    that was added, and of what the model cannot absorb of it;  local : noise where it acts [N]
    found : whether it was named;  said : names beyond those that are there anyway
    skipped : why it was not diagnosed
    """

    effect: str | None
    wanted: float
    size: float = 0.0
    parameters: dict[str, tuple[float, str]] = field(default_factory=dict)
    force: float = 0.0
    beyond: float = 0.0
    local: float = 0.0
    found: bool | None = None
    said: tuple[str, ...] = ()
    verdict: str = ""
    skipped: str | None = None


@dataclass(frozen=True, eq=False)
class Host:
    """A recording to hide effects in, with what its own diagnosis says.

    recording : at its full rate;  every : of whose samples one is diagnosed
    found : its diagnosis;  given : the corrected parameters of that
    again : names that a diagnosis of the same recording with that model still gives
    """

    recording: Recording
    every: int
    found: Diagnosis
    given: Parameters
    again: tuple[str, ...]
    seed: int

    @property
    def anyway(self) -> tuple[str, ...]:
        """Names that need nothing to be hidden."""
        return (*(f.effect.name for f in self.found.findings), *self.again)


def host(recording: Recording, every: int, seed: int, jobs: int, progress: Progress) -> Host:
    """A recording diagnosed as it is, and once more beyond what that names."""
    if recording.force is None:
        raise UsageProblem("prove --on needs a log with a measured force")
    thin = _thinned(recording, every)
    found = diagnose(thin, catalogue(), limits=False, learning=False, jobs=jobs, progress=progress)
    if found.rig.blocking:
        texts = "; ".join(f.text for f in found.rig.blocking)
        raise UsageProblem(f"nothing can be hidden in this log before its rig is right: {texts}")
    given = parameters(found)
    more = diagnose(
        thin, catalogue(), given=given, most=2, limits=False, learning=False, jobs=jobs,
        progress=progress,
    )  # fmt: skip
    again = tuple(f.effect.name for f in more.findings)
    # What a parameter would need is for people, and holds functions that no process can be sent.
    lean = replace(found, problem=replace(found.problem, needs={}))
    return Host(recording, every, lean, given, again, seed)


def hideable(chosen: Sequence[str] | None) -> list[str]:
    """Effects that the plant can hide and a diagnosis can name, all or those chosen."""
    names = [n for n in every() if n in nameable()]
    unknown = [n for n in chosen or () if n not in names]
    if unknown:
        raise UsageProblem(f"cannot hide {', '.join(unknown)}; there are {', '.join(names)}")
    return [n for n in names if chosen is None or n in chosen]


def with_all(bare: OnLog, laws: Sequence[tuple[Twin, Mapping[str, float]]]) -> OnLog:
    """A damper on a log with effects whose laws have some values, as many as it can have together.

    The first ones first: behind a soft mount, say, the plant simulates no law of the rod's motion.
    """
    present: list[Twin] = []
    for twin, values in laws:
        fits = all(twin.goes_with(other) for other in present)
        there = bare.also_with(twin, values) if fits else None
        if there is not None:
            bare = there
            present.append(twin)
    return bare


class Hiding:
    """Hides effects in a host."""

    def __init__(self, host: Host) -> None:
        self.host = host
        r, best = host.recording, host.found.selection.best
        records = [
            Logged(name, r.t[part], r.x[part], r.xdot[part], r.duty[part])
            for name, part in zip(r.names, r.slices, strict=True)
        ]
        sides = [{q: best.values[f"{d}.{q}"] for q in QUANTITIES} for d in DIRECTIONS]
        self.stage: OnLog = stage(records, sides)
        twins = [(every()[e.name], e) for e in best.effects if e.name in every()]
        self.present = [twin for twin, _ in twins]
        laws = [(twin, effect.local(best.values)) for twin, effect in twins]
        self.stage = with_all(self.stage, laws)
        self.injection = Injection(host.found.problem, best)
        self.rest = best.residual
        block = host.found.problem.block
        self.force = float(np.sqrt(np.average(block.force**2, weights=block.weight)))

    def trials(self, name: str, sizes: Sequence[float]) -> list[Trial]:
        """An effect hidden in each of some sizes."""
        twin = every()[name]
        same = {name, *right_names(name, twin.equivalents)}
        there = sorted(same.intersection(self.host.anyway))
        if there:
            return [Trial(name, s, skipped=f"{there[0]} is in the log already") for s in sizes]
        lacking = [self.host.found.untestable.get(n) for n in same]
        beside = [t.name for t in self.present if not twin.goes_with(t)]
        if beside:
            why = f"one damper has not both it and {beside[0]}, which is in the log"
            return [Trial(name, s, skipped=why) for s in sizes]
        if all(lacking):
            return [Trial(name, s, skipped=f"cannot be tested: {lacking[0]}") for s in sizes]
        best = self.host.found.selection.best
        if no_model_has(same, best.model, self.host.found.problem.block.signals, best.values):
            why = "no model holds it beside the effects that are in the log"
            return [Trial(name, s, skipped=why) for s in sizes]
        shape = twin.drawn(np.random.default_rng([self.host.seed, crc32(name.encode())]))
        out, at = [], log(twin.start)
        for size in sizes:
            trial, at = self._sought(twin, shape, size, at)
            if trial.skipped is None:
                trial = self._judged(trial, self._recorded(twin, shape, exp(at)), twin)
            out.append(trial)
        return out

    def null(self, number: int) -> Trial:
        """The recording with what was left of it turned over at random, group by group."""
        problem = self.host.found.problem
        random = np.random.default_rng([self.host.seed, number])
        sign = random.choice([-1.0, 1.0], problem.count)[problem.group]
        r = problem.recording
        assert r.force is not None
        force = r.force + (sign - 1.0) * self.rest
        return self._judged(Trial(None, 0.0), replace(r, force=force), None)

    def _sought(
        self, twin: Twin, shape: Mapping[str, float], size: float, at: float
    ) -> tuple[Trial, float]:
        """An effect as strong as it must be for a size: to first order, then by refits."""
        rough = self._nearest(twin, shape, size, at, self.injection.beyond, STEPS, CLOSE)
        at = rough[2]
        off, trial, at = self._nearest(twin, shape, size, at, self._refitted, REFITS, REFIT_CLOSE)
        if off > FAR:
            nearest = f"the nearest is {trial.size:.2g}"
            trial = replace(trial, skipped=f"not {size:g} times the noise on this log: {nearest}")
        elif trial.force > self.force:
            much = f"{trial.force:.3g} N rms where the log has {self.force:.3g} N"
            trial = replace(trial, skipped=f"it would be another damper: {much}")
        return trial, at

    def _nearest(
        self, twin: Twin, shape: Mapping[str, float], size: float, at: float,
        beyond: Callable[[Array], Array], steps: int, close: float,
    ) -> tuple[float, Trial, float]:  # fmt: skip
        """What comes nearest to a size, by halves of a bracket and secants: by how much it is off,
        itself, and the logarithm of its strength.

        beyond : (n,) what is not absorbed of a force (n,)
        """
        low, high = log(twin.low), log(twin.high)
        best: tuple[float, Trial, float] | None = None
        for _ in range(steps):
            trial = self._measured(twin, shape, exp(at), size, beyond)
            off = log(max(trial.size, 1e-12) / size)
            if best is None or abs(off) < best[0]:
                best = abs(off), trial, at
            if abs(off) < close or high - low < 1e-3:
                break
            low, high = (low, at) if off > 0.0 else (at, high)
            following = at - off
            at = following if low < following < high else 0.5 * (low + high)
        assert best is not None
        return best

    def _refitted(self, added: Array) -> Array:
        """(n,) what the log's own model does not absorb of a force (n,) when it is fitted again.

        As a diagnosis fits: to the samples of a search first. To all at once, a model whose piston
        slips behind a spring was stuck with three times of what a diagnosis leaves.
        """
        problem, best = self.host.found.problem, self.host.found.selection.best
        whole = replace(problem, block=problem.block._replace(force=problem.block.force + added))
        few = samples_of_search(whole, thresholds.SEARCH_SAMPLES)
        found = self._fit(few, base_starts(best.values))
        return self._fit(whole, [found.values, best.values]).residual - self.rest

    def _fit(self, problem: Problem, starts: Sequence[Mapping[str, float]]) -> Hypothesis:
        """The log's own model fitted to a problem."""
        best = self.host.found.selection.best
        return fit_hypothesis(problem, best.effects, starts, record_effects=best.record_effects)

    def _measured(
        self, twin: Twin, shape: Mapping[str, float], s: float, wanted: float,
        absorbed: Callable[[Array], Array],
    ) -> Trial:  # fmt: skip
        """What an effect of a strength is on this log, of whose force a model absorbs some."""
        added = self.stage.added(twin, s, shape)
        r = self.host.recording
        here = _thinned(replace(r, force=added), self.host.every).force
        assert here is not None
        beyond = absorbed(here)
        weight = self.host.found.problem.block.weight
        energy = float(np.dot(weight, beyond**2))
        local = float(np.sqrt(np.dot(weight, (beyond * self.rest) ** 2) / max(energy, 1e-300)))
        rms = float(np.sqrt(energy / weight.sum()))
        shown = self.stage.parameters(twin, s, shape)
        units = {path.split(".")[1]: unit for path, unit in twin.shows.items()}
        return Trial(
            effect=twin.name,
            wanted=wanted,
            size=rms / local if local > 0.0 else 0.0,
            parameters={symbol: (value, units[symbol]) for symbol, value in shown.items()},
            force=float(np.sqrt(np.dot(weight, here**2) / weight.sum())),
            beyond=rms,
            local=local,
        )

    def _recorded(self, twin: Twin, shape: Mapping[str, float], s: float) -> Recording:
        """The recording as it would be with an effect of a strength."""
        r = self.host.recording
        assert r.force is not None
        force = self.stage.with_effect(twin, s, shape, r.force)
        return _thinned(replace(r, force=force), self.host.every)

    def _judged(self, trial: Trial, recording: Recording, twin: Twin | None) -> Trial:
        """A trial with what the diagnosis says beyond what is there anyway."""
        most = min(1 + len(self.host.again), MOST)
        try:
            found = diagnose(
                recording, catalogue(), given=self.host.given, most=most, limits=False,
                learning=False,
            )  # fmt: skip
        except ErdctlError as problem:
            return replace(trial, skipped=f"cannot be diagnosed: {problem}")
        new = [f for f in found.findings if f.effect.name not in self.host.again]
        said = tuple("/".join([f.effect.name, *f.equivalent]) for f in new)
        named = None
        if twin is not None:
            hidden = HiddenEffect(twin.name, trial.size, right_names(twin.name, twin.equivalents))
            named = any(matches(Found(f.effect.name, f.equivalent), hidden) for f in new)
        return replace(trial, found=named, said=said, verdict=found.verdict.value)


def _thinned(recording: Recording, every: int) -> Recording:
    """One of so many samples; of all where that is one."""
    return recording if every == 1 else thinned(recording, -(-len(recording) // every))
