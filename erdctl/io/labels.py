"""Labels of a test as documents hold them."""

from __future__ import annotations

from typing import TypedDict


class LabelsDocument(TypedDict, total=False):
    """What somebody said of the test: date (ISO 8601), damper, operator."""

    date: str
    damper: str
    operator: str
