"""The geometry file, `"schema": "erdctl.geometry/1"`: a damper's dimensions and its fluid."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Final, Literal

import msgspec

from erdctl.core.errors import InputProblem
from erdctl.io import documents
from erdctl.model.geometry import Geometry

SCHEMA: Final = "erdctl.geometry/1"
# SI units by field.
UNITS = {
    "A_p": "m^2", "A_s": "m^2", "L_d": "m", "d": "m", "R_d": "m", "mu": "Pa s", "c": "1",
    "alpha": "Pa (m/V)^beta", "beta": "1", "U_m": "V", "d_e": "m", "P_0": "Pa",
    "V_0": "m^3", "gamma": "1", "stroke": "m",
}  # fmt: skip


class Measure(msgspec.Struct):
    """A number with its unit."""

    value: float
    unit: str | None = None


class GeometryFile(msgspec.Struct, kw_only=True):
    """Dimensions and fluid data of a damper, in SI units unless a unit is given."""

    schema: Literal["erdctl.geometry/1"]
    A_p: Measure | float
    A_s: Measure | float
    L_d: Measure | float
    d: Measure | float
    R_d: Measure | float
    mu: Measure | float
    c: Measure | float
    alpha: Measure | float
    beta: Measure | float
    U_m: Measure | float
    d_e: Measure | float
    P_0: Measure | float
    V_0: Measure | float
    gamma: Measure | float
    stroke: Measure | float = 0.0
    note: str = ""


def read_geometry(path: str) -> Geometry:
    """A geometry from a file, or from stdin for `-`."""
    name = "stdin" if path == "-" else path
    document = documents.decode(documents.read_bytes(path), GeometryFile, name=name, schema=SCHEMA)
    values = {}
    for field in fields(Geometry):
        given = getattr(document, field.name)
        value, unit = (given.value, given.unit) if isinstance(given, Measure) else (given, None)
        si = UNITS[field.name]
        if unit is not None and unit != si:
            from erdctl.io.units import factor_between

            # Volts per metre to the power beta, which no unit library writes, are not converted.
            if field.name == "alpha":
                raise InputProblem(f"alpha is given in '{unit}'; expected {si}", file=name)

            value *= factor_between(unit, si, f"{name}: {field.name}")
        if value != value or abs(value) == float("inf"):
            raise InputProblem(f"{field.name} is not a finite number", file=name)
        values[field.name] = value
    return Geometry(**values)


def json_schema() -> dict[str, Any]:
    """The published JSON Schema of the geometry file."""
    return msgspec.json.schema(GeometryFile)
