"""A duty that a log has under some other name is never taken as no control."""

from __future__ import annotations

from pathlib import Path

import pytest

from erdctl.core.errors import InputProblem
from erdctl.io.logs import Log, read_logs

# Names under which a duty is recorded, and what the way out is said to be.
CONTROLS = {
    "Duty %": "Duty %[%]", "duty_pct": "duty_pct[%]", "PWM%": "PWM%[%]", "PWM_FL": "PWM_FL[UNIT]",
    "pwm1": "pwm1[UNIT]", "duty [V]": "duty [V][UNIT]", "PWM (counts)": "PWM (counts)[UNIT]",
    "PWM [0-255]": "PWM [0-255][UNIT]", "Duty FL [%]": "Duty FL [%]",
    "Duty command [%]": "Duty command [%]", "Tastgrad VL": "Tastgrad VL[UNIT]", "PWM": "PWM[1]",
    "PWM channel 1 [%]": "PWM channel 1 [%]", "Duty on FL": "Duty on FL[UNIT]",
}  # fmt: skip
BESIDE = ("PWM frequency [Hz]", "PWM carrier", "pwm on [ms]", "duty status", "pump")


def read(folder: Path, name: str, *maps: str) -> Log:
    file = folder / "lab.csv"
    lines = [f"{0.005 * i:.3f},{1e-3 * (i % 7)},{i % 5 - 2},{0.1 * (i // 20)}" for i in range(60)]
    file.write_text("\n".join([f"t,x,force,{name}", *lines, ""]))
    return read_logs([str(file)], maps=maps, need_force=True, report=lambda line: None)


@pytest.mark.parametrize(("name", "way"), CONTROLS.items())
def test_it_is_asked_for(tmp_path: Path, name: str, way: str) -> None:
    with pytest.raises(InputProblem, match="'duty' may be") as caught:
        read(tmp_path, name)
    assert f'--map "duty={way}"' in str(caught.value)
    assert not read(tmp_path, name, "duty=0").recording.duty.any()


def test_what_is_said_to_do_is_right(tmp_path: Path) -> None:
    for name, way in CONTROLS.items():
        if way.endswith("[%]"):
            duty = read(tmp_path, name, f"duty={way}").recording.duty
            assert duty.max() == pytest.approx(0.002)


@pytest.mark.parametrize("name", BESIDE)
def test_what_a_pwm_has_beside_it_is_no_duty(tmp_path: Path, name: str) -> None:
    assert not read(tmp_path, name).recording.duty.any()
