"""An exported emulator, compiled and driven over whole arrays."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from erdctl.export.emulator.source import EmulatorBlock

STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
COMPILERS = [c for c in ("gcc", "clang") if shutil.which(c)]

# Many samples in one call. A row of `inputs`: dt, x, xdot, duty, temperature, the three factors; of
# `outputs`: duty_out, status, limited, out_of_reach.
DRIVER = """
#include "PREFIX.h"
#include <stddef.h>
size_t size_of_state(void) { return sizeof(PREFIX_state); }
size_t size_of_params(void) { return sizeof(PREFIX_params); }
void defaults(PREFIX_params *p) { PREFIX_defaults(p); }
void init(PREFIX_state *s, const PREFIX_params *p) { PREFIX_init(s, p); }
void run(PREFIX_state *s, size_t n, const PREFIX_real *in, PREFIX_real *out)
{
    size_t i;
    for (i = 0; i < n; i++, in += 8, out += 4) {
        if (i == 0 || in[5] != in[-3] || in[6] != in[-2] || in[7] != in[-1])
            PREFIX_faults(s, in[5], in[6], in[7]);
        out[0] = PREFIX_step(s, in[0], in[1], in[2], in[3], in[4]);
        out[1] = (PREFIX_real)s->status;
        out[2] = (PREFIX_real)s->limited;
        out[3] = (PREFIX_real)s->out_of_reach;
    }
}
"""

# Bad and good inputs at random, so that the sanitizers see every branch.
NONSENSE = """
#include "PREFIX.h"
#include <math.h>
#include <stdio.h>
static unsigned long seed = 1;
static PREFIX_real pick(PREFIX_real low, PREFIX_real high)
{
    seed = (seed * 1103515245UL + 12345UL) % 2147483648UL;
    switch (seed / 65536UL % 40UL) {
    case 0: return (PREFIX_real)NAN;
    case 1: return (PREFIX_real)INFINITY;
    case 2: return (PREFIX_real)-INFINITY;
    case 3: return (PREFIX_real)0;
    case 4: return (PREFIX_real)1e30;
    default:
        return low
            + (high - low) * (PREFIX_real)(seed / 65536UL % 32768UL) / (PREFIX_real)32768;
    }
}
int main(void)
{
    PREFIX_state s;
    PREFIX_params p;
    int run, i;
    for (run = 0; run < 200; run++) {
        PREFIX_defaults(&p);
        if (run % 2) {
            p.slew = pick(0, 20);
            p.resolution = pick(0, (PREFIX_real)0.05);
            p.update_period = pick(0, (PREFIX_real)0.02);
        }
        PREFIX_init(&s, run % 3 ? &p : 0);
        for (i = 0; i < 500; i++) {
            PREFIX_real out;
            if (i % 100 == 0)
                PREFIX_faults(&s, pick(0, 1), pick(0, 1), pick(0, 1));
            out = PREFIX_step(&s, pick(0, (PREFIX_real)0.005), pick(-1, 1), pick(-1, 1), pick(0, 1),
                              pick(0, 70));
            if (!(out >= 0 && out <= 1))
                return 1;
        }
    }
    puts("ok");
    return 0;
}
"""


@dataclass(frozen=True)
class Emulated:
    """What came out: (n,) each."""

    duty: Any
    status: Any
    limited: Any
    out_of_reach: Any


@dataclass(frozen=True)
class Compiled:
    """A compiled emulator; `names` are the members of its parameters in their order."""

    library: Any
    names: tuple[str, ...]
    real: Any = np.float64

    @classmethod
    def of(
        cls,
        block: EmulatorBlock,
        folder: Path,
        *,
        compiler: str = "gcc",
        options: tuple[str, ...] = (),
    ) -> Compiled:
        write(block, folder)
        (folder / "driver.c").write_text(DRIVER.replace("PREFIX", block.prefix))
        out = folder / f"{block.prefix}.so"
        subprocess.run(
            [compiler, *STRICT, "-O2", "-shared", "-fPIC", *options, f"{block.prefix}.c",
             "driver.c", "-o", str(out), "-lm"],
            cwd=folder, check=True,
        )  # fmt: skip
        library = ctypes.CDLL(str(out))
        library.size_of_state.restype = library.size_of_params.restype = ctypes.c_size_t
        library.run.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_void_p]
        library.init.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
        real = np.float32 if "-DERDCTL_FLOAT" in options else np.float64
        return cls(library, tuple(m.path for m in block.parameters), real)

    def state(self, **changed: float) -> Any:
        """A fresh state, with other parameters than the exported ones."""
        params = np.zeros(len(self.names), dtype=self.real)
        assert params.nbytes == self.library.size_of_params()
        self.library.defaults(ctypes.c_void_p(params.ctypes.data))
        for name, value in changed.items():
            params[self.names.index(name)] = value
        state = np.zeros(self.library.size_of_state(), dtype=np.uint8)
        self.library.init(state.ctypes.data, params.ctypes.data)
        return state

    def run(self, state: Any, inputs: Any) -> Emulated:
        """The state goes on from where it is. inputs : (n, 8), see DRIVER."""
        given = np.ascontiguousarray(inputs, dtype=self.real)
        out = np.empty((len(given), 4), dtype=self.real)
        self.library.run(state.ctypes.data, len(given), given.ctypes.data, out.ctypes.data)
        return Emulated(out[:, 0], out[:, 1].astype(int), out[:, 2] != 0, out[:, 3] != 0)


def write(block: EmulatorBlock, folder: Path) -> None:
    (folder / f"{block.prefix}.h").write_text(block.header)
    (folder / f"{block.prefix}.c").write_text(block.source)


def rows(
    t: Any, x: Any, xdot: Any, duty: Any, *, temperature: Any = 25.0, oil: Any = 1.0,
    electrical: Any = 1.0, deformation: Any = 1.0,
) -> Any:  # fmt: skip
    """(n, 8) inputs from columns or numbers; the first step is 0 and of no weight."""
    columns = (np.diff(t, prepend=t[0]), x, xdot, duty, temperature, oil, electrical, deformation)
    return np.stack([np.broadcast_to(c, len(t)) for c in columns], axis=1)


def sanitized(
    compiler: str, folder: Path, real: tuple[str, ...] = ()
) -> subprocess.CompletedProcess[str]:
    """e.c and main.c, built and run under the sanitizers; skips where they are not installed."""
    built = subprocess.run(
        [compiler, "-std=c99", "-g", "-O1", "-fsanitize=address,undefined",
         "-fno-sanitize-recover=all", *real, "e.c", "main.c", "-o", "main", "-lm"],
        cwd=folder, capture_output=True, text=True,
    )  # fmt: skip
    if "cannot find" in built.stderr:
        pytest.skip("the sanitizers' libraries are not installed")
    assert built.returncode == 0, built.stderr
    return subprocess.run(["./main"], cwd=folder, capture_output=True, text=True)
