"""`erdctl derive`."""

from __future__ import annotations

from typing import Annotated

import typer

from erdctl.cli.options import Damper, Date, Operator, Out


def command(
    geometry: Annotated[
        str, typer.Argument(metavar="GEOMETRY", help="Geometry file (JSON); - is stdin.")
    ],
    output: Out = "-",
    date: Date = None,
    damper: Damper = None,
    operator: Operator = None,
) -> None:
    """Derive k_nom, c_vis and sigma from a damper's geometry and fluid (Eqs. 3-14).

    T_d follows from no geometry and stays without a value.

    \b
    Examples:
      erdctl derive fixtures/geometry_inove.json
      erdctl derive geometry.json | erdctl simulate - drive.csv
    """
    from erdctl.core.labels import labels_of
    from erdctl.core.recording import DIRECTIONS
    from erdctl.io.geometry import read_geometry
    from erdctl.io.parameters import write_parameters
    from erdctl.model.composed import Model
    from erdctl.model.geometry import derive
    from erdctl.model.paper import QUANTITIES
    from erdctl.model.parameters import Estimate, Parameters
    from erdctl.report.readable import number
    from erdctl.report.text import say, table

    labels = labels_of(date, damper, operator)
    given = read_geometry(geometry)
    found = derive(given, file="stdin" if geometry == "-" else geometry)
    values = {"k_nom": found.k_nom, "c_vis": found.c_vis, "sigma": found.sigma, "beta": found.beta}
    T_d = Estimate(
        value=None, unit="s", assumed=0.0, reason="the lag of Eq. 12 follows from no geometry"
    )
    estimates = {
        f"{d}.{s}": Estimate(value=values[s], unit=q.unit) if s in values else T_d
        for d in DIRECTIONS
        for s, q in QUANTITIES.items()
    }
    origin = {"derived_from": geometry, "preload": {"value": found.preload, "unit": "N"}, **labels}
    write_parameters(Parameters(model=Model(), estimates=estimates, provenance=origin), output)
    rows = [[s, QUANTITIES[s].unit, number(v, 6)] for s, v in values.items()]
    rows.append(["gas preload", "N", number(found.preload, 6)])
    table("Derived from geometry and fluid", ["parameter", "unit", "value"], rows)
    say("the gas preload P_0 A_s is not part of the paper's linear spring (Eq. 14)")
