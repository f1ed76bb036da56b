"""Twelve files as labs hand them over, of one log each: who wrote it, its bytes, what is asked.

Imported by tests; the samples are `samples()` whatever the file.
"""

from __future__ import annotations

import datetime as dt
import io
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

N, RATE = 400, 200
START = dt.datetime(2022, 4, 29, 11, 56, 20, 699000)


def samples() -> dict[str, np.ndarray]:
    """t [s], x [m], force [N], duty [1], as they are printed below."""
    t = np.arange(N) / RATE
    x = np.round(0.02 * np.sin(2 * np.pi * 1.5 * t), 6)
    force = np.round(900.0 * np.cos(2 * np.pi * 1.5 * t) + 40.0 * np.sign(np.cos(9.42 * t)), 2)
    return {"t": t, "x": x, "force": force, "duty": np.full(N, 0.3)}


@dataclass(frozen=True)
class LabFile:
    """name : of the file;  who : writes such files;  assumed : words of the line that is said"""

    name: str
    who: str
    data: bytes
    options: tuple[str, ...]
    assumed: tuple[str, ...]


def _rows(form: Callable[[int, float, float, float], str]) -> list[str]:
    s = samples()
    return [form(i, s["t"][i], s["x"][i], s["force"][i]) for i in range(N)]


def _at(t: float) -> dt.datetime:
    return START + dt.timedelta(milliseconds=round(t * 1e3))


def _comma(text: str) -> str:
    return text.replace(".", ",")


def recorder() -> LabFile:
    lines = ["Header Size:  6", "Version:  2", "Sampling Interval:  0.005", "Sampling Rate:  200",
             "Device Serial Number:  0",
             "Sample Number, Date/Time, CHANNEL0, CHANNEL1, Events"]  # fmt: skip
    lines += _rows(
        lambda i, t, x, f: (
            f"{i + 1:10d},   {_at(t):%m/%d/%Y %I:%M:%S}.{_at(t).microsecond // 1000:03d}"
            f" AM, {f / 100:.4f}, {x * 100:.4f}" + (", DAQ Start" if i == 0 else "")
        )
    )
    return LabFile(
        "recorder.txt", "a data recorder", "\r\n".join(lines).encode(),
        ("--map", "force=CHANNEL0[100 N]", "--map", "x=CHANNEL1[0.01 m]"),
        ("commas", "header in line 6", "'Events' absent", "mm/dd/yyyy"),
    )  # fmt: skip


def labview() -> LabFile:
    lines = [
        "LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab",
        "Decimal_Separator\t,", "Multi_Headings\tNo", "X_Columns\tOne", "Time_Pref\tRelative",
        "Operator\tMeier", "Date\t2022/04/29", "Time\t11:56:20,6990", "***End_of_Header***\t", "\t",
        "Channels\t2\t\t", f"Samples\t{N}\t{N}\t", "Date\t2022/04/29\t2022/04/29\t",
        "Time\t11:56:20,6990\t11:56:20,6990\t", "Y_Unit_Label\tmm\tkN\t",
        "X_Dimension\tTime\tTime\t", "X0\t0,0000000000000000E+0\t0,0000000000000000E+0\t",
        "Delta_X\t0,005000\t0,005000\t", "***End_of_Header***\t\t\t",
        "X_Value\tStroke\tLoad\tComment",
    ]  # fmt: skip
    lines += _rows(lambda i, t, x, f: _comma(f"{t:.6f}\t{x * 1e3:.6f}\t{f / 1e3:.6f}\t"))
    return LabFile(
        "bench.lvm", "LabVIEW (.lvm)", "\r\n".join(lines).encode(), (),
        ("tabs", "decimal comma", "LabVIEW", "header in line 23"),
    )  # fmt: skip


def labview_text() -> LabFile:
    lines = ["Bench 3", "Operator\tMeier", "Rate [Hz]\t200", "",
             "Zeit\tWeg (mm)\tKraft (N)"]  # fmt: skip
    lines += _rows(
        lambda i, t, x, f: (
            f"{_at(t):%d.%m.%Y %H:%M:%S},{_at(t).microsecond // 1000:03d}\t"
            + _comma(f"{x * 1e3:.3f}\t{f:.2f}")
        )
    )
    return LabFile(
        "labview.txt", "LabVIEW, tabs and dates", "\r\n".join(lines).encode("cp1252"), (),
        ("tabs", "decimal comma", "header in line 5", "dd.mm.yyyy"),
    )  # fmt: skip


