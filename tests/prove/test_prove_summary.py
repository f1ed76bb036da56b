"""Rates, confusions and misses, counted by hand."""

from __future__ import annotations

import json
from typing import Any

import msgspec
from results import result

from erdctl.prove.case import Wish
from erdctl.prove.document import SCHEMA, from_json, proof_of, to_json
from erdctl.prove.judge import Failed, Result
from erdctl.prove.score import Errors, Found, HiddenEffect, Printed
from erdctl.prove.summary import reasons, summarise
from erdctl.prove.tables import line, tables
from erdctl.prove.tally import Rate

WRONG = {"findings": (Found("drift"),), "named": False, "matched": 0, "spurious": 1}
RESULTS: tuple[Result, ...] = (
    result(1, first_place=True),
    result(2, **WRONG, located=False, first_place=False,
           fresh=Errors(5.0, 4.0, 1.0, 100.0)),  # a quarter removed
    result(3, verdict="unexplained", motion="measured", fresh=Errors(5.0, 1.0, 1.0, 100.0)),
    result(4, hidden=(HiddenEffect("rub", 0.5),), level=0.5, verdict="adequate", findings=(),
           named=False, matched=0, located=None),
    result(5, kind="pair", hidden=(HiddenEffect("rub", 3.0), HiddenEffect("skew", 2.5))),
    result(6, kind="null", hidden=(), level=0.0, colour="pink", verdict="adequate", findings=(),
           named=None, matched=0, located=None, fresh=Errors(0.1, 0.1, None, 100.0)),
    result(7, kind="null", hidden=(), level=0.0, findings=(Found("drift"),), named=None,
           matched=0, spurious=1, located=None, fresh=Errors(0.1, 0.2, None, 100.0)),
    result(8, kind="unknown", hidden=(HiddenEffect("stranger", 4.0),), named=None, matched=0,
           spurious=1, fresh=Errors(5.0, 4.0, None, 100.0)),
)  # fmt: skip
FAILED = (Failed(9, 9, "ValueError: no"),)


def test_bands() -> None:
    strong, weak = summarise(RESULTS).bands
    assert (strong.label, strong.cases) == (">= 2", 3)
    assert strong.named == Rate(2, 3)
    assert strong.wrong == Rate(1, 3)
    assert strong.explained == Rate(2, 3)
    assert strong.located == Rate(2, 3)
    assert strong.first_place == Rate(1, 2)
    assert strong.spurious == 1 / 3
    assert (strong.removed, strong.removed_of) == (0.9, 3)  # of 0.25, 0.9 and 1
    assert (weak.label, weak.named, weak.wrong) == ("0.2 to 1", Rate(0, 1), Rate(0, 1))
    assert weak.removed is None  # too weak to count


def test_other_groups() -> None:
    s = summarise(RESULTS, FAILED)
    assert s.pairs.all_found == Rate(0, 1)
    assert s.pairs.named == Rate(1, 1)
    assert [(g.label, g.adequate) for g in s.nulls] == [
        ("pink", Rate(1, 1)), ("white", Rate(0, 1)), ("all", Rate(1, 2))
    ]  # fmt: skip
    assert s.unknowns.unexplained == Rate(0, 1)
    assert s.unknowns.explained == Rate(1, 1)
    assert s.whole.spurious == 3 / 8
    assert s.whole.right == Rate(4, 8)  # 1, 2, 5 and 6
    assert s.whole.located == Rate(4, 5)
    assert [(e.effect, e.band, e.named) for e in s.effects] == [
        ("rub", ">= 2", Rate(2, 3)), ("rub", "0.2 to 1", Rate(0, 1))
    ]  # fmt: skip
    assert [(g.label, g.cases) for g in s.motions][:2] == [("single, exact", 3),
                                                           ("single, measured", 1)]  # fmt: skip
    assert s.failed == 1


def test_confusions_and_misses() -> None:
    s = summarise(RESULTS, FAILED)
    assert [(c.hidden, c.said, c.seeds) for c in s.confusions] == [
        ("nothing", "drift", (7,)), ("rub", "drift", (2,)), ("stranger", "rub", (8,))
    ]  # fmt: skip
    assert {m.seed: m.why for m in s.misses} == {
        2: ("wrong name first", "1 spurious", "not located"),
        3: ("verdict unexplained",),
        4: ("not named", "verdict adequate"),
        5: ("1 of 2 found",),
        7: ("verdict explained", "1 spurious"),
        8: ("verdict explained", "1 spurious"),
        9: ("failed: ValueError: no",),
    }
    assert reasons(RESULTS[0]) == ()


