"""The proof as JSON, `"schema": "erdctl.proof/1"`: one record a case, and the summary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

import msgspec

from erdctl.core.version import __version__
from erdctl.prove.case import Wish
from erdctl.prove.judge import Failed, Result
from erdctl.prove.run import Outcome
from erdctl.prove.summary import Summary, summarise

SCHEMA = "erdctl.proof/1"
DERIVED = ("nrmse_paper", "nrmse_corrected", "nrmse_best", "removed")  # added to a case


@dataclass(frozen=True)
class Proof:
    """Everything that a run gave; the same seeds and wishes give the same, so no dates."""

    schema: str
    erdctl: str
    seed: int
    cases: int
    wish: Wish
    results: tuple[Result, ...]
    failed: tuple[Failed, ...]

    @property
    def summary(self) -> Summary:
        """Figures of all cases."""
        return summarise(self.results, self.failed)


def proof_of(wish: Wish, seeds: Sequence[int], outcomes: Sequence[Outcome]) -> Proof:
    """The proof that some outcomes make."""
    results = tuple(o for o in outcomes if isinstance(o, Result))
    failed = tuple(o for o in outcomes if isinstance(o, Failed))
    return Proof(SCHEMA, __version__, seeds[0], len(seeds), wish, results, failed)


class ProofFile(TypedDict):
    """The document: what a run gave, and what follows from it."""

    schema: Literal["erdctl.proof/1"]
    erdctl: str
    seed: int
    cases: int
    wish: Wish
    results: list[Result]
    failed: list[Failed]
    summary: Summary


def json_schema() -> dict[str, Any]:
    """The published JSON Schema of a proof."""
    schema = msgspec.json.schema(ProofFile)
    added = {name: {"type": ["number", "null"]} for name in DERIVED}
    schema["$defs"]["Errors"]["properties"] |= added
    return schema


def to_json(proof: Proof) -> dict[str, Any]:
    """The document. What follows from the results is in it too, for readers without erdctl."""
    document: dict[str, Any] = msgspec.to_builtins(proof)
    for raw, result in zip(document["results"], proof.results, strict=True):
        errors = result.fresh
        figures = (
            *map(errors.nrmse, (errors.paper, errors.corrected, errors.best)),
            errors.removed,
        )
        raw["fresh"] |= dict(zip(DERIVED, figures, strict=True))
    return document | {"summary": msgspec.to_builtins(proof.summary)}


def from_json(document: dict[str, Any]) -> Proof:
    """The proof of a document; what follows from the results is computed anew."""
    return msgspec.convert(document, Proof)
