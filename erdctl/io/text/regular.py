"""Stamps that are coarser than the samples: the interval that the file states puts them right."""

from __future__ import annotations

import numpy as np

from erdctl.core.errors import InputProblem
from erdctl.core.recording import Array
from erdctl.io.text.layout import TextLayout
from erdctl.io.text.stamps import Read, seconds_from_first


def regular(time: Read, layout: TextLayout, file: str, column: str) -> tuple[Array, list[str]]:
    """(n,) seconds from the first sample, and what was done.

    Stamps are printed to some resolution q. Where an interval h is stated (by --text interval or
    the block above the header) and all |stamp_i - stamp_0 - i h| <= q, times are i h.
    Raises InputProblem where samples share a stamp and no interval tells them apart.
    """
    seconds = seconds_from_first(time.ns)
    if len(seconds) < 2:
        return seconds, []
    steps = np.diff(time.ns)
    given = layout.options.interval
    h = given if given is not None else layout.interval
    q = time.resolution / 1e9
    if given is None and steps.min() > 0 and steps.min() == steps.max():
        h = None  # the stamps themselves are even
    if h is not None:
        even: Array = np.arange(len(seconds), dtype=np.float64) * h
        if float(np.abs(seconds - even).max()) <= q * (1.0 + 1e-9):
            exact = float(np.abs(seconds - even).max()) < 1e-9
            said = (
                ""
                if exact
                else f"times are the interval {h:g} s that is stated; stamps agree within {q:g} s"
            )
            return (seconds if exact else even), [said] if said else []
        if given is not None:
            worst = int(np.abs(seconds - even).argmax())
            raise InputProblem(
                f"the stamps do not go on by {h:g} s: after {worst} samples they are at"
                f" {seconds[worst]:g} s, not {even[worst]:g} s; leave --text interval out",
                file=file,
                column=column,
            )
    shared = float(np.mean(steps == 0))
    if shared > 0.05:
        guess = (seconds[-1] - seconds[0]) / (len(seconds) - 1)
        why = "" if h is None else f" (the interval {h:g} s in the file does not fit them)"
        raise InputProblem(
            f"{shared:.0%} of the samples share their stamp with the one before, for stamps have a"
            f" resolution of {q:g} s{why}; give the interval, about {guess:.3g} s: --text"
            " interval=SECONDS",
            file=file,
            column=column,
        )
    return seconds, []
