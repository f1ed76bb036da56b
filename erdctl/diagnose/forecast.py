"""What a test would show: from which size each effect, under the paper's model and a given noise.

The drive of a log, or of one that is only planned; the force is that of the model with white noise,
and what is asked of it is what a diagnosis asks of what it could have missed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from erdctl.bench.excitation import Survey
from erdctl.bench.identifiability import untestable
from erdctl.bench.inspection import force_noise
from erdctl.core.blocks import thinned
from erdctl.core.errors import UsageProblem
from erdctl.core.progress import Progress, part_of
from erdctl.core.recording import Recording
from erdctl.core.signals import Signals
from erdctl.diagnose import thresholds
from erdctl.diagnose.detectable import Detectable, detectable
from erdctl.diagnose.hypothesis import Hypothesis, fit_hypothesis
from erdctl.diagnose.problem import prepare
from erdctl.estimate.starts import fresh_start
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters


@dataclass(frozen=True)
class Forecast:
    """From which size each effect would show.

    noise : of the force, white, rms [N]
    """

    noise: float
    effects: tuple[Detectable, ...]


def forecast(
    recording: Recording,
    candidates: Sequence[Effect],
    *,
    parameters: Parameters | None = None,
    noise: float | None = None,
    seed: int = 0,
    progress: Progress = lambda stage, what: None,
) -> Forecast:
    """What the drive of a recording would show.

    parameters : of the damper; where there are none the paper's model is fitted to the force
    noise : rms [N], of the force at the samples; where it is not given that of the force
    Raises UsageProblem where a drive without force leaves either open.
    """
    if recording.force is None and (parameters is None or noise is None):
        raise UsageProblem("a forecast for a log without force needs --params FILE and --noise N")
    if noise is None:
        floor = force_noise(recording)
        noise = 0.0 if floor is None else floor.rms
    # On the samples that a search would look at: what acts within a step depends on the step.
    thin = thinned(recording, thresholds.SEARCH_SAMPLES)
    signals = Signals.of(thin)
    progress("forecast", part_of("the model", 1, 1))
    if parameters is None:
        model, values = (fitted := _fitted(thin)).model, fitted.values
    else:
        model, values = parameters.model, parameters.values
    random = np.random.default_rng(seed)
    force = model.force(signals, values) + noise * random.standard_normal(len(thin))
    problem = prepare(replace(thin, force=force))
    best = fit_hypothesis(problem, model.effects, [values], thresholds.STEPS_AGAIN)
    survey = Survey.of(thin)
    found = detectable(problem, best, candidates, untestable(survey, candidates), progress)
    return Forecast(noise, found)


def _fitted(recording: Recording) -> Hypothesis:
    starts = [fresh_start(*thresholds.FRESH), fresh_start(*thresholds.FRESH_SECOND)]
    return fit_hypothesis(prepare(recording), (), starts)
