"""Factors and offsets that a file states beside samples, and whether they are still to be applied.

Whole numbers are counts of a converter, which they make values. Other numbers are values already,
unless the file says otherwise: `scale_factor` and `add_offset` are netCDF's, which has them applied
to whatever is stored.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from erdctl.core.errors import InputProblem

_FACTORS = ("scale_factor", "scale", "gain", "factor", "slope")
_OFFSETS = ("add_offset", "offset", "bias")
_NETCDF = {"scale_factor", "add_offset"}


@dataclass(frozen=True)
class Scaling:
    """values * factor + offset, where it applies;  said : what there is to say about it"""

    factor: float = 1.0
    offset: float = 0.0
    applies: bool = False
    said: str | None = None

    def __call__(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        return values * self.factor + self.offset if self.applies else values


def scaling(stated: Mapping[str, Any], name: str, file: str, *, counts: bool) -> Scaling:
    """The scaling of a channel.

    stated : what stands beside its samples, by any name;  counts : they are whole numbers
    Raises InputProblem if two of them could be its factor, or its offset.
    """
    low = {k.casefold(): v for k, v in stated.items()}
    found: list[tuple[str, float]] = []
    for kinds, off in ((_FACTORS, 1.0), (_OFFSETS, 0.0)):
        several = [(k, v) for k in kinds if (v := _number(low.get(k))) is not None]
        if len(several) > 1:
            raise InputProblem(
                f"'{name}' has {' and '.join(k for k, _ in several)}; which of them scales it is"
                " not clear: keep one",
                file=file,
            )
        found += several or [("", off)]
    (gain, factor), (bias, offset) = found
    names = [k for k, _ in found if k]
    if not names:
        return Scaling()
    what = " and ".join(f"{k} = {v:g}" for k, v in found if k)
    changes = (factor, offset) != (1.0, 0.0)
    if counts or _NETCDF.intersection(names):
        said = f"'{name}' holds {'counts' if counts else 'packed values'}; applied {what}"
        return Scaling(factor, offset, applies=True, said=said if changes else None)
    how = f'; if they are to be multiplied, say so: --map "TARGET={name}[{factor:g} UNIT]"'
    said = (
        f"'{name}' holds values and no counts, so its {what} {'are' if gain and bias else 'is'} not"
        f" applied{how if gain and not bias else ''}"
    )
    return Scaling(said=said if changes else None)


def _number(value: Any) -> float | None:
    array = np.asarray(value)
    return float(array.ravel()[0]) if array.size == 1 and array.dtype.kind in "iuf" else None
