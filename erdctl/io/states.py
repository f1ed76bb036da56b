"""Parameter files and diagnoses as rows of a campaign's table, so that all are compared alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any

import msgspec
import numpy as np
import pyarrow as pa

from erdctl.compare.history import Covariance
from erdctl.core.errors import InputProblem, UsageProblem
from erdctl.effects import get, names
from erdctl.io import documents
from erdctl.io.campaign_in import LEARNED
from erdctl.io.campaign_table import SCHEMA as TABLE
from erdctl.io.diagnosis import SCHEMA as DIAGNOSIS
from erdctl.io.parameters import SCHEMA as PARAMETERS
from erdctl.io.parameters import parse_parameters
from erdctl.io.undetected import Limit
from erdctl.model.parameters import Parameters

PARQUET = b"PAR1"
Row = dict[str, Any]


class _Scored(msgspec.Struct):
    nrmse: float | None = None


class _CorrectedIn(msgspec.Struct):
    params: dict[str, Any]


class DiagnosisIn(msgspec.Struct):
    """What `compare` reads of a diagnosis."""

    schema: str
    verdict: str
    corrected: _CorrectedIn
    baseline: _Scored = msgspec.field(default_factory=_Scored)
    noise_rms: float | None = None
    limits: dict[str, Limit] = {}


@dataclass(frozen=True, eq=False)
class Inputs:
    """All that is compared: one table, covariances by log, and whether it is of documents alone."""

    table: pa.Table
    covariances: dict[str, Covariance]
    documents: bool


@dataclass(frozen=True, eq=False)
class _State:
    """A parameter file, or what a diagnosis says; common : to all its rows."""

    parameters: Parameters
    common: Row
    diagnosis: DiagnosisIn | None = None


Refit = Callable[[dict[str, Parameters]], dict[str, Parameters]]


def read_inputs(paths: Sequence[str], refit: Refit | None = None) -> Inputs:
    """Campaign tables, parameter files and diagnoses, told apart by content; `-` is stdin.

    refit : gives other parameters in the place of those of the files
    Raises UsageProblem for a file given twice or not there, InputProblem for one that is neither.
    """
    from erdctl.io.campaign_in import as_declared, campaign_table

    twice = [p for p in paths if list(paths).count(p) > 1]
    if twice:
        raise UsageProblem(f"{twice[0]} is given twice")
    tables, states = [], dict[str, _State]()
    for path in paths:
        data = documents.read_bytes(path)
        name = "stdin" if path == "-" else path
        if data[:4] == PARQUET:
            tables.append(as_declared(campaign_table(data, name), name))
            continue
        states[name] = _state(data, name)
    if refit is not None:
        if tables:
            raise UsageProblem("--refit takes parameter files and diagnoses, not campaign tables")
        again = refit({name: state.parameters for name, state in states.items()})
        states = {name: replace(state, parameters=again[name]) for name, state in states.items()}
    rows, covariances = list[Row](), dict[str, Covariance]()
    for name, state in states.items():
        some, covariance = _rows(state.parameters, state.common)
        rows += some
        if state.diagnosis is not None:
            told = {row["parameter"] for row in some}
            limits = _limits(state.diagnosis, some[0])
            rows += [row for row in limits if row["parameter"] not in told]
        if covariance is not None:
            covariances[name] = covariance
    if rows:
        rows = _one_damper(rows)
        columns = {f.name: [row.get(f.name) for row in rows] for f in TABLE}
        tables.append(pa.table(columns, schema=TABLE))
    return Inputs(pa.concat_tables(tables), covariances, len(tables) == bool(rows))


def _one_damper(rows: list[Row]) -> list[Row]:
    """Files that name no damper are taken to be of one."""
    if any(row["damper"] for row in rows):
        return rows
    return [{**row, "damper": "the damper"} for row in rows]


def _state(data: bytes, name: str) -> _State:
    raw = documents.parsed(data, name)
    schema = raw.get("schema") if isinstance(raw, dict) else None
    common: Row = {"log": name, "exit_code": 0}
    if schema == PARAMETERS:
        return _State(parse_parameters(data, name), {**common, "command": "identify"})
    if schema == DIAGNOSIS:
        document = documents.decode(data, DiagnosisIn, name=name, schema=DIAGNOSIS)
        parameters = parse_parameters(msgspec.json.encode(document.corrected.params), name)
        common |= {
            "command": "diagnose", "verdict": document.verdict, "nrmse": document.baseline.nrmse,
            "noise_rms": document.noise_rms,
        }  # fmt: skip
        return _State(parameters, common, document)
    found_text = f"it says {str(schema)[:80]!r}" if schema else 'it has no field "schema"'
    raise InputProblem(
        f"expected a parameter file, a diagnosis or a campaign's table, but {found_text}", file=name
    )


def _rows(parameters: Parameters, common: Row) -> tuple[list[Row], Covariance | None]:
    origin = parameters.provenance
    common = {
        **common, "version": str(origin.get("erdctl", "")), "damper": _text(origin.get("damper")),
        "date": _date(origin.get("date"), common["log"]),
        "findings": [e.name for e in parameters.model.effects if not e.name.startswith(LEARNED)],
    }  # fmt: skip
    common.setdefault("noise_rms", origin.get("noise_rms"))
    rows = []
    for name, e in parameters.estimates.items():
        if name.startswith(LEARNED):
            continue
        low, high = e.within or (None, None)
        rows.append({
            **common, "parameter": name, "unit": e.unit, "value": e.value, "stderr": e.stderr,
            "low": low, "high": high, "identified": e.identified,
        })  # fmt: skip
    return rows, _covariance(parameters)


def _covariance(parameters: Parameters) -> Covariance | None:
    """What the fit says of how its errors go together, if the file tells it."""
    found = parameters.fits.get("correlation")
    if not isinstance(found, dict):
        return None
    listed, lower = found.get("parameters"), found.get("lower")
    if not isinstance(listed, list) or not isinstance(lower, list) or len(lower) != len(listed):
        return None
    out = np.eye(len(listed))
    for i, row in enumerate(lower):
        if not isinstance(row, list) or len(row) != i or not all(map(_correlation, row)):
            return None
        out[i, :i] = out[:i, i] = row
    return Covariance(tuple(map(str, listed)), out)


def _correlation(given: object) -> bool:
    return isinstance(given, int | float) and -1.0 <= given <= 1.0


def _limits(document: DiagnosisIn, common: Row) -> list[Row]:
    """Effects that were not named: no value, and as upper end the size that would have been."""
    known = {*names()}
    out = []
    for effect, limit in document.limits.items():
        if effect not in known or limit["parameter"] not in {
            q.symbol for q in get(effect).quantities
        }:
            continue
        out.append({
            **common, "parameter": f"{effect}.{limit['parameter']}", "unit": limit["unit"],
            "value": None, "stderr": None, "low": None, "high": limit["value"], "identified": False,
        })  # fmt: skip
    return out


def _text(given: object) -> str | None:
    return given if isinstance(given, str) and given else None


def _date(given: object, name: str) -> datetime | None:
    text = _text(given)
    if text is None:
        return None
    try:
        found = datetime.fromisoformat(text)
    except ValueError:
        raise InputProblem(
            f"provenance.date: expected a date, not {text[:40]!r}", file=name
        ) from None
    # In UTC, as a campaign's table has it: here and there the order of logs is the same.
    return found if found.tzinfo is None else found.astimezone(UTC).replace(tzinfo=None)
