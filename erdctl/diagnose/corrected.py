"""Parameters that a diagnosis ends with: of the corrected model, and of the one to answer for."""

from __future__ import annotations

from erdctl.diagnose.diagnosis import Diagnosis
from erdctl.estimate.covariance import estimates, lower_correlation
from erdctl.estimate.finer import MOST_SAMPLES
from erdctl.model.parameters import Estimate, Parameters, provenance


def parameters(found: Diagnosis) -> Parameters:
    """The corrected model's parameters, with errors."""
    # Under few conditions an interval holds in the model that is named, which may be another.
    best = (found.learned or found).selection.best
    few = f"at {found.cannot_tell} other effects, with other values, explain the log as well"
    reasons = dict.fromkeys(found.fit.values, few) if found.cannot_tell and found.findings else {}
    reasons |= {name: lack.reason for name, lack in best.problem.needs.items()}
    said = "a learned law over the duty says it as well: it keeps the value from before"
    reasons |= dict.fromkeys(found.fit.model.said_by_effects, said)
    told = estimates(found.fit, reasons)
    return Parameters(
        model=found.fit.model,
        estimates=told,
        provenance=provenance(found.problem.recording, found.noise_rms, found.rig.to_json()),
        fits={"method": "diagnose", "correlation": lower_correlation(found.fit, told)},
        warnings=_remarks(found),
    )


def _remarks(found: Diagnosis) -> tuple[str, ...]:
    samples, effects = len(found.problem.recording), found.fit.model.effects
    by_slopes = (
        "the intervals of effects are by the slopes of the force, and by no profile of the cost"
    )
    if any(e.smooth for e in effects):
        return (f"beside a curve that was learned {by_slopes}",)
    if samples <= MOST_SAMPLES or not effects:
        return ()
    return (
        f"a log of {samples} samples: {by_slopes}, which is followed up to {MOST_SAMPLES} samples",
    )


def baseline(found: Diagnosis) -> Parameters:
    """The parameters of the model to answer for: those given, or the paper's as fitted here."""
    if found.given is not None:
        return found.given
    base = found.selection.base
    estimates = {
        name: Estimate(value=base.values[name], unit=q.unit)
        for name, q in base.model.quantities.items()
    }
    return Parameters(model=base.model, estimates=estimates)
