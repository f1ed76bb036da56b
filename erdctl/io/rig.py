"""Faults of the rig as documents hold them."""

from __future__ import annotations

from typing import NotRequired, TypedDict


class RigFaultDocument(TypedDict):
    """Something wrong with the recording: code, record by name or null for the log, what to do.

    blocks : nothing of the record (of the log) was used;  samples, first, last : what was left out,
    and the time of the first and the last [s]
    """

    code: str
    record: str | None
    text: str
    remedy: str
    blocks: bool
    samples: NotRequired[int]
    first: NotRequired[float]
    last: NotRequired[float]
