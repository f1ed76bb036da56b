"""The fixtures' independent solution, and one linear algebra thread for each test process."""

from __future__ import annotations

import os
import sys
from collections.abc import Generator
from functools import cache

import hypothesis
import pytest
import quick_approx
import typer.testing
from places import FIXTURES, ROOT, SHARED
from real_data import MARK, RealData

sys.path.insert(0, str(FIXTURES))  # the oracle is a script's module, not part of the package
# The processes are the parallelism.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
quick_approx.install()
# How long an example takes is the machine's affair; and whether a change is accepted is that of the
# change, not of what was drawn this time. New draws: pytest --hypothesis-profile=random
hypothesis.settings.register_profile("random", deadline=None)
hypothesis.settings.register_profile("the same", deadline=None, derandomize=True)
hypothesis.settings.load_profile("the same")
# Typer makes Click's commands of an app anew at each call, which takes longer than most calls do.
typer.testing._get_command = cache(typer.testing._get_command)  # type: ignore[attr-defined]  # its own

# Diagnoses of minutes, and what runs nothing of erdctl: tracing costs them half again to twice as
# much again, and others run the same lines. Single tests of that kind have the mark `untraced`.
UNTRACED = (
    "bench/rig/test_rig_in_a_car.py",
    "cli/test_narrow_screens.py",
    "diagnose/learning/test_laws_over_two.py",
    "diagnose/learning/test_learning.py",
    "diagnose/learning/test_logged_temperature.py",
    "diagnose/learning/test_one_motion_alone.py",
    "diagnose/residual/test_loud_parts.py",
    "diagnose/residual/test_record_levels.py",
    "diagnose/residual/test_variance.py",
    "diagnose/test_alike_under_misfit.py",
    "diagnose/test_beginnings.py",
    "diagnose/test_carry_over.py",
    "diagnose/test_clipped.py",
    "diagnose/test_companions_beside_others.py",
    "diagnose/test_decisions.py",
    "diagnose/test_detectable.py",
    "diagnose/test_earned_names.py",
    "diagnose/test_executor.py",
    "diagnose/test_fault_of_given.py",
    "diagnose/test_fault_onsets.py",
    "diagnose/test_few_records.py",
    "diagnose/test_findings_order.py",
    "diagnose/test_guo_loop.py",
    "diagnose/test_in_the_place_of_another.py",
    "diagnose/test_invariance.py",
    "diagnose/test_jittering_clock.py",
    "diagnose/test_levels_of_records.py",
    "diagnose/test_limit_of_effects.py",
    "diagnose/test_measuring_chain_and_limits.py",
    "diagnose/test_no_lag.py",
    "diagnose/test_real_data.py",
    "diagnose/test_record_effects.py",
    "diagnose/test_resolved.py",
    "diagnose/test_samples_of_search.py",
    "diagnose/test_sets_in_once.py",
    "diagnose/test_slight_lag.py",
    "diagnose/test_smoothed_records.py",
    "diagnose/test_unseen.py",
    "docs/test_docs.py",
    "estimate/test_identify.py",
    "estimate/test_measurement_noise.py",
    "export/c/test_catalogue_in_c.py",
    "export/c/test_learned_in_c.py",
    "export/c/test_models_in_c.py",
    "export/emulator/test_emulator_corrected.py",
    "fuzz/test_binary_bombs.py",
    "fuzz/test_fuzz.py",
    "interface/test_calls_equal_commands.py",
    "mimic/test_mimic_corrected.py",
    "mimic/test_random_plans.py",
    "plant/test_plant_asked.py",
    "plant/test_plant_case.py",
    "plant/test_plant_leak.py",
    "prove/test_coverage.py",
    "prove/test_prove_command.py",
    "prove/test_prove_nulls.py",
    "prove/test_prove_on_log.py",
    "prove/test_small_proof.py",
    "tests/test_architecture.py",
)

TRACED: set[str] = set()  # tests of which one set of parameters ran in this process


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """From the set-up on, where fixtures diagnose; pytest-cov's `no_cover` is of the call alone.

    Of a test with several sets of parameters the first is traced: tracing costs two thirds more.
    """
    plugin = item.config.pluginmanager.get_plugin("_cov")
    control = plugin.cov_controller if plugin is not None else None
    test = item.nodeid.partition("[")[0]
    again = test in TRACED
    TRACED.add(test)
    if control is None or not (
        again or item.path.as_posix().endswith(UNTRACED) or item.get_closest_marker("untraced")
    ):
        return (yield)
    control.pause()
    try:
        return (yield)
    finally:
        control.resume()


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", f"{MARK}: reads real recordings, see tests/real_data.py")
    if not hasattr(config, "workerinput"):  # the first process of a session, which judges it
        config.pluginmanager.register(RealData(config, ROOT / "tests", SHARED), MARK)
