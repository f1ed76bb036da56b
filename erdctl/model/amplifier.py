"""The high-voltage PWM amplifier: what duty sequence it can carry out."""

from __future__ import annotations

import math
from dataclasses import dataclass

from erdctl.core.errors import UsageProblem


@dataclass(frozen=True, kw_only=True)
class Amplifier:
    """Limits of a PWM amplifier; the defaults are those of the INOVE bench (Sec. 2).

    carrier : PWM frequency [Hz];  full_scale : voltage at duty 1 [V] (Table 1)
    duty_max : highest duty, by default the highest tested (Sec. 4.2: v = 0.1 to 0.45)
    resolution : smallest step of the duty, 0 for none;  slew : fastest change of the duty [1/s]
    update_rate : how often the duty can change [Hz]; None for every sample of the log
    """

    carrier: float = 25_000.0
    full_scale: float = 5_000.0
    duty_max: float = 0.45
    resolution: float = 0.0
    slew: float = math.inf
    update_rate: float | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.duty_max <= 1.0:
            raise UsageProblem(f"the highest duty must be in 0..1, not {self.duty_max:g}")
        if not 0.0 <= self.resolution < self.duty_max:
            raise UsageProblem(f"the resolution must be in 0..{self.duty_max:g}")
        scales = (self.carrier, self.full_scale)
        if not self.slew > 0.0 or not all(0.0 < scale < math.inf for scale in scales):
            raise UsageProblem(
                "slew rate, carrier and full scale must be above zero, and the last two finite"
            )
        if self.update_rate is not None and not 0.0 < self.update_rate <= self.carrier:
            raise UsageProblem(
                f"the update rate must be above 0 and at most the carrier, {self.carrier:g} Hz"
            )