def test_crowded_cases() -> None:
    """The strong one first, spurious a case, the share of what can be removed, and none worse."""
    crowd = (HiddenEffect("rub", 6.0), HiddenEffect("skew", 0.7), HiddenEffect("play", 0.4))
    some: dict[str, Any] = {"kind": "crowded", "hidden": crowd}
    results = [
        result(1, **some, matched=3),
        result(2, **some, named=False, matched=2, spurious=1, fresh=Errors(5.0, 5.1, 1.0, 100.0)),
        result(3, **some, matched=1, fresh=Errors(5.0, 1.1, 1.0, 100.0)),  # 3.9 of 4: 97.5 %
        result(4),
    ]
    c = summarise(results).crowded
    assert (c.group.cases, c.group.named, c.group.spurious) == (3, Rate(2, 3), 1 / 3)
    assert (c.group.all_found, c.group.removed) == (Rate(1, 3), 0.9)
    assert c.mostly == Rate(1, 3)
    assert c.worse == Rate(1, 3)
    assert reasons(results[1]) == (
        "wrong name first", "2 of 3 found", "worse than the paper's model", "1 spurious"
    )  # fmt: skip
    assert not summarise(results).confusions  # a crowd has no one name


def test_sparse_cases() -> None:
    """Not to name what cannot be told is no miss; a wrong name that explains is, and so is an
    interval without the truth."""
    right, wrong = Printed("k", 1.0, 2.0, 1.5), Printed("c", 1.0, 2.0, 2.1)
    some: dict[str, Any] = {"kind": "sparse"}
    none: dict[str, Any] = {**some, "hidden": (), "named": None, "matched": 0, "located": None,
                            "level": 0.0}  # fmt: skip
    results = [
        result(1, **some, printed=(right, right, wrong)),
        result(2, **some, **WRONG),
        result(3, **some, **WRONG | {"verdict": "unexplained", "cannot_tell": True}),
        result(4, **some, verdict="adequate", findings=(), named=False, matched=0),
        result(5, **none, verdict="adequate", findings=(), printed=(right,)),
        result(6, **none, verdict="unexplained", findings=()),
    ]
    hidden, nothing, every = summarise(results).sparse
    assert [hidden.cases, nothing.cases, every.cases] == [4, 2, 6]
    assert (hidden.wrong, hidden.right, hidden.undecided) == (Rate(1, 4), Rate(1, 4), Rate(1, 4))
    assert (hidden.silent, hidden.unexplained, hidden.held) == (Rate(1, 4), Rate(0, 4), Rate(2, 3))
    assert (nothing.silent, nothing.unexplained, every.held) == (Rate(1, 2), Rate(1, 2), Rate(3, 4))
    assert [reasons(r) for r in results] == [
        ("not within its interval: c",), ("wrong name",), (), (), (), ()
    ]  # fmt: skip
    assert summarise(results).whole.right == Rate(5, 6)


def test_a_line_names_seed_and_hash_first() -> None:
    assert line(RESULTS[0]) == (
        "seed 1  abababababab  single: rub 3  said: rub  named yes  explained  located yes"
        "  nrmse 0.0500 0.0140 0.0100"
    )
    assert line(FAILED[0]) == "seed 9  FAILED  ValueError: no"


def test_every_row_of_a_table_has_its_header() -> None:
    found = list(tables(summarise(RESULTS, FAILED)))
    assert len(found) == 11
    asked = [result(1, kind="crowded"), result(2, kind="sparse"), result(3, kind="left_out")]
    kinds = ("Crowded", "Sparse", "Left out")
    found += [t for t in tables(summarise(asked)) if t[0].startswith(kinds)]
    assert len(found) == 14
    for _, header, rows in found:
        assert {len(header)} == {len(row) for row in rows}
    assert list(tables(summarise([]))) == []


def test_the_document_goes_there_and_back() -> None:
    proof = proof_of(Wish(effects=("rub",), level=3.0), range(1, 10), [*RESULTS, *FAILED])
    document = json.loads(msgspec.json.encode(to_json(proof)))
    assert document["schema"] == SCHEMA
    assert from_json(document) == proof
    assert (document["seed"], document["cases"]) == (1, 9)
    assert document["results"][0]["fresh"]["removed"] == 0.9
    assert document["results"][0]["fresh"]["nrmse_paper"] == 0.05
    assert document["summary"]["bands"][0]["named"] == {"hits": 2, "of": 3}
    assert document["failed"][0]["seed"] == 9
