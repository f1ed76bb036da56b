"""`import erdctl`: light, complete, and its functions hidden by no room of the same name."""

from __future__ import annotations

import inspect
import pydoc
import subprocess
import sys

import pytest
from places import ROOT

import erdctl

FUNCTIONS = (
    "read", "identify", "simulate", "validate", "diagnose", "mimic", "inspect", "effects",
)  # fmt: skip


def python(code: str) -> str:
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    return run.stdout


def test_the_face_is_what_it_says() -> None:
    assert set(erdctl.__all__) == {*FUNCTIONS, "ErdctlError", "__version__"}
    assert set(erdctl.__all__) <= set(dir(erdctl))
    for name in FUNCTIONS:
        assert inspect.isfunction(getattr(erdctl, name))
    with pytest.raises(AttributeError, match="no attribute 'identity'"):
        erdctl.identity  # type: ignore[attr-defined]  # noqa: B018 - it must raise


def test_rooms_do_not_hide_functions() -> None:
    code = (
        "from erdctl.diagnose.diagnosis import Verdict\n"
        "import erdctl.effects, erdctl.mimic.plan\n"
        "from erdctl.effects import get\n"
        "import erdctl, sys\n"
        "from erdctl import effects\n"
        "print(*(type(f).__name__ for f in (erdctl.diagnose, erdctl.effects, erdctl.mimic)),"
        " effects is erdctl.effects, type(sys.modules['erdctl.effects']).__name__,"
        " effects('backlash').chosen[0] is get('backlash'), type(erdctl.core).__name__)"
    )
    assert python(code).split() == [
        "function", "function", "function", "True", "module", "True", "module",
    ]  # fmt: skip


def test_importing_loads_nothing() -> None:
    loaded = set(python("import erdctl, sys; print(*sys.modules)").split())
    assert {m for m in loaded if m.startswith("erdctl")} == {"erdctl"}
    assert erdctl.__version__.count(".") == 2
    loaded = set(python("import erdctl, sys; erdctl.ErdctlError; print(*sys.modules)").split())
    assert "numpy" not in loaded


def test_help_is_enough() -> None:
    text = pydoc.plain(pydoc.render_doc(erdctl))
    for name in FUNCTIONS:
        assert f"erdctl.{name}(" in text
        assert f"\n    {name}(" in text  # with its arguments
    for word in ("SI", "DataFrame", ".to_dict()", ".table()", ".plot(", ".write(", "m/s", "degC"):
        assert word in text


@pytest.mark.parametrize("name", FUNCTIONS)
def test_each_help_says_what_goes_in_and_comes_out(name: str) -> None:
    function = getattr(erdctl, name)
    text = inspect.getdoc(function) or ""
    for word in ("Returns", "Raises", "Example:"):
        assert word in text
    for argument in inspect.signature(function).parameters:
        assert argument in text
    for p in inspect.signature(function).parameters.values():
        if p.default is not p.empty and p.name not in ("log", "name"):
            assert p.kind is p.KEYWORD_ONLY


@pytest.mark.parametrize("name", FUNCTIONS)
def test_methods_are_documented(name: str) -> None:
    found = inspect.get_annotations(getattr(erdctl, name), eval_str=False)["return"]
    home = sys.modules[getattr(erdctl, name).__module__]
    for method, value in vars(getattr(home, found)).items():
        if not method.startswith("_") and callable(value):
            assert value.__doc__, f"{found}.{method}"


def test_a_type_checker_knows_the_functions() -> None:
    pytest.importorskip("mypy")
    run = subprocess.run(
        [sys.executable, "-m", "mypy", "tests/interface/usage.py"],
        capture_output=True, text=True, cwd=ROOT,
    )  # fmt: skip
    errors = [line for line in run.stdout.splitlines() if ": error:" in line]
    assert len(errors) == 2, run.stdout + run.stderr
    assert 'incompatible type "int"' in errors[0]
    assert "Literal['guess']" in errors[1]
