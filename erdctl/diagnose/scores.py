"""NRMSE of the models of a diagnosis: as given, fitted, with record effects, cross-validated."""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose.hypothesis import Hypothesis
from erdctl.diagnose.problem import Problem
from erdctl.model.composed import Model
from erdctl.model.slots import Values
from erdctl.score.nrmse import Normalise, Validation, validate


def of(problem: Problem, model: Model, values: Values) -> Validation:
    """Of a model with given values, without record effects."""
    return validate(problem.recording, model.force(problem.block.signals, values), Normalise.RANGE)


def carried(problem: Problem, hypothesis: Hypothesis) -> Validation:
    """Of a model with its record effects."""
    modelled: Array = problem.block.force - hypothesis.residual
    return validate(problem.recording, modelled, Normalise.RANGE)


def cross_validated(problem: Problem, hypothesis: Hypothesis) -> Validation:
    """Scores on what the fit left out, of the samples that a problem gives weight."""
    r, rows = problem.recording, np.flatnonzero(problem.block.weight)
    ends = np.searchsorted(rows, r.starts)
    names = [name for name, size in zip(r.names, np.diff(ends), strict=True) if size]
    kept = r.take(rows, np.unique(ends), names)
    return validate(kept, (problem.block.force - hypothesis.cross_validated)[rows], Normalise.RANGE)
