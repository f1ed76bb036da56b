"""Names and units of a log's own: what is accepted, what is refused, and with which words."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from erdctl.core.errors import ExitCode, InputProblem, UsageProblem
from erdctl.io.maps import parse_maps
from erdctl.io.units import TARGETS, conversion, factor_between

# unit, column, a value in that unit, the value in SI from the unit's definition
DEFINITIONS = [
    ("mm", "x", 12.3, 0.0123),
    ("um", "x", 5.0, 5e-6),
    ("µm", "x", 5.0, 5e-6),
    ("in", "x", 1.0, 0.0254),
    ("mm/s", "xdot", 40.0, 0.04),
    ("in/s", "xdot", 2.0, 0.0508),
    ("ms", "t", 250.0, 0.25),
    ("min", "t", 2.0, 120.0),
    ("kN", "force", 1.5, 1500.0),
    ("daN", "force", 1.5, 15.0),
    ("kgf", "force", 1.0, 9.80665),
    ("lbf", "force", 1.0, 4.4482216152605),
    ("%", "duty", 35.0, 0.35),
    ("percent", "duty", 35.0, 0.35),
    ("-", "duty", 0.35, 0.35),
    ("1", "duty", 0.35, 0.35),
    ("K", "temperature", 273.15, 0.0),
    ("degF", "temperature", 212.0, 100.0),
    ("°F", "temperature", 32.0, 0.0),
    ("C", "temperature", 21.5, 21.5),
    ("°C", "temperature", 21.5, 21.5),
]


@pytest.mark.parametrize(("unit", "column", "value", "expected"), DEFINITIONS)
def test_values_from_the_definitions(unit: str, column: str, value: float, expected: float) -> None:
    (mapping,) = parse_maps([f"{column}=A[{unit}]"])
    name, convert = mapping.find(["A"], "log.csv")
    assert name == "A"
    assert convert(np.array([value]))[0] == pytest.approx(expected, rel=4e-16, abs=1e-13)


@settings(deadline=None)  # the first one imports pint
@given(st.integers(-(10**6), 10**6))
def test_conversion_costs_no_more_than_the_last_digit(micrometres: int) -> None:
    convert = conversion("mm", "x", "")
    got = convert(np.array([float(f"{micrometres}e-3")]))[0]
    expected = float(f"{micrometres}e-6")
    assert abs(got - expected) <= np.spacing(abs(expected))


def test_si_values_are_not_copied() -> None:
    values = np.arange(3.0)
    assert conversion("N", "force", "")(values) is values


def test_values_given_are_never_changed() -> None:
    values = np.arange(3.0)
    values.setflags(write=False)
    conversion("degF", "temperature", "")(values)
    assert values.tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("spec", "columns", "found", "factor"),
    [
        ("x=Defl FL[mm]", ["t", "Defl FL"], "Defl FL", 1e-3),
        ("x=Defl FL[mm]", ["t", "Defl FL[mm]"], "Defl FL[mm]", 1e-3),
        ("x=Defl FL[mm]", ["t", "Defl FL [mm]"], "Defl FL [mm]", 1e-3),
        ("x=Defl FL [mm]", ["t", "Defl FL[mm]"], "Defl FL[mm]", 1e-3),
        ("x=Defl FL", ["t", "Defl FL [mm]"], "Defl FL [mm]", 1e-3),
        ("x=Defl FL", ["t", "Defl FL"], "Defl FL", 1.0),
        ("x = Defl FL", ["t", "Defl FL"], "Defl FL", 1.0),
        ("x=a=b[mm]", ["a=b"], "a=b", 1e-3),
        ("x=Defl [FL][mm]", ["Defl [FL]"], "Defl [FL]", 1e-3),
        ("x=-Defl[mm]", ["Defl"], "Defl", -1e-3),
        ("x=-Defl", ["Defl [m]"], "Defl [m]", -1.0),
        ("x=-Defl", ["-Defl", "Defl"], "-Defl", 1.0),
        # the name as it was typed comes before every other reading
        ("x=A[mm]", ["A", "A[mm]"], "A[mm]", 1e-3),
        ("x=A", ["A [mm]", "A"], "A", 1.0),
    ],
)
def test_finding_the_column(spec: str, columns: list[str], found: str, factor: float) -> None:
    (mapping,) = parse_maps([spec])
    name, convert = mapping.find(columns, "log.csv")
    assert name == found
    assert convert(np.array([1.0]))[0] == factor


def test_record_has_no_unit() -> None:
    (mapping,) = parse_maps(["record=Test [N]"])
    assert mapping.find(["Test [N]"], "log.csv")[0] == "Test [N]"


@pytest.mark.parametrize(
    ("specs", "words"),
    [
        (["force=F[mm]"], "'force' mapped with unit 'mm', which is a length; expected"),
        (["force=F[mm]"], "something like N, kN"),
        (["force=F[kg]"], "which is a mass; expected something like N, kN, lbf, kgf"),
        (["duty=PWM[V]"], "which is a voltage; expected something like 1, percent, %"),
        (["x=A[m^2]"], "which is something else; expected something like m, mm"),
        (["x=A[furlongs per]"], "'furlongs per', which is not a unit"),
        (["x=A[mmm]"], "'mmm', which is not a unit"),
        (["x=A[0 mm]"], "'0 mm', which is not a unit"),
        (["x=A[5 N]"], "unit 'N', which is a force"),
        (["x=A[mm(]"], "'mm(', which is not a unit"),
        (["duty=A[dB]"], "'dB', which is not a unit"),
        (["x=A[]"], "no unit (- or 1), which is a plain number"),
        (["Force=F"], "unknown column 'Force'; did you mean 'force'? Columns are t, x, xdot"),
        (["zzz=F"], "unknown column 'zzz'; Columns are t, x, xdot"),
        (["force"], "write COLUMN=NAME[UNIT]"),
        (["force="], "write COLUMN=NAME[UNIT]"),
        (["=F"], "write COLUMN=NAME[UNIT]"),
        ([""], "write COLUMN=NAME[UNIT]"),
        (["x=A", "x=B"], "'x' is mapped twice"),
        (["x=A", "force=A"], "'A' is mapped to both 'x' and 'force'"),
    ],
)
def test_refused_specs(specs: list[str], words: str) -> None:
    with pytest.raises(UsageProblem) as caught:
        parse_maps(specs)
    assert words in str(caught.value)
    assert caught.value.exit_code == ExitCode.USAGE


def test_wrong_unit_in_the_logs_own_name() -> None:
    (mapping,) = parse_maps(["x=A"])
    with pytest.raises(UsageProblem, match="which is a force"):
        mapping.find(["A [N]"], "log.csv")


def test_missing_column_names_what_is_there_and_what_is_close() -> None:
    (mapping,) = parse_maps(["force=F_FL[N]"])
    with pytest.raises(InputProblem) as caught:
        mapping.find(["time", "F_fl", "Defl FL"], "log.csv")
    text = str(caught.value)
    assert text.startswith("log.csv: ")
    assert "no column 'F_FL'; close to it: F_fl; it has time, F_fl, Defl FL" in text
    assert caught.value.exit_code == ExitCode.BAD_INPUT


def test_a_name_that_fits_two_columns_is_not_guessed() -> None:
    (mapping,) = parse_maps(["force=F"])
    with pytest.raises(InputProblem, match=r"F \[N\], F\[kN\]"):
        mapping.find(["F [N]", "F[kN]"], "log.csv")


def test_long_lists_of_columns_are_cut() -> None:
    (mapping,) = parse_maps(["force=F"])
    with pytest.raises(InputProblem, match="c19 and 80 more"):
        mapping.find([f"c{i}" for i in range(100)], "log.csv")


@given(st.sampled_from(TARGETS), st.text("mskgNVACF%°1/*^ ()-_²·indB.'\\", max_size=8))
def test_no_unit_text_gets_past_as_anything_but_a_usage_problem(target: str, unit: str) -> None:
    with suppress(UsageProblem):
        parse_maps([f"{target}=A[{unit}]"])


@pytest.mark.parametrize(
    ("given_unit", "wanted", "factor"),
    [("mm", "m", 1e-3), ("N/(mm/s)", "N*s/m", 1e3), ("ms", "s", 1e-3), ("kN/m", "N/m", 1e3)],
)
def test_factor_between(given_unit: str, wanted: str, factor: float) -> None:
    assert factor_between(given_unit, wanted, "file: k_nom") == factor


def test_factor_between_refuses_other_dimensions() -> None:
    with pytest.raises(InputProblem, match="k_nom is given in unit 'mm', which is a length"):
        factor_between("mm", "N/m", "p.json: k_nom")


def test_si_needs_no_unit_library() -> None:
    program = (
        "import sys; from erdctl.io.maps import parse_maps;"
        "parse_maps(['force=F[N]', 'x=A', 'duty=P[-]', 'temperature=T[°C]']);"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0
