"""A duty that the log shows later than the supply has it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from by_hand import signals
from rig import campaign, every, noisy

from erdctl.core.recording import Recording
from erdctl.diagnose.diagnosis import diagnose
from erdctl.diagnose.wording import finding_text
from erdctl.effects import get
from erdctl.effects.duty_skew import duty_skew
from erdctl.effects.input_delay import input_delay

RIVALS = (
    "coulomb_friction", "duty_skew", "field_threshold", "input_delay", "rise_decay_asymmetry",
    "supply_slew", "time_skew",
)  # fmt: skip


def late(r: Recording, samples: int) -> Recording:
    """The same with the duty so many samples late."""
    duty = r.duty.copy()
    for part in r.slices:
        duty[part] = np.concatenate([np.full(samples, duty[part][0]), duty[part][:-samples]])
    return replace(r, duty=duty)


@pytest.mark.parametrize("steps", [1, 4, 60])
def test_it_takes_back_whole_steps_of_delay(steps: int) -> None:
    """As far as the record still shows what was set; after that its last value holds."""
    field = np.repeat(np.array([0.0, 1.0, 0.3, 0.7]), 25)
    s, tau = signals(np.ones(100), step=0.01), {"tau": 0.01 * steps}
    seen = np.concatenate([np.zeros(steps), field[:-steps]])
    again = duty_skew(seen, s, tau, "release")
    assert again[: 100 - steps] == pytest.approx(field[: 100 - steps])
    assert again[100 - steps :] == pytest.approx(seen[-1])


def test_parts_of_a_step_are_the_mirror_of_a_dead_time() -> None:
    """Backwards in time an early duty is a late one."""
    field = np.random.default_rng(3).uniform(size=60)
    s, tau = signals(np.ones(60), step=0.01), {"tau": 0.0137}
    ahead = duty_skew(field, s, tau, "release")[:-1]
    held = np.concatenate([field[:-1][::-1], [0.0]])
    back = input_delay(held, s, tau, "release")[:-1][::-1]
    inner = slice(0, -3)  # at the ends either holds another sample
    assert ahead[inner] == pytest.approx(back[inner])


@pytest.mark.few(1)
@pytest.mark.parametrize("samples", [1, 2])
def test_a_duty_that_is_logged_late_has_a_name(samples: int) -> None:
    """A friction that goes with a power of the duty was learned, and stood beside a rest that "is
    noise as far as these data tell"."""
    seen = noisy(late(campaign(100.0, 8.0), samples), 5, rms=0.2)
    found = diagnose(seen, [get(n) for n in RIVALS], limits=False)
    (finding,) = found.findings
    assert finding.effect.name == "duty_skew"
    assert finding.equivalent == ()
    assert found.verdict.value == "explained"
    assert found.fit.values["duty_skew.tau"] == pytest.approx(0.01 * samples, abs=1e-3)


@pytest.mark.long
def test_a_duty_that_switches_between_samples_is_said_to() -> None:
    """It is half a sample late in the mean, on a bench on which nothing is."""
    found = diagnose(
        noisy(every(campaign(1000.0, 8.0), 20), 5, rms=0.1), [get(n) for n in RIVALS], limits=False
    )
    (finding,) = found.findings
    assert finding.effect.name == "duty_skew"
    assert found.fit.values["duty_skew.tau"] == pytest.approx(0.01, abs=3e-3)
    assert "less than the 20 ms between samples, as of a duty that switches" in finding_text(
        finding
    )


def test_a_duty_that_is_later_than_a_sample_is_late() -> None:
    assert get("duty_skew").caveat({"tau": 0.021}, 0.02) == ""
