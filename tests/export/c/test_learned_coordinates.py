"""Coordinates and curves of learned laws in C, each by itself, against those in Python."""

from __future__ import annotations

import ctypes
import re
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from erdctl.core.recording import Array
from erdctl.core.signals import Signals
from erdctl.export.c.names import helpers, part
from erdctl.model.learned import c_coordinates, c_curve
from erdctl.model.learned.coordinates import KINDS, Memory, along
from erdctl.model.learned.curve import Curve
from erdctl.model.learned.forms import FORMS
from erdctl.model.learned.surface import Surface

MEMORY = Memory(0.07, 0.15)
FLAGS = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-O2"]


def prelude(called: str) -> str:
    """What stands before an effect's code in an exported file."""
    real = "#ifdef ERDCTL_FLOAT\ntypedef float real;\n#else\ntypedef double real;\n#endif\n"
    types = part("types.c").replace('#include "PREFIX.h"', real)
    types = re.sub(r"typedef PREFIX_\w+ \w+;", "", types)
    return f"{types}\n{helpers(called)}\n"


REALS = ("h", "t", "x", "xdot", "duty", "before", "sign", "path", "after")


def motion(seed: int = 1, rate: float = 400.0, duration: float = 5.0) -> Signals:
    """Random motion that rests now and then, duty that is held, on a step that is not even."""
    random = np.random.default_rng(seed)
    t = np.arange(0.0, duration, 1.0 / rate)
    t[1:-1] += random.uniform(-0.2, 0.2, len(t) - 2) / rate
    f, a, p = random.uniform(0.5, 6.0, 5), random.uniform(1e-3, 6e-3, 5), random.uniform(0, 6, 5)
    phase = 2 * np.pi * f[:, None] * t + p[:, None]
    x = (a[:, None] * np.sin(phase)).sum(0)
    xdot = (2 * np.pi * (f * a)[:, None] * np.cos(phase)).sum(0)
    still = (t > 2.0) & (t < 2.2)
    x[still], xdot[still] = x[still][0], 0.0
    levels = random.uniform(0.0, 0.6, 200) * (random.uniform(size=200) > 0.3)
    duty = levels[(t / 0.05).astype(int)]
    step = np.append(np.diff(t), 0.0)
    starts = np.array([0, len(t)])
    return Signals(t, x, xdot, duty, step, starts, temperature=np.full(len(t), 31.0))


def samples_of(s: Signals) -> dict[str, Array]:
    """The members of the C struct, from `Signals` of one record."""
    zero = np.zeros(len(s))
    out = {"x": s.x, "xdot": s.xdot, "duty": s.duty, "t": s.t - s.t[0], "sign": s.sign}
    out["h"] = np.append(0.0, s.step[:-1])
    out["path"] = np.append(0.0, s.path[0][:-1])
    for name, values in (("before", s.turns[1]), ("after", s.path[1]), ("turned", 1.0)):
        out[name] = zero.copy()
        out[name][s.turns[0] + 1] = values
    return out | {"up": s.compressing.astype(float)}


