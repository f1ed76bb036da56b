"""modelDescription.xml of an FMU, for FMI 2.0 and 3.0, and the page that comes with it.

Source: Functional Mock-up Interface, version 2.0 (sections 2.2 and 4.3) and 3.0 (sections 2.4 and
4.3), Modelica Association.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from xml.etree import ElementTree as ET

from erdctl.core.version import __version__
from erdctl.export.fmu.block import FmuBlock, FmuType, FmuVariable
from erdctl.export.fmu.units import base_units
from erdctl.export.fmu.version import TWO, Version

_STRUCTURED = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*", re.ASCII)
_TYPES_2 = {FmuType.REAL: "Real", FmuType.INTEGER: "Integer", FmuType.BOOLEAN: "Boolean"}
_TYPES_3 = {FmuType.REAL: "Float64", FmuType.INTEGER: "Int32", FmuType.BOOLEAN: "Boolean"}

# How FMI calls what a variable is for, how it may change and how it begins.
_INPUT = {"causality": "input", "variability": "continuous"}
_OUTPUT = {"causality": "output", "initial": "calculated"}
_WATCHED = {"causality": "local", "initial": "calculated"}
_INITIAL = {"causality": "parameter", "variability": "fixed", "initial": "exact"}
_PARAMETER = {"causality": "parameter", "variability": "tunable", "initial": "exact"}


def model_description(block: FmuBlock, version: Version, token: str, c_files: list[str]) -> bytes:
    """Text of modelDescription.xml.

    token : the GUID of FMI 2.0, the instantiation token of FMI 3.0
    c_files : those to be compiled, which FMI 2.0 lists here
    """
    every = [*block.inputs, *block.computed, *block.parameters, *block.initial]
    structured = all(_STRUCTURED.fullmatch(v.name) for v in every)
    root = ET.Element(
        "fmiModelDescription",
        {
            "fmiVersion": version.number,
            "modelName": block.prefix,
            "guid" if version is TWO else "instantiationToken": token,
            "description": block.title,
            "generationTool": f"erdctl {__version__}",
            "variableNamingConvention": "structured" if structured else "flat",
        },
    )
    root.append(_co_simulation(block, version, c_files))
    units = sorted({v.unit for v in every if v.kind is FmuType.REAL} | {"s"})
    root.append(_units(units))
    categories = ET.SubElement(root, "LogCategories")
    for name in ("logStatusWarning", "logStatusDiscard", "logStatusError"):
        ET.SubElement(categories, "Category", name=name)
    ET.SubElement(root, "DefaultExperiment", startTime="0", stepSize=repr(block.step_size))
    variables = ET.SubElement(root, "ModelVariables")
    for element in _variables(block, version):
        variables.append(element)
    root.append(_structure(block, version))
    return _text(root)


def build_description(block: FmuBlock, c_files: list[str]) -> bytes:
    """Text of sources/buildDescription.xml, which FMI 3.0 has beside its sources."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    built = ET.SubElement(root, "BuildConfiguration", modelIdentifier=block.prefix)
    files = ET.SubElement(built, "SourceFileSet", language="C99")
    for name in c_files:
        ET.SubElement(files, "SourceFile", name=name)
    return _text(root)


def page(block: FmuBlock) -> bytes:
    """Text of documentation/index.html."""
    html = ET.Element("html", lang="en")
    head = ET.SubElement(html, "head")
    ET.SubElement(head, "meta", charset="utf-8")
    ET.SubElement(head, "title").text = block.prefix
    body = ET.SubElement(html, "body")
    ET.SubElement(body, "h1").text = block.title
    for note in block.notes:
        ET.SubElement(body, "p").text = note
    for title, variables in (
        ("Inputs", block.inputs),
        ("Outputs", block.outputs),
        ("To be watched", block.watched),
        ("Parameters", block.parameters),
        ("How it begins", block.initial),
    ):
        if variables:
            ET.SubElement(body, "h2").text = title
            table = ET.SubElement(body, "table")
            for v in variables:
                row = ET.SubElement(table, "tr")
                for cell in (v.name, v.unit, v.title):
                    ET.SubElement(row, "td").text = cell
    text: bytes = ET.tostring(html, encoding="UTF-8", method="html")
    return b"<!DOCTYPE html>\n" + text + b"\n"


