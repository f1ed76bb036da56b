"""What an FMU is made of: a block of C with an interface, and the variables that FMI sees of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum


class FmuType(Enum):
    """Type of a variable, as the C that holds it knows it by."""

    REAL = "r"
    INTEGER = "i"
    BOOLEAN = "b"


@dataclass(frozen=True, kw_only=True)
class FmuVariable:
    """A variable of an FMU.

    name : in the FMU; dots and identifiers
    member : of a parameter, its place in the params struct (`compression_k_nom`, `backlash.g`);
    of inputs, outputs and watched values unused, as `FmuBlock.calls` names them
    start : of inputs and parameters [unit];  low, high : values that are accepted of a parameter
    (and stated of an input)
    """

    name: str
    unit: str = "1"
    title: str = ""
    member: str = ""
    start: float = 0.0
    low: float = -math.inf
    high: float = math.inf
    kind: FmuType = FmuType.REAL


@dataclass(frozen=True, kw_only=True)
class FmuBlock:
    """A block of C and its interface.

    prefix : of its C names, and of the files; the header declares PREFIX_real, PREFIX_params,
    PREFIX_state (plain data without pointers: copied, it is the FMU state),
    PREFIX_defaults(PREFIX_params *) and PREFIX_init(PREFIX_state *, const PREFIX_params *)
    header, source : text of PREFIX.h and PREFIX.c
    outputs : what may be connected;  watched : what may only be looked at
    calls : C that takes one step. It knows `s` (PREFIX_state *), `dt` [s] (without meaning at the
    first call after init), and doubles of the names of all inputs (to be read), outputs and
    watched values (to be set)
    initial : values that say how it begins;  begin : C that is run after init. It knows `s`, `t`
    (start time [s]) and doubles of the names of all initial values
    retune : C that lets parameters that were changed while it runs take effect: `s`, and `p`
    (const PREFIX_params *)
    status : C expression of `s`: 0 while all is well; the FMU then returns a warning instead of OK
    words : flags of the status (C expressions) and what is said of each
    notes : paragraphs of the FMU's own page
    step_size : communication step that is proposed [s]
    """

    prefix: str
    title: str
    header: str
    source: str
    inputs: tuple[FmuVariable, ...]
    outputs: tuple[FmuVariable, ...]
    calls: str
    parameters: tuple[FmuVariable, ...] = ()
    watched: tuple[FmuVariable, ...] = ()
    initial: tuple[FmuVariable, ...] = ()
    begin: str = ""
    retune: str = "s->p = *p;"
    status: str = "s->status"
    words: Mapping[str, str]
    notes: tuple[str, ...] = ()
    step_size: float = 1e-3

    @property
    def computed(self) -> tuple[FmuVariable, ...]:
        """Outputs and watched values, in the order of their value references."""
        return self.outputs + self.watched
