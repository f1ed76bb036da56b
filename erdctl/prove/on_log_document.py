"""What was hidden in a user's own recording: `"schema": "erdctl.proof-on/1"`, and tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final, Literal, TypedDict

import msgspec

from erdctl.core.version import __version__
from erdctl.prove.on_log import Host, Trial
from erdctl.prove.tables import Table
from erdctl.report.readable import number, with_unit

SCHEMA: Final = "erdctl.proof-on/1"


class AddedParameter(TypedDict):
    """A parameter of what was hidden, SI."""

    value: float
    unit: str


class TrialDocument(TypedDict):
    """One diagnosis with something hidden in the log.

    wanted, size : rms of what the model cannot absorb of the added force, over the noise where it
    acts, as asked and as reached;  force_rms, beyond_rms, local_noise_rms : of all that was added,
    of what cannot be absorbed, and of that noise [N];  found : null where it was not diagnosed, for
    the reason in `skipped`;  said : names beyond those that are there anyway
    """

    effect: str
    wanted: float
    size: float
    parameters: dict[str, AddedParameter]
    force_rms: float
    beyond_rms: float
    local_noise_rms: float
    found: bool | None
    said: list[str]
    verdict: str
    skipped: str | None


class NullDocument(TypedDict):
    """One diagnosis with nothing hidden, what was left turned over at random by groups."""

    said: list[str]
    verdict: str


class Share(TypedDict):
    """How many of some trials, at one size; 0 is nothing hidden."""

    size: float
    found: int
    of: int


class FoundFrom(TypedDict):
    """The smallest size from which an effect is found in every larger one, if in any."""

    effect: str
    size: float | None
    parameters: dict[str, AddedParameter]
    force_rms: float | None


class HidingSummary(TypedDict):
    """By effect, by size, and what was named when nothing was hidden."""

    effects: list[FoundFrom]
    sizes: list[Share]
    nulls: Share


class ProofOnFile(TypedDict):
    """The document.

    thin : one of so many samples was used;  named : what the log's own diagnosis names;  again :
    what another names that answers for the model so corrected
    """

    schema: Literal["erdctl.proof-on/1"]
    erdctl: str
    logs: list[dict[str, str]]
    thin: int
    seed: int
    verdict: str
    noise_rms: float
    rest_rms: float
    named: list[str]
    again: list[str]
    trials: list[TrialDocument]
    nulls: list[NullDocument]
    summary: HidingSummary


def json_schema() -> dict[str, Any]:
    """The published JSON Schema."""
    return msgspec.json.schema(ProofOnFile)


def to_json(host: Host, trials: Sequence[Trial]) -> ProofOnFile:
    """The document; what follows from the trials is in it too."""
    hidden = [t for t in trials if t.effect is not None]
    nulls = [t for t in trials if t.effect is None and t.skipped is None]
    return {
        "schema": SCHEMA,
        "erdctl": __version__,
        "logs": [{"name": s.name, "sha256": s.sha256} for s in host.recording.sources],
        "thin": host.every,
        "seed": host.seed,
        "verdict": host.found.verdict.value,
        "noise_rms": host.found.noise_rms,
        "rest_rms": host.found.carried.overall.rms,
        "named": [f.effect.name for f in host.found.findings],
        "again": list(host.again),
        "trials": [_trial(t) for t in hidden],
        "nulls": [{"said": list(t.said), "verdict": t.verdict} for t in nulls],
        "summary": {
            "effects": [_found_from(n, hidden) for n in _names(hidden)],
            "sizes": [_share(s, [t for t in hidden if t.wanted == s]) for s in _sizes(hidden)],
            "nulls": {"size": 0.0, "found": sum(bool(t.said) for t in nulls), "of": len(nulls)},
        },
    }


def tables(trials: Sequence[Trial]) -> Iterator[Table]:
    """From which size each effect is found, how many of each size are, and what nothing gives."""
    hidden = [t for t in trials if t.effect is not None]
    sizes = _sizes(hidden)
    rows = []
    for name in _names(hidden):
        of = {t.wanted: t for t in hidden if t.effect == name}
        first = _first(name, hidden)
        shown = "-" if first is None else _parameters(first)
        force = "-" if first is None else with_unit(first.force, "N", 2)
        rows.append([name, *(_cell(of.get(s)) for s in sizes), shown, force])
    if rows:
        heads = [f"{s:g} x noise" for s in sizes]
        yield (
            "Effects hidden in this log, by what the model cannot absorb of them over the noise"
            " where they act",
            ["", *heads, "found from", "its force, rms"],
            rows,
        )
    shares = [_share(s, [t for t in hidden if t.wanted == s]) for s in sizes]
    nulls = [t for t in trials if t.effect is None and t.skipped is None]
    rows = [[f"{s['size']:g} x noise", *_counts(s["found"], s["of"])] for s in shares if s["of"]]
    if nulls:
        rows.append(["nothing", *_counts(sum(bool(t.said) for t in nulls), len(nulls))])
    if rows:
        yield "Named, by what was hidden", ["hidden", "named", "of", ""], rows
    skipped: dict[tuple[str, str], list[str]] = {}
    for t in trials:
        if t.skipped:
            skipped.setdefault((t.effect or "nothing", t.skipped), []).append(f"{t.wanted:g}")
    rows = [[name, " ".join(at), why] for (name, why), at in skipped.items()]
    if rows:
        yield "Not hidden", ["", "x noise", "why"], rows


def line(trial: Trial) -> str:
    """One trial in a line."""
    said = " + ".join(trial.said) or "-"
    if trial.effect is None:
        return f"nothing hidden  said: {said}  {trial.verdict}"
    hidden = f"{trial.effect} {trial.wanted:g} x noise"
    if trial.skipped:
        return f"{hidden}  not hidden: {trial.skipped}"
    return (
        f"{hidden}, {_parameters(trial)}  said: {said}  found {'yes' if trial.found else 'no'}"
        f"  {trial.verdict}"
    )


def _trial(t: Trial) -> TrialDocument:
    return {
        "effect": str(t.effect), "wanted": t.wanted, "size": t.size,
        "parameters": _values(t), "force_rms": t.force, "beyond_rms": t.beyond,
        "local_noise_rms": t.local, "found": t.found, "said": list(t.said), "verdict": t.verdict,
        "skipped": t.skipped,
    }  # fmt: skip


def _values(t: Trial) -> dict[str, AddedParameter]:
    return {n: {"value": value, "unit": unit} for n, (value, unit) in t.parameters.items()}


def _found_from(name: str, hidden: Sequence[Trial]) -> FoundFrom:
    t = _first(name, hidden)
    if t is None:
        return {"effect": name, "size": None, "parameters": {}, "force_rms": None}
    return {"effect": name, "size": t.wanted, "parameters": _values(t), "force_rms": t.force}


def _first(name: str, hidden: Sequence[Trial]) -> Trial | None:
    """The smallest trial of an effect that was found, as was every larger one."""
    out = None
    for t in sorted((t for t in hidden if t.effect == name), key=lambda t: -t.wanted):
        if t.skipped:
            continue
        if not t.found:
            break
        out = t
    return out


def _share(size: float, trials: Sequence[Trial]) -> Share:
    known = [t for t in trials if t.found is not None]
    return {"size": size, "found": sum(bool(t.found) for t in known), "of": len(known)}


def _names(hidden: Sequence[Trial]) -> list[str]:
    return list(dict.fromkeys(str(t.effect) for t in hidden if t.found is not None))


def _sizes(hidden: Sequence[Trial]) -> list[float]:
    return sorted({t.wanted for t in hidden})


def _cell(trial: Trial | None) -> str:
    if trial is None or trial.found is None:
        return "-"
    return "yes" if trial.found else "no"


def _counts(found: int, of: int) -> list[str]:
    return [str(found), str(of), f"{100 * found / of:.0f} %" if of else "-"]


def _parameters(trial: Trial) -> str:
    values = (f"{n} {with_unit(v, unit, 2)}" for n, (v, unit) in trial.parameters.items())
    return ", ".join(values) or number(trial.size, 2)
