"""Texts as labs write them, one peculiarity each: read right, or stopped with what decides."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from erdctl.core.errors import ErdctlError, InputProblem, UsageProblem
from erdctl.core.recording import Recording
from erdctl.io.logs import read_logs

N = 30
T = np.arange(N) * 0.005
X = np.round(5e-3 * np.sin(20 * T) + 1e-5, 7)
F = np.round(100.0 * np.cos(20 * T), 3)
LABVIEW = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
    "Decimal_Separator\t.\nMulti_Headings\tYes\nX_Columns\t{}\n***End_of_Header***\t\n\t\n"
)
SEGMENT = (
    "Channels\t2\t\nSamples\t30\t30\t\nY_Unit_Label\tmm\tN\nX_Dimension\tTime\tTime\n"
    "X0\t{0}\t{0}\nDelta_X\t0.005\t0.005\n***End_of_Header***\t\t\n"
    "X_Value\tStroke\tForce\tComment\n"
)


class Reading:
    """What was read of a text, and what was said."""

    def __init__(self, path: Path, content: str | bytes, /, **options: Sequence[str]) -> None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.said: list[str] = []
        self.recording: Recording = read_logs(
            [str(path)], need_force=True, report=self.said.append, **options
        ).recording

    def holds(self, t: object = T, copies: int = 1) -> bool:
        r = self.recording
        return (
            np.allclose(r.t, t, rtol=0, atol=1e-12)
            and np.allclose(r.x, np.tile(X, copies), rtol=0, atol=1e-12)
            and np.allclose(r.force, np.tile(F, copies), rtol=0, atol=1e-9)
        )


Read = Callable[..., Reading]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    def read(content: str | bytes, /, **options: Sequence[str]) -> Reading:
        return Reading(tmp_path / "lab.txt", content, **options)

    return read


def rows(form: Callable[[int], str], between: str = ";", n: int = N) -> str:
    """Lines of a time in this form, x in mm and the force."""
    return "".join(
        between.join([form(i), f"{X[i] * 1e3:.4f}", f"{F[i]:.3f}"]) + "\n" for i in range(n)
    )


def ms(i: int) -> str:
    return f"{T[i]:.3f}"


HEADER = "t;x [mm];force\n"


@pytest.mark.parametrize(
    ("form", "words"),
    [
        (lambda i: f"29.04.2022 11:56:20,{5 * i:03d}", "dd.mm.yyyy"),
        (lambda i: f"04/29/2022 11:56:20.{5 * i:03d} AM", "mm/dd/yyyy"),
        (lambda i: f"29/04/2022 11:56:20.{5 * i:03d}", "dd/mm/yyyy"),
        (lambda i: f"29-Apr-2022 11:56:20.{5 * i:03d}", "dd-mmm-yyyy"),
        (lambda i: f"20220429T115620.{5 * i:03d}Z", "yyyy-mm-dd"),
        (lambda i: f"2022-04-29T11:56:20.{5 * i:03d}+02:00", "yyyy-mm-dd"),
        (lambda i: f"13:59:59.{5 * i:03d} PM", "hours of a 24 h clock"),
        (lambda i: f"0 days 00:00:00.{5 * i:03d}000", "durations"),
        (lambda i: f"{5 * i // 1000:02d}:00.{5 * i:03d}", "m:ss.f"),
        (lambda i: f"11:56:20:{5 * i:03d}", "h:mm:ss"),
    ],
)
def test_times_become_seconds(read: Read, form: Callable[[int], str], words: str) -> None:
    found = read(HEADER + rows(form))
    assert found.holds()
    assert words in found.said[0]


def midnight(first: str, second: str) -> Callable[[int], str]:
    return lambda i: (
        f"{first}23:59:59.{900 + 5 * i:03d}" if i < 20 else f"{second}00:00:00.{5 * (i - 20):03d}"
    )


def test_the_clock_passes_midnight(read: Read) -> None:
    found = read(HEADER + rows(midnight("", "")))
    assert found.holds()
    assert "the clock passes midnight" in found.said[0]


@pytest.mark.parametrize(
    ("first", "second", "right", "other"),
    [
        ("03/04/2022 ", "03/05/2022 ", "mdy", "dmy"),
        ("04-03-2022 ", "05-03-2022 ", "dmy", "mdy"),
        ("22/04/29 ", "22/04/30 ", "ymd", "dmy"),
        ("29.04.22 ", "30.04.22 ", "dmy", "ymd"),
    ],
)
def test_a_day_that_may_be_a_month(
    read: Read, first: str, second: str, right: str, other: str
) -> None:
    text = HEADER + rows(midnight(first, second))
    with pytest.raises(InputProblem, match=rf"row 22, column 't': .*date={right}"):
        read(text)
    assert read(text, text=[f"date={right}"]).holds()
    with suppress(ErdctlError):
        assert not read(text, text=[f"date={other}"]).holds()


@pytest.mark.parametrize(
    "form",
    [
        lambda i: "31.02.2022 10:00:00.{i:03d}",
        lambda i: f"29.04.2022 10:61:00.{i:03d}",
        lambda i: f"13:00:00.{i:03d} AM",
        lambda i: f"10:00:00.{i:03d} AM" if i % 2 else f"10:00:00.{i:03d}",
    ],
)
def test_times_that_do_not_exist(read: Read, form: Callable[[int], str]) -> None:
    with pytest.raises(InputProblem, match="column 't': "):
        read(HEADER + rows(form))


def test_stamps_coarser_than_samples(read: Read) -> None:
    coarse = rows(lambda i: f"11:56:{20 + int(T[i] * 20):02d}")
    with pytest.raises(InputProblem, match=r"share their stamp .* --text interval=SECONDS"):
        read(HEADER + coarse)
    fine = rows(lambda i: f"11:56:{20 + int(T[i]):02d}")
    assert read(HEADER + fine, text=["interval=0.005"]).holds()
    stated = read("Sampling Rate: 200 Hz\n" + HEADER + fine)
    assert stated.holds()
    assert "times are the interval 0.005 s that is stated" in stated.said[0]
    with pytest.raises(InputProblem, match=r"do not go on by 0\.5 s"):
        read(HEADER + fine, text=["interval=0.5"])


def test_a_stated_rate_that_does_not_fit_is_not_taken(read: Read) -> None:
    found = read("Sampling Rate: 100 Hz\n" + HEADER + rows(lambda i: f"11:56:20.{5 * i:03d}"))
    assert found.holds()


def test_no_times_at_all(read: Read) -> None:
    text = "Sampling Interval: 0.005 s\nn;x [mm];force\n" + rows(str)
    with pytest.raises(InputProblem, match=r"--text interval=0.005 makes a time of it"):
        read(text)
    assert read(text, text=["interval=0.005"]).holds()


# --- header


def test_without_a_header_columns_have_numbers(read: Read) -> None:
    text = rows(ms, ",")
    with pytest.raises(InputProblem, match=r'--map "t=column_1\[UNIT\]" --map "x=column_2'):
        read(text)
    maps = ["t=column_1[s]", "x=column_2[mm]", "force=column_3[N]"]
    assert read(text, maps=maps).holds()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("t;x [mm]\n" + rows(ms), "2 names in the header, but 3 cells"),
        ("t;x [mm];force\n0.0;ERR;ERR\n" + rows(ms), "row 2: neither names nor values"),
        ("t;x [mm];force\n-;m;-\n" + rows(ms), "mm by its name and m by the units in row 2"),
        ("t;x [mm];x [mm]\n" + rows(ms), "columns 2 and 3 are both called 'x [mm]'"),
        (HEADER + rows(ms) + "Mean;1;2\n", "row 32, column 't': found 'Mean'"),
        (HEADER + rows(ms) + "0.15;1.0\n", "row 32: 2 cells where the header has 3 columns"),
        (
            HEADER + "".join(f"{i}.5;0.5;1.5\n" for i in range(450)) + "450.5;1,234.5;1\n",
            "row 452, column 'x [mm]': found '1,234.5', expected a number with a decimal point; if",
        ),
        (HEADER + rows(ms).replace("100.000", "100.0D0"), "found '100.0D0', expected a number"),
        (HEADER + rows(ms) + HEADER + rows(ms), "row 32, column 't': found 't'"),
    ],
)
def test_refused(read: Read, text: str, words: str) -> None:
    with pytest.raises(InputProblem) as caught:
        read(text)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "Gain;1;1;1\nOffset;0;0;0\nn;t;x [mm];force\n"
        + "".join(f"{i};{r}\n" for i, r in enumerate(rows(ms).splitlines())),
        "| t | x [mm] | force |\n"
        + "".join(f"| {r.replace(';', ' | ')} |\n" for r in rows(ms).splitlines()),
        HEADER + rows(ms) + ";;\n;;\n",
        "a;b;c\nt;x;force\ns;mm;N\n" + rows(ms),
        '"t";"x [mm]";"force"\n'
        + "".join('"' + r.replace(";", '";"') + '"\n' for r in rows(ms).splitlines()),
    ],
)
def test_read(read: Read, text: str) -> None:
    assert read(text).holds()


def test_options_hold(read: Read) -> None:
    text = "a;b;c\n1;2;3\nt;x [mm];force\n" + rows(ms)
    assert read(text, text=["header=3"]).holds()
    japanese = "時間;変位 [mm];荷重\n".encode("shift_jis") + rows(ms).encode()
    maps = ["t=時間[s]", "x=変位", "force=荷重[N]"]
    assert read(japanese, text=["encoding=shift_jis"], maps=maps).holds()
    with pytest.raises(InputProblem, match="row 9: --text header=9: it holds no names"):
        read(text, text=["header=9"])


@pytest.mark.parametrize(
    ("option", "words"),
    [
        ("decimal", "write KEY=VALUE"),
        ("decimal=semicolon", "expected point, comma"),
        ("sep=comma", "unknown 'sep'; known are encoding, separator"),
        ("date=mm", "expected dmy, mdy, ymd"),
        ("header=0", "the number of a line, or none"),
        ("encoding=klingon", "a name like utf-8"),
        ("encoding=rot13", "a name like utf-8"),
        ("interval=-1", "seconds between samples"),
        ("decimal=comma,thousands=comma", "the same sign"),
    ],
)
def test_wrong_options(read: Read, option: str, words: str) -> None:
    with pytest.raises(UsageProblem) as caught:
        read(HEADER + rows(ms), text=[option])
    assert words in str(caught.value)


# --- LabVIEW


def test_labview_segments(read: Read) -> None:
    block = rows(ms, "\t")
    two = read(LABVIEW.format("One") + (SEGMENT.format(0) + block) * 2)
    assert two.recording.names == ("lab:1", "lab:2")
    assert two.holds(np.tile(T, 2), copies=2)
    later = rows(lambda i: f"{T[i] + 0.15:.3f}", "\t")
    on = read(LABVIEW.format("One") + SEGMENT.format(0) + block + SEGMENT.format(0.15) + later)
    assert on.holds(np.concatenate([T, T + 0.15]), copies=2)
    bad = later.replace(f"{F[3]:.3f}", "OVR")
    with pytest.raises(InputProblem, match="row 59, column 'Force': found 'OVR'"):
        read(LABVIEW.format("One") + SEGMENT.format(0) + block + SEGMENT.format(0.15) + bad)


def test_labview_without_times(read: Read) -> None:
    text = LABVIEW.format("No") + SEGMENT.format(0.5) + rows(lambda i: "", "\t")
    found = read(text)
    assert found.holds(T + 0.5)
    assert "times made of the interval 0.005 s" in found.said[0]


def test_labview_cut_off(read: Read) -> None:
    with pytest.raises(InputProblem, match="cut off"):
        read("LabVIEW Measurement\t\nWriter_Version\t2\n")


# --- names and errors


def test_all_that_is_missing_in_one_message(read: Read) -> None:
    text = "Time;Displacement;Load;PWM\n" + "".join(f"{r};30\n" for r in rows(ms).splitlines())
    with pytest.raises(InputProblem) as caught:
        read(text)
    for option in ("t=Time[s]", "x=Displacement[m]", "force=Load[N]", "duty=PWM[1]"):
        assert f'--map "{option}"' in str(caught.value)
    maps = ["t=Time[s]", "x=Displacement[mm]", "force=Load[N]"]
    assert read(text, maps=[*maps, "duty=PWM[%]"]).recording.duty[0] == 0.3
    assert read(text, maps=[*maps, "duty=0"]).recording.duty[0] == 0.0


def test_errors_of_all_columns_in_one_message(read: Read) -> None:
    lines = (HEADER + rows(ms)).splitlines()
    for separator in (";", ","):
        spoilt = [line.replace(";", separator) for line in lines]
        spoilt[5] = separator.join(["x", "1.0", "2.0"])
        spoilt[8] = separator.join(["0.035", "1.0", "OVR"])
        spoilt[11] = separator.join(["0.05", "1.0"])
        with pytest.raises(InputProblem) as caught:
            read("\n".join(spoilt) + "\n")
        for words in ("row 6, column 't': found 'x'", "row 9, column 'force': found 'OVR'",
                      "row 12: 2 cells"):  # fmt: skip
            assert words in str(caught.value)


def test_wrong_maps_in_one_message(read: Read) -> None:
    with pytest.raises(UsageProblem) as caught:
        read(HEADER + rows(ms), maps=["x=x[kN]", "force=force[mm]", "zz=q"])
    for words in ("'x' mapped with unit 'kN'", "'force' mapped with unit 'mm'", "column 'zz'"):
        assert words in str(caught.value)


def test_a_setpoint_is_not_the_measured_channel(read: Read) -> None:
    text = "Time (s);Displacement setpoint (mm);Displacement (mm);Force (N)\n" + "".join(
        f"{r.split(';')[0]};9;{';'.join(r.split(';')[1:])}\n" for r in rows(ms).splitlines()
    )
    assert read(text).holds()


def test_sensors_in_volts(read: Read) -> None:
    text = "t;U1 [V];U2\n" + rows(ms)
    assert read(text, maps=["x=U1[0.001 m]", "force=U2[1 N]"]).holds()
    turned = read(text, maps=["x=U1[1e-3 m]", "force=-U2[0.001 kN]"]).recording
    assert np.allclose(turned.force, -F, atol=1e-9)
    with pytest.raises(UsageProblem, match="which is a length"):
        read(text, maps=["force=U2[2 mm]"])
