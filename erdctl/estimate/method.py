"""Which fit counts; imports nothing, so that the command line can name the choices at once."""

from __future__ import annotations

from enum import StrEnum


class Method(StrEnum):
    """Which of the two fits becomes the parameter values."""

    JOINT = "joint"
    TWO_STEP = "two-step"
