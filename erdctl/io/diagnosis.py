"""The diagnosis as JSON, `"schema": "erdctl.diagnosis/1"`."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from msgspec import to_builtins

from erdctl.diagnose.diagnosis import Diagnosis, Finding, Verdict
from erdctl.diagnose.residual.localisation import Region
from erdctl.diagnose.residual.resemblance import resemblance
from erdctl.io.parameters import provenance, to_document
from erdctl.model.parameters import Estimate, Parameters
from erdctl.score.nrmse import Validation

SCHEMA = "erdctl.diagnosis/1"
FITTED = "the paper's model, fitted to these logs"
GIVEN = "the given parameters as they are"


def to_json(found: Diagnosis, file: Mapping[str, str] | None = None) -> dict[str, Any]:
    """The document of a diagnosis; `file` says where given parameters came from."""
    corrected = parameters(found)
    origin = dict(corrected.provenance)
    if found.given is not None:
        names = [e.name for e in found.given.model.effects]
        origin["params"] = {**(file or {}), "effects": names}
    return {
        "schema": SCHEMA,
        "verdict": found.verdict.value,
        "noise_rms": found.noise_rms,
        "baseline": {
            **_scores(found.baseline),
            "of": FITTED if found.given is None else GIVEN,
            "params": to_builtins(to_document(baseline(found))),
        },
        **({} if found.given is None else {"refitted": _scores(found.refitted)}),
        "mismatch": [
            {"where": _where(r), "share": r.share, "text": r.text} for r in found.mismatch
        ],
        "findings": [_finding(f, corrected) for f in found.findings],
        "corrected": {
            **_scores(found.corrected),
            "params": to_builtins(to_document(corrected)),
        },
        "heldout": {
            "groups": found.problem.count,
            **{
                k: _scores(v)
                for k, v in zip(("before", "after"), found.cross_validated, strict=True)
            },
        },
        "remaining": {
            "rms": found.carried.overall.rms,
            "over_noise": found.carried.overall.rms / found.noise_rms if found.noise_rms else 1.0,
            "misfit_rms": found.lack_of_fit.misfit_rms,
            "text": remaining_text(found),
        },
        **_records(found),
        "not_testable": found.untestable,
        "provenance": origin,
    }


def parameters(found: Diagnosis) -> Parameters:
    """The corrected model's parameters, with errors."""
    errors = found.fit.stderr
    values = found.fit.values
    estimates = {}
    for name, q in found.fit.model.quantities.items():
        need = found.problem.needs.get(name)
        if need is None:
            estimates[name] = Estimate(value=values[name], unit=q.unit, stderr=errors.get(name))
        else:
            estimates[name] = Estimate(
                value=None, unit=q.unit, assumed=values[name], reason=need.reason
            )
    return Parameters(
        model=found.fit.model,
        estimates=estimates,
        provenance=provenance(found.problem.recording, found.noise_rms),
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


def finding_text(finding: Finding) -> str:
    """One finding in words."""
    e = finding.effect
    text = (
        f"{e.title}: leaving it out costs {100 * finding.gain.gain:.0f} % of the mean square error"
        f" on data that the fit had not seen (NRMSE {finding.before:.4f} without it,"
        f" {finding.after:.4f} with it)"
    )
    if finding.where is not None:
        text += f"; {finding.where.text.replace('the misfit', 'its force')}"
    if finding.equivalent:
        text += f"; these data cannot tell it from {' or '.join(finding.equivalent)}"
    if finding.test is not None:
        text += (
            f"; to tell it from {finding.test.against}, record --drive {finding.test.drive}, where"
            f" they differ by {finding.test.difference:.3g} N rms"
        )
    return text


def remaining_text(found: Diagnosis) -> str:
    """What is left, in words."""
    left = found.lack_of_fit
    if found.verdict is not Verdict.UNEXPLAINED:
        return (
            f"what remains, {found.carried.overall.rms:.3g} N rms, holds nothing that motion,"
            " duty, time or energy would predict: measurement noise"
        )
    words = (
        f"{left.misfit_rms:.3g} N rms beyond a noise of {left.noise_rms:.3g} N can be predicted"
        " from motion and duty, but by no effect in the catalogue"
    )
    if left.spectral_line is not None:
        words += (
            f"; {100 * left.spectral_line.share:.0f} % of it swings at {left.spectral_line.frequency:.3g} Hz and"
            " turns over with the motion, as a ripple of the yield force does"
        )
    if left.impulses > 0.0:
        words += (
            f"; {100 * left.impulses:.0f} % of it comes in sudden jumps, as of a seal that sticks and"
            " slips, a joint that knocks or a valve that opens"
        )
    resembles = resemblance(found.selection.best.problem, left.predicted)
    if resembles is not None:
        words += f"; it is most like {resembles.form} (correlation {resembles.correlation:+.2f})"
    return f"{words}; {found.mismatch[0].text}" if found.mismatch else words


def record_values(found: Diagnosis) -> list[dict[str, Any]]:
    """Gain and offset of each record, as far as they were free; no error where undetermined."""
    free, record_effects = found.problem.free, found.record_effects
    if record_effects is None:
        return []

    def value(number: float, unit: str, error: float) -> dict[str, Any]:
        return {"value": number, "unit": unit, "stderr": error if isfinite(error) else None}

    out = []
    for i, name in enumerate(found.problem.recording.names):
        entry: dict[str, Any] = {"name": name}
        if free.gain:
            entry["gain"] = value(
                float(record_effects.gain[i]), "1", float(record_effects.gain_error[i])
            )
        if free.offset:
            entry["offset"] = value(
                float(record_effects.offset[i]), "N", float(record_effects.offset_error[i])
            )
        out.append(entry)
    return out


def _records(found: Diagnosis) -> dict[str, Any]:
    """Per record, apart from the shared parameters; and the scores when both are used."""
    values = record_values(found)
    return {"records": values, "with_records": _scores(found.carried)} if values else {}


def _finding(f: Finding, corrected: Parameters) -> dict[str, Any]:
    def value(symbol: str) -> dict[str, Any]:
        e = corrected.estimates[f.effect.key(symbol)]
        return {"value": e.value, "unit": e.unit, "stderr": e.stderr}

    out: dict[str, Any] = {
        "effect": f.effect.name,
        "equivalent": list(f.equivalent),
        "text": finding_text(f),
        "equation": f.effect.equation,
        "source": f.effect.source,
        "parameters": {q.symbol: value(q.symbol) for q in f.effect.quantities},
        "where": None if f.where is None else _where(f.where),
        "evidence": {
            "gain_unseen": f.gain.gain,
            "gain_over_scatter": f.gain.t_stretches,
            "gain_over_scatter_of_groups": f.gain.t_groups,
            "runner_up": f.runner_up,
        },
        "heldout": {"nrmse_before": f.before, "nrmse_after": f.after},
    }
    if f.test is not None:
        out["test"] = {"drive": f.test.drive, "difference": f.test.difference, "unit": "N",
                       "against": f.test.against}  # fmt: skip
    return out


def _where(region: Region) -> dict[str, Any]:
    return {"variable": region.variable.value, "low": region.low, "high": region.high}


def _scores(v: Validation) -> dict[str, Any]:
    return {
        "nrmse": v.overall.nrmse,
        "nrmse_by_duty": [{"duty": d, "nrmse": s.nrmse} for d, s in v.by_duty.items()],
        "rms": v.overall.rms,
    }
