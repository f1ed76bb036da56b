"""The coordinates of learned laws as C: what each remembers, and its value at a sample.

Each is what `erdctl.model.learned.coordinates` has, computed from sample to sample; that looks
ahead in places, where this is causal:

- `passes` are counted over `SPOTS` spots of the stroke, which is not known before it was travelled.
  Spots grow with it, each twice as wide as before, and two that become one have the mean of their
  counts, which is exactly what would have been counted over it. So they are `SPOTS` to
  `SPOTS` / 2 over the stroke so far, where Python has `SPOTS` over that of the whole record. With a
  stroke that is told after init (PREFIX_stroke) they are the same.
- `temperature` is told by PREFIX_temperature; before that the middle of the law's range holds.
- the slope of a coordinate (for a deflection that goes with it) is that at the sample: of the
  motion where the coordinate has one of it, else of the step before, where Python has the mean of
  the steps before and after.

Sums that may go on for hours are compensated, so that they hold in single precision too.
Source: W. Kahan, Communications of the ACM 8 (1965) 40.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from erdctl.model.c_law import Told
from erdctl.model.learned.coordinates import KINDS, SPOTS

NEVER = "K(1e30)"  # since what has not been yet: beyond any range, and finite in single precision
NARROWEST = 1e-3  # m, of the stroke for which spots are made at first


class CCoordinate(NamedTuple):
    """One coordinate in C.

    state : what it remembers, real numbers by name, arrays with their size
    code : statements that set `VALUE` at each sample; `@name` is a member of its state
    step : its change over a step of `h` at the slope that it has at a sample; empty where it holds
        between jumps, and None where only that of the last step is known
    told : what a program may tell it
    """

    state: tuple[str, ...]
    code: str
    step: str | None = None
    told: tuple[Told, ...] = ()

    def named(self, name: str, span: tuple[float, float], *, moves: bool) -> CCoordinate:
        """It in a variable of that name, over a range; `moves`: with its change over a step."""
        middle = f"K({0.5 * (span[0] + span[1])!r})"

        def own(text: str) -> str:
            text = text.replace("@", f"z->{name}_").replace("MIDDLE", middle)
            return text.replace("VALUE", name)

        state, code, step = self.state, self.code, self.step
        if step is None and moves:
            state = (*state, "last", "slope")
            code += "\n@slope = s->first ? K(0.0) : VALUE - @last;\n@last = VALUE;"
            step = "@slope"
        return CCoordinate(
            state=tuple(f"{name}_{member}" for member in state),
            code=own(code),
            step=own(step or "K(0.0)"),
            told=tuple(replace(t, code=own(t.code)) for t in self.told),
        )


def _sum(more: str, keep: str = "") -> str:
    """A sum of what each step adds, 0 as the motion begins."""
    return f"""\
if (s->first) {{
    @sum = K(0.0);
    @low = K(0.0);
}} else {{
    add_to(&@sum, &@low, {more});
}}{keep and chr(10) + keep}
VALUE = @sum;"""


def _since(event: str, more: str = "s->h", begins: str = "K(0.0)", keep: str = "") -> str:
    """A sum of what each step adds since an event."""
    return f"""\
