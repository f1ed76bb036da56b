"""The paper's model in C against Python, and what a block does with bad input."""

from __future__ import annotations

import numpy as np
import pytest
from c_built import COMPILERS, FLOAT, block_of, built, forces, rows_of, run
from c_motion import bench, random_motion, record
from places import FIXTURES

from erdctl.core.signals import Signals
from erdctl.io.parameters import read_parameters
from erdctl.model.composed import Model

PAPER = read_parameters(str(FIXTURES / "table_2.json")).values
BLOCK = block_of(Model(), PAPER)


@pytest.mark.parametrize("s", [random_motion(), bench()], ids=["random", "bench"])
@pytest.mark.parametrize(("options", "near"), [((), 1e-9), ((FLOAT,), 1e-5)])
@pytest.mark.parametrize("T_d", [None, 0.0])
def test_it_equals_python(
    s: Signals, options: tuple[str, ...], near: float, T_d: float | None
) -> None:
    values = dict(PAPER)
    if T_d is not None:
        values |= {"compression.T_d": T_d, "release.T_d": T_d}
    expected = Model().force(s, values)
    found = forces(block_of(Model(), values), s, *options)
    assert np.abs(found - expected).max() <= near * np.ptp(expected)


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("options", [(), (FLOAT,)])
def test_no_warnings(compiler: str, options: tuple[str, ...]) -> None:
    built(BLOCK, *options, compiler=compiler, optimised="-O2")


NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize("options", [(), (FLOAT,)])
def test_bad_input_holds_the_force_and_says_so(options: tuple[str, ...]) -> None:
    good = [0.01, 0.002, 0.1, 0.3, 1.0, 1.0, 1.0]
    cases = [
        (0, NAN, 1), (0, INF, 1), (0, 0.0, 2), (0, -0.01, 2), (0, -INF, 3), (1, NAN, 1),
        (2, -INF, 1), (3, NAN, 1), (3, 1.5, 4), (3, -0.1, 4), (4, NAN, 8), (5, 1.5, 8), (6, -1, 8),
    ]  # fmt: skip
    for column, value, status in cases:
        bad = good.copy()
        bad[column] = value
        found = run(BLOCK, np.array([good, good, bad, good, good]), *options)
        assert np.isfinite(found.force).all()
        assert found.status.tolist() == [0, 0, status, 0, 0]
        if status & 3:
            assert found.force[2] == found.force[1]
    nothing = run(BLOCK, np.array([[0.0, NAN, 0.0, 0.0, 1.0, 1.0, 1.0]]), *options)
    assert (nothing.force.tolist(), nothing.status.tolist()) == ([0.0], [1])


def test_time_passes_while_the_input_is_bad() -> None:
    good = [0.01, 0.002, 0.1, 0.3, 1.0, 1.0, 1.0]
    rest, jump, bad = good.copy(), good.copy(), good.copy()
    rest[3], jump[0], bad[1] = 0.0, 0.02, NAN
    waited = run(BLOCK, np.array([rest, good, bad, good])).force
    assert waited[-1] == pytest.approx(
        run(BLOCK, np.array([rest, good, jump])).force[-1], rel=1e-12
    )


def test_stuck_inputs_settle() -> None:
    stuck = np.tile([0.01, 0.002, 0.1, 0.3, 1.0, 1.0, 1.0], (3000, 1))
    force = run(BLOCK, stuck).force
    assert np.isfinite(force).all()
    assert force[-1] == pytest.approx(force[-2], rel=1e-12)


def test_faults_scale_the_groups_of_their_equations() -> None:
    s = random_motion()
    one = slice(0, int(s.starts[1]))
    s = record(s, one.start, one.stop)
    n = len(s)
    factors = np.column_stack([np.linspace(1.0, 0.5, n), np.full(n, 0.8), np.full(n, 0.7)])
    prepared = Model().prepare(s, PAPER)
    oil, electrical, deformation = factors.T
    groups = {"gas": oil, "viscous": oil * deformation, "yield": oil * electrical * deformation}
    expected = prepared.force(PAPER, groups)
    found = run(BLOCK, rows_of(s, factors), begin=(0.0, int(s.compressing[0]), -1)).force
    assert np.abs(found - expected).max() <= 1e-9 * np.ptp(expected)