def _text(root: ET.Element) -> bytes:
    ET.indent(root)
    text: bytes = ET.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text + b"\n"


def _co_simulation(block: FmuBlock, version: Version, c_files: list[str]) -> ET.Element:
    said = {"modelIdentifier": block.prefix, "canHandleVariableCommunicationStepSize": "true"}
    if version is not TWO:
        return ET.Element(
            "CoSimulation", said, canGetAndSetFMUState="true", canSerializeFMUState="true"
        )
    element = ET.Element(
        "CoSimulation",
        said,
        canInterpolateInputs="true",
        canNotUseMemoryManagementFunctions="true",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
    )
    files = ET.SubElement(element, "SourceFiles")
    for name in c_files:
        ET.SubElement(files, "File", name=name)
    return element


def _units(units: list[str]) -> ET.Element:
    element = ET.Element("UnitDefinitions")
    for unit in units:
        one = ET.SubElement(element, "Unit", name=unit)
        base = base_units(unit)
        if base is not None:
            ET.SubElement(one, "BaseUnit", {k: f"{v:.17g}" for k, v in base.items()})
    return element


def _variables(block: FmuBlock, version: Version) -> Iterator[ET.Element]:
    # FMI 3.0 wants time among the variables; value reference 0 is kept for it in both.
    if version is not TWO:
        yield ET.Element(
            "Float64", name="time", valueReference="0", causality="independent",
            variability="continuous", unit="s",
        )  # fmt: skip
    groups = (
        (block.inputs, _INPUT),
        (block.outputs, _OUTPUT),
        (block.watched, _WATCHED),
        (block.parameters, _PARAMETER),
        (block.initial, _INITIAL),
    )
    rows = [(v, role) for variables, role in groups for v in variables]
    for reference, (v, role) in enumerate(rows, start=1):
        yield _variable(v, reference, role, version)


def _variable(v: FmuVariable, reference: int, role: dict[str, str], version: Version) -> ET.Element:
    common = {"name": v.name, "valueReference": str(reference)}
    if v.title:
        common["description"] = v.title
    common |= role
    # Only numbers with a fraction change continuously.
    common.setdefault("variability", "continuous" if v.kind is FmuType.REAL else "discrete")
    value: dict[str, str] = {}
    if v.kind is FmuType.REAL:
        value["unit"] = v.unit
    if v.kind is not FmuType.BOOLEAN:
        value |= {k: _said(v, x) for k, x in (("min", v.low), ("max", v.high)) if math.isfinite(x)}
    if role.get("initial") != "calculated":
        value["start"] = _said(v, v.start)
    if version is TWO:
        element = ET.Element("ScalarVariable", common)
        ET.SubElement(element, _TYPES_2[v.kind], value)
        return element
    return ET.Element(_TYPES_3[v.kind], common | value)


def _said(v: FmuVariable, value: float) -> str:
    """A value of a variable as XML has it."""
    if v.kind is FmuType.BOOLEAN:
        return "true" if value else "false"
    return repr(float(value)) if v.kind is FmuType.REAL else str(int(value))


def _structure(block: FmuBlock, version: Version) -> ET.Element:
    """Outputs and what initialisation computes; without dependencies all depend on all."""
    element = ET.Element("ModelStructure")
    first = 1 + len(block.inputs)
    places = range(first, first + len(block.outputs))
    if version is TWO:
        # By place in the list of variables, which is the value reference: 0 is not in that list.
        for group in ("Outputs", "InitialUnknowns"):
            unknowns = ET.SubElement(element, group)
            for i in places:
                ET.SubElement(unknowns, "Unknown", index=str(i))
        return element
    for kind in ("Output", "InitialUnknown"):
        for i in places:
            ET.SubElement(element, kind, valueReference=str(i))
    return element