if (s->first || {event}) {{
    @sum = s->first ? {NEVER} : {begins};
    @low = K(0.0);
}} else {{
    add_to(&@sum, &@low, {more});
}}{keep and chr(10) + keep}
VALUE = @sum;"""


def _largest(of: str) -> str:
    return f"@most = s->first ? FABS({of}) : FMAX(@most, FABS({of}));\nVALUE = @most;"


def _late(of: str, *, less: bool = False, settles: bool = False, gone: str = "s->h") -> CCoordinate:
    """dy/dt = (value - y) / tau, the value a straight line whose mean counts in each step."""
    value = "now - @lag" if less else "K(0.5) * (K(1.0) - s->sign * @lag)" if settles else "@lag"
    code = f"""\
{{
    const real now = {of};
    if (s->first) {{
        @lag = {"now" if less or settles else "K(0.0)"};
    }} else {{
        const real gone = -EXPM1(-{gone} / FMAX(p->tau, K(1e-9)));
        @lag += gone * (K(0.5) * (@was + now) - @lag);
    }}
    @was = now;
    VALUE = {value};
}}"""
    if settles:
        return CCoordinate(("lag", "was"), code)
    move = "FMIN(h / FMAX(p->tau, K(1e-9)), K(1.0)) * (@was - @lag)"
    with_x = "s->xdot * h - " if of == "s->x" else "-"
    return CCoordinate(("lag", "was"), code, f"{with_x}({move})" if less else move)


def _ringing(of: str, *, cosine: bool) -> CCoordinate:
    """A complex amplitude that turns and fades; a change of the value is spread over its step.

    Z -> Z exp(q h) + dv (exp(q h) - 1) / (q h),   q = -zeta w + i w_d
    """
    value = "-(@re + p->zeta * w / turn * @im)" if cosine else "@im * w / turn"
    code = f"""\
{{
    const real now = {of};
    const real w = K(1.0) / FMAX(p->tau, K(1e-9));
    const real turn = w * SQRT(FMAX(K(1.0) - p->zeta * p->zeta, K(1e-6)));
    if (s->first) {{
        @re = K(0.0);
        @im = K(0.0);
    }} else {{
        const real a = -p->zeta * w * s->h, b = turn * s->h;
        const real half = SIN(K(0.5) * b);
        const real fade = EXP(a), c = COS(b), d = SIN(b);
        const real jump = (now - @was) / (a * a + b * b);
        const real grown = EXPM1(a) * c - K(2.0) * half * half, turned = fade * d;
        const real re = fade * (@re * c - @im * d) + jump * (grown * a + turned * b);
        @im = fade * (@re * d + @im * c) + jump * (turned * a - grown * b);
        @re = re;
    }}
    @was = now;
    VALUE = {value};
}}"""
    return CCoordinate(("re", "im", "was"), code)


_SPOT = f"(int)clipped(({{}} - @low) / @width, K(0.0), K({SPOTS - 1}.0))"
_HALF = SPOTS // 2
_PASSES = f"""\
{{
    int k, end;
    if (s->first) {{
        for (k = 0; k < {SPOTS}; ++k) @count[k] = K(0.0);
        @grows = @high > @from ? K(0.0) : K(1.0);
        @width = @grows > K(0.0) ? K({NARROWEST / SPOTS!r}) : (@high - @from) / K({SPOTS}.0);
        @low = @grows > K(0.0) ? s->x - K({NARROWEST / 2!r}) : @from;
    }}
    while (@grows > K(0.0) && (s->x < @low || s->x > @low + K({SPOTS}.0) * @width)) {{
        /* Spots twice as wide: those that were there become the upper or the lower half. */
        if (s->x < @low) {{
            for (k = {_HALF - 1}; k >= 0; --k)
                @count[k + {_HALF}] = K(0.5) * (@count[2 * k] + @count[2 * k + 1]);
            for (k = 0; k < {_HALF}; ++k) @count[k] = K(0.0);
            @low -= K({SPOTS}.0) * @width;
        }} else {{
            for (k = 0; k < {_HALF}; ++k) @count[k] = K(0.5) * (@count[2 * k] + @count[2 * k + 1]);
            for (k = {_HALF}; k < {SPOTS}; ++k) @count[k] = K(0.0);
        }}
        @width *= K(2.0);
    }}
    if (!s->first) {{
        const real from = FMIN(s->x, @x), to = FMAX(s->x, @x);
        end = {_SPOT.format("to")};
        for (k = {_SPOT.format("from")}; k <= end; ++k) {{
            const real edge = @low + @width * (real)k;
            @count[k] += (clipped(to - edge, K(0.0), @width) - clipped(from - edge, K(0.0), @width))
                                      / @width;
        }}
    }}
    k = {_SPOT.format("s->x")};
    {{
        /* Less what the present pass has covered of the place itself. */
        const real edge = @low + @width * (real)k;
        const real passed = (s->up ? s->x - edge : edge + @width - s->x) / @width;
        VALUE = FMAX(@count[k] - clipped(passed, K(0.0), K(1.0)), K(0.0));
    }}
    @x = s->x;
}}"""

_STROKE = Told(
    name="stroke",
    given=("low", "high"),
    words="Least and largest deflection [m] of what follows, where they are known before the first"
    " sample: passes are counted over parts of that stroke. Without, it grows with the motion.",
    code="@from = low;\n@high = high;",
)
_TEMPERATURE = Told(
    name="temperature",
    given=("temperature",),
    words="Temperature [degC] of which the force is a law; held until called again. Before the"
    " first call the middle of the range holds in which the law was learned.",
    code="@told = temperature;\n@known = K(1.0);",
)

WRITTEN: Mapping[str, CCoordinate] = {
    "x": CCoordinate((), "VALUE = s->x;", "s->xdot * h"),
    "abs_x": CCoordinate((), "VALUE = FABS(s->x);", "(s->x < K(0.0) ? -s->xdot : s->xdot) * h"),
    "direction": CCoordinate((), "VALUE = s->sign;", ""),
    "xdot": CCoordinate((), "VALUE = s->xdot;"),
    "abs_xdot": CCoordinate((), "VALUE = FABS(s->xdot);"),
    "duty": CCoordinate((), "VALUE = s->duty;", ""),
    "since_reversal": CCoordinate(("sum", "low"), _since("s->turned"), "h"),
    "path_since_reversal": CCoordinate(
        ("sum", "low"), _since("s->turned", "s->path", "s->after"), "FABS(s->xdot) * h"
    ),
    "since_duty_step": CCoordinate(
        ("sum", "low", "duty"),
        _since("s->duty < @duty || s->duty > @duty", keep="@duty = s->duty;"), "h",
    ),
    "t": CCoordinate((), "VALUE = s->t;", "h"),
    "travel": CCoordinate(("sum", "low"), _sum("s->path"), "FABS(s->xdot) * h"),
    "field_travel": CCoordinate(
        ("sum", "low", "duty"), _sum("s->path * @duty", "@duty = s->duty;"),
        "FABS(s->xdot) * s->duty * h",
    ),
    "flow_work": CCoordinate(
        ("sum", "low", "xdot"), _sum("s->h * @xdot * @xdot", "@xdot = s->xdot;"),
        "s->xdot * s->xdot * h",
    ),
    "passes": CCoordinate(
        ("from", "high", "low", "width", "grows", "x", f"count[{SPOTS}]"), _PASSES, told=(_STROKE,)
    ),
    "largest_x": CCoordinate(("most",), _largest("s->x")),
    "largest_xdot": CCoordinate(("most",), _largest("s->xdot")),
    "largest_duty": CCoordinate(("most",), _largest("s->duty"), ""),
    "temperature": CCoordinate(
        ("told", "known"), "VALUE = @known > K(0.0) ? @told : MIDDLE;", "", (_TEMPERATURE,)
    ),
    "late_duty": _late("s->duty"),
    "late_xdot2": _late("s->xdot * s->xdot"),
    "late_flow": _late("s->xdot * FABS(s->xdot)"),
    "fresh_x": _late("s->x", less=True),
    "unsettled_time": _late("s->sign", settles=True),
    "unsettled_way": _late("s->sign", settles=True, gone="s->path"),
    "ringing_xdot": _ringing("s->xdot", cosine=False),
    "ringing_field": _ringing("s->duty * s->sign", cosine=True),
    "fresh_duty": _late("s->duty", less=True),
}  # fmt: skip

assert WRITTEN.keys() == KINDS.keys()
