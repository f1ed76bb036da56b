"""A fleet of twenty, three of them wearing: what wears, since when and how fast; measure_compare.py
draws many by hand."""

from __future__ import annotations

from fleets import FIRST, MONTH, draw

from erdctl.compare.comparison import Attention, compare
from erdctl.io.campaign_in import histories
from erdctl.report.changes import damper_texts, head

SEED = 5000


def test_what_wears_and_nothing_else() -> None:
    table, worn = draw(SEED)
    found = compare(histories(table))
    assert [d.history.damper for d in found.dampers if d.attention is Attention.CHANGED] == [
        d.history.damper for d in found.dampers[:3]
    ]
    assert {w.damper for w in worn} == {d.history.damper for d in found.dampers[:3]}
    assert {d.attention for d in found.dampers[3:]} == {Attention.QUIET}
    assert head(found) == f"{found.logs} logs, 3 of 20 dampers changed"
    for w in worn:
        damper = next(d for d in found.dampers if d.history.damper == w.damper)
        assert {t.series.name for t in damper.changes} == set(w.parameters)
        for t in damper.changes:
            assert t.since is not None
            at = (t.since[0] - FIRST.timestamp() / 86400.0) / MONTH
            assert abs(at - w.since) <= 2.0
            if t.rate is not None:
                rate = w.rate * (t.start[0] if w.what == "leak" else 1.0)
                assert abs(t.rate[0] - rate) < 3.5 * t.rate[1]
        said = " ".join(damper_texts(damper))
        word = {"leak": "c_vis in compression fell", "play": "free play appeared",
                "preload": "static force fell"}[w.what]  # fmt: skip
        assert word in said


def test_a_healthy_fleet() -> None:
    table, _ = draw(SEED + 1, months=60, healthy=True)
    found = compare(histories(table))
    assert {d.attention for d in found.dampers} == {Attention.QUIET}
    assert head(found) == f"{found.logs} logs, none of 20 dampers changed"
