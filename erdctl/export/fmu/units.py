"""Units as FMI states them: powers of the SI base units."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping

# Powers of the base units; a factor or an offset under its own name.
_KNOWN: dict[str, dict[str, float]] = {
    "1": {},
    "kg": {"kg": 1}, "m": {"m": 1}, "s": {"s": 1}, "A": {"A": 1}, "K": {"K": 1}, "rad": {"rad": 1},
    "Hz": {"s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
}  # fmt: skip
_DEGREES = {"degC": {"K": 1, "offset": 273.15}}  # no factor of another unit

_FACTOR = re.compile(r"(?P<symbol>[A-Za-z]+|1)(\^(?P<power>-?\d+))?")


def base_units(unit: str) -> Mapping[str, float] | None:
    """Powers of the SI base units of a unit; None if it has none that FMI can state.

    unit : factors with whole powers, and after one "/" those that divide: "N s^2/m^2"

    Check: N s/m is kg m/s^2 s/m = kg/s, the powers 1 and -1; half a power has none.
    >>> base_units("N s/m")
    {'kg': 1, 's': -1}
    >>> base_units("m^0.5") is None
    True
    """
    if unit in _DEGREES:
        return _DEGREES[unit]
    powers: Counter[str] = Counter()
    for sign, part in zip((1, -1), unit.split("/"), strict=False):
        for word in part.split():
            found = _FACTOR.fullmatch(word)
            if found is None or found["symbol"] not in _KNOWN:
                return None
            times = sign * int(found["power"] or 1)
            for base, power in _KNOWN[found["symbol"]].items():
                powers[base] += times * int(power)
    if unit.count("/") > 1:
        return None
    return {base: power for base, power in powers.items() if power}
