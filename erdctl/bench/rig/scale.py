"""Units: a channel whose size no damper bench has."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from erdctl.bench.rig.fault import RigFault
from erdctl.bench.rig.pieces import THIN, Piece, spread
from erdctl.core.quantiles import percentiles

FASTEST = 5.0  # m/s; suspension dampers are tested up to 3 m/s
SHORTEST = 60e-6  # m; a stroke of centimetres that is a thousand times too small
LONGEST_CYCLE = 300.0  # s
SHORTEST_CYCLE = 1e-3  # s
SLOWEST_SAMPLING = 0.5  # s from sample to sample
WEAKEST = 2.0  # N peak; kilonewtons of a damper of up to 2 kN
LOWEST_DUTY = 0.0101  # per cent within 0..1


def check(found: Sequence[Piece]) -> list[RigFault]:
    """Channels whose unit is in doubt; each is a question that the user can decline."""
    return list(_check(found)) if found else []


def _check(found: Sequence[Piece]) -> Iterator[RigFault]:
    speed = max(spread(p.xdot) / 2.0 for p in found)
    stroke = max(p.stroke for p in found)
    cycle = min((p.cycle for p in found if p.cycle > 0), default=0.0)
    step = max(p.step for p in found)
    if step > SLOWEST_SAMPLING or cycle > LONGEST_CYCLE:
        yield _doubt(
            "time_unit",
            f"t has a step of {step:.4g} s and the piston a cycle of {cycle:.4g} s",
            'if t is in milliseconds, give --map "t=t[ms]"',
        )
    elif 0.0 < cycle < SHORTEST_CYCLE:
        yield _doubt(
            "time_unit",
            f"the piston has a cycle of {cycle:.3g} s ({1 / cycle:.4g} Hz)",
            'if t is in minutes, give --map "t=t[min]"',
        )
    elif speed > FASTEST:
        yield _doubt(
            "speed_unit",
            f"the speed reaches {speed:.4g} m/s, and damper benches stay below {FASTEST:g} m/s",
            'if the motion is in mm or cm, give --map "x=x[mm]" --map "xdot=xdot[mm/s]"',
        )
    elif 0.0 < stroke < SHORTEST:
        yield _doubt(
            "stroke_unit",
            f"the stroke is {1e6 * stroke:.3g} um",
            "if x was in metres and has been converted once too often, map it without a unit",
        )
    yield from _forces(found)
    duty = max(float(p.of("duty").max()) for p in found)
    if 0.0 < duty <= LOWEST_DUTY:
        yield _doubt(
            "duty_unit",
            f"the duty cycle never exceeds {duty:.4g} of full scale",
            'if 1 stands for 1 %, give --map "duty=duty[percent]"',
        )


def _forces(found: Sequence[Piece]) -> Iterator[RigFault]:
    if found[0].recording.force is None:
        return
    peak = max(max(map(abs, percentiles(p.force[:: 1 + len(p) // THIN], 0.1, 99.9))) for p in found)
    if 0.0 < peak < WEAKEST:
        yield _doubt(
            "force_unit",
            f"the force stays below {peak:.3g} N",
            'if it is in kilonewtons, give --map "force=force[kN]"',
        )


def _doubt(code: str, text: str, remedy: str) -> RigFault:
    return RigFault(code, None, text, f"{remedy}; if it is right, --accept {code}", blocks=True)
