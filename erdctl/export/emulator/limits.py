"""What an online emulator must keep."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from erdctl.core.errors import UsageProblem
from erdctl.model.amplifier import Amplifier


@dataclass(frozen=True, kw_only=True)
class EmulatorLimits:
    """Limits of the amplifier and of the damper's temperature.

    temperature_max : above it the output is closed [degC] (Sec. 5.4)
    temperature_hysteresis : it opens again that much below [K]
    """

    amplifier: Amplifier = field(default_factory=Amplifier)
    temperature_max: float = 60.0
    temperature_hysteresis: float = 5.0

    def __post_init__(self) -> None:
        if not -273.0 <= self.temperature_max <= 1e4:
            raise UsageProblem(
                f"the highest temperature is in degC, not {self.temperature_max:g}; an online"
                " emulator cannot do without it"
            )
        if not 0.0 <= self.temperature_hysteresis <= 1e4:
            raise UsageProblem(
                f"the hysteresis of the temperature is in K and not below 0, not"
                f" {self.temperature_hysteresis:g}"
            )

    @property
    def slew(self) -> float:
        """Fastest change of the duty [1/s], 0 for none, as the C has it."""
        return 0.0 if math.isinf(self.amplifier.slew) else self.amplifier.slew

    @property
    def update_period(self) -> float:
        """Least time between two changes of the duty [s], 0 for none, as the C has it."""
        rate = self.amplifier.update_rate
        return 0.0 if rate is None else 1.0 / rate
