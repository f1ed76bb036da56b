"""A misfit that lives in one record is located there, and one that lives in all is not."""

from __future__ import annotations

import numpy as np
from rig import campaign

from erdctl.diagnose.problem import prepare
from erdctl.diagnose.residual.localisation import locate, record_region
from erdctl.diagnose.residual.places import places
from erdctl.model.effect import Variable


def test_one_record() -> None:
    recording = campaign()
    problem = prepare(recording)
    square = np.full(len(recording), 0.01)
    part = recording.slices[4]
    square[part] = 4.0
    found = record_region(problem, square)
    assert found is not None
    assert found.variable is Variable.RECORD
    assert (found.low, found.high) == (5.0, 5.0)
    assert recording.names[4] in found.text
    weight = problem.block.weight
    share = float(np.dot(weight[part], square[part]) / np.dot(weight, square))
    assert abs(found.share - share) < 1e-9
    assert all(r.variable is not Variable.RECORD for r in locate(problem, square))


def test_what_nothing_explains_is_looked_for_in_the_record_that_has_it_all() -> None:
    """A record with its axes reversed was told as "100 % of the misfit lies at 7.5 to 12.5 % duty",
    and the record fourth."""
    recording = campaign()
    problem = prepare(recording)
    square = np.full(len(recording), 1e-4)
    square[recording.slices[4]] = 4.0
    unexplained, explained = (places(problem, square, sure=sure) for sure in (False, True))
    assert [r.variable for r in unexplained].index(Variable.RECORD) == 0
    assert explained == [*unexplained[1:], unexplained[0]]
    square[recording.slices[1]] = 2.0
    others = [r.variable for r in places(problem, square, sure=False)]
    assert others.index(Variable.RECORD) == len(others) - 1


def test_all_records_alike() -> None:
    recording = campaign()
    assert record_region(prepare(recording), np.ones(len(recording))) is None


def test_a_single_record_has_no_other() -> None:
    one = campaign().select([0])
    assert record_region(prepare(one), np.ones(len(one))) is None
