"""What `diagnose` says of a damper in a car, by hand, one to two minutes a case:

    PYTHONPATH=.:tests python tests/diagnose/measure_in_a_car.py FIRST END

Each seed hides the next of `quarter_car.EFFECTS` in a drive of five to eight records at 200 to
500 Hz, most of them in a closed loop. All have a yield force that is steep next to rest, so that
`preyield_viscosity` is right beside each.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import quarter_car

from erdctl.diagnose.diagnosis import diagnose
from erdctl.effects import catalogue
from erdctl.io.logs import read_logs

STEEP = {"preyield_viscosity", "preyield_field_dependence", "yield_hysteresis"}
ALIKE = {
    "coulomb_friction": {"presliding_friction", "stribeck_friction"},
    "gas_preload": {"force_offset", "gas_polytropic"},
}


def main(first: int, end: int) -> None:
    hidden = named = alike = spurious = 0
    for seed in range(first, end):
        g = np.random.default_rng([seed, 1])
        effect = list(quarter_car.EFFECTS)[seed % len(quarter_car.EFFECTS)]
        rate, records = int(g.choice([200, 250, 500])), int(g.integers(5, 9))
        table = quarter_car.log(seed, rate, records=records, seconds=15.0, effect=effect)
        with TemporaryDirectory() as folder:
            file = Path(folder) / "car.parquet"
            table.to_parquet(file)
            log = read_logs([str(file)], need_force=True, report=lambda line: None)
        found = diagnose(log.recording, catalogue(), jobs=1)
        names = [f.effect.name for f in found.findings]
        said = ", ".join(names) or "nothing"
        print(f"{seed} {effect} at {rate} Hz: {found.verdict.value}, {said}", flush=True)
        hidden += effect != "none"
        named += effect in names
        alike += effect not in names and bool(ALIKE.get(effect, set()) & set(names))
        right = {effect} | STEEP | ALIKE.get(effect, set())
        spurious += len([n for n in names if n not in right])
    print(f"{hidden} hidden, {named} named, {alike} by what looks alike; {spurious} spurious")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
