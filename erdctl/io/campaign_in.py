"""The table of a campaign, read damper by damper."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from erdctl.compare.history import DAY, Covariance, History, Series
from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.effects import get, names
from erdctl.io.campaign_table import NAME, SCHEMA

if TYPE_CHECKING:
    import pandas as pd

SCORES = {"nrmse": "1", "nrmse_worst": "1", "noise_rms": "N"}
NEEDED = ("log", "parameter", "unit", "value", "stderr", "exit_code")
LEARNED = "learned."  # parameters of curves, which mean nothing from one curve to the next


def campaign_table(data: bytes, name: str) -> pa.Table:
    """The table in the bytes of a file; InputProblem for one that is none."""
    import pyarrow.parquet as pq

    try:
        return pq.read_table(pa.BufferReader(data))
    except (pa.ArrowException, OSError) as error:
        raise InputProblem(f"no campaign table: {error}", file=name) from None


def histories(
    table: pa.Table, covariances: Mapping[str, Covariance] | None = None
) -> list[History]:
    """The dampers of a table with all columns, in the order of their names.

    covariances : by log.  Logs without damper and corner stand each for a damper of its own.
    """
    rows = table.to_pandas()
    rows["key"] = _keys(rows)
    offs = off_values(rows["parameter"].dropna().unique())
    groups = rows.groupby("key", sort=True, observed=True)
    return [_history(str(key), group, offs, covariances or {}) for key, group in groups]


def off_values(parameters: Iterable[str]) -> dict[str, float]:
    """Values at which the effects of these parameters are absent, by parameter.

    Nothing of the paper's own parameters, nor of effects that the catalogue has not here.
    """
    known = {str(p).partition(".")[0] for p in parameters} & {*names()}
    return {e.key(q.symbol): q.off for e in map(get, sorted(known)) for q in e.quantities}


def as_declared(table: pa.Table, name: str) -> pa.Table:
    """A campaign's table with all columns, null where an older one has none.

    Raises InputProblem for a table that is none, or holds what none can hold.
    """
    stated = (table.schema.metadata or {}).get(b"schema", b"").decode(errors="replace")
    missing = [c for c in NEEDED if c not in table.column_names]
    if missing or (stated and stated != NAME):
        found = f"it has no column '{missing[0]}'" if missing else f"it says '{stated[:80]}'"
        raise InputProblem(f"expected a table of schema '{NAME}', but {found}", file=name)
    columns = []
    for field in SCHEMA:
        if field.name not in table.column_names:
            columns.append(pa.nulls(len(table), field.type))
            continue
        try:
            columns.append(table.column(field.name).cast(field.type))
        except pa.ArrowException as error:
            raise InputProblem(
                f"expected {field.type}: {error}", file=name, column=field.name
            ) from None
    out = pa.table(columns, names=SCHEMA.names)
    for column in ("value", "stderr", "low", "high", *SCORES):
        values = out.column(column).to_numpy()
        wrong = np.isinf(values) | (values < 0 if column == "stderr" else False)
        if wrong.any():
            row = int(wrong.argmax())
            raise InputProblem(
                f"{values[row]:g} is no value of it", file=name, row=row + 1, column=column
            )
    return out


def _keys(rows: pd.DataFrame) -> pd.Series:
    """A name for each damper: its own, with its corner; of a log without either, the log's."""
    both = rows["damper"].fillna("") + " " + rows["corner"].fillna("")
    return both.str.strip().where(lambda key: key != "", rows["log"])


def _history(
    key: str, rows: pd.DataFrame, offs: Mapping[str, float], covariances: Mapping[str, Covariance]
) -> History:
    logs = rows.drop_duplicates("log", keep="first")
    failed = logs[logs["error"].notna() & ~logs["log"].isin(rows.loc[rows["value"].notna(), "log"])]
    logs = logs[~logs["log"].isin(failed["log"])]
    # Where some have no date the dates say nothing of these, and the order given is that of time.
    logs = logs if logs["date"].isna().any() else logs.sort_values("date", kind="stable")
    number = {log: i for i, log in enumerate(logs["log"])}
    t = _days(logs["date"])
    told = rows[rows["parameter"].notna() & rows["log"].isin(number)]
    # A diagnosis comes after the identification of the same log, and its model is the better one.
    told = told.assign(last=told["command"].eq("diagnose")).sort_values("last", kind="stable")
    told = told.drop_duplicates(["log", "parameter"], keep="last")
    series = {}
    for parameter, group in told.groupby("parameter", sort=True):
        name = str(parameter)
        if name.startswith(LEARNED):
            continue
        one = _series(name, group, number, t, offs.get(name))
        if one is not None:
            series[name] = one
    for name, unit in SCORES.items():
        value = logs[name].to_numpy(float)
        if np.isfinite(value).any():
            at = np.flatnonzero(np.isfinite(value))
            none = np.full(len(at), np.nan)
            series[name] = Series(
                name=name, unit=unit, at=at, t=t[at], value=value[at], stderr=none, low=none,
                high=none,
            )  # fmt: skip
    verdicts = logs["verdict"]
    return History(
        damper=key,
        corner=next(iter(logs["corner"].dropna()), None),
        logs=tuple(logs["log"]),
        t=t,
        series=series,
        effects=tuple(frozenset(_listed(f)) for f in logs["findings"]),
        searched=tuple(verdicts.notna()),
        settled=tuple(verdicts.isin(["adequate", "explained"])),
        covariances={i: covariances[log] for log, i in number.items() if log in covariances},
        failed=tuple(zip(failed["log"], failed["error"], strict=True)),
        rig=dict(Counter(code for codes in logs["rig"] for code in _listed(codes))),
    )


def _series(
    name: str, group: pd.DataFrame, number: dict[str, int], t: Array, off: float | None
) -> Series | None:
    """One parameter; of an effect, also the logs that do not name it."""
    where = group["log"].map(number).to_numpy(int)
    named = group["value"].notna().to_numpy()
    if not named.any():
        return None
    n = len(number)

    def over(column: str) -> Array:
        out = np.full(n, np.nan)
        out[where] = group[column].to_numpy(float)
        return out

    value, high = over("value"), over("high")
    at = np.sort(where[named]) if off is None else np.arange(n)
    seen = np.isfinite(value)
    limit, high = np.where(seen, np.nan, high), np.where(seen, high, np.nan)
    return Series(
        name=name, unit=str(group["unit"].iloc[0]), at=at, t=t[at], value=value[at],
        stderr=over("stderr")[at], low=over("low")[at], high=high[at],
        off=off, limit=limit[at],
    )  # fmt: skip


def _days(dates: pd.Series) -> Array:
    seconds = dates.astype("datetime64[us]").to_numpy().astype("int64") / 1e6
    return np.where(dates.isna().to_numpy(), np.nan, seconds / DAY)


def _listed(found: object) -> list[str]:
    return [str(f) for f in found] if isinstance(found, (list, np.ndarray)) else []