def excel_german() -> LabFile:
    lines = ["sep=;", "Zeit;Weg;Kraft;Tastgrad", "s;mm;N;%"]
    lines += _rows(
        lambda i, t, x, f: _comma(f"{t:.3f};{x * 1e3:.3f};")
        + f"{f:,.2f}".replace(",", "_").replace(".", ",").replace("_", ".") + ";30"
    )  # fmt: skip
    return LabFile(
        "excel.csv", "Excel, German", "\r\n".join(lines).encode("cp1252"), (),
        ("semicolons", "decimal comma", "header in line 2", "units in line 3"),
    )  # fmt: skip


def utf16_tabs() -> LabFile:
    lines = ["Time (s)\tDeflection (mm)\tLoad (N)\tDuty cycle [%]"]
    lines += _rows(lambda i, t, x, f: f"{t:.3f}\t{x * 1e3:.3f}\t{f:.2f}\t30")
    return LabFile(
        "export.txt", "Excel, Unicode text", "\r\n".join(lines).encode("utf-16"), (),
        ("UTF-16", "tabs", "header in line 1", "x is 'Deflection (mm)'"),
    )  # fmt: skip


def mts() -> LabFile:
    lines = ["MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A", "",
             "Data Acquisition:\tTimed\t\tData Header:\tTime:\t12.345\tSec\t4/29/2022 11:56:20 AM",
             "Station Name:\tdamper.cfg", "Test File Name:\tsine.000",
             "Time\tAxial Displacement\tAxial Force", "Sec\tmm\tkN"]  # fmt: skip
    lines += _rows(lambda i, t, x, f: f"{t + 3.25:.5f}\t{x * 1e3:.5f}\t{f / 1e3:.6f}")
    return LabFile(
        "mts.dat", "MTS TestStar", "\r\n".join(lines).encode(), (),
        ("tabs", "header in line 6", "units in line 7", "force is 'Axial Force' in kN"),
    )  # fmt: skip


def iso() -> LabFile:
    lines = ["timestamp,x,force,duty"]
    lines += _rows(lambda i, t, x, f: f"{_at(t).isoformat(timespec='milliseconds')}Z,{x},{f},0.3")
    return LabFile(
        "iso.csv", "a script, ISO 8601", "\n".join(lines).encode(), (),
        ("commas", "yyyy-mm-dd", "as seconds from the first sample"),
    )  # fmt: skip


def timedelta() -> LabFile:
    lines = ["time,x,force,duty"]
    lines += _rows(
        lambda i, t, x, f: f"0 days 00:00:{int(t):02d}.{round(t * 1e3) % 1000:03d}000,{x},{f},0.3"
    )
    return LabFile(
        "pandas.csv", "pandas, timedelta", "\n".join(lines).encode(), (),
        ("commas", "durations"),
    )  # fmt: skip


def am_pm() -> LabFile:
    lines = ["Date|Time|Stroke [in]|Load [lbf]"]
    lines += _rows(
        lambda i, t, x, f: (
            f"4/29/2022|{_at(t):%I:%M:%S}.{_at(t).microsecond // 1000:03d} AM|"
            f"{x / 0.0254:.6f}|{f / 4.4482216152605:.5f}"
        )
    )
    return LabFile(
        "us.txt", "a US logger, AM/PM", "\r\n".join(lines).encode(), (),
        ("bars", "'Date' and 'Time'", "x is 'Stroke [in]'"),
    )  # fmt: skip


def degrees() -> LabFile:
    lines = ["% Prüfstand 3, Öl 46", "Zeit [s];Weg [mm];Kraft [N];Öltemperatur [°C]"]
    lines += _rows(lambda i, t, x, f: _comma(f"{t:.3f};{x * 1e3:.3f};{f:.2f};23.5"))
    return LabFile(
        "latin1.asc", "a German logger, Latin-1", "\r\n".join(lines).encode("latin-1"), (),
        ("Latin-1", "semicolons", "decimal comma", "header in line 2"),
    )  # fmt: skip


def fixed() -> LabFile:
    lines = ["      time          disp         force", "       [s]           [m]           [N]"]
    lines += _rows(lambda i, t, x, f: f"{t:10.3f}  {x:12.6f}  {f:12.2f}")
    return LabFile(
        "columns.prn", "Fortran, fixed columns", "\n".join(lines).encode(), (),
        ("blanks", "units in line 2"),
    )  # fmt: skip


def savetxt() -> LabFile:
    text = io.StringIO()
    s = samples()
    np.savetxt(
        text, np.column_stack([s["t"], s["x"], s["force"]]), delimiter=",", fmt="%.9e",
        header="rig 3, sine 1.5 Hz\nTime (s), Displacement (m), Force (N)",
    )  # fmt: skip
    return LabFile(
        "numpy.txt", "numpy.savetxt", text.getvalue().encode(), (),
        ("commas", "header in line 2"),
    )  # fmt: skip


ALL = (
    recorder, labview, labview_text, excel_german, utf16_tabs, mts, iso, timedelta, am_pm, degrees,
    fixed, savetxt,
)  # fmt: skip
