"""False alarms by kind of noise: the tables, and one null from seed to verdict."""

from __future__ import annotations

from erdctl.plant.rig_errors import KINDS
from erdctl.prove.nulls import NullResult, examine, tables


def result(
    seed: int, kind: str, named: tuple[str, ...], verdict: str, z: float, learned: bool = False
) -> NullResult:
    measures = {"Z_ENERGY": z, "critical": 3.1}
    return NullResult(seed, kind, KINDS[kind].only_noise, verdict, named, (), measures, learned)


def test_the_tables() -> None:
    results = [
        result(1, "white", (), "adequate", 1.0),
        result(2, "white", ("coulomb_friction",), "explained", 7.0),
        result(3, "clipped", (), "unexplained", 9.0, learned=True),
    ]
    (_, header, rows), (_, _, statistics) = tables(results)
    assert header == ["", "nulls", "named", "learned", "not adequate", "seeds"]
    assert rows == [
        ["white", "2", "1 (50.0 %)", "0 (0.0 %)", "1 (50.0 %)", "2"],
        ["clipped", "1", "0 (0.0 %)", "1 (100.0 %)", "1 (100.0 %)", "3"],
        ["all", "3", "1 (33.3 %)", "1 (33.3 %)", "2 (66.7 %)", "2 3"],
        ["all that is only noise", "2", "1 (50.0 %)", "0 (0.0 %)", "1 (50.0 %)", "2"],
    ]
    energy, critical = statistics
    assert energy == ["Z_ENERGY", "6", "4", "6.7", "7", "1"]
    assert critical[0] == "critical"


def test_a_null() -> None:
    """White noise, looked at before; what it gives is what `erdctl prove --nulls 1` prints."""
    found = examine(0)
    assert (found.kind, found.named, found.verdict) == ("white", (), "adequate")
    assert found.measures["T_STRETCHES"] < 3.5
    assert found.measures["Z_ENERGY"] < 6.0
    assert 2.5 < found.measures["critical"] < 4.5
    assert not found.learned
    assert found.line == "seed 0  white  named nothing  adequate"
