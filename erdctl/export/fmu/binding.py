"""The header that ties a block to the FMI functions: its variables, by place and by bounds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from importlib.resources import files

from erdctl.export.fmu.block import FmuBlock, FmuVariable
from erdctl.export.fmu.version import Version

BINDING = "erdctl_block.h"
COMMON = "erdctl_fmu.h"

_TEXT = """\
/* The variables of {prefix} for FMI, in the order of their value references. Made by erdctl. */

#ifndef ERDCTL_BLOCK_H
#define ERDCTL_BLOCK_H

#include "{prefix}.h"

#include <float.h>
#include <stddef.h>

#define TOKEN "{token}"

enum {{
    INPUTS = {inputs},
    OUTPUTS = {outputs},
    PARAMETERS = {parameters},
    INITIAL = {initial}
}};

typedef {prefix}_real block_real;
typedef {prefix}_params BlockParams;
typedef {prefix}_state BlockState;

static const double INPUT_START[INPUTS] = {{{starts}}};

/* r: real, i: integer, b: Boolean. */
static const char OUTPUT_KIND[OUTPUTS] = {{{kinds}}};

/* DBL_MAX is no bound, but that of being finite. A last row, as C has no empty array. */
static const struct {{
    size_t at;
    double low, high;
}} PARAMETER[PARAMETERS + 1] = {{
{rows}
    {{0, 0.0, 0.0}}}};

static const struct {{
    char kind;
    double start, low, high;
}} INITIAL_VALUE[INITIAL + 1] = {{
{begins}
    {{0, 0.0, 0.0, 0.0}}}};

static void block_defaults(BlockParams *p)
{{
    {prefix}_defaults(p);
}}

static void block_init(BlockState *s, const BlockParams *p)
{{
    {prefix}_init(s, p);
}}

static void block_begin(BlockState *s, double t, const double z[])
{{
{read_initial}
    (void)s, (void)t, (void)z;
{begin}
}}

static void block_retune(BlockState *s, const BlockParams *p)
{{
    {retune}
}}

static int block_status(const BlockState *s)
{{
    return (int)({status});
}}

static const char *block_words(int status)
{{
{words}
    (void)status;
    return "the status of the block is not 0";
}}

static void block_step(BlockState *s, double dt, const double u[], double out[])
{{
{read}
{declared}

{calls}
{written}
}}

#endif
"""


def sources(block: FmuBlock, version: Version, token: str) -> dict[str, str]:
    """Text of all C files of an FMU by name; those that end in .c are to be compiled."""
    shim = files("erdctl.export.fmu") / "shim"
    return {
        f"{block.prefix}.c": block.source,
        f"{block.prefix}.h": block.header,
        BINDING: binding(block, token),
        COMMON: (shim / COMMON).read_text("utf-8"),
        version.shim: (shim / version.shim).read_text("utf-8"),
    }


def binding(block: FmuBlock, token: str) -> str:
    """Text of the header.

    token : the GUID of FMI 2.0, the instantiation token of FMI 3.0
    """
    return _TEXT.format(
        prefix=block.prefix,
        token=token,
        inputs=len(block.inputs),
        outputs=len(block.computed),
        parameters=len(block.parameters),
        initial=len(block.initial),
        begins="\n".join(_begins(v) for v in block.initial),
        read_initial=_lines(
            f"const double {v.name} = z[{i}];" for i, v in enumerate(block.initial)
        ),
        begin=_lines(block.begin.strip().splitlines()),
        starts=", ".join(_number(v.start) for v in block.inputs),
        kinds=", ".join(f"'{v.kind.value}'" for v in block.computed),
        rows="\n".join(_row(block, v) for v in block.parameters),
        retune=block.retune,
        status=block.status,
        words=_lines(
            f'if (status & {flag})\n        return "{_quoted(text)}";'
            for flag, text in block.words.items()
        ),
        read=_lines(f"const double {v.name} = u[{i}];" for i, v in enumerate(block.inputs)),
        declared=_lines(f"double {v.name} = 0.0;" for v in block.computed),
        calls=_lines(block.calls.strip().splitlines()),
        written=_lines(f"out[{i}] = {v.name};" for i, v in enumerate(block.computed)),
    )


def _row(block: FmuBlock, v: FmuVariable) -> str:
    at = f"offsetof({block.prefix}_params, {v.member})"
    return f"    {{{at}, {_number(v.low)}, {_number(v.high)}}},"


def _begins(v: FmuVariable) -> str:
    return f"    {{'{v.kind.value}', {_number(v.start)}, {_number(v.low)}, {_number(v.high)}}},"


def _number(value: float) -> str:
    """As C reads it; beyond all numbers: the largest."""
    if math.isinf(value):
        return "DBL_MAX" if value > 0 else "-DBL_MAX"
    return repr(float(value))


def _quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')


def _lines(rows: Iterable[str] | Sequence[str]) -> str:
    return "\n".join(f"    {row}" for row in rows)
