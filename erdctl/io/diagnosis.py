"""The diagnosis as JSON, `"schema": "erdctl.diagnosis/1"`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from msgspec import to_builtins

from erdctl.diagnose.corrected import baseline, parameters
from erdctl.diagnose.diagnosis import Diagnosis
from erdctl.diagnose.findings import Finding
from erdctl.diagnose.learning.stage import LearnedLaw
from erdctl.diagnose.learning.words import law_text
from erdctl.diagnose.residual.localisation import Region
from erdctl.diagnose.unseen import Unseen
from erdctl.diagnose.wording import finding_text, record_values, remaining_text, unseen_text
from erdctl.io.faults import as_fault, sets_in_once
from erdctl.io.parameters import to_document
from erdctl.io.undetected import limits, undetected
from erdctl.io.unlogged import unlogged
from erdctl.model.effect import Effect
from erdctl.model.parameters import Parameters
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
        "cannot_tell": bool(found.cannot_tell),
        "noise_rms": found.noise_rms,
        "baseline": {
            **_scores(found.baseline),
            "of": FITTED if found.given is None else GIVEN,
            "params": to_builtins(to_document(baseline(found))),
        },
        **({} if found.given is None else {"refitted": _scores(found.refitted)}),
        "mismatch": [
            {"where": _where(r), "share": r.share, "time": r.time, "text": r.text}
            for r in found.mismatch
        ],
        "findings": [_finding(f, corrected) for f in found.findings],
        **_learned(found, corrected),
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
        "unseen": [_unseen(u) for u in found.unseen],
        **({} if not found.withdrawn else {"withdrawn": [e.name for e in found.withdrawn]}),
        "remaining": {
            "rms": found.carried.overall.rms,
            "over_noise": found.carried.overall.rms / found.noise_rms if found.noise_rms else 1.0,
            "misfit_rms": found.lack_of_fit.misfit_rms,
            **unlogged(found),
            "text": remaining_text(found),
        },
        **_records(found),
        **sets_in_once(found),
        **as_fault(found),
        "rig": found.rig.to_json(),
        "not_testable": found.untestable,
        "undetected": undetected(found.undetected),
        "limits": limits(found.undetected),
        "provenance": origin,
    }


def _unseen(u: Unseen) -> dict[str, Any]:
    return {
        "left_out": u.left.value,
        "parts": u.parts,
        "records": list(u.names),
        "seen_by_search": not u.never_seen,
        "nrmse_before": u.before,
        "nrmse_after": u.after,
        "text": unseen_text(u),
    }


def _records(found: Diagnosis) -> dict[str, Any]:
    """Per record, apart from the shared parameters; and the scores when both are used."""
    values = record_values(found)
    return {"records": values, "with_records": _scores(found.carried)} if values else {}


def _finding(f: Finding, corrected: Parameters) -> dict[str, Any]:
    return {
        "effect": f.effect.name,
        "equivalent": list(f.equivalent),
        "text": finding_text(f),
        "equation": f.effect.equation,
        "source": f.effect.source,
        "parameters": _parameters(f.effect, corrected),
        "where": None if f.where is None else _where(f.where),
        **_worth(f),
    }


def _parameters(effect: Effect, corrected: Parameters) -> dict[str, Any]:
    def value(symbol: str) -> dict[str, Any]:
        e = corrected.estimates[effect.key(symbol)]
        bound = {"at_bound": True} if e.at_bound else {}
        ends = {"interval": list(e.within)} if e.within else {}
        why = {} if e.reason is None else {"assumed": e.assumed, "reason": e.reason}
        return {"value": e.value, "unit": e.unit, "stderr": e.stderr, **bound, **ends, **why}

    return {q.symbol: value(q.symbol) for q in effect.quantities}


def _learned(found: Diagnosis, corrected: Parameters) -> dict[str, Any]:
    """Laws that the catalogue does not hold; nothing where none was learned."""
    if found.learned is None:
        return {}
    return {"learned": [_law(f, corrected) for f in found.learned.laws]}


def _law(f: LearnedLaw, corrected: Parameters) -> dict[str, Any]:
    curve, worth = f.law.curve, f.finding
    return {
        "slot": f.law.slot.value,
        "coordinates": [
            {
                "name": axis.coordinate,
                "unit": axis.kind.unit,
                "low": axis.range[0],
                "high": axis.range[1],
            }
            for axis in curve.axes
        ],
        "form": curve.form or "spline",
        "equation": f"{f.law.equation}, {f.law.where}",
        "text": law_text(f),
        "parameters": _parameters(worth.effect, corrected),
        "curve": {
            **{name: z.tolist() for name, z in zip("zy", f.z, strict=False)},
            "f": f.f.tolist(),
            "unit": f.law.unit,
        },
        **_worth(worth),
        "equivalent": [
            {"slot": a.slot.value, "coordinates": [axis.coordinate for axis in a.curve.axes]}
            for a in f.alike
        ],
    }


def _worth(f: Finding) -> dict[str, Any]:
    """What a finding gains on what its fits have not seen, and what would decide it."""
    out: dict[str, Any] = {
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
        "nrmse_by_duty": [
            {"duty": d, "nrmse": s.nrmse, "rms": s.rms} for d, s in v.by_duty.items()
        ],
        "rms": v.overall.rms,
    }
