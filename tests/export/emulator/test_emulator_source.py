"""The source compiles everywhere without a word, and says what it is."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from emulators import COMPILERS, DRIVER, NONSENSE, STRICT, sanitized, write
from places import FIXTURES

from erdctl.core.errors import UsageProblem
from erdctl.export.emulator.limits import EmulatorLimits
from erdctl.export.emulator.source import write_emulator
from erdctl.io.parameters import parse_parameters
from erdctl.model.amplifier import Amplifier

TABLE_2 = parse_parameters((FIXTURES / "table_2.json").read_bytes(), "table_2.json")
compiled = pytest.mark.skipif(not COMPILERS, reason="no C compiler")


@compiled
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("real", [(), ("-DERDCTL_FLOAT",)], ids=["double", "float"])
def test_no_warnings(compiler: str, real: tuple[str, ...], tmp_path: Path) -> None:
    block = write_emulator(TABLE_2, prefix="car_1")
    write(block, tmp_path)
    options = (*STRICT, "-Wshadow", "-Wdouble-promotion", "-O2", *real)
    subprocess.run([compiler, *options, "-c", "car_1.c", "-o", "car_1.o"], cwd=tmp_path, check=True)


@compiled
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("real", [(), ("-DERDCTL_FLOAT",)], ids=["double", "float"])
def test_sanitizers_find_nothing(compiler: str, real: tuple[str, ...], tmp_path: Path) -> None:
    block = write_emulator(TABLE_2, prefix="e")
    write(block, tmp_path)
    (tmp_path / "main.c").write_text(NONSENSE.replace("PREFIX", "e"))
    ran = sanitized(compiler, tmp_path, real)
    assert (ran.returncode, ran.stdout.strip()) == (0, "ok"), ran.stderr


@compiled
def test_four_dampers_link_into_one_program(tmp_path: Path) -> None:
    names = ["fl", "fr", "rl", "rr"]
    for name in names:
        write(write_emulator(TABLE_2, prefix=name), tmp_path)
    main = "".join(f'#include "{n}.h"\n' for n in names) + "int main(void) { return 0; }\n"
    (tmp_path / "main.c").write_text(main)
    subprocess.run(
        [COMPILERS[0], *STRICT, "main.c", *(f"{n}.c" for n in names), "-o", "main", "-lm"],
        cwd=tmp_path, check=True,
    )  # fmt: skip


def test_only_the_prefix_is_seen_from_outside() -> None:
    block = write_emulator(TABLE_2, prefix="fl")
    functions = re.findall(r"^(?!static|typedef|/|#| )[\w ]+[ *](\w+)\(", block.source, re.M)
    assert set(functions) == {"fl_defaults", "fl_init", "fl_faults", "fl_step"}
    assert "PREFIX" not in block.source + block.header
    assert "@" not in block.source + block.header
    assert set(re.findall(r"#include (\S+)", block.source)) == {"<math.h>", '"fl.h"'}
    assert not re.search(r"malloc|static (?!int|real|void|Span|Law|Left)", block.source)


def test_members_have_values_and_units() -> None:
    amplifier = Amplifier(duty_max=0.4, slew=3.0, resolution=0.01, update_rate=250.0)
    limits = EmulatorLimits(amplifier=amplifier, temperature_max=55.0)
    block = write_emulator(TABLE_2, prefix="fl", limits=limits)
    found = {m.path: (m.value, m.unit) for m in block.parameters}
    assert found["compression_sigma"] == (12.8157, "N")
    assert found["release_T_d"] == (0.043, "s")
    assert found["duty_max"] == (0.4, "1")
    assert found["slew"] == (3.0, "1/s")
    assert found["update_period"] == (0.004, "s")
    assert found["temperature_max"] == (55.0, "degC")
    for m in block.parameters:
        assert f"fl_real {m.path}; /* [{m.unit}]" in block.header
        assert f"p->{m.path} = K({m.value!r});" in block.source


def test_a_prefix_becomes_a_name_of_c() -> None:
    assert "n9_lives_step(" in write_emulator(TABLE_2, prefix="9 lives").header


def test_without_any_fault_there_is_nothing_to_emulate() -> None:
    with pytest.raises(UsageProblem, match="needs a fault"):
        write_emulator(TABLE_2, prefix="fl", faults=[])


@pytest.mark.parametrize("bad", [{"temperature_max": np.nan}, {"temperature_hysteresis": -1.0}])
def test_limits_that_make_no_sense(bad: Any) -> None:
    with pytest.raises(UsageProblem, match="temperature"):
        EmulatorLimits(**bad)


def test_driver_has_the_columns_that_tests_give() -> None:
    assert DRIVER.count("in[") == 14
