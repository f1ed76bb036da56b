"""Strokes that motion and control do not tell from others, in a diagnosis's document."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from erdctl.diagnose.diagnosis import Diagnosis


class UnloggedStrokes(TypedDict):
    """Strokes with a force of their own by the same motion and duty, from `begin` to `end` [s].

    strokes, others : how many, and how many are like them
    force : beyond that of the others, over it, by thirds of the way [1];  scatter : of either [1]
    """

    record: str
    direction: str
    begin: float
    end: float
    strokes: int
    others: int
    force: list[float]
    scatter: float


def unlogged(found: Diagnosis) -> dict[str, list[UnloggedStrokes]]:
    """Them as a part of the document; nothing where there are none."""
    names = found.problem.recording.names
    told: list[UnloggedStrokes] = [
        {
            "record": names[u.record],
            "direction": u.way,
            "begin": u.begin,
            "end": u.end,
            "strokes": u.count,
            "others": u.others,
            "force": u.part.tolist(),
            "scatter": u.scatter,
        }
        for u in found.apart
    ]
    return {"unlogged": told} if told else {}
