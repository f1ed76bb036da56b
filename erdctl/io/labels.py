"""Labels of a test as documents hold them."""

from __future__ import annotations

from typing import TypedDict


class LabelsDocument(TypedDict, total=False):
    """What somebody said of the test: date (ISO 8601), damper, operator; by a
    project file corner and conditions, and which project file it was and what it changed."""

    date: str
    damper: str
    operator: str
    corner: str
    conditions: str
    project: str
