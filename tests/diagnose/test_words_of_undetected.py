"""What could have been missed, in words: sizes that say how far they are from none, and a count."""

from __future__ import annotations

from erdctl.diagnose.detectable import Detectable
from erdctl.diagnose.wording import undetected_text
from erdctl.effects import get


def seen_from(name: str, **values: float) -> Detectable:
    return Detectable(get(name), values, force=0.1, beyond=0.05)


def test_a_factor_near_one_is_told_by_what_it_takes_away() -> None:
    """An f of 0.9961 was said as 1, which is no fault, and one of 0.9877 as 0.99."""
    for f, shown in ((0.9961, "0.9961"), (0.9877, "0.988"), (0.62, "0.62"), (0.021, "0.021")):
        (said,) = undetected_text([seen_from("electrical_fault", f=f)])
        assert f"electrical_fault from f = {shown} (" in said
    (said,) = undetected_text([seen_from("coulomb_friction", F_c=0.18937)])
    assert "F_c = 0.19 N (" in said


def test_one_other_is_in_the_singular() -> None:
    several = [seen_from("coulomb_friction", F_c=float(n)) for n in range(1, 5)]
    (said,) = undetected_text(several)
    assert said.endswith(", and 1 other from less force")
