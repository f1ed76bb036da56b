"""A damper in Python as an exported block has it."""

from __future__ import annotations

from erdctl.export.c.provenance import AHEAD, looking_ahead
from erdctl.export.damper_alone import damper_alone, without
from erdctl.model.parameters import Parameters


def as_block(parameters: Parameters) -> tuple[Parameters, list[str]]:
    """The parameters whose force is that of the block that `erdctl export` writes of them.

    Effects of the bench take no part. Their force is that of the C to rounding, but for what the
    remarks say, which come second.
    """
    alone, left_out = damper_alone(parameters)
    effects = tuple(e.with_c() for e in alone.model.effects)
    laws = [(e.name, e.with_c().c) for e in alone.model.effects if e.causal is None]
    differs = [f"{name}: in a block, {c.note}" for name, c in laws if c is not None and c.note]
    differs += [f"{name}: in a block, {AHEAD}" for name in looking_ahead(alone, effects)]
    return alone, [*without(left_out), *differs]
