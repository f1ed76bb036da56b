"""Exported C, built by this machine's compilers and run on signals."""

from __future__ import annotations

import ctypes
import hashlib
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from c_motion import record

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.export.c.source import CBlock, write_c
from erdctl.model.composed import Model
from erdctl.model.parameters import Estimate, Parameters

WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
COMPILERS = tuple(c for c in ("gcc", "clang") if shutil.which(c))
FLOAT = "-DERDCTL_FLOAT"
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g")

# Calls the block once a sample; values are its parameters in the order of CBlock.parameters.
DRIVER = """
#include "%(prefix)s.h"

void run(long n, const double *values, const double *begin, const double *rows, double *force,
         int *status);

void run(long n, const double *values, const double *begin, const double *rows, double *force,
         int *status)
{
    %(prefix)s_params p;
    %(prefix)s_state s;
    long i;

    %(prefix)s_defaults(&p);
%(set)s
    %(prefix)s_init(&s, &p);
    %(prefix)s_begin(&s, (%(prefix)s_real)begin[0], (int)begin[1], (int)begin[2]);
    for (i = 0; i < n; i++, rows += 7) {
        %(prefix)s_faults(&s, (%(prefix)s_real)rows[4], (%(prefix)s_real)rows[5],
                          (%(prefix)s_real)rows[6]);
        force[i] = (double)%(prefix)s_step(&s, (%(prefix)s_real)rows[0], (%(prefix)s_real)rows[1],
                                           (%(prefix)s_real)rows[2], (%(prefix)s_real)rows[3]);
        status[i] = s.status;
    }
}
"""
MAIN = """
#include <stdio.h>
#include <stdlib.h>

void run(long n, const double *values, const double *begin, const double *rows, double *force,
         int *status);

static double *doubles(FILE *f, long n)
{
    double *out = malloc((size_t)(n > 0 ? n : 1) * sizeof(double));
    if (!out || fread(out, sizeof(double), (size_t)n, f) != (size_t)n)
        exit(2);
    return out;
}

int main(int argc, char **argv)
{
    long sizes[2], i;
    FILE *f = argc == 2 ? fopen(argv[1], "rb") : NULL;
    double *values, *begin, *rows, *force;
    int *status;

    if (!f || fread(sizes, sizeof(long), 2, f) != 2)
        return 2;
    values = doubles(f, sizes[0]);
    begin = doubles(f, 3);
    rows = doubles(f, 7 * sizes[1]);
    force = malloc((size_t)sizes[1] * sizeof(double));
    status = malloc((size_t)sizes[1] * sizeof(int));
    if (!force || !status)
        return 2;
    run(sizes[1], values, begin, rows, force, status);
    for (i = 0; i < sizes[1]; i++)
        printf("%.17g %d\\n", force[i], status[i]);
    free(values); free(begin); free(rows); free(force); free(status);
    fclose(f);
    return 0;
}
"""


class Ran(NamedTuple):
    """(n,) force and status."""

    force: Array
    status: Array


def parameters_of(model: Model, values: Mapping[str, float], **provenance: object) -> Parameters:
    estimates = {
        name: Estimate(value=values[name], unit=q.unit) for name, q in model.quantities.items()
    }
    return Parameters(model=model, estimates=estimates, provenance=provenance)


def block_of(
    model: Model, values: Mapping[str, float], s: Signals | None = None, prefix: str = "damper"
) -> CBlock:
    ranges = {} if s is None else {"xdot": [0.0, float(np.abs(s.xdot).max())]}
    return write_c(parameters_of(model, values, ranges=ranges), prefix=prefix)


@cache
def folder() -> Path:
    import atexit

    made = tempfile.mkdtemp(prefix="erdctl_c_")
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return Path(made)


def built(
    block: CBlock, *options: str, compiler: str = "gcc", main: bool = False, optimised: str = "-O1"
) -> Path:
    """A library, or a program, of a block and its driver; each is built once."""
    assignments = "\n".join(
        f"    p.{m.path} = ({block.prefix}_real)values[{i}];"
        for i, m in enumerate(block.parameters)
    )
    driver = DRIVER % {"prefix": block.prefix, "set": assignments}
    key = hashlib.sha256(
        "\n".join([block.header, block.source, driver, compiler, optimised, *options, str(main)])
        .encode()
    ).hexdigest()[:16]  # fmt: skip
    here = folder() / key
    out = here / ("run" if main else "run.so")
    if out.exists():
        return out
    here.mkdir(exist_ok=True)
    texts = {f"{block.prefix}.h": block.header, f"{block.prefix}.c": block.source,
             "driver.c": driver, "main.c": MAIN}  # fmt: skip
    for name, text in texts.items():
        (here / name).write_text(text)
    sources = [f"{block.prefix}.c", "driver.c", *(["main.c"] if main else [])]
    kind = [] if main else ["-shared", "-fPIC"]
    done = subprocess.run(
        [compiler, *WARNINGS, optimised, *options, *kind, "-o", str(out), *sources, "-lm"],
        cwd=here, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, f"{done.stderr}\n{block.source}"
    return out


def rows_of(s: Signals, faults: Array | None = None) -> Array:
    """(n, 7) dt, x, xdot, duty and fault factors of one record."""
    dt = np.concatenate([[0.0], s.step[:-1]])
    factors = np.ones((len(s), 3)) if faults is None else faults
    return np.column_stack([dt, s.x, s.xdot, s.duty, factors])


def run(
    block: CBlock,
    rows: Array,
    *options: str,
    begin: tuple[float, int, int] = (0.0, 1, -1),
    changed: Mapping[str, float] | None = None,
    compiler: str = "gcc",
) -> Ran:
    """What a block makes of rows; `changed` are other values of its parameters by path."""
    library = ctypes.CDLL(str(built(block, *options, compiler=compiler)))
    rows = np.ascontiguousarray(rows, dtype=float)
    values = np.array([(changed or {}).get(m.path, m.value) for m in block.parameters])
    first = np.array(begin, dtype=float)
    force, status = np.empty(len(rows)), np.empty(len(rows), dtype=np.int32)
    arrays = [a.ctypes.data_as(ctypes.c_void_p) for a in (values, first, rows, force, status)]
    library.run(ctypes.c_long(len(rows)), *arrays)
    return Ran(force, status)


def forces(block: CBlock, s: Signals, *options: str, **given: Any) -> Array:
    """(n,) force over all records, each from its own beginning."""
    out = np.empty(len(s))
    for a, b in zip(s.starts[:-1], s.starts[1:], strict=True):
        one = record(s, int(a), int(b))
        begin = (float(one.t[0]), int(one.compressing[0]), int(one.rests[0]))
        out[a:b] = run(block, rows_of(one), *options, begin=begin, **given).force
    return out
