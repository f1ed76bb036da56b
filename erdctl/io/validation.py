"""A validation as JSON, `"schema": "erdctl.validation/1"`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from erdctl.bench.unknown_direction import UnknownDirection
from erdctl.score.nrmse import Score, Validation

SCHEMA = "erdctl.validation/1"


def to_json(
    found: Validation,
    labels: Mapping[str, str],
    rig: Sequence[Mapping[str, Any]] = (),
    unknown: UnknownDirection | None = None,
) -> dict[str, Any]:
    """The document of a validation.

    labels : of the test, see `Recording`;  rig : what is wrong with the recording
    unknown : what lies where the direction of motion is not told
    """

    def score(s: Score) -> dict[str, float]:
        return {"nrmse": s.nrmse, "rms": s.rms, "samples": s.samples}

    return {
        "schema": SCHEMA,
        "normalise": found.normalise.value,
        **score(found.overall),
        "nrmse_by_duty": [{"duty": d, **score(s)} for d, s in found.by_duty.items()],
        "nrmse_by_direction": [{"direction": d, **score(s)} for d, s in found.by_direction.items()],
        "nrmse_by_record": [{"record": r, **score(s)} for r, s in found.by_record.items()],
        **({} if unknown is None else {"direction_unknown": _unknown(unknown, found.overall)}),
        "rig": [*rig],
        **({"provenance": dict(labels)} if labels else {}),
    }


def _unknown(of: UnknownDirection, all_samples: Score) -> dict[str, float]:
    return {
        "samples": of.samples,
        "squared_error": of.squares,
        "nrmse_of_others": all_samples.nrmse * of.others,
    }
