"""Functions that do not fit their slots, for the type checker; nothing runs this file."""

from __future__ import annotations

import numpy as np

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.model.slots import ControlSlot, FieldSlot, ScaleSlot, SeriesSlot, Values


def without_values(s: Signals) -> Array:
    return s.duty


def a_plain_array(s: Signals, p: Values) -> Array:
    return np.ones(len(s))


def without_direction(field: Array, s: Signals, p: Values) -> Array:
    return field


def a_word(p: Values) -> str:
    return "stiff"


def right(s: Signals, p: Values) -> Array:
    return s.duty


WRONG = (
    ControlSlot(without_values),
    ScaleSlot(a_plain_array),
    FieldSlot(without_direction),
    SeriesSlot(a_word),
)
RIGHT = ControlSlot(right)
