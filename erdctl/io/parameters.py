"""The parameter file, `"schema": "erdctl.parameters/1"`."""

from __future__ import annotations

import math
from typing import Any, Final, Literal

import msgspec

from erdctl.core.errors import IncompatibleEffects, InputProblem
from erdctl.core.quantity import Quantity
from erdctl.core.recording import DIRECTIONS
from erdctl.io import documents
from erdctl.io.learned import NAME, LawDocument, to_law, to_law_document
from erdctl.model.composed import Model
from erdctl.model.effect import Effect
from erdctl.model.paper import QUANTITIES
from erdctl.model.parameters import Estimate, Parameters

SCHEMA: Final = "erdctl.parameters/1"


class Value(msgspec.Struct, omit_defaults=True):
    """One parameter: value, SI unit, standard error.

    A parameter that the data do not identify has value null, the `reason`, and in `assumed` what a
    simulation uses in its place. One that a fit pressed against its bound has `at_bound` and no
    standard error. `interval` is the 95 % one where it is not value +- 1.96 stderr.
    """

    value: float | None
    unit: str | None = None
    stderr: float | None = None
    identified: bool = True
    assumed: float | None = None
    reason: str | None = None
    at_bound: bool = False
    interval: tuple[float, float] | None = None


class Direction(msgspec.Struct):
    """The paper's parameters for one direction of motion."""

    k_nom: Value | float
    c_vis: Value | float
    T_d: Value | float
    sigma: Value | float
    beta: Value | float


class ExtraEffect(msgspec.Struct, omit_defaults=True):
    """An effect beyond the paper's model, with its parameters by symbol.

    One that was learned from data is called `learned` and brings its `law`.
    """

    effect: str
    parameters: dict[str, Value | float]
    law: LawDocument | None = None


class KnownProvenance(msgspec.Struct):
    """What commands read of the provenance: ranges of the logs [SI], and the noise [N]."""

    ranges: dict[str, tuple[float, float]] = {}
    noise_rms: float | None = None


class ParameterFile(msgspec.Struct, kw_only=True):
    """Parameters of a damper."""

    schema: Literal["erdctl.parameters/1"]
    compression: Direction
    release: Direction
    effects: list[ExtraEffect] = []
    provenance: dict[str, Any] = {}
    fits: dict[str, Any] = {}
    warnings: list[str] = []


def read_parameters(path: str) -> Parameters:
    """Parameters from a file, or from stdin for `-`."""
    return parse_parameters(documents.read_bytes(path), "stdin" if path == "-" else path)


def parse_parameters(data: bytes, name: str) -> Parameters:
    """Parameters from the bytes of a document; `name` is for messages."""
    document = documents.decode(data, ParameterFile, name=name, schema=SCHEMA)
    estimates = {}
    for direction in DIRECTIONS:
        given = getattr(document, direction)
        for symbol, quantity in QUANTITIES.items():
            full = f"{direction}.{symbol}"
            estimates[full] = _estimate(getattr(given, symbol), quantity, full, name)
    chosen = []
    for i, extra in enumerate(document.effects):
        effect = _effect(extra, f"effects[{i}]", name)
        if effect in chosen:
            raise InputProblem(f"effects[{i}]: '{effect.name}' is listed twice", file=name)
        chosen.append(effect)
        known = {q.symbol: q for q in effect.quantities}
        values = _completed(extra.parameters, effect)
        if set(values) != set(known):
            raise InputProblem(
                f"effects[{i}] ({effect.name}): expected the parameters"
                f" {', '.join(known)}, found {', '.join(extra.parameters) or 'none'}",
                file=name,
            )
        for symbol, quantity in known.items():
            full = effect.key(symbol)
            estimates[full] = _estimate(values[symbol], quantity, full, name)
    documents.converted(document.provenance, KnownProvenance, name=name, path=".provenance")
    found = Parameters(
        model=Model(tuple(chosen)),
        estimates=estimates,
        provenance=document.provenance,
        fits=document.fits,
        warnings=tuple(document.warnings),
    )
    if len(chosen) > 1:
        _check_together(found, name)
    return found


def _effect(extra: ExtraEffect, where: str, file: str) -> Effect:
    """The effect of the catalogue that is named, or of the law that is given."""
    if (extra.law is not None) != (extra.effect == NAME):
        raise InputProblem(f"{where}: '{NAME}', and it alone, has a law", file=file)
    if extra.law is not None:
        return to_law(extra.law, f"{where}.law", file).effect
    from erdctl.effects import get  # only where there are any: most parameter files have none

    try:
        return get(extra.effect)
    except InputProblem as problem:
        raise InputProblem(f"{where}: {problem}", file=file) from None