@cache
def compiled(source: str, folder: Path, single: bool = False) -> ctypes.CDLL:
    name = f"c{abs(hash(source + str(single))):x}"
    (folder / f"{name}.c").write_text(prelude(source) + source)
    out = folder / f"{name}.so"
    flags = [*FLAGS, "-DERDCTL_FLOAT"] if single else FLAGS
    made = subprocess.run(
        ["gcc", *flags, "-shared", "-fPIC", str(folder / f"{name}.c"), "-o", str(out), "-lm"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert made.returncode == 0, made.stderr
    return ctypes.CDLL(str(out))


def program(kind: str, *, step: bool = False) -> str:
    """A loop over samples that puts out a coordinate, or its change over a step."""
    written = c_coordinates.WRITTEN[kind].named("a", (20.0, 30.0), moves=step)
    state, code, change = written.state, written.code, written.step
    members = " ".join(f"real {m};" for m in state) or "real none;"
    loads = "\n".join(f"    sample.{m} = in[{k}][i];" for k, m in enumerate(REALS))
    k = len(REALS)
    return f"""
typedef struct {{ real tau, zeta; }} params;
typedef struct {{ {members} }} State;
void run(int n, const double *const *whole, const double *memory,
         const double *told, double *out);
void run(int n, const double *const *whole, const double *memory,
         const double *told, double *out) {{
  State state; State *z = &state; Sample sample; Sample *s = &sample;
  params given; const params *p = &given; int i;
  real in[{k + 2}][1];
  memset(z, 0, sizeof *z); memset(s, 0, sizeof *s);
  given.tau = (real)memory[0]; given.zeta = (real)memory[1];
  (void)p; (void)told;
  {told(kind)}
  for (i = 0; i < n; ++i) {{
    real a; real h; int j;
    for (j = 0; j < {k + 2}; ++j) in[j][0] = (real)whole[j][i];
{loads.replace("[i]", "[0]")}
    sample.up = whole[{k}][i] > 0.5; sample.turned = whole[{k + 1}][i] > 0.5; sample.first = i == 0;
    {code}
    h = s->h; (void)h;
    out[i] = (double)({(change or "K(0.0)") if step else "a"});
    (void)a;
  }}
}}
"""


def told(kind: str) -> str:
    """What is told of a whole motion that Python sees at once."""
    if kind == "passes":
        return "z->a_from = (real)told[0]; z->a_high = (real)told[1];"
    return "z->a_told = (real)told[2]; z->a_known = K(1.0);" if kind == "temperature" else ""


def in_c(
    kind: str, s: Signals, folder: Path, stroke: tuple[float, float] = (0.0, 0.0), *,
    step: bool = False, single: bool = False,
) -> Array:  # fmt: skip
    library = compiled(program(kind, step=step), folder, single)
    members = samples_of(s)
    rows = [np.ascontiguousarray(members[m], dtype=float) for m in (*REALS, "up", "turned")]
    number = ctypes.POINTER(ctypes.c_double)
    pointers = (number * len(rows))(*(r.ctypes.data_as(number) for r in rows))
    out = np.empty(len(s))
    given = np.array([*stroke, 31.0])
    library.run(
        len(s), pointers, np.array(MEMORY).ctypes.data_as(number), given.ctypes.data_as(number),
        out.ctypes.data_as(number),
    )  # fmt: skip
    return out


def apart(a: Array, b: Array) -> float:
    """Largest difference over the range, where both are finite; infinity must be at the same."""
    never = ~np.isfinite(b)
    assert (a[never] > 1e29).all()
    return float(np.abs(a - b)[~never].max() / max(np.ptp(b[~never]), 1e-12))


@pytest.mark.parametrize("kind", KINDS)
def test_each_coordinate_is_the_same_in_c(kind: str, tmp_path: Path) -> None:
    for seed in (1, 2):
        s = motion(seed)
        expected = along(kind, s, MEMORY)
        stroke = (float(s.x.min()), float(s.x.max()))
        assert apart(in_c(kind, s, tmp_path, stroke), expected) < 1e-10
        assert apart(in_c(kind, s, tmp_path, stroke, single=True), expected) < 2e-3


def test_passes_over_a_stroke_that_is_not_known_are_as_many(tmp_path: Path) -> None:
    s = motion(3, duration=9.0)
    expected, found = along("passes", s, None), in_c("passes", s, tmp_path)
    assert np.abs(found - expected).mean() < 1.0  # passes
    assert abs(found - expected).max() < 8.0  # near the ends of the stroke
    assert expected.max() > 40.0


@pytest.mark.parametrize("kind", KINDS)
def test_the_slope_of_a_coordinate_is_known_as_it_goes(kind: str, tmp_path: Path) -> None:
    """Between jumps the change over a step is what Python's differences show, to second order."""
    s = motion(4, rate=1000.0)
    z = along(kind, s, MEMORY)
    with np.errstate(invalid="ignore"):
        slope = np.gradient(z, s.t)
    found = in_c(kind, s, tmp_path, (float(s.x.min()), float(s.x.max())), step=True)[1:-1]
    expected = (slope * np.append(0.0, s.step[:-1]))[1:-1]
    good = np.isfinite(expected)
    error = np.abs(found - expected)[good]
    assert np.quantile(error, 0.8) <= 0.05 * np.quantile(np.abs(expected[good]), 0.95) + 1e-12


def curve_program(curve: Curve) -> str:
    quantities = [q.symbol for q in (*curve.amplitudes("N"), *curve.shape())]
    curve_ = c_curve.curve_in_c(curve, "N")
    values = "".join(f"  p.{q} = (real)given[{k}];\n" for k, q in enumerate(quantities))
    return f"""
typedef struct {{ real {", ".join(quantities)}; }} params;
static real law(const params *p, real at, real by) {{
  real value;
  (void)by;
{curve_.declared}
{curve_.code}
  return value;
}}
void run(int n, const double *given, const double *z, const double *y, double *out);
void run(int n, const double *given, const double *z, const double *y, double *out) {{
  params p; int i; (void)y;
{values}
  for (i = 0; i < n; ++i) out[i] = (double)law(&p, (real)z[i], (real)y[i]);
}}
"""


def curves_apart(curve: Curve, folder: Path, *, single: bool = False) -> float:
    random = np.random.default_rng(5)
    sizes, shape = curve.amplitudes("N"), curve.shape()
    values = {q.symbol: float(random.uniform(-5, 5)) for q in sizes}
    values |= {q.symbol: q.start for q in shape}
    low, high = curve.range
    z = random.uniform(low - 3.0 * (high - low), high + 3.0 * (high - low), 500)
    z[:3] = low, high, 1e30  # what has not been yet, which Python has as infinite
    y = random.uniform(-0.1, 1.1, 500)
    out = np.empty(500)
    number = ctypes.POINTER(ctypes.c_double)
    given = np.array(list(values.values()))
    compiled(curve_program(curve), folder, single).run(
        500, *(a.ctypes.data_as(number) for a in (given, z, y, out))
    )
    z[2] = np.inf
    rows = curve.at_both(z, y) if isinstance(curve, Surface) else curve.at(z, values)
    return apart(out, np.array([values[q.symbol] for q in sizes]) @ rows)


@pytest.mark.parametrize("form", FORMS)
def test_each_closed_form_is_the_same_in_c(form: str, tmp_path: Path) -> None:
    for ends in ((-0.03, 0.05), (0.0, 4.0)):
        curve = Curve("late_duty", ends, form)
        assert curves_apart(curve, tmp_path) < 1e-12
        assert curves_apart(curve, tmp_path, single=True) < 1e-5


@pytest.mark.parametrize("zero_first", [False, True])
@pytest.mark.parametrize("count", [3, 5, 9])
def test_a_spline_is_the_same_in_c(count: int, zero_first: bool, tmp_path: Path) -> None:
    knots = np.cumsum(np.random.default_rng(6).uniform(0.1, 1.0, count)) - 1.0
    curve = Curve("x", tuple(knots.tolist()), zero_first=zero_first)
    assert curves_apart(curve, tmp_path) < 1e-12
    assert curves_apart(curve, tmp_path, single=True) < 2e-6


@pytest.mark.parametrize("zero_first", [False, True])
@pytest.mark.parametrize("counts", [(2, 2), (4, 3)])
def test_a_surface_is_the_same_in_c(
    counts: tuple[int, int], zero_first: bool, tmp_path: Path
) -> None:
    first, second = (tuple(np.linspace(0.0, 1.0, n).tolist()) for n in counts)
    curve = Surface("x", first, zero_first=zero_first, across=Curve("duty", second))
    assert curves_apart(curve, tmp_path) < 1e-12
