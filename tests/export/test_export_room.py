"""What all exports share."""

from __future__ import annotations

from importlib.resources import files


def test_the_parts_of_the_source_travel_with_the_package() -> None:
    parts = files("erdctl.export.c") / "parts"
    assert {"header.h", "types.c", "helpers.c", "interface.c"} <= {p.name for p in parts.iterdir()}
