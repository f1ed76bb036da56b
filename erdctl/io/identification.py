"""An identification as parameters that travel: values of the chosen fit, origin, both fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Recording
from erdctl.estimate.covariance import lower_correlation
from erdctl.estimate.identify import Identification
from erdctl.estimate.method import Method
from erdctl.model.parameters import Parameters, provenance


def parameters_of(
    found: Identification,
    method: Method,
    recording: Recording,
    rig: Sequence[Mapping[str, Any]] = (),
) -> Parameters:
    """The parameters of one of the two fits, with both as a record of where they come from.

    rig : what was found wrong with the recording, as `Rig.to_json` gives it

    Raises InputProblem if the paper's procedure cannot give them all from these logs.
    """
    estimates = dict(found.joint)
    if method is Method.TWO_STEP:
        for name, e in estimates.items():
            if e.identified and name not in found.two_step:
                raise InputProblem(
                    f"the paper's procedure cannot give {name} from these logs (too little"
                    " null-control data?); use --method joint"
                )
            if e.identified:
                value = found.two_step[name]
                estimates[name] = replace(e, value=value, stderr=None, at_bound=False, within=None)
    fits: dict[str, Any] = {
        "joint": {
            "rms": found.fit.rms,
            "samples": found.fit.samples,
            "evaluations": found.fit.evaluations,
            "converged": found.fit.converged,
        },
        "two_step": {"rms": found.two_step_rms, "values": dict(found.two_step)},
        "method": method.value,
    }
    if method is Method.JOINT:
        fits["correlation"] = lower_correlation(found.fit, estimates)
    return Parameters(
        model=found.model,
        estimates=estimates,
        provenance=provenance(recording, found.noise_rms, rig),
        fits=fits,
        warnings=found.warnings,
    )


def residual_of(fits: Mapping[str, Any]) -> str:
    """How many samples were fitted, and what the fit that was written leaves of them.

    fits : of parameters that `parameters_of` gave
    """
    samples = f"{fits['joint']['samples']} samples"
    if fits["method"] == Method.JOINT.value:
        return f"{samples}, residual {fits['joint']['rms']:.4g} N rms"
    rms = fits["two_step"]["rms"]
    left = "" if rms is None else f", residual {rms:.4g} N rms"
    return f"{samples} by the paper's steps{left}"
