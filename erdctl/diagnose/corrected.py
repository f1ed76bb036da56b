"""Parameters that a diagnosis ends with: of the corrected model, and of the one to answer for."""

from __future__ import annotations

from erdctl.diagnose.diagnosis import Diagnosis
from erdctl.estimate.covariance import confounded, estimates
from erdctl.model.parameters import Estimate, Parameters, provenance


def parameters(found: Diagnosis) -> Parameters:
    """The corrected model's parameters, with errors."""
    reasons = confounded(found.fit)
    reasons |= {name: lack.reason for name, lack in found.problem.needs.items()}
    return Parameters(
        model=found.fit.model,
        estimates=estimates(found.fit, reasons),
        provenance=provenance(found.problem.recording, found.noise_rms, found.rig.to_json()),
        fits={"method": "diagnose"},
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
