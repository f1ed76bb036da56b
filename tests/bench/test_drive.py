"""Described drives: the grammar of --drive, the motions and the duty over them."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from erdctl.bench.drive import Drive, drives, parse_drive, record
from erdctl.bench.waveforms import KINDS, Noise, Sine, Sweep
from erdctl.core.errors import UsageProblem
from erdctl.core.recording import Array


@st.composite
def described(draw: st.DrawFn) -> Drive:
    """Drives over the whole accepted range of every key, short enough for a test."""
    shape = draw(st.sampled_from(sorted(KINDS)))
    values: dict[str, Any] = {}
    kind: Any = KINDS[shape]
    for key in dataclasses.fields(kind):
        default: Any = key.default
        if isinstance(default, int):
            values[key.name] = draw(st.integers(*key.metadata["range"]))
        elif isinstance(default, float):
            values[key.name] = draw(st.floats(*key.metadata["range"]))
        else:
            values[key.name] = draw(st.sampled_from(type(default)))
    if "every" in values:
        values["every"] = max(values["every"], values["width"])
    motion = KINDS[shape](**values)
    fs = draw(st.floats(0.1, 1e6))
    assume(fs > 2.001 * motion.fastest)
    duration = draw(st.floats(2, 400)) / fs
    assume(1e-4 <= duration <= 1e6)
    duty = "|".join(map(repr, draw(st.lists(st.floats(0, 1), min_size=1, max_size=4))))
    if draw(st.booleans()):
        duty = f"{draw(st.floats(0, 1))!r}..{draw(st.floats(0, 1))!r}"
    hold, offset = draw(st.floats(1e-4, 1e6)), draw(st.floats(-1, 1))
    described = Drive(motion=motion, fs=fs, duration=duration, hold=hold, offset=offset)
    return parse_drive(str(described).rpartition(",")[0] + f",duty={duty}")


def reach(drive: Drive) -> float:
    """Largest |x - offset| that the drive promises [m]."""
    rms: float = getattr(drive.motion, "rms", 0.0)
    amp: float = getattr(drive.motion, "amp", rms * math.sqrt(128))
    return amp


def motion(spec: str, t: list[float]) -> tuple[Array, Array]:
    drive = parse_drive(spec)
    return drive.motion(np.array(t), drive.duration)


@given(described())
def test_a_drive_survives_its_own_text(drive: Drive) -> None:
    assert parse_drive(str(drive)) == drive


@given(described())
def test_every_accepted_drive_is_a_usable_recording(drive: Drive) -> None:
    made = record(drive)
    assert len(made) == drive.samples
    assert np.all(np.diff(made.t) > 0)
    for channel in (made.t, made.x, made.xdot, made.duty):
        assert np.isfinite(channel).all()
    assert np.all((made.duty >= 0) & (made.duty <= 1))
    assert np.all(np.abs(made.x - drive.offset) <= reach(drive) * (1 + 1e-9) + 1e-12)


@given(described())
@settings(max_examples=200)
def test_xdot_is_the_derivative_of_x(drive: Drive) -> None:
    """x(t + h) - x(t - h) = 2 h xdot + O(h^3), away from the corners of a motion."""
    scale = max(drive.motion.fastest, 1 / drive.duration)
    h = 1e-4 / scale
    t = np.linspace(0.1, 0.9, 50) * min(drive.duration, 20 / scale)
    x_low, low = drive.motion(t - h, drive.duration)
    x_high, high = drive.motion(t + h, drive.duration)
    _, xdot = drive.motion(t, drive.duration)
    top = float(np.max(np.abs(np.concatenate([low, high, xdot]))))
    # A corner between the two shows in their speeds; it cannot hide, since h resolves the motion.
    smooth = np.abs(high - low) <= 0.05 * top
    rounding = 1e-15 * reach(drive) / h + 1e-300  # the latter for subnormal amplitudes
    difference = (x_high - x_low) / (2 * h)
    error = np.abs(difference - xdot)[smooth]
    assert np.all(error <= 2e-3 * top + rounding)
    assert smooth.sum() >= 25 or top == 0


@pytest.mark.parametrize(
    ("spec", "t", "x", "xdot"),
    [
        ("sine:freq=1,amp=0.01", [0.0, 0.25, 0.5], [0, 0.01, 0], [0.0628319, 0, -0.0628319]),
        ("triangle:speed=0.1,amp=0.01", [0.0, 0.1, 0.2, 0.3], [0, 0.01, 0, -0.01], None),
        (
            "triangle:speed=0.1,amp=0.01",
            [0.05, 0.15, 0.35],
            [0.005, 0.005, -0.005],
            [0.1, -0.1, 0.1],
        ),
        ("bumps:amp=0.01,width=0.5", [0.125, 0.25, 0.75], [0.005, 0.01, 0], [0.0628319, 0, 0]),
        ("bumps:amp=0.01,width=0.5", [1.125, 1.375], [0.005, 0.005], [0.0628319, -0.0628319]),
        ("hold", [0.0, 5.0], [0, 0], [0, 0]),
        # phi = 2 pi 1.5, f = 2 Hz at t = 1 s
        ("sweep:f0=1,f1=3,amp=0.01,duration=2", [1.0], [0], [-0.01 * 4 * math.pi]),
        # f = sqrt(1 * 4) = 2 Hz at t = T / 2, phi = 2 pi (2 - 1) 2 / ln 4 = 9.0647
        (
            "sweep:f0=1,f1=4,amp=0.01,scale=log,duration=2",
            [1.0],
            [0.01 * math.sin(9.0647)],
            [0.01 * 4 * math.pi * math.cos(9.0647)],
        ),
    ],
)
def test_hand_calculated_motion(
    spec: str, t: list[float], x: list[float], xdot: list[float] | None
) -> None:
    found = motion(spec, t)
    assert found[0] == pytest.approx(x, abs=1e-6)
    if xdot is not None:
        assert found[1] == pytest.approx(xdot, abs=1e-5)


def test_a_logarithmic_sweep_of_one_frequency_is_a_sine() -> None:
    t = np.linspace(0, 2, 101)
    sine = Sine(freq=2.0, amp=0.01)(t, 2.0)
    for f1 in ("2", "2.0000000001"):
        for scale in ("log", "linear"):
            sweep = parse_drive(f"sweep:f0=2,f1={f1},amp=0.01,scale={scale},duration=2").motion
            assert isinstance(sweep, Sweep)
            assert np.allclose(sweep(t, 2.0), sine, rtol=0, atol=1e-9)


def test_noise_has_its_rms_and_its_band() -> None:
    noise = Noise(rms=0.001, f_max=10.0, seed=5)
    t = np.arange(400_000) / 200.0
    x, xdot = noise(t, 2000.0)
    assert np.sqrt(np.mean(x**2)) == pytest.approx(0.001, rel=0.05)
    # Uniform over 0..f_max: the mean of f^2 is f_max^2 / 3.
    assert np.sqrt(np.mean(xdot**2)) == pytest.approx(0.0363, rel=0.05)
    power = np.abs(np.fft.rfft(x)) ** 2
    frequency = np.fft.rfftfreq(len(x), 1 / 200.0)
    assert power[frequency > 10.1].sum() < 1e-3 * power.sum()
    other = Noise(rms=0.001, f_max=10.0, seed=6)(t[:100], 2000.0)[0]
    assert not np.allclose(other, x[:100])


def test_levels_of_duty_are_held_and_repeated() -> None:
    made = record(parse_drive("hold:duty=0.1|0.3,hold=0.3,fs=10,duration=1.2"))
    assert made.duty.tolist() == [0.1] * 3 + [0.3] * 3 + [0.1] * 3 + [0.3] * 3


def test_a_ramp_of_duty_spans_the_drive() -> None:
    made = record(parse_drive("hold:duty=0..0.4,duration=10,fs=1"))
    assert made.duty == pytest.approx(0.04 * np.arange(10))
    down = record(parse_drive("hold:duty=0.4..0,duration=10,fs=1"))
    assert down.duty == pytest.approx(0.4 - 0.04 * np.arange(10))


def test_several_drives_are_several_records() -> None:
    made = drives(["sine:duration=1", "hold:duration=2,fs=100,offset=0.005", "sine:duration=1"])
    assert made.names == ("sine-1", "hold-2", "sine-3")
    assert made.starts.tolist() == [0, 1000, 1200, 2200]
    assert made.t[made.starts[:-1]].tolist() == [0, 0, 0]
    assert np.all(made.x[1000:1200] == 0.005)
    assert made.force is None
    with pytest.raises(UsageProblem, match="sine:freq"):
        drives([])


@pytest.mark.parametrize(
    ("spec", "names"),
    [
        ("", "sine, sweep, triangle, bumps, hold, noise"),
        ("sin:freq=1", "'sin'"),
        ("sine:frq=1", "freq, amp, hold, duration, fs, offset, duty"),
        ("sine:freq", "key=value"),
        ("sine:freq=1,", "key=value"),
        ("sine:freq=1,freq=2", "twice"),
        ("sine:amp=10mm", "amplitude, 0..1 m"),
        ("sine:amp=10", "out of range"),
        ("sine:amp=nan", "out of range"),
        ("sine:freq=-1", "out of range"),
        ("sine:freq=600", "fs above 1200 Hz"),
        ("sine:duration=1e6,fs=1e6", "samples"),
        ("sine:duration=0.001", "samples"),
        ("sine:duty=30", "30 % is 0.3"),
        ("sine:duty=nan", "0..1"),
        ("sine:duty=", "nor a ramp"),
        ("sine:duty=0.1|", "nor a ramp"),
        ("sine:duty=0..0.1..0.2", "two ends"),
        ("sine:hold=0", "time at each level"),
        ("sweep:scale=cubic", "linear or log"),
        ("noise:seed=0.5", "seed"),
        ("bumps:width=2,every=1", "every=1"),
        ("hold:amp=0.01", "'amp'"),
    ],
)
def test_a_bad_specification_is_named_with_what_is_allowed(spec: str, names: str) -> None:
    with pytest.raises(UsageProblem) as caught:
        parse_drive(spec)
    assert f"drive '{spec}'" in str(caught.value)
    assert names in str(caught.value)


@given(st.text(max_size=20) | st.from_regex(r"(sine|bumps|noise|hold):[a-z_0-9=.,|]{0,25}"))
def test_any_text_is_a_drive_or_a_usage_problem(spec: str) -> None:
    try:
        drive = parse_drive(spec)
    except UsageProblem:
        return
    assert parse_drive(str(drive)) == drive
