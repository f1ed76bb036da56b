"""`erdctl.effects`."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from erdctl.effects import candidates
from erdctl.interface.display import frame_of, html, option, text
from erdctl.interface.log import Place
from erdctl.io import documents
from erdctl.io.catalogue import facts_of
from erdctl.model.effect import Effect

if TYPE_CHECKING:
    import pandas as pd

FACTS = (
    "name", "stage", "title", "equation", "source", "validity", "needs", "shows", "equivalent",
)  # fmt: skip
PARAMETERS = ("effect", "symbol", "unit", "title", "low", "high", "off")


@dataclass(frozen=True, eq=False, repr=False)
class Catalogue:
    """Physical effects beyond the paper's model; what `erdctl.effects` gives."""

    chosen: tuple[Effect, ...]

    def __len__(self) -> int:
        return len(self.chosen)

    def to_dict(self) -> list[dict[str, Any]]:
        """The document of `erdctl effects --json`: a list with a dict for each effect."""
        found: list[dict[str, Any]] = documents.plain([facts_of(e) for e in self.chosen])
        return found

    def table(self, of: Literal["effects", "parameters"] = "effects") -> pd.DataFrame:
        """One row an effect, with equation and source.

        of : "parameters" has a row for each parameter instead: symbol, SI unit, bounds, and the
            value at which the effect is absent
        """
        option(of, ("effects", "parameters"), "of")
        facts = self.to_dict()
        if of == "effects":
            return frame_of([{k: f[k] for k in FACTS} for f in facts], FACTS)
        rows = [{"effect": f["name"], **p} for f in facts for p in f["parameters"]]
        return frame_of(rows, PARAMETERS)

    def write(self, path: Place) -> None:
        """Write the document as JSON, as `erdctl effects --json` prints it."""
        documents.write([facts_of(e) for e in self.chosen], os.fspath(path))

    def __repr__(self) -> str:
        if len(self.chosen) > 1:
            rows = [f"{e.name:27} {e.stage.value:9} {e.title}" for e in self.chosen]
            return "\n  ".join([f"Catalogue: {len(self)} effects", *rows])
        effect = self.chosen[0]
        quantities = [
            f"{q.symbol} [{q.unit}] {q.title}, {q.low:g} to {q.high:g}, off at {q.off:g}"
            for q in effect.quantities
        ]
        lines = [effect.equation, *quantities, f"source: {effect.source}"]
        return text(f"Catalogue: {effect.name}, {effect.title}", lines)

    def _repr_html_(self) -> str:
        if len(self.chosen) > 1:
            shown = self.table()[["name", "stage", "title", "equation"]]
            return html(f"{len(self)} effects", shown)
        effect = self.chosen[0]
        lines = [effect.equation, f"source: {effect.source}"]
        return html(f"{effect.name}: {effect.title}", self.table("parameters"), lines)


def effects(name: str | None = None) -> Catalogue:
    """The catalogue of physical effects beyond the paper's model, or one of them.

    name : of one effect, e.g. "backlash"; all without it

    Returns a Catalogue: `.table()` a row for each effect, with equation and source;
    `.table("parameters")` their parameters with SI units and bounds; `.to_dict()` the list that
    `erdctl effects --json` prints.

    Raises UsageProblem, with the names there are, for one that the catalogue has not.

    Example:
        erdctl.effects("input_delay")
    """
    return Catalogue(candidates(() if name is None else (name,)))
