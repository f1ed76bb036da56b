"""What a finding is said to be worth, against the two mean squares that it comes from."""

from __future__ import annotations

import re
from typing import Any, cast

import pytest

from erdctl.diagnose.findings import Finding
from erdctl.diagnose.wording import finding_text
from erdctl.effects import get


class _Gain:
    gain = 0.75


def test_the_percentage_is_what_the_two_errors_differ_by() -> None:
    """0.04 without and 0.02 with it: a quarter of the square is left, so it is 75 % lower.

    Leaving the effect out makes it four times as large, which costs 300 % and not 75 %.
    """
    found = Finding(
        effect=get("backlash"), equivalent=(), test=None, gain=cast(Any, _Gain()), acts=(),
        before=0.04, after=0.02, runner_up=None,
    )  # fmt: skip
    said = re.search(
        r"with it the mean square error .* is (\d+) % lower"
        r" \(NRMSE ([\d.]+) without it, ([\d.]+) with it\)",
        finding_text(found),
    )
    assert said is not None
    lower, without, with_it = (float(v) for v in said.groups())
    assert lower == pytest.approx(100 * (1 - (with_it / without) ** 2))
