"""The tables as files: from parameters to the bytes that are written."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace

from erdctl.core.errors import UsageProblem
from erdctl.export.damper_alone import damper_alone, set_in, without
from erdctl.export.origin import Origin, whole
from erdctl.export.tables.dpr import property_file
from erdctl.export.tables.grid import Asked, grid
from erdctl.export.tables.map_files import csv, mat
from erdctl.export.tables.peak_map import peak_map
from erdctl.export.tables.static_cost import static_cost
from erdctl.export.tables.words import about, cost
from erdctl.io.atomic import output
from erdctl.model.parameters import Parameters


def write_table(
    parameters: Parameters,
    path: str,
    asked: Asked,
    origin: Origin,
    progress: Callable[[int, int], None] = lambda i, n: None,
) -> Sequence[str]:
    """Write .dpr, .csv or .mat by suffix; returns remarks for the user."""
    kind = os.path.splitext(path)[1].lower()
    if kind == ".dpr":
        if len(asked.duty) > 1:
            raise UsageProblem("a damper property file holds one curve: give --duty once")
        asked = replace(asked, duty=asked.duty or (0.0,))
    damper, left_out = damper_alone(parameters)
    damper = set_in(damper)
    places = grid(damper, asked)
    table = peak_map(damper, places, progress)
    found = static_cost(damper, table)
    remarks = about(damper, table, found, origin, left_out)
    remarks += [f"note: {r}" for r in places.remarks]
    remarks += [f"note: {c}; the assumed value was used" for c in damper.caveats()]
    remarks = [whole(r) for r in remarks]
    if kind == ".dpr":
        remarks.insert(0, f"duty {places.duty[0]:g} of full scale")
        text = property_file(
            places.speed, table.force[:, 0], table.stderr[:, 0], remarks=remarks,
            extension=asked.extension,
        )  # fmt: skip
        data = text.encode("ascii", "backslashreplace")
    elif kind == ".csv":
        data = csv(table, remarks).encode()
    else:
        data = mat(table, remarks, found.held)
    with output(path) as stream:
        stream.write(data)
    return [*without(left_out), *places.remarks, *cost(found)]
