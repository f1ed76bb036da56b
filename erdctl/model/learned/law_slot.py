"""The places in the model where a learned law may act."""

from __future__ import annotations

from enum import StrEnum

LEAST_LAG = 0.01  # of a time constant


class LawSlot(StrEnum):
    """Where in the model a learned law acts."""

    FORCE = "force"
    FRICTION = "friction"
    YIELD = "yield"
    VISCOUS = "viscous"
    GAS = "gas"
    FLUID = "fluid"
    LAG = "lag"
    DUTY = "duty"
    DEFLECTION = "deflection"

    @property
    def adds(self) -> bool:
        """Whether it adds a force, in place of a factor on one."""
        return self in (LawSlot.FORCE, LawSlot.FRICTION)

    @property
    def groups(self) -> tuple[str, ...]:
        """The groups of forces that it scales."""
        return GROUPS_OF.get(self, ())


GROUPS_OF = {
    LawSlot.YIELD: ("yield",),
    LawSlot.VISCOUS: ("viscous",),
    LawSlot.GAS: ("gas",),
    LawSlot.FLUID: ("viscous", "yield"),
}
