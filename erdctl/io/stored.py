"""Units that a file states itself: where each format keeps them, and what becomes of them.

CSV: contract columns in SI have plain names, all others with a unit are called `NAME [UNIT]`.
Parquet, Arrow: metadata `unit` of the field, or `attrs` of the pandas frame. MAT, HDF5, MDF4, TDMS:
see `erdctl.io.containers`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pyarrow as pa

from erdctl.core.errors import InputProblem
from erdctl.io.units import UNITS, Conversion, WrongUnit, between, examples, name_and_unit

_KEY = b"unit"
_KEYS = (_KEY, b"units")
_WORDS = ("units", "unit", "column_units", "einheiten", "einheit")  # in `attrs` of pandas
_NONE = {"", "none", "unitless", "n/a", "unknown"}  # what bench software writes for "not set"
PLAIN = "1"


def stored_unit(text: str | None) -> str | None:
    """A unit as the file spells it, without brackets around it; None if it states none."""
    text = (text or "").strip()
    if text[:1] + text[-1:] in ("[]", "()"):
        text = text[1:-1].strip()
    return None if text.casefold() in _NONE else text


def from_stored(unit: str, target: str, column: str, file: str) -> Conversion:
    """From the unit that a file states for a column to that of the contract.

    Raises InputProblem if it is no unit, or a unit of something else.
    """
    try:
        return between(unit, UNITS[target])
    except WrongUnit as error:
        raise InputProblem(
            f"stored with {error}; '{target}' needs something like {examples(target)}; if the file"
            f' is wrong about it, say the right one: --map "{target}={column}[UNIT]"',
            file=file,
            column=column,
        ) from None


def unit_of(field: pa.Field) -> str | None:
    """The unit in the metadata of a field, or None."""
    metadata = field.metadata or {}
    found = next((metadata[key] for key in _KEYS if key in metadata), b"")
    return stored_unit(found.decode(errors="replace"))


def units_of(schema: pa.Schema) -> dict[str, str]:
    """The units that the fields of a schema state, or else `attrs` of the pandas frame it was."""
    stated = {field.name: unit_of(field) for field in schema}
    own = {name: unit for name, unit in stated.items() if unit is not None}
    return units_of_pandas(schema) | own


def units_of_pandas(schema: pa.Schema) -> dict[str, str]:
    """The units in `DataFrame.attrs`, of columns that the schema has.

    Labs write {"units": {"x": "mm"}}, {"units": ["s", "mm"]} in the order of the columns, or
    {"x": "mm"}, {"x": {"unit": "mm"}}, {"x_unit": "mm"}.
    """
    attrs = _attrs(schema)
    if not attrs:
        return {}
    names = schema.names
    out: dict[str, str] = {}
    for name in names:
        own = attrs.get(name, attrs.get(f"{name}_unit", attrs.get(f"{name}_units")))
        if isinstance(own, dict):
            own = next((v for k, v in own.items() if str(k).casefold() in _WORDS), None)
        if isinstance(own, str):
            out[name] = own
    for key, value in attrs.items():
        if key.casefold() not in _WORDS:
            continue
        if isinstance(value, list) and len(value) == len(names):
            value = dict(zip(names, value, strict=True))
        if isinstance(value, dict):
            out |= {k: v for k, v in value.items() if k in names and isinstance(v, str)}
    found = {name: stored_unit(unit) for name, unit in out.items()}
    return {name: unit for name, unit in found.items() if unit is not None}


def _attrs(schema: pa.Schema) -> dict[str, Any]:
    """`DataFrame.attrs` as pandas and pyarrow store it, {} if there are none."""
    import json

    metadata = schema.metadata or {}
    for key, inner in ((b"PANDAS_ATTRS", None), (b"pandas", "attributes")):
        text = metadata.get(key)
        if text is None:
            continue
        try:
            found = json.loads(text)
        except (ValueError, RecursionError):
            continue  # metadata of somebody else under that name; no unit comes from it
        if inner is not None and isinstance(found, dict):
            found = found.get(inner)
        if isinstance(found, dict) and found:
            return found
    return {}


def si(target: str) -> str:
    """The unit of a contract column as files state it."""
    return UNITS[target] or PLAIN


def with_unit(field: pa.Field, unit: str | None) -> pa.Field:
    """The field with this unit in place of any other; its other metadata stay."""
    kept = {k: v for k, v in (field.metadata or {}).items() if k not in _KEYS}
    if unit is not None:
        kept[_KEY] = unit.encode()
    return field.with_metadata(kept or None)


def with_units(table: pa.Table, units: Mapping[str, str]) -> pa.Table:
    """The table with these units in the metadata of its fields; others stay as they are."""
    fields = [with_unit(f, units[f.name]) if f.name in units else f for f in table.schema]
    # Not `cast`: it imports the compute functions, which takes as long as the whole of NumPy.
    return pa.Table.from_arrays(table.columns, schema=pa.schema(fields, table.schema.metadata))


def with_si(table: pa.Table) -> pa.Table:
    """The table with the contract's unit on contract columns that state none: they are SI."""
    bare = [f.name for f in table.schema if f.name in UNITS and unit_of(f) is None]
    return with_units(table, {name: si(name) for name in bare}) if bare else table


def units_apart(table: pa.Table) -> pa.Table:
    """The table with units of names like `p [bar]` in metadata, where no name then comes twice."""
    names = list(table.column_names)
    for index, field in enumerate(table.schema):
        name, unit = name_and_unit(field.name)
        unit = stored_unit(unit)
        if unit is None or name in names or name in UNITS or unit_of(field) is not None:
            continue
        names[index] = name
        table = table.set_column(index, with_unit(field, unit).with_name(name), table.column(index))
    return table


def header(schema: pa.Schema) -> list[str]:
    """Names of columns in CSV: `NAME [UNIT]`, for the contract's columns the plain name."""
    out: list[str] = []
    for field in schema:
        unit = unit_of(field)
        known = unit is None or (field.name in UNITS and unit == si(field.name))
        said = known or name_and_unit(field.name)[1] is not None
        out.append(field.name if said else f"{field.name} [{unit}]")
    return out
