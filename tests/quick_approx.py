"""`pytest.approx` of arrays at once: it takes ten thousand samples one by one, for 40 ms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest


def install() -> None:
    """Say yes quickly where all are near; what is not, pytest looks at and reports as ever."""
    of_arrays: Any = type(pytest.approx(np.zeros(1)))
    one_by_one = of_arrays.__eq__

    def equal(self: Any, found: Any) -> bool:
        return all_near(self, found) or one_by_one(self, found)

    of_arrays.__eq__ = equal


def all_near(self: Any, found: Any) -> bool:
    """Whether both are finite arrays of numbers, and within pytest's tolerances of each other."""
    expected = self.expected
    if not isinstance(found, np.ndarray) or found.shape != expected.shape:
        return False
    if found.dtype.kind not in "fi" or expected.dtype.kind not in "fi":
        return False
    most = np.full(expected.shape, 1e-12 if self.abs is None else self.abs)
    with np.errstate(invalid="ignore"):
        if self.rel is not None or self.abs is None:
            most = np.maximum(most, (1e-6 if self.rel is None else self.rel) * np.abs(expected))
        off = np.abs(found.astype(float) - expected)
    return bool(np.isfinite(off).all() and (off <= most).all())