def _extra(effect: Effect, parameters: dict[str, Value | float]) -> ExtraEffect:
    from erdctl.model.learned.law import LearnedEffect  # only where there are effects

    if isinstance(effect, LearnedEffect):
        return ExtraEffect(NAME, parameters, to_law_document(effect.law))
    return ExtraEffect(effect.name, parameters)


def _completed(given: dict[str, Value | float], effect: Effect) -> dict[str, Value | float]:
    """Parameters of an effect, with those that it had not when the file was written."""
    out = dict(given)
    for symbol, was in effect.earlier:
        if symbol not in out and (not isinstance(was, str) or was in given):
            out[symbol] = given[was] if isinstance(was, str) else was
    return out


def _check_together(parameters: Parameters, name: str) -> None:
    """Refuse effects that no model can hold at once, before a command begins with them."""
    import numpy as np

    from erdctl.core.signals import Signals

    t, still = np.array([0.0, 1e-3]), np.zeros(2)
    moment = Signals(
        t, still, still + 1e-3, still, np.array([1e-3, 0.0]), np.array([0, 2]), temperature=still
    )
    try:
        parameters.model.force(moment, parameters.values)
    except IncompatibleEffects as error:
        names = ", ".join(e.name for e in parameters.model.effects)
        raise InputProblem(f"effects {names} together: {error}", file=name) from error


def _estimate(given: Value | float, quantity: Quantity, full: str, name: str) -> Estimate:
    if not isinstance(given, Value):
        given = Value(value=given)
    factor = 1.0
    if given.unit is not None and given.unit != quantity.unit:
        from erdctl.io.units import factor_between

        factor = factor_between(given.unit, quantity.unit, f"{name}: {full}")
    numbers = (given.value, given.stderr, given.assumed)
    value, stderr, assumed = (None if v is None else v * factor for v in numbers)
    for what, number in (("", value), ("the standard error of ", stderr), ("assumed ", assumed)):
        if number is not None and not math.isfinite(number):
            raise InputProblem(f"{what}{full} is not a finite number", file=name)
    if stderr is not None and stderr < 0.0:
        raise InputProblem(
            f"the standard error of {full} is {stderr:g}; expected 0 or more", file=name
        )
    value, assumed = (None if v is None else quantity.snapped(v) for v in (value, assumed))
    ends = given.interval
    if ends is not None and not (math.isfinite(ends[0]) and ends[0] <= ends[1] < math.inf):
        raise InputProblem(f"the interval of {full} is no pair of rising numbers", file=name)
    used = assumed if value is None else value
    if used is not None and not quantity.admits(used):
        raise InputProblem(
            f"{full} = {used:g} {quantity.unit}".removesuffix(" 1")
            + f" is outside {quantity.low:g}..{quantity.high:g}",
            file=name,
        )
    return Estimate(
        value=value, unit=quantity.unit, stderr=stderr, assumed=assumed, reason=given.reason,
        at_bound=given.at_bound,
        within=None if ends is None else (ends[0] * factor, ends[1] * factor),
    )  # fmt: skip


def to_document(parameters: Parameters) -> ParameterFile:
    """The parameter file of given parameters."""

    def value(full: str) -> Value | float:
        e = parameters.estimates[full]
        return Value(
            value=e.value,
            unit=e.unit,
            stderr=e.stderr,
            identified=e.identified,
            assumed=e.assumed,
            reason=e.reason,
            at_bound=e.at_bound,
            interval=e.within,
        )

    directions = {
        d: Direction(**{symbol: value(f"{d}.{symbol}") for symbol in QUANTITIES})
        for d in DIRECTIONS
    }
    extra = [
        _extra(e, {q.symbol: value(e.key(q.symbol)) for q in e.quantities})
        for e in parameters.model.effects
    ]
    return ParameterFile(
        schema=SCHEMA,
        effects=extra,
        provenance=dict(parameters.provenance),
        fits=dict(parameters.fits),
        warnings=list(parameters.warnings),
        **directions,
    )


def write_parameters(parameters: Parameters, path: str) -> None:
    """Write the parameter file to a path, or to stdout for `-`."""
    documents.write(to_document(parameters), path)


def json_schema() -> dict[str, Any]:
    """The published JSON Schema of the parameter file."""
    return msgspec.json.schema(ParameterFile)
