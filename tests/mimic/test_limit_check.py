"""The check that stands between a computed sequence and the file: it finds what is put in."""

from __future__ import annotations

import numpy as np
import pytest
from rig import recording

from erdctl.core.errors import ComputationProblem, ExitCode
from erdctl.core.recording import Array
from erdctl.mimic import sequence as module
from erdctl.mimic.check import breaches, check_limits
from erdctl.model.amplifier import Amplifier

AMPLIFIER = Amplifier(duty_max=0.4, resolution=0.01, slew=1.0, update_rate=50.0)
T = np.arange(200) * 0.005
STARTS = np.array([0, 100, 200])


def sound() -> Array:
    """A staircase that takes each limit to its end, in two records."""
    part = np.repeat(np.concatenate([0.02 * np.arange(20), 0.38 - 0.02 * np.arange(5)]), 4)
    return np.concatenate([part, part[::-1]])


def times() -> Array:
    return np.concatenate([T[:100], T[:100]])


def test_a_sound_sequence_passes() -> None:
    assert breaches(sound(), times(), STARTS, AMPLIFIER) == []


@pytest.mark.parametrize(
    ("limit", "sample", "value"),
    [
        ("duty", 30, -0.01), ("duty", 30, np.nan), ("highest duty", 77, 0.41),
        ("resolution", 12, 0.0603), ("time between updates", 41, 0.19), ("slew", 44, 0.23),
    ],
)  # fmt: skip
def test_one_wrong_value_is_found(limit: str, sample: int, value: float) -> None:
    duty = sound()
    duty[sample] = value
    found = [b for b in breaches(duty, times(), STARTS, AMPLIFIER) if b.limit == limit]
    assert found
    assert found[0].sample == sample


def test_a_leap_after_a_rest_is_found() -> None:
    duty = np.where(np.arange(200) < 150, 0.1, 0.3)
    (found,) = breaches(duty, times(), STARTS, AMPLIFIER)
    assert (found.limit, found.sample) == ("slew", 150)


def test_a_record_starts_anew() -> None:
    duty = np.where(np.arange(200) < 100, 0.1, 0.3)
    assert breaches(duty, times(), STARTS, AMPLIFIER) == []
    assert breaches(duty, T, np.array([0, 200]), AMPLIFIER) != []


def test_what_breaks_a_limit_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if the computation were wrong: channel, row, time, value and limit are said."""
    r = recording(T, 0.01 * np.sin(9 * T), 0.09 * np.cos(9 * T), np.full(200, 0.3))
    wrong = np.full(200, 0.3)
    wrong[120:] = 0.1
    with pytest.raises(ComputationProblem) as problem:
        check_limits({"fl": wrong, "fr": wrong}, r, Amplifier(slew=2.0))
    said = str(problem.value)
    assert said.startswith("channel fl, data row 121 (t = 0.6 s): slew")
    assert "where 2 1/s is allowed" in said
    assert problem.value.exit_code is ExitCode.NOT_COMPLETED
    from test_hold import PARAMETERS

    from erdctl.model.faults import parse_fault

    monkeypatch.setattr(module, "follow", lambda *_: wrong)
    with pytest.raises(ComputationProblem, match="channel fr, data row 121"):
        module.sequence(PARAMETERS, r, [parse_fault("oil=0.5")], Amplifier(slew=2.0))
